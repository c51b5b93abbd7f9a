//! The arguments of `picture`.

use super::{DetectArgs, OUTPUT};
use clap::builder::{StringValueParser, TypedValueParser};
use clap::{Arg, Args, Command, FromArgMatches, ValueEnum};
use nearmiss::error::Error;
use std::path::Path;

/// The part of the scene that fills the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Around {
    /// All bodies.
    All,
    /// Triangles in contact, or all bodies if there are none.
    Contacts,
}

/// The frames that are seen whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Fit {
    /// All frames: the camera stays.
    All,
    /// Each frame by itself.
    Frame,
}

/// Fewest and most pixels of either side of a picture.
const SIDES: [usize; 2] = [16, 8192];

#[derive(Args)]
#[command(mut_args(of_picture))]
pub struct PictureArgs {
    #[command(flatten)]
    pub detect: DetectArgs,
    #[command(flatten, next_help_heading = OUTPUT)]
    pub look: LookArgs,
}

/// How the bodies are seen.
#[derive(Args)]
pub struct LookArgs {
    /// Set width and height in pixels, each from 16 to 8192
    #[arg(long, value_name = "WxH", default_value = "1200x900", allow_hyphen_values = true, value_parser = size())]
    pub size: [usize; 2],
    #[command(flatten)]
    pub direction: DirectionArgs,
    /// Fill the picture with all bodies, or with the contacts
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = Around::All, hide_possible_values = true,
        long_help = super::help::listed("Fill the picture with all bodies, or with the contacts", &["all", "contacts"]))]
    pub around: Around,
    /// Fit the camera to all frames of a sequence, or to each frame
    ///
    /// One camera for all frames is the default, except with `--around contacts`.
    #[arg(long, value_name = "WHAT", value_enum, hide_possible_values = true, hide_short_help = true,
        long_help = super::help::listed("Fit the camera to all frames of a sequence, or to each frame. One camera for all frames is the default, except with --around contacts", &["all", "frame"]))]
    pub fit: Option<Fit>,
    /// Draw the bodies at this time of the step, from 0 to 1
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = part())]
    pub time: f64,
}

/// The direction from which bodies are seen.
#[derive(Args)]
pub struct DirectionArgs {
    /// Look from this direction, of any length
    ///
    /// It points from the middle of the bodies to the viewer.
    #[arg(long, value_name = "X,Y,Z", default_value = "4,-7,3.5", allow_hyphen_values = true,
        value_parser = direction())]
    pub view: [f64; 3],
    /// Draw this direction upwards, of any length
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", allow_hyphen_values = true,
        value_parser = direction())]
    pub up: [f64; 3],
}

impl LookArgs {
    /// How bodies are seen without options.
    pub fn usual() -> LookArgs {
        let none = LookArgs::augment_args(Command::new("picture")).get_matches_from(["picture"]);
        LookArgs::from_arg_matches(&none).expect("every option has a default")
    }
}

/// Options of `detect` that a picture and a page refuse.
pub const IDLE: [&str; 12] = [
    "repeat",
    "only",
    "earliest",
    "first_contacts",
    "json",
    "verbose",
    "geometry",
    "out_mesh",
    "file_faces",
    "rebuild",
    "rebuild_every",
    "fail_on",
];

/// An option of `detect`, as a picture has it.
fn of_picture(option: Arg) -> Arg {
    match option.get_id().as_str() {
        "out" => option
            .required(true)
            .help("Write the picture (.png): all bodies at --time, contacts in red")
            .long_help(
                "Write the picture (.png): all bodies at --time, contacts in red\n\nTriangles are red if they, one of \
                 their vertices or one of their edges are in contact. They are orange if all their contacts are \
                 undecided. Each body has a colour of its own, and so has each connected part of a body alone. A \
                 sequence has a file for each frame: `#` in the name is its number, as in `frame.####.png`.",
            ),
        idle if IDLE.contains(&idle) => option.hide(true),
        _ => option,
    }
}

/// Refuses a file whose name is not that of a PNG.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(option: &str, path: &Path) -> Result<(), Error> {
    match path.extension() {
        _ if crate::output::is_stdout(path) => Ok(()),
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(()),
        _ => Err(Error::InvalidArgument {
            what: format!("{option} must end in .png, got {}", path.display()),
            advice: "rename the picture".into(),
        }),
    }
}

fn size() -> impl TypedValueParser<Value = [usize; 2]> {
    let [least, most] = SIDES;
    let refused = format!("give two whole numbers from {least} to {most}, such as 1200x900");
    StringValueParser::new().try_map(move |text: String| {
        let side = |text: &str| text.parse().ok().filter(|side| (least..=most).contains(side));
        let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
        sides.ok_or_else(|| refused.clone())
    })
}

/// A number from 0 to 1.
fn part() -> impl TypedValueParser<Value = f64> {
    StringValueParser::new().try_map(|text: String| {
        text.parse().ok().filter(|part| (0.0..=1.0).contains(part)).ok_or("give a number from 0 to 1")
    })
}

/// Three finite numbers, divided by the largest, which is not 0.
fn direction() -> impl TypedValueParser<Value = [f64; 3]> {
    StringValueParser::new().try_map(|text: String| {
        let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let numbers = numbers.and_then(|all| <[f64; 3]>::try_from(all).ok());
        // By their largest first: squares neither overflow nor vanish.
        let largest = numbers.map_or(0.0, |all| all.iter().fold(0.0f64, |most, x| most.max(x.abs())));
        let whole = numbers.filter(|all| all.iter().all(|x| x.is_finite()) && largest > 0.0);
        whole
            .map(|all| all.map(|x| x / largest))
            .ok_or("give three numbers that are not all 0, such as 4,-7,3.5")
    })
}
