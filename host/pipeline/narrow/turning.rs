//! Pairs of bodies that turn: their lists, and the launches around those of straight motion.

use super::exclude::Kept;
use super::left::{OfKinds, lists, named_lists};
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
use nearmiss_kernels::entry::{
    narrow_divide, narrow_turning, narrow_turning_chords, narrow_turning_common, narrow_turning_features,
};
use nearmiss_kernels::prim::inclusion::Params;

/// Candidates of each kind for which there is room at first.
const FEW: usize = 4096;

/// Pairs that one slice leaves.
const LEFT: OfKinds = [
    ("narrow: vf turning, left", "vertex/face pairs that turn, left by one slice", counter::VF_TURNING_LEFT),
    ("narrow: ee turning, left", "edge/edge pairs that turn, left by one slice", counter::EE_TURNING_LEFT),
];
/// Pairs that are no common case.
const WALKS: OfKinds = [
    ("narrow: vf walks", "vertex/face pairs that turn and take the walk", counter::VF_TURNING_WALKS),
    ("narrow: ee walks", "edge/edge pairs that turn and take the walk", counter::EE_TURNING_WALKS),
];

/// The lists; without room until a step has a body that may turn.
pub struct Turning {
    /// Triangle pairs of which neither body turns.
    straight: List<Pair>,
    /// The others, if no direction parts them.
    turning: List<Pair>,
    /// Those of them that leave their chords far.
    far: List<Pair>,
    /// Vertex/face and edge/edge pairs of both lists that turn.
    candidates: [List<Pair>; 2],
    /// Those of them that are not excluded, in a scene that excludes some.
    kept: Option<Kept>,
    /// Those that one slice leaves.
    left: [List<Pair>; 2],
    /// Those of them that take the walk.
    walks: [List<Pair>; 2],
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
            far: list("triangle pairs that turn far", counter::FAR_PAIRS)?,
            candidates: [
                list("vertex/face pairs that turn", counter::VF_TURNING)?,
                list("edge/edge pairs that turn", counter::EE_TURNING)?,
            ],
            kept: None,
            left: lists(device, LEFT, [0, 0])?,
            walks: lists(device, WALKS, [0, 0])?,
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

    /// Makes room. All candidates may go straight: the next step may have other bodies that turn. If
    /// only the earliest time is wanted, all pairs of features may be left: how many are depends on when
    /// it is known.
    fn reserve<R: Precision>(&mut self, given: &NarrowContext<R>, is_earliest: bool) -> Result<(), Error> {
        self.straight.reserve(given.device, given.pairs.room() as usize)?;
        for list in [&mut self.turning, &mut self.far].into_iter().chain(&mut self.candidates) {
            list.reserve(given.device, FEW)?;
        }
        for (kind, candidates) in self.candidates.iter().enumerate() {
            let room = if is_earliest { candidates.capacity() } else { FEW };
            self.left[kind].reserve(given.device, room)?;
            self.walks[kind].reserve(given.device, room)?;
        }
        Ok(())
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
        is_earliest: bool,
    ) -> Result<Output<Pair>, Error> {
        let Some(certified) = certified.filter(|_| !given.frames.turns.is_empty()) else {
            return Ok(given.pairs);
        };
        if given.may_grow {
            self.reserve(given, is_earliest)?;
        }
        let [straight, turning] = [&self.straight, &self.turning].map(|list| list.output(given.counters));
        let (frames, rest) = R::in_f64(given.frames, given.rest);
        let facets = given.features.facets();
        let gap = certified.min_separation + certified.tolerance.unwrap_or(0.0) + radii;
        let args = DivideArgs { frames, facets, pairs: given.pairs, straight, turning, gap };
        launch::striding::<narrow_divide>(given.device, given.pairs.room() as usize, &args)?;
        if !given.is_sample {
            let [vf, ee] = self.candidates.each_ref().map(|list| list.output(given.counters));
            let far = self.far.output(given.counters);
            let args = TurningFeaturesArgs { frames, rest, facets, pairs: turning, far, vf, ee, gap };
            launch::striding::<narrow_turning_chords>(given.device, self.turning.capacity(), &args)?;
            let args = TurningFeaturesArgs { pairs: far, far: Output::EMPTY, ..args };
            launch::striding::<narrow_turning_features>(given.device, self.far.capacity(), &args)?;
        }
        Ok(straight)
    }

    /// Returns the lists that [`Turning::divide`] fills.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        growable([&mut self.straight, &mut self.turning, &mut self.far]).chain(growable(&mut self.candidates))
    }

    /// Returns the lists that [`Turning::solve`] fills.
    pub fn left(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        growable(self.left.iter_mut().chain(&mut self.walks))
    }

    /// Returns the lists, with names: for comparing machines.
    pub fn between(&self) -> Vec<Named<'_>> {
        if self.straight.capacity() + self.turning.capacity() == 0 {
            return Vec::new();
        }
        let [vf, ee] = &self.candidates;
        let mut all = vec![
            named("narrow: straight", &self.straight),
            named("narrow: turning", &self.turning),
            named("narrow: far", &self.far),
            named("narrow: vf turning", vf),
            named("narrow: ee turning", ee),
        ];
        all.extend(named_lists(&self.left, LEFT).chain(named_lists(&self.walks, WALKS)));
        all
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
        let (frames, rest) = R::in_f64(given.frames, given.rest);
        let (left, walks) = (self.left.each_ref(), self.walks.each_ref());
        let args = |pairs: [&List<Pair>; 2], leaves: Option<[&List<Pair>; 2]>, params: Params| {
            let listed = |kind: usize| Listed {
                pairs: pairs[kind].output(given.counters),
                begun: Output::EMPTY,
                hits: hits[kind].output(given.counters),
                left: leaves.map_or(Output::EMPTY, |leaves| leaves[kind].output(given.counters)),
            };
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
                params,
                flags: RungFlags::NONE,
                pad: 0,
            };
            (pairs.into_iter().map(List::capacity).sum::<usize>(), TurningArgs { rung, rest })
        };
        let params = certified.params();
        let mut last = tested;
        if !certified.is_apart() {
            // One slice decides most pairs. Then lanes of a warp do the same.
            let one = Params { max_iterations: params.max_iterations.min(1), ..params };
            for (pairs, leaves, params) in [(tested, left, one), (left, walks, params)] {
                let (pairs, args) = args(pairs, Some(leaves), params);
                launch::at_once::<narrow_turning_common>(given.device, pairs, &args)?;
            }
            last = walks;
        }
        let (pairs, args) = args(last, None, params);
        launch::spread::<narrow_turning>(given.device, pairs, &args)
    }
}
