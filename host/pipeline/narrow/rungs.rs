//! The ladder of certified solvers: the rungs of a query, the lists between them, their launches.

use super::left::{ADVANCING, ASKED, LEFT, Left, lists};
use super::{Capacities, NarrowContext};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::{Certified, CertifiedPrecision};
use nearmiss_kernels::abi::{
    Begun, BodyTolerance, Hit, Listed, Output, Pair, RungArgs, RungFlags, Span, ThickRungArgs,
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
    /// Separation by the largest radius of each pair, in f32: only parts pairs.
    Part,
    /// Separation of features whose radii differ, in f64.
    SeparateThick,
    /// Before all others: features that are near at the start, if they must come nearer.
    Approach,
    /// Whether they do, by bounds of errors.
    ApproachSigns,
    /// Whether they do, in integers.
    ApproachExact,
    /// When they do, by advancement. The solver does not need it.
    ApproachAdvance,
}

/// The rungs that leave to the solver what approaches, in one list: that of the last of them.
const APPROACH: [Rung; 3] = [Rung::Approach, Rung::ApproachSigns, Rung::ApproachExact];

/// Returns the rungs of a solver.
fn rungs(certified: &Certified) -> Vec<Rung> {
    let of_solver: &[Rung] = match (certified.precision, certified.is_apart()) {
        (CertifiedPrecision::F64, true) => &[Rung::Separate64],
        (CertifiedPrecision::Mixed | CertifiedPrecision::F32, true) => &[Rung::Separate32, Rung::Separate64],
        (CertifiedPrecision::F32, false) => &[Rung::Isolate32, Rung::Settle],
        (CertifiedPrecision::F64, false) => &[Rung::Isolate64, Rung::Slice],
        (CertifiedPrecision::Mixed, false) => &[Rung::Isolate32, Rung::Isolate64, Rung::Slice],
    };
    let first: &[Rung] = if certified.approaching { &APPROACH } else { &[] };
    [first, of_solver].concat()
}

impl Rung {
    /// Returns which of these lists its undecided pairs go to.
    fn left(self) -> usize {
        match self {
            Rung::Isolate32 | Rung::Separate32 | Rung::Part => 0,
            Rung::Isolate64 | Rung::Settle | Rung::Slice | Rung::Separate64 | Rung::SeparateThick => 1,
            Rung::ApproachExact | Rung::ApproachAdvance => 2,
            Rung::Approach => 3,
            Rung::ApproachSigns => 4,
        }
    }

    /// Returns whether it is before the solver.
    fn is_before(self) -> bool {
        APPROACH.contains(&self)
    }
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
    /// In a query of what approaches: pairs whose distance may fall later.
    advancing: Option<[List<Begun>; 2]>,
    /// Tolerances of bodies; empty if all pairs have the same.
    tolerances: Buffer<BodyTolerance>,
    /// The thickness of every vertex, if it differs within a body; else empty.
    radii: Buffer<f64>,
    /// The values in `tolerances`.
    held: Vec<BodyTolerance>,
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
            let is_begun = is_apart && !rung.is_before();
            let is_last = *rung == Rung::ApproachExact;
            let capacity = if is_last { capacities.survivors } else { capacities.left };
            if is_begun {
                lists(device, LEFT[rung.left()], capacity).map(Left::Begun)
            } else {
                lists(device, LEFT[rung.left()], capacity).map(Left::Pairs)
            }
        };
        let left = leaving.iter().map(of).collect::<Result<_, Error>>()?;
        let asked = || lists(device, ASKED, capacities.asked).map(Left::Pairs);
        let asked = rungs.contains(&Rung::Isolate64).then(asked).transpose()?;
        let advances = rungs.contains(&Rung::Approach);
        let advancing = advances.then(|| lists(device, ADVANCING, capacities.left)).transpose()?;
        let tolerances = device.of(purpose::TOLERANCES).buffer(0)?;
        let radii = device.of(purpose::RADII).buffer(0)?;
        let certified = certified.copied().unwrap_or_default();
        Ok(Rungs { certified, rungs, left, names, asked, advancing, tolerances, radii, held: Vec::new() })
    }

    /// Makes them the rungs of vertices whose thickness differs within a body, with the same lists
    /// between them. In f32 a rung parts pairs; in f64 one decides the others. Pairs that approach
    /// are still sorted out before.
    ///
    /// # Errors
    /// Device errors.
    pub fn thicken(&mut self, device: &Device, radii: &[f64]) -> Result<(), Error> {
        self.radii = device.of(purpose::RADII).upload(radii)?;
        for rung in &mut self.rungs {
            if *rung == Rung::Separate32 {
                *rung = Rung::Part;
            } else if *rung == Rung::Separate64 {
                *rung = Rung::SeparateThick;
            }
        }
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
        let advancing = self.advancing.iter_mut().flatten().map(|list| list as &mut dyn GrowableOutput);
        self.left.iter_mut().chain(&mut self.asked).flat_map(Left::growable).chain(advancing)
    }

    /// Returns the lists, with names.
    pub fn between(&self) -> impl Iterator<Item = Named<'_>> {
        let advancing = self.advancing.iter().flatten().zip(ADVANCING.map(|(name, ..)| name));
        let advancing = advancing.map(|(list, name)| named(name, list));
        let left = self
            .names
            .iter()
            .zip(&self.left)
            .flat_map(|(&at, left)| left.named(LEFT[at].map(|(name, ..)| name)));
        left.chain(advancing)
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
        // A second list that it leaves: to be settled, or for the next rung before the solver.
        let second = |of: Option<&Left>, kind: usize| match of {
            Some(Left::Pairs(of)) => of[kind].output(given.counters),
            _ => Output::EMPTY,
        };
        let run_over = |capacity, rung: Rung, before: Option<&Left>, [left, other]: [Option<&Left>; 2]| {
            let narrow = self.certified.precision == CertifiedPrecision::F32;
            let everything = narrow || rung == Rung::Isolate64;
            let listed = |kind: usize| match (&self.advancing, rung) {
                (Some(of), Rung::ApproachSigns | Rung::ApproachExact) => {
                    Listed { begun: of[kind].output(given.counters), ..listed(before, left, kind) }
                }
                (Some(of), Rung::ApproachAdvance) => {
                    let begun = of[kind].output(given.counters);
                    Listed { pairs: Output::EMPTY, begun, ..listed(before, left, kind) }
                }
                _ => listed(before, left, kind),
            };
            let args = RungArgs {
                frames: given.frames,
                faces: given.faces,
                edges,
                vf: listed(0),
                ee: listed(1),
                vf_asked: second(other, 0),
                ee_asked: second(other, 1),
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
            start::<R>(rung, given.device, capacity, (&args, self.radii.span()))
        };
        let run = |rung, before: Option<&Left>, outputs| {
            let capacity = before.map_or(first[0].capacity() + first[1].capacity(), Left::capacity);
            run_over(capacity, rung, before, outputs)
        };
        let to_solver = self.rungs.iter().position(|&rung| rung == Rung::ApproachExact);
        let to_solver = to_solver.and_then(|at| self.left.get(at));
        let mut before = None;
        for (at, &rung) in self.rungs.iter().enumerate() {
            if sample && !rung.is_before() && !matches!(rung, Rung::Isolate32 | Rung::Isolate64) {
                break;
            }
            let left = self.left.get(at);
            let outputs = if rung == Rung::ApproachExact {
                [left, None]
            } else if rung.is_before() {
                [to_solver, left]
            } else {
                [left, asked]
            };
            run(rung, before, outputs)?;
            if rung == Rung::Isolate64 && asked.is_some_and(|asked| asked.capacity() > 0) {
                run(Rung::Settle, asked, [left, asked])?;
            }
            if let (Rung::ApproachExact, Some([vf, ee])) = (rung, &self.advancing) {
                let capacity = vf.capacity() + ee.capacity();
                given.device.beside(|| run_over(capacity, Rung::ApproachAdvance, None, [None; 2]))?;
            }
            before = left;
        }
        if self.advancing.is_some() {
            given.device.join();
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
    let thick = || ThickRungArgs { rung: *args, radii };
    match rung {
        Rung::Isolate32 => launch::striding::<R::Isolate32>(device, capacity, args),
        // All warps that run at once share the pairs; there are few.
        Rung::Isolate64 => spread::<R::Isolate64>(device, capacity, args),
        Rung::Settle => launch::striding::<R::Settle>(device, capacity, args),
        // A block per pair; there are few.
        Rung::Slice => spread::<R::Slice>(device, capacity, args),
        Rung::Separate32 => launch::at_once::<R::Separate32>(device, capacity, args),
        Rung::Separate64 => launch::at_once::<R::Separate64>(device, capacity, args),
        Rung::Approach => launch::striding::<R::Approach>(device, capacity, &thick()),
        // All warps that run at once share the pairs; there are few.
        Rung::ApproachSigns => spread::<R::ApproachSigns>(device, capacity, &thick()),
        Rung::ApproachExact => spread::<R::ApproachExact>(device, capacity, &thick()),
        Rung::ApproachAdvance => spread::<R::ApproachAdvance>(device, capacity, &thick()),
        Rung::Part => launch::at_once::<R::Part>(device, capacity, &thick()),
        Rung::SeparateThick => launch::at_once::<R::SeparateThick>(device, capacity, &thick()),
    }
}

/// Launches as many blocks as run at once, for few pairs that are spread over them.
fn spread<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    launch::at_once::<E>(device, capacity.saturating_mul(E::LANES as usize), args)
}
