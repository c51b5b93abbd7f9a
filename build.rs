//! Embeds the kernels' compressed PTX, with feature `cuda`. Sets the cfg `public_data` if there are
//! public test data.
//!
//! The PTX in the kernels' package is used if it has the stamp of the kernels' sources. Otherwise
//! the kernels are compiled, if this machine has a device compiler (kernels/ptx.sh); if it has
//! none, the build stops.
//!
//! Machine code is embedded too, from the file that `NEARMISS_CUBINS` names (.ci/cubins.sh
//! makes it). Code of another PTX stops the build.
//!
//! The library gets `NEARMISS_STAMP` (16 hex digits) from the environment and the text from
//! `OUT_DIR`.

#[cfg(feature = "cuda")]
#[allow(dead_code, reason = "the library uses the rest")]
#[path = "host/device/code/cubins.rs"]
mod cubins;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    look_for_test_data();
    #[cfg(feature = "cuda")]
    ptx::embed();
}

/// Sets `public_data` if the folder of public test data exists: `NEARMISS_DATA`, else a folder next
/// to the repository. Otherwise the tests that need it are ignored.
fn look_for_test_data() {
    println!("cargo::rustc-check-cfg=cfg(public_data)");
    println!("cargo::rerun-if-env-changed=NEARMISS_DATA");
    let folder = std::env::var("NEARMISS_DATA").unwrap_or("../shared/data".into());
    if std::path::Path::new(&folder).is_dir() {
        println!("cargo::rustc-cfg=public_data");
    }
}

#[cfg(feature = "cuda")]
mod ptx {
    use super::cubins::Cubins;
    use sha2::{Digest, Sha256};
    use std::io::{BufRead, BufReader};
    use std::path::{Path, PathBuf};
    use std::process::Command;
    use std::{env, fs};

    const PTX: &str = "nearmiss.ptx.zst";
    const CUBINS: &str = "NEARMISS_CUBINS";

    pub fn embed() {
        let folder = |name| PathBuf::from(env::var_os(name).unwrap_or_else(|| panic!("cargo sets {name}")));
        // The output of kernels/build.rs: the folder of that package, in this repository or in a
        // registry.
        let (kernels, out) = (folder("DEP_NEARMISS_KERNELS_ROOT"), folder("OUT_DIR"));
        for path in ["src", "Cargo.toml", PTX] {
            println!("cargo::rerun-if-changed={}", kernels.join(path).display());
        }
        println!("cargo::rerun-if-env-changed=NEARMISS_DEVICE_RUSTC");

        let text = out.join(PTX);
        let stamp = stamp(&kernels);
        let packaged = fs::read(kernels.join(PTX)).unwrap_or_default();
        if is_made_from(&packaged, &stamp) {
            fs::write(&text, packaged).expect("OUT_DIR takes the PTX");
        } else {
            compile(&kernels, &out, &text, &stamp);
        }
        println!("cargo::rustc-env=NEARMISS_STAMP={stamp}");
        println!("cargo::rerun-if-env-changed={CUBINS}");
        fs::write(out.join("nearmiss.cubins"), machine_code(&text)).expect("OUT_DIR takes machine code");
    }

    /// The file of machine code that the environment names; empty if it names none.
    fn machine_code(ptx: &Path) -> Vec<u8> {
        let Some(name) = env::var_os(CUBINS).filter(|name| !name.is_empty()) else { return Vec::new() };
        println!("cargo::rerun-if-changed={}", Path::new(&name).display());
        let digest = |bytes: &[u8]| hex(&Sha256::digest(bytes));
        let file = fs::read(&name).map_err(|error| error.to_string());
        let whole = file.and_then(|file| {
            let ptx = digest(&fs::read(ptx).map_err(|error| error.to_string())?);
            Cubins::new(&file)?.matches(&ptx, digest)?;
            Ok(file)
        });
        whole.unwrap_or_else(|why| {
            eprintln!("the machine code in {} cannot be used: {why}.", Path::new(&name).display());
            eprintln!("Make it again by .ci/cubins.sh, or unset {CUBINS}.");
            std::process::exit(1)
        })
    }

    /// Whether the first line of a compressed text contains the stamp.
    fn is_made_from(compressed: &[u8], stamp: &str) -> bool {
        let mut first = String::new();
        ruzstd::decoding::StreamingDecoder::new(compressed)
            .is_ok_and(|text| BufReader::new(text).read_line(&mut first).is_ok())
            && first.contains(&format!("sources {stamp},"))
    }

    /// The stamp, as `kernels/ptx.sh stamp` prints it (tests/gpu/ptx.rs compares): a digest over
    /// one line per file, "digest  kernels/name". A file's digest is that of its compiled lines:
    /// all except blank lines and comments.
    fn stamp(kernels: &Path) -> String {
        let mut names = vec!["Cargo.toml".to_owned()];
        rust_files(kernels, &kernels.join("src"), &mut names);
        names.sort();
        let mut all = Sha256::new();
        for name in names {
            let path = kernels.join(&name);
            // Packaging rewrites the manifest; the original file is next to it.
            let original = kernels.join("Cargo.toml.orig");
            let path = if name == "Cargo.toml" && original.exists() { original } else { path };
            let text = fs::read_to_string(path).expect("a kernel source is readable");
            let is_compiled = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
            let compiled: String = text.lines().filter(is_compiled).flat_map(|line| [line, "\n"]).collect();
            all.update(format!("{}  kernels/{name}\n", hex(&Sha256::digest(compiled))));
        }
        hex(&all.finalize())[..16].to_owned()
    }

    /// The Rust files below a folder, named from `root`.
    fn rust_files(root: &Path, folder: &Path, names: &mut Vec<String>) {
        for entry in fs::read_dir(folder).expect("the kernels' sources are a folder") {
            let path = entry.expect("the kernels' sources are readable").path();
            if path.is_dir() {
                rust_files(root, &path, names);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let name = path.strip_prefix(root).expect("below the root");
                names.push(name.to_string_lossy().replace('\\', "/"));
            }
        }
    }

    fn hex(bytes: &[u8]) -> String {
        bytes.iter().map(|b| format!("{b:02x}")).collect()
    }

    fn compile(kernels: &Path, out: &Path, text: &Path, stamp: &str) {
        // A build script that runs cargo needs another target folder: the outer cargo holds the
        // lock of its own.
        let target = out.ancestors().nth(4).unwrap_or(out).join("ptx");
        let script = kernels.join("ptx.sh");
        let built =
            Command::new(&script).arg("build").arg(text).env("NEARMISS_PTX_TARGET_DIR", target).output();
        let why = match built {
            Ok(done) if done.status.success() => {
                println!("cargo::warning=kernels/{PTX} is stale; the kernels were compiled again");
                return;
            }
            Ok(done) => String::from_utf8_lossy(&done.stderr).into_owned(),
            Err(error) => format!("{}: {error}", script.display()),
        };
        eprintln!("{why}");
        eprintln!(
            "{} is stale (stamp of the sources: {stamp}), and the kernels could not be compiled: see above.",
            kernels.join(PTX).display()
        );
        eprintln!("Install a device compiler (kernels/ptx.sh fetch), or renew the committed file:");
        eprintln!("kernels/ptx.sh build kernels/{PTX}");
        std::process::exit(1);
    }
}
