//! The first words of the lines of an OBJ file: those of the specification (version 3.0, with
//! superseded ones), and others.

/// Treatment of a line by a reader of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Word {
    Vertex,
    Face,
    /// Segments from each corner to the next.
    Line,
    /// Points.
    Point,
    /// Without a surface, and makes none: names, materials, texture coordinates, normals, display.
    Quiet,
    /// With geometry that is not read: curves, surfaces, another file.
    Element,
    /// No word of the specification, but similar to `v` or `f`: a vertex or a face may be lost with
    /// it.
    Misspelt,
    Unknown,
}

/// Statements without geometry, by the chapters of the specification. These are vertex data,
/// attributes and parts of free-form curves and surfaces, connectivity, grouping, display, and
/// superseded ones.
const QUIET: [&[u8]; 32] = [
    b"vt",
    b"vn",
    b"vp",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"curv2",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"g",
    b"s",
    b"mg",
    b"o",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"res",
];

/// Statements with geometry that is not read; `call` and `csh` insert the output of another file or
/// program.
const ELEMENTS: [&[u8]; 8] = [b"curv", b"surf", b"bsp", b"bzp", b"cdc", b"cdp", b"call", b"csh"];

impl Word {
    pub fn of(word: &[u8]) -> Word {
        match word {
            b"v" => Word::Vertex,
            // Versions before 3.0 had `fo` for a face.
            b"f" | b"fo" => Word::Face,
            b"l" => Word::Line,
            b"p" => Word::Point,
            _ if QUIET.contains(&word) => Word::Quiet,
            _ if ELEMENTS.contains(&word) => Word::Element,
            _ if is_nearly(word) => Word::Misspelt,
            _ => Word::Unknown,
        }
    }
}

/// Whether the only letter of a word is `v` or `f`, in either case: `V`, `v:`, `v1.0`, also after a
/// Unicode mark or space.
fn is_nearly(word: &[u8]) -> bool {
    let text = String::from_utf8_lossy(word);
    let mut letters = text.chars().filter(|c| c.is_alphabetic());
    matches!((letters.next(), letters.next()), (Some('v' | 'V' | 'f' | 'F'), None))
}
