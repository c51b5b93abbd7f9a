//! Gives the shared library its SONAME: the name under which programs that were linked to it look
//! for it.

use std::env::var;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Set by cargo. The linkers of macOS and Windows name a library by other means.
    let of = |name: &str| var(name).unwrap_or_default();
    let is_elf = of("CARGO_CFG_TARGET_FAMILY").split(',').any(|family| family == "unix")
        && of("CARGO_CFG_TARGET_VENDOR") != "apple";
    if is_elf {
        let [major, minor] = ["CARGO_PKG_VERSION_MAJOR", "CARGO_PKG_VERSION_MINOR"].map(of);
        // Before 1.0 a minor version may change the interface; c/CMakeLists.txt has the same rule.
        let version = if major == "0" { format!("0.{minor}") } else { major };
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libnearmiss_c.so.{version}");
    }
}
