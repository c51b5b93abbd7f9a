//! Any bytes, to both readers: a mesh that the door lets in again and that has a sound topology, or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nearmiss::mesh::{Format, Mesh, Topology, check};

fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Ply, Format::Obj] {
        match Mesh::parse("fuzz", format, bytes) {
            Ok(mesh) => {
                let again = Mesh::new("again", mesh.positions().clone(), mesh.faces().to_vec());
                assert!(again.is_ok(), "the door refuses what it let in");
                assert!(mesh.notes().iter().all(|note| note.count > 0 && note.to_string().starts_with("fuzz: ")));
                assert_eq!(mesh.notes().is_empty(), mesh.clone().strict().is_ok());
                let topology = Topology::new(mesh.faces(), mesh.vertex_count());
                assert_eq!(check(&topology, mesh.faces()), Ok(()));
            }
            Err(error) => assert!(error.to_string().starts_with("fuzz: ")),
        }
    }
});
