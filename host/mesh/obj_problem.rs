//! Problems of OBJ files.

/// Problem of an OBJ file. Lines count from 1; a continued line has the number of its first part.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the message of each variant says what it and its fields are")]
pub enum ObjProblem {
    #[error("line {line}: a vertex with {found} coordinates; x, y and z are needed")]
    ShortVertex { line: usize, found: usize },
    #[error(
        "line {line}: vertex {vertex} (from 0) has {found:?} after x, y and z; at most a weight and a colour of three \
         numbers may follow: correct it, or begin a new line"
    )]
    LongVertex { line: usize, vertex: usize, found: String },
    #[error(
        "line {line}: the {axis} of vertex {vertex} (from 0) is {found:?}, which is not a number: correct it"
    )]
    Number { line: usize, vertex: usize, axis: char, found: String },
    #[error(
        "line {line}: a face with {corners} corners; at least 3 are needed: remove it or give its corners"
    )]
    ShortFace { line: usize, corners: usize },
    #[error(
        "line {line}: an l with {corners} vertices; at least 2 are needed: remove it or give its vertices"
    )]
    ShortLine { line: usize, corners: usize },
    #[error(
        "line {line}: the corner {found:?} is not of the form i, i/j, i//k or i/j/k with whole numbers: correct it"
    )]
    Corner { line: usize, found: String },
    #[error("line {line}: vertex index 0; OBJ counts vertices from 1, or back from -1: correct it")]
    Zero { line: usize },
    #[error(
        "line {line}: vertex index {index} reaches before the first of the {vertices} vertices so far: correct it"
    )]
    Back { line: usize, index: i64, vertices: usize },
    #[error(
        "line {line}: vertex index {index}, but the file has {vertices} vertices, counted from 1: correct it"
    )]
    Index { line: usize, index: i64, vertices: usize },
    #[error(
        "line {line} begins with {found:?}, which is nearly v or f but is no keyword of OBJ: begin it with v for a \
         vertex, with f for a face, or with # for a comment"
    )]
    Misspelt { line: usize, found: String },
    #[error("line {line} begins with {found:?}, which is no keyword of OBJ: correct it or remove the line")]
    Word { line: usize, found: String },
    #[error(
        "line {line} begins with {found:?}, which is not read; only v, f, l and p are: give polygons, or remove the \
         line"
    )]
    Element { line: usize, found: String },
    #[error(
        "line {line} ends in a backslash, so the next line, which begins with {found:?}, is a part of it: remove the \
         backslash"
    )]
    Joined { line: usize, found: String },
    #[error("line {line} has a NUL byte; the file is not UTF-8 text: save it as UTF-8")]
    Nul { line: usize },
}

impl ObjProblem {
    /// Line of the problem, from 1.
    pub fn line(&self) -> usize {
        match self {
            ObjProblem::ShortVertex { line, .. }
            | ObjProblem::LongVertex { line, .. }
            | ObjProblem::Number { line, .. }
            | ObjProblem::ShortFace { line, .. }
            | ObjProblem::ShortLine { line, .. }
            | ObjProblem::Corner { line, .. }
            | ObjProblem::Zero { line }
            | ObjProblem::Back { line, .. }
            | ObjProblem::Index { line, .. }
            | ObjProblem::Misspelt { line, .. }
            | ObjProblem::Word { line, .. }
            | ObjProblem::Element { line, .. }
            | ObjProblem::Joined { line, .. }
            | ObjProblem::Nul { line } => *line,
        }
    }
}
