//! The arguments of `lab`: a command for each experiment.

use super::{BenchArgs, PlanArgs, SceneArgs, TablesArgs, TradeArgs, TurnsArgs};
use clap::{Args, Subcommand};

#[derive(Args)]
#[command(arg_required_else_help = true)]
pub struct LabArgs {
    #[command(subcommand)]
    pub command: Lab,
}

#[derive(Subcommand)]
pub enum Lab {
    /// Measure what faster solvers miss.
    Trade(Box<TradeArgs>),
    /// Measure the tables of the paper, with its figures next to ours.
    Tables(Box<TablesArgs>),
    /// Time fixed cases stage by stage, and compare with an earlier run.
    Bench(Box<BenchArgs>),
    /// Show the kernels, memory and transfers of a frame.
    Plan(Box<PlanArgs>),
    /// Write a generated scene as PLY files.
    Scene(Box<SceneArgs>),
    /// Judge the test of turning features on hostile pairs.
    Turns(Box<TurnsArgs>),
}
