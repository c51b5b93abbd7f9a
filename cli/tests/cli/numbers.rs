//! Numbers that begin with a minus are arguments, and are refused as numbers. Threads have a cap.

use super::{err, refused, run, summary};

#[test]
fn numbers_below_zero_reach_the_checks() {
    let scene = ["detect", "--scene", "soup-moving", "--triangles", "20"];
    for (option, said) in [
        ("--tolerance", "tolerance must be finite and at least 0, got -"),
        ("--min-separation", "minimum separation must be finite and at least 0, got -"),
        ("--near", "distance must be finite and at least 0, got -"),
    ] {
        for number in ["-3e-5", "-1", "-0.5", "-1e300", "-inf", "-.5"] {
            let joined = format!("{option}={number}");
            for args in [&[option, number][..], &[&joined]] {
                let text = refused(2, &[&scene[..], args].concat());
                assert!(text.starts_with("nearmiss: ") && text.contains(said), "{args:?}: {text}");
            }
        }
    }
    let text = refused(2, &["explain", "a.ply", "--vf", "0", "0", "--tolerance", "-3e-5"]);
    assert!(text.contains("--tolerance must be finite and at least 0, got -0.00003"), "{text}");
    // Before anything is read.
    let text = refused(2, &["detect", "no.ply", "no.ply", "--tolerance", "-3e-5"]);
    assert!(text.contains("tolerance must be finite and at least 0, got -0.00003"), "{text}");
    for args in [
        &["detect", "a.ply", "--threads"][..],
        &["detect", "a.ply", "--repeat"],
        &["detect", "a.ply", "--problems"],
        &["check", "a.ply", "--problems"],
        &["check", "a.ply", "--first"],
        &["detect", "a.ply", "--max-iterations"],
        &["detect", "a.ply", "--budget"],
        &["detect", "a.ply", "--cores"],
        &["detect", "a.ply", "--queue"],
        &["detect", "--scene", "soup", "--triangles"],
        &["detect", "--scene", "soup", "--seed"],
        &["lab", "scene", "n-body", "--out", "x", "--frames"],
        &["lab", "scene", "n-body", "--out", "x", "--skip"],
        &["lab", "tables", "--frames"],
        &["lab", "tables", "--triangles"],
        &["lab", "tables", "--rebuild-every"],
        &["lab", "trade", "--cases"],
        &["lab", "trade", "--repeat"],
        &["selftest", "--cases"],
        &["selftest", "--triangles"],
        &["explain", "a.ply", "--vf", "0"],
        &["explain", "--queries", "a.csv", "--row"],
    ] {
        for number in ["-1", "1.5", "many", "99999999999999999999"] {
            let text = refused(2, &[args, &[number]].concat());
            assert!(text.contains("give a whole number from "), "{args:?} {number}: {text}");
        }
    }
    for args in [
        &["detect", "a.ply", "--threads", "0"][..],
        &["lab", "trade", "--cases", "0"],
        &["lab", "tables", "--frames", "1"],
    ] {
        assert!(refused(2, args).contains("give a whole number from "), "{args:?}");
    }
}

#[test]
fn more_threads_than_processors_are_not_taken() {
    let all = std::thread::available_parallelism().expect("a number").get();
    let with = |threads: usize| {
        let threads = threads.to_string();
        let output = run(&[
            "detect",
            "--scene",
            "grid",
            "--triangles",
            "16",
            "--backend",
            "cpu",
            "--threads",
            &threads,
            "-v",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        (super::out(&output), err(&output))
    };
    let (text, said) = with(all);
    assert!(said.is_empty(), "{said}");
    let (more, said) = with(all + 1);
    assert!(said.contains(&format!("--threads {} exceeds the {all} processor", all + 1)), "{said}");
    let named = |text: &str| text.lines().find_map(|line| line.split(" on ").nth(1).map(str::to_owned));
    assert_eq!(named(&more), named(&text));
    assert_eq!(
        summary(&[
            "detect",
            "--scene",
            "grid",
            "--triangles",
            "16",
            "--backend",
            "cpu",
            "--threads",
            "1",
            "--json"
        ])["device"],
        "CPU, 1 thread"
    );
}
