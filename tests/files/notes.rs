//! Parts of a file that a reader skips, leaves out or cuts as it can: each is counted by a note, or
//! refused by its reason.
#![allow(clippy::unwrap_used, reason = "tests")]

use nearmiss::mesh::Body;
use nearmiss_io::{Format, MeshFile, Treated, encode_ply};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\nf 2 3 4\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                   element face 2\nproperty list uchar int vertex_indices\nend_header\n\
                   0 0 0\n1 0 0\n0 1 0\n5 5 5\n3 0 1 2\n3 1 2 3\n";

fn read(format: Format, bytes: impl AsRef<[u8]>) -> Result<MeshFile, String> {
    MeshFile::parse("a file", format, bytes.as_ref()).map_err(|error| {
        assert_eq!(error.exit_code(), 3, "{error}");
        error.to_string()
    })
}

fn obj(bytes: impl AsRef<[u8]>) -> Result<MeshFile, String> {
    read(Format::Obj, bytes)
}

/// A mesh of the same vertices and faces.
fn is_plain(file: &MeshFile, format: Format) -> bool {
    let plain = read(format, if format == Format::Obj { OBJ } else { PLY }).unwrap().into_mesh();
    (file.mesh().positions(), file.mesh().faces()) == (plain.positions(), plain.faces())
}

fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
    text.encode_utf16().flat_map(order).collect()
}

/// The same mesh, without a note.
#[test]
fn marks_and_line_ends_change_nothing() {
    for (format, text) in [(Format::Obj, OBJ), (Format::Ply, PLY)] {
        for mark in ["", "\u{feff}"] {
            for end in ["\n", "\r\n", "\r", " \t\n", "\n\n"] {
                let header = format == Format::Ply && end == "\n\n";
                let file = format!("{mark}{}", text.replace('\n', if header { "\n" } else { end }));
                let mesh = read(format, &file).unwrap();
                assert!(is_plain(&mesh, format) && mesh.notes().is_empty(), "{mark:?} {end:?}");
                assert_eq!(mesh.clone().strict().unwrap(), mesh);
            }
            let file = format!("{mark}{text}");
            let wide = [(utf16(&file, u16::to_le_bytes), "little"), (utf16(&file, u16::to_be_bytes), "big")];
            for (bytes, order) in wide {
                let error = read(format, bytes).unwrap_err();
                assert!(error.contains(&format!("text in UTF-16, {order}-endian")), "{error}");
                assert!(error.contains("save it as UTF-8"), "{error}");
            }
        }
    }
    let mut binary = "\u{feff}".as_bytes().to_vec();
    encode_ply(read(Format::Ply, PLY).unwrap().mesh(), &mut binary).unwrap();
    assert!(is_plain(&read(Format::Ply, binary).unwrap(), Format::Ply));
}

/// Every keyword of the specification, with what may stand behind it: faces and vertices are as
/// without them.
#[test]
fn keywords_of_the_format_are_known() {
    let quiet = "vt vn vp cstype deg bmat step curv2 parm trim hole scrv sp end con g s mg o bevel c_interp d_interp lod \
                 usemtl mtllib usemap maplib shadow_obj trace_obj ctech stech res";
    let words = |list: &'static str| list.split_ascii_whitespace();
    for word in words(quiet) {
        for rest in ["", " 1", " a b 0.5", " v 1 2 3", " \\\n 1 2", "\t#", " C:\\x\\\n"] {
            let mesh = obj(format!("{word}{rest}\n{OBJ}")).unwrap();
            assert!(is_plain(&mesh, Format::Obj) && mesh.notes().is_empty(), "{word}{rest}");
        }
    }
    for word in words("curv surf bsp bzp cdc cdp call csh") {
        let mesh = obj(format!("{word} 1 2\n{OBJ}{word} 3\n")).unwrap();
        let [note] = mesh.notes() else { panic!("{word}: {:?}", mesh.notes()) };
        assert_eq!((note.treated, note.count), (Treated::NotRead, 2));
        let text = note.to_string();
        let start = format!("a file: 2 lines were not read; the first: line 1 begins with \"{word}\"");
        assert!(text.starts_with(&start), "{text}");
        assert!(
            is_plain(&mesh, Format::Obj) && mesh.strict().unwrap_err().to_string().contains("line 1 begins")
        );
    }
}

/// A line that begins with another word holds no vertex and no face, and is counted; or it nearly
/// does, and is refused.
#[test]
fn other_words_are_counted_or_refused() {
    for word in ["vertex", "VN", "1.0", "\u{feff}#", "//", "\u{1a}", "\u{a0}", "solid", "vv", "facet"] {
        let mesh = obj(format!("{OBJ}{word} 1 2 3\n{word}\n")).unwrap();
        assert!(is_plain(&mesh, Format::Obj), "{word}");
        let [note] = mesh.notes() else { panic!("{word}: {:?}", mesh.notes()) };
        assert_eq!((note.treated, note.count, note.file.as_str()), (Treated::Unknown, 2, "a file"), "{word}");
        assert!(
            note.to_string().starts_with("a file: 2 lines were skipped; the first: line 7 begins"),
            "{note}"
        );
        assert!(mesh.strict().unwrap_err().to_string().contains("no keyword of OBJ"));
    }
    for word in
        ["V", "F", "v:", "f:", "v1", "f,", "\u{a0}v", "\u{feff}f", "\u{200b}v", "(v)", "\"v\"", "v\u{a0}1"]
    {
        let error = obj(format!("# one\n{word} 1 2 3\n{OBJ}")).unwrap_err();
        assert!(
            error.contains("line 2 begins with") && error.contains("is nearly v or f"),
            "{word}: {error}"
        );
    }
}

#[test]
fn odd_lines_are_read_or_refused_by_their_reason() {
    let with = |line: &str| obj(format!("{OBJ}{line}\n"));
    for line in [
        "",
        " \t",
        "f 1 2 3 # 4",
        "f\t3/1\t2//1 \t1/1/1 ",
        "  f 1 2 3",
        "f -4 -3 -2",
        "f 1 \\\n2 \\\n 3",
        "fo 1 2 3",
        "\u{b}",
    ] {
        let mesh = with(line).unwrap();
        assert!(mesh.mesh().faces().len() == 2 + usize::from(line.contains('f')), "{line:?}");
    }
    for numbers in ["1e5 -1E-3 +.5", "1. 2 3 1.0", "1 2 3 0.5 0.5 0.5", "1 2 3 1 0.1 0.2 0.3"] {
        let mesh = obj(format!("v {numbers}\n{OBJ}")).unwrap();
        let first: f64 = numbers.split(' ').next().unwrap().parse().unwrap();
        assert_eq!(mesh.mesh().positions().get_f64(0).unwrap()[0], first, "{numbers}");
    }
    for (line, why) in [
        ("v 1,5 2 3", "the x of vertex 4 (from 0) is \"1,5\""),
        ("v 1 2 3,", "the z of vertex 4"),
        ("v 1 0x1 3", "\"0x1\", which is not a number"),
        ("v 1d5 2 3", "\"1d5\""),
        ("v 1 2 3 v 4 5 6", "line 7: vertex 4 (from 0) has \"v\" after x, y and z"),
        ("v 1 2 3 4 5 6 7 8", "has \"8\" after"),
        ("v 1 2\u{a0}3", "the y of vertex 4"),
        ("v 1 2 3\0", "NUL"),
        ("\0f 1 2 3", "line 7 has a NUL byte"),
        ("v nan 0 0\nf 1 2 5", "vertex 4 has x = NaN"),
        ("f 1 2 3.0", "the corner \"3.0\""),
        ("f 1 2 3e0", "the corner"),
        ("f 1 2 3 / 4", "the corner \"/\""),
        ("f 1,2,3", "the corner"),
        ("f 1 2 -5", "index -5 reaches before"),
        ("mtllib C:\\x\\\nv 0 0 0", "line 7 ends in a backslash, so the next line, which begins with \"v\""),
        ("f 1 2 3 \\\nf 1 2 3", "begins with \"f\""),
    ] {
        let error = with(line).unwrap_err();
        assert!(error.contains(why), "{line:?}: {error}");
    }
    assert!(with("v nan nan nan").is_ok(), "no face uses it");
}

/// A quad whose sides cross becomes its fan, whose triangles cover both halves and have all sides.
#[test]
fn a_face_that_crosses_itself_is_cut_as_a_fan() {
    let bow = format!("{OBJ}v 0 0 9\nv 2 2 9\nv 2 0 9\nv 0 2 9\nf 5 6 7 8\nf 1 2 3\nf 6 7 8 5\n");
    let mesh = obj(&bow).unwrap();
    assert_eq!(mesh.mesh().faces()[2..], [[4, 5, 6], [4, 6, 7], [0, 1, 2], [5, 6, 7], [5, 7, 4]]);
    assert_eq!([2, 3, 4, 6].map(|t| mesh.file_face(t)), [2, 2, 3, 4]);
    let [note] = mesh.notes() else { panic!("{:?}", mesh.notes()) };
    assert_eq!((note.treated, note.count), (Treated::Fan, 2));
    let text = note.to_string();
    for part in
        ["a file: 2 faces were cut as a fan", "face 2, with 4 corners, crosses itself", "vertices 4 and 5"]
    {
        assert!(text.contains(part), "{text}");
    }
    let refused = mesh.clone().strict().unwrap_err().to_string();
    assert!(refused.starts_with("a file: face 2, with 4 corners, crosses itself"), "{refused}");
    // A frame is cut as its first, which has said so.
    let frame = mesh.parse_frame("next", Format::Obj, bow.as_bytes()).unwrap();
    assert!(frame.notes().is_empty() && frame.mesh().faces() == mesh.mesh().faces());
    let odd = mesh.parse_frame("next", Format::Obj, format!("{bow}x\n").as_bytes()).unwrap();
    assert_eq!(odd.notes().len(), 1);
}

/// They keep their number in the file, whether polygons come before them or not.
#[test]
fn faces_of_fewer_than_three_corners_are_left_out() {
    let quad = ["", "f 1 2 3 1\n"];
    for (count, before) in [(0, 0), (1, 0), (2, 0), (2, 1), (0, 1), (1, 1)] {
        let short = &["f", "f 4", "f 1 2"][count];
        let text =
            format!("{}{short}\n{}{short}\nf 2 3 4\n{short}\n", quad[before], OBJ.replace("f 2 3 4\n", ""));
        let mesh = obj(&text).unwrap();
        let fan = 2 * before;
        assert_eq!(mesh.mesh().faces()[fan..], [[0, 1, 2], [1, 2, 3]], "{text}");
        assert_eq!(
            [fan, fan + 1].map(|t| mesh.file_face(t as u32) as usize),
            [before + 1, before + 3],
            "{text}"
        );
        assert_eq!((mesh.file_face_count(), mesh.mesh().face_count()), (before + 5, fan + 2));
        let [note] = mesh.notes() else { panic!("{:?}", mesh.notes()) };
        assert_eq!((note.treated, note.count), (Treated::LeftOut, 3));
        assert!(note.to_string().contains(&format!("a face with {count} corners; at least 3")), "{note}");
        assert!(mesh.clone().strict().is_err());
        assert_eq!(mesh.clone().cut_as(&mesh).unwrap().notes(), []);
        assert!(Body::moving(mesh.mesh().clone(), mesh.clone().into_mesh()).is_ok());
        let list = ["0", "1 3", "2 0 1"][count];
        let head =
            PLY.replace("face 2", "face 4").replace("3 0 1 2\n", &format!("{list}\n3 0 1 2\n{list}\n"));
        let mesh = read(Format::Ply, head).unwrap();
        assert!(is_plain(&mesh, Format::Ply));
        assert_eq!([0, 1].map(|t| mesh.file_face(t)), [1, 3]);
        let [note] = mesh.notes() else { panic!("{:?}", mesh.notes()) };
        assert_eq!((note.treated, note.count), (Treated::LeftOut, 2));
        assert!(mesh.strict().unwrap_err().to_string().contains(&format!("face 0 has {count} corners")));
    }
    // Their corners must be what they claim.
    assert!(obj(format!("{OBJ}f 1 9\n")).unwrap_err().contains("index 9"));
    assert!(read(Format::Ply, PLY.replace("3 0 1 2", "2 0 9")).unwrap_err().contains("vertex 9"));
    assert!(obj("v 0 0 0\nf 1 1\n").unwrap_err().contains("no triangles"));
}

#[test]
fn elements_of_ply_are_known_or_counted() {
    let with = |name: &str| {
        let body = "element vertex 4";
        let file = PLY.replace(body, &format!("element {name} 2\nproperty int a\n{body}"));
        read(Format::Ply, file.replace("0 0 0\n", "7\n8\n0 0 0\n")).unwrap()
    };
    for name in ["material", "camera", "user", "range_grid"] {
        assert!(is_plain(&with(name), Format::Ply) && with(name).notes().is_empty(), "{name}");
    }
    for name in ["edge", "tristrip", "Face", "faces"] {
        let mesh = with(name);
        assert!(is_plain(&mesh, Format::Ply));
        let [note] = mesh.notes() else { panic!("{:?}", mesh.notes()) };
        assert_eq!((note.treated, note.count), (Treated::NotRead, 2));
        assert!(
            note.to_string()
                .contains(&format!("2 entries were not read; the first: its element {name}, of 2")),
            "{note}"
        );
        assert!(mesh.strict().is_err());
    }
    let text =
        PLY.replace("element vertex", " comment a\n\tobj_info b\ncomment\telement face 9\nelement vertex");
    assert!(is_plain(&read(Format::Ply, text).unwrap(), Format::Ply));
}
