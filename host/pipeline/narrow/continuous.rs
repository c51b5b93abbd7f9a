//! Moving features: their lists, and the launches from triangle pairs to contacts, or to the first
//! of them.

mod bound;
mod first;
mod made;
mod steps;

use super::answer::rows_of;
use super::cull;
use super::exclude::Kept;
use super::features::Features;
use super::left::named_lists;
use super::rungs::Rungs;
use super::start::StartCheck;
use super::thin::{Thin, solver_in};
use super::turning::Turning;
use super::{AnswerLists, Narrow, NarrowContext, RowSpans, growable};
use crate::contacts::Entries;
use crate::device::{Ahead, Buffer, Device};
use crate::error::Error;
use crate::pipeline::below_precision::{self, BelowPrecision};
use crate::pipeline::counts::{Counts, FrameCounters};
use crate::pipeline::launch;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List, Named};
use crate::pipeline::order::{Order, Ordering, Unordered};
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::{Hits, Listed};
use crate::query::{self, Certified, ContinuousSolver, Query};
use crate::scene::Body;
use first::SecondPass;
use made::MAY_MEET;
use nearmiss_kernels::abi::rows::code;
use nearmiss_kernels::abi::{
    BodyTolerance, Counter, Counters, Hit, Pair, SolveArgs, Span, counter, earliest,
};
use steps::Step;

/// The lists of a continuous query, or of an earliest one.
pub struct ContinuousNarrow {
    /// The solver of all pairs, or of those with a thickness.
    solver: ContinuousSolver,
    /// The check of the start; none for a query that assumes a start without crossings.
    start: Option<StartCheck>,
    /// Pairs that may meet; `None` with a separation, which has no cull.
    survivors: Option<[List<Pair>; 2]>,
    /// Those that are not excluded, in a scene that excludes some.
    kept: Option<Kept>,
    /// Vertex/face contacts.
    pub vf_hits: List<Hit>,
    /// Edge/edge contacts.
    pub ee_hits: List<Hit>,
    /// Rungs of a certified solver.
    rungs: Rungs,
    /// Pairs of bodies that turn: tested by a certified solver.
    turning: Turning,
    /// Counters: pairs that isolation leaves; hits that are not certain, those whose iterations ran
    /// out, those with both, and those too large for the tolerance.
    counters: [Counter; 6],
    /// The smallest tolerance above 0, if pairs have several.
    finest: Option<f64>,
    /// Whether pairs may be too large for the tolerance: see [`BelowPrecision`].
    below_precision: Option<BelowPrecision>,
    /// Whether vertices have a thickness: then there is a separation, and no sample.
    is_thick: bool,
    /// The other pairs, if features without a thickness may meet and the query has no separation.
    thin: Option<Thin>,
    /// The smallest toi, for an earliest query.
    earliest: Option<Buffer<u64>>,
    /// The smallest toi of a sample, or a given time, if it bounds the query.
    bound: Option<Buffer<u64>>,
    /// The pass for the contacts at that time, in a submission that wants them. They are in the lists
    /// of contacts then.
    second: Option<SecondPass>,
    /// All contacts in order, if the device orders them.
    ordered: Option<Order<Hit>>,
}

/// The pairs that the solver tests: vertex/face and edge/edge.
struct Tested<'a> {
    /// Those that go straight.
    pairs: [&'a List<Pair>; 2],
    /// Those without a thickness, in a scene in which the others have one.
    thin: Option<[&'a List<Pair>; 2]>,
    /// Those of bodies that turn.
    turning: [&'a List<Pair>; 2],
}

impl ContinuousNarrow {
    /// Returns whether its contacts are proven.
    fn is_certified(&self) -> bool {
        self.solver.certified().is_some()
    }

    /// Returns the pairs that the solver tests.
    fn tested<'a>(&'a self, features: &'a Features) -> [&'a List<Pair>; 2] {
        self.kept.as_ref().map_or_else(|| self.may_meet(features), Kept::lists)
    }

    /// Returns the pairs that may meet, with those that are excluded.
    fn may_meet<'a>(&'a self, features: &'a Features) -> [&'a List<Pair>; 2] {
        let sifted = self.thin.as_ref().and_then(Thin::thick);
        sifted.unwrap_or_else(|| self.survivors.as_ref().unwrap_or(&features.candidates).each_ref())
    }

    /// Puts pairs, vertex/face and edge/edge, among those that [`ContinuousNarrow::solve`] tests,
    /// and their numbers in `counts`.
    ///
    /// # Errors
    /// Device errors.
    ///
    /// # Panics
    /// If there are more pairs than room: a fault of the caller.
    pub fn put_survivors(
        &mut self,
        features: &mut Features,
        [vf, ee]: [&[Pair]; 2],
        counts: &mut Counts,
    ) -> Result<(), Error> {
        let [vf_list, ee_list] = self.survivors.as_mut().unwrap_or(&mut features.candidates);
        vf_list.put(vf, counts)?;
        ee_list.put(ee, counts)
    }

    /// Launches the cull, which keeps pairs that may meet; for pairs with a separation it launches
    /// nothing.
    ///
    /// # Errors
    /// Device errors.
    pub fn cull<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        if let Some(thin) = &self.thin {
            return thin.cull(given);
        }
        let Some(survivors) = &self.survivors else { return Ok(()) };
        let lists = [&given.features.candidates, survivors];
        cull::run(given, lists, self.solver.certified(), self.known(given.is_sample))
    }

    /// Launches the solver.
    ///
    /// # Errors
    /// Device errors.
    pub fn solve<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        let first = if given.is_sample { &mut self.bound } else { &mut self.earliest };
        let earliest = first.as_ref().map_or(Span::EMPTY, Buffer::span);
        if let Some(earliest) = first {
            // All bits set: the greatest word.
            earliest.fill(u8::MAX)?;
        }
        let hits = [&self.vf_hits, &self.ee_hits];
        let tested = Tested {
            pairs: self.tested(given.features),
            thin: self.thin.as_ref().map(Thin::tested),
            turning: self.turning.tested(),
        };
        self.launch_solver(given, &tested, (hits, earliest))?;
        if !self.is_certified() {
            return Ok(());
        }
        let listed = (given.features.edges.span(), &self.vf_hits, &self.ee_hits);
        below_precision::count(self.below_precision, self.rungs.tolerances(), listed, given)
    }

    /// Launches the solver over pairs that go straight, and over those that turn.
    fn launch_solver<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        &Tested { pairs: [vf, ee], thin, turning }: &Tested,
        (hits, earliest): ([&List<Hit>; 2], Span<u64>),
    ) -> Result<(), Error> {
        let edges = given.features.edges.span();
        let precision = match self.solver {
            ContinuousSolver::Certified(certified) => {
                self.rungs.climb(given, (edges, given.is_sample), ([vf, ee], hits, earliest))?;
                let mut certified = certified;
                if let (Some(of_thin), Some(tested)) = (&self.thin, thin) {
                    of_thin.solve(given, (tested, hits, earliest))?;
                    certified = *of_thin.certified();
                }
                let tolerances = self.rungs.tolerances();
                return self.turning.solve(given, (&certified, tolerances), (turning, hits, earliest));
            }
            ContinuousSolver::Cubic(precision) => precision,
        };
        let args = |survivors: &List<Pair>, hits: &List<Hit>| SolveArgs {
            frames: given.frames,
            faces: given.faces,
            edges,
            survivors: survivors.output(given.counters),
            hits: hits.output(given.counters),
            earliest,
            counters: given.counters,
        };
        let (of_vf, of_ee) = (args(vf, hits[0]), args(ee, hits[1]));
        match precision {
            query::Precision::F32 => {
                launch::striding::<R::Vf32>(given.device, vf.capacity(), &of_vf)?;
                launch::striding::<R::Ee32>(given.device, ee.capacity(), &of_ee)
            }
            query::Precision::F64 => {
                launch::striding::<R::Vf64>(given.device, vf.capacity(), &of_vf)?;
                launch::striding::<R::Ee64>(given.device, ee.capacity(), &of_ee)
            }
        }
    }
}

impl<R: Precision> Narrow<R> for ContinuousNarrow {
    fn steps(&self) -> Vec<&'static str> {
        self.all_steps().map(Step::name).collect()
    }

    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error> {
        match self.step_at(step)? {
            // A sample has only a part of the candidates, and none of it is counted.
            Step::Start => match self.start.as_ref().filter(|_| !given.is_sample) {
                Some(start) => given.device.beside(|| start.run(given)),
                None => Ok(()),
            },
            Step::Features => {
                let gap = self.solver.certified().filter(|certified| certified.is_apart());
                let known = self.known(given.is_sample);
                let numbers = (gap.map_or(0.0, Certified::listed_within), known);
                let thick = (self.solver.certified(), 2.0 * self.rungs.largest_radius());
                let pairs = self.turning.divide(given, thick, self.earliest.is_some())?;
                if let Some(thin) = &self.thin {
                    let thick = thin.divide(given, pairs)?;
                    given.features.run::<R, R::ThickFeatures>(given, thick, numbers)?;
                    thin.features(given)
                } else if self.is_thick {
                    given.features.run::<R, R::ThickFeatures>(given, pairs, numbers)
                } else if known.is_empty() {
                    given.features.run::<R, R::Features>(given, pairs, numbers)
                } else {
                    given.features.run::<R, R::FeaturesBefore>(given, pairs, numbers)
                }
            }
            Step::Cull => self.cull(given),
            Step::Exclude => self.keep(given),
            Step::Solve => self.solve(given),
        }
    }

    fn take_samples(&mut self, device: &Device) -> Result<(), Error> {
        if self.earliest.is_some() { self.take_bound(device) } else { Ok(()) }
    }

    fn samples(&self) -> bool {
        self.earliest.is_some() && self.bound.is_some()
    }

    fn take_second(&mut self, device: &Device, wanted: bool) -> Result<bool, Error> {
        self.keep_second(device, wanted)
    }

    fn second(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        self.run_second(given)
    }

    fn counters_of_second(&self) -> Option<&FrameCounters> {
        self.second_counters()
    }

    fn lists_of_second(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.lists_of_second()
    }

    fn checks_start(&self) -> bool {
        self.start.is_some()
    }

    fn bound(&self) -> Option<Span<u64>> {
        self.bound.as_ref().map(Buffer::span)
    }

    fn set(&mut self, device: &Device, query: &Query, tolerances: &[BodyTolerance]) -> Result<(), Error> {
        self.bind(query)?;
        let Some(certified) = query.certified() else { return Ok(()) };
        self.solver = solver_in((*certified).into(), self.is_thick);
        self.finest = tolerances.iter().map(|record| record.tolerance).reduce(f64::min);
        if let Some(thin) = &mut self.thin {
            thin.set(device, certified, tolerances)?;
        }
        let own = self.solver.certified().unwrap_or(certified);
        self.rungs.set(device, own, tolerances)
    }

    fn lists<'a>(&'a mut self, step: usize, features: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput> {
        let Ok(step) = self.step_at(step) else { return Vec::new() };
        match step {
            Step::Start => self.start.as_mut().map_or(Vec::new(), StartCheck::lists),
            Step::Features => {
                let all = growable(&mut features.candidates).chain(self.turning.lists());
                all.chain(self.thin.iter_mut().flat_map(Thin::listed)).collect()
            }
            Step::Cull => {
                let thin = self.thin.iter_mut().flat_map(Thin::culled);
                growable(self.survivors.iter_mut().flatten()).chain(thin).collect()
            }
            Step::Exclude => {
                let kept = self.kept.iter_mut().flat_map(Kept::growable);
                let thin = self.thin.iter_mut().flat_map(Thin::kept);
                kept.chain(self.turning.kept_lists()).chain(thin).collect()
            }
            Step::Solve => growable([&mut self.vf_hits, &mut self.ee_hits])
                .chain(growable(&mut self.counters))
                .chain(self.rungs.lists())
                .chain(self.turning.left())
                .chain(self.thin.iter_mut().flat_map(Thin::left))
                .collect(),
        }
    }

    fn between<'a>(&'a self, features: &'a Features) -> Vec<Named<'a>> {
        if self.earliest.is_some() {
            // The test of a pair depends on the pairs found before it.
            return Vec::new();
        }
        let mut lists: Vec<_> = self.start.iter().flat_map(StartCheck::uncertain).collect();
        lists.extend(features.between());
        lists.extend(self.turning.between());
        lists.extend(self.survivors.iter().flat_map(|lists| named_lists(lists, MAY_MEET)));
        let names = ["narrow: vf that are not excluded", "narrow: ee that are not excluded"];
        lists.extend(self.kept.iter().flat_map(|kept| kept.between(names)));
        lists.extend(self.rungs.between());
        lists.extend(self.thin.iter().flat_map(Thin::between));
        lists
    }

    fn place(&mut self, bodies: &[Body], layout: &Layout) {
        let of = |certified: &Certified| {
            BelowPrecision::of((bodies, layout), certified, self.finest, self.earliest.is_some())
        };
        self.below_precision = self.solver.certified().and_then(of);
    }

    fn ordering(&mut self) -> Option<&mut dyn Ordering> {
        self.earliest.is_none().then_some(&mut self.ordered as &mut dyn Ordering)
    }

    fn order(&mut self, given: &NarrowContext<R>, is_submitted: bool) -> Result<(), Error> {
        let decided = if self.is_certified() { code::CERTIFIED } else { code::UNVERIFIED };
        let Some(order) = &mut self.ordered else { return Ok(()) };
        let (first, second) = (&self.vf_hits, Some(&self.ee_hits));
        let unordered = Unordered { first, second, decided, is_submitted };
        order.run(given.device, &unordered, given.counters)
    }

    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>> {
        match &self.earliest {
            Some(earliest) => vec![earliest.ahead(earliest.len())],
            None => Hits::ahead(&[&self.vf_hits, &self.ee_hits], self.ordered.as_ref(), last),
        }
    }

    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error> {
        if let Some(words) = &self.earliest {
            let first = earliest::of_key(words.read(words.len())?[earliest::KEY as usize]);
            let below_precision = self.below_precision == Some(BelowPrecision::Unlisted);
            let undecided = first.is_some_and(|(_, undecided)| undecided);
            let toi = first.map(|(toi, _)| toi);
            return Ok(Listed::Earliest { toi, undecided, below_precision });
        }
        let lists = [&self.vf_hits, &self.ee_hits];
        let hits = Hits::of(&lists, self.ordered.as_ref(), counters)?;
        Ok(Listed::Hits { hits, certified: self.is_certified() })
    }

    fn rows(&self, counters: Counters) -> Option<RowSpans> {
        let lists = [&self.vf_hits, &self.ee_hits];
        let rows = || RowSpans::Contacts(rows_of(&lists, self.ordered.as_ref(), counters));
        (self.earliest.is_none() || self.second.is_some()).then(rows)
    }

    fn answer(&self, features: &Features) -> AnswerLists {
        let lists = [&self.vf_hits, &self.ee_hits];
        AnswerLists {
            earliest: self.earliest.as_ref().map(|earliest| earliest.span().addr()),
            crossing: self.start.as_ref().map(|_| counter::STARTS_CROSSING),
            edges: features.edges.span(),
            ..AnswerLists::of(Entries::Contacts, &lists, self.ordered.as_ref())
        }
    }
}
