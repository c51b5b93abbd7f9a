//! Tells the build scripts of dependents, as `DEP_NEARMISS_KERNELS_ROOT`, where this package lies: its PTX and the sources
//! that the PTX is made from.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::metadata=root={}", env!("CARGO_MANIFEST_DIR"));
}
