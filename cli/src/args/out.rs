//! Options that choose what is written and printed.

use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::process::ExitCode;

/// Answers that are failures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FailOn {
    /// Something meets.
    Contacts,
}

/// Exit status if something meets that must not.
pub const MEETS: u8 = 1;

#[derive(Args)]
pub struct OutArgs {
    /// Write the contacts: .csv, .json or .vtp, each also with .gz
    ///
    /// A .vtp has two points for each contact, at which the features are nearest. Its cells have
    /// `row` (of the .csv, from 0), `kind` (0 vf, 1 ee, 2 two triangles, 3 ev, 4 vv), `status`
    /// (0 unverified, 1 certified, 2 undecided), `bodies`, `feature_a`, `feature_b`, `toi`,
    /// `toi_upper` and `distance`. For triangles at t = 0 it has the curves in which they cross, and
    /// the segments and points in which they touch. These cells have `kind` (0 crossing, 1 point, 2
    /// segment), `group` (-1 for a touch) and `is_closed`, their points `row`.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Add vertices, weights, points, distance and normal to --out
    ///
    /// For rows of vertex-face and edge-edge pairs, in .csv and .json. Triangles at t = 0 get their kind
    /// (crossing, point, segment, overlap), both ends of their common segment, and the error of these.
    #[arg(long, requires = "out", conflicts_with_all = ["file_faces", "distance", "body_pairs", "body_distances"])]
    pub geometry: bool,
    /// Name faces of the file in --out, not triangles; they count from 0
    #[arg(long, requires = "out", conflicts_with_all = ["scene", "earliest"], hide_short_help = true)]
    pub file_faces: bool,
    /// Write all bodies at t = 0 as one mesh, contacts in red (.ply)
    ///
    /// Triangles are red if they, one of their vertices or one of their edges are in contact. They
    /// are orange if all their contacts are undecided, and grey otherwise. The file may be
    /// compressed (.ply.gz). A sequence has a file for each frame: `#` in the name is its number, as in
    /// `marked.####.ply`.
    #[arg(long, value_name = "FILE")]
    pub out_mesh: Option<PathBuf>,
    /// Colour triangles by their number of contacts
    ///
    /// Yellow is 1 contact, orange 2 or 3, red 4 to 7, dark red 8 to 15, and violet 16 or more. A
    /// triangle has the contacts of its vertices and edges too.
    #[arg(long, hide_short_help = true)]
    pub heat: bool,
    /// Exit with status 1 if something meets: contacts
    ///
    /// Something meets if the answer has rows, or if triangles share a point when a step starts. The
    /// distance of the nearest bodies has a row always: bodies meet if it is 0.
    #[arg(long, value_name = "WHAT", value_enum, hide_possible_values = true, hide_short_help = true)]
    pub fail_on: Option<FailOn>,
    /// Print the summary as one JSON object
    #[arg(long)]
    pub json: bool,
    /// Print candidates, stages, memory and the hash too
    #[arg(long, short, conflicts_with = "json")]
    pub verbose: bool,
}

impl OutArgs {
    /// The exit status of an answer.
    pub fn fails(&self, meets: bool) -> ExitCode {
        ExitCode::from(if meets && self.fail_on == Some(FailOn::Contacts) { MEETS } else { 0 })
    }
}
