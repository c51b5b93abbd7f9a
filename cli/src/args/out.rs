//! Options that choose what is written and printed.

use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct OutArgs {
    /// Write the contacts: .csv, .json or .vtp, each also with .gz
    ///
    /// A .vtp has two points for each contact, at which the features are nearest. Its cells have
    /// `row` (of the .csv, from 0), `kind` (0 vf, 1 ee, 2 two triangles), `status` (0 unverified,
    /// 1 certified, 2 undecided), `bodies`, `feature_a`, `feature_b`, `toi`, `toi_upper` and
    /// `distance`.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Add vertices, weights, points, distance and normal to --out
    ///
    /// For rows of vertex-face and edge-edge pairs, in .csv and .json.
    #[arg(long, requires = "out", conflicts_with_all = ["file_faces", "earliest", "discrete", "distance"])]
    pub geometry: bool,
    /// Name faces of the file in --out, not triangles; they count from 0
    #[arg(long, requires = "out", conflicts_with_all = ["scene", "earliest"])]
    pub file_faces: bool,
    /// Write all bodies at t = 0 as one mesh, contacts in red (.ply)
    ///
    /// Triangles are red if they, one of their vertices or one of their edges are in contact. They
    /// are orange if all their contacts are undecided, and grey otherwise. The file may be
    /// compressed (.ply.gz).
    #[arg(long, value_name = "FILE", conflicts_with = "earliest")]
    pub out_mesh: Option<PathBuf>,
    /// Print the summary as one JSON object
    #[arg(long)]
    pub json: bool,
    /// Print candidates, stages, memory and the hash too
    #[arg(long, short, conflicts_with = "json")]
    pub verbose: bool,
}
