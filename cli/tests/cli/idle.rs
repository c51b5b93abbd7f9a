//! Options that would do nothing, command by command: refused, with why.

use super::refused;

#[test]
fn options_that_would_do_nothing_are_refused() {
    const SOUP: [&str; 2] = ["--scene", "soup"];
    let walk = "gives its rest away; add --traversal per-leaf-spill";
    let queues = "the walk has no queues; add --traversal queue";
    let planned = "a plan asks a frame for its costs alone";
    let files = "nothing is made here; add --full";
    let from_files = "the bodies come from files";
    let still = "of what stands still there is one answer within the distance";
    let seedless = "is the same with every seed; leave it out, or choose one of: balls, cloth-ball";
    let of_scenes = "no figure of a single scene is measured; add --table 6.12";
    let table: [(&str, &[&str], &str); 69] = [
        ("detect", &["--scene", "draped", "--seed", "3"], "the scene draped is the same with every seed"),
        ("detect", &["--scene", "grid", "--seed", "1"], seedless),
        ("plan", &["--scene", "line", "--seed", "3"], seedless),
        ("picture", &["--scene", "identical", "--seed", "3", "--out", "x.png"], seedless),
        ("scene", &["single", "--seed", "3", "--out", "x"], seedless),
        ("tables", &["--table", "bodies", "--seed", "3"], of_scenes),
        ("tables", &["--table", "scale", "--seed", "3"], of_scenes),
        ("tables", &["--table", "scale", "--scene", "n-body"], of_scenes),
        ("tables", &["--table", "bodies", "--bv", "aabb"], of_scenes),
        ("tables", &["--table", "bodies", "--profile", "native"], of_scenes),
        ("tables", &["--table", "bodies", "--mesh", "a.ply", "b.ply"], of_scenes),
        ("tables", &["--table", "bodies", "--triangles", "9"], "scenes of one size; add --table scale"),
        ("tables", &["--devices", "2"], "the figure scale alone divides frames"),
        (
            "detect",
            &["--scene", "soup-moving", "--solver", "certified-f32", "--boxes", "9"],
            "tests no boxes",
        ),
        ("detect", &["--budget", "8"], walk),
        ("detect", &["--budget", "8", "--traversal", "per-leaf"], walk),
        ("detect", &["--budget", "8", "--traversal", "steal"], walk),
        ("detect", &["--cores", "8"], queues),
        ("detect", &["--queue", "8"], queues),
        ("detect", &["--cores", "8", "--traversal", "per-leaf"], queues),
        ("detect", &["--queue", "8", "--traversal", "per-leaf-spill"], queues),
        ("detect", &["--threads", "1", "--backend", "cuda"], "a GPU takes no CPU threads"),
        ("detect", &["--tolerance", "1"], "takes no tolerance"),
        ("detect", &["--boxes", "1"], "takes no tolerance, no budget"),
        ("detect", &["--separation", "1"], "no separation"),
        ("detect", &["--near", "1", "--tolerance", "1"], still),
        ("detect", &["--near", "1", "--boxes", "1"], still),
        ("detect", &["--near", "1", "--separation", "1"], still),
        ("detect", &["--near", "1", "--adjacent"], "those of adjacent triangles among them"),
        ("detect", &["--near", "1", "--discrete"], "cannot be used with"),
        ("detect", &["--near", "1", "--solver", "exact"], "choose one of: bounded"),
        ("plan", &["--near", "1", "--tolerance", "1"], still),
        ("detect", &["--earliest", "--adjacent"], "in a discrete query with the solver exact"),
        ("detect", &["--only", "narrow"], "--repeat"),
        ("plan", &["--repeat", "2"], planned),
        ("plan", &["--repeat", "2", "--only", "narrow"], planned),
        ("plan", &["--out", "a.csv"], planned),
        ("plan", &["--rebuild-every", "2"], planned),
        ("plan", &["--rebuild", "never"], planned),
        ("plan", &["--budget", "8"], walk),
        ("explain", &["a.ply", "--tt", "0", "1", "--tolerance", "1"], "decided exactly"),
        ("explain", &["a.ply", "--tt", "0", "1", "--boxes", "1"], "decided exactly"),
        ("scene", &["single", "--triangles", "5", "--out", "x"], "has one triangle"),
        ("scene", &["grid", "--skip", "1", "--out", "x"], "made by formula"),
        ("scene", &["soup", "--contact", "--out", "x"], "made by formula"),
        ("scene", &["soup", "--frames", "2", "--out", "x"], "which has 1"),
        ("scene", &["n-body", "--contact", "--out", "x"], "no cloth"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--frames", "3"], "the files of --mesh"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--seed", "3"], "the files of --mesh"),
        ("tables", &["--mesh", "a.ply", "b.ply", "--triangles", "3"], "the files of --mesh"),
        ("tables", &["--table", "6.12", "--rebuild-every", "3"], "no frame is measured"),
        ("tables", &["--threads", "1", "--backend", "cuda"], "a GPU takes no CPU threads"),
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
            "asked about each other",
        ),
        ("plan", &["m", "--with", "a", "b", "c"], "3 files for --with; give one, or two"),
        ("plan", &["a", "b", "c"], "3 files for the mesh; give one, or two"),
    ];
    for (command, options, why) in table {
        let is_named = !options[0].starts_with("--") || options.contains(&"--scene");
        let scene: &[&str] = if matches!(command, "detect" | "plan") && !is_named { &SOUP } else { &[] };
        let text = refused(2, &[&[command], options, scene].concat());
        assert!(text.contains(why), "{command} {options:?}: {text}");
    }
    assert!(refused(2, &["detect", "--scene", "single", "--triangles", "5"]).contains("has one triangle"));
    assert!(!std::path::Path::new("x").exists(), "nothing was made");
}
