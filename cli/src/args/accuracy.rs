//! Options that set how exact an answer is.

use super::number::some;
use clap::Args;

#[derive(Args)]
pub struct AccuracyArgs {
    /// Set the accuracy of contacts, a length [default: 1e-4 of an edge]
    ///
    /// Features that come this near may be reported. 0 means all that the precision gives. The
    /// default is 1e-4 of the mean edge, rounded down to a power of two; of two bodies the smaller.
    #[arg(long, value_name = "L", allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// Report features that come within this length [default: 0, touch]
    #[arg(long, value_name = "L", allow_hyphen_values = true)]
    pub min_separation: Option<f64>,
    /// Let features that near at the start rest, slide and part
    ///
    /// Those within the minimum separation at the start are in contact from when they come nearer
    /// than there, not at once.
    #[arg(long, hide_short_help = true)]
    pub approaching: bool,
    /// Limit the iterations for a pair of features [default: 4096]
    ///
    /// A pair that is not decided by then is reported as undecided.
    #[arg(long, hide_short_help = true, value_name = "N", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub max_iterations: Option<u32>,
}

impl AccuracyArgs {
    /// The first of these options that is given, as typed.
    pub fn given(&self) -> Option<&'static str> {
        let all = [
            ("--tolerance", self.tolerance.is_some()),
            ("--min-separation", self.min_separation.is_some()),
            ("--approaching", self.approaching),
            ("--max-iterations", self.max_iterations.is_some()),
        ];
        all.into_iter().find(|(_, given)| *given).map(|(option, _)| option)
    }
}
