//! Any bytes, to all readers: a mesh that the door lets in again and that has a sound topology, or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nearmiss::mesh::{Mesh, Topology, check};
use nearmiss_io::{Format, MeshFile, Note, Treated};

fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Ply, Format::Obj, Format::Stl, Format::Off, Format::Gltf] {
        match MeshFile::parse("fuzz", format, bytes) {
            Ok(file) => {
                assert!(file.notes().iter().all(|note| note.count > 0 && note.to_string().starts_with("fuzz: ")));
                let is_welded = |note: &Note| matches!(note.treated, Treated::Welded { .. });
                assert_eq!(file.notes().iter().all(is_welded), file.clone().strict().is_ok());
                let mesh = file.into_mesh();
                let again = Mesh::new("again", mesh.positions().clone(), mesh.faces().to_vec());
                let again = again.and_then(|again| again.with_edges(mesh.edges().to_vec()));
                let again = again.and_then(|again| again.with_points(mesh.points().to_vec()));
                assert!(again.is_ok(), "the door refuses what it let in");
                let topology = Topology::new(mesh.faces(), mesh.vertex_count());
                assert_eq!(check(&topology, mesh.faces()), Ok(()));
            }
            Err(error) => assert!(error.to_string().starts_with("fuzz: ")),
        }
    }
});
