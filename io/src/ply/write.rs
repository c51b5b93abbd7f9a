//! Meshes to PLY files.

use nearmiss::Error;
use nearmiss::mesh::{Mesh, Positions};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a mesh as binary little-endian PLY, floats or doubles as they are. Edges and points are
/// the element `edge`; a point is an edge from its vertex to itself.
/// [`MeshFile::read`](crate::MeshFile::read) returns an equal mesh, bit by bit. Replaces the file.
///
/// # Errors
/// [`Error::Output`] with the operating system's text.
pub fn write_ply(mesh: &Mesh, path: &Path) -> Result<(), Error> {
    let write = || {
        let mut out = BufWriter::new(std::fs::File::create(path)?);
        encode_ply(mesh, &mut out)?;
        out.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        Ok(())
    };
    write().map_err(|error: std::io::Error| Error::Output {
        file: path.display().to_string(),
        text: error.to_string(),
    })
}

/// Writes the bytes of such a file to `out`, in small pieces: pass a buffered writer.
///
/// # Errors
/// Errors of `out`.
pub fn encode_ply(mesh: &Mesh, out: &mut impl Write) -> std::io::Result<()> {
    encode(mesh, out, |_| None)
}

/// The same with one colour per triangle: `red`, `green` and `blue` of the element `face`, as PLY
/// viewers read them.
///
/// # Errors
/// [`std::io::ErrorKind::InvalidInput`] unless there are as many colours as triangles; errors of
/// `out`.
pub fn encode_ply_coloured(mesh: &Mesh, out: &mut impl Write, colours: &[[u8; 3]]) -> std::io::Result<()> {
    if colours.len() != mesh.face_count() {
        let text =
            format!("one colour per triangle is needed, got {} for {}", colours.len(), mesh.face_count());
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, text));
    }
    encode(mesh, out, |face| Some(colours[face]))
}

/// Writes the header, the vertices, the faces, each with its colour, and the edges. Either all faces
/// have a colour, or none.
fn encode(
    mesh: &Mesh,
    out: &mut impl Write,
    colour: impl Fn(usize) -> Option<[u8; 3]>,
) -> std::io::Result<()> {
    let kind = if mesh.positions().is_f64() { "double" } else { "float" };
    write!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.vertex_count())?;
    for axis in ['x', 'y', 'z'] {
        writeln!(out, "property {kind} {axis}")?;
    }
    write!(out, "element face {}\nproperty list uchar uint vertex_indices\n", mesh.face_count())?;
    if mesh.face_count() > 0 && colour(0).is_some() {
        ["red", "green", "blue"].iter().try_for_each(|name| writeln!(out, "property uchar {name}"))?;
    }
    let loose = mesh.edges().len() + mesh.points().len();
    if loose > 0 {
        write!(out, "element edge {loose}\nproperty uint vertex1\nproperty uint vertex2\n")?;
    }
    out.write_all(b"end_header\n")?;
    match mesh.positions() {
        Positions::F32(points) => {
            points.iter().flatten().try_for_each(|x| out.write_all(&x.to_le_bytes()))?
        }
        Positions::F64(points) => {
            points.iter().flatten().try_for_each(|x| out.write_all(&x.to_le_bytes()))?
        }
    }
    for (at, face) in mesh.faces().iter().enumerate() {
        out.write_all(&[3])?;
        face.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))?;
        colour(at).map_or(Ok(()), |colour| out.write_all(&colour))?;
    }
    let points = mesh.points().iter().map(|&point| [point; 2]);
    let mut ends = mesh.edges().iter().copied().chain(points).flatten();
    ends.try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))
}
