//! The ground floor of the host: inputs, queries and answers are values that know no device.

use super::sources::{NONE, Source, after, lines, planted, rust, says};

const GROUND_FLOOR: [&str; 4] = ["host/mesh", "host/scene", "host/query", "host/contacts"];

/// Rooms above it.
const ABOVE: [&str; 4] = ["pipeline", "device", "detector", "several"];

fn climbs(sources: &[Source]) -> Vec<String> {
    lines(sources, |_, code| after(code, "crate::").any(|next| ABOVE.contains(&next)))
}

#[test]
fn values_know_no_device() {
    assert_eq!(climbs(&rust(&GROUND_FLOOR)), NONE);
}

#[test]
fn a_value_that_knows_the_device_is_noticed() {
    for line in ["use crate::pipeline::Layout;", "let device: crate::device::Device;"] {
        assert_eq!(climbs(&planted("host/contacts/near.rs", line)).len(), 1, "{line}");
    }
    let line = "use crate::mesh::Mesh; // see crate::device";
    assert_eq!(climbs(&planted("host/scene/body.rs", line)), NONE);
}

// The library opens no file: readers and writers are the package `nearmiss-io`.

/// The file that reads the system's accounts of memory; Linux has these as files.
const ACCOUNTS: &str = "host/memory.rs";

fn opens_files(sources: &[Source]) -> Vec<String> {
    lines(sources, |name, code| {
        let of_files = ["fs", "Path", "PathBuf"].iter().any(|word| says(code, word));
        name != ACCOUNTS && (of_files || code.contains("File::"))
    })
}

#[test]
fn the_library_opens_no_file() {
    assert_eq!(opens_files(&rust(&["host"])), NONE);
}

#[test]
fn a_file_that_the_library_opens_is_noticed() {
    for line in [
        "use std::fs::read_to_string;",
        "let bytes = std::fs::read(name)?;",
        "use std::{fs, thread};",
        "use std::path::PathBuf;",
        "pub fn read(path: &Path) -> Mesh {",
        "let mut file = File::create(name)?;",
    ] {
        assert_eq!(opens_files(&planted("host/mesh/mod.rs", line)).len(), 1, "{line}");
        assert_eq!(opens_files(&planted(ACCOUNTS, line)), NONE, "{line}");
    }
    for line in ["Note::File { text } => f.write_str(text), // see std::fs", "let file = name.to_owned();"] {
        assert_eq!(opens_files(&planted("host/contacts/notes.rs", line)), NONE, "{line}");
    }
}
