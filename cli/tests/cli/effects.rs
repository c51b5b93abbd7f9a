//! Every option of every command either changes what happens or is refused: none is accepted in
//! silence.

use super::{Folder, err, ok, out, path, run};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Commands that are tried here.
const COMMANDS: [&str; 11] =
    ["detect", "check", "plan", "picture", "view", "explain", "scene", "bench", "tables", "trade", "turns"];

/// Options of commands that take long: the test that sees what each changes.
const ELSEWHERE: [(&str, &[&str], &str); 5] = [
    ("bench", &["question", "repeat", "against", "limit", "out", "json", "list"], "tests/cli/bench.rs"),
    (
        "tables",
        &["frames", "table", "bounding-volume", "out", "json", "mesh", "profile", "scene"],
        "tests/cli/tables.rs",
    ),
    ("trade", &["queries", "mesh", "truth", "out", "json"], "tests/cli/trade.rs"),
    ("turns", &["family", "pairs", "times", "seed", "out", "json"], "tests/cli/turns.rs"),
    // How much is measured, and how often: no test has the minutes to hours that these take.
    ("trade", &["full", "repeat"], "src/lab/trade.rs"),
];

/// A command with some arguments, then with others instead.
type Pair<'a> = (&'a str, Vec<&'a str>, Vec<&'a str>, Vec<&'a str>);

/// A run of the program, without times and without what depends on the moment.
#[derive(PartialEq)]
struct Outcome {
    status: Option<i32>,
    printed: String,
    complained: String,
    /// Path and content, in the order of paths.
    files: Vec<(String, Vec<u8>)>,
}

/// Runs the program in an empty folder.
fn outcome(args: &[&str], folder: &Folder) -> Outcome {
    let made = folder.path("made");
    let _ = std::fs::remove_dir_all(&made);
    std::fs::create_dir(&made).expect("a folder");
    let output = run(args);
    let text = out(&output);
    let printed = serde_json::from_str::<Value>(&text).map_or(text, |mut json| {
        scrub(&mut json);
        json.to_string()
    });
    let mut files: Vec<(String, Vec<u8>)> = std::fs::read_dir(&made)
        .expect("a folder")
        .map(|file| file.expect("a file").path())
        .map(|path| (path.display().to_string(), std::fs::read(&path).expect("a file")))
        .collect();
    files.sort();
    Outcome { status: output.status.code(), printed, complained: err(&output), files }
}

/// Takes times out.
fn scrub(json: &mut Value) {
    match json {
        Value::Object(all) => {
            all.retain(|key, _| !matches!(key.as_str(), "ms" | "machine" | "threads"));
            all.values_mut().for_each(scrub);
        }
        Value::Array(all) => all.iter_mut().for_each(scrub),
        _ => {}
    }
}

/// Outcomes of commands. Many pairs have a command in common, which runs once.
type Known = BTreeMap<String, Outcome>;

/// The pair, if both do the same.
fn is_silent((command, base, one, two): &Pair, folder: &Folder, known: &mut Known) -> Option<String> {
    let [first, second] = [one, two].map(|more| {
        let args = [&path(command)[..], &base[..], &more[..]].concat();
        let line = args.join(" ");
        known.entry(line.clone()).or_insert_with(|| outcome(&args, folder));
        line
    });
    (known[&first] == known[&second])
        .then(|| format!("{command} {}: {one:?} and {two:?} do the same", base.join(" ")))
}

/// The options that a command's help lists.
fn options(command: &str) -> BTreeSet<String> {
    let help = ok(&[path(command), vec!["--help"]].concat());
    let lines =
        help.lines().filter(|line| line.trim_start().starts_with('-') && !line.starts_with("         "));
    let names = lines.filter_map(|line| line.split_whitespace().find_map(|word| word.strip_prefix("--")));
    let names = names.map(|name| name.trim_end_matches([',', '.']).to_owned());
    names.filter(|name| !matches!(name.as_str(), "help" | "version")).collect()
}

#[test]
fn every_option_changes_something_or_is_refused() {
    let folder = Folder::new("effects");
    ok(&["lab", "scene", "soup-moving", "--triangles", "60", "--out", folder.name()]);
    ok(&["lab", "scene", "soup", "--triangles", "60", "--seed", "5", "--out", folder.name()]);
    let [t0, t1] = ["soup-moving_t0.ply", "soup-moving_t1.ply"].map(|name| folder.path(name));
    let other = folder.path("soup_t0.ply");
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 .2 -1\nv .3 .2 1\nv .2 .3 1\nf 1 2 3 4\nf 5 6 7\n";
    let quads = folder.write("quads.obj", quads);
    let torn = folder.write("torn.obj", "v 0 x 0\nv 1 y 0\nv 0 1 0\nf 1 2 3\n");
    let note = folder.write("note.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    let seam =
        folder.write("seam.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 5 6\n");
    let fan = folder.write("fan.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv .5 .5 1\nv .5 .5 -1\nf 1 2 3\nf 1 4 5\n");
    let made = |name: &str| folder.path(&format!("made/{name}"));
    let [csv, json, ply, png, html, frames, dir] =
        ["a.csv", "a.json", "a.ply", "a.png", "a.html", "#.png", ""].map(made);
    let scene: Vec<&str> = vec!["--scene", "soup-moving", "--triangles", "300", "--backend", "cpu", "--json"];
    let still: Vec<&str> = vec!["--scene", "soup", "--triangles", "300", "--backend", "cpu", "--json"];
    let files: Vec<&str> = vec![&t0, &t1, "--backend", "cpu", "--json"];
    let drawn: Vec<&str> = vec![&t0, &t1, "--size", "64x64", "--out", &png];
    let no: Vec<&str> = Vec::new();
    let mut pairs: Vec<Pair> = vec![
        (
            "detect",
            no.clone(),
            vec!["--scene", "soup", "--triangles", "40"],
            vec!["--scene", "line", "--triangles", "40"],
        ),
        ("detect", vec!["--scene", "soup"], vec!["--triangles", "40"], vec!["--triangles", "80"]),
        ("detect", still.clone(), no.clone(), vec!["--seed", "2"]),
        ("detect", vec![&t0, "--json"], no.clone(), vec!["--with", &other]),
        ("detect", vec![&t0, "--with", &other, "--json"], no.clone(), vec!["--no-self-collision"]),
        ("detect", scene.clone(), no.clone(), vec!["--discrete"]),
        ("detect", still.clone(), no.clone(), vec!["--continuous"]),
        ("detect", scene.clone(), no.clone(), vec!["--earliest"]),
        ("detect", scene.clone(), no.clone(), vec!["--near", "0.01"]),
        ("detect", scene.clone(), vec!["--near", "0.01"], vec!["--near", "0.01", "--thickness", "0.05"]),
        ("detect", vec![&t0, "--with", &other, "--json"], no.clone(), vec!["--distance"]),
        ("detect", vec![&t0, "--with", &other, "--json"], no.clone(), vec!["--body-pairs"]),
        ("detect", vec![&t0, "--with", &other, "--json"], vec!["--distance"], vec!["--body-distances", "9"]),
        ("detect", scene.clone(), vec!["--broad-phase", "tiles"], vec!["--broad-phase", "tree"]),
        ("detect", scene.clone(), vec!["--bounding-volume", "aabb"], vec!["--bounding-volume", "obb"]),
        (
            "detect",
            scene.clone(),
            vec!["--broad-phase", "tree", "--refit", "levels"],
            vec!["--broad-phase", "tree", "--refit", "treelets"],
        ),
        ("detect", scene.clone(), vec!["--traversal", "per-leaf"], vec!["--traversal", "steal"]),
        (
            "detect",
            scene.clone(),
            vec!["--traversal", "per-leaf-spill", "--budget", "4"],
            vec!["--traversal", "per-leaf-spill"],
        ),
        (
            "detect",
            scene.clone(),
            vec!["--traversal", "queue", "--cores", "4"],
            vec!["--traversal", "queue", "--cores", "9"],
        ),
        (
            "detect",
            scene.clone(),
            vec!["--traversal", "queue", "--queue", "64"],
            vec!["--traversal", "queue", "--queue", "900"],
        ),
        ("detect", scene.clone(), no.clone(), vec!["--solver", "cubic-f64"]),
        ("detect", scene.clone(), no.clone(), vec!["--tolerance", "0.1"]),
        (
            "detect",
            scene.clone(),
            vec!["--solver", "certified-f32"],
            vec!["--solver", "certified-f32", "--max-iterations", "1"],
        ),
        ("detect", scene.clone(), no.clone(), vec!["--min-separation", "0.1"]),
        ("detect", [&scene[..], &["--min-separation", "0.1"]].concat(), no.clone(), vec!["--approaching"]),
        ("detect", scene.clone(), no.clone(), vec!["--assume-free"]),
        ("detect", files.clone(), vec!["--earliest"], vec!["--earliest", "--first-contacts"]),
        ("detect", scene.clone(), no.clone(), vec!["--backend", "auto"]),
        ("detect", scene.clone(), vec!["--threads", "1"], vec!["--threads", "2"]),
        ("detect", vec![&fan, "--json"], no.clone(), vec!["--adjacent"]),
        ("detect", vec![&seam, "--json"], no.clone(), vec!["--only-crossing"]),
        ("detect", vec![&seam, "--json"], no.clone(), vec!["--weld"]),
        ("detect", vec![&note, "--json"], no.clone(), vec!["--strict"]),
        ("detect", vec![&torn], no.clone(), vec!["--problems", "5"]),
        ("check", vec![&torn], no.clone(), vec!["--problems", "1"]),
        ("detect", vec![&quads, "--out", &csv], no.clone(), vec!["--file-faces"]),
        ("detect", files.clone(), no.clone(), vec!["--out", &csv]),
        ("detect", files.clone(), vec!["--out", &csv], vec!["--out", &json]),
        ("detect", vec![&t0, &t1, "--out", &csv], no.clone(), vec!["--geometry"]),
        ("detect", vec![&t0, "--out", &csv], no.clone(), vec!["--geometry"]),
        ("detect", vec![&t0, "--json"], no.clone(), vec!["--out-mesh", &ply]),
        ("detect", vec![&t0, "--json", "--out-mesh", &ply], no.clone(), vec!["--heat"]),
        ("detect", vec![&t0, "--json"], no.clone(), vec!["--heat"]),
        ("detect", vec![&t0, "--json"], no.clone(), vec!["--fail-on", "contacts"]),
        ("detect", vec![&t0, &t1, &quads, "--json"], no.clone(), vec!["--keep-going"]),
        ("detect", vec![&t0, "--json"], no.clone(), vec!["--keep-going"]),
        ("picture", vec![&t0, "--size", "64x64", "--out", &png], no.clone(), vec!["--heat"]),
        ("picture", vec![&t0, "--size", "64x64", "--out", &png], no.clone(), vec!["--fit", "all"]),
        (
            "picture",
            vec![&t0, &t1, &t0, "--size", "64x64", "--out", &frames],
            vec!["--fit", "all"],
            vec!["--fit", "frame"],
        ),
        ("detect", vec![&t0], no.clone(), vec!["--json"]),
        ("detect", vec![&t0], no.clone(), vec!["--verbose"]),
        ("detect", vec![&t0, &t1, &t0, "--json"], no.clone(), vec!["--repeat", "3"]),
        ("detect", files.clone(), no.clone(), vec!["--rebuild", "auto"]),
        ("detect", files.clone(), no.clone(), vec!["--rebuild-every", "2"]),
        ("detect", files.clone(), vec!["--repeat", "2", "--only", "narrow"], vec!["--repeat", "2"]),
        // Options that others leave nothing to do.
        (
            "detect",
            vec!["--scene", "draped", "--triangles", "300", "--json"],
            no.clone(),
            vec!["--seed", "3"],
        ),
        ("detect", vec!["--scene", "grid", "--triangles", "300", "--json"], no.clone(), vec!["--seed", "3"]),
        ("plan", vec!["--scene", "line", "--triangles", "300", "--no-run"], no.clone(), vec!["--seed", "3"]),
        (
            "picture",
            vec!["--scene", "identical", "--triangles", "30", "--out", &png],
            no.clone(),
            vec!["--seed", "3"],
        ),
        ("detect", vec![&t0, "--discrete", "--json"], no.clone(), vec![&t1]),
        ("detect", vec![&t0, "--near", "0.1", "--json"], no.clone(), vec![&t1]),
        // Pictures.
        ("picture", drawn.clone(), no.clone(), vec!["--view", "1,0,0"]),
        ("picture", drawn.clone(), no.clone(), vec!["--up", "1,0,0"]),
        ("picture", drawn.clone(), no.clone(), vec!["--around", "contacts"]),
        ("picture", drawn.clone(), no.clone(), vec!["--time", "0.5"]),
        ("picture", vec![&t0, "--size", "64x64", "--out", &png], no.clone(), vec!["--time", "0.5"]),
        ("picture", vec![&t0, "--out", &png], vec!["--size", "64x64"], vec!["--size", "64x32"]),
        ("picture", vec![&t0, "--size", "64x64"], no.clone(), vec!["--out", &png]),
        // Pages.
        ("view", vec![&t0, &t1, "--out", &html], no.clone(), vec!["--view", "1,0,0"]),
        ("view", vec![&t0, &t1, "--out", &html], no.clone(), vec!["--up", "1,0,0"]),
        ("view", vec![&t0, "--out", &html], no.clone(), vec!["--heat"]),
        ("view", vec![&t0], no.clone(), vec!["--out", &html]),
        // Faults of meshes.
        ("check", vec![&quads, "--json"], no.clone(), vec!["--first", "0"]),
        ("check", vec![&quads], no.clone(), vec!["--json"]),
        ("check", vec![&seam], no.clone(), vec!["--allow-touching"]),
        ("check", vec![&seam], no.clone(), vec!["--weld"]),
        ("check", vec![&note], no.clone(), vec!["--strict"]),
        ("check", vec![&t0, &other], no.clone(), vec!["--each"]),
        ("check", vec![&t0], no.clone(), vec!["--each"]),
        ("check", vec![&t0], no.clone(), vec!["--out-mesh", &ply]),
        ("check", vec![&t0], no.clone(), vec!["--picture", &png]),
        ("check", vec![&t0, "--backend", "cuda"], no.clone(), vec!["--threads", "1"]),
        ("check", vec![&t0, "--threads", "1"], vec!["--backend", "cpu"], vec!["--backend", "cuda"]),
        // One pair.
        ("explain", vec![&t0, &t1], vec!["--vf", "0", "3"], vec!["--vf", "0", "4"]),
        ("explain", vec![&t0, "--vf", "0", "3"], no.clone(), vec!["--with", &other]),
        ("explain", vec![&t0, &t1], vec!["--ee", "0", "3"], vec!["--ee", "0", "4"]),
        ("explain", vec![&t0], vec!["--tt", "0", "3"], vec!["--tt", "0", "4"]),
        ("explain", vec![&t0, &t1], vec!["--ev", "0", "12"], vec!["--ev", "0", "13"]),
        ("explain", vec![&t0, &t1], vec!["--vv", "0", "12"], vec!["--vv", "0", "13"]),
        ("explain", vec![&seam, "--ee", "0", "3"], no.clone(), vec!["--weld"]),
        ("explain", vec![&t0, &t1, "--vf", "0", "3"], no.clone(), vec!["--tolerance", "0.5"]),
        ("explain", vec![&t0, &t1, "--vf", "0", "3"], no.clone(), vec!["--json"]),
        ("explain", vec![&t0, "--tt", "0", "3"], no.clone(), vec!["--max-iterations", "2"]),
        // Scenes that are written.
        ("scene", vec!["soup", "--out", &dir], vec!["--triangles", "30"], vec!["--triangles", "40"]),
        ("scene", vec!["soup-moving", "--triangles", "30", "--out", &dir], no.clone(), vec!["--frames", "1"]),
        ("scene", vec!["soup", "--triangles", "30", "--out", &dir], no.clone(), vec!["--frames", "2"]),
        ("scene", vec!["soup", "--triangles", "30", "--out", &dir], no.clone(), vec!["--seed", "3"]),
        (
            "scene",
            vec!["n-body", "--triangles", "400", "--out", &dir],
            vec!["--skip", "0"],
            vec!["--skip", "3"],
        ),
        ("scene", vec!["soup", "--triangles", "30", "--out", &dir], no.clone(), vec!["--contact"]),
        ("scene", vec!["n-body", "--triangles", "400", "--out", &dir], no.clone(), vec!["--contact"]),
        ("scene", vec!["soup", "--triangles", "30"], no.clone(), vec!["--out", &dir]),
        // Slow options: refusals.
        ("bench", vec!["--case", "draped", "--backend", "cuda"], no.clone(), vec!["--threads", "1"]),
        ("bench", vec!["--case", "lace"], no.clone(), vec!["--case", "draped", "--mesh", &t0]),
        ("tables", vec!["--table", "6.12", "--backend", "cuda"], no.clone(), vec!["--threads", "1"]),
        ("tables", vec!["--table", "bodies", "--backend", "cuda"], no.clone(), vec!["--triangles", "30"]),
        ("tables", vec!["--table", "bodies", "--backend", "cuda"], no.clone(), vec!["--seed", "3"]),
        ("tables", vec!["--table", "bodies", "--backend", "cuda"], no.clone(), vec!["--devices", "3"]),
        ("tables", vec!["--table", "6.12", "--backend", "cuda"], no.clone(), vec!["--rebuild-every", "3"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--threads", "1"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--scene", "n-body"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--triangles", "30"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--frames", "3"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--cases", "3"]),
        ("trade", vec!["--mesh", &t0, "--backend", "cuda"], no.clone(), vec!["--seed", "3"]),
    ];
    // A plan, a picture and a page have the options of detect, by the same code.
    pairs.push(("plan", scene, no.clone(), vec!["--no-run"]));
    let mut known = Known::new();
    let silent: Vec<String> = pairs.iter().filter_map(|pair| is_silent(pair, &folder, &mut known)).collect();
    assert!(silent.is_empty(), "{}", silent.join("\n"));

    // Options without an effect are named.
    let planted: [Pair; 2] = [
        ("detect", still.clone(), no.clone(), vec!["--seed", "1"]),
        ("detect", still, no, vec!["--discrete"]),
    ];
    assert!(planted.iter().all(|pair| is_silent(pair, &folder, &mut known).is_some()));

    for command in COMMANDS {
        let given = |list: &[&str]| -> Vec<String> {
            list.iter().filter_map(|word| word.strip_prefix("--")).map(str::to_owned).collect()
        };
        let of = |pair: &&Pair| {
            pair.0 == command || (matches!(command, "picture" | "view" | "plan") && pair.0 == "detect")
        };
        let mut tried: BTreeSet<String> = pairs
            .iter()
            .filter(of)
            .flat_map(|(_, base, one, two)| [given(base), given(one), given(two)].concat())
            .collect();
        for (_, options, file) in ELSEWHERE.iter().filter(|(other, ..)| *other == command) {
            let tests = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
            let text = std::fs::read_to_string(tests).expect("a test");
            let has = |option: &str| {
                text.contains(&format!("--{option}")) || text.contains(&format!("args.{option}"))
            };
            let unseen = options.iter().find(|option| !has(option));
            assert_eq!(unseen, None, "{file} does not give it to {command}");
        }
        let elsewhere = ELSEWHERE.iter().filter(|(other, ..)| *other == command);
        tried.extend(elsewhere.flat_map(|(_, options, _)| options.iter().map(|option| (*option).to_owned())));
        if command == "explain" {
            // `explain.rs` tests files of queries and points.
            tried.extend(["queries", "row", "points", "between"].map(str::to_owned));
        }
        let missing: Vec<String> =
            options(command).into_iter().filter(|name| !tried.contains(name)).collect();
        assert!(missing.is_empty(), "{command}: no pair tries {missing:?}");
    }
}
