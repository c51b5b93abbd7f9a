//! The arguments of `explain`.

use super::number::whole;
use super::{ACCURACY, OUTPUT, QUERY};
use clap::builder::TypedValueParser;
use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

/// The features of a pair without a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Between {
    /// A vertex and a face: `v f0 f1 f2`.
    Vf,
    /// Two edges: `ea0 ea1 eb0 eb1`.
    Ee,
}

fn index() -> impl TypedValueParser<Value = u32> {
    whole::<u32>(0, u64::from(u32::MAX))
}

#[derive(Args)]
#[command(next_help_heading = QUERY)]
#[command(override_usage = "nearmiss explain --vf|--ee|--ev|--vv|--tt <I> <J> [OPTIONS] <MESH>...")]
#[command(group = ArgGroup::new("which").required(true).args(["vf", "ee", "ev", "vv", "tt", "queries", "points"]))]
pub struct ExplainArgs {
    /// Read a mesh, or the two ends of a step
    #[arg(num_args = 1.., value_name = "MESH", help_heading = None::<&str>, conflicts_with_all = ["queries", "points"])]
    pub meshes: Vec<PathBuf>,
    /// Add a second mesh; give it twice for both ends of a step
    ///
    /// The second index is then one of this mesh.
    #[arg(long, value_name = "MESH", requires = "meshes")]
    pub with: Vec<PathBuf>,
    /// Merge vertices with equal coordinates, as detect --weld
    ///
    /// Edges then have other numbers.
    #[arg(long, requires = "meshes")]
    pub weld: bool,
    /// Explain a vertex of the first mesh and a face of the last
    ///
    /// The indices are feature_a and feature_b of a vf row of detect. If the vertex is on the second
    /// mesh, name the meshes in the other order.
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = index(),
        value_names = ["VERTEX", "FACE"], requires = "meshes")]
    pub vf: Option<Vec<u32>>,
    /// Explain two edges, as detect lists them
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = index(),
        value_names = ["EDGE", "EDGE"], requires = "meshes")]
    pub ee: Option<Vec<u32>>,
    /// Explain an edge of no face and a vertex, as detect lists them
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = index(),
        value_names = ["EDGE", "VERTEX"], requires = "meshes")]
    pub ev: Option<Vec<u32>>,
    /// Explain two vertices, as detect lists them
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = index(),
        value_names = ["VERTEX", "VERTEX"], requires = "meshes")]
    pub vv: Option<Vec<u32>>,
    /// Explain two triangles at t = 0
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = index(),
        value_names = ["TRIANGLE", "TRIANGLE"], requires = "meshes")]
    pub tt: Option<Vec<u32>>,
    /// Explain a query of a file (.csv, .csv.gz)
    ///
    /// A query has eight rows: four points at t = 0, then at t = 1. A row has numerators and
    /// denominators of x, y and z, then 0 or 1 for the truth.
    #[arg(long, value_name = "FILE", requires = "row")]
    pub queries: Option<PathBuf>,
    /// Choose the query of the file, from 0
    #[arg(long, value_name = "N", requires = "queries", allow_negative_numbers = true,
        value_parser = whole::<usize>(0, u64::MAX))]
    pub row: Option<usize>,
    /// Explain four points: x, y, z of each at t = 0, then at t = 1
    ///
    /// These are 24 numbers.
    #[arg(long, num_args = 1..=24, value_name = "X", allow_hyphen_values = true, requires = "between")]
    pub points: Option<Vec<f64>>,
    /// Name the features of --points or --queries: vf or ee
    ///
    /// vf: a vertex and a face, `v f0 f1 f2`. ee: two edges, `ea0 ea1 eb0 eb1`. A file in a folder
    /// called vertex-face or edge-edge needs no name.
    #[arg(long, value_enum, value_name = "KIND", hide_possible_values = true, conflicts_with = "meshes")]
    pub between: Option<Between>,
    /// Set the accuracy of contacts, a length [default: 1e-4 of an edge]
    ///
    /// Without a mesh the default is 1e-6.
    #[arg(long, value_name = "L", allow_hyphen_values = true, help_heading = ACCURACY)]
    pub tolerance: Option<f64>,
    /// Limit the iterations for the pair [default: 4096]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = ACCURACY,
        value_parser = whole::<u32>(1, u64::from(u32::MAX)))]
    pub max_iterations: Option<u32>,
    /// Print one JSON object
    #[arg(long, help_heading = OUTPUT)]
    pub json: bool,
}
