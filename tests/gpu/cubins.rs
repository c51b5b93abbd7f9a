//! Machine code for releases: are registers limited as the host limits them for PTX?

use nearmiss_kernels::entry::{Entry, Visit, visit};
use std::path::Path;
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Kernels with a limit, as lines of the script.
#[derive(Default)]
struct Limits(Vec<String>);

impl Visit for Limits {
    fn kernel<E: Entry>(&mut self) {
        self.0.extend(E::REGISTERS.map(|limit| format!("{} {limit}", E::NAME)));
    }
}

/// The lines of `ptx.sh registers` in a folder of kernels.
fn listed(kernels: &Path) -> Vec<String> {
    let done = Command::new(kernels.join("ptx.sh")).arg("registers").output().expect("ptx.sh runs");
    String::from_utf8(done.stdout).expect("a text").lines().map(str::to_owned).collect()
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "kernels/ptx.sh wants GNU tools")]
fn the_script_lists_each_limit_of_registers_and_would_notice_another() {
    let mut limits = Limits::default();
    visit(&mut limits);
    let kernels = Path::new(ROOT).join("kernels");
    assert!(!limits.0.is_empty());
    assert_eq!(listed(&kernels), limits.0, "`kernels/ptx.sh registers`");

    let folder = std::env::temp_dir().join(format!("nearmiss-registers-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("src")).expect("a folder");
    std::fs::copy(kernels.join("ptx.sh"), folder.join("ptx.sh")).expect("copied");
    let table = std::fs::read_to_string(kernels.join("src/entry.rs")).expect("the table");
    let (_, first) = limits.0[0].split_once(' ').expect("a kernel and a limit");
    for other in [" registers = 1;", ";"] {
        let planted = table.replacen(&format!(" registers = {first};"), other, 1);
        std::fs::write(folder.join("src/entry.rs"), planted).expect("written");
        assert_ne!(listed(&folder), limits.0, "{other}");
    }
    std::fs::remove_dir_all(folder).expect("removed");
}

/// Kernels with blocks of 512 lanes.
#[derive(Default)]
struct Large(Vec<&'static str>);

impl Visit for Large {
    fn kernel<E: Entry>(&mut self) {
        assert!(E::LANES <= 512, "{}", E::NAME);
        if E::LANES > 256 {
            assert!(E::REGISTERS.is_none_or(|limit| limit <= 128), "{}", E::NAME);
            self.0.push(E::NAME);
        }
    }
}

/// More registers than a block has make a launch fail: `.ci/ptxas.sh` looks at these kernels.
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "kernels/ptx.sh wants GNU tools")]
fn the_script_names_each_kernel_of_large_blocks() {
    let mut large = Large::default();
    visit(&mut large);
    let done = Command::new(Path::new(ROOT).join("kernels/ptx.sh")).arg("large").output().expect("it runs");
    let said = String::from_utf8(done.stdout).expect("a text");
    let names = || said.split_whitespace();
    let unnamed: Vec<_> =
        large.0.iter().filter(|kernel| !names().any(|name| kernel.starts_with(name))).collect();
    assert!(unnamed.is_empty(), "`kernels/ptx.sh large` lacks {unnamed:?}");
    let idle: Vec<_> =
        names().filter(|name| !large.0.iter().any(|kernel| kernel.starts_with(name))).collect();
    assert!(idle.is_empty(), "`kernels/ptx.sh large` has {idle:?}");
}
