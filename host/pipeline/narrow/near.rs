//! Features at one time: their lists, and the launches from triangle pairs to those within a
//! distance.

use super::answer::rows_of;
use super::features::Features;
use super::{AnswerLists, Narrow, NarrowContext, RowSpans, growable};
use crate::contacts::Entries;
use crate::device::{Ahead, Buffer, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::order::{Order, Ordering, Unordered};
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::{Hits, Listed};
use crate::pipeline::{launch, purpose};
use crate::query::Query;
use nearmiss_kernels::abi::{
    BodyTolerance, Counter, Counters, NearArgs, NearExcludingArgs, NearHit, Output, Pair, Span,
    ThickNearArgs, counter,
};

/// Names of the lists of pairs of vertices with a thickness that the first launch leaves open.
const OPEN: [&str; 2] = ["vertex/face pairs that are open", "edge/edge pairs that are open"];

/// A step of the phase.
#[derive(Clone, Copy)]
enum Step {
    /// Lists vertex/face and edge/edge candidates.
    Features,
    /// Lists those within the distance.
    Near,
}

impl Step {
    /// All steps, in order.
    const ALL: [Step; 2] = [Step::Features, Step::Near];
}

/// The lists of a near query.
pub struct NearNarrow {
    distance: f64,
    /// Whether the scene excludes pairs.
    excludes: bool,
    /// Vertices and faces within the distance.
    vf_hits: List<NearHit>,
    /// Edges within the distance.
    ee_hits: List<NearHit>,
    /// Counter of hits that are not certainly within the distance.
    undecided: Counter,
    /// The thickness of every vertex; empty in a scene without.
    radii: Buffer<f64>,
    /// Pairs of vertices with a thickness that the first launch leaves to the second, vertex/face and
    /// edge/edge. None if radii are the same within each body, and no pairs are excluded.
    open: Option<[List<Pair>; 2]>,
    /// All hits in order, if the device orders them.
    ordered: Option<Order<NearHit>>,
}

impl NearNarrow {
    /// Allocates the lists, with room for `few` hits, of a scene with or without a thickness and
    /// excluded pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, distance: f64, layout: &Layout, few: usize) -> Result<Self, Error> {
        let excludes = !layout.excluded.is_empty();
        let has_open = layout.is_uneven || (layout.is_thick() && excludes);
        let open = || {
            let [vf, ee] = OPEN;
            Ok::<_, Error>([
                List::new(device, vf, counter::VF_OPEN_NEAR, few / 4)?,
                List::new(device, ee, counter::EE_OPEN_NEAR, few / 2)?,
            ])
        };
        Ok(NearNarrow {
            distance,
            excludes,
            vf_hits: List::new(device, "vertex/face pairs within the distance", counter::VF_HITS, few)?,
            ee_hits: List::new(device, "edge/edge pairs within the distance", counter::EE_HITS, 2 * few)?,
            undecided: counter::UNDECIDED,
            radii: device.of(purpose::RADII).upload(&layout.radii)?,
            open: has_open.then(open).transpose()?,
            ordered: None,
        })
    }

    fn measure<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let [vf, ee] = &given.features.candidates;
        let args = NearArgs {
            positions: given.frames.still,
            faces: given.faces,
            edges: given.features.edges.span(),
            vf: vf.output(given.counters),
            ee: ee.output(given.counters),
            vf_hits: self.vf_hits.output(given.counters),
            ee_hits: self.ee_hits.output(given.counters),
            counters: given.counters,
            distance: self.distance,
        };
        let count = vf.capacity() + ee.capacity();
        if !self.radii.is_empty() {
            let of = |list: &List<Pair>| list.output(given.counters);
            let [vf_open, ee_open] =
                self.open.as_ref().map_or([Output::EMPTY; 2], |[vf, ee]| [of(vf), of(ee)]);
            let (radii, tables) = (self.radii.span(), given.excluded);
            let args = ThickNearArgs { near: args, vf_open, ee_open, radii, tables };
            launch::striding::<R::ThickNear>(given.device, count, &args)?;
            let Some([vf, ee]) = &self.open else { return Ok(()) };
            let count = vf.capacity() + ee.capacity();
            return launch::striding::<R::OpenNear>(given.device, count, &args);
        }
        if self.excludes {
            let args = NearExcludingArgs { near: args, tables: given.excluded };
            return launch::at_once::<R::NearExcluding>(given.device, count, &args);
        }
        launch::striding::<R::Near>(given.device, count, &args)
    }
}

impl<R: Precision> Narrow<R> for NearNarrow {
    fn steps(&self) -> Vec<&'static str> {
        let name = |step| match step {
            Step::Features => "features",
            Step::Near => "near",
        };
        Step::ALL.map(name).into()
    }

    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error> {
        match Step::ALL[step] {
            Step::Features => {
                let within = (self.distance, Span::EMPTY);
                if self.radii.is_empty() {
                    given.features.run::<R, R::FeaturesAtRest>(given, given.pairs, within)
                } else {
                    given.features.run::<R, R::ThickAtRest>(given, given.pairs, within)
                }
            }
            Step::Near => self.measure(given),
        }
    }

    fn set(&mut self, _: &Device, query: &Query, _: &[BodyTolerance]) -> Result<(), Error> {
        self.distance = query.listed_within();
        Ok(())
    }

    fn lists<'a>(&'a mut self, step: usize, features: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput> {
        match Step::ALL[step] {
            Step::Features => growable(&mut features.candidates).collect(),
            Step::Near => growable([&mut self.vf_hits, &mut self.ee_hits])
                .chain(growable([&mut self.undecided]))
                .chain(growable(self.open.iter_mut().flatten()))
                .collect(),
        }
    }

    fn between<'a>(&'a self, features: &'a Features) -> Vec<Named<'a>> {
        let mut lists = features.between();
        if let Some([vf, ee]) = &self.open {
            let [vf_name, ee_name] = ["narrow: vf that are open", "narrow: ee that are open"];
            lists.extend([named(vf_name, vf), named(ee_name, ee)]);
        }
        lists
    }

    fn ordering(&mut self) -> Option<&mut dyn Ordering> {
        Some(&mut self.ordered)
    }

    fn order(&mut self, given: &NarrowContext<R>, is_submitted: bool) -> Result<(), Error> {
        let Some(order) = &mut self.ordered else { return Ok(()) };
        let (first, second) = (&self.vf_hits, Some(&self.ee_hits));
        let unordered = Unordered { first, second, decided: 0, is_submitted };
        order.run(given.device, &unordered, given.counters)
    }

    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>> {
        Hits::ahead(&[&self.vf_hits, &self.ee_hits], self.ordered.as_ref(), last)
    }

    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error> {
        let lists = [&self.vf_hits, &self.ee_hits];
        Ok(Listed::Near(Hits::of(&lists, self.ordered.as_ref(), counters)?))
    }

    fn rows(&self, counters: Counters) -> Option<RowSpans> {
        Some(RowSpans::Near(rows_of(&[&self.vf_hits, &self.ee_hits], self.ordered.as_ref(), counters)))
    }

    fn answer(&self, features: &Features) -> AnswerLists {
        let edges = features.edges.span();
        let lists = [&self.vf_hits, &self.ee_hits];
        AnswerLists { edges, ..AnswerLists::of(Entries::NearPairs, &lists, self.ordered.as_ref()) }
    }
}
