//! `--near`: text, JSON, files.

use super::{Folder, err, ok, run, summary};

/// A rod over a triangle, and a point next to it.
const MESH: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 5\n";

#[test]
fn near_features_are_told() {
    let folder = Folder::new("near");
    let mesh = folder.write("mesh.obj", MESH);
    let asked = ["detect", &mesh, "--backend", "cpu", "--near", "1"];
    let text = ok(&[&asked[..], &["-v"]].concat());
    assert!(
        text.contains("near by bounded") && text.starts_with("2 pairs within 1, 2 undecided; "),
        "{text}"
    );
    // At the distance itself, to the bit: rounding cannot separate them from farther pairs.
    assert!(text.contains("caveat: 2 pairs listed, within the distance or by a rounding"), "{text}");
    let all = summary(&[&asked[..], &["--json"]].concat());
    assert_eq!(
        (&all["query"], &all["distance"], &all["undecided"]),
        (&"near".into(), &1.0.into(), &2.into()),
        "{all}"
    );
    assert_eq!(all["caveats"][0]["reason"], "distance-below-precision", "{all}");
    let more = summary(&["detect", &mesh, "--near", "1.125", "--json"]);
    assert_eq!((&more["contacts"], &more["caveats"]), (&2.into(), &serde_json::json!([])), "{more}");
    assert_eq!(summary(&["detect", &mesh, "--near", "0.99", "--json"])["contacts"], 0);

    let rows = "kind,feature_a,feature_b,squared_distance,weight_0,weight_1,weight_2,weight_3,closest\n\
                vf,3,0,1,1,0.5,0.25,0.25,vertex-face\nvf,4,0,1,1,0.25,0.5,0.25,vertex-face\n";
    let csv = folder.path("near.csv");
    ok(&[&asked[..], &["--out", &csv]].concat());
    assert_eq!(std::fs::read_to_string(&csv).expect("written"), rows);
    let json = folder.path("near.json");
    ok(&[&asked[..], &["--out", &json]].concat());
    let told: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).expect("written")).expect("JSON");
    let first = &told["contacts"][0];
    assert_eq!((&first["kind"], &first["closest"]), (&"vf".into(), &"vertex-face".into()), "{told}");
    assert_eq!(
        (&first["weights"], &first["squared_distance"]),
        (&serde_json::json!([1.0, 0.5, 0.25, 0.25]), &1.0.into())
    );
    // Faces of the file would not have the weights' corners.
    assert_eq!(run(&[&asked[..], &["--out", &csv, "--file-faces"]].concat()).status.code(), Some(2));
}

#[test]
fn lines_and_points_of_a_file_are_threads_and_points() {
    let folder = Folder::new("near-threads");
    let vertices = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0.5\nv 1 1 3\nv 1 1.2 2\nv 1 1.4 2\n";
    let mesh = folder.write("hair.obj", &format!("{vertices}p 6\nf 1 2 3\nl 4 5\np 7\n"));
    let csv = folder.path("near.csv");
    ok(&["detect", &mesh, "--backend", "cpu", "--near", "0.5", "--out", &csv]);
    let rows = std::fs::read_to_string(&csv).expect("written");
    let kinds: Vec<&str> = rows.lines().skip(1).map(|row| row.split(',').next().unwrap_or(row)).collect();
    assert_eq!(kinds, ["vf", "ev", "ev", "vv"], "{rows}");
    let text = ok(&["detect", &mesh, "--backend", "cpu", "--near", "0.5", "-v"]);
    assert!(text.contains("1 triangle, 1 edge, 2 points, 7 vertices"), "{text}");
    // Each row can be explained: the same distance, exactly.
    for (pair, features) in [(["--ev", "0", "5"], "vertex 5 of"), (["--vv", "5", "6"], "vertex 6 of")] {
        let text = ok(&[&["explain"], &pair[..], &[&mesh]].concat());
        assert!(text.contains(features), "{text}");
    }
    let far = run(&["explain", "--ev", "9", "5", &mesh]);
    assert!(err(&far).contains("edge 9"), "{}", err(&far));
    // A frame of it has the same lines.
    let other = folder.write("other.obj", &format!("{vertices}p 6\nf 1 2 3\nl 4 6\np 7\n"));
    let refused = run(&["detect", &mesh, &other, "--backend", "cpu"]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(err(&refused).contains("has other edges than the first frame"), "{}", err(&refused));
}

/// A face that is pierced in its middle has no features near: what crosses is named, too.
#[test]
fn what_crosses_is_named_with_what_is_near() {
    let folder = Folder::new("near-pierced");
    let wide = folder.write("wide.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    let thin = folder.write("thin.obj", "v 0 0 -9\nv 0 0 9\nv 0 0.1 9\nf 1 2 3\n");
    let ask = ["detect", &wide, "--with", &thin, "--backend", "cpu", "--near", "0.5"];
    let text = ok(&ask);
    assert!(text.starts_with("0 pairs within 0.5, 1 triangle pair meets; "), "{text}");
    assert_eq!(summary(&[&ask[..], &["--json"]].concat())["crossing"], 1);
    assert_eq!(run(&[&ask[..], &["--fail-on", "contacts"]].concat()).status.code(), Some(1));
    let apart = folder.write("apart.obj", "v 0 0 1\nv 0 0 9\nv 0 0.1 9\nf 1 2 3\n");
    let ask = ["detect", &wide, "--with", &apart, "--near", "0.5", "--fail-on", "contacts"];
    assert!(ok(&ask).starts_with("0 pairs within 0.5; "));
    for query in [&["--body-pairs"][..], &["--body-distances", "1"]] {
        let alone = ok(&[&["detect", &wide], query].concat());
        assert!(alone.contains("no two bodies may meet"), "{alone}");
        let two = ok(&[&["detect", &wide, "--with", &apart], query].concat());
        assert!(!two.contains("no two bodies may meet"), "{two}");
    }
}

#[test]
fn a_plan_names_the_distance() {
    let text =
        ok(&["lab", "plan", "--scene", "soup", "--triangles", "20", "--backend", "cpu", "--near", "0.5"]);
    assert!(
        text.contains("distance        5e-1, as given") && text.contains("solver          bounded: "),
        "{text}"
    );
}
