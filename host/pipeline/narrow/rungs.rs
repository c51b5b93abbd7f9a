//! The ladder of certified solvers: the rungs of a query, the lists between them, their launches.

use super::{Capacities, NarrowContext};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::{Certified, CertifiedPrecision};
use bytemuck::Pod;
use nearmiss_kernels::abi::{
    Begun, BodyTolerance, Counter, Hit, Listed, Output, Pair, RungArgs, RungFlags, Span, ThickRungArgs,
    counter,
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
    /// Separation of features whose radii differ, in f64.
    SeparateThick,
    /// Before all others: features that are near at the start, if they must come nearer.
    Approach,
}

/// Returns the rungs of a solver.
fn rungs(certified: &Certified) -> Vec<Rung> {
    let of_solver: &[Rung] = match (certified.precision, certified.is_apart()) {
        (CertifiedPrecision::F64, true) => &[Rung::Separate64],
        (CertifiedPrecision::Mixed | CertifiedPrecision::F32, true) => &[Rung::Separate32, Rung::Separate64],
        (CertifiedPrecision::F32, false) => &[Rung::Isolate32, Rung::Settle],
        (CertifiedPrecision::F64, false) => &[Rung::Isolate64, Rung::Slice],
        (CertifiedPrecision::Mixed, false) => &[Rung::Isolate32, Rung::Isolate64, Rung::Slice],
    };
    let first = certified.approaching.then_some(Rung::Approach);
    first.into_iter().chain(of_solver.iter().copied()).collect()
}

/// Lists of both kinds: a name for comparisons of machines, a name for errors, and the counter.
type OfKinds = [(&'static str, &'static str, Counter); 2];

/// The lists that rungs leave.
const LEFT: [OfKinds; 3] = [
    [
        ("narrow: vf for f64", "vertex/face pairs for f64", counter::VF_ESCALATED),
        ("narrow: ee for f64", "edge/edge pairs for f64", counter::EE_ESCALATED),
    ],
    [
        ("narrow: vf for slices", "vertex/face pairs for slices", counter::VF_HARD),
        ("narrow: ee for slices", "edge/edge pairs for slices", counter::EE_HARD),
    ],
    [
        ("narrow: vf that may approach", "vertex/face pairs that may approach", counter::VF_APPROACHING),
        ("narrow: ee that may approach", "edge/edge pairs that may approach", counter::EE_APPROACHING),
    ],
];

/// The lists of pairs to settle. How many there are depends on the machine, so none is compared.
const ASKED: OfKinds = [
    ("", "vertex/face pairs to settle", counter::VF_ASKED),
    ("", "edge/edge pairs to settle", counter::EE_ASKED),
];

impl Rung {
    /// Returns which of these lists its undecided pairs go to.
    fn left(self) -> usize {
        match self {
            Rung::Isolate32 | Rung::Separate32 => 0,
            Rung::Isolate64 | Rung::Settle | Rung::Slice | Rung::Separate64 | Rung::SeparateThick => 1,
            Rung::Approach => 2,
        }
    }
}

/// Pairs that a rung leaves: vertex/face, edge/edge.
enum Left {
    /// To isolation, or to slices.
    Pairs([List<Pair>; 2]),
    /// With a separation: with times that are proven.
    Begun([List<Begun>; 2]),
}

/// The rungs of a certified solver, and the lists between them; empty for another solver.
pub struct Rungs {
    certified: Certified,
    rungs: Vec<Rung>,
    /// Pairs that each rung except the last leaves.
    left: Vec<Left>,
    /// Index into [`LEFT`] of each.
    names: Vec<usize>,
    /// Pairs that a long list in f64 leaves to be settled in a launch of their own; none without
    /// f64. In a query they have no room, and there is no launch, until such a list was seen.
    asked: Option<Left>,
    /// Tolerances of bodies; empty if all pairs have the same.
    tolerances: Buffer<BodyTolerance>,
    /// The thickness of every vertex, if it differs within a body; else empty.
    radii: Buffer<f64>,
    /// The values in `tolerances`.
    held: Vec<BodyTolerance>,
}

impl Left {
    fn capacity(&self) -> usize {
        match self {
            Left::Pairs([vf, ee]) => vf.capacity() + ee.capacity(),
            Left::Begun([vf, ee]) => vf.capacity() + ee.capacity(),
        }
    }
}

/// Allocates lists of both kinds.
fn lists<T: Pod>(device: &Device, names: OfKinds, capacity: [usize; 2]) -> Result<[List<T>; 2], Error> {
    let [(_, vf, vf_counter), (_, ee, ee_counter)] = names;
    Ok([List::new(device, vf, vf_counter, capacity[0])?, List::new(device, ee, ee_counter, capacity[1])?])
}

impl Rungs {
    /// Allocates the lists.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        certified: Option<&Certified>,
        capacities: &Capacities,
    ) -> Result<Self, Error> {
        let rungs = certified.map_or(Vec::new(), rungs);
        let leaving = rungs.split_last().map_or(&[][..], |(_, before)| before);
        let names: Vec<_> = leaving.iter().map(|rung| rung.left()).collect();
        let is_apart = certified.is_some_and(Certified::is_apart);
        let of = |rung: &Rung| {
            if *rung == Rung::Approach {
                lists(device, LEFT[rung.left()], capacities.survivors).map(Left::Pairs)
            } else if is_apart {
                lists(device, LEFT[rung.left()], capacities.left).map(Left::Begun)
            } else {
                lists(device, LEFT[rung.left()], capacities.left).map(Left::Pairs)
            }
        };
        let left = leaving.iter().map(of).collect::<Result<_, Error>>()?;
        let asked = || lists(device, ASKED, capacities.asked).map(Left::Pairs);
        let asked = rungs.contains(&Rung::Isolate64).then(asked).transpose()?;
        let tolerances = device.of(purpose::TOLERANCES).buffer(0)?;
        let radii = device.of(purpose::RADII).buffer(0)?;
        let certified = certified.copied().unwrap_or_default();
        Ok(Rungs { certified, rungs, left, names, asked, tolerances, radii, held: Vec::new() })
    }

    /// Makes them the one rung of vertices whose thickness differs within a body: in f64, to the last
    /// list. Pairs that approach are still sorted out before it.
    ///
    /// # Errors
    /// Device errors.
    pub fn thicken(&mut self, device: &Device, radii: &[f64]) -> Result<(), Error> {
        self.radii = device.of(purpose::RADII).upload(radii)?;
        self.rungs.retain(|rung| *rung == Rung::Approach);
        self.left.truncate(self.rungs.len());
        self.names.truncate(self.rungs.len());
        self.rungs.push(Rung::SeparateThick);
        self.asked = None;
        Ok(())
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

    /// Returns the largest radius of a body.
    pub fn largest_radius(&self) -> f64 {
        self.held.iter().map(|record| record.radius).fold(0.0, f64::max)
    }

    /// Returns the tolerances of bodies; empty if all pairs have the same.
    pub fn tolerances(&self) -> Span<BodyTolerance> {
        self.tolerances.span()
    }

    /// Returns the lists that the rungs fill.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        self.left.iter_mut().chain(&mut self.asked).flat_map(|left| -> [&mut dyn GrowableOutput; 2] {
            match left {
                Left::Pairs([vf, ee]) => [vf, ee],
                Left::Begun([vf, ee]) => [vf, ee],
            }
        })
    }

    /// Returns the lists, with names.
    pub fn between(&self) -> impl Iterator<Item = Named<'_>> {
        self.names.iter().zip(&self.left).flat_map(|(&at, left)| {
            let [vf_name, ee_name] = LEFT[at].map(|(name, ..)| name);
            match left {
                Left::Pairs([vf, ee]) => [named(vf_name, vf), named(ee_name, ee)],
                Left::Begun([vf, ee]) => [named(vf_name, vf), named(ee_name, ee)],
            }
        })
    }

    /// Launches the rungs, the first one over `first`. For a sample it launches only the rungs that
    /// find most contacts: the others would cost launches for little. There f64 works only if f32
    /// has found nothing: any time is a bound.
    ///
    /// # Errors
    /// Device errors.
    pub fn climb<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        (edges, sample): (Span<[u32; 2]>, bool),
        (first, hits, earliest): ([&List<Pair>; 2], [&List<Hit>; 2], Span<u64>),
    ) -> Result<(), Error> {
        let listed = |before: Option<&Left>, left: Option<&Left>, kind: usize| {
            let pairs = |of: &[List<Pair>; 2]| of[kind].output(given.counters);
            let begun = |of: &[List<Begun>; 2]| of[kind].output(given.counters);
            let mut listed = Listed {
                pairs: first[kind].output(given.counters),
                begun: Output::EMPTY,
                hits: hits[kind].output(given.counters),
                left: Output::EMPTY,
            };
            match before {
                Some(Left::Pairs(of)) => listed.pairs = pairs(of),
                Some(Left::Begun(of)) => (listed.pairs, listed.begun) = (Output::EMPTY, begun(of)),
                None => {}
            }
            match left {
                Some(Left::Pairs(of)) => listed.left = pairs(of),
                Some(Left::Begun(of)) => listed.begun = begun(of),
                None => {}
            }
            listed
        };
        let asked = self.asked.as_ref().filter(|_| !sample);
        let of_asked = |kind: usize| match asked {
            Some(Left::Pairs(of)) => of[kind].output(given.counters),
            _ => Output::EMPTY,
        };
        let run = |rung, before: Option<&Left>, left| {
            let narrow = self.certified.precision == CertifiedPrecision::F32;
            let everything = narrow || rung == Rung::Isolate64;
            let args = RungArgs {
                frames: given.frames,
                faces: given.faces,
                edges,
                vf: listed(before, left, 0),
                ee: listed(before, left, 1),
                vf_asked: of_asked(0),
                ee_asked: of_asked(1),
                earliest,
                counters: given.counters,
                tolerances: self.tolerances.span(),
                params: self.certified.params(),
                flags: RungFlags::EVERYTHING.when(everything)
                    | RungFlags::DEFERS.when(asked.is_some())
                    | RungFlags::MARKS.when(sample && rung == Rung::Isolate32)
                    | RungFlags::UNLESS_MARKED.when(sample && before.is_some()),
                pad: 0,
            };
            let capacity = before.map_or(first[0].capacity() + first[1].capacity(), Left::capacity);
            start::<R>(rung, given.device, capacity, (&args, self.radii.span()))
        };
        let mut before = None;
        for (at, &rung) in self.rungs.iter().enumerate() {
            if sample && !matches!(rung, Rung::Approach | Rung::Isolate32 | Rung::Isolate64) {
                break;
            }
            let left = self.left.get(at);
            run(rung, before, left)?;
            if rung == Rung::Isolate64 && asked.is_some_and(|asked| asked.capacity() > 0) {
                run(Rung::Settle, asked, left)?;
            }
            before = left;
        }
        Ok(())
    }
}

fn start<R: Precision>(
    rung: Rung,
    device: &Device,
    capacity: usize,
    (args, radii): (&RungArgs<R>, Span<f64>),
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
        Rung::Approach => {
            let args = ThickRungArgs { rung: *args, radii };
            launch::striding::<R::Approach>(device, capacity, &args)
        }
        Rung::SeparateThick => {
            let args = ThickRungArgs { rung: *args, radii };
            launch::at_once::<R::SeparateThick>(device, capacity, &args)
        }
    }
}
