//! One mesh in each format: the same triangles, and what each format adds.

use nearmiss::mesh::Positions;
use nearmiss_io::{Format, MeshFile, Treated, encode_ply};

/// The triangles of a file by their corners, in their order; then its edges and its points.
fn triangles(file: &MeshFile) -> Vec<[[f64; 3]; 3]> {
    let (mesh, points) = (file.mesh(), file.mesh().positions().to_f64());
    let edges = mesh.edges().iter().map(|&[a, b]| [a, b, b]);
    let all = mesh.faces().iter().copied().chain(edges).chain(mesh.points().iter().map(|&p| [p; 3]));
    all.map(|face| face.map(|vertex| points[vertex as usize])).collect()
}

pub fn read(format: Format, bytes: impl AsRef<[u8]>) -> MeshFile {
    MeshFile::parse("a", format, bytes.as_ref()).unwrap_or_else(|e| panic!("{e}"))
}

pub fn refused(format: Format, bytes: impl AsRef<[u8]>) -> String {
    let error = MeshFile::parse("a", format, bytes.as_ref()).expect_err("refused");
    assert_eq!(error.exit_code(), 3, "{error}");
    error.to_string()
}

/// A binary STL.
pub fn binary_stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = b"solid of a writer that begins its binary files as text".to_vec();
    bytes.resize(80, 0);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let numbers = [[0.0; 3]].iter().chain(triangle).flatten().copied().collect::<Vec<f32>>();
        numbers.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digit = |three: &[u8], at: usize| {
        let word = three.iter().chain([&0; 3]).take(3).fold(0u32, |word, byte| word << 8 | u32::from(*byte));
        if at > three.len() { '=' } else { char::from(DIGITS[(word >> (18 - 6 * at)) as usize & 63]) }
    };
    bytes.chunks(3).flat_map(|three| (0..4).map(move |at| digit(three, at))).collect()
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

/// Points of a square, behind each other, then six indices as shorts.
fn buffer() -> Vec<u8> {
    let points = SQUARE.iter().flatten().flat_map(|x| x.to_le_bytes());
    points.chain([0u16, 1, 2, 2, 1, 3].iter().flat_map(|i| i.to_le_bytes())).collect()
}

/// The JSON of two nodes with a square each, in a mode; the second is moved and turned about z.
fn json(mode: usize, uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0,"children":[1]}},{{"mesh":0,"translation":[10,0,0],"rotation":[0,0,1,0]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
"buffers":[{{"byteLength":60{uri}}}]}}"#
    )
}

/// A glTF file with its buffer in its text.
pub fn gltf(mode: usize) -> String {
    let data = base64(&buffer());
    json(mode, &format!(r#","uri":"data:application/octet-stream;base64,{data}""#))
}

/// A GLB file.
pub fn glb(mode: usize) -> Vec<u8> {
    let (mut json, buffer) = (json(mode, "").into_bytes(), buffer());
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk =
        |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &buffer)].concat();
    [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// A tetrahedron in each format.
fn tetrahedra() -> Vec<(Format, Vec<u8>)> {
    let points = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.25]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let vertices =
        |word: &str| -> String { points.iter().map(|[x, y, z]| format!("{word}{x} {y} {z}\n")).collect() };
    let obj: String = faces.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).collect();
    let off: String = faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")).collect();
    let corners: Vec<[[f32; 3]; 3]> = faces.iter().map(|face| face.map(|v| points[v])).collect();
    let facet = |corners: &[[f32; 3]; 3]| {
        let vertices: String = corners.iter().map(|[x, y, z]| format!("  vertex {x} {y} {z}\n")).collect();
        format!(" facet normal 0 0 0\n  outer loop\n{vertices}  endloop\n endfacet\n")
    };
    let facets: Vec<String> = corners.iter().map(facet).collect();
    let obj = format!("{}{obj}", vertices("v "));
    let mut ply = Vec::new();
    encode_ply(read(Format::Obj, &obj).mesh(), &mut ply).expect("written");
    vec![
        (Format::Obj, obj.into_bytes()),
        (Format::Ply, ply),
        (Format::Off, format!("OFF\n4 4 6\n{}{off}", vertices("")).into_bytes()),
        (Format::Stl, binary_stl(&corners)),
        (Format::Stl, format!("solid\n{}endsolid\n", facets.concat()).into_bytes()),
        // Two solids, words in capitals, lines that end in CR LF.
        (
            Format::Stl,
            format!(
                "SOLID a\n{}{}endsolid a\nsolid b\n{}{}endsolid b",
                facets[0], facets[1], facets[2], facets[3]
            )
            .replace("facet", "FACET")
            .replace('\n', "\r\n")
            .into_bytes(),
        ),
    ]
}

#[test]
fn each_format_has_the_same_mesh() {
    let all = tetrahedra();
    let known = triangles(&read(all[0].0, &all[0].1));
    assert_eq!(known.len(), 4);
    for (format, bytes) in &all {
        let file = read(*format, bytes);
        assert_eq!(triangles(&file), known, "{format:?}");
        assert_eq!((file.mesh().vertex_count(), file.file_face_count()), (4, 4), "{format:?}");
        assert!(!file.mesh().positions().is_f64());
        assert_eq!(Format::of_bytes(bytes), *format);
        let welded = Treated::Welded { vertices: 4 };
        match format {
            Format::Stl => {
                let [note] = file.notes() else { panic!("{:?}", file.notes()) };
                assert_eq!((note.treated, note.count), (welded, 12));
                assert!(
                    note.to_string().starts_with("a: 12 corners were welded to 4 vertices by equal"),
                    "{note}"
                );
            }
            _ => assert!(file.notes().is_empty()),
        }
        assert!(file.strict().is_ok());
    }
}

#[test]
fn numbers_of_text_are_kept_exactly() {
    let stl = "solid\nfacet normal 0 0 0\nouter loop\nvertex 0.1 0 0\nvertex 1 0 -0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    let off = "OFF 3 1 0\n0.1 0 0\n1 0 -0\n0 1 0\n3 0 1 2\n";
    for (format, text) in [(Format::Stl, stl), (Format::Off, off)] {
        let Positions::F64(points) = read(format, text).mesh().positions().clone() else {
            panic!("{format:?}")
        };
        assert_eq!(points[0][0].to_bits(), 0.1f64.to_bits());
    }
    // Both zeros are one place.
    let two = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[-0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
    ];
    assert_eq!(read(Format::Stl, binary_stl(&two)).mesh().vertex_count(), 4);
}

#[test]
fn strips_are_triangles_that_turn_one_way() {
    let strips = |list: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
             element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
             0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n{list}\n"
        )
    };
    let of = |list: &str| read(Format::Ply, strips(list)).mesh().faces().to_vec();
    assert_eq!(of("6 0 1 2 3 4 5"), [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
    // -1 begins the next strip, and equal corners join two.
    assert_eq!(of("7 0 1 2 -1 3 4 5"), [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(of("8 0 1 2 2 3 3 4 5"), [[0, 1, 2], [4, 3, 5]]);
    assert!(refused(Format::Ply, strips("3 0 1 6")).contains("6"));
    assert!(refused(Format::Ply, strips("3 0 1 -2")).contains("-2"));
    assert!(refused(Format::Ply, strips("2 0 1")).contains("has no triangles"));
    // Vertices that make no triangle are noted.
    for list in ["5 0 1 2 -1 3", "6 0 1 -1 2 3 4", "6 3 4 -1 0 1 2"] {
        let file = read(Format::Ply, strips(list));
        let [note] = file.notes() else { panic!("{list}: {:?}", file.notes()) };
        assert_eq!((note.treated, note.count, file.mesh().face_count()), (Treated::NotRead, 1, 1), "{note}");
    }
    assert!(read(Format::Ply, strips("7 0 1 2 -1 3 4 5")).notes().is_empty());
}

#[test]
fn nodes_place_meshes_of_gltf() {
    // Half a turn about z, then 10 along x.
    let moved = |p: [f64; 3]| [10.0 - p[0], -p[1], p[2]];
    let square = SQUARE.map(|point| point.map(f64::from));
    let modes: [(usize, &[[usize; 3]]); 7] = [
        // Edges [a, b, b] and points [p, p, p], edges first.
        (0, &[[0, 0, 0], [1, 1, 1], [2, 2, 2], [2, 2, 2], [1, 1, 1], [3, 3, 3]]),
        (1, &[[0, 1, 1], [2, 2, 2], [1, 3, 3]]),
        (2, &[[0, 1, 1], [1, 2, 2], [2, 2, 2], [2, 1, 1], [1, 3, 3], [3, 0, 0]]),
        (3, &[[0, 1, 1], [1, 2, 2], [2, 2, 2], [2, 1, 1], [1, 3, 3]]),
        (4, &[[0, 1, 2], [2, 1, 3]]),
        (5, &[[0, 1, 2], [1, 2, 3]]),
        (6, &[[0, 1, 2], [0, 2, 1], [0, 1, 3]]),
    ];
    for (mode, faces) in modes {
        let first = faces.iter().map(|face| face.map(|vertex| square[vertex]));
        let known: Vec<_> = first.clone().chain(first.map(|face| face.map(moved))).collect();
        let (points, others): (Vec<_>, Vec<_>) = known.iter().partition(|face| face[0] == face[1]);
        let known = [others, points].concat();
        for file in [read(Format::Gltf, gltf(mode)), read(Format::Gltf, glb(mode))] {
            let found = triangles(&file);
            let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-5);
            let is_as = |(a, b): (&[[f64; 3]; 3], &[[f64; 3]; 3])| (0..3).all(|k| near(a[k], b[k]));
            assert!(found.len() == known.len() && found.iter().zip(&known).all(is_as), "{mode}: {found:?}");
            // The first is where it is, exactly; vertices of the two are not one.
            let first = faces.iter().map(|face| face.map(|vertex| square[vertex]));
            assert!(first.clone().all(|face| found.contains(&face)), "{mode}: {found:?}");
            assert_eq!(file.mesh().vertex_count(), 8);
        }
    }
}

#[test]
fn broken_files_are_refused_by_their_reason() {
    let stl = String::from_utf8(tetrahedra().swap_remove(4).1).expect("text");
    for (from, to, said) in [
        ("endfacet\n facet", "facet", "line 8: has \"facet\" where \"endfacet\" must be"),
        ("vertex 1 0 0", "vertex 1 0 x", "where \"a number\" must be"),
        ("endsolid\n", "", "ends where \"facet or endsolid\" must follow"),
    ] {
        let text = refused(Format::Stl, stl.replacen(from, to, 1));
        assert!(text.contains(said), "{text}");
    }
    let mut cut = binary_stl(&[[[0.0; 3]; 3]; 3]);
    cut.pop();
    cut[0] = b'b';
    assert!(
        refused(Format::Stl, &cut).contains("has 3 triangles of 50 bytes by its header, 150 in all, and 149")
    );
    for (off, said) in [
        ("4OFF 1 1 0\n", "line 1: begins with \"4OFF\""),
        ("OFF\nmany 2\n", "line 2: has \"many 2\" for the numbers"),
        ("OFF BINARY\n\0\0\0\x01", "is a binary OFF file; give an OFF file in text"),
        ("OFF 99999999999 1 0\n", "99999999999 vertices"),
        ("OFF 2 1 0\n0 0 0\n", "ends after 1 of 2 vertices"),
        ("OFF 1 1 0\n0 0 y\n", "line 2: z is \"y\""),
        ("OFF 1 1 0\n0 0 0\n3 0 0\n", "line 3: has 2 of 3 corners"),
        ("OFF 1 1 0\n0 0 0\n3 0 0 1\n", "line 3: names vertex 1, but there are 1"),
        ("OFF 1 1 0\n0 0 0\n3 0 0 0\n7\n", "line 4: \"7\" is after the last face"),
    ] {
        let text = refused(Format::Off, off);
        assert!(text.contains(said), "{text}");
    }
    let good = gltf(4);
    for (from, to, said) in [
        ("\"count\":6", "\"count\":7", "accessor 1 has 7 items beyond its buffer"),
        ("\"count\":4,", "\"count\":2,", "names vertex 2, but there are 2"),
        ("5126", "5123", "positions that are no floats"),
        ("\"POSITION\":0", "\"POSITION\":2", "names accessor 2, but there are 2"),
        ("\"children\":[1]", "\"children\":[0]", "node 0 has two parents, or is its own"),
        ("base64,A", "base64,*", "is no base64"),
        ("data:application/octet-stream;base64,", "http://a.org/b?", "is no path from it"),
        ("data:application/octet-stream;base64,", "x", "bytes have no folder"),
        ("\"mesh\":0,\"t", "\"mesh\":3,\"t", "is no glTF that is read"),
    ] {
        assert!(good.contains(from), "{from}");
        let text = refused(Format::Gltf, good.replacen(from, to, 1));
        assert!(text.contains(said), "{from}: {text}");
    }
    for length in 0..glb(4).len() {
        refused(Format::Gltf, &glb(4)[..length]);
    }
}

#[test]
fn buffers_of_gltf_are_next_to_it() {
    let folder = support::folder::Folder::new("gltf");
    let file = folder.write("a.gltf", &json(4, r#","uri":"the%20buffer.bin""#));
    let path = std::path::Path::new(&file);
    let missing = MeshFile::read(path).expect_err("refused").to_string();
    assert!(missing.contains("the buffer.bin"), "{missing}");
    std::fs::write(folder.path("the buffer.bin"), buffer()).expect("written");
    let read = MeshFile::read(path).expect("a mesh");
    assert_eq!(read.mesh().face_count(), 4);
    assert_eq!(read.read_frame(path).expect("a frame").mesh(), read.mesh());
}
