//! Bad files and the words that must answer them; odd files that must be accepted.
#![allow(clippy::unwrap_used, reason = "tests")]

use nearmiss::mesh::{Body, Positions};
use nearmiss_io::{Format, MeshFile};
use std::path::PathBuf;
use support::folder::Folder;

/// A header of an ascii file with three float vertices and one face.
const HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const BODY: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// The good ascii file with a part replaced.
fn ply(from: &str, to: &str) -> Vec<u8> {
    let good = format!("{HEAD}{BODY}");
    assert!(good.contains(from), "{from:?} is not in the file");
    good.replacen(from, to, 1).into_bytes()
}

/// A binary file: header with `counts` of vertices and faces, then three float vertices, then `faces`.
fn binary(endian: &str, counts: (u64, u64), faces: &[u8], list: &str) -> Vec<u8> {
    let (v, f) = counts;
    let mut bytes = format!(
        "ply\nformat binary_{endian}_endian 1.0\nelement vertex {v}\nproperty float x\nproperty float y\n\
         property float z\nelement face {f}\nproperty list {list} vertex_indices\nend_header\n"
    )
    .into_bytes();
    for x in [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(if endian == "big" { x.to_be_bytes() } else { x.to_le_bytes() });
    }
    bytes.extend(faces);
    bytes
}

type Row = (&'static str, Vec<u8>, &'static [&'static str]);

/// File name, bytes, and what the message must hold besides the file name.
fn bad_files() -> Vec<Row> {
    let obj = |text: &str| text.as_bytes().to_vec();
    let bin = |faces: &[u8]| binary("little", (3, 1), faces, "uchar uchar");
    vec![
        // Headers.
        ("empty.ply", vec![], &["begin with the line \"ply\"", "no PLY file"]),
        ("text.ply", obj("solid cube\n"), &["\"ply\" but with \"solid cube\""]),
        ("only.ply", obj("ply"), &["no end_header", "cut short"]),
        ("cut_header.ply", ply("end_header\n", "")[..60].to_vec(), &["no end_header", "lines read"]),
        (
            "utf8.ply",
            b"ply\nformat ascii 1.0\nelement v\xff 3\n".to_vec(),
            &["header line 3", "not UTF-8", "correct"],
        ),
        (
            "format.ply",
            ply("ascii 1.0", "ascii 2.0"),
            &["header line 2", "\"ascii 2.0\"", "binary_big_endian"],
        ),
        ("middle.ply", ply("ascii 1.0", "binary_middle_endian 1.0"), &["binary_middle_endian", "convert"]),
        ("no_format.ply", ply("format ascii 1.0\n", ""), &["no format line", "add one"]),
        (
            "two_formats.ply",
            ply("element v", "format ascii 1.0\nelement v"),
            &["line 3", "the format a second time"],
        ),
        (
            "keyword.ply",
            ply("element face", "elephant face"),
            &["header line 7", "\"elephant\"", "known are"],
        ),
        (
            "form.ply",
            ply("property float y", "property float"),
            &["header line 5", "property TYPE NAME", "correct"],
        ),
        (
            "count.ply",
            ply("vertex 3", "vertex -3"),
            &["header line 3", "element vertex", "\"-3\"", "whole number"],
        ),
        ("element.ply", ply("vertex 3", "vertex"), &["header line 3", "element NAME COUNT"]),
        ("twice.ply", ply("float y", "float x"), &["header line 5", "property x a second time"]),
        (
            "element_twice.ply",
            ply("element face", "element vertex"),
            &["header line 7", "element vertex a second"],
        ),
        ("orphan.ply", ply("element vertex 3\n", ""), &["header line 3", "before the first element"]),
        ("type.ply", ply("float z", "half z"), &["header line 6", "unknown type \"half\"", "float64"]),
        (
            "float_list.ply",
            ply("list uchar", "list float"),
            &["header line 8", "float32 for its length", "whole-number"],
        ),
        ("float_index.ply", ply("uchar int", "uchar double"), &["header line 8", "float64 for its indices"]),
        ("no_vertices.ply", ply("element vertex", "element point"), &["no element vertex"]),
        ("no_z.ply", ply("float z", "float w"), &["element vertex has no property z"]),
        ("list_y.ply", ply("float y", "list uchar float y"), &["vertex property y is a list"]),
        (
            "no_corners.ply",
            ply("int vertex_indices", "int strip"),
            &["element face has no list vertex_indices"],
        ),
        (
            "two_corners.ply",
            ply("end_h", "property list uchar int vertex_index\nend_h"),
            &["both vertex_indices and vertex_index"],
        ),
        // Counts and sizes.
        (
            "lying.ply",
            ply("vertex 3", "vertex 4000000000"),
            &["4000000000 entries of element vertex", "26 bytes are left"],
        ),
        (
            "lying_binary.ply",
            binary("little", (4_000_000_000, 1), &[], "uchar int"),
            &["4000000000 entries", "at least 48000000000 bytes", "36 bytes are left", "cut short"],
        ),
        (
            "lying_most.ply",
            ply("face 1", "face 18446744073709551615"),
            &["18446744073709551615 entries of element face"],
        ),
        ("one_more.ply", ply("face 1", "face 2"), &["ends inside element face 1", "vertex_indices"]),
        ("cut_body.ply", bin(&[3, 0, 1]), &["face 0", "length 3", "2 bytes are left"]),
        ("cut_vertex.ply", bin(&[])[..200].to_vec(), &["3 entries of element vertex", "cut short"]),
        (
            "list_255.ply",
            bin(&[255, 0, 1]),
            &["face 0", "vertex_indices has the length 255", "2 bytes are left"],
        ),
        (
            "list_huge.ply",
            binary("big", (3, 1), &[0xff, 0xff, 0xff, 0xfe], "uint int"),
            &["length 4294967294", "17179869176 bytes", "0 bytes are left"],
        ),
        (
            "list_negative.ply",
            binary("little", (3, 1), &[0xff], "char int"),
            &["face 0", "vertex_indices has the length -1", "0 or more"],
        ),
        ("trailing.ply", bin(&[3, 0, 1, 2, 9, 9]), &["2 bytes after its last element", "correct the counts"]),
        ("trailing_text.ply", ply("3 0 1 2\n", "3 0 1 2\nmore"), &["\"more\" after its last element"]),
        // Values.
        ("word.ply", ply("1 0 0", "1 zero 0"), &["vertex 1", "property y", "\"zero\"", "no float32"]),
        ("byte.ply", ply("3 0 1 2", "300 0 1 2"), &["face 0", "\"300\"", "no uint8"]),
        ("short_line.ply", ply("1 0 0", "1 0"), &["vertex 1 ends its line before property z"]),
        ("long_line.ply", ply("1 0 0", "1 0 0 7"), &["vertex 1 has \"7\" after its last property"]),
        ("nan.ply", ply("1 0 0", "1 nan 0"), &["vertex 1 has y = NaN", "must be finite", "correct it"]),
        ("inf.ply", ply("0 1 0", "0 1 -inf"), &["vertex 2 has z = -inf", "must be finite"]),
        (
            "infinite.ply",
            ply("1 0 0", "1 0 2e38").replace_text("0 1 0", "0 1 4e38"),
            &["vertex 2 has z = inf", "finite"],
        ),
        ("corners.ply", ply("3 0 1 2", "2 0 1"), &["no triangles"]),
        ("index.ply", ply("0 1 2", "0 1 3"), &["face 0 corner 2 names vertex 3", "there are 3 vertices"]),
        (
            "after_polygon.ply", // the face of the file, not the triangle of the fan
            ply("face 1", "face 2").replace_text("3 0 1 2\n", "5 0 1 2 0 1\n3 0 0 7\n"),
            &["face 1 corner 2 names vertex 7", "correct the index"],
        ),
        ("negative.ply", ply("0 1 2", "0 -1 2"), &["face 0 corner 1 names vertex -1", "0 or more"]),
        (
            "no_face.ply",
            ply("face 1", "face 0").replace_text("3 0 1 2\n", ""),
            &["no triangles", "at least one face"],
        ),
        // OBJ.
        ("empty.obj", vec![], &["no triangles"]),
        ("points.obj", obj("v 0 0 0\n"), &["no triangles"]),
        ("short.obj", obj("# two\nv 0 0\n"), &["line 2", "2 coordinates"]),
        (
            "word.obj",
            obj("v 0 0 0\nv 0 one 0\n"),
            &["line 2", "the y of vertex 1", "\"one\"", "not a number"],
        ),
        ("bytes.obj", b"v 0 \xfe 0\n".to_vec(), &["line 1", "the y of vertex 0", "not a number"]),
        ("zero.obj", obj("v 0 0 0\nf 1 0 1\n"), &["line 2", "vertex index 0", "from 1"]),
        ("back.obj", obj("v 0 0 0\nf -1 -1 -2\n"), &["line 2", "index -2", "the 1 vertices so far"]),
        ("index.obj", obj("v 0 0 0\n\nf 1 \\\n 1 2\n"), &["line 3", "index 2", "has 1 vertices"]),
        ("corner.obj", obj("v 0 0 0\nf 1/x 1 1\n"), &["line 2", "\"1/x\"", "i/j/k"]),
        ("slashes.obj", obj("v 0 0 0\nf 1/1/1/1 1 1\n"), &["line 2", "\"1/1/1/1\""]),
        ("edge.obj", obj("v 0 0 0\nf 1 1\n"), &["no triangles"]),
        ("inf.obj", obj("v 0 0 1e999\nf 1 1 1\n"), &["vertex 0 has z = inf", "must be finite"]),
        ("large.obj", obj("v 0 0 1e145\nf 1 1 1\n"), &["vertex 0 has z = 1e145", "2^480"]),
        // Names.
        ("mesh.3mf", obj("solid\n"), &["extension \"3mf\"", ".ply", ".obj"]),
        ("mesh", obj("ply\n"), &["extension \"\"", ".ply"]),
    ]
}

trait ReplaceText {
    fn replace_text(self, from: &str, to: &str) -> Self;
}

impl ReplaceText for Vec<u8> {
    fn replace_text(self, from: &str, to: &str) -> Self {
        String::from_utf8(self).unwrap().replacen(from, to, 1).into_bytes()
    }
}

#[test]
fn every_bad_file_is_answered_with_its_element_value_and_advice() {
    let folder = Folder::new("bad");
    let mut wrong = Vec::new();
    for (file, bytes, parts) in bad_files() {
        let path = PathBuf::from(folder.path(file));
        std::fs::write(&path, bytes).unwrap();
        let read = std::panic::catch_unwind(|| MeshFile::read(&path));
        match read {
            Err(_) => wrong.push(format!("{file}: panics")),
            Ok(Ok(mesh)) => wrong.push(format!("{file}: accepted with {} faces", mesh.mesh().face_count())),
            Ok(Err(error)) => {
                let text = error.to_string();
                let lacks = parts.iter().find(|part| !text.contains(**part));
                if lacks.is_some() || !text.contains(file) || error.exit_code() != 3 {
                    wrong.push(format!("{file}: lacks {lacks:?}: {text}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_no_file_is_answered_in_the_words_of_the_system() {
    let folder = Folder::new("none");
    let text = |name: &str| MeshFile::read(folder.path(name).as_ref()).unwrap_err().to_string();
    assert!(
        text("missing.ply").contains("missing.ply: cannot be read: No such file"),
        "{}",
        text("missing.ply")
    );
    std::fs::create_dir_all(folder.path("a.obj")).unwrap();
    assert!(text("a.obj").contains("a.obj: cannot be read: it is a directory; check the path"));
    let device = MeshFile::read("/dev/zero.ply".as_ref()).unwrap_err().to_string();
    assert!(device.contains("/dev/zero.ply: cannot be read"));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/dev/zero", folder.path("endless.ply")).unwrap();
        assert!(text("endless.ply").contains("not a regular file"));
    }
}

fn parse(name: &str, bytes: &[u8]) -> MeshFile {
    let format = Format::of(name.as_ref()).unwrap();
    MeshFile::parse(name, format, bytes).unwrap()
}

#[test]
fn frames_that_do_not_belong_together_are_refused() {
    let t0 = parse("t0.ply", &ply("face", "face"));
    let more = parse("t1.ply", &ply("vertex 3", "vertex 4").replace_text("0 0 0\n", "0 0 0\n5 5 5\n"));
    let moving = |t1: MeshFile| Body::moving(t0.mesh().clone(), t1.into_mesh()).unwrap_err().to_string();
    let text = moving(more.clone());
    assert_eq!(more.cut_as(&t0).unwrap_err().to_string(), text);
    assert_eq!(
        text,
        "t1.ply: has 4 vertices, but the first frame, t0.ply, has 3: two frames of one body must have the same vertices"
    );
    let other = parse("t1.ply", &ply("3 0 1 2", "3 0 2 1"));
    let text = moving(other.clone());
    assert_eq!(other.cut_as(&t0).unwrap_err().to_string(), text);
    assert!(text.contains("face 0 is [0, 2, 1], but in the first frame, t0.ply, it is [0, 1, 2]"), "{text}");
}

type Odd<'a> = (&'a str, Vec<u8>, &'a [[u32; 3]]);

/// Every file here has the triangles that are listed with it.
#[test]
fn odd_but_legal_files_are_accepted() {
    let one = [[0, 1, 2]].as_slice();
    let crlf = String::from_utf8(ply("face", "face")).unwrap().replace('\n', "\r\n");
    let cr = crlf.replace("\r\n", "\r");
    let extra =
        "property list ushort double before\nproperty list uchar int vertex_index\nproperty uchar red\n";
    let mut latin = ply("element vertex", "comment Z\u{fc}rich\nobj_info x\ncomment\nelement vertex");
    latin.retain(|&b| b != 0xc3); // leaves a byte that is no UTF-8
    let rows: Vec<Odd> = vec![
        ("crlf.ply", crlf.into_bytes(), one),
        ("cr.ply", cr.into_bytes(), one),
        ("comments.ply", latin, one),
        ("unended.ply", ply("3 0 1 2\n", "3 0 1 2"), one),
        ("blank.ply", ply("3 0 1 2\n", "\n\t 3 0 1 2 \n\n \n"), one),
        ("unused_nan.ply", ply("vertex 3", "vertex 4").replace_text("0 1 0\n", "0 1 0\nnan inf -inf\n"), one),
        ("degenerate.ply", ply("1 0 0", "0 0 -0.0"), one),
        ("repeated.ply", ply("3 0 1 2", "3 1 1 1"), &[[1, 1, 1]]),
        ("duplicate.ply", ply("face 1", "face 2").replace_text("3 0 1 2\n", "3 0 1 2\n3 0 1 2\n"), &[[0, 1, 2]; 2]),
        ("fan.ply", ply("3 0 1 2", "5 0 1 2 1 0"), &[[0, 1, 2], [0, 2, 1], [0, 1, 0]]),
        (
            "extra.ply",
            ply("property list uchar int vertex_indices\n", extra).replace_text("3 0 1 2", "2 0.5 1e3 3 0 1 2 255"),
            one,
        ),
        (
            "elements.ply",
            ply("element vertex", "element none 99999999999\nelement tag 2\nproperty char t\nelement vertex")
                .replace_text("0 0 0\n", "-128\n127\n0 0 0\n"),
            one,
        ),
        (
            "faces_first.ply",
            b"ply\nformat ascii 1.0\nelement face 1\nproperty list int uint vertex_indices\nelement vertex 3\n\
              property int x\nproperty int y\nproperty int z\nend_header\n3 2 1 0\n0 0 0\n1 0 0\n2147483647 1 0\n"
                .to_vec(),
            &[[2, 1, 0]],
        ),
        ("big.ply", binary("big", (3, 1), &[3, 0, 0, 0, 1, 0, 2], "uchar short"), one),
        ("little.ply", binary("little", (3, 1), &[4, 0, 0, 0, 0, 1, 2, 1], "uint uchar"), &[[0, 1, 2], [0, 2, 1]]),
        (
            "all.obj",
            b"# all\r\nmtllib C:\\x\r\n# path\\\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 \\\n 0\nvt 0 0\no \xff\n\
              f 1/1 2//2 -1/3/4 # c\nf +1 2 3 2\n"
                .to_vec(),
            &[[0, 1, 2], [0, 1, 2], [0, 2, 1]],
        ),
        ("ahead.obj", b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n".to_vec(), one),
    ];
    for (file, bytes, faces) in rows {
        assert_eq!(parse(file, &bytes).mesh().faces(), faces, "{file}");
    }
}

#[test]
fn positions_keep_their_precision() {
    let doubles = |positions: &Positions| matches!(positions, Positions::F64(_));
    let mut big = ply("face", "face")
        .replace_text("ascii", "binary_big_endian")
        .replace_text("float x", "double x")
        .replace_text("float y", "short y")
        .replace_text(BODY, "");
    for (x, y, z) in [(0.1f64, 7i16, 0.5f32), (1.0, -8, 0.1), (-0.0, 0, f32::MIN_POSITIVE)] {
        big.extend(x.to_be_bytes());
        big.extend(y.to_be_bytes());
        big.extend(z.to_be_bytes());
    }
    big.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    let read = parse("big.ply", &big).into_mesh();
    assert!(doubles(read.positions()));
    assert_eq!(read.positions().get_f64(0), Some([0.1, 7.0, 0.5]));
    assert_eq!(read.positions().get_f64(1), Some([1.0, -8.0, f64::from(0.1f32)]));
    assert_eq!(read.positions().get_f64(2).unwrap()[0].to_bits(), (-0.0f64).to_bits());
    // Declared floats are rounded to floats, as the format demands; an OBJ says nothing, so only exact floats are.
    let tenth = parse("tenth.ply", &ply("1 0 0", "0.1 0 0"));
    assert_eq!(tenth.mesh().positions().get_f64(1), Some([f64::from(0.1f32), 0.0, 0.0]));
    let obj = |x: &str| parse("x.obj", format!("v {x} 0 0\nf 1 1 1\n").as_bytes()).into_mesh();
    assert_eq!(obj("0.1").positions(), &Positions::F64(vec![[0.1, 0.0, 0.0]]));
    assert_eq!(obj("0.125").positions(), &Positions::F32(vec![[0.125, 0.0, 0.0]]));
    assert!(!doubles(parse("bytes.ply", &ply("float y", "int16 y")).mesh().positions()));
    assert!(doubles(parse("ints.ply", &ply("float y", "int y")).mesh().positions()));
}
