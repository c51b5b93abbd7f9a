//! `picture`: what is seen, in which colour, and what is refused.

use super::{Folder, ok, refused};

/// Two triangles across each other around the origin, and a single one to their right, looking along
/// y.
const MESH: &str = "v -3 0 -3\nv 3 0 -3\nv 0 0 3\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 9 0 -3\nv 15 0 -3\nv 12 0 3\n\
                    f 1 2 3\nf 4 5 6\nf 7 8 9\n";

/// A picture's width, height and pixels.
pub struct Png(pub usize, pub usize, Vec<u8>);

impl Png {
    pub fn read(path: &str) -> Png {
        let file = std::io::BufReader::new(std::fs::File::open(path).expect("written"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        let head = reader.next_frame(&mut pixels).expect("whole");
        assert_eq!((head.color_type, head.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        Png(head.width as usize, head.height as usize, pixels)
    }

    pub fn at(&self, x: usize, y: usize) -> [i32; 3] {
        let at = 3 * (y * self.0 + x);
        [0, 1, 2].map(|c| i32::from(self.2[at + c]))
    }

    /// How many pixels are far more red than green and blue.
    fn red(&self) -> usize {
        self.2.chunks(3).filter(|pixel| is_red([pixel[0], pixel[1], pixel[2]].map(i32::from))).count()
    }
}

fn is_red([r, g, b]: [i32; 3]) -> bool {
    r > 3 * g && r > 3 * b
}

/// The light colour around the bodies.
pub const PAPER: [i32; 3] = [246, 247, 249];

fn drawn(asked: &[&str], out: &str) -> (Png, String) {
    let front = ["--backend", "cpu", "--view", "0,-1,0", "--out", out];
    let said = ok(&[&["picture"], asked, &front[..]].concat());
    (Png::read(out), said)
}

#[test]
fn what_meets_is_red_and_what_does_not_is_not() {
    let folder = Folder::new("picture");
    let (mesh, out) = (folder.write("mesh.obj", MESH), folder.path("a.png"));
    let (picture, said) = drawn(&[&mesh, "--size", "200x100"], &out);
    assert!(said.ends_with("a.png: 200x100, 3 triangles, 2 red, 0 orange\n"), "{said}");
    // 18 wide in nine tenths of 200 pixels: ten pixels a unit, the middle at x = 6.
    assert_eq!((picture.0, picture.1), (200, 100));
    assert_eq!(picture.at(2, 2), PAPER);
    assert!(is_red(picture.at(40, 55)) && is_red(picture.at(40, 45)));
    let [r, g, b] = picture.at(160, 60);
    assert!(!is_red([r, g, b]) && [r, g, b] != PAPER, "{r} {g} {b}");
    // Around what meets, that is all there is.
    let (close, _) = drawn(&[&mesh, "--size", "200x100", "--around", "contacts"], &out);
    assert!(close.red() > 2 * picture.red(), "{} and {}", close.red(), picture.red());
    assert_eq!(close.at(195, 80), PAPER);
}

#[test]
fn what_is_nearer_hides_what_is_farther() {
    let folder = Folder::new("picture-depth");
    let square = |y: f64, half: f64| {
        format!(
            "v -{half} {y} -{half}\nv {half} {y} -{half}\nv {half} {y} {half}\nv -{half} {y} {half}\nf 1 2 3 4\n"
        )
    };
    let [large, small] = [("large", 0.0, 4.0), ("small", 1.0, 2.0)]
        .map(|(name, y, half)| folder.write(&format!("{name}.obj"), &square(y, half)));
    let out = folder.path("a.png");
    let size = ["--size", "100x100"];
    let both = ["--with", &small[..]];
    let (front, _) = drawn(&[&[&large[..]], &both[..], &size].concat(), &out);
    let behind =
        [&["picture", &large[..]], &both[..], &size, &["--backend", "cpu", "--view", "0,1,0", "--out", &out]];
    ok(&behind.concat());
    let behind = Png::read(&out);
    // Off the sides of the triangles, which are darker.
    let near = |a: [i32; 3], b: [i32; 3]| (0..3).all(|c| (a[c] - b[c]).abs() < 8);
    assert!(near(front.at(45, 60), front.at(10, 30)), "hidden: one colour");
    assert!(!near(behind.at(45, 60), behind.at(10, 30)), "in front: its own");
    assert!(near(behind.at(10, 30), front.at(10, 30)), "either side of a surface has its colour");
}

#[test]
fn distances_and_near_pairs_have_their_lines() {
    let folder = Folder::new("picture-lines");
    let shape = |z: f64| format!("v -2 0 {z}\nv 2 0 {z}\nv 0 0 {}\nf 1 2 3\n", 2.0 * z);
    let [above, below] =
        [("above", 1.0), ("below", -1.0)].map(|(name, z)| folder.write(&format!("{name}.obj"), &shape(z)));
    let out = folder.path("a.png");
    for asked in [&["--distance"][..], &["--near", "2"]] {
        let (picture, said) =
            drawn(&[&[&above, "--with", &below, "--size", "100x100"], asked].concat(), &out);
        assert!(said.contains("2 triangles, 2 red"), "{said}");
        // Between both there is a dark line, somewhere along the gap.
        assert!((0..100).any(|x| picture.at(x, 50).iter().sum::<i32>() < 600), "{asked:?}");
    }
    let (none, _) = drawn(&[&above, "--with", &below, "--size", "100x100"], &out);
    assert!((0..100).all(|x| none.at(x, 50) == PAPER) && none.red() == 0);
}

#[test]
fn the_same_question_has_the_same_bytes() {
    let folder = Folder::new("picture-bytes");
    let bytes = |threads: &str, name: &str| {
        let out = folder.path(name);
        let scene = ["picture", "--scene", "draped", "--triangles", "500", "--backend", "cpu"];
        ok(&[&scene[..], &["--threads", threads, "--size", "160x120", "--out", &out]].concat());
        let picture = Png::read(&out);
        assert!(picture.red() > 100, "cloth in motion meets itself");
        std::fs::read(out).expect("written")
    };
    assert_eq!(bytes("1", "a.png"), bytes("2", "b.png"));
    // The usual size.
    let out = folder.path("c.png");
    drawn(&["--scene", "grid", "--triangles", "16"], &out);
    let usual = Png::read(&out);
    assert_eq!((usual.0, usual.1), (1200, 900));
}

#[test]
fn a_scene_of_bodies_is_drawn_where_they_are() {
    let folder = Folder::new("picture-scene");
    folder.write("tri.obj", "v -2 0 -2\nv 2 0 -2\nv 0 0 2\nf 1 2 3\n");
    let scene = "[[body]]\nname = \"a\"\nkind = \"fixed\"\nmesh = \"tri.obj\"\n\
         [[body]]\nname = \"b\"\nkind = \"rigid\"\nmesh = \"tri.obj\"\nposes = [{ translation = [14, 0, 0] }]\n";
    let (picture, said) =
        drawn(&[&folder.write("scene.toml", scene), "--size", "200x100"], &folder.path("a.png"));
    assert!(said.contains("2 triangles, 0 red"), "{said}");
    let [one, other] = [picture.at(30, 60), picture.at(170, 60)];
    assert!(one != PAPER && other != PAPER && one != other && picture.at(100, 50) == PAPER);
}

#[test]
fn bodies_are_drawn_where_they_are_at_a_time() {
    let folder = Folder::new("picture-time");
    // One that falls by 8 next to one that rests; 18 wide in nine tenths of 200 pixels.
    let mesh = |x: f64, z: f64| format!("v {x} 0 {z}\nv {} 0 {z}\nv {x} 0 {}\nf 1 2 3\n", x + 2.0, z + 2.0);
    let rest = "v -2 1 -4\nv 16 1 -4\nv 16 1 -3.9\nf 1 2 3\n";
    let [from, to, rest] = [("from", mesh(0.0, 4.0)), ("to", mesh(0.0, -4.0)), ("rest", rest.to_owned())]
        .map(|(name, text)| folder.write(&format!("{name}.obj"), &text));
    let out = folder.path("a.png");
    let at = |time: &[&str]| {
        let (picture, _) =
            drawn(&[&[&from, &to, "--with", &rest, "--size", "200x200"][..], time].concat(), &out);
        let column: Vec<usize> = (0..200).filter(|y| picture.at(34, *y) != PAPER).collect();
        column[0]
    };
    let (start, middle, end) = (at(&[]), at(&["--time", "0.5"]), at(&["--time", "1"]));
    assert_eq!(at(&["--time", "0"]), start);
    assert!(start < middle && middle < end, "{start}, {middle}, {end}");
    // Poses, too.
    let scene = "[[body]]\nmesh = \"from.obj\"\nkind = \"rigid\"\n\
         poses = [{}, { translation = [0, 0, -8] }]\n[[body]]\nmesh = \"rest.obj\"\nkind = \"fixed\"\n";
    let (posed, _) = drawn(&[&folder.write("scene.toml", scene), "--size", "200x200", "--time", "0.5"], &out);
    assert_eq!((0..200).find(|y| posed.at(34, *y) != PAPER), Some(middle));
    // A body that turns by half a turn is on its arc, at x = 4 to 6. On straight lines it has no area.
    let turned = |path: &str| {
        let scene = format!(
            "[[body]]\nmesh = \"from.obj\"\nkind = \"rigid\"\n{path}\
             poses = [{{}}, {{ rotation = [0, 1, 0, 0] }}]\n[[body]]\nmesh = \"rest.obj\"\nkind = \"fixed\"\n"
        );
        let scene = folder.write("turn.toml", &scene);
        let (picture, _) = drawn(&[&scene, "--size", "200x200", "--time", "0.5"], &out);
        (0..200).filter(|y| picture.at(75, *y) != PAPER).count()
    };
    assert!(turned("") >= 10 && turned("path = \"straight\"\n") < 5, "{}", turned(""));
    for asked in [&["--discrete"][..], &["--near", "1"], &["--distance", "--with", &rest]] {
        let still = refused(2, &[&["picture", &from, "--time", "0.5", "--out", &out], asked].concat());
        assert!(still.contains("--time has no effect: a "), "{still}");
    }
    for time in ["-0.1", "1.01", "NaN", "now"] {
        let text = refused(2, &["picture", &from, &to, "--time", time, "--out", &out]);
        assert!(text.contains("give a number from 0 to 1"), "{text}");
    }
}

#[test]
fn threads_and_points_are_drawn_and_hidden() {
    let folder = Folder::new("picture-threads");
    // Seen along y: a thread in front of a wall, one behind it, one above it, and a point next to that.
    let walled = |threads: &str| {
        format!(
            "v 0 0 0\nv 10 0 0\nv 10 0 6\nv 0 0 6\nv 1 -2 1\nv 9 -2 1\nv 1 2 3\nv 9 2 3\nv 1 0 9\nv 6 0 9\n\
             v 9 0 9\nf 1 2 3 4\n{threads}"
        )
    };
    let out = folder.path("a.png");
    let shot = |threads: &str| {
        let mesh = folder.write("a.obj", &walled(threads));
        drawn(&[&mesh, "--size", "200x200"], &out).0
    };
    // The frame is the same, with an edge of the wall.
    let (bare, all) = (shot("l 9 10\np 11\nl 1 2\n"), shot("l 9 10\np 11\nl 5 6\nl 7 8\n"));
    let differ: Vec<(usize, usize)> = (0..200)
        .flat_map(|y| (0..200).map(move |x| (x, y)))
        .filter(|&(x, y)| bare.at(x, y) != all.at(x, y))
        .collect();
    assert!(!differ.is_empty(), "the thread in front of the wall is not drawn");
    let rows: std::collections::BTreeSet<usize> = differ.iter().map(|&(_, y)| y).collect();
    assert!(rows.len() <= 4, "the thread behind the wall is drawn: {rows:?}");
    let inked = |columns: std::ops::Range<usize>| {
        (0..80)
            .flat_map(|y| columns.clone().map(move |x| (x, y)))
            .filter(|&(x, y)| bare.at(x, y) != PAPER)
            .count()
    };
    assert!(inked(20..120) > 50 && inked(150..200) > 2, "{} and {}", inked(20..120), inked(150..200));
}

#[test]
fn what_cannot_be_drawn_is_refused_before_the_work() {
    let grid = ["picture", "--scene", "grid", "--triangles", "16"];
    let more = |more: &[&str]| refused(2, &[&grid[..], more].concat());
    assert!(more(&[]).contains("--out"));
    assert!(more(&["--out", "a.jpg"]).contains("--out must end in .png, got a.jpg"));
    for size in ["1200", "0x900", "15x16", "8193x100", "-3x9", "100x", "12x9x3", "1e3x9"] {
        assert!(more(&["--out", "a.png", "--size", size]).contains("from 16 to 8192"), "{size}");
    }
    for of in ["0,0,0", "1,2", "1,2,3,4", "1,NaN,0", "inf,0,0", "north"] {
        assert!(more(&["--out", "a.png", "--view", of]).contains("three numbers that are not all 0"), "{of}");
        assert!(more(&["--out", "a.png", "--up", of]).contains("three numbers that are not all 0"), "{of}");
    }
    for idle in [&["--earliest"][..], &["--repeat", "2"], &["--json"], &["--out-mesh", "a.ply"]] {
        let text = more(&[&["--out", "a.png"], idle].concat());
        assert!(text.contains("has no effect: a picture shows a frame"), "{text}");
    }
    let folder = Folder::new("picture-refused");
    let mesh = folder.write("mesh.obj", MESH);
    let out = folder.path("a.png");
    let several = refused(2, &["picture", &mesh, &mesh, &mesh, "--out", &out]);
    assert!(several.contains("--out must have a # for the number of each of 2 frames, got "), "{several}");
    assert!(!std::path::Path::new(&out).exists());
    let nowhere = folder.path("no/a.png");
    assert!(refused(4, &["picture", "no.ply", "--out", &nowhere]).contains("no/a.png: cannot be written"));
    assert!(refused(3, &["picture", "no.ply", "--out", &out]).contains("no.ply"));
    // The old file stays if the work fails.
    folder.write("a.png", "before");
    refused(3, &["picture", &folder.path("no.ply"), "--out", &out]);
    assert_eq!(folder.read("a.png"), "before");
}

#[test]
fn any_direction_and_any_mesh_can_be_drawn() {
    let folder = Folder::new("picture-any");
    let out = folder.path("a.png");
    let flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1e-30 5 5\nf 1 2 3\nf 1 1 1\n");
    let huge = folder.write("huge.obj", "v 0 0 0\nv 1e140 0 0\nv 0 1e140 0\nf 1 2 3\n");
    for mesh in [&flat, &huge] {
        for view in ["0,0,1", "0,0,-1", "1e300,0,0", "1e-300,-1e-300,0", "0,1e-8,1"] {
            ok(&["picture", mesh, "--backend", "cpu", "--size", "32x16", "--view", view, "--out", &out]);
        }
    }
    // A vertex of no triangle may be anywhere: nothing of it is seen.
    let mut bytes = ["", "v 1e60 0 0\n"].into_iter().map(|more| {
        let mesh = folder.write("far.obj", &format!("v 0 0 0\nv 4 1 0\nv 0 4 9\n{more}f 1 2 3\n"));
        drawn(&[&mesh, "--size", "64x64"], &out).0.2
    });
    assert_eq!(bytes.next(), bytes.next());
    ok(&["picture", &huge, "--backend", "cpu", "--size", "32x32", "--view", "0,0,1", "--out", &out]);
    assert_ne!(Png::read(&out).at(10, 22), PAPER);
}
