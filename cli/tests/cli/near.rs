//! `--near`: text, JSON, files.

use super::{Folder, ok, run, summary};

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
fn a_plan_names_the_distance() {
    let text =
        ok(&["lab", "plan", "--scene", "soup", "--triangles", "20", "--backend", "cpu", "--near", "0.5"]);
    assert!(
        text.contains("distance        5e-1, as given") && text.contains("solver          bounded: "),
        "{text}"
    );
}
