//! Mesh files: opening, the choice of the reader, and the parts of a file that are not in its mesh.

use crate::file::{self, encoding};
use crate::format::Format;
use crate::loose::Loose;
use crate::note::{Note, Notes, Treated};
use crate::polygons::{Fans, Polygons};
use crate::problems::{Problems, wrong};
use crate::shown::shown;
use crate::{cut, gltf, obj, off, ply, stl};
use nearmiss::Error;
use nearmiss::mesh::{Mesh, Positions, Problem};
use std::path::Path;

/// A mesh file as it was read: a mesh, the faces of the file, and notes.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    mesh: Mesh,
    polygons: Polygons,
    notes: Vec<Note>,
}

impl MeshFile {
    /// Reads a `.ply`, `.obj`, `.stl`, `.off`, `.gltf` or `.glb` file, also with `.gz` after the name.
    ///
    /// A polygon of n corners becomes n - 2 triangles, in file order; [`MeshFile::file_face`]
    /// returns the face of a triangle. It is projected along the axis of its normal's largest
    /// component, and cut with exact signs. The cut is the fan around its first corner if that
    /// covers it once (every convex polygon), else by ears.
    /// A polygon without area, on a line or there and back, keeps its fan, which has all its edges.
    /// So does one that is not flat (a corner off the plane by a thousandth of its extent) and
    /// whose projection crosses itself. Corners may touch; a hole may be joined by an edge there
    /// and back.
    ///
    /// Lines and points are [edges](Mesh::edges) and [points](Mesh::points) of the mesh: `l` and `p`
    /// of OBJ, the element `edge` of PLY, faces of two corners and one of OFF, and those modes of
    /// glTF.
    ///
    /// A flat polygon that crosses itself is cut as a fan too. The fan covers all that the polygon
    /// winds around, and may cover more. A face of fewer than three corners is left out.
    /// [`MeshFile::notes`] counts both, and all other parts that were not read;
    /// [`MeshFile::strict`] refuses them. A byte order mark of UTF-8 is skipped; UTF-16 and UTF-32
    /// are refused.
    ///
    /// Cost: O(n log n) for usual polygons, O(n^2) for bad ones. Memory: the file, the mesh, and
    /// temporarily at most a small multiple of the file, for any header.
    ///
    /// # Errors
    /// [`Error::Input`], with the file, the element and the value, for:
    /// - a file that cannot be read or is not regular, an unknown extension, a malformed file;
    /// - a mesh that fails [`Mesh::new`], or has no triangles, edges and points;
    /// - a polygon of more than 131,072 corners whose fan is wrong ([`Problem::FaceCorners`]).
    ///
    /// [`Error::OutOfMemory`] for a file that is too large for the memory.
    pub fn read(path: &Path) -> Result<MeshFile, Error> {
        let (file, format, bytes) = open(path)?;
        MeshFile::cut(fans((file, format, &bytes), &next_to(path), &mut Problems::of(1))?)
    }

    /// All problems for which [`MeshFile::read`] refuses a file, at most so many: one at least if it
    /// does, and none if it does not. Damage after which nothing can be understood is the last.
    ///
    /// # Errors
    /// Those of a file that cannot be opened, and [`Error::OutOfMemory`].
    pub fn problems(path: &Path, most: usize) -> Result<Vec<Problem>, Error> {
        let (file, format, bytes) = open(path)?;
        MeshFile::problems_by((file, format, &bytes), &next_to(path), most)
    }

    /// All problems in the bytes of a file. Otherwise as [`MeshFile::problems`].
    ///
    /// # Errors
    /// As there.
    pub fn parse_problems(
        name: impl Into<String>,
        format: Format,
        bytes: &[u8],
        most: usize,
    ) -> Result<Vec<Problem>, Error> {
        MeshFile::problems_by((name.into(), format, bytes), &elsewhere, most)
    }

    fn problems_by(
        (name, format, bytes): (String, Format, &[u8]),
        others: gltf::Others<'_>,
        most: usize,
    ) -> Result<Vec<Problem>, Error> {
        let mut problems = Problems::of(most);
        let parsed = match parsed(&name, (format, bytes), others, &mut problems)? {
            Ok(parsed) => parsed,
            Err(problem) => {
                problems.found.push(problem);
                return Ok(problems.found);
            }
        };
        let mut found = problems.found;
        let Parsed { mut positions, fans, loose, .. } = parsed;
        while found.len() < most {
            match made(name.clone(), positions.clone(), fans.faces.clone(), loose.clone()) {
                Ok(_) if !found.is_empty() => break,
                Ok(_) => match MeshFile::parse_by((name, format, bytes), others) {
                    Err(Error::Input { problem, .. }) => return Ok(vec![problem]),
                    done => return done.map(|_| found),
                },
                Err(Error::Input { problem, .. }) => {
                    let vertex = match problem {
                        Problem::NonFinite { vertex, .. } | Problem::TooLarge { vertex, .. } => Some(vertex),
                        _ => None,
                    };
                    // After problems of faces, faces are not whole.
                    if found.is_empty() || vertex.is_some() {
                        found.push(problem);
                    }
                    let Some(vertex) = vertex else { break };
                    match &mut positions {
                        Positions::F32(all) => all[vertex] = [0.0; 3],
                        Positions::F64(all) => all[vertex] = [0.0; 3],
                    }
                }
                Err(other) => return Err(other),
            }
        }
        Ok(found)
    }

    /// Reads another frame of this mesh: a file with the same faces. They are cut as here, even if
    /// their corners have moved.
    ///
    /// Frames that are read separately may be cut differently: a polygon may no longer be visible
    /// whole from its first corner. [`MeshFile::cut_as`] makes them alike.
    ///
    /// # Errors
    /// As [`MeshFile::read`], except for polygons, which are cut as here; and those of
    /// [`MeshFile::cut_as`].
    pub fn read_frame(&self, path: &Path) -> Result<MeshFile, Error> {
        let (file, format, bytes) = open(path)?;
        fans((file, format, &bytes), &next_to(path), &mut Problems::of(1))?.cut_as(self)
    }

    /// Reads a mesh from the bytes of a file; messages contain `name`. Otherwise as
    /// [`MeshFile::read`].
    ///
    /// # Errors
    /// As [`MeshFile::read`], except for the file itself.
    pub fn parse(name: impl Into<String>, format: Format, bytes: &[u8]) -> Result<MeshFile, Error> {
        MeshFile::parse_by((name.into(), format, bytes), &elsewhere)
    }

    fn parse_by(file: (String, Format, &[u8]), others: gltf::Others<'_>) -> Result<MeshFile, Error> {
        MeshFile::cut(fans(file, others, &mut Problems::of(1))?)
    }

    /// Cuts the polygons of a file.
    fn cut(file: MeshFile) -> Result<MeshFile, Error> {
        if file.polygons.is_empty() {
            return Ok(file);
        }
        let MeshFile { mesh, mut polygons, mut notes } = file;
        let loose = Loose::of(&mesh);
        let (name, positions, mut faces) = mesh.into_parts();
        match cut::cut(&positions, &mut faces, &mut polygons) {
            Ok(of_cut) => notes.extend(of_cut.of(&name)),
            Err(problem) => return Err(Error::Input { file: name, problem }),
        }
        Ok(MeshFile { mesh: loose.set(Mesh::new(name, positions, faces)?)?, polygons, notes })
    }

    /// Reads another frame of this mesh from the bytes of a file. Otherwise as
    /// [`MeshFile::read_frame`].
    ///
    /// # Errors
    /// As [`MeshFile::read_frame`], except for the file itself.
    pub fn parse_frame(
        &self,
        name: impl Into<String>,
        format: Format,
        bytes: &[u8],
    ) -> Result<MeshFile, Error> {
        fans((name.into(), format, bytes), &elsewhere, &mut Problems::of(1))?.cut_as(self)
    }

    /// This mesh with the triangles of another file of the same faces, so that both are frames of
    /// one body. [`Body::moving`](nearmiss::Body::moving) requires that.
    ///
    /// Notes that the first frame has too are dropped. So are those of faces that were cut as a
    /// fan: this frame is cut as the first.
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::FrameVertices`], [`Problem::FrameFaces`],
    /// [`Problem::FrameFace`] (the first face of the file that differs) or
    /// [`Problem::FrameElements`].
    pub fn cut_as(self, first: &MeshFile) -> Result<MeshFile, Error> {
        if let Some(problem) = difference(first, &self) {
            return Err(Error::Input { file: self.mesh.name().to_owned(), problem });
        }
        let MeshFile { mut mesh, mut notes, .. } = self;
        if mesh.faces() != first.mesh.faces() {
            let loose = Loose::of(&mesh);
            let (name, positions, _) = mesh.into_parts();
            mesh = loose.set(Mesh::new(name, positions, first.mesh.faces().to_vec())?)?;
        }
        notes.retain(|note| {
            note.treated != Treated::Fan && !first.notes.iter().any(|known| known.is_as(note))
        });
        Ok(MeshFile { mesh, polygons: first.polygons.clone(), notes })
    }

    /// The mesh of triangles.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The mesh of triangles, without the faces of the file and without notes.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// The faces of the file, to map the triangles of an answer to.
    pub fn polygons(&self) -> &Polygons {
        &self.polygons
    }

    /// The face of the file to which a triangle belongs, as by [`Polygons::file_face`].
    pub fn file_face(&self, triangle: u32) -> u32 {
        self.polygons.file_face(triangle)
    }

    /// Number of faces in the file: [`Mesh::face_count`] if every face was a triangle.
    pub fn file_face_count(&self) -> usize {
        self.polygons.count(self.mesh.face_count())
    }

    /// Notes of the reader, one for each kind of part: empty if the mesh is all of the file.
    ///
    /// A frame that was read by [`MeshFile::read_frame`] has those notes that its first frame does
    /// not have.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Refuses a mesh whose reader left [notes](MeshFile::notes); returns any other as it is. Corners
    /// that were welded are no reason: see [`Treated::Welded`].
    ///
    /// # Errors
    /// [`Error::Input`] with the first part of the first note. It is [`Problem::FaceCrosses`],
    /// [`Problem::FaceFolds`], a face of fewer than three corners, or a line or an element that no
    /// reader supports.
    pub fn strict(self) -> Result<MeshFile, Error> {
        match self.notes.iter().find(|note| !matches!(note.treated, Treated::Welded { .. })) {
            Some(Note { file, first, .. }) => {
                Err(Error::Input { file: file.clone(), problem: first.clone() })
            }
            None => Ok(self),
        }
    }
}

/// The contents of a file, as its format's reader returns them.
pub(crate) struct Parsed {
    pub positions: Positions,
    pub fans: Fans,
    pub loose: Loose,
    pub notes: Notes,
}

/// The contents of a file; the inner error is its last problem.
fn parsed(
    name: &str,
    (format, bytes): (Format, &[u8]),
    others: gltf::Others<'_>,
    problems: &mut Problems,
) -> Result<Result<Parsed, Problem>, Error> {
    if format == Format::Gltf {
        gltf::require(name, bytes)?;
    }
    let text = || encoding::utf8(bytes);
    Ok(match format {
        Format::Ply => text().and_then(|bytes| ply::read::read(bytes, problems)),
        Format::Obj => text().and_then(|bytes| obj::read(bytes, problems)),
        Format::Off => text().and_then(|bytes| off::read(bytes, problems)),
        // They have encodings of their own.
        Format::Stl => stl::read(bytes),
        Format::Gltf => gltf::read(bytes, others),
    })
}

/// The mesh of a file, every polygon still a fan.
fn fans(
    (name, format, bytes): (String, Format, &[u8]),
    others: gltf::Others<'_>,
    problems: &mut Problems,
) -> Result<MeshFile, Error> {
    let Parsed { positions, fans, loose, notes } = match parsed(&name, (format, bytes), others, problems)? {
        Ok(parsed) => parsed,
        Err(problem) => return Err(Error::Input { file: name, problem }),
    };
    let mesh = made(name, positions, fans.faces, loose)?;
    let notes = notes.of(mesh.name());
    Ok(MeshFile { mesh, polygons: fans.polygons, notes })
}

/// The mesh of a file; it has a face, an edge or a point.
fn made(name: String, positions: Positions, faces: Vec<[u32; 3]>, loose: Loose) -> Result<Mesh, Error> {
    let mesh = loose.set(Mesh::new(name, positions, faces)?)?;
    mesh.require_elements().map(|()| mesh)
}

/// Files that a file names, from its folder.
fn next_to(path: &Path) -> impl Fn(&str) -> Result<Vec<u8>, Problem> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    move |name| {
        file::read(&folder.join(name), MULTIPLE_WELDED).map_err(|e| {
            let text = e.to_string();
            let (what, advice) = text.split_once("; ").unwrap_or((&text, "put it next to the file"));
            wrong(what, advice)
        })
    }
}

/// Bytes have no folder in which other files are.
fn elsewhere(name: &str) -> Result<Vec<u8>, Problem> {
    let what = format!("names the file {:?}, and bytes have no folder", shown(name.as_bytes()));
    Err(wrong(what, "read it by its path, or export a .glb"))
}

/// The first difference that keeps two files from being frames of one mesh. Polygons are the same
/// if their corners are, even if they were cut differently.
fn difference(t0: &MeshFile, t1: &MeshFile) -> Option<Problem> {
    let first = || t0.mesh.name().to_owned();
    let [count_t0, count_t1] = [t0, t1].map(|file| file.mesh.vertex_count());
    if count_t0 != count_t1 {
        return Some(Problem::FrameVertices { first: first(), t0: count_t0, t1: count_t1 });
    }
    let differ = |what, is_other: bool| is_other.then(|| Problem::FrameElements { first: first(), what });
    let loose = || {
        let edges = differ("edges", t0.mesh.edges() != t1.mesh.edges());
        edges.or_else(|| differ("points", t0.mesh.points() != t1.mesh.points()))
    };
    if t0.mesh.faces() == t1.mesh.faces() {
        return loose();
    }
    let [count_t0, count_t1] = [t0, t1].map(MeshFile::file_face_count);
    if count_t0 != count_t1 {
        return Some(Problem::FrameFaces { first: first(), t0: count_t0, t1: count_t1 });
    }
    let (mut corners_t0, mut corners_t1) = (Vec::new(), Vec::new());
    let face = (0..count_t0).find(|&face| {
        t0.polygons.corners(face, t0.mesh.faces(), &mut corners_t0);
        t1.polygons.corners(face, t1.mesh.faces(), &mut corners_t1);
        corners_t0 != corners_t1
    });
    let Some(face) = face else { return loose() };
    Some(Problem::FrameFace { first: first(), face, t0: corners_t0, t1: corners_t1 })
}

/// Name, format and bytes of a file.
fn open(path: &Path) -> Result<(String, Format, Vec<u8>), Error> {
    let file = path.display().to_string();
    let format = Format::of(path).map_err(|problem| Error::Input { file: file.clone(), problem })?;
    let multiple = match format {
        Format::Stl | Format::Gltf => MULTIPLE_WELDED,
        Format::Ply | Format::Obj | Format::Off => MULTIPLE,
    };
    Ok((file, format, file::read(path, multiple)?))
}

/// Maximum memory for each byte of a file, the file itself included, in bytes. Texts of short
/// numbers need most. Corners that are welded need a table too.
const MULTIPLE: u64 = 8;
const MULTIPLE_WELDED: u64 = 24;
