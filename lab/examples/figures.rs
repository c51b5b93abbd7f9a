//! Writes the tables of measured figures into README and pages, from `benches/results`.
//!
//! ```sh
//! cargo run -p nearmiss-lab --example figures              # write
//! cargo run -p nearmiss-lab --example figures -- --check   # only name the pages that differ
//! ```

use nearmiss_lab::figures::{Tables, pages, refill};
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let is_check = env::args().nth(1).as_deref() == Some("--check");
    match write(&root, is_check) {
        Ok(differ) if is_check && differ > 0 => ExitCode::FAILURE,
        Ok(_) => ExitCode::SUCCESS,
        Err(text) => {
            eprintln!("figures: {text}");
            ExitCode::FAILURE
        }
    }
}

/// How many pages differ from their tables; writes them unless `is_check`.
fn write(root: &Path, is_check: bool) -> Result<usize, String> {
    let mut tables = Tables::open(root)?;
    let mut differ = 0;
    for path in pages(root)? {
        let told = |e: std::io::Error| format!("{}: {e}", path.display());
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(&path).map_err(told)?;
        let made = refill(&name, &text, &mut tables)?;
        if made != text {
            differ += 1;
            println!("{name} {}", if is_check { "differs" } else { "written" });
            if !is_check {
                fs::write(&path, made).map_err(told)?;
            }
        }
    }
    Ok(differ)
}
