//! The faces of a file from which the triangles were made.

/// Faces of a file from which the triangles were made.
///
/// It maps the triangles of an answer to faces of the file. By default every face is a triangle.
/// Triangles keep their numbers if a mesh is welded or moved, so the map stays right.
///
/// Memory: none if every face was a triangle. Else 4 bytes per face, and 8 bytes plus 4 per corner
/// for a face that is not a fan. A face that was left out has no triangle.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Polygons {
    /// The first triangle of each face, ascending; empty if every face was a triangle.
    first: Vec<u32>,
    /// The faces that are not fans, ascending, each with the start of its corners in `corners`.
    cut: Vec<[u32; 2]>,
    corners: Vec<u32>,
}

impl Polygons {
    /// Number of faces of the file, those that were left out too, from which so many triangles were
    /// made.
    pub fn count(&self, triangles: usize) -> usize {
        if self.first.is_empty() { triangles } else { self.first.len() }
    }

    /// The face of the file to which a triangle belongs, counted from 0 in the file's order. The
    /// triangle itself if every face was a triangle. Cost: a binary search.
    pub fn file_face(&self, triangle: u32) -> u32 {
        match self.first.partition_point(|&first| first <= triangle) {
            0 => triangle,
            after => after as u32 - 1,
        }
    }

    /// The number in the file of an element of a mesh with so many triangles: the face of a triangle.
    /// Edges and points of no face come behind all faces of the file.
    pub fn file_element(&self, element: u32, triangles: usize) -> u32 {
        match (element as usize).checked_sub(triangles) {
            None => self.file_face(element),
            Some(behind) => (self.count(triangles) + behind) as u32,
        }
    }

    /// The triangles of a face, among `triangles` of the mesh.
    pub(crate) fn triangles(&self, face: usize, triangles: usize) -> std::ops::Range<usize> {
        match self.first.get(face) {
            None => face..face + 1,
            Some(&first) => first as usize..self.first.get(face + 1).map_or(triangles, |&next| next as usize),
        }
    }

    /// Whether every face was a triangle.
    pub(crate) fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Writes the corners of a face, as the file has them, to `into`.
    pub(crate) fn corners(&self, face: usize, faces: &[[u32; 3]], into: &mut Vec<u32>) {
        into.clear();
        let triangles = &faces[self.triangles(face, faces.len())];
        let Some(fan) = triangles.first() else { return }; // it was left out
        match self.cut.binary_search_by_key(&(face as u32), |cut| cut[0]) {
            Ok(at) => {
                let from = self.cut[at][1] as usize;
                into.extend(&self.corners[from..from + triangles.len() + 2]);
            }
            Err(_) => {
                into.extend(&fan[..2]);
                into.extend(triangles.iter().map(|triangle| triangle[2]));
            }
        }
    }

    /// Keeps the corners of a face that will not be a fan; faces come in ascending order.
    pub(crate) fn keep(&mut self, face: usize, corners: &[u32]) {
        self.cut.push([face as u32, self.corners.len() as u32]);
        self.corners.extend(corners);
    }
}

/// Faces gathered by a reader: each as a fan around its first corner, in the file's order.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    pub faces: Vec<[u32; 3]>,
    pub polygons: Polygons,
    read: u32,
    first: u32,
    last: u32,
}

impl Fans {
    /// Adds the next vertex, which is corner `corner` (from 0) of its face. A face of fewer than
    /// three corners is left out afterwards.
    pub fn corner(&mut self, corner: u64, vertex: u32) {
        match corner {
            0 => {
                self.first = vertex;
                if !self.polygons.is_empty() {
                    self.polygons.first.push(self.faces.len() as u32);
                }
                self.read += 1;
            }
            1 => {}
            // The first face with more than three corners: all before it are triangles.
            3 if self.polygons.is_empty() => {
                self.polygons.first.extend(0..self.read);
                self.faces.push([self.first, self.last, vertex]);
            }
            _ => self.faces.push([self.first, self.last, vertex]),
        }
        self.last = vertex;
    }

    /// Adds a face of one triangle.
    pub fn single(&mut self, face: [u32; 3]) {
        face.into_iter().enumerate().for_each(|(corner, vertex)| self.corner(corner as u64, vertex));
    }

    /// Adds a triangle of a strip; every second one turns the other way. One with equal corners joins
    /// two strips, and is no face.
    pub fn of_strip(&mut self, [a, b, c]: [u32; 3], turned: bool) {
        if a != b && b != c && a != c {
            self.single(if turned { [b, a, c] } else { [a, b, c] });
        }
    }

    /// Leaves out the last face, which has this number of corners, two at most. It keeps its
    /// number, and has no triangles.
    pub fn leave_out(&mut self, corners: u64) {
        let others = if corners > 0 { self.read - 1 } else { self.read };
        let (count, first) = (self.faces.len() as u32, &mut self.polygons.first);
        if first.is_empty() {
            first.extend(0..others);
            first.push(count);
        } else if corners == 0 {
            first.push(count);
        }
        self.read = others + 1;
    }
}
