//! Problems of inputs. Each message names the element and its value, and how to correct it.

use super::{MatrixProblem, ObjProblem, PlyProblem};

/// Problem of a mesh, a pair of frames or a scene name. [`crate::Error::Input`] names the file.
///
/// Vertices, faces and corners count from 0; lines of a file from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// A file that cannot be read; the text is the operating system's.
    #[error("cannot be read: {reason}; check the path, its kind and its permissions")]
    Unreadable {
        /// Text of the operating system.
        reason: String,
    },
    /// A file that was packed by gzip and is damaged.
    #[error("its gz data cannot be unpacked: {reason}; copy the file again, or pack it again")]
    Packed {
        /// Text of the unpacker.
        reason: String,
    },
    /// A text file in another encoding than UTF-8.
    #[error("is text in {found}, and only UTF-8 is read: save it as UTF-8")]
    Encoding {
        /// The encoding, by the file's first bytes.
        found: &'static str,
    },
    /// An extension without a reader.
    #[error(
        "has the extension {found:?}, which no reader of meshes knows; give a .ply, .obj, .stl, .off, .gltf \
         or .glb file"
    )]
    UnknownExtension {
        /// The extension without its dot; empty if there is none.
        found: String,
    },
    /// NaN or infinity at a vertex that a face uses.
    #[error(
        "vertex {vertex} has {axis} = {value}; a vertex that a face uses must be finite: \
         correct it, or remove its faces"
    )]
    NonFinite {
        /// Index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// NaN or an infinity.
        value: f64,
    },
    /// A coordinate of a used vertex beyond the range of double precision arithmetic.
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
    /// A pose of a rigid body that is not a rigid motion.
    #[error(
        "has the pose {rotation:?} + {translation:?}; give a unit quaternion (x, y, z, w) and a finite translation"
    )]
    NoPose {
        /// The quaternion, as passed.
        rotation: [f64; 4],
        /// The translation, as passed.
        translation: [f64; 3],
    },
    /// A matrix that is no rotation and translation.
    #[error(transparent)]
    Matrix(#[from] MatrixProblem),
    /// A pose that moves a body out of the range of coordinates.
    #[error(
        "has a pose that moves it to coordinates of {size:e}; they may be at most 2^480 in size: \
         move it closer to the origin"
    )]
    PoseTooFar {
        /// The largest coordinate, rounded up.
        size: f64,
    },
    /// A pivot or a rotation vector that is not finite, or a turn of more than a whole one.
    #[error(
        "turns by {turn:?} about {pivot:?}; give a pivot of coordinates up to 2^480 and a rotation vector of at \
         most 2 pi, in radians: divide a longer step"
    )]
    NoTurn {
        /// The pivot, as passed.
        pivot: [f64; 3],
        /// The rotation vector, as passed; zeros for the shorter arc.
        turn: [f64; 3],
    },
    /// An index of a vertex that does not exist, in a face.
    #[error(
        "face {face} corner {corner} names vertex {index}, but there are {vertices} vertices, counted from 0: \
         correct the index or remove the face"
    )]
    IndexOutOfRange {
        /// Index of the face.
        face: usize,
        /// Corner in the face.
        corner: usize,
        /// The index, as in the input.
        index: i64,
        /// Number of vertices.
        vertices: usize,
    },
    /// More vertices or triangles than index arithmetic allows.
    #[error("has {count} {what}, and at most {limit} fit the index arithmetic: split the mesh")]
    TooMany {
        /// `vertices` or `triangles`.
        what: &'static str,
        /// Number found.
        count: u64,
        /// Maximum number.
        limit: u64,
    },
    /// No triangles, edges or points, though the operation needs some.
    #[error("has no triangles, edges or points, and some are needed: give a mesh with at least one face")]
    NoElements,
    /// An index of a vertex that does not exist, in an edge or a point of the mesh's own.
    #[error(
        "{what} {at} names vertex {index}, but there are {vertices} vertices, counted from 0: \
         correct the index or remove the {what}"
    )]
    NoVertex {
        /// `edge` or `point`.
        what: &'static str,
        /// Index of the edge or point.
        at: usize,
        /// The index, as in the input.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// An edge with one vertex at both ends.
    #[error("edge {edge} has vertex {vertex} at both ends; give two vertices, or give the vertex as a point")]
    EdgeOfOneVertex {
        /// Index of the edge.
        edge: usize,
        /// The vertex.
        vertex: u32,
    },
    /// Two frames of one body whose edges or points differ.
    #[error(
        "has other {what} than the first frame, {first}: two frames of one body must have the same {what} in the \
         same order"
    )]
    FrameElements {
        /// Name of the first frame.
        first: String,
        /// `edges` or `points`.
        what: &'static str,
    },
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
        /// The first face that differs; a face of the file if both meshes come from files.
        face: usize,
        /// Its corners at t0.
        t0: Vec<u32>,
        /// Its corners at t1.
        t1: Vec<u32>,
    },
    /// A polygon with two crossing edges, projected along the axis of its normal's largest
    /// component.
    #[error(
        "face {face}, with {corners} corners, crosses itself: its edges between the vertices {} and {}, and {} and \
         {}; put its corners in order around it, or split it",
        edges[0][0], edges[0][1], edges[1][0], edges[1][1]
    )]
    FaceCrosses {
        /// Index of the face in the file.
        face: usize,
        /// Number of corners.
        corners: usize,
        /// Both ends of both edges.
        edges: [[u32; 2]; 2],
    },
    /// A polygon with too many corners whose fan is wrong.
    #[error(
        "face {face} has {corners} corners and needs ear cutting, which handles at most {limit}: split it"
    )]
    FaceCorners {
        /// Index of the face in the file.
        face: usize,
        /// Number of corners.
        corners: usize,
        /// Maximum number of corners.
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
        /// Number of corners.
        corners: usize,
    },
    /// An index beyond the end.
    #[error("has no {what} {index}: it has {count} of them, counted from 0; give a smaller index")]
    NoSuch {
        /// `vertex`, `face`, `edge` or `query`.
        what: &'static str,
        /// The index, as passed.
        index: u64,
        /// Number of items.
        count: u64,
    },
    /// A row of a file of queries that cannot be used.
    #[error("line {line}: {token:?} {why}; a row has three numerators and denominators, and 0 or 1")]
    QueryRow {
        /// The line, counted from 1.
        line: usize,
        /// The bad token.
        token: String,
        /// The reason.
        why: &'static str,
    },
    /// A scene file that cannot be used.
    #[error("{what}; {advice}")]
    Scene {
        /// The body, the key and the value.
        what: String,
        /// The remedy.
        advice: String,
    },
    /// An unknown name of a generated scene.
    #[error("is not a scene; known are: {known}")]
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

/// The shortest text that reads back as the value; a float's if the value is a float.
fn short(value: f64) -> String {
    let float = value as f32;
    if f64::from(float) == value { format!("{float:e}") } else { format!("{value:e}") }
}

/// The first corners, up to a line's worth, as a message shows them.
fn listed(corners: &[u32]) -> String {
    const MOST: usize = 12;
    match corners.get(..MOST) {
        Some(most) if corners.len() > MOST => format!("{most:?} and {} more", corners.len() - MOST),
        _ => format!("{corners:?}"),
    }
}
