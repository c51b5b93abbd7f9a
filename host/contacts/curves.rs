//! Curves in which surfaces cross, chained by the features that their points are on.

use super::{PairGeometry, PairKind, Part};
use crate::error::Error;
use crate::memory;
use crate::scene::{Body, BodyId};
use std::collections::HashMap;

/// Curves in which surfaces cross, and groups of the rows that cross: see [`crossing_curves`].
///
/// Arrays are in the form of files and of other languages. [`Curves::iter`] has a curve at a time.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Curves {
    /// Points of all curves, curve by curve. A closed curve has its first point again at its end.
    pub points: Vec<[f64; 3]>,
    /// First point of each curve in `points`, and their number: one number more than curves.
    pub starts: Vec<usize>,
    /// Whether each curve is closed.
    pub is_closed: Vec<bool>,
    /// Row of each segment, curve by curve. A curve has one segment less than points, so the
    /// segments of curve `k` begin at `starts[k] - k`.
    pub rows: Vec<u32>,
    /// Group of each curve, in ascending order of their first rows.
    pub groups: Vec<u32>,
    /// Group of each row; `None` for rows that do not cross.
    pub row_groups: Vec<Option<u32>>,
}

/// A curve in which surfaces cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<'a> {
    /// Its points, in scene units. A closed curve has its first point again at its end.
    pub points: &'a [[f64; 3]],
    /// Rows of the segments between them.
    pub rows: &'a [u32],
    /// Whether it is closed.
    pub is_closed: bool,
    /// Its group.
    pub group: u32,
}

impl Curves {
    /// Number of curves.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// Whether there are no curves.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// The curves.
    pub fn iter(&self) -> impl Iterator<Item = Curve<'_>> {
        self.groups.iter().enumerate().map(|(k, &group)| {
            let points = self.starts[k]..self.starts[k + 1];
            let rows = points.start - k..points.end - k - 1;
            Curve {
                points: &self.points[points],
                rows: &self.rows[rows],
                is_closed: self.is_closed[k],
                group,
            }
        })
    }
}

/// Feature of a body that holds a point in its inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Site {
    Vertex(BodyId, u32),
    /// An edge by its vertices, the smaller first.
    Edge(BodyId, [u32; 2]),
    Face(BodyId, u32),
}

/// A segment of a curve: its row, and the numbers of its ends.
#[derive(Clone, Copy)]
struct Segment {
    row: u32,
    ends: [usize; 2],
}

/// Host memory for a row: its segment, two ends in a table, lists of both, and its faces.
const OF_A_ROW: usize = 400;

/// Chains the segments of the rows that [cross](PairKind::Crossing), and groups these rows.
/// `bodies` are those of the scene, by number, and `geometry` is of the rows of a discrete answer.
///
/// - Two segments are joined if an end of both is on the same features: the same vertex, edge or
///   face of each body. No coordinate is compared. Ends that are joined have the same bits.
/// - A curve ends where no other segment or more than one continues it. That is at a border of a
///   mesh, at a seam of vertices with equal coordinates, where an edge is on a face along the
///   curve, and where more than two surfaces meet.
/// - A curve runs along the product of both normals, the first row's first body times its second.
/// - Rows that share a triangle or an end are in one group.
///
/// ```
/// use nearmiss::{Body, Detector, Device, Discrete, Mesh, contacts::crossing_curves, device::Backend, mesh::Positions};
///
/// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]];
/// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
/// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
/// let pairs = detector.query(&Discrete::default())?;
/// let geometry = detector.geometry(&pairs)?;
/// let curves = crossing_curves(&geometry, detector.scene().bodies())?;
/// assert_eq!((curves.len(), curves.is_closed[0], curves.points.len()), (1, false, 2));
/// # Ok::<(), nearmiss::Error>(())
/// ```
///
/// # Errors
/// [`Error::InvalidArgument`] for triangles that the bodies do not have; [`Error::OutOfMemory`].
pub fn crossing_curves(geometry: &[PairGeometry], bodies: &[Body]) -> Result<Curves, Error> {
    memory::require("crossing curves", (geometry.len() * OF_A_ROW) as u64)?;
    let mut numbers: HashMap<[Site; 2], usize> = HashMap::new();
    let (mut segments, mut groups) = (Vec::new(), Groups::of(geometry.len()));
    let mut faces: HashMap<(BodyId, u32), usize> = HashMap::new();
    let mut first_rows: Vec<usize> = Vec::new();
    for (row, pair) in geometry.iter().enumerate().filter(|(_, pair)| pair.kind == PairKind::Crossing) {
        for side in 0..2 {
            let face = (pair.bodies[side], pair.triangles[side]);
            groups.join(row, *faces.entry(face).or_insert(row));
        }
        let mut ends = [0; 2];
        for (end, parts) in ends.iter_mut().zip(pair.parts.iter().flatten()) {
            let mut sites = [site(pair, 0, parts[0], bodies)?, site(pair, 1, parts[1], bodies)?];
            sites.sort_unstable();
            let next = numbers.len();
            *end = *numbers.entry(sites).or_insert(next);
            if *end == next {
                first_rows.push(row);
            }
            groups.join(row, first_rows[*end]);
        }
        // A segment that pierces a triangle has one point, and no part of a curve.
        if ends[0] != ends[1] {
            segments.push(Segment { row: row as u32, ends });
        }
    }
    let is_crossing = |row: usize| geometry[row].kind == PairKind::Crossing;
    let row_groups = groups.numbered(is_crossing);
    Ok(Chains::of(segments, numbers.len()).curves(geometry, row_groups))
}

/// The feature that holds an end of a row in its inside.
fn site(pair: &PairGeometry, side: usize, part: Part, bodies: &[Body]) -> Result<Site, Error> {
    let (body, triangle) = (pair.bodies[side], pair.triangles[side]);
    let face = bodies.get(body.index()).and_then(|own| own.elements().get(triangle as usize));
    let Some(face) = face else {
        return Err(Error::InvalidArgument {
            what: format!("triangle {triangle} of body {} does not exist", body.index()),
            advice: "pass the bodies of the detector that found the rows".into(),
        });
    };
    let corner = |k: u8| face[usize::from(k) % 3];
    Ok(match part {
        Part::Corner(k) => Site::Vertex(body, corner(k)),
        Part::Edge(k) => {
            let (from, to) = (corner(k), corner(k + 1));
            Site::Edge(body, [from.min(to), from.max(to)])
        }
        Part::Inside => Site::Face(body, triangle),
    })
}

/// Segments by their ends.
struct Chains {
    segments: Vec<Segment>,
    /// Segments at each end, ascending.
    at: Vec<Vec<usize>>,
    is_used: Vec<bool>,
}

impl Chains {
    fn of(segments: Vec<Segment>, ends: usize) -> Chains {
        let mut at = vec![Vec::new(); ends];
        for (number, segment) in segments.iter().enumerate() {
            segment.ends.iter().for_each(|&end| at[end].push(number));
        }
        Chains { is_used: vec![false; segments.len()], segments, at }
    }

    /// Whether exactly one segment continues another one at an end.
    fn is_passed(&self, end: usize) -> bool {
        self.at[end].len() == 2
    }

    /// Chains all segments: those that begin at an end of a curve, along their direction if
    /// possible, then those of closed curves.
    fn curves(mut self, geometry: &[PairGeometry], row_groups: Vec<Option<u32>>) -> Curves {
        let mut curves = Curves { starts: vec![0], row_groups, ..Curves::default() };
        for is_along in [true, false] {
            for number in 0..self.segments.len() {
                let from = self.segments[number].ends[usize::from(!is_along)];
                if !self.is_used[number] && !self.is_passed(from) {
                    self.walk(number, from, geometry, &mut curves);
                }
            }
        }
        for number in 0..self.segments.len() {
            if !self.is_used[number] {
                self.walk(number, self.segments[number].ends[0], geometry, &mut curves);
            }
        }
        curves
    }

    /// Adds the curve that begins with a segment at one of its ends.
    fn walk(&mut self, first: usize, from: usize, geometry: &[PairGeometry], curves: &mut Curves) {
        let (mut number, mut end) = (first, from);
        loop {
            let Segment { row, ends } = self.segments[number];
            let is_back = usize::from(ends[0] != end);
            let points = geometry[row as usize].ends.unwrap_or_default();
            if number == first {
                curves.points.push(points[is_back]);
            }
            curves.points.push(points[1 - is_back]);
            curves.rows.push(row);
            self.is_used[number] = true;
            end = ends[1 - is_back];
            let next = self.at[end].iter().copied().find(|&next| !self.is_used[next]);
            match next {
                Some(next) if self.is_passed(end) => number = next,
                _ => break,
            }
        }
        curves.is_closed.push(end == from);
        curves.starts.push(curves.points.len());
        let row = self.segments[first].row as usize;
        curves.groups.push(curves.row_groups[row].unwrap_or_default());
    }
}

/// Rows that are joined.
struct Groups(Vec<usize>);

impl Groups {
    fn of(rows: usize) -> Groups {
        Groups((0..rows).collect())
    }

    /// The first row of a row's group.
    fn first(&mut self, mut row: usize) -> usize {
        while self.0[row] != row {
            self.0[row] = self.0[self.0[row]];
            row = self.0[row];
        }
        row
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// Numbers of the groups of some rows, ascending by their first rows.
    fn numbered(mut self, has_group: impl Fn(usize) -> bool) -> Vec<Option<u32>> {
        let (mut count, mut numbers) = (0, vec![None; self.0.len()]);
        for row in (0..self.0.len()).filter(|&row| has_group(row)) {
            let first = self.first(row);
            if first == row {
                numbers[row] = Some(count);
                count += 1;
            }
            numbers[row] = numbers[first];
        }
        numbers
    }
}
