//! The committed header is what the sources say. `NEARMISS_BLESS=1 cargo test -p nearmiss-c --test header` writes it anew.

use std::path::Path;

#[test]
fn the_header_is_that_of_the_sources() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("a configuration");
    let made = cbindgen::Builder::new().with_crate(root).with_config(config).generate().expect("a header");
    let mut text = Vec::new();
    made.write(&mut text);
    let path = root.join("include/nearmiss.h");
    if std::env::var_os("NEARMISS_BLESS").is_some() {
        std::fs::write(&path, &text).expect("written");
    }
    let committed = std::fs::read(&path).expect("a header");
    assert!(committed == text, "include/nearmiss.h is old: bless it, and look at what changed");
}
