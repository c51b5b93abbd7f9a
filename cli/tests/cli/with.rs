//! Which files are the mesh's and which the other's: the rule of `--with`.

use super::{Folder, ok, refused, summary};

#[test]
fn the_other_mesh_may_stand_before_or_behind() {
    let folder = Folder::new("with-order");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    // It falls through the first.
    let [b0, b1] = [("b0.obj", 1), ("b1.obj", -1)].map(|(name, z)| {
        folder.write(name, &format!("v 0.25 0.25 {z}\nv 0.25 0.25 {}\nv 5 5 3\nf 1 2 3\n", z + 2))
    });
    let hash = |args: &[&str]| {
        let all = summary(&[&["detect", "--json"], args].concat());
        (all["hash"].as_str().expect("a hash").to_owned(), all["frames"].as_u64())
    };
    let still = hash(&[&a, "--with", &b1]);
    assert_eq!(still.1, Some(1));
    assert_eq!(hash(&["--with", &b1, &a]), still);
    assert_eq!(hash(&["--with", &b1, "--discrete", &a]), still);
    let moving = hash(&[&a, &a, "--with", &b0, &b1]);
    assert_eq!(moving.1, Some(2));
    let same: [&[&str]; 6] = [
        &[&a, &a, "--with", &b0, "--with", &b1],
        &["--with", &b0, "--with", &b1, &a, &a],
        &["--with", &b0, &a, &a, "--with", &b1],
        &["--with", &b0, "--with", &b1, &a],
        &[&a, "--with", &b0, &b1, "--continuous"],
        &[&a, "--with", &b0, "--continuous", "--with", &b1],
    ];
    for args in same {
        assert_eq!(hash(args), moving, "{args:?}");
    }
    // Not right behind it: the mesh's own.
    let frames = summary(&["detect", "--json", &a, "--with", &b1, "--discrete", &a]);
    assert_eq!(frames["steps"].as_array().map(Vec::len), Some(2), "{frames}");
    assert!(ok(&["lab", "plan", "--with", &b0, &a]).contains("discrete, within and between bodies"));
    let between = ["lab", "plan", "--with", &b0, &a, "--no-self-collision"];
    assert!(ok(&between).contains("discrete, between bodies"));

    let explained = ok(&["explain", "--with", &a, "--with", &a, &b0, &b1, "--vf", "0", "0"]);
    assert!(explained.contains("vertex 0 of ") && explained.contains("t = 1/2"), "{explained}");
}

#[test]
fn three_files_are_too_many_for_a_pair() {
    for (args, said) in [
        (
            &["explain", "a", "--with", "b", "c", "d", "--vf", "0", "0"][..],
            "--with takes one or two files, got 3",
        ),
        (
            &["explain", "--with", "b", "--with", "c", "--with", "d", "a", "--vf", "0", "0"],
            "--with takes one or two files, got 3",
        ),
        (&["explain", "a", "b", "c", "--vf", "0", "0"], "MESH takes one or two files, got 3"),
    ] {
        let text = refused(2, args);
        assert!(text.contains(said) && text.contains("give one mesh, or both ends"), "{args:?}: {text}");
    }
    assert!(ok(&["detect", "--help"]).contains("--with B0 --with B1 A0 A1"));
}
