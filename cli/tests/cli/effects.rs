//! Every option of every command either changes what happens or is refused: none is accepted in silence.

use super::{Folder, err, ok, out, run};
use serde_json::Value;
use std::collections::BTreeSet;

/// Commands that are tried here.
const COMMANDS: [&str; 8] = ["detect", "plan", "picture", "explain", "scene", "bench", "tables", "trade"];

/// Options of commands that take long: the test that sees what each changes.
const ELSEWHERE: [(&str, &[&str], &str); 4] = [
    (
        "bench",
        &["question", "repeat", "against", "limit", "out", "json", "list", "backend"],
        "cli/tests/cli/bench.rs",
    ),
    (
        "tables",
        &["frames", "table", "bv", "out", "json", "mesh", "profile", "scene", "backend"],
        "cli/tests/tables.rs",
    ),
    ("trade", &["queries", "mesh", "truth", "out", "json", "backend"], "cli/tests/trade.rs"),
    // How much is measured, and how often.
    ("trade", &["repeat", "full"], "cli/src/trade.rs"),
];

/// A command with some arguments, then with others instead.
type Pair<'a> = (&'a str, &'a [&'a str], &'a [&'a str], &'a [&'a str]);

/// How the program ends and what it says and writes, without times and without what depends on the moment.
fn outcome(args: &[&str], folder: &Folder) -> (Option<i32>, String, String, Vec<(String, Vec<u8>)>) {
    let made = folder.path("made");
    let _ = std::fs::remove_dir_all(&made);
    std::fs::create_dir(&made).expect("a folder");
    let output = run(args);
    let text = out(&output);
    let said = serde_json::from_str::<Value>(&text).map_or(text, |mut json| {
        scrub(&mut json);
        json.to_string()
    });
    let mut files: Vec<(String, Vec<u8>)> = std::fs::read_dir(&made)
        .expect("a folder")
        .map(|file| file.expect("a file").path())
        .map(|path| (path.display().to_string(), std::fs::read(&path).expect("a file")))
        .collect();
    files.sort();
    (output.status.code(), said, err(&output), files)
}

/// Takes times out.
fn scrub(json: &mut Value) {
    match json {
        Value::Object(all) => {
            all.retain(|key, _| !matches!(key.as_str(), "ms" | "times" | "model" | "machine" | "threads"));
            all.values_mut().for_each(scrub);
        }
        Value::Array(all) => all.iter_mut().for_each(scrub),
        _ => {}
    }
}

/// The pair, if both do the same.
fn is_silent((command, base, one, two): Pair, folder: &Folder) -> Option<String> {
    let [first, second] = [one, two].map(|more| outcome(&[&[command], base, more].concat(), folder));
    (first == second).then(|| format!("{command} {}: {one:?} and {two:?} do the same", base.join(" ")))
}

/// The options that a command's help lists.
fn options(command: &str) -> BTreeSet<String> {
    let help = ok(&[command, "--help"]);
    let lines =
        help.lines().filter(|line| line.trim_start().starts_with('-') && !line.starts_with("         "));
    let names = lines.filter_map(|line| line.split_whitespace().find_map(|word| word.strip_prefix("--")));
    let names = names.map(|name| name.trim_end_matches([',', '.']).to_owned());
    names.filter(|name| !matches!(name.as_str(), "help" | "version")).collect()
}

#[test]
fn every_option_changes_something_or_is_refused() {
    let folder = Folder::new("effects");
    ok(&["scene", "soup-moving", "--triangles", "60", "--out", folder.name()]);
    ok(&["scene", "soup", "--triangles", "60", "--seed", "5", "--out", folder.name()]);
    let [t0, t1] = ["soup-moving_t0.ply", "soup-moving_t1.ply"].map(|name| folder.path(name));
    let other = folder.path("soup_t0.ply");
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 .2 -1\nv .3 .2 1\nv .2 .3 1\nf 1 2 3 4\nf 5 6 7\n";
    let quads = folder.write("quads.obj", quads);
    let note = folder.write("note.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    let seam =
        folder.write("seam.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 5 6\n");
    let fan = folder.write("fan.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv .5 .5 1\nv .5 .5 -1\nf 1 2 3\nf 1 4 5\n");
    let made = |name: &str| folder.path(&format!("made/{name}"));
    let [csv, json, ply, png, dir] = ["a.csv", "a.json", "a.ply", "a.png", ""].map(made);
    let scene: &[&str] = &["--scene", "soup-moving", "--triangles", "300", "--backend", "cpu", "--json"];
    let still: &[&str] = &["--scene", "soup", "--triangles", "300", "--backend", "cpu", "--json"];
    let files: &[&str] = &[&t0, &t1, "--backend", "cpu", "--json"];
    let drawn: &[&str] = &[&t0, &t1, "--size", "64x64", "--out", &png];
    let no: &[&str] = &[];
    let mut pairs: Vec<Pair> = vec![
        ("detect", no, &["--scene", "soup", "--triangles", "40"], &["--scene", "line", "--triangles", "40"]),
        ("detect", &["--scene", "soup"], &["--triangles", "40"], &["--triangles", "80"]),
        ("detect", still, no, &["--seed", "2"]),
        ("detect", &[&t0, "--json"], no, &["--with", &other]),
        ("detect", &[&t0, "--with", &other, "--json"], no, &["--no-self-contact"]),
        ("detect", scene, no, &["--discrete"]),
        ("detect", still, no, &["--continuous"]),
        ("detect", scene, no, &["--earliest"]),
        ("detect", scene, no, &["--near", "0.01"]),
        ("detect", &[&t0, "--with", &other, "--json"], no, &["--distance"]),
        ("detect", scene, &["--broad", "tiles"], &["--broad", "tree"]),
        (
            "detect",
            scene,
            &["--broad", "tiles", "--order", "runs"],
            &["--broad", "tiles", "--order", "median"],
        ),
        ("detect", scene, &["--bv", "aabb"], &["--bv", "obb"]),
        (
            "detect",
            scene,
            &["--broad", "tree", "--refit", "levels"],
            &["--broad", "tree", "--refit", "bottom-up"],
        ),
        ("detect", scene, &["--traversal", "per-leaf"], &["--traversal", "steal"]),
        (
            "detect",
            scene,
            &["--traversal", "per-leaf-spill", "--budget", "4"],
            &["--traversal", "per-leaf-spill"],
        ),
        (
            "detect",
            scene,
            &["--traversal", "queue", "--cores", "4"],
            &["--traversal", "queue", "--cores", "9"],
        ),
        (
            "detect",
            scene,
            &["--traversal", "queue", "--queue", "64"],
            &["--traversal", "queue", "--queue", "900"],
        ),
        ("detect", scene, no, &["--solver", "cubic-f64"]),
        ("detect", scene, no, &["--tolerance", "0.1"]),
        ("detect", scene, &["--separation", "0.1"], &["--separation", "0.1", "--boxes", "1"]),
        ("detect", scene, &["--solver", "certified-f32"], &["--solver", "certified-f32", "--boxes", "1"]),
        ("detect", scene, no, &["--separation", "0.1"]),
        ("detect", scene, no, &["--assume-free"]),
        ("detect", scene, no, &["--backend", "auto"]),
        ("detect", scene, &["--threads", "1"], &["--threads", "2"]),
        ("detect", &[&fan, "--json"], no, &["--adjacent"]),
        ("detect", &[&seam, "--json"], no, &["--weld"]),
        ("detect", &[&note, "--json"], no, &["--strict"]),
        ("detect", &[&quads, "--out", &csv], no, &["--file-faces"]),
        ("detect", files, no, &["--out", &csv]),
        ("detect", files, &["--out", &csv], &["--out", &json]),
        ("detect", &[&t0, &t1, "--out", &csv], no, &["--geometry"]),
        ("detect", &[&t0, "--json"], no, &["--out-mesh", &ply]),
        ("detect", &[&t0], no, &["--json"]),
        ("detect", &[&t0, &t1, &t0, "--json"], no, &["--repeat", "3"]),
        ("detect", files, no, &["--rebuild", "never"]),
        ("detect", files, no, &["--rebuild-every", "2"]),
        ("detect", files, &["--repeat", "2", "--only", "narrow"], &["--repeat", "2"]),
        // Options that others leave nothing to do.
        ("detect", &["--scene", "draped", "--triangles", "300", "--json"], no, &["--seed", "3"]),
        ("detect", &["--scene", "grid", "--triangles", "300", "--json"], no, &["--seed", "3"]),
        ("plan", &["--scene", "line", "--triangles", "300", "--no-run"], no, &["--seed", "3"]),
        ("picture", &["--scene", "identical", "--triangles", "30", "--out", &png], no, &["--seed", "3"]),
        ("detect", &[&t0, "--discrete", "--json"], no, &[&t1]),
        ("detect", &[&t0, "--near", "0.1", "--json"], no, &[&t1]),
        // Pictures.
        ("picture", drawn, no, &["--view", "1,0,0"]),
        ("picture", drawn, no, &["--up", "1,0,0"]),
        ("picture", drawn, no, &["--around", "contacts"]),
        ("picture", drawn, no, &["--time", "0.5"]),
        ("picture", &[&t0, "--size", "64x64", "--out", &png], no, &["--time", "0.5"]),
        ("picture", &[&t0, "--out", &png], &["--size", "64x64"], &["--size", "64x32"]),
        ("picture", &[&t0, "--size", "64x64"], no, &["--out", &png]),
        // One pair.
        ("explain", &[&t0, &t1], &["--vf", "0", "3"], &["--vf", "0", "4"]),
        ("explain", &[&t0, "--with", &other], &["--fv", "0", "3"], &["--fv", "0", "4"]),
        ("explain", &[&t0, "--vf", "0", "3"], no, &["--with", &other]),
        ("explain", &[&t0, &t1], &["--ee", "0", "3"], &["--ee", "0", "4"]),
        ("explain", &[&t0], &["--tt", "0", "3"], &["--tt", "0", "4"]),
        ("explain", &[&t0, &t1, "--vf", "0", "3"], no, &["--tolerance", "0.5"]),
        ("explain", &[&t0, &t1, "--vf", "0", "3"], no, &["--json"]),
        ("explain", &[&t0, "--tt", "0", "3"], no, &["--boxes", "2"]),
        // Scenes that are written.
        ("scene", &["soup", "--out", &dir], &["--triangles", "30"], &["--triangles", "40"]),
        ("scene", &["soup-moving", "--triangles", "30", "--out", &dir], no, &["--frames", "1"]),
        ("scene", &["soup", "--triangles", "30", "--out", &dir], no, &["--frames", "2"]),
        ("scene", &["soup", "--triangles", "30", "--out", &dir], no, &["--seed", "3"]),
        ("scene", &["n-body", "--triangles", "400", "--out", &dir], &["--skip", "0"], &["--skip", "3"]),
        ("scene", &["soup", "--triangles", "30", "--out", &dir], no, &["--contact"]),
        ("scene", &["n-body", "--triangles", "400", "--out", &dir], no, &["--contact"]),
        ("scene", &["soup", "--triangles", "30"], no, &["--out", &dir]),
        // What takes long: refusals.
        ("bench", &["--case", "draped", "--backend", "cuda"], no, &["--threads", "1"]),
        ("bench", &["--case", "lace"], no, &["--case", "draped", "--mesh", &t0]),
        ("tables", &["--table", "6.12", "--backend", "cuda"], no, &["--threads", "1"]),
        ("tables", &["--table", "bodies", "--backend", "cuda"], no, &["--triangles", "30"]),
        ("tables", &["--table", "bodies", "--backend", "cuda"], no, &["--seed", "3"]),
        ("tables", &["--table", "bodies", "--backend", "cuda"], no, &["--devices", "3"]),
        ("tables", &["--table", "6.12", "--backend", "cuda"], no, &["--rebuild-every", "3"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--threads", "1"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--scene", "n-body"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--triangles", "30"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--frames", "3"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--cases", "3"]),
        ("trade", &["--mesh", &t0, "--backend", "cuda"], no, &["--seed", "3"]),
    ];
    // A plan and a picture take what detect takes: the same pairs, with what they refuse.
    let shared: Vec<Pair> = pairs.iter().filter(|pair| pair.0 == "detect").copied().collect();
    pairs.extend(shared.iter().map(|(_, base, one, two)| ("plan", *base, *one, *two)));
    pairs.push(("plan", scene, no, &["--no-run"]));
    let silent: Vec<String> = pairs.iter().filter_map(|pair| is_silent(*pair, &folder)).collect();
    assert!(silent.is_empty(), "{}", silent.join("\n"));

    // What does the same is named.
    let planted: [Pair; 2] =
        [("detect", still, no, &["--seed", "1"]), ("detect", still, no, &["--discrete"])];
    assert!(planted.into_iter().all(|pair| is_silent(pair, &folder).is_some()));

    for command in COMMANDS {
        let given = |list: &[&str]| -> Vec<String> {
            list.iter().filter_map(|word| word.strip_prefix("--")).map(str::to_owned).collect()
        };
        let of = |pair: &&Pair| pair.0 == command || (command == "picture" && pair.0 == "detect");
        let mut tried: BTreeSet<String> = pairs
            .iter()
            .filter(of)
            .flat_map(|(_, base, one, two)| [given(base), given(one), given(two)].concat())
            .collect();
        let elsewhere = ELSEWHERE.iter().filter(|(other, ..)| *other == command);
        tried.extend(elsewhere.flat_map(|(_, options, _)| options.iter().map(|option| (*option).to_owned())));
        if command == "explain" {
            // `explain.rs` asks files of queries and points.
            tried.extend(["queries", "row", "points", "between"].map(str::to_owned));
        }
        let missing: Vec<String> =
            options(command).into_iter().filter(|name| !tried.contains(name)).collect();
        assert!(missing.is_empty(), "{command}: no pair tries {missing:?}");
    }
}
