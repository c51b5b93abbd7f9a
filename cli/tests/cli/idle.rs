//! Options without an effect, command by command: refused, with the reason.

use super::{path, refused};

#[test]
fn options_without_an_effect_are_refused() {
    const SOUP: [&str; 2] = ["--scene", "soup"];
    let walk = "only the walk per-leaf-spill spills; remove it, or add --traversal per-leaf-spill";
    let queues = "the walk has no queues; remove it, or add --traversal queue";
    let planned = "has no effect: a plan shows the costs of one frame; remove it, or use detect";
    let files = "generate no scenes and cases; remove it, or add --full";
    let from_files = "the bodies are read from files";
    let still = "the distances at t = 0 have no such limit";
    let seedless = "has no random numbers; remove it, or use one of: balls, cloth-ball";
    let of_scenes = "no table of a single scene is measured; remove it, or add --table 6.12";
    let table: [(&str, &[&str], &str); 72] = [
        (
            "detect",
            &["--scene", "draped", "--seed", "3"],
            "--seed has no effect: the scene draped has no random numbers",
        ),
        ("detect", &["--scene", "grid", "--seed", "1"], seedless),
        ("plan", &["--scene", "line", "--seed", "3"], seedless),
        ("picture", &["--scene", "identical", "--seed", "3", "--out", "x.png"], seedless),
        ("scene", &["single", "--seed", "3", "--out", "x"], seedless),
        ("tables", &["--table", "bodies", "--seed", "3"], of_scenes),
        ("tables", &["--table", "scale", "--seed", "3"], of_scenes),
        ("tables", &["--table", "scale", "--scene", "n-body"], of_scenes),
        ("tables", &["--table", "bodies", "--bounding-volume", "aabb"], of_scenes),
        ("tables", &["--table", "bodies", "--profile", "native"], of_scenes),
        ("tables", &["--table", "bodies", "--mesh", "a.ply", "b.ply"], of_scenes),
        (
            "tables",
            &["--table", "bodies", "--triangles", "9"],
            "have one size; remove it, or add --table scale",
        ),
        ("tables", &["--devices", "2"], "only the table scale divides frames"),
        (
            "detect",
            &["--scene", "soup-moving", "--solver", "certified-f32", "--max-iterations", "9"],
            "tests no boxes",
        ),
        ("detect", &["--budget", "8"], walk),
        ("detect", &["--budget", "8", "--traversal", "per-leaf"], walk),
        ("detect", &["--budget", "8", "--traversal", "steal"], walk),
        ("detect", &["--cores", "8"], queues),
        ("detect", &["--queue", "8"], queues),
        ("detect", &["--cores", "8", "--traversal", "per-leaf"], queues),
        ("detect", &["--queue", "8", "--traversal", "per-leaf-spill"], queues),
        ("detect", &["--threads", "1", "--backend", "cuda"], "a GPU has no CPU threads"),
        ("detect", &["--tolerance", "1"], "--tolerance cannot be used with --solver exact"),
        ("detect", &["--max-iterations", "1"], "--max-iterations cannot be used with --solver exact"),
        ("detect", &["--min-separation", "1"], "--min-separation cannot be used with --solver exact"),
        ("detect", &["--near", "1", "--tolerance", "1"], still),
        ("detect", &["--near", "1", "--max-iterations", "1"], still),
        ("detect", &["--near", "1", "--min-separation", "1"], still),
        ("detect", &["--near", "1", "--adjacent"], "features of adjacent triangles are always tested"),
        ("detect", &["--near", "1", "--only-crossing"], "near features do not show it"),
        ("detect", &["--distance", "--only-crossing"], "never within one"),
        ("detect", &["--earliest", "--only-crossing"], "use --discrete with the solver exact"),
        ("detect", &["--near", "1", "--discrete"], "cannot be used with"),
        ("detect", &["--near", "1", "--solver", "exact"], "use one of: bounded"),
        ("plan", &["--near", "1", "--tolerance", "1"], still),
        ("detect", &["--earliest", "--adjacent"], "use --discrete with the solver exact"),
        ("detect", &["--only", "narrow"], "--repeat"),
        ("plan", &["--repeat", "2"], planned),
        ("plan", &["--repeat", "2", "--only", "narrow"], planned),
        ("plan", &["--out", "a.csv"], planned),
        ("plan", &["--rebuild-every", "2"], planned),
        ("plan", &["--rebuild", "auto"], planned),
        ("plan", &["--budget", "8"], walk),
        ("explain", &["a.ply", "--tt", "0", "1", "--tolerance", "1"], "decided exactly"),
        ("explain", &["a.ply", "--tt", "0", "1", "--max-iterations", "1"], "decided exactly"),
        ("scene", &["single", "--triangles", "5", "--out", "x"], "has one triangle"),
        ("scene", &["grid", "--skip", "1", "--out", "x"], "is not simulated"),
        ("scene", &["soup", "--contact", "--out", "x"], "is not simulated"),
        ("scene", &["soup", "--frames", "2", "--out", "x"], "at most 1 for the scene soup, got 2"),
        ("scene", &["n-body", "--contact", "--out", "x"], "no cloth"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--frames", "3"], "the frames are read from --mesh"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--seed", "3"], "the frames are read from --mesh"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--triangles", "3"], "the frames are read from --mesh"),
        ("tables", &["--table", "6.12", "--rebuild-every", "3"], "no frame is measured"),
        ("tables", &["--threads", "1", "--backend", "cuda"], "a GPU has no CPU threads"),
        ("trade", &["--mesh", "a.ply", "--scene", "n-body"], files),
        ("trade", &["--mesh", "a.ply", "--triangles", "9"], files),
        ("trade", &["--queries", "a", "--frames", "9"], files),
        ("trade", &["--queries", "a", "--cases", "9"], files),
        ("trade", &["--queries", "a", "--seed", "9"], files),
        ("trade", &["--truth", "a.csv"], "--mesh"),
        ("detect", &["a.ply", "--triangles", "10"], from_files),
        ("detect", &["a.ply", "--seed", "3"], from_files),
        ("detect", &["a.ply", "--with", "b.ply", "--seed", "3"], from_files),
        ("plan", &["a.ply", "--triangles", "10"], from_files),
        ("picture", &["a.ply", "--seed", "3", "--out", "x.png"], from_files),
        ("detect", &["a.ply", "--no-self-collision"], "there is no second mesh"),
        ("plan", &["a.toml", "--no-self-collision"], "self_collision = false"),
        ("detect", &["--scene", "soup", "--no-self-collision"], "there is no second mesh"),
        (
            "detect",
            &["a.ply", "--with", "b.ply", "--distance", "--no-self-collision"],
            "between bodies, never within one",
        ),
        ("plan", &["m", "--with", "a", "b", "c"], "--with takes one or two files, got 3; give one mesh"),
        ("plan", &["a", "b", "c"], "MESH takes one or two files, got 3; give one mesh"),
    ];
    for (command, options, why) in table {
        let is_named = !options[0].starts_with("--") || options.contains(&"--scene");
        let scene: &[&str] = if matches!(command, "detect" | "plan") && !is_named { &SOUP } else { &[] };
        let text = refused(2, &[&path(command)[..], options, scene].concat());
        assert!(text.contains(why), "{command} {options:?}: {text}");
    }
    assert!(refused(2, &["detect", "--scene", "single", "--triangles", "5"]).contains("has one triangle"));
    assert!(!std::path::Path::new("x").exists(), "nothing was made");
}
