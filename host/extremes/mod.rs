//! The catalogue of extremes as data: what breaks other programs, and what must be said of it. `docs/extremes.md` lists
//! every id with the tests that hold it; tests run it on the CPU, `nearmiss selftest` on the machine that it is on.

mod question;
mod questions;
mod scenes;

pub use question::{Expect, Fault, MOST_BOXES, Question};
pub use questions::{questions, reported_motions};
pub use scenes::{PATCH, PATCH_FACES, TRIANGLES};
