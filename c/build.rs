//! Gives the shared library the name under which programs that were linked to it look for it: its
//! SONAME, and on macOS its install name.

use std::env::var;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Set by cargo. On Windows a library has the name of its file.
    let of = |name: &str| var(name).unwrap_or_default();
    let is_unix = of("CARGO_CFG_TARGET_FAMILY").split(',').any(|family| family == "unix");
    if of("CARGO_CFG_TARGET_VENDOR") == "apple" {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libnearmiss_c.dylib");
    } else if is_unix {
        let [major, minor] = ["CARGO_PKG_VERSION_MAJOR", "CARGO_PKG_VERSION_MINOR"].map(of);
        // Before 1.0 a minor version may change the interface; c/CMakeLists.txt has the same rule.
        let version = if major == "0" { format!("0.{minor}") } else { major };
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libnearmiss_c.so.{version}");
    }
}
