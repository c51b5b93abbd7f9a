//! Gives the build scripts of dependents the root of this package, as `DEP_NEARMISS_KERNELS_ROOT`:
//! it has the PTX and the sources of the PTX.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::metadata=root={}", env!("CARGO_MANIFEST_DIR"));
}
