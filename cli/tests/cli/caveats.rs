//! Caveats of the program's answers, as text and as JSON.

use super::ok;
use support::folder::Folder;
use support::shrinking::SHRINKING;

#[test]
fn the_program_tells() {
    let folder = Folder::new("caveats");
    let [t0, t1] = [0, 1].map(|end| {
        let corners = SHRINKING[end].map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
        folder.write(&format!("t{end}.obj"), &(corners + "f 1 2 3\nf 4 5 6\n"))
    });
    let asked = |args: &[&str], more: &[&str]| {
        let args = [&["detect", "--backend", "cpu"], args].concat();
        ok(&[&args[..], more].concat())
    };
    let run = |more: &[&str]| asked(&["--scene", "draped", "--triangles", "400"], more);
    let json = |more: &[&str]| -> serde_json::Value {
        serde_json::from_str(&run(&[more, &["--json"]].concat())).expect("JSON")
    };
    let all = json(&["--max-iterations", "1"]);
    let shrinking = asked(&[&t0, &t1], &["--max-iterations", "1", "--tolerance", "4e-3", "--json"]);
    let shrinking: serde_json::Value = serde_json::from_str(&shrinking).expect("JSON");
    let boxes = shrinking["caveats"].as_array().expect("a list").iter().find(|r| r["reason"] == "iterations");
    assert!(boxes.is_some_and(|r| r["pairs"].as_u64().is_some_and(|n| n > 0)), "{shrinking}");
    assert_eq!(all["min_separation"], 0.0);
    let plain = json(&["--discrete"]);
    assert_eq!(
        (&plain["caveats"], &plain["min_separation"]),
        (&serde_json::json!([]), &serde_json::Value::Null)
    );
    let text = asked(&[&t0, &t1], &["--max-iterations", "1", "--tolerance", "4e-3"]);
    assert!(text.contains("  caveat: ") && text.contains("raise their number"), "{text}");
    assert!(!run(&["--discrete"]).contains("caveat"));
    // Lists that grow make no answer less.
    let grown = asked(&["--scene", "identical", "--triangles", "400"], &["--json"]);
    let grown: serde_json::Value = serde_json::from_str(&grown).expect("JSON");
    assert!(grown["reruns"].as_u64() > Some(0) && grown["caveats"] == serde_json::json!([]), "{grown}");
    let grown = asked(&["--scene", "identical", "--triangles", "400"], &["-v"]);
    assert!(grown.contains("buffers grew") && !grown.contains("caveat"), "{grown}");
    assert!(plain["reruns"] == 0 && !run(&["--discrete", "-v"]).contains("buffers grew"));
    let apart = json(&["--min-separation", "0.01"]);
    assert!(
        apart["min_separation"] == 0.01 && apart["contacts"].as_u64() > all["contacts"].as_u64(),
        "{apart}"
    );
    assert!(run(&["--min-separation", "0.01", "-v"]).contains("minimum separation 1e-2"));
}
