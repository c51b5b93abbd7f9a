//! Notes of a reader: parts of a file that the mesh has differently.

use nearmiss::mesh::{ObjProblem, Problem};
use nearmiss::words::counted;
use std::fmt;

/// A note of a reader: parts of one kind that the mesh lacks or has differently, counted.
///
/// Its text has the file, the count, the treatment, and the first of them.
/// [`MeshFile::strict`](crate::MeshFile::strict) turns it into an error.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// The file, as [`Error::Input`](nearmiss::Error::Input) names it.
    pub file: String,
    /// Treatment by the reader.
    pub treated: Treated,
    /// Number of parts: at least one.
    pub count: u64,
    /// The first of them in the file, as [`MeshFile::strict`](crate::MeshFile::strict) reports it.
    pub first: Problem,
}

/// Treatment of a part of a file that the reader could not keep unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Treated {
    /// A face that crosses itself was cut as a fan around its first corner. The fan covers every
    /// point that the face winds around, and has all its edges. So no contact is missed, and there
    /// may be more at points that only the fan covers.
    Fan,
    /// A face of fewer than three corners was left out; later faces keep their numbers. So was a line
    /// of one vertex.
    LeftOut,
    /// Geometry of other kinds was not read: curves and surfaces of OBJ, elements of PLY, strips of
    /// fewer vertices than a triangle has, further scenes of glTF.
    NotRead,
    /// Corners with equal coordinates became one vertex: the format has no shared vertices. It is how
    /// such a file is read, and [`MeshFile::strict`](crate::MeshFile::strict) allows it.
    Welded {
        /// Number of vertices.
        vertices: u64,
    },
    /// A line whose first word is not a keyword of the format was skipped.
    Unknown,
}

impl Note {
    /// Whether both notes are equal, except for their files.
    pub(crate) fn is_as(&self, other: &Note) -> bool {
        (self.treated, self.count, &self.first) == (other.treated, other.count, &other.first)
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Note { file, treated, count, first } = self;
        let (one, many) = match (treated, first) {
            (Treated::LeftOut, Problem::Obj(first)) if matches!(**first, ObjProblem::ShortLine { .. }) => {
                ("part", "parts")
            }
            (Treated::Fan | Treated::LeftOut, _) => ("face", "faces"),
            (_, Problem::Ply(_)) => ("entry", "entries"),
            (Treated::NotRead, Problem::Scene { .. }) => ("part", "parts"),
            _ => ("line", "lines"),
        };
        let corners = counted(*count, "corner was", "corners were");
        let done = match treated {
            Treated::Welded { vertices } => {
                let vertices = counted(*vertices, "vertex", "vertices");
                return write!(f, "{file}: {corners} welded to {vertices} by equal coordinates: {first}");
            }
            Treated::Fan => "cut as a fan around the first corner",
            Treated::LeftOut => "left out",
            Treated::NotRead => "not read",
            Treated::Unknown => "skipped",
        };
        let verb = if *count == 1 { "was" } else { "were" };
        write!(f, "{file}: {} {verb} {done}; the first: {first}", counted(*count, one, many))
    }
}

/// Notes while a file is read, without its name.
#[derive(Debug, Default)]
pub(crate) struct Notes(Vec<(Treated, u64, Problem)>);

impl Notes {
    /// Counts one part; `first` is called for the first of its kind.
    pub fn add(&mut self, treated: Treated, first: impl FnOnce() -> Problem) {
        self.add_many(treated, 1, first);
    }

    /// Counts parts.
    pub fn add_many(&mut self, treated: Treated, count: u64, first: impl FnOnce() -> Problem) {
        match self.0.iter_mut().find(|note| note.0 == treated) {
            Some(note) => note.1 += count,
            None => self.0.push((treated, count, first())),
        }
    }

    /// The notes of a file.
    pub fn of(self, file: &str) -> Vec<Note> {
        let note = |(treated, count, first)| Note { file: file.to_owned(), treated, count, first };
        self.0.into_iter().map(note).collect()
    }
}
