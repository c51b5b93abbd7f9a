//! The arguments of `view`.

use super::picture::{DirectionArgs, IDLE};
use super::{DetectArgs, OUTPUT};
use clap::{Arg, Args};
use nearmiss::error::Error;
use std::path::Path;

#[derive(Args)]
#[command(mut_args(of_view))]
pub struct ViewArgs {
    #[command(flatten)]
    pub detect: DetectArgs,
    #[command(flatten, next_help_heading = OUTPUT)]
    pub direction: DirectionArgs,
}

/// An option of `detect`, as a view has it.
fn of_view(option: Arg) -> Arg {
    match option.get_id().as_str() {
        "out" => option
            .required(true)
            .help("Write the page (.html): all frames, contacts in red")
            .long_help(
                "Write the page (.html): all frames, contacts in red\n\nThe page is one file, needs no network and opens \
                 in any browser with WebGL. It has the bodies in all frames, and the rows of each step or frame. A row \
                 that is picked shows its features at the time of contact. Triangles have the colours of `picture`.",
            ),
        idle if IDLE.contains(&idle) => option.hide(true),
        _ => option,
    }
}

/// Refuses a file whose name is not that of a page.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(path: &Path) -> Result<(), Error> {
    match path.extension() {
        _ if crate::output::is_stdout(path) => Ok(()),
        Some(extension) if extension.eq_ignore_ascii_case("html") => Ok(()),
        _ => Err(Error::InvalidArgument {
            what: format!("--out must end in .html, got {}", path.display()),
            advice: "rename the page".into(),
        }),
    }
}
