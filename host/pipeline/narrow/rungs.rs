//! The ladder of certified solvers: the rungs of a query, the lists between them, their launches.
//!
//! # Two branches
//!
//! A query of what approaches has two branches behind distances: the first rung over pairs that are
//! beyond the separation at the start; and signs, integers, the first rung and advancement over the
//! others. They run at the same time.
//!
//! - Each reads lists that only launches before it wrote. No pair is in both branches.
//! - Both append to the contacts and to the list for the next rung, and add to counters: by atomics.
//!   An entry is a function of its pair, so schedules differ in the order of entries alone.
//! - Both lower the earliest time, by atomic minima. Isolation reads it and skips a pair if no verdict
//!   of the pair could begin before it. The time only falls, and is always that of a verdict. So no
//!   skipped pair could lower the least one, whichever branch found the time.
//! - The next rung comes after the first one of both branches. All come before what follows.

use super::left::{ASKED, Approaching, Left, Names, lists};
use super::rung::{Rung, rungs};
use super::{Capacities, NarrowContext};
use crate::device::{Buffer, Device, Place};
use crate::error::Error;
use crate::pipeline::list::{GrowableOutput, List, Named};
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use crate::query::{Certified, CertifiedPrecision};
use nearmiss_kernels::abi::{BodyTolerance, Counters, Hit, Listed, Output, Pair, RungArgs, RungFlags, Span};

/// The rungs of a certified solver, and the lists between them; empty for another solver.
pub struct Rungs {
    certified: Certified,
    rungs: Vec<Rung>,
    /// Pairs that each rung except the last leaves.
    left: Vec<Left>,
    /// Names of the lists.
    names: &'static Names,
    /// Pairs that a long list in f64 leaves to be settled in a launch of their own; none without
    /// f64. In a query they have no room, and there is no launch, until such a list was seen.
    asked: Option<Left>,
    /// The lists before the solver, in a query of what approaches.
    approaching: Option<Approaching>,
    /// Tolerances of bodies; empty if all pairs have the same.
    tolerances: Buffer<BodyTolerance>,
    /// The thickness of every vertex, if it differs within a body; else empty.
    radii: Buffer<f64>,
    /// The values in `tolerances`.
    held: Vec<BodyTolerance>,
}

impl Rungs {
    /// Allocates the lists, with these names.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        (certified, names): (Option<&Certified>, &'static Names),
        capacities: &Capacities,
    ) -> Result<Self, Error> {
        let rungs = certified.map_or(Vec::new(), |certified| rungs(certified).to_vec());
        let leaving = rungs.split_last().map_or(&[][..], |(_, before)| before);
        let is_apart = certified.is_some_and(Certified::is_apart);
        let of = |rung: &Rung| {
            if is_apart {
                lists(device, names.left[rung.left()], capacities.left).map(Left::Begun)
            } else {
                lists(device, names.left[rung.left()], capacities.left).map(Left::Pairs)
            }
        };
        let left = leaving.iter().map(of).collect::<Result<_, Error>>()?;
        let asked = || lists(device, ASKED, capacities.asked).map(Left::Pairs);
        let asked = rungs.contains(&Rung::Isolate64).then(asked).transpose()?;
        let approaches = certified.is_some_and(|certified| certified.approaching);
        let approaching = approaches.then(|| Approaching::new(device, names, capacities)).transpose()?;
        let tolerances = device.of(purpose::TOLERANCES).buffer(0)?;
        let radii = device.of(purpose::RADII).buffer(0)?;
        let certified = certified.copied().unwrap_or_default();
        Ok(Rungs { certified, rungs, left, names, asked, approaching, tolerances, radii, held: Vec::new() })
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
        let approaching = self.approaching.iter_mut().flat_map(Approaching::growable);
        self.left.iter_mut().chain(&mut self.asked).flat_map(Left::growable).chain(approaching)
    }

    /// Returns the lists, with names.
    pub fn between(&self) -> impl Iterator<Item = Named<'_>> {
        let left = self.rungs.iter().zip(&self.left);
        let left =
            left.flat_map(|(rung, left)| left.named(self.names.left[rung.left()].map(|(name, ..)| name)));
        left.chain(self.approaching.iter().flat_map(|own| own.named(self.names)))
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
        let all = first[0].capacity() + first[1].capacity();
        let asked = self.asked.as_ref().filter(|_| !sample);
        let run = |rung: Rung, over: Over| {
            let listed = |kind: usize| over.listed((first[kind], hits[kind]), kind, given.counters);
            let narrow = self.certified.precision == CertifiedPrecision::F32;
            let everything = narrow || rung == Rung::Isolate64;
            let args = RungArgs {
                frames: given.frames,
                faces: given.faces,
                edges,
                vf: listed(0),
                ee: listed(1),
                vf_asked: over.second(0, given.counters),
                ee_asked: over.second(1, given.counters),
                earliest,
                counters: given.counters,
                tolerances: self.tolerances.span(),
                params: self.certified.params(),
                flags: RungFlags::EVERYTHING.when(everything)
                    | RungFlags::DEFERS.when(asked.is_some())
                    | RungFlags::MARKS.when(sample && rung == Rung::Isolate32)
                    | RungFlags::UNLESS_MARKED.when(sample && over.before.is_some()),
                pad: 0,
            };
            let capacity = over.before.map_or(all, Left::capacity);
            rung.start::<R>(given.device, (capacity, over.place), (&args, self.radii.span()))
        };
        let of_first = Over { left: self.left.first(), second: asked, ..Over::default() };
        let mut before = None;
        let mut place = Place::Whole;
        if let (Some(of), Some(&solver)) = (&self.approaching, self.rungs.first()) {
            run(Rung::Approach, Over { left: Some(&of.beyond), second: Some(&of.near), ..Over::default() })?;
            // The solver of all others at the same time. They share counted lists, whose order is free.
            let candidates: usize = given.features.candidates.iter().map(List::capacity).sum();
            let has_place = solver.fills() && of.near.capacity().saturating_mul(FEW) <= candidates;
            let spare = if has_place { Place::Spare } else { Place::Whole };
            let near = Over { left: Some(&of.approaching), place: spare, ..Over::default() };
            given.device.beside(|| {
                let (second, advancing) = (Some(&of.unbounded), Some(&of.advancing));
                run(Rung::ApproachSigns, Over { before: Some(&of.near), second, advancing, ..near })?;
                run(Rung::ApproachExact, Over { before: Some(&of.unbounded), advancing, ..near })?;
                run(solver, Over { before: Some(&of.approaching), place: spare, ..of_first })
            })?;
            given.device.flag();
            let advancing = Over { before: Some(&of.advancing), place: spare, ..Over::default() };
            given.device.beside(|| run(Rung::ApproachAdvance, advancing))?;
            before = Some(&of.beyond);
            place = if has_place { Place::Rest } else { Place::Whole };
        }
        for (at, &rung) in self.rungs.iter().enumerate() {
            if sample && !matches!(rung, Rung::Isolate32 | Rung::Isolate64) {
                break;
            }
            let left = self.left.get(at);
            run(rung, Over { before, left, second: asked, place, ..Over::default() })?;
            if at == 0 && self.approaching.is_some() {
                given.device.join_flag();
            }
            if rung == Rung::Isolate64 && asked.is_some_and(|asked| asked.capacity() > 0) {
                run(Rung::Settle, Over { before: asked, left, second: asked, ..Over::default() })?;
            }
            (before, place) = (left, Place::Whole);
        }
        if self.approaching.is_some() {
            given.device.join();
        }
        Ok(())
    }
}

/// Pairs that may be near at the start are few if there is room for so many times as many candidates:
/// their launches in a place end before the solver does. Else they take the whole device. A list of
/// candidates has room for ten times its entries or more, and a place takes a fiftieth of them in time.
const FEW: usize = 512;

/// The lists of a launch, and its place.
#[derive(Clone, Copy, Default)]
struct Over<'a> {
    /// The pairs; none for the candidates.
    before: Option<&'a Left>,
    /// Pairs that it leaves.
    left: Option<&'a Left>,
    /// Others that it leaves: to be settled, or for the next launch before the solver.
    second: Option<&'a Left>,
    /// Pairs that it leaves with a time, before the solver.
    advancing: Option<&'a Left>,
    place: Place,
}

impl Over<'_> {
    /// Returns the lists of a kind.
    fn listed(&self, (first, hits): (&List<Pair>, &List<Hit>), kind: usize, counters: Counters) -> Listed {
        let mut listed = Listed {
            pairs: first.output(counters),
            begun: Output::EMPTY,
            hits: hits.output(counters),
            left: Output::EMPTY,
        };
        match self.before {
            Some(Left::Pairs(of)) => listed.pairs = of[kind].output(counters),
            Some(Left::Begun(of)) => {
                (listed.pairs, listed.begun) = (Output::EMPTY, of[kind].output(counters));
            }
            None => {}
        }
        for left in [self.left, self.advancing].into_iter().flatten() {
            match left {
                Left::Pairs(of) => listed.left = of[kind].output(counters),
                Left::Begun(of) => listed.begun = of[kind].output(counters),
            }
        }
        listed
    }

    /// Returns the second list of a kind.
    fn second(&self, kind: usize, counters: Counters) -> Output<Pair> {
        match self.second {
            Some(Left::Pairs(of)) => of[kind].output(counters),
            _ => Output::EMPTY,
        }
    }
}
