//! Embeds the kernels' PTX, with feature `cuda`; without it, does nothing.
//!
//! The committed kernels/nearmiss.ptx is taken if it carries the stamp of the present sources. Otherwise the
//! kernels are compiled, if this machine has a device compiler (kernels/ptx.sh); if it has none, the build stops.
//! The library gets `NEARMISS_STAMP` (16 hex digits) from the environment and the text from `OUT_DIR`.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "cuda")]
    ptx::embed();
}

#[cfg(feature = "cuda")]
mod ptx {
    use sha2::{Digest, Sha256};
    use std::path::{Path, PathBuf};
    use std::process::Command;
    use std::{env, fs};

    const COMMITTED: &str = "kernels/nearmiss.ptx";

    pub fn embed() {
        for path in ["kernels/src", "kernels/Cargo.toml", "kernels/ptx.sh", COMMITTED] {
            println!("cargo::rerun-if-changed={path}");
        }
        println!("cargo::rerun-if-env-changed=NEARMISS_DEVICE_RUSTC");

        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        let text = out.join("nearmiss.ptx");
        let stamp = stamp();
        let committed = fs::read_to_string(COMMITTED).unwrap_or_default();
        if is_made_from(&committed, &stamp) {
            fs::write(&text, committed).expect("OUT_DIR takes the PTX");
        } else {
            compile(&out, &text, &stamp);
        }
        println!("cargo::rustc-env=NEARMISS_STAMP={stamp}");
    }

    fn is_made_from(ptx: &str, stamp: &str) -> bool {
        ptx.lines().next().is_some_and(|first| first.contains(&format!("sources {stamp},")))
    }

    /// As `kernels/ptx.sh stamp` (tests/ptx.rs compares): a digest over one line a file, "digest  name".
    fn stamp() -> String {
        let mut names = vec!["kernels/Cargo.toml".to_owned()];
        rust_files(Path::new("kernels/src"), &mut names);
        names.sort();
        let mut all = Sha256::new();
        for name in names {
            let bytes = fs::read(&name).expect("a kernel source is readable");
            all.update(format!("{}  {name}\n", hex(&Sha256::digest(bytes))));
        }
        hex(&all.finalize())[..16].to_owned()
    }

    fn rust_files(folder: &Path, names: &mut Vec<String>) {
        for entry in fs::read_dir(folder).expect("kernels/src is a folder") {
            let path = entry.expect("kernels/src is readable").path();
            if path.is_dir() {
                rust_files(&path, names);
            } else if path.extension().is_some_and(|e| e == "rs") {
                names.push(path.to_string_lossy().replace('\\', "/"));
            }
        }
    }

    fn hex(bytes: &[u8]) -> String {
        bytes.iter().map(|b| format!("{b:02x}")).collect()
    }

    fn compile(out: &Path, text: &Path, stamp: &str) {
        // A build script that runs cargo needs another target folder: the outer cargo holds the lock of its own.
        let target = out.ancestors().nth(4).unwrap_or(out).join("ptx");
        let built = Command::new("kernels/ptx.sh")
            .arg("build")
            .arg(text)
            .env("NEARMISS_PTX_TARGET_DIR", target)
            .output();
        let why = match built {
            Ok(done) if done.status.success() => {
                println!(
                    "cargo::warning={COMMITTED} is not made from the present kernels; they were compiled anew"
                );
                return;
            }
            Ok(done) => String::from_utf8_lossy(&done.stderr).into_owned(),
            Err(error) => format!("kernels/ptx.sh: {error}"),
        };
        eprintln!("{why}");
        eprintln!(
            "The kernels' sources (stamp {stamp}) are not those that {COMMITTED} was made from, and they could"
        );
        eprintln!(
            "not be compiled here; the reason is above. With a device compiler (kernels/ptx.sh fetch) this builds"
        );
        eprintln!("by itself; to renew the committed file: kernels/ptx.sh build {COMMITTED}");
        std::process::exit(1);
    }
}
