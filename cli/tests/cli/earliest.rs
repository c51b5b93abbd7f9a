//! `--earliest`: where nothing moves or things meet already, and the contacts at that time.

use super::{Folder, ok, refused, summary};

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
    for question in ["--earliest", "--continuous"] {
        let asked = |with: &[&str]| {
            let args = [&["detect", &floor, question, "--with"], with].concat();
            let all = summary(&[&args[..], &["--json"]].concat());
            let notes: Vec<String> = all["notes"]
                .as_array()
                .expect("notes")
                .iter()
                .map(|n| n.as_str().expect("text").to_owned())
                .collect();
            let text = ok(&args);
            assert!(notes.iter().all(|note| text.contains(note.as_str())), "{notes:?}: {text}");
            (all["starts_crossing"].as_u64().expect("a number"), notes)
        };
        let (pairs, notes) = asked(&[&high]);
        let still = "nothing moves: there is one frame";
        assert!(pairs == 0 && notes.len() == 1 && notes[0].starts_with(still), "{notes:?}");
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
        // Not counted where that is assumed, and the same answer.
        let args = ["detect", &floor, question, "--with", &through, &lower, "--json"];
        let (checked, assumed) = (summary(&args), summary(&[&args[..], &["--assume-free"]].concat()));
        assert!(
            assumed["starts_crossing"].is_null() && assumed["notes"] == serde_json::json!([]),
            "{assumed}"
        );
        assert_eq!(assumed["hash"], checked["hash"]);
    }
    // Nothing of it of what stands still.
    let all = summary(&["detect", &floor, "--with", &through, "--json"]);
    assert!(all["starts_crossing"].is_null() && all["notes"] == serde_json::json!([]), "{all}");
    for more in [&[][..], &["--discrete"], &["--near", "1"], &["--distance"]] {
        let text = refused(2, &[&["detect", &floor, "--with", &through, "--assume-free"], more].concat());
        assert!(text.contains("--assume-free"), "{text}");
    }
}

/// The rows of `--first-contacts` are those of `--continuous` with the least time, in every kind of
/// file.
#[test]
fn first_contacts_are_rows_of_all_contacts() {
    let folder = Folder::new("first");
    let scene = ["detect", "--scene", "soup-moving", "--triangles", "300"];
    let rows = |name: &str, more: &[&str]| {
        let file = folder.path(name);
        ok(&[&scene[..], more, &["--out", &file]].concat());
        folder.read(name)
    };
    let all = rows("all.csv", &["--continuous"]);
    let column = all.lines().next().expect("a head").split(',').position(|name| name == "toi");
    let toi = |row: &str| row.split(',').nth(column.expect("a time")).expect("a field").parse::<f64>();
    let times = all.lines().skip(1).map(|row| toi(row).expect("a number"));
    let least = times.min_by(f64::total_cmp).expect("some meet");
    let wanted: Vec<&str> =
        all.lines().take(1).chain(all.lines().skip(1).filter(|row| toi(row) == Ok(least))).collect();
    let first = ["--earliest", "--first-contacts"];
    let found = rows("first.csv", &first);
    assert_eq!(found.lines().collect::<Vec<_>>(), wanted);
    assert!(wanted.len() > 1 && all.lines().count() > 2 * wanted.len());
    let placed = rows("placed.csv", &[&first[..], &["--geometry"]].concat());
    assert_eq!(placed.lines().count(), wanted.len());
    assert!(rows("first.vtp", &first).contains("<VTKFile"));
    let told = summary(&[&scene[..], &first, &["--json"]].concat());
    assert_eq!(told["contacts"], wanted.len() - 1);
    // A film has the rows of each step, and those of a step without a contact.
    let files = super::film::falling(&folder);
    let film: Vec<&str> = std::iter::once("detect").chain(files.iter().map(String::as_str)).collect();
    for more in [&[][..], &["--geometry"]] {
        let file = folder.path("film.csv");
        let text = ok(&[&film[..], &first, more, &["--out", &file]].concat());
        assert!(text.contains("step 1001") && !text.contains("0 contacts; 0 ms"), "{text}");
        let written = folder.read("film.csv");
        assert!(written.starts_with("step,frame,file,kind,feature_a,"), "{written}");
        let steps: Vec<&str> =
            written.lines().skip(1).map(|row| row.split(',').nth(1).unwrap_or(row)).collect();
        assert_eq!(steps, ["1002", "1002", "1003"], "{written}");
    }
    let marked = folder.path("marked.ply");
    ok(&[&scene[..], &first, &["--out-mesh", &marked]].concat());
    for needs in [&["--out-mesh", &marked][..], &["--geometry", "--out", &marked.replace(".ply", ".csv")]] {
        let text = refused(2, &[&scene[..], &["--earliest"], needs].concat());
        assert!(text.contains("add --first-contacts"), "{text}");
    }
    assert!(refused(2, &[&scene[..], &["--first-contacts"]].concat()).contains("--earliest"));
}
