//! Names of kernels of volumes, which are put together, and their places.

use super::TABLE;
use crate::math::Real;

/// A name put together of others.
pub struct Name {
    bytes: [u8; 64],
    len: usize,
}

impl Name {
    /// The concatenation of the parts.
    pub const fn of(parts: &[&str]) -> Name {
        let mut name = Name { bytes: [0; 64], len: 0 };
        let mut part = 0;
        while part < parts.len() {
            let mut at = 0;
            while at < parts[part].len() {
                name.bytes[name.len] = parts[part].as_bytes()[at];
                (at, name.len) = (at + 1, name.len + 1);
            }
            part += 1;
        }
        name
    }

    /// Its text.
    pub const fn text(&self) -> &str {
        match str::from_utf8(self.bytes.split_at(self.len).0) {
            Ok(text) => text,
            Err(_) => panic!("parts of names are text"),
        }
    }
}

/// The suffix of a precision in names.
pub const fn precision<R: Real>() -> &'static str {
    if size_of::<R>() == 4 { "_f32" } else { "_f64" }
}

/// The place in the table of a kernel with that name.
pub const fn place(name: &str) -> Option<usize> {
    let mut place = 0;
    while place < TABLE.len() {
        let (other, mut at) = (TABLE[place].0.as_bytes(), 0);
        while at < name.len() && at < other.len() && name.as_bytes()[at] == other[at] {
            at += 1;
        }
        if at == name.len() && at == other.len() {
            return Some(place);
        }
        place += 1;
    }
    None
}
