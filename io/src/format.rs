//! The formats of mesh files, by names and by first bytes.

use crate::file::is_packed;
use crate::stl;
use nearmiss::mesh::Problem;
use std::path::Path;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Stanford PLY: ascii, binary little-endian or big-endian. Elements `face` and `tristrips`.
    Ply,
    /// STL, binary or text. Corners with equal coordinates become one vertex; a note counts them.
    Stl,
    /// OFF in text, also with colours and normals, which are skipped.
    Off,
    /// glTF or GLB: the meshes of the scene, where its nodes place them. Corners of a mesh with equal
    /// coordinates become one vertex; a note counts them.
    Gltf,
    /// Wavefront OBJ: `v`, `f`, `l` and `p`. Other keywords of the format are skipped;
    /// [`MeshFile::notes`](crate::MeshFile::notes) counts all else.
    Obj,
}

impl Format {
    /// The format of an extension in any case; `.ply.gz` is PLY.
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
            "stl" => Ok(Format::Stl),
            "off" => Ok(Format::Off),
            "gltf" | "glb" => Ok(Format::Gltf),
            _ => Err(Problem::UnknownExtension { found: found.into_owned() }),
        }
    }
}

impl Format {
    /// The format of a file without a name, by its first bytes. Text that is none of the others is OBJ.
    pub fn of_bytes(bytes: &[u8]) -> Format {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        let begins = |word: &[u8]| text.get(..word.len()).is_some_and(|own| own.eq_ignore_ascii_case(word));
        let first = text.split(u8::is_ascii_whitespace).next().unwrap_or_default();
        match () {
            () if text.starts_with(b"ply") => Format::Ply,
            () if bytes.starts_with(b"glTF") || text.starts_with(b"{") => Format::Gltf,
            () if first.ends_with(b"OFF") => Format::Off,
            () if begins(b"solid") || stl::is_binary(bytes) => Format::Stl,
            () => Format::Obj,
        }
    }
}
