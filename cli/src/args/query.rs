//! Options that choose the query and its meshes.

use super::number::{some, whole};
use clap::Args;
use clap::builder::PossibleValuesParser;
use nearmiss_lab::scene::NAMES;
use std::path::PathBuf;

#[derive(Args)]
pub struct QueryArgs {
    /// Find triangles that share a point at t = 0 [default of one frame]
    #[arg(long, conflicts_with_all = ["continuous", "earliest"])]
    pub discrete: bool,
    /// Find features that meet in the step, and when [default of two]
    ///
    /// Features are a vertex and a face, or two edges.
    #[arg(long, conflicts_with = "earliest")]
    pub continuous: bool,
    /// Find the first time of contact: the largest safe step
    #[arg(long)]
    pub earliest: bool,
    /// List the features that meet at that time (with --earliest)
    ///
    /// They are the rows of --continuous whose time it is. The step is tested again, up to that time.
    #[arg(long, requires = "earliest", hide_short_help = true)]
    pub first_contacts: bool,
    /// Find features within the distance L at t = 0, and where
    #[arg(long, value_name = "L", allow_hyphen_values = true,
        conflicts_with_all = ["discrete", "continuous", "earliest"])]
    pub near: Option<f64>,
    /// Find the distance of the two nearest bodies at t = 0, and where
    ///
    /// The distance is 0 only if the bodies share a point. It takes two meshes or more.
    #[arg(long, conflicts_with_all = ["discrete", "continuous", "earliest", "near"])]
    pub distance: bool,
    /// Find the pairs of bodies that share a point at t = 0
    ///
    /// A body is not tested against itself. It takes two meshes or more.
    #[arg(long, conflicts_with_all = ["discrete", "continuous", "earliest", "near", "distance"])]
    pub body_pairs: bool,
    /// Find each two bodies within the distance L at t = 0, and where
    ///
    /// Each pair of bodies has a row: its least distance and the triangles that have it. The distance
    /// is 0 only if the bodies share a point. It takes two meshes or more.
    #[arg(long, value_name = "L", allow_hyphen_values = true,
        conflicts_with_all = ["discrete", "continuous", "earliest", "near", "distance", "body_pairs"])]
    pub body_distances: Option<f64>,
    /// Add a second mesh; give it twice for both ends of a step
    ///
    /// `--with B0 --with B1 A0 A1` and `A0 A1 --with B0 B1` are the same. Each mesh is tested against
    /// itself too, unless --no-self-collision is given.
    #[arg(long, value_name = "MESH")]
    pub with: Vec<PathBuf>,
    /// Test the two meshes against each other only
    #[arg(long)]
    pub no_self_collision: bool,
    /// Give each mesh a thickness: a radius (with --near or a step)
    ///
    /// Features count as near, or in contact, within the distance and both radii. With a thickness
    /// `--near 0` is the pairs whose surfaces of that thickness touch.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub thickness: Option<f64>,
    /// Test triangles that share a vertex too (with --discrete)
    ///
    /// They are reported if they meet beyond the vertices that they share.
    #[arg(long)]
    pub adjacent: bool,
    /// Leave out triangles that touch without crossing (with --discrete)
    ///
    /// Triangles cross if their insides share a point and no plane holds both. A wall that stands on a
    /// floor touches it.
    #[arg(long)]
    pub only_crossing: bool,
    /// Skip the count of triangles that cross at the start of the step
    #[arg(long, conflicts_with_all = ["discrete", "near", "distance", "body_pairs", "body_distances"])]
    pub assume_free: bool,
    /// Merge vertices that coincide in all frames of a mesh
    #[arg(long)]
    pub weld: bool,
    /// Refuse a file with parts that would be skipped or repaired
    #[arg(long, conflicts_with = "scene")]
    pub strict: bool,
    /// List the first N problems of a file that cannot be read
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, conflicts_with = "scene",
        hide_short_help = true, value_parser = some::<usize>())]
    pub problems: usize,
    /// Pass over frames that cannot be read; exit with status 3 then
    ///
    /// A frame is passed over if its file cannot be read, or if its faces are not those of the first.
    /// So are steps from it and to it. The reason is printed, and is a column of --out.
    #[arg(long, conflicts_with = "scene", hide_short_help = true)]
    pub keep_going: bool,
    /// Test a generated scene instead of files, such as draped
    #[arg(long, conflicts_with_all = ["meshes", "with"], value_name = "NAME", hide_possible_values = true,
        long_help = super::help::listed("Test a generated scene instead of files", &NAMES),
        value_parser = PossibleValuesParser::new(NAMES))]
    pub scene: Option<String>,
    /// Set the triangles of the generated scene [default: its own]
    #[arg(long, requires = "scene", value_name = "N", allow_negative_numbers = true,
        hide_short_help = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Choose the random numbers of the generated scene
    #[arg(long, default_value_t = 1, requires = "scene", value_name = "N", allow_negative_numbers = true,
        hide_short_help = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
}
