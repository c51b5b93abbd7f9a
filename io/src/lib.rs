//! nearmiss-io: mesh files for [`nearmiss`]. PLY, OBJ, STL, OFF and glTF are read, also packed by
//! gzip; PLY is written.
//!
//! [`MeshFile`] is a file as it was read. It has a [`Mesh`](nearmiss::Mesh) of triangles, the faces
//! of the file ([`Polygons`]), and notes of all parts that differ from the file ([`Note`]).
//! Arrays need none of this: pass them to [`Mesh::new`](nearmiss::Mesh::new).
//!
//! ```
//! use nearmiss::Body;
//! use nearmiss_io::{Format, MeshFile};
//!
//! let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let file = MeshFile::parse("square.obj", Format::Obj, square)?;
//! assert_eq!((file.mesh().face_count(), file.file_face_count()), (2, 1));
//! assert_eq!(file.file_face(1), 0);
//! for note in file.notes() {
//!     eprintln!("{note}");
//! }
//! let body = Body::deformable(file.into_mesh());
//! # assert_eq!(body.name(), "square.obj");
//! # Ok::<(), nearmiss::Error>(())
//! ```

mod cut;
pub mod file;
mod format;
mod gltf;
mod loose;
mod mesh_file;
mod note;
mod obj;
mod off;
mod ply;
mod polygons;
mod problems;
mod shown;
mod stl;
mod welded;

pub use format::Format;
pub use mesh_file::MeshFile;
pub use note::{Note, Treated};
pub use ply::{encode_ply, encode_ply_coloured, write_ply};
pub use polygons::Polygons;
