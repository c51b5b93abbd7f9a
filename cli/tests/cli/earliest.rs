//! `--earliest` where there is little to say: nothing moves, or things meet already.

use super::{Folder, ok, summary};

const FLOOR: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";

#[test]
fn what_does_not_move_or_meets_already_is_said() {
    let folder = Folder::new("earliest");
    let floor = folder.write("floor.obj", FLOOR);
    // A triangle across the floor's plane, from one height to another.
    let across = |name: &str, z: f64| {
        folder.write(name, &format!("v 1 1 {}\nv 1 1 {}\nv 9 9 {}\nf 1 2 3\n", z - 1.0, z + 1.0, z + 1.0))
    };
    let (through, above, high) =
        (across("through.obj", 0.0), across("above.obj", 2.0), across("high.obj", 5.0));
    let lower = across("lower.obj", -0.5);
    let asked = |with: &[&str]| {
        let args = [&["detect", &floor, "--earliest", "--with"], with].concat();
        let all = summary(&[&args[..], &["--json"]].concat());
        let notes: Vec<String> = all["notes"]
            .as_array()
            .expect("notes")
            .iter()
            .map(|n| n.as_str().expect("text").to_owned())
            .collect();
        let text = ok(&args);
        assert!(notes.iter().all(|note| text.contains(note.as_str())), "{notes:?}: {text}");
        (all["pairs_at_start"].as_u64().expect("a number"), notes)
    };
    let (pairs, notes) = asked(&[&high]);
    assert!(
        pairs == 0 && notes.len() == 1 && notes[0].starts_with("nothing moves: there is one frame"),
        "{notes:?}"
    );
    let (pairs, notes) = asked(&[&high, &high]);
    assert!(pairs == 0 && notes == ["nothing moves: both frames are the same"], "{notes:?}");
    let (pairs, notes) = asked(&[&above, &through]);
    assert!(pairs == 0 && notes.is_empty(), "it meets on the way: {notes:?}");
    // An edge that is through the face already has no time of contact.
    let (pairs, notes) = asked(&[&through, &lower]);
    let meets = "1 triangle pair meets at the start of the step already";
    assert!(pairs == 1 && notes.len() == 1 && notes[0].starts_with(meets), "{notes:?}");
    let (pairs, notes) = asked(&[&through]);
    assert!(pairs == 1 && notes.len() == 2, "{notes:?}");
    // Nothing of it where all contacts are asked for, but that nothing moves.
    let all = summary(&["detect", &floor, "--with", &through, "--continuous", "--json"]);
    assert!(
        all["pairs_at_start"].is_null()
            && all["notes"][0].as_str().is_some_and(|n| n.starts_with("nothing moves"))
    );
    let all = summary(&["detect", &floor, "--with", &through, "--json"]);
    assert_eq!(all["notes"], serde_json::json!([]));
}
