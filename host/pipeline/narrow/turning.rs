//! Pairs of bodies that turn: their lists, and the launches around those of straight motion.

use super::exclude::Kept;
use super::{NarrowContext, growable};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::precision::Precision;
use crate::query::Certified;
use nearmiss_kernels::abi::{
    BodyTolerance, DivideArgs, Hit, Listed, Output, Pair, RungArgs, RungFlags, Span, TurningArgs,
    TurningFeaturesArgs, counter,
};
use nearmiss_kernels::entry::{narrow_divide, narrow_turning, narrow_turning_features};

/// Candidates of each kind for which there is room at first.
const FEW: usize = 4096;

/// The lists; without room until a step has a body that may turn.
pub struct Turning {
    /// Triangle pairs of which neither body turns.
    straight: List<Pair>,
    /// The others.
    turning: List<Pair>,
    /// Vertex/face and edge/edge pairs of those.
    candidates: [List<Pair>; 2],
    /// Those of them that are not excluded, in a scene that excludes some.
    kept: Option<Kept>,
}

impl Turning {
    /// Returns empty lists.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device) -> Result<Self, Error> {
        let list = |name, counter| List::new(device, name, counter, 0);
        Ok(Turning {
            straight: list("triangle pairs that go straight", counter::STRAIGHT_PAIRS)?,
            turning: list("triangle pairs that turn", counter::TURNING_PAIRS)?,
            candidates: [
                list("vertex/face pairs that turn", counter::VF_TURNING)?,
                list("edge/edge pairs that turn", counter::EE_TURNING)?,
            ],
            kept: None,
        })
    }

    /// Drops pairs of features that are excluded.
    ///
    /// # Errors
    /// Device errors.
    pub fn exclude(&mut self, device: &Device) -> Result<(), Error> {
        let names = [
            ("vertex/face pairs that turn, without those excluded", counter::VF_TURNING_KEPT),
            ("edge/edge pairs that turn, without those excluded", counter::EE_TURNING_KEPT),
        ];
        self.kept = Some(Kept::new(device, names, [0, 0])?);
        Ok(())
    }

    /// Launches the step that drops them, if it is to run.
    ///
    /// # Errors
    /// Device errors.
    pub fn keep<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        let Some(kept) = self.kept.as_mut().filter(|_| !given.frames.turns.is_empty() && !given.is_sample)
        else {
            return Ok(());
        };
        if given.may_grow {
            kept.reserve(given.device, FEW)?;
        }
        kept.run(given, self.candidates.each_ref())
    }

    /// Returns the lists that [`Turning::keep`] fills.
    pub fn kept_lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        self.kept.iter_mut().flat_map(Kept::growable)
    }

    /// Makes room for all candidates: then a step in which other bodies turn has room too.
    fn reserve<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        let pairs = given.pairs.room() as usize;
        self.straight.reserve(given.device, pairs)?;
        self.turning.reserve(given.device, pairs)?;
        self.candidates.iter_mut().try_for_each(|list| list.reserve(given.device, FEW))
    }

    /// Divides the candidates, and lists the features of those that turn. Returns the others: all for a
    /// solver that is not certified, and goes straight. A sample has none of those that turn: it only
    /// wants a bound.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; device errors.
    pub fn divide<R: Precision>(
        &mut self,
        given: &NarrowContext<R>,
        (certified, radii): (Option<&Certified>, f64),
    ) -> Result<Output<Pair>, Error> {
        let Some(certified) = certified.filter(|_| !given.frames.turns.is_empty()) else {
            return Ok(given.pairs);
        };
        if given.may_grow {
            self.reserve(given)?;
        }
        let (straight, turning) = (self.straight.output(given.counters), self.turning.output(given.counters));
        let args = DivideArgs {
            turns: given.frames.turns,
            faces: given.faces,
            pairs: given.pairs,
            straight,
            turning,
        };
        launch::striding::<narrow_divide>(given.device, given.pairs.room() as usize, &args)?;
        if !given.is_sample {
            let [vf, ee] = self.candidates.each_ref().map(|list| list.output(given.counters));
            let (frames, rest) = R::in_f64(given.frames, given.rest);
            let facets = given.features.facets();
            let gap = certified.min_separation + certified.tolerance.unwrap_or(0.0) + radii;
            let args = TurningFeaturesArgs { frames, rest, facets, pairs: turning, vf, ee, gap };
            launch::striding::<narrow_turning_features>(given.device, self.turning.capacity(), &args)?;
        }
        Ok(straight)
    }

    /// Returns the lists that [`Turning::divide`] fills.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        growable([&mut self.straight, &mut self.turning]).chain(growable(&mut self.candidates))
    }

    /// Returns the lists, with names: for comparing machines.
    pub fn between(&self) -> Vec<Named<'_>> {
        if self.straight.capacity() + self.turning.capacity() == 0 {
            return Vec::new();
        }
        let [vf, ee] = &self.candidates;
        vec![
            named("narrow: straight", &self.straight),
            named("narrow: turning", &self.turning),
            named("narrow: vf turning", vf),
            named("narrow: ee turning", ee),
        ]
    }

    /// Returns the pairs that the solver tests.
    pub fn tested(&self) -> [&List<Pair>; 2] {
        self.kept.as_ref().map_or(self.candidates.each_ref(), Kept::lists)
    }

    /// Launches the solver of the pairs that turn, in these lists. Its hits follow those of the others.
    ///
    /// # Errors
    /// Device errors.
    pub fn solve<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        (certified, tolerances): (&Certified, Span<BodyTolerance>),
        (tested, hits, earliest): ([&List<Pair>; 2], [&List<Hit>; 2], Span<u64>),
    ) -> Result<(), Error> {
        if given.frames.turns.is_empty() || given.is_sample {
            return Ok(());
        }
        let listed = |kind: usize| Listed {
            pairs: tested[kind].output(given.counters),
            begun: Output::EMPTY,
            hits: hits[kind].output(given.counters),
            left: Output::EMPTY,
        };
        let (frames, rest) = R::in_f64(given.frames, given.rest);
        let rung = RungArgs {
            frames,
            faces: given.faces,
            edges: given.features.edges.span(),
            vf: listed(0),
            ee: listed(1),
            vf_asked: Output::EMPTY,
            ee_asked: Output::EMPTY,
            earliest,
            counters: given.counters,
            tolerances,
            params: certified.params(),
            flags: RungFlags::NONE,
            pad: 0,
        };
        let pairs: usize = tested.into_iter().map(List::capacity).sum();
        launch::at_once::<narrow_turning>(given.device, pairs, &TurningArgs { rung, rest })
    }
}
