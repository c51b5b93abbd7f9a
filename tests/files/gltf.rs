//! Parts of glTF files: scenes, nodes without one, and what is not read.

use super::formats::{gltf, read, refused};
use nearmiss_io::{Format, Treated};

/// The file of two squares, with these replacements.
fn with(mode: usize, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(gltf(mode), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in {text}");
        text.replacen(from, to, 1)
    })
}

const SCENES: &str = r#""scene":0,"scenes":[{"nodes":[0]}],"#;
const NODES: &str =
    r#""nodes":[{"mesh":0,"children":[1]},{"mesh":0,"translation":[10,0,0],"rotation":[0,0,1,0]}],"#;

#[test]
fn a_file_without_scenes_has_the_places_of_its_nodes() {
    let known = read(Format::Gltf, gltf(4));
    let bare = read(Format::Gltf, with(4, &[(SCENES, "")]));
    assert_eq!(
        (bare.mesh().positions(), bare.mesh().faces()),
        (known.mesh().positions(), known.mesh().faces())
    );
    let loops =
        with(4, &[(SCENES, ""), (r#"{"mesh":0,"translation""#, r#"{"mesh":0,"children":[0],"translation""#)]);
    assert!(refused(Format::Gltf, loops).contains("give each node one parent"));
    // Meshes alone are parts of their own, which are no neighbours.
    let mesh = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}"#;
    let twice = format!("{mesh},{}", mesh.trim_start_matches("\"meshes\":["));
    let alone = read(Format::Gltf, with(4, &[(SCENES, ""), (NODES, ""), (mesh, &twice)]));
    assert_eq!((alone.mesh().vertex_count(), alone.mesh().face_count()), (8, 4));
}

#[test]
fn what_is_not_read_is_noted_or_refused() {
    let strip = [
        (r#""primitives":["#, r#""primitives":[{"attributes":{"POSITION":0},"indices":2,"mode":5},"#),
        (
            r#""count":6,"type":"SCALAR"}"#,
            r#""count":6,"type":"SCALAR"},{"bufferView":1,"componentType":5123,"count":2,"type":"SCALAR"}"#,
        ),
    ];
    let scenes = [(r#"[{"nodes":[0]}]"#, r#"[{"nodes":[0]},{"nodes":[1]}]"#)];
    let instances = [(r#""scene":0,"#, r#""scene":0,"extensionsUsed":["EXT_mesh_gpu_instancing"],"#)];
    for (changes, count, said) in [
        (&strip[..], 2, "has 2 corners, and needs 3"),
        (&scenes, 1, "several scenes"),
        (&instances, 1, "EXT_mesh_gpu_instancing"),
    ] {
        let file = read(Format::Gltf, with(4, changes));
        let note = file.notes().iter().find(|note| note.treated == Treated::NotRead).expect("a note");
        assert!(note.count == count && note.to_string().contains(said), "{note}");
        assert_eq!(file.mesh().face_count(), 4, "{said}");
        assert!(file.strict().is_err(), "{said}");
    }
    let odd = with(1, &[(r#""count":6"#, r#""count":5"#)]);
    assert!(refused(Format::Gltf, odd).contains("has 5 corners, and lines have two each"));
}
