//! Pictures and coloured meshes of films, and heat maps.

use super::film::falling;
use super::picture::{PAPER, Png};
use super::{Folder, err, ok, refused, run};
use nearmiss_io::{Format, MeshFile};

/// Colours of the triangles of a coloured PLY.
fn colours(path: &str) -> Vec<[u8; 3]> {
    let bytes = std::fs::read(path).expect("written");
    let faces = MeshFile::parse("painted", Format::Ply, &bytes).expect("a mesh").mesh().face_count();
    let body = &bytes[bytes.len() - 16 * faces..];
    body.chunks(16).map(|face| [face[13], face[14], face[15]]).collect()
}

#[test]
fn each_frame_has_a_mesh_and_a_picture() {
    let folder = Folder::new("film-meshes");
    let files = falling(&folder);
    let args = |command: &'static str, more: &[&'static str], to: &str| -> Vec<String> {
        let files = files.iter().map(String::as_str);
        let all = [command].into_iter().chain(files).chain(more.iter().copied()).chain([to]);
        all.map(str::to_owned).collect()
    };
    let ran = |args: &[String]| ok(&args.iter().map(String::as_str).collect::<Vec<_>>());
    ran(&args("detect", &["--discrete", "--out-mesh"], &folder.path("marked.######.ply")));
    let red =
        |frame: usize| colours(&folder.path(&format!("marked.{frame:06}.ply"))).contains(&[210, 30, 30]);
    assert_eq!([1001, 1002, 1003, 1004].map(red), [false, false, true, false]);
    let text = ran(&args("picture", &["--discrete", "--size", "64x64", "--out"], &folder.path("#.png")));
    assert_eq!(text.lines().count(), 4, "{text}");
    assert!(
        text.lines().nth(2).is_some_and(|line| line.contains("1003.png: 64x64, 2 triangles, 2 red")),
        "{text}"
    );
    // A file that is read is not overwritten.
    let ply = folder.path("marked.001001.ply");
    let numbered = [1, 2, 3].map(|at| {
        let to = folder.path(&format!("m.{at}.ply"));
        std::fs::copy(&ply, &to).expect("copied");
        to
    });
    let [a, b, c] = &numbered;
    let said = refused(2, &["detect", a, b, c, "--discrete", "--out-mesh", &folder.path("m.#.ply")]);
    assert!(said.contains("--out-mesh would overwrite"), "{said}");
}

#[test]
fn one_camera_sees_all_frames() {
    let folder = Folder::new("film-camera");
    // A triangle that moves to the right, 10 wide in all.
    let frame = |at: usize| {
        let x = 4 * at;
        folder.write(&format!("a.{at}.obj"), &format!("v {x} 0 0\nv {} 0 0\nv {x} 0 2\nf 1 2 3\n", x + 2))
    };
    let files = [0, 1, 2].map(frame);
    let [a, b, c] = &files;
    let drawn = |more: &[&str]| {
        let out = folder.path("f#.png");
        let all = ["picture", a, b, c, "--discrete", "--size", "200x100", "--view", "0,-1,0", "--out", &out];
        ok(&[&all[..], more].concat());
        [0, 1, 2].map(|at| {
            let picture = Png::read(&folder.path(&format!("f{at}.png")));
            (0..200).filter(|x| (0..100).any(|y| picture.at(*x, y) != PAPER)).collect::<Vec<_>>()
        })
    };
    let all = drawn(&[]);
    assert_eq!(all, drawn(&["--fit", "all"]));
    // 10 wide in nine tenths of 200 pixels.
    for (at, columns) in all.iter().enumerate() {
        let [first, last] = [columns[0], columns[columns.len() - 1]];
        assert!(
            first.abs_diff(10 + 72 * at) <= 1 && last.abs_diff(45 + 72 * at) <= 1,
            "{at}: {first} to {last}"
        );
    }
    let own = drawn(&["--fit", "frame"]);
    assert!(own[0] == own[1] && own[1] == own[2] && own[0].len() > 80, "{:?}", own[0]);
    let out = folder.path("f#.png");
    let both = ["picture", a, b, c, "--fit", "all", "--around", "contacts", "--out", &out];
    assert!(refused(2, &both).contains("--fit all cannot be used with --around contacts"));
    assert!(refused(2, &["picture", a, "--fit", "all", "--out", &out]).contains("--fit has no effect"));
    // Bad frames are passed over.
    let torn = folder.write("a.3.obj", "v 0\n");
    let done =
        run(&["picture", a, b, c, &torn, "--discrete", "--size", "64x64", "--keep-going", "--out", &out]);
    assert_eq!(done.status.code(), Some(3), "{}", err(&done));
    assert!(!std::path::Path::new(&folder.path("f3.png")).exists());
}

#[test]
fn heat_is_the_number_of_contacts() {
    let folder = Folder::new("film-heat");
    // A floor that n walls stand through, each apart from the others.
    let heat = |walls: usize| {
        let mut text =
            "v 0 0 0\nv 200 0 0\nv 0 200 0\nv 300 300 300\nv 301 300 300\nv 300 301 300\n".to_owned();
        let mut faces = "f 1 2 3\nf 4 5 6\n".to_owned();
        for at in 0..walls {
            let (x, first) = (2 * at + 1, 3 * at + 7);
            text += &format!("v {x} 1 -1\nv {x} 2 -1\nv {x} 1 1\n");
            faces += &format!("f {first} {} {}\n", first + 1, first + 2);
        }
        let mesh = folder.write("heat.obj", &(text + &faces));
        let ply = folder.path("heat.ply");
        ok(&["detect", &mesh, "--out-mesh", &ply, "--heat"]);
        let out = folder.path("heat.png");
        let said = ok(&["picture", &mesh, "--heat", "--size", "64x64", "--out", &out]);
        assert!(
            said.contains(&format!(", {} in contact, at most {walls} contacts each", walls + 1)),
            "{said}"
        );
        let all = colours(&ply);
        assert!(all[1] == [190, 190, 190] && all[2..].iter().all(|of| *of == [250, 220, 60]), "{all:?}");
        all[0]
    };
    let known = [
        (1, [250, 220, 60]),
        (2, [245, 150, 40]),
        (3, [245, 150, 40]),
        (4, [220, 50, 30]),
        (15, [150, 10, 40]),
        (16, [90, 20, 120]),
        (40, [90, 20, 120]),
    ];
    for (walls, colour) in known {
        assert_eq!(heat(walls), colour, "{walls}");
    }
}
