//! Meshes of files: opening, the choice of the reader, and what a file has beside a mesh.

use crate::file::{self, encoding, is_packed};
use crate::note::{Note, Notes, Treated};
use crate::polygons::{Fans, Polygons};
use crate::{cut, obj, ply};
use nearmiss::Error;
use nearmiss::mesh::{Mesh, Positions, Problem};
use std::path::Path;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Stanford PLY: ascii, binary little-endian or big-endian.
    Ply,
    /// Wavefront OBJ: `v` and `f`; other keywords of the format are skipped, and all else is
    /// counted by [`MeshFile::notes`].
    Obj,
}

impl Format {
    /// The format that the extension names, whatever its case: of `.ply.gz` that of `.ply`.
    ///
    /// # Errors
    /// [`Problem::UnknownExtension`].
    pub fn of(path: &Path) -> Result<Format, Problem> {
        let inner = is_packed(path).then(|| path.with_extension(""));
        let path = inner.as_deref().unwrap_or(path);
        let found = path.extension().unwrap_or_default().to_string_lossy();
        match found.to_ascii_lowercase().as_str() {
            "ply" => Ok(Format::Ply),
            "obj" => Ok(Format::Obj),
            _ => Err(Problem::UnknownExtension { found: found.into_owned() }),
        }
    }
}

/// A mesh file as it was read: a mesh, the faces of the file behind its triangles, and notes.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    mesh: Mesh,
    polygons: Polygons,
    notes: Vec<Note>,
}

impl MeshFile {
    /// Reads a `.ply` or `.obj` file, also with `.gz` behind the name.
    ///
    /// A polygon of n corners becomes n - 2 triangles, in file order; [`MeshFile::file_face`]
    /// returns the face of a triangle. A polygon is cut as it is seen along the axis on which its
    /// normal is longest, with exact signs: into the fan around its first corner if that covers it
    /// once (every convex polygon), else by ears. A polygon without area, on a line or there and
    /// back, keeps its fan, which has all its edges; so does one that is not flat (a corner off the
    /// plane by a thousandth of its extent) and crosses itself as it is seen. Corners may touch; a
    /// hole may be joined by an edge there and back.
    ///
    /// A flat polygon that crosses itself is cut as a fan too, which covers all that it winds
    /// around, and may cover more. A face of fewer than three corners is left out.
    /// [`MeshFile::notes`] counts both, and all else that was not read; [`MeshFile::strict`]
    /// refuses them. A byte order mark of UTF-8 is skipped; UTF-16 and UTF-32 are refused.
    ///
    /// Cost: O(n log n) for usual polygons, O(n^2) for bad ones. Memory: the file, the mesh, and at
    /// most a small multiple of the file on the way, whatever its header promises.
    ///
    /// # Errors
    /// [`Error::Input`], naming the file, the element and the value: a file that cannot be read or
    /// is no regular file, an unknown extension, a malformed file, a mesh that fails [`Mesh::new`],
    /// one without triangles, or a polygon of more than 131,072 corners whose fan is wrong
    /// ([`Problem::FaceCorners`]). [`Error::OutOfMemory`] for a file that is too large for the
    /// memory there is.
    pub fn read(path: &Path) -> Result<MeshFile, Error> {
        let (file, format, bytes) = open(path)?;
        MeshFile::parse(file, format, &bytes)
    }

    /// Reads another frame of this mesh: a file with the same faces, cut as here, wherever their
    /// corners have moved.
    ///
    /// Frames that are read one by one may be cut differently, if a polygon's first corner no
    /// longer sees it whole; [`MeshFile::cut_as`] makes them alike.
    ///
    /// # Errors
    /// As [`MeshFile::read`], except for polygons, which are cut as here; and those of
    /// [`MeshFile::cut_as`].
    pub fn read_frame(&self, path: &Path) -> Result<MeshFile, Error> {
        let (file, format, bytes) = open(path)?;
        self.parse_frame(file, format, &bytes)
    }

    /// Reads a mesh from the bytes of a file; `name` stands in messages. As [`MeshFile::read`]
    /// otherwise.
    ///
    /// # Errors
    /// As [`MeshFile::read`], except for the file itself.
    pub fn parse(name: impl Into<String>, format: Format, bytes: &[u8]) -> Result<MeshFile, Error> {
        let file = fans(name.into(), format, bytes)?;
        if file.polygons.is_empty() {
            return Ok(file);
        }
        let MeshFile { mesh, mut polygons, mut notes } = file;
        let (name, positions, mut faces) = mesh.into_parts();
        match cut::cut(&positions, &mut faces, &mut polygons) {
            Ok(of_cut) => notes.extend(of_cut.of(&name)),
            Err(problem) => return Err(Error::Input { file: name, problem }),
        }
        Ok(MeshFile { mesh: Mesh::new(name, positions, faces)?, polygons, notes })
    }

    /// Reads another frame of this mesh from the bytes of a file. As [`MeshFile::read_frame`]
    /// otherwise.
    ///
    /// # Errors
    /// As [`MeshFile::read_frame`], except for the file itself.
    pub fn parse_frame(
        &self,
        name: impl Into<String>,
        format: Format,
        bytes: &[u8],
    ) -> Result<MeshFile, Error> {
        fans(name.into(), format, bytes)?.cut_as(self)
    }

    /// This mesh with the triangles of another file of the same faces, so that both are frames of
    /// one body; [`Body::moving`](nearmiss::Body::moving) takes only such.
    ///
    /// Notes that the first frame has too are dropped, and those of faces that were cut as a fan:
    /// this frame is cut as the first.
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::FrameVertices`], [`Problem::FrameFaces`] or
    /// [`Problem::FrameFace`]: the first face of the file that differs.
    pub fn cut_as(self, first: &MeshFile) -> Result<MeshFile, Error> {
        if let Some(problem) = difference(first, &self) {
            return Err(Error::Input { file: self.mesh.name().to_owned(), problem });
        }
        let MeshFile { mut mesh, mut notes, .. } = self;
        if mesh.faces() != first.mesh.faces() {
            let (name, positions, _) = mesh.into_parts();
            mesh = Mesh::new(name, positions, first.mesh.faces().to_vec())?;
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

    /// The faces of the file, for the triangles of an answer.
    pub fn polygons(&self) -> &Polygons {
        &self.polygons
    }

    /// The face of the file that a triangle is part of, as [`Polygons::file_face`].
    pub fn file_face(&self, triangle: u32) -> u32 {
        self.polygons.file_face(triangle)
    }

    /// Number of faces in the file, [`Mesh::face_count`] if every face was a triangle.
    pub fn file_face_count(&self) -> usize {
        self.polygons.count(self.mesh.face_count())
    }

    /// Notes of the reader, one a kind of part: empty if the mesh is all that its file says.
    ///
    /// A frame that was read by [`MeshFile::read_frame`] has those notes that its first frame does
    /// not have.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Refuses a mesh whose reader left [notes](MeshFile::notes); returns any other as it is.
    ///
    /// # Errors
    /// [`Error::Input`] with the first part of the first note: [`Problem::FaceCrosses`],
    /// [`Problem::FaceFolds`], a face of fewer than three corners, or a line or an element that no
    /// reader knows.
    pub fn strict(self) -> Result<MeshFile, Error> {
        match self.notes.first() {
            Some(Note { file, first, .. }) => {
                Err(Error::Input { file: file.clone(), problem: first.clone() })
            }
            None => Ok(self),
        }
    }
}

/// What a reader of a format makes of a file.
pub(crate) struct Parsed {
    pub positions: Positions,
    pub fans: Fans,
    pub notes: Notes,
}

/// The mesh of a file, every polygon still a fan.
fn fans(name: String, format: Format, bytes: &[u8]) -> Result<MeshFile, Error> {
    let parsed = encoding::utf8(bytes).and_then(|bytes| match format {
        Format::Ply => ply::read::read(bytes),
        Format::Obj => obj::read(bytes),
    });
    let Parsed { positions, fans, notes } = match parsed {
        Ok(parsed) => parsed,
        Err(problem) => return Err(Error::Input { file: name, problem }),
    };
    let mesh = Mesh::new(name, positions, fans.faces)?;
    mesh.require_triangles()?;
    let notes = notes.of(mesh.name());
    Ok(MeshFile { mesh, polygons: fans.polygons, notes })
}

/// The first difference that keeps two files from being frames of one mesh. Polygons are the same
/// if their corners are, however they were cut.
fn difference(t0: &MeshFile, t1: &MeshFile) -> Option<Problem> {
    let first = || t0.mesh.name().to_owned();
    let [count_t0, count_t1] = [t0, t1].map(|file| file.mesh.vertex_count());
    if count_t0 != count_t1 {
        return Some(Problem::FrameVertices { first: first(), t0: count_t0, t1: count_t1 });
    }
    if t0.mesh.faces() == t1.mesh.faces() {
        return None;
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
    })?;
    Some(Problem::FrameFace { first: first(), face, t0: corners_t0, t1: corners_t1 })
}

/// Name, format and bytes of a file.
fn open(path: &Path) -> Result<(String, Format, Vec<u8>), Error> {
    let file = path.display().to_string();
    let format = Format::of(path).map_err(|problem| Error::Input { file: file.clone(), problem })?;
    Ok((file, format, file::read(path, MULTIPLE)?))
}

/// Most bytes of memory that a byte of a file takes, the file itself with it: texts of short numbers take most.
const MULTIPLE: u64 = 8;
