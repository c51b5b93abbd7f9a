//! `detect --repeat --only`: one stage, for profilers.

#[test]
fn one_stage_is_repeated() {
    let run = |more: &[&str]| {
        let scene = ["detect", "--scene", "soup-moving", "--triangles", "300", "--backend", "cpu", "--json"];
        super::run(&[&scene[..], more].concat())
    };
    let summary = |more: &[&str]| -> serde_json::Value {
        serde_json::from_slice(&run(more).stdout).expect("a summary")
    };
    let refused = |more: &[&str]| {
        let output = run(more);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    let plain = summary(&[]);
    for stage in ["construct", "fit", "refit", "traverse", "narrow", "order"] {
        let only = summary(&["--repeat", "3", "--only", stage]);
        assert_eq!(only["hash"], plain["hash"], "{stage}");
        assert!(only["ms"][stage].as_f64().expect("ms") >= 0.0, "{stage}");
    }
    assert!(refused(&["--only", "traverse"]).contains("--repeat"));
    let unknown = refused(&["--repeat", "3", "--only", "sort"]);
    assert!(unknown.contains("construct, fit, refit, traverse, narrow, order"), "{unknown}");
}
