//! The cull: keeps pairs of features that may meet in a step.

use super::NarrowContext;
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::list::List;
use crate::pipeline::precision::Precision;
use crate::query::Certified;
use nearmiss_kernels::abi::{CullArgs, Output, Pair, Span};

/// Returns the arguments of kernels that cull: pairs and those that may meet, vertex/face and
/// edge/edge. Pairs that begin later than the `known` time are dropped too.
pub fn args<R: Precision>(
    given: &NarrowContext<R>,
    [[vf, ee], [may_vf, may_ee]]: [[Output<Pair>; 2]; 2],
    certified: Option<&Certified>,
    known: Span<u64>,
) -> CullArgs<R> {
    CullArgs {
        frames: given.frames,
        faces: given.faces,
        edges: given.features.edges.span(),
        vf,
        ee,
        may_vf,
        may_ee,
        params: certified.copied().unwrap_or_default().params(),
        known,
    }
}

/// Launches the cull of a query.
///
/// # Errors
/// Device errors.
pub fn run<R: Precision>(
    given: &NarrowContext<R>,
    [from, to]: [&[List<Pair>; 2]; 2],
    certified: Option<&Certified>,
    known: Span<u64>,
) -> Result<(), Error> {
    let outputs = [from, to].map(|lists| lists.each_ref().map(|list| list.output(given.counters)));
    let capacity = from.iter().map(List::capacity).sum();
    launch::striding::<R::Cull>(given.device, capacity, &args(given, outputs, certified, known))
}
