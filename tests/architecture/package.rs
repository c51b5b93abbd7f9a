//! The packages as a stranger gets them: unpacked outside this repository, built offline with feature `cuda` and nothing set,
//! into a program that runs without a GPU and exports nothing of the driver's.

use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The packages of the library, each after those that it needs.
const PACKAGES: [&str; 4] = ["nearmiss-kernels", "nearmiss-emulator", "nearmiss", "nearmiss-io"];

/// The stranger's program.
const PROGRAM: &str = r#"
use nearmiss::{Body, Detector, Device, Discrete, device::Backend};
use nearmiss_io::{Format, MeshFile};

const FILE: &[u8] = b"v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";

fn main() -> Result<(), nearmiss::Error> {
    let mesh = MeshFile::parse("two.obj", Format::Obj, FILE)?.into_mesh();
    let device = Device::open(Backend::Auto, None)?;
    let pairs = Detector::new(device, Body::deformable(mesh))?.query(&Discrete::default())?;
    println!("{:?}", pairs.iter().map(|pair| pair.triangles).collect::<Vec<_>>());
    Ok(())
}
"#;

/// A folder outside the repository, removed at its end.
struct Outside(PathBuf);

impl Outside {
    fn new() -> Outside {
        let path = std::env::temp_dir().join(format!("nearmiss-package-{}", std::process::id()));
        assert!(!path.starts_with(ROOT), "{} is inside the repository", path.display());
        std::fs::create_dir_all(path.join("src")).expect("a folder");
        Outside(path)
    }
}

impl Drop for Outside {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs cargo without what the surrounding one has set: its output, or its standard error when it fails.
fn cargo(folder: &Path, args: &[&str]) -> Result<String, String> {
    let mut cargo = Command::new(env!("CARGO"));
    for (name, _) in std::env::vars().filter(|(name, _)| name.starts_with("CARGO") && name != "CARGO_HOME") {
        cargo.env_remove(name);
    }
    // A stranger sets nothing of ours either.
    for name in ["CUDA_LIBRARY_PATH", "NEARMISS_DATA", "NEARMISS_REQUIRE_DATA"] {
        cargo.env_remove(name);
    }
    let done = cargo.current_dir(folder).args(args).output();
    let done = done.expect("cargo starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if done.status.success() { Ok(text(&done.stdout)) } else { Err(text(&done.stderr)) }
}

/// Names of functions of the driver in a list of symbols: they must not be here for others to link with.
fn of_the_driver(symbols: &str) -> Vec<&str> {
    let of_it = |name: &&str| {
        name.strip_prefix("cu").is_some_and(|rest| rest.starts_with(|c: char| c.is_uppercase()))
    };
    symbols.split_whitespace().filter(of_it).collect()
}

#[test]
fn a_function_of_the_driver_is_noticed() {
    let symbols =
        " 31: 0000 21 FUNC GLOBAL DEFAULT 12 cuInit\n 32: 0000 21 FUNC GLOBAL DEFAULT 12 current\n custom";
    assert_eq!(of_the_driver(symbols), ["cuInit"]);
}

/// With all that it needs itself, and with no parser of arguments, plots, progress bars, CSV, big numbers or readers of
/// files among it.
#[test]
fn the_library_needs_few_crates() {
    let tree = ["tree", "--offline", "-p", "nearmiss", "-e", "normal", "--prefix", "none", "--format", "{p}"];
    let told = cargo(Path::new(ROOT), &tree).expect("a tree");
    let crates: std::collections::BTreeSet<&str> = told.lines().filter_map(|l| l.split(' ').next()).collect();
    assert!(crates.contains("bytemuck") && crates.contains("nearmiss-kernels"), "{crates:?}");
    assert!(crates.len() <= 40, "{}: {crates:?}", crates.len());
    for foreign in [
        "clap",
        "plotters",
        "indicatif",
        "csv",
        "num-bigint",
        "nearmiss-lab",
        "nearmiss-io",
        "flate2",
        "cust",
        "serde",
        "nalgebra",
    ] {
        assert!(!crates.contains(foreign), "{foreign}");
    }
}

#[test]
#[ignore = "a minute: packages are built from nothing"]
fn packages_build_anywhere() {
    let outside = Outside::new();
    let [folder, packed] = [outside.0.clone(), outside.0.join("packed")];
    let target = packed.to_str().expect("text");
    let mut package = vec!["package", "--offline", "--no-verify", "--allow-dirty", "--target-dir", target];
    package.extend(PACKAGES.iter().flat_map(|name| ["-p", name]));
    cargo(Path::new(ROOT), &package).expect("packages");
    let version = env!("CARGO_PKG_VERSION");
    for name in PACKAGES {
        let archive = packed.join(format!("package/{name}-{version}.crate"));
        let unpacked = Command::new("tar").arg("xzf").arg(&archive).current_dir(&folder).status();
        assert!(unpacked.expect("tar starts").success(), "{}", archive.display());
    }
    let manifest = format!(
        "[package]\nname = \"stranger\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         nearmiss = {{ path = \"nearmiss-{version}\", features = [\"cuda\"] }}\n\
         nearmiss-io = {{ path = \"nearmiss-io-{version}\" }}\n\n[patch.crates-io]\n\
         nearmiss = {{ path = \"nearmiss-{version}\" }}\n\
         nearmiss-emulator = {{ path = \"nearmiss-emulator-{version}\" }}\n\
         nearmiss-kernels = {{ path = \"nearmiss-kernels-{version}\" }}\n\n[workspace]\n"
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("written");
    std::fs::write(folder.join("src/main.rs"), PROGRAM).expect("written");
    cargo(&folder, &["build", "--offline"]).expect("a program");

    let program = folder.join("target/debug/stranger");
    let said = Command::new(&program).output().expect("the program starts");
    assert_eq!(String::from_utf8_lossy(&said.stdout), "[[0, 1]]\n", "{said:?}");
    let symbols = Command::new("readelf").args(["-Ws"]).arg(&program).output().expect("readelf starts");
    let symbols = String::from_utf8_lossy(&symbols.stdout);
    assert!(symbols.contains("main"), "symbols are told");
    assert_eq!(of_the_driver(&symbols), [""; 0]);
}
