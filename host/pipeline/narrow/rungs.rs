//! The ladder of certified solvers: the rungs of a query, the lists between them, their launches.

use super::NarrowContext;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::{Certified, CertifiedPrecision};
use nearmiss_kernels::abi::{
    BodyTolerance, Counter, Hit, Listed, Output, Pair, RungArgs, RungFlags, Span, counter,
};
use nearmiss_kernels::entry::Entry;

/// A rung: one launch over the pairs that the one before left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rung {
    /// Isolation of roots in f32.
    Isolate32,
    /// Isolation of roots in f64; touching at the start, and flat motion.
    Isolate64,
    /// Touching at the start, and flat motion. If there is no f64, all that f32 leaves, by directions
    /// and nearness too.
    Settle,
    /// The time window in slices.
    Slice,
    /// Separation, in f32.
    Separate32,
    /// Separation, in f64.
    Separate64,
}

/// Returns the rungs of a solver.
fn rungs(certified: &Certified) -> &'static [Rung] {
    match (certified.precision, certified.is_apart()) {
        (CertifiedPrecision::F64, true) => &[Rung::Separate64],
        (CertifiedPrecision::Mixed | CertifiedPrecision::F32, true) => &[Rung::Separate32, Rung::Separate64],
        (CertifiedPrecision::F32, false) => &[Rung::Isolate32, Rung::Settle],
        (CertifiedPrecision::F64, false) => &[Rung::Isolate64, Rung::Slice],
        (CertifiedPrecision::Mixed, false) => &[Rung::Isolate32, Rung::Isolate64, Rung::Slice],
    }
}

/// The lists that rungs leave: a name for comparisons of machines, a name for errors, and the
/// counter.
const LEFT: [[(&str, &str, Counter); 2]; 2] = [
    [
        ("narrow: vf for f64", "vertex/face pairs for f64", counter::VF_ESCALATED),
        ("narrow: ee for f64", "edge/edge pairs for f64", counter::EE_ESCALATED),
    ],
    [
        ("narrow: vf for slices", "vertex/face pairs for slices", counter::VF_HARD),
        ("narrow: ee for slices", "edge/edge pairs for slices", counter::EE_HARD),
    ],
];

/// The lists of pairs to settle: a name for errors, and the counter.
const ASKED: [(&str, Counter); 2] =
    [("vertex/face pairs to settle", counter::VF_ASKED), ("edge/edge pairs to settle", counter::EE_ASKED)];

impl Rung {
    /// Returns which of these lists its undecided pairs go to.
    fn left(self) -> usize {
        match self {
            Rung::Isolate32 | Rung::Separate32 => 0,
            Rung::Isolate64 | Rung::Settle | Rung::Slice | Rung::Separate64 => 1,
        }
    }
}

/// The rungs of a certified solver, and the lists between them; empty for another solver.
pub struct Rungs {
    certified: Certified,
    rungs: &'static [Rung],
    /// Pairs that each rung except the last leaves: vertex/face, edge/edge.
    left: Vec<[List<Pair>; 2]>,
    /// Index into [`LEFT`] of each.
    names: Vec<usize>,
    /// Pairs that a long list in f64 leaves to be settled in a launch of their own; none without
    /// f64. They have no room, and there is no launch, until such a list was seen.
    asked: Option<[List<Pair>; 2]>,
    /// Tolerances of bodies; empty if all pairs have the same.
    tolerances: Buffer<BodyTolerance>,
    /// The values in `tolerances`.
    held: Vec<BodyTolerance>,
}

impl Rungs {
    /// Allocates the lists.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, certified: Option<&Certified>, capacity: [usize; 2]) -> Result<Self, Error> {
        let rungs = certified.map_or(&[][..], rungs);
        let names: Vec<_> = rungs.iter().rev().skip(1).rev().map(|rung| rung.left()).collect();
        let list = |(_, name, counter): (&str, &'static str, Counter), capacity| {
            List::new(device, name, counter, capacity)
        };
        let left = names
            .iter()
            .map(|&at| Ok([list(LEFT[at][0], capacity[0])?, list(LEFT[at][1], capacity[1])?]))
            .collect::<Result<_, Error>>()?;
        let asked = || {
            let [vf, ee] = ASKED;
            Ok::<_, Error>([List::new(device, vf.0, vf.1, 0)?, List::new(device, ee.0, ee.1, 0)?])
        };
        let asked = rungs.contains(&Rung::Isolate64).then(asked).transpose()?;
        let tolerances = device.of(purpose::TOLERANCES).buffer(0)?;
        let certified = certified.copied().unwrap_or_default();
        Ok(Rungs { certified, rungs, left, names, asked, tolerances, held: Vec::new() })
    }

    /// Sets the numbers of another solver of the same precision, and the tolerances of bodies;
    /// these are empty if all pairs have the same.
    ///
    /// # Errors
    /// Device errors.
    pub fn set(
        &mut self,
        device: &Device,
        certified: &Certified,
        tolerances: &[BodyTolerance],
    ) -> Result<(), Error> {
        self.certified = *certified;
        if self.held != tolerances {
            self.tolerances = device.of(purpose::TOLERANCES).upload(tolerances)?;
            self.held = tolerances.to_vec();
        }
        Ok(())
    }

    /// Returns the tolerances of bodies; empty if all pairs have the same.
    pub fn tolerances(&self) -> Span<BodyTolerance> {
        self.tolerances.span()
    }

    /// Returns the lists that the rungs fill.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        let asked = self.asked.iter_mut().flatten();
        self.left.iter_mut().flatten().chain(asked).map(|list| list as &mut dyn GrowableOutput)
    }

    /// Returns the lists, with names.
    pub fn between(&self) -> impl Iterator<Item = (&'static str, &List<Pair>)> {
        self.names
            .iter()
            .zip(&self.left)
            .flat_map(|(&at, [vf, ee])| [(LEFT[at][0].0, vf), (LEFT[at][1].0, ee)])
    }

    /// Launches the rungs, the first one over `first`. For a sample it launches only the rungs that
    /// find most contacts: the others would cost launches for little.
    ///
    /// # Errors
    /// Device errors.
    pub fn climb<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        (edges, sample): (Span<[u32; 2]>, bool),
        (first, hits, earliest): ([&List<Pair>; 2], [&List<Hit>; 2], Span<u64>),
    ) -> Result<(), Error> {
        let output =
            |list: Option<&List<Pair>>| list.map_or(Output::EMPTY, |list| list.output(given.counters));
        let asked = self.asked.as_ref().map(|lists| lists.each_ref()).filter(|_| !sample);
        let run = |rung, pairs: [&List<Pair>; 2], left: Option<[&List<Pair>; 2]>| {
            let listed = |kind: usize| Listed {
                pairs: pairs[kind].output(given.counters),
                hits: hits[kind].output(given.counters),
                left: output(left.map(|lists| lists[kind])),
            };
            let narrow = self.certified.precision == CertifiedPrecision::F32;
            let everything = narrow || rung == Rung::Isolate64;
            let args = RungArgs {
                frames: given.frames,
                faces: given.faces,
                edges,
                vf: listed(0),
                ee: listed(1),
                vf_asked: output(asked.map(|[vf, _]| vf)),
                ee_asked: output(asked.map(|[_, ee]| ee)),
                earliest,
                counters: given.counters,
                tolerances: self.tolerances.span(),
                params: self.certified.params(),
                flags: RungFlags::EVERYTHING.when(everything) | RungFlags::DEFERS.when(asked.is_some()),
                pad: 0,
            };
            let capacity = pairs[0].capacity() + pairs[1].capacity();
            start::<R>(rung, given.device, capacity, &args)
        };
        let mut pairs = first;
        for (at, &rung) in self.rungs.iter().enumerate() {
            if sample && !matches!(rung, Rung::Isolate32 | Rung::Isolate64) {
                break;
            }
            let left = self.left.get(at).map(|lists| lists.each_ref());
            run(rung, pairs, left)?;
            if let (Rung::Isolate64, Some([vf, ee])) = (rung, asked)
                && vf.capacity() + ee.capacity() > 0
            {
                run(Rung::Settle, [vf, ee], left)?;
            }
            pairs = left.unwrap_or(pairs);
        }
        Ok(())
    }
}

fn start<R: Precision>(
    rung: Rung,
    device: &Device,
    capacity: usize,
    args: &RungArgs<R>,
) -> Result<(), Error> {
    match rung {
        Rung::Isolate32 => launch::striding::<R::Isolate32>(device, capacity, args),
        // All warps that run at once share the pairs; there are few.
        Rung::Isolate64 => {
            let lanes = R::Isolate64::LANES as usize;
            launch::at_once::<R::Isolate64>(device, capacity.saturating_mul(lanes), args)
        }
        Rung::Settle => launch::striding::<R::Settle>(device, capacity, args),
        // A block per pair; there are few.
        Rung::Slice => {
            launch::at_once::<R::Slice>(device, capacity.saturating_mul(R::Slice::LANES as usize), args)
        }
        Rung::Separate32 => launch::at_once::<R::Separate32>(device, capacity, args),
        Rung::Separate64 => launch::at_once::<R::Separate64>(device, capacity, args),
    }
}
