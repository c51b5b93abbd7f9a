//! `view`: the data of the page are the answer of `detect` and the places of the files.
//! `cli/view/test` opens pages in a browser.

use super::{Folder, err, ok, refused, run};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::GzDecoder;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

/// The data of a page.
struct Page {
    text: String,
    head: Value,
}

impl Page {
    fn read(folder: &Folder, name: &str) -> Page {
        let text = folder.read(name);
        let head = Page::part(&text, "scene").expect("a head");
        let head = serde_json::from_str(head).expect("JSON");
        Page { text, head }
    }

    /// Writes a page, and reads it.
    fn written(folder: &Folder, args: &[&str]) -> Page {
        let out = folder.path("a.html");
        ok(&[&["view"], args, &["--backend", "cpu", "--out", &out]].concat());
        Page::read(folder, "a.html")
    }

    fn part<'a>(text: &'a str, id: &str) -> Option<&'a str> {
        let (_, rest) = text.split_once(&format!("id=\"{id}\">"))?;
        Some(rest.split_once("</script>").expect("an end").0)
    }

    /// The numbers of a part, of so many bytes each.
    fn numbers<const N: usize, T>(&self, id: &str, of: fn([u8; N]) -> T) -> Vec<T> {
        let part = Page::part(&self.text, id).unwrap_or_else(|| panic!("no {id}"));
        let bytes = STANDARD.decode(part).expect("base64");
        assert!(bytes.len().is_multiple_of(N), "{id}");
        bytes.chunks(N).map(|chunk| of(chunk.try_into().expect("a number"))).collect()
    }

    fn names(&self, of: &str) -> Vec<String> {
        let all = self.head["columns"][of].as_array().expect("columns");
        all.iter().map(|name| name.as_str().expect("a name").to_owned()).collect()
    }

    /// A column of the rows of a moment, as a CSV file has it.
    fn column(&self, moment: usize, name: &str) -> Vec<String> {
        let name_of = |at: u32| {
            let of = if name.starts_with("body") { None } else { Some(&self.head["names"][name]) };
            let text = of.and_then(|names| names[at as usize].as_str());
            text.map_or(at.to_string(), str::to_owned)
        };
        if let Some(at) = self.names("words").iter().position(|own| own == name) {
            let words = self.numbers(&format!("words-{moment}"), u32::from_le_bytes);
            return words.chunks(self.names("words").len()).map(|row| name_of(row[at])).collect();
        }
        let at = self.names("numbers").iter().position(|own| own == name).expect("a column");
        let all = self.numbers(&format!("numbers-{moment}"), f64::from_le_bytes);
        all.chunks(self.names("numbers").len()).map(|row| row[at].to_string()).collect()
    }

    fn places(&self, number: &Value) -> Vec<f32> {
        self.numbers(&format!("places-{number}"), f32::from_le_bytes)
    }
}

/// A column of a CSV file.
fn column(csv: &str, name: &str) -> Vec<String> {
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let at = lines.next().expect("a head").iter().position(|own| *own == name).expect("a column");
    lines.map(|row| row[at].to_owned()).collect()
}

#[test]
fn rows_are_those_of_detect() {
    let folder = Folder::new("view-rows");
    ok(&["lab", "scene", "soup-moving", "--triangles", "200", "--out", folder.name()]);
    ok(&["lab", "scene", "soup", "--triangles", "100", "--out", folder.name()]);
    let [t0, t1, other] =
        ["soup-moving_t0.ply", "soup-moving_t1.ply", "soup_t0.ply"].map(|name| folder.path(name));
    let features = ["kind", "feature_a", "feature_b"];
    let step = [&features[..], &["toi", "toi_upper", "status", "weight_0", "weight_3"]].concat();
    let near = [&features[..], &["distance", "weight_1"]].concat();
    let with = ["--with", &other[..]];
    for (files, more, names) in [
        (vec![&t0[..], &t1], vec!["--geometry"], step.clone()),
        (vec![&t0, &t1, "--min-separation", "0.01"], vec!["--geometry"], step),
        (vec![&t0, "--near", "0.05"], vec!["--geometry"], near),
        (vec![&t0], vec!["--geometry"], vec!["tri_a", "tri_b", "kind"]),
        (vec![&t0, "--solver", "moller"], vec![], vec!["tri_a", "tri_b"]),
        ([&[&t0[..]], &with[..]].concat(), vec!["--geometry"], vec!["body_a", "body_b", "tri_a", "kind"]),
        (
            [&[&t0[..], "--body-distances", "9"], &with[..]].concat(),
            vec![],
            vec!["tri_a", "tri_b", "distance"],
        ),
        ([&[&t0[..], "--distance"], &with[..]].concat(), vec![], vec!["body_a", "tri_b", "distance"]),
        ([&[&t0[..], "--body-pairs"], &with[..]].concat(), vec![], vec!["body_a", "body_b"]),
    ] {
        let page = Page::written(&folder, &files);
        let answer = ok(&[&["detect"], &files[..], &["--backend", "cpu", "--json"]].concat());
        let answer: Value = serde_json::from_str(&answer).expect("JSON");
        let last = page.head["moments"][0]["remarks"].as_array().and_then(|all| all.last());
        let hash = format!("hash {}", answer["hash"].as_str().expect("a hash"));
        assert_eq!(last.and_then(Value::as_str), Some(&hash[..]), "{files:?}");
        let csv = folder.path("a.csv");
        ok(&[&["detect"], &files[..], &more, &["--backend", "cpu", "--out", &csv]].concat());
        let csv = folder.read("a.csv");
        for name in names {
            let rows = column(&csv, name);
            assert!(!rows.is_empty() && page.column(0, name) == rows, "{files:?}: {name}");
        }
        assert_eq!(page.head["moments"][0]["rows"], csv.lines().count() - 1, "{files:?}");
    }
}

/// A triangle, and another so far above it, both far from the origin.
fn stacked(above: f64) -> String {
    let low = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let high = [[1.0, 1.0, above], [2.0, 1.0, above], [1.0, 2.0, above]];
    let points = low.iter().chain(&high);
    let lines: String = points.map(|[x, y, z]| format!("v {} {y} {z}\n", x + 1e6)).collect();
    lines + "f 1 2 3\nf 4 5 6\n"
}

#[test]
fn places_are_those_of_the_files_and_are_stored_once() {
    let folder = Folder::new("view-places");
    let films: Vec<String> = [2.0, 1.0, 1.0]
        .iter()
        .enumerate()
        .map(|(k, z)| folder.write(&format!("a.{k}.obj"), &stacked(*z)))
        .collect();
    let ground = folder.write("ground.obj", &stacked(-1.0));
    let files = [&films[0][..], &films[1], &films[2], "--with", &ground];
    let page = Page::written(&folder, &files);
    let (head, moments) = (&page.head, page.head["moments"].as_array().expect("moments"));
    assert_eq!((moments.len(), head["at_rest"].as_bool()), (2, Some(false)));
    // The ground rests, and so does the film in its second step.
    let ends = |at: usize| [&moments[at]["starts"], &moments[at]["ends"]];
    assert_eq!(ends(0)[0][1], ends(1)[1][1]);
    assert_eq!((&ends(0)[1][0], &ends(1)[0][0]), (&ends(1)[0][0], &ends(1)[1][0]));
    assert_ne!(ends(0)[0][0], ends(0)[1][0]);
    assert_eq!(page.text.matches("id=\"places-").count(), 3);
    let number = |value: &Value| value.as_f64().expect("a number");
    let side = number(&head["side"]);
    let back = |number: &Value| -> Vec<f64> {
        let middle = |k: usize| head["middle"][k].as_f64().expect("a number");
        page.places(number).iter().enumerate().map(|(k, x)| f64::from(*x) * side + middle(k % 3)).collect()
    };
    let of = |text: &str| -> Vec<f64> {
        let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
        lines.flat_map(str::split_whitespace).map(|word| word.parse().expect("a number")).collect()
    };
    for (places, text) in [(ends(0)[0], stacked(2.0)), (ends(0)[1], stacked(1.0))] {
        let (places, truth) = (back(&places[0]), of(&text));
        assert_eq!(places.len(), truth.len());
        // Single precision of a scene of side 4, not of one a million away.
        assert!(places.iter().zip(&truth).all(|(a, b)| (a - b).abs() < 1e-6), "{places:?}, {truth:?}");
    }
    assert_eq!(page.numbers("faces", u32::from_le_bytes), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
}

#[test]
fn colours_are_those_of_a_coloured_mesh() {
    let folder = Folder::new("view-colours");
    let mesh = folder.write("mesh.obj", &(stacked(0.0) + "f 1 2 4\n"));
    let page = Page::written(&folder, &[&mesh]);
    let red = 0xd2_1e_1e;
    assert_eq!(page.numbers("met-0", u32::from_le_bytes), [0, red, 1, red]);
    let heat = Page::written(&folder, &[&mesh, "--heat"]);
    assert_ne!(heat.numbers("met-0", u32::from_le_bytes), page.numbers("met-0", u32::from_le_bytes));
    assert_eq!(page.numbers("colours", |x: [u8; 1]| x[0]).len(), 9);
}

#[test]
fn frames_that_were_passed_over_have_the_reason() {
    let folder = Folder::new("view-gap");
    let [a, b, c] = [("a.1.obj", stacked(1.0)), ("a.2.obj", "v 0\n".into()), ("a.3.obj", stacked(0.0))]
        .map(|(name, text)| folder.write(name, &text));
    let out = folder.path("a.html");
    let done = run(&["view", &a, &b, &c, "--discrete", "--keep-going", "--out", &out]);
    assert_eq!(done.status.code(), Some(3), "{}", err(&done));
    let page = Page::read(&folder, "a.html");
    let moment = |at: usize| &page.head["moments"][at];
    assert!(moment(1)["reason"].as_str().is_some_and(|reason| reason.contains("a.2.obj")));
    assert_eq!((&moment(1)["rows"], moment(2)["rows"].as_u64()), (&Value::Null, Some(1)));
    assert_eq!((moment(2)["frame"].as_u64(), moment(2)["step"].as_u64()), (Some(3), Some(2)));
}

#[test]
fn a_page_holds_any_name_and_any_size() {
    let folder = Folder::new("view-any");
    folder.write("a.obj", "v 0 0 0\nv 1e140 0 0\nv 0 1e140 0\nf 1 2 3\n");
    folder.write("b.obj", "v 5 5 5\nf 1 1 1\n");
    let scene = "[[body]]\nname = \"</script><script>\"\nmesh = \"a.obj\"\n[[body]]\nmesh = \"b.obj\"\n";
    let scene = folder.write("scene.toml", scene);
    let page = Page::written(&folder, &[&scene]);
    assert_eq!(page.head["bodies"][0]["name"], "</script><script>");
    assert!(!page.text.contains("</script><script>"));
    assert!(page.places(&page.head["moments"][0]["starts"][0]).iter().all(|x| x.abs() <= 0.5));
    // A body of one point has no side.
    let point = Page::written(&folder, &[&folder.path("b.obj")]);
    assert_eq!(point.places(&point.head["moments"][0]["starts"][0]), [0.0; 3]);
    // A vertex of no triangle may be anywhere, and is in the page nevertheless.
    let far = folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e60 0 0\nf 1 2 3\n");
    let far = Page::written(&folder, &[&far]);
    let places = far.places(&far.head["moments"][0]["starts"][0]);
    assert!(places.len() == 12 && places[..9].iter().all(|x| x.abs() <= 0.5) && places[9] == 1.0);
}

#[test]
fn a_body_that_turns_has_its_quarters() {
    let folder = Folder::new("view-turn");
    folder.write("a.obj", "v 1 0 0\nv 3 0 0\nv 1 1 0\nf 1 2 3\n");
    let scene = "[[body]]\nmesh = \"a.obj\"\nkind = \"rigid\"\npivot = [1, 0, 0]\nself_collision = true\n\
                 poses = [{}, { turn = [0, 0, 3] }]\n";
    let scene = folder.write("scene.toml", scene);
    let page = Page::written(&folder, &[&scene]);
    let turn = &page.head["moments"][0]["turns"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    let (side, middle) = (number(&page.head["side"]), &page.head["middle"]);
    // The pose turns the mesh about its origin, and the pivot with it.
    for (end, pivot) in [[1.0, 0.0, 0.0], [3.0f64.cos(), 3.0f64.sin(), 0.0]].iter().enumerate() {
        let near = |k: usize| number(&turn["pivots"][end][k]) * side + number(&middle[k]) - pivot[k];
        assert!((0..3).all(|k| near(k).abs() < 1e-12), "{turn}");
    }
    for (quarter, angle) in [0.0, 0.75, 1.5, 2.25, 3.0f64].iter().enumerate() {
        let rotation = |k: usize| turn["rotations"][quarter][k].as_f64().expect("a number");
        let expected = [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()];
        assert!((0..4).all(|k| (rotation(k) - expected[k]).abs() < 1e-12), "{turn}");
    }
    // At rest nothing turns.
    let rest = Page::written(&folder, &[&scene, "--discrete"]);
    assert_eq!(rest.head["moments"][0]["turns"], serde_json::json!([]));
}

/// A film of threads alone is as large as they are.
#[test]
fn threads_are_in_the_cube_of_the_page() {
    let folder = Folder::new("view-threads");
    let frames = [0.0, 1.0, 2.0].map(|y| {
        let text = format!("v 100 {y} 0\nv 140 {y} 0\nv 120 1 -20\nv 120 1 20\nl 1 2\nl 3 4\np 1\n");
        folder.write(&format!("hair.{}.obj", 1 + y as u32), &text)
    });
    let files: Vec<&str> = frames.iter().map(String::as_str).collect();
    let page = Page::written(&folder, &[&files[..], &["--near", "0.1"]].concat());
    let places = page.places(&page.head["moments"][0]["starts"][0]);
    let widest = |axis: usize| {
        let all = || places.iter().skip(axis).step_by(3);
        all().fold(f32::MIN, |most, &x| most.max(x)) - all().fold(f32::MAX, |least, &x| least.min(x))
    };
    // Their longest side is that of the cube; none is cut off.
    assert!((widest(0) - 1.0).abs() < 1e-6 && (widest(2) - 1.0).abs() < 1e-6, "{places:?}");
    let out = folder.path("b.html");
    let printed = ok(&[&["view"], &files[..], &["--near", "0.1", "--out", &out]].concat());
    assert!(printed.contains("3 frames, 0 triangles, 2 edges and points"), "{printed}");
}

#[test]
fn the_line_has_the_size_and_bad_arguments_are_refused() {
    let folder = Folder::new("view-line");
    let mesh = folder.write("mesh.obj", &stacked(0.0));
    let out = folder.path("a.html");
    let printed = ok(&["view", &mesh, "--out", &out]);
    let size = folder.read("a.html").len() as f64 / 1e6;
    assert_eq!(printed, format!("{out}: 1 frame, 2 triangles, 1 row, {size:.1} MB\n"));
    assert!(refused(2, &["view", &mesh]).contains("--out"));
    for (more, named) in [
        (vec!["--out", "a.png"], "--out must end in .html, got a.png"),
        (vec!["--earliest", "--out", &out], "--earliest has no effect: a page shows frames and rows"),
        (vec!["--json", "--out", &out], "--json has no effect"),
        (vec!["--view", "0,0,0", "--out", &out], "give three numbers that are not all 0"),
        (vec!["--time", "0.5", "--out", &out], "unexpected argument '--time'"),
    ] {
        let text = refused(2, &[&["view", &mesh[..]], &more[..]].concat());
        assert!(text.contains(named), "{more:?}: {text}");
    }
    // The page before stays if the work fails.
    folder.write("a.html", "before");
    refused(3, &["view", &folder.path("no.ply"), "--out", &out]);
    assert_eq!(folder.read("a.html"), "before");
    let nowhere = folder.path("no/a.html");
    assert!(refused(4, &["view", &mesh, "--out", &nowhere]).contains("no/a.html: cannot be written"));
}

/// The reader of these tests sees data that are not those of `detect`.
#[test]
fn a_page_with_other_rows_is_noticed() {
    let folder = Folder::new("view-planted");
    let mesh = folder.write("mesh.obj", &stacked(0.0));
    let page = Page::written(&folder, &[&mesh]);
    assert_eq!(page.column(0, "kind"), ["overlap"]);
    let words = Page::part(&page.text, "words-0").expect("rows").to_owned();
    let bytes: Vec<u8> = [0u32, 0, 1, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let text = page.text.replace(&words, &STANDARD.encode(bytes));
    let planted = Page { text, head: page.head.clone() };
    assert_eq!(
        (planted.column(0, "tri_a"), planted.column(0, "kind")),
        (vec!["1".into()], vec!["crossing".into()])
    );
}

/// A digest of the sources of the page: `cli/view/build.mjs` computes the same.
fn digest(change: impl Fn(&str, String) -> String) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("view");
    let sources = std::fs::read_dir(root.join("src")).expect("sources");
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.expect("a file").file_name();
    let mut names: Vec<String> =
        sources.map(|entry| format!("src/{}", name(entry).to_str().expect("a name"))).collect();
    names.extend(["build.mjs", "package-lock.json", "three.LICENSE"].map(str::to_owned));
    names.sort();
    let mut hash = Sha256::new();
    for name in &names {
        let text = std::fs::read_to_string(root.join(name)).expect("a source");
        hash.update(format!("{name}\n{}", change(name, text)));
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn the_committed_page_is_that_of_its_sources() {
    let packed = include_bytes!("../../view/page.html.gz");
    let mut page = String::new();
    GzDecoder::new(&packed[..]).read_to_string(&mut page).expect("a page");
    let (_, rest) = page.split_once("<meta name=\"sources\" content=\"").expect("a digest");
    let of = rest.split('"').next();
    let advice = "the page is stale; run cli/view/build.sh and commit it";
    assert_eq!(of, Some(&digest(|_, text| text)[..]), "{advice}");
    let changed = |name: &str, text: String| if name == "src/main.js" { text + "\n" } else { text };
    assert_ne!(of, Some(&digest(changed)[..]), "a change is noticed");
    // The licence of what is built in is there.
    let licence = include_str!("../../view/three.LICENSE");
    assert!(page.contains(licence.trim()));
}
