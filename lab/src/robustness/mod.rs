//! The catalogue of extremes as data: inputs that break other programs, with the required answers.
//! `docs/internals/robustness.md` lists every id with its tests. Tests run it on the CPU, `nearmiss
//! selftest` on the current machine.

mod ask;
mod built;
mod large;
mod question;
mod questions;
mod refits;
mod report;
mod run;
mod scenes;
mod search;

pub use ask::{ask_questions, ask_turned_questions};
pub use built::ask_built;
pub use large::{Crowds, ask_crowds};
pub use question::{Expect, Fault, MOST_BOXES, Question};
pub use questions::{MOTIONS, Reported, questions, reported_motions};
pub use refits::ask_refits;
pub use report::Report;
pub use run::{Amount, run};
pub use scenes::{Finds, Numbers, PATCH, PATCH_FACES, Refused, Scene, TRIANGLES, refused, scenes};
pub use search::{ask_refused, ask_scenes, ask_turned_scenes};
