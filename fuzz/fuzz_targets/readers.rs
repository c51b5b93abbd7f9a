//! Any bytes, to both readers: a mesh that the door lets in again and that has a sound topology, or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nearmiss::mesh::{Mesh, Topology, check};
use nearmiss_io::{Format, MeshFile};

fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Ply, Format::Obj] {
        match MeshFile::parse("fuzz", format, bytes) {
            Ok(file) => {
                assert!(file.notes().iter().all(|note| note.count > 0 && note.to_string().starts_with("fuzz: ")));
                assert_eq!(file.notes().is_empty(), file.clone().strict().is_ok());
                let mesh = file.into_mesh();
                let again = Mesh::new("again", mesh.positions().clone(), mesh.faces().to_vec());
                assert!(again.is_ok(), "the door refuses what it let in");
                let topology = Topology::new(mesh.faces(), mesh.vertex_count());
                assert_eq!(check(&topology, mesh.faces()), Ok(()));
            }
            Err(error) => assert!(error.to_string().starts_with("fuzz: ")),
        }
    }
});
