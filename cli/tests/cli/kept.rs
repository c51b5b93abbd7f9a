//! Existing files stay until their successors are whole, also in folders that others use.

use super::{Folder, err, ok, refused, run};
use flate2::read::GzDecoder;
use std::fs;
use std::io::Read;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::process::{Command, Output};

const GRID: [&str; 5] = ["detect", "--scene", "grid", "--triangles", "16"];
const HEAD: &str = "tri_a,tri_b\n";

/// Runs a script whose `"$@"` is the program with its arguments, and whose `$FOLDER` is the test's.
fn shell(folder: &Folder, script: &str, args: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_nearmiss");
    let mut command = Command::new("sh");
    command.args(["-c", script, "sh", program]).args(args).env("FOLDER", folder.name());
    command.output().expect("a shell")
}

/// The same without the powers of root, who else writes and renames everywhere.
fn powerless(folder: &Folder, script: &str, args: &[&str]) -> Output {
    let drop = "if [ $(id -u) = 0 ]; then caps=-dac_override,-fowner; \
                set -- setpriv --bounding-set $caps --inh-caps $caps \"$@\"; fi; ";
    shell(folder, &(drop.to_owned() + script), args)
}

fn names(folder: &Folder) -> usize {
    fs::read_dir(folder.name()).expect("a folder").count()
}

#[test]
fn what_others_left_is_no_hindrance_and_stays() {
    let folder = Folder::new("left");
    let (good, new) = (folder.write("good.csv", "good\n"), folder.path("new.csv"));
    fs::hard_link(&good, folder.path("before")).expect("a link");
    // A killed run with the same number, as each first process of a container has.
    let script = "for name in good new; do echo left > \"$FOLDER/.$name.csv.$$.part\"; done; exec \"$@\"";
    for out in [&good, &new] {
        let output = shell(&folder, script, &[&GRID[..], &["--out", out]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    }
    assert!(folder.read("good.csv").starts_with(HEAD) && folder.read("new.csv").starts_with(HEAD));
    assert_eq!(folder.read("before"), "good\n", "a file that is replaced is not written over");
    let all = fs::read_dir(folder.name()).expect("a folder").map(|file| file.expect("a file").path());
    let left: Vec<_> = all.filter(|path| path.extension().is_some_and(|e| e == "part")).collect();
    assert_eq!((left.len(), names(&folder)), (4, 7));
    assert!(left.iter().all(|path| fs::read_to_string(path).expect("text") == "left\n"));
}

#[test]
fn names_may_be_long_and_permissions_stay() {
    let folder = Folder::new("modes");
    let long = folder.path(&("n".repeat(251) + ".csv"));
    let kept = folder.write("kept.csv", "");
    fs::set_permissions(&kept, fs::Permissions::from_mode(0o604)).expect("permissions");
    for (out, mode) in [(&long, 0o640), (&long, 0o640), (&kept, 0o604)] {
        let output = shell(&folder, "umask 027; exec \"$@\"", &[&GRID[..], &["--out", out]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert_eq!(fs::metadata(out).expect("a file").mode() & 0o7777, mode, "{out}");
    }
}

#[test]
fn a_link_to_nothing_is_followed_when_there_is_something() {
    let folder = Folder::new("dangling");
    fs::create_dir(folder.path("deep")).expect("a folder");
    let [first, second] = ["first.csv", "deep/second.csv"].map(|name| folder.path(name));
    symlink("deep/second.csv", &first).expect("a link");
    symlink("../made.csv", &second).expect("a link");
    let missing = folder.path("missing.ply");
    refused(3, &["detect", &missing, "--out", &first]);
    assert!(!fs::exists(folder.path("made.csv")).expect("a folder"), "nothing is made before the work");
    ok(&[&GRID[..], &["--out", &first]].concat());
    assert!(folder.read("made.csv").starts_with(HEAD));
    let is_link = |path: &String| fs::symlink_metadata(path).expect("a link").is_symlink();
    assert!(is_link(&first) && is_link(&second));
    symlink("no/such/folder/a.csv", folder.path("nowhere.csv")).expect("a link");
    for name in ["nowhere.csv", "slash.csv/"] {
        assert!(refused(4, &["detect", &missing, "--out", &folder.path(name)]).contains("cannot be written"));
    }
}

/// A mesh whose two triangles meet.
const CROSSED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 5 5 1\nf 1 2 3\nf 4 5 6\n";

fn unpacked(path: &str) -> std::io::Result<String> {
    let mut text = String::new();
    GzDecoder::new(fs::File::open(path)?).read_to_string(&mut text).map(|_| text)
}

/// A failure in the middle: standard output is full when the first of three frames is printed.
#[test]
fn half_an_answer_does_not_look_like_one() {
    let folder = Folder::new("half");
    let mesh = folder.write("mesh.obj", CROSSED);
    let ask = |out: &str| ["detect", &mesh, &mesh, &mesh, "--discrete", "--out", out].map(str::to_owned);
    let pipe = ask(&folder.path("pipe.csv.gz"));
    let script = |to: &str| {
        let read = "mkfifo \"$FOLDER/pipe.csv.gz\"; cat \"$FOLDER/pipe.csv.gz\" > \"$FOLDER/got\" & ";
        format!("{read}\"$@\" > {to}; code=$?; wait; rm \"$FOLDER/pipe.csv.gz\"; exit $code")
    };
    let output = shell(&folder, &script("/dev/null"), &pipe.each_ref().map(String::as_str));
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(unpacked(&folder.path("got")).expect("a gzip file").starts_with("step,"));
    let output = shell(&folder, &script("/dev/full"), &pipe.each_ref().map(String::as_str));
    assert_eq!(output.status.code(), Some(4), "{}", err(&output));
    assert!(unpacked(&folder.path("got")).is_err());
    // A file in a folder that takes no new ones is written in place: it keeps its number.
    for name in ["closed/a.csv", "closed/a.csv.gz"] {
        let file = folder.write(name, "what was there");
        let number = || fs::metadata(&file).expect("a file").ino();
        let (before, args) = (number(), ask(&file));
        let write = |script: &str, args: &[String]| {
            let args: Vec<&str> = args.iter().map(String::as_str).collect();
            powerless(&folder, &format!("chmod 555 \"$FOLDER/closed\"; {script}"), &args)
        };
        let output = write("\"$@\"", &args);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(number() == before && fs::metadata(&file).expect("a file").len() > 20);
        let output = write("\"$@\" > /dev/full", &args);
        assert_eq!((output.status.code(), fs::read(&file).expect("a file").len()), (Some(4), 0), "{name}");
        let output = write("\"$@\"", &ask(&folder.path("closed/new.csv")));
        assert!(err(&output).contains("cannot be written: Permission denied"), "{}", err(&output));
        fs::set_permissions(folder.path("closed"), fs::Permissions::from_mode(0o755)).expect("permissions");
    }
}

/// A mounted file where a test may mount one, and another's in a sticky folder where it may give files away.
#[test]
fn a_file_that_keeps_its_name_takes_the_answer() {
    let folder = Folder::new("mounted");
    folder.write("from.csv", "old\n");
    let to = folder.write("to.csv", "below\n");
    let args = [&GRID[..], &["--out", &to]].concat();
    let mount =
        "unshare -rm sh -c 'mount --bind \"$FOLDER/from.csv\" \"$FOLDER/to.csv\" && exec \"$@\"' sh \"$@\"";
    let may = |script: &str| shell(&folder, script, &["--version"]).status.success();
    if may(mount) {
        let output = shell(&folder, mount, &args);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(folder.read("from.csv").starts_with(HEAD) && folder.read("to.csv") == "below\n");
        assert_eq!(names(&folder), 2);
    }
    let sticky = "cd \"$FOLDER\" && mkdir sticky && echo old > sticky/a.csv && chmod 666 sticky/a.csv && \
                  chown 2 sticky/a.csv && chmod 1777 sticky && chown 1 sticky";
    if may(sticky) {
        let file = folder.path("sticky/a.csv");
        let args = [&GRID[..], &["--out", &file]].concat();
        let output = powerless(&folder, "exec \"$@\"", &args);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(folder.read("sticky/a.csv").starts_with(HEAD));
        assert_eq!(fs::metadata(&file).expect("a file").uid(), 2);
    }
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = Folder::new("inputs");
    fs::create_dir(folder.path("deep")).expect("a folder");
    let mesh = folder.path("mesh.ply");
    let other = folder.write("other.obj", CROSSED);
    ok(&["detect", &other, "--out-mesh", &mesh]);
    let before = fs::read(&mesh).expect("a mesh");
    let scene = folder.write("scene.toml", "[[body]]\nmesh = \"deep/../mesh.ply\"\n");
    let spelled = folder.path("deep/../mesh.ply");
    let links = ["link.ply", "link.csv", "link.png"].map(|name| folder.path(name));
    links.iter().for_each(|link| symlink("mesh.ply", link).expect("a link"));
    let all: [&[&str]; 9] = [
        &["detect", &mesh, "--out-mesh", &mesh],
        &["detect", &other, "--with", &mesh, "--out-mesh", &mesh],
        &["detect", &mesh, "--out-mesh", &spelled],
        &["detect", &spelled, "--out-mesh", &mesh],
        &["detect", &mesh, "--out-mesh", &links[0]],
        &["detect", &links[0], "--out-mesh", &mesh],
        &["detect", &scene, "--out-mesh", &mesh],
        &["detect", &mesh, "--out", &links[1]],
        &["picture", &mesh, "--out", &links[2]],
    ];
    for args in all {
        let said = refused(2, args);
        assert!(said.contains("would overwrite ") && said.contains("which is read"), "{args:?}: {said}");
        assert!(fs::read(&mesh).expect("a mesh") == before, "{args:?}");
    }
    // The file may be replaced if it belongs to another mesh.
    ok(&["detect", &other, "--out-mesh", &links[0]]);
}

/// A file may have half a kilobyte: the disk is full in the middle of writing.
#[test]
fn whatever_writes_a_folder_keeps_what_is_there() {
    let folder = Folder::new("folders");
    let dir = folder.path("out");
    let tables =
        ["lab", "tables", "--scene", "n-body", "--triangles", "300", "--frames", "2", "--table", "6.12"];
    let all: [(&str, &[&str]); 2] = [
        ("out/grid_t0.ply", &["lab", "scene", "grid", "--triangles", "400"]),
        ("out/figure-6.12.svg", &tables),
    ];
    for (name, args) in all {
        folder.write(name, "good\n");
        let args = [args, &["--out", &dir]].concat();
        let output = shell(&folder, "trap '' XFSZ; ulimit -f 1; exec \"$@\"", &args);
        assert_eq!(output.status.code(), Some(4), "{}", err(&output));
        assert!(err(&output).contains("cannot be written: "), "{}", err(&output));
        assert_eq!(folder.read(name), "good\n");
        assert_eq!(run(&args).status.code(), Some(0));
        assert!(fs::metadata(folder.path(name)).expect("a file").len() > 1000);
    }
}
