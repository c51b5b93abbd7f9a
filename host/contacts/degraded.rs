//! What an answer, or its making, owes to a limit: said aloud, each by its reason.

use crate::mesh::{Body, Positions};
use crate::pipeline::{Found, Layout};
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{Hit, counter};
use nearmiss_kernels::math::tolerance::Tolerance;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt;

/// A way in which a frame came to less than all that was asked. Nothing is ever missed for any of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Degraded {
    /// Pairs nearer than the tolerance that are neither certain to meet nor certain to stay apart. Of an earliest query
    /// also those of [`Degraded::Boxes`].
    Unresolved {
        /// How many.
        pairs: u64,
    },
    /// Pairs whose budget of boxes ended ([`Query::boxes`]): listed, but their times may be far too early. Not counted by an
    /// earliest query.
    Boxes {
        /// How many.
        pairs: u64,
    },
    /// Listed pairs so large that the solver's precision cannot tell as little as the tolerance: there a larger one counts,
    /// 64 roundings of their extent. A tolerance of 0 asks for no more than that, and is never below.
    ToleranceBelowPrecision {
        /// How many; `None` where pairs are not listed.
        pairs: Option<u64>,
    },
    /// Lists were too short and grew, and that part of the frame ran again. The answer is whole; it took longer.
    ListsGrown {
        /// How often.
        times: u64,
    },
    /// The front did not pay: dropped, or not yet taken up again. The answer is whole.
    FrontDropped,
}

impl Degraded {
    /// Whether the answer itself is less than was asked, not only the time that it took.
    pub fn touches_answer(&self) -> bool {
        !matches!(self, Degraded::ListsGrown { .. } | Degraded::FrontDropped)
    }

    /// All that holds of a frame. Cost: a pass over the hits; where the tolerance is near the precision a few positions of
    /// each.
    pub(crate) fn of(found: &Found, layout: &Layout, bodies: &[Body], query: &Query) -> Vec<Degraded> {
        let mut all = Vec::new();
        let hits = || found.vf.par_iter().chain(&found.ee);
        let ended = hits().filter(|hit| hit.verdict.exhausted()).count() as u64;
        let ended_unsure =
            hits().filter(|hit| hit.verdict.exhausted() && !hit.verdict.is_contact()).count() as u64;
        let unsure = found.counters[counter::UNRESOLVED as usize] - ended_unsure;
        let mut put = |count: u64, reason: Degraded| all.extend((count > 0).then_some(reason));
        put(unsure, Degraded::Unresolved { pairs: unsure });
        put(ended, Degraded::Boxes { pairs: ended });
        if let Some(pairs) = below_precision(found, layout, bodies, query) {
            put(pairs.unwrap_or(1), Degraded::ToleranceBelowPrecision { pairs });
        }
        put(found.reruns, Degraded::ListsGrown { times: found.reruns });
        put(found.front_dropped as u64, Degraded::FrontDropped);
        all
    }
}

impl fmt::Display for Degraded {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Degraded::Unresolved { pairs } => {
                write!(
                    f,
                    "{pairs} pairs nearer than the tolerance, neither certain to meet nor to stay apart"
                )
            }
            Degraded::Boxes { pairs } => {
                write!(f, "{pairs} pairs whose boxes ended, with times that may be too early; raise --boxes")
            }
            Degraded::ToleranceBelowPrecision { pairs } => {
                let pairs = pairs.map_or("some".to_owned(), |pairs| pairs.to_string());
                write!(f, "{pairs} pairs too large for the tolerance in the solver's precision")
            }
            Degraded::ListsGrown { times } => {
                write!(f, "lists were too short {times} times: they grew, the answer is whole")
            }
            Degraded::FrontDropped => write!(f, "the front did not pay and was dropped; the answer is whole"),
        }
    }
}

/// How many listed pairs are too large for the tolerance; `Some(None)` where pairs are not listed and there may be some.
fn below_precision(found: &Found, layout: &Layout, bodies: &[Body], query: &Query) -> Option<Option<u64>> {
    let finest = match query.solver() {
        Solver::CertifiedF32 => f64::from(f32::INCLUSION_FINEST),
        // What f32 cannot tell is asked again in f64.
        Solver::Certified | Solver::CertifiedF64 => f64::INCLUSION_FINEST,
        _ => return None,
    };
    // Positive, or not asked for.
    let tolerance = query.tolerance.filter(|t| *t > 0.0)?;
    let frames: Vec<_> = bodies.iter().map(Body::ends).collect();
    if query.motion == Motion::Earliest {
        // The two ends of an edge differ from any one point by half of its length, one or the other.
        let mut sides = bodies.iter().zip(&frames).flat_map(|(body, frames)| {
            let side = |[p, q]: [u32; 2]| largest(frames, p, frames, q);
            body.faces().iter().map(move |&[p, q, r]| side([p, q]).max(side([q, r])).max(side([r, p])))
        });
        return sides.any(|side| tolerance < finest * side / 2.0).then_some(None);
    }
    if (found.vf.is_empty() && found.ee.is_empty()) || tolerance >= finest * extent(&frames) {
        return None;
    }
    // Vertices, faces and edges of all bodies are numbered one after the other.
    let at = |v: u32| {
        let body = (bodies.len() == 2 && v >= layout.starts[1].vertex) as usize;
        (&frames[body], v - layout.starts[body].vertex)
    };
    let large = |one: &[u32], other: &[u32]| {
        let differences = one.iter().flat_map(|&p| other.iter().map(move |&q| (p, q)));
        let mut reaches = differences.map(|(p, q)| {
            let ((of_p, p), (of_q, q)) = (at(p), at(q));
            largest(of_p, p, of_q, q)
        });
        reaches.any(|reach| tolerance < finest * reach)
    };
    let vf = |hit: &&Hit| large(&[hit.a], &layout.faces[hit.b as usize]);
    let ee = |hit: &&Hit| large(&layout.edges[hit.a as usize], &layout.edges[hit.b as usize]);
    let count = found.vf.par_iter().filter(vf).count() + found.ee.par_iter().filter(ee).count();
    Some(Some(count as u64))
}

/// A body's positions at both ends of the step.
type Ends<'a> = [&'a Positions; 2];

fn point(positions: &Positions, v: u32) -> [f64; 3] {
    // Faces were checked when the mesh was made: every vertex is there.
    positions.get_f64(v as usize).unwrap_or_default()
}

/// The largest component of the difference of two vertices, at either end of the step.
fn largest(one: &Ends, p: u32, other: &Ends, q: u32) -> f64 {
    let apart = |i: usize| {
        let (p, q) = (point(one[i], p), point(other[i], q));
        (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max)
    };
    apart(0).max(apart(1))
}

/// The largest difference of coordinates of all: no pair is larger.
fn extent(frames: &[Ends]) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for positions in frames.iter().flatten() {
        for v in 0..positions.len() as u32 {
            let p = point(positions, v);
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
        }
    }
    (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max)
}
