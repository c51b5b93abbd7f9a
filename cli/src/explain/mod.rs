//! `explain`: what each solver says of one question, and the exact answer.

mod judge;
mod solvers;
mod subject;
mod text;

use crate::args::whole;
use crate::output::print;
use clap::{ArgGroup, Args, ValueEnum};
use nearmiss::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// Which features a question without a mesh is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Between {
    /// A vertex and a face: `v f0 f1 f2`.
    Vf,
    /// Two edges: `ea0 ea1 eb0 eb1`.
    Ee,
}

#[derive(Args)]
#[command(group = ArgGroup::new("which").required(true).args(["vf", "fv", "ee", "tt", "queries", "points"]))]
pub struct ExplainArgs {
    /// The mesh (.ply, .obj); with a second file, its positions at the end of the step. As detect takes them.
    #[arg(num_args = 1.., value_name = "MESH", conflicts_with_all = ["queries", "points"])]
    pub meshes: Vec<PathBuf>,
    /// The other mesh, as detect takes it: the second index is one of its own. May be given twice.
    #[arg(long, value_name = "MESH", requires = "meshes")]
    pub with: Vec<PathBuf>,
    /// A vertex and a face, as detect lists them.
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = whole::<u32>(0, u64::from(u32::MAX)), value_names = ["VERTEX", "FACE"], requires = "meshes")]
    pub vf: Option<Vec<u32>>,
    /// A face of the first mesh and a vertex of the other, as detect lists them.
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = whole::<u32>(0, u64::from(u32::MAX)), value_names = ["FACE", "VERTEX"], requires = "with")]
    pub fv: Option<Vec<u32>>,
    /// Two edges, as detect lists them.
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = whole::<u32>(0, u64::from(u32::MAX)), value_names = ["EDGE", "EDGE"], requires = "meshes")]
    pub ee: Option<Vec<u32>>,
    /// Two triangles at t = 0.
    #[arg(long, num_args = 2, allow_negative_numbers = true, value_parser = whole::<u32>(0, u64::from(u32::MAX)), value_names = ["TRIANGLE", "TRIANGLE"], requires = "meshes")]
    pub tt: Option<Vec<u32>>,
    /// A file of queries (.csv, .csv.gz): eight rows each, four points at t = 0 and at t = 1, each three numerators and
    /// denominators, then 0 or 1.
    #[arg(long, value_name = "FILE", requires = "row")]
    pub queries: Option<PathBuf>,
    /// Which query of the file, counted from 0.
    #[arg(long, value_name = "N", requires = "queries", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub row: Option<usize>,
    /// 24 numbers: x, y, z of four points at t = 0, then at t = 1.
    #[arg(long, num_args = 24, value_name = "X", allow_hyphen_values = true, requires = "between")]
    pub points: Option<Vec<f64>>,
    /// What the points are [default for a file of queries: what its folder, vertex-face or edge-edge, says].
    #[arg(long, value_enum, conflicts_with = "meshes")]
    pub between: Option<Between>,
    /// Certified: how near to contact may count as one, a length [default: of a mesh, 1e-4 of its mean edge, rounded down to
    /// a power of two; else 1e-6].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// Certified: boxes that are looked at before the pair is left undecided [default: 4096].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, u64::from(u32::MAX)))]
    pub boxes: Option<u32>,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// Asks every solver and the oracle, and prints how they compare.
pub fn explain(args: &ExplainArgs) -> Result<ExitCode, Error> {
    if args.tolerance.is_some_and(|t| !(0.0..f64::INFINITY).contains(&t)) {
        return Err(Error::InvalidArgument {
            what: "a tolerance that is no length".into(),
            advice: "give --tolerance a finite length from 0".into(),
        });
    }
    let said = match subject::of(args)? {
        subject::Subject::Moving(moving) => text::moving(&moving, &solvers::ask_moving(&moving)),
        subject::Subject::Still(still) => text::still(&still, &solvers::ask_still(&still)),
    };
    let printed = if args.json {
        serde_json::to_string(&said).map_err(|e| Error::Bug { what: e.to_string() })? + "\n"
    } else {
        text::human(&said)
    };
    print(&printed)?;
    Ok(ExitCode::SUCCESS)
}
