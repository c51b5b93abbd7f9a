//! Problems of PLY files.

/// Problem of a PLY file. Header lines count from 1; entries, faces and corners from 0.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the message of each variant says what it and its fields are")]
pub enum PlyProblem {
    #[error("does not begin with the line \"ply\" but with {found:?}: it is no PLY file, or damaged")]
    NotPly { found: String },
    #[error("its header has no end_header line ({lines} lines read): the file is cut short or damaged")]
    HeaderCut { lines: usize },
    #[error("header line {line} is not UTF-8: {found:?}; correct or remove the line")]
    HeaderText { line: usize, found: String },
    #[error(
        "header line {line} has the format {found:?}; known are ascii, binary_little_endian and \
         binary_big_endian, each 1.0: convert the file"
    )]
    Format { line: usize, found: String },
    #[error("its header has no format line; add one after the line \"ply\"")]
    NoFormat,
    #[error(
        "header line {line} begins with {found:?}; known are format, comment, obj_info, element, property"
    )]
    Keyword { line: usize, found: String },
    #[error("header line {line} is {found:?}, which is not of the form \"{form}\": correct it")]
    Form { line: usize, found: String, form: &'static str },
    #[error(
        "header line {line}: the count of element {element} is {found:?}; it must be a whole number, 0 or more"
    )]
    Count { line: usize, element: String, found: String },
    #[error("header line {line} declares {what} {name} a second time: remove or rename one")]
    Twice { line: usize, what: &'static str, name: String },
    #[error("header line {line} has a property before the first element: name its element first")]
    Orphan { line: usize },
    #[error(
        "header line {line}: unknown type {found:?}; known are char, uchar, short, ushort, int, uint, float, double \
         and int8 to float64"
    )]
    TypeName { line: usize, found: String },
    #[error(
        "header line {line}: the list {property} has {found} for its {what}; it must be a whole-number type"
    )]
    ListType { line: usize, property: String, what: &'static str, found: &'static str },
    #[error("its header has no element vertex: nothing to read")]
    NoVertices,
    #[error("its element vertex has no property {axis}; x, y and z are needed")]
    NoCoordinate { axis: char },
    #[error("its vertex property {axis} is a list; it must be a single number")]
    ListCoordinate { axis: char },
    #[error(
        "its element face has no list vertex_indices (or vertex_index); the corners of each face are needed"
    )]
    NoCorners,
    #[error("its element face has both vertex_indices and vertex_index: remove one")]
    TwoCorners,
    #[error(
        "its header declares {count} entries of element {element}, at least {need} bytes, but {left} bytes are left: \
         the header is wrong or the file is cut short"
    )]
    Promise { element: String, count: u64, need: u128, left: usize },
    #[error("ends inside element {element} {index}, at property {property}: the file is cut short")]
    Cut { element: String, index: u64, property: String },
    #[error("element {element} {index} ends its line before property {property}: add the value")]
    ShortLine { element: String, index: u64, property: String },
    #[error(
        "element {element} {index} has {found:?} after its last property: remove it, or declare it in the header"
    )]
    LongLine { element: String, index: u64, found: String },
    #[error("element {element} {index}: property {property} is {found:?}, which is no {kind}: correct it")]
    Number { element: String, index: u64, property: String, found: String, kind: &'static str },
    #[error("element {element} {index}: the list {property} has the length {found}; it must be 0 or more")]
    NegativeLength { element: String, index: u64, property: String, found: i64 },
    #[error(
        "element {element} {index}: the list {property} has the length {length}, at least {need} bytes, but {left} \
         bytes are left: the length is wrong or the file is cut short"
    )]
    Length { element: String, index: u64, property: String, length: u64, need: u128, left: usize },
    #[error("face {face} has {corners} corners; at least 3 are needed: remove the face or give its corners")]
    Corners { face: u64, corners: u64 },
    #[error(
        "its element {element}, of {count} entries, is not read; only vertex, face, tristrips and edge (vertex1, \
         vertex2) are: convert it, or remove it"
    )]
    Unread { element: String, count: u64 },
    #[error("face {face} corner {corner} names vertex {index}; an index must be 0 or more: correct it")]
    NegativeIndex { face: u64, corner: u64, index: i64 },
    #[error(
        "face {face} corner {corner} names vertex {index}, but there are {vertices} vertices, counted from 0: correct \
         the index or remove the face"
    )]
    Index { face: u64, corner: u64, index: i64, vertices: u64 },
    #[error(
        "edge {edge} names vertex {index}, but there are {vertices} vertices, counted from 0: correct the index or \
         remove the edge"
    )]
    End { edge: u64, index: i64, vertices: u64 },
    #[error("has {bytes} bytes after its last element: correct the counts in the header or remove the bytes")]
    Trailing { bytes: usize },
    #[error("has {found:?} after its last element: correct the counts in the header or remove the text")]
    TrailingText { found: String },
}
