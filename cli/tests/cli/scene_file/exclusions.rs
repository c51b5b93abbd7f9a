//! Exclusions of a scene file.

use super::*;

/// A strip of triangles that is folded, so that all of it is near; and its flat shape.
fn strip(folder: &Folder) {
    let points = |x: fn(f64) -> f64| -> String {
        (0..12).map(|i| format!("v {} {} {}\n", x(f64::from(i)), i % 2, 0.01 * f64::from(i))).collect()
    };
    let faces: String = (1..11).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    folder.write("strip.obj", &(points(|i| (i - 5.5).abs() / 2.0) + &faces));
    folder.write("flat.obj", &(points(|i| i / 2.0) + &faces));
}

#[test]
fn features_are_excluded_as_a_file_says() {
    let folder = Folder::new("scene-exclusions");
    strip(&folder);
    let rows = |own: &str, pairs: &str| {
        let bodies = format!(
            "[[body]]\nname = \"strip\"\nmesh = \"strip.obj\"\n{own}\n[[body]]\nname = \"other\"\nmesh = \"flat.obj\"\n{pairs}\n"
        );
        let (scene, csv) = (folder.write("scene.toml", &bodies), folder.path("rows.csv"));
        ok(&["detect", &scene, "--near", "0.2", "--out", &csv]);
        folder.read("rows.csv").lines().count() - 1
    };
    let whole = rows("", "");
    let mut last = whole;
    for ring in [1, 2, 3] {
        let left = rows(&format!("exclude = {{ ring = {ring} }}"), "");
        assert!(if ring == 1 { left == whole } else { left < last }, "{ring}: {left} of {last}");
        last = left;
    }
    // At its place all that is near is out; in its flat shape only neighbours are.
    let [here, flat] =
        ["", ", rest = \"flat.obj\""].map(|rest| rows(&format!("exclude = {{ within = 0.9{rest} }}"), ""));
    assert!(here < flat && flat < whole, "{here}, {flat}, {whole}");
    assert!(rows("exclude = { faces = [0, 9] }", "") < whole);
    let pairs = "[[exclude_pairs]]\nbodies = [\"strip\", \"other\"]\nvertices = [[0, 6], [11, 5]]";
    let own = "[[exclude_pairs]]\nbodies = [\"strip\", \"strip\"]\nvertices = [[0, 11]]";
    let between = rows("", pairs);
    assert!(between < whole && rows("", &format!("{pairs}\n{own}")) < between);
    assert_eq!(
        rows("exclude = {}", "[[exclude_pairs]]\nbodies = [\"strip\", \"other\"]\nvertices = []"),
        whole
    );
}

#[test]
fn exclusions_of_a_file_that_cannot_be_are_refused() {
    let folder = Folder::new("scene-exclusions-bad");
    strip(&folder);
    folder.write("small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (own, pairs, said) in [
        ("{ ring = 0 }", "", "`exclude`: the ring of neighbours of"),
        ("{ ring = -1 }", "", "-1"),
        ("{ rings = 1 }", "", "unknown field `rings`"),
        ("{ within = -1.0 }", "", "must be finite and at least 0, got -1; give a length"),
        ("{ within = nan }", "", "got NaN"),
        ("{ rest = \"flat.obj\" }", "", "`exclude` has `rest` without `within`; add the distance"),
        ("{ within = 1.0, rest = \"small.obj\" }", "", "has 3 positions, and the body 12 vertices"),
        ("{ within = 1.0, rest = \"no.obj\" }", "", "no.obj"),
        ("{ faces = [3, 10] }", "", "cannot be excluded: it has 10 faces"),
        (
            "{}",
            "bodies = [\"strip\", \"strap\"]\nvertices = []",
            "line 5: `exclude_pairs` names \"strap\", which no body is",
        ),
        (
            "{}",
            "bodies = [\"strip\", \"strip\"]\nvertices = [[1, 1]]",
            "line 5: `exclude_pairs`: pair (1, 1) of",
        ),
        (
            "{}",
            "bodies = [\"strip\", \"strip\"]\nvertices = [[1, 12]]",
            "cannot be excluded: it has 12 vertices",
        ),
        (
            "{}",
            "bodies = [\"strip\", \"strip\"]\nvertices = []\n[[exclude_pairs]]\nbodies = [\"strip\", \"strip\"]\nvertices = []",
            "line 8: `exclude_pairs` has \"strip\" and \"strip\", as that of line 5 has",
        ),
    ] {
        let table = if pairs.is_empty() { String::new() } else { format!("[[exclude_pairs]]\n{pairs}\n") };
        let text = format!("[[body]]\nname = \"strip\"\nmesh = \"strip.obj\"\nexclude = {own}\n{table}");
        let message = refused(3, &["detect", &folder.write("bad.toml", &text), "--near", "1"]);
        assert!(message.contains(said), "{own} {pairs}: {message}");
    }
    // A query that cannot obey.
    let text = "[[body]]\nname = \"strip\"\nmesh = \"strip.obj\"\nexclude = { ring = 2 }\n[[body]]\nmesh = \"flat.obj\"\n";
    let message = refused(2, &["detect", &folder.write("scene.toml", text), "--distance"]);
    assert!(message.contains("a distance query cannot leave out pairs of features"), "{message}");
}
