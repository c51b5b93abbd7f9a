//! What can be wrong with an input, each message with its element, its value and what to do.

use super::{ObjProblem, PlyProblem};

/// What is wrong with a mesh, a pair of frames or a scene name. The file is named by [`crate::Error::Input`].
///
/// Vertices, faces and corners count from 0; lines of a file from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file could not be read; the text is the operating system's.
    #[error("cannot be read: {reason}; check the path, its kind and its permissions")]
    Unreadable {
        /// The operating system's words.
        reason: String,
    },
    /// The file was packed by gzip and is damaged.
    #[error("its gz data cannot be unpacked: {reason}; copy the file again, or pack it again")]
    Packed {
        /// The unpacker's words.
        reason: String,
    },
    /// The file is text in another encoding than UTF-8.
    #[error("is text in {found}, and only UTF-8 is read: save it as UTF-8")]
    Encoding {
        /// The encoding, by the file's first bytes.
        found: &'static str,
    },
    /// The extension names no reader.
    #[error("has the extension {found:?}, which no reader knows; give a .ply or an .obj file")]
    UnknownExtension {
        /// The extension without its dot; empty if there is none.
        found: String,
    },
    /// A vertex that a face uses is NaN or infinite.
    #[error(
        "vertex {vertex} has {axis} = {value}; a vertex that a face uses must be finite: mend it, or remove its faces"
    )]
    NonFinite {
        /// Index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// NaN or an infinity.
        value: f64,
    },
    /// A vertex that a face uses is larger than arithmetic in double precision allows.
    #[error(
        "vertex {vertex} has {axis} = {}; coordinates may be at most {limit} in size: scale the mesh down",
        short(*value)
    )]
    TooLarge {
        /// Index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// The coordinate.
        value: f64,
        /// The limit, in words.
        limit: &'static str,
    },
    /// A pose of a rigid body that is no motion.
    #[error(
        "has the pose {rotation:?} + {translation:?}; give a unit quaternion (x, y, z, w) and a finite translation"
    )]
    NoPose {
        /// The quaternion as given.
        rotation: [f64; 4],
        /// The translation as given.
        translation: [f64; 3],
    },
    /// A pose that takes a body out of the range of coordinates.
    #[error(
        "has a pose that takes it to coordinates of {size:e}; they may be at most 2^480 in size: move it nearer"
    )]
    PoseTooFar {
        /// The largest coordinate, rounded up.
        size: f64,
    },
    /// A face names a vertex that does not exist.
    #[error(
        "face {face} corner {corner} names vertex {index}, but there are {vertices} vertices, counted from 0: \
         correct the index or remove the face"
    )]
    IndexOutOfRange {
        /// Index of the face.
        face: usize,
        /// Corner in the face.
        corner: usize,
        /// The index as given.
        index: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More vertices or triangles than index arithmetic allows.
    #[error("has {count} {what}, and at most {limit} fit the index arithmetic: split the mesh")]
    TooMany {
        /// `vertices` or `triangles`.
        what: &'static str,
        /// How many.
        count: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// No triangles where some are needed.
    #[error("has no triangles, and some are needed: give a mesh with at least one face")]
    NoTriangles,
    /// Two frames of one body with different numbers of vertices.
    #[error(
        "has {t1} vertices, but the first frame, {first}, has {t0}: two frames of one body must have the same vertices"
    )]
    FrameVertices {
        /// Name of the first frame.
        first: String,
        /// Vertices at t0.
        t0: usize,
        /// Vertices at t1.
        t1: usize,
    },
    /// Two frames of one body with different numbers of faces.
    #[error(
        "has {t1} faces, but the first frame, {first}, has {t0}: two frames of one body must have the same faces"
    )]
    FrameFaces {
        /// Name of the first frame.
        first: String,
        /// Faces at t0.
        t0: usize,
        /// Faces at t1.
        t1: usize,
    },
    /// Two frames of one body whose faces differ.
    #[error(
        "face {face} is {}, but in the first frame, {first}, it is {}: two frames of one body must have the same \
         faces in the same order",
        listed(t1),
        listed(t0)
    )]
    FrameFace {
        /// Name of the first frame.
        first: String,
        /// The first face that differs, of the file if both are of files.
        face: usize,
        /// Its corners at t0.
        t0: Vec<u32>,
        /// Its corners at t1.
        t1: Vec<u32>,
    },
    /// A polygon two of whose edges cross, seen along the axis on which its normal is longest.
    #[error(
        "face {face}, with {corners} corners, crosses itself: its edges between the vertices {} and {}, and {} and \
         {}; put its corners in order around it, or split it",
        edges[0][0], edges[0][1], edges[1][0], edges[1][1]
    )]
    FaceCrosses {
        /// Index of the face in the file.
        face: usize,
        /// How many corners it has.
        corners: usize,
        /// The ends of both edges.
        edges: [[u32; 2]; 2],
    },
    /// A polygon with too many corners, of which the fan is wrong.
    #[error(
        "face {face} has {corners} corners and must be cut by ears, which is done for at most {limit}: split it"
    )]
    FaceCorners {
        /// Index of the face in the file.
        face: usize,
        /// How many corners it has.
        corners: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// A polygon that no triangles cover once, though none of its edges cross.
    #[error(
        "face {face}, with {corners} corners, folds over itself: no triangles cover it once; put its corners in order \
         around it, or split it"
    )]
    FaceFolds {
        /// Index of the face in the file.
        face: usize,
        /// How many corners it has.
        corners: usize,
    },
    /// An index that is past the end.
    #[error("has no {what} {index}: it has {count} of them, counted from 0; give a smaller one")]
    NoSuch {
        /// `vertex`, `face`, `edge` or `query`.
        what: &'static str,
        /// What was asked for.
        index: u64,
        /// How many there are.
        count: u64,
    },
    /// A row of a file of queries that cannot be used.
    #[error("line {line}: {token:?} {why}; a row has three numerators and denominators, and 0 or 1")]
    QueryRow {
        /// The line, counted from 1.
        line: usize,
        /// What is wrong.
        token: String,
        /// Why.
        why: &'static str,
    },
    /// A file of a scene that cannot be used.
    #[error("{what}; {advice}")]
    Scene {
        /// The body, the key and the value.
        what: String,
        /// What to do.
        advice: String,
    },
    /// No such generated scene.
    #[error("is no scene; known are: {known}")]
    UnknownScene {
        /// The names, with commas.
        known: String,
    },
    /// A PLY file that cannot be used.
    #[error(transparent)]
    Ply(Box<PlyProblem>),
    /// An OBJ file that cannot be used.
    #[error(transparent)]
    Obj(Box<ObjProblem>),
}

// Boxed, so that a `Result` stays small.
impl From<PlyProblem> for Problem {
    fn from(problem: PlyProblem) -> Problem {
        Problem::Ply(Box::new(problem))
    }
}

impl From<ObjProblem> for Problem {
    fn from(problem: ObjProblem) -> Problem {
        Problem::Obj(Box::new(problem))
    }
}

/// The shortest text that reads back as the value: as a float where it is one.
fn short(value: f64) -> String {
    let float = value as f32;
    if f64::from(float) == value { format!("{float:e}") } else { format!("{value:e}") }
}

/// Corners as a message shows them: no more than a line's worth.
fn listed(corners: &[u32]) -> String {
    const MOST: usize = 12;
    match corners.get(..MOST) {
        Some(most) if corners.len() > MOST => format!("{most:?} and {} more", corners.len() - MOST),
        _ => format!("{corners:?}"),
    }
}
