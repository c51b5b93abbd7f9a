//! The search of queries of pairs of bodies: relations and their words, down to pairs of triangles
//! that may decide a row.

use super::descent::{self, Descent};
use super::{BodyGroups, striding, without_instances};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::{BroadContext, CandidateSearch, Candidates, Checked, Placeable};
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use crate::query::Query;
use nearmiss_kernels::abi::{
    Growth, InstancesWithinArgs, NodesWithinArgs, Output, Pair, RelationWords, RelationsArgs,
    RelationsWithinArgs, Span, TouchingArgs, TouchingFlags, counter,
};
use nearmiss_kernels::entry;

/// The query of a search.
#[derive(Clone, Copy)]
enum Wanted {
    /// Bodies that share a point: all, or the first alone.
    Touching { only_first: bool },
    /// Distances up to a limit, of each two bodies or of the nearest two of all.
    Within { within: f64, only_nearest: bool },
}

impl Wanted {
    fn of(query: &Query) -> Wanted {
        if let Query::BodyDistances(query) = query {
            // Adding zero turns -0.0 into 0.0.
            let within = query.within + 0.0;
            return Wanted::Within { within, only_nearest: query.only_nearest };
        }
        let only_first = matches!(query, Query::BodyPairs(query) if query.first == Some(1));
        Wanted::Touching { only_first }
    }
}

/// Bodies in groups, with words for each relation.
pub struct PairSearch {
    bodies: BodyGroups,
    wanted: Wanted,
    /// The words of [`RelationWords`]: bounds, triangles that share a point, nearest triangles. Each
    /// has room for every relation.
    words: [List<u64>; 3],
    /// Lists of distances; `None` for pairs that share a point.
    close: Option<Close>,
}

/// The lists of distances, behind those of bodies that share a point.
struct Close {
    descent: Descent,
    /// Triangles of bodies that share a point: those that do, and undecided ones.
    left: List<Pair>,
}

impl PairSearch {
    /// Allocates groups over the bodies of a layout, for a query of pairs of bodies. At least one
    /// body moves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, query: &Query, margin: f32) -> Result<Self, Error> {
        let mut bodies = BodyGroups::new(device, layout, descent::MEETING)?;
        bodies.groups.set_margin(margin);
        let (wanted, room) = (Wanted::of(query), bodies.relations.capacity());
        // One counter counts relations and their words, so all have the same room.
        let words = |name| List::new(device, name, counter::RELATIONS, room);
        let words = [
            words("bounds of related bodies")?,
            words("related bodies that share a point")?,
            words("nearest triangles of related bodies")?,
        ];
        let close = match wanted {
            Wanted::Touching { .. } => None,
            Wanted::Within { .. } => Some(Close {
                descent: Descent::new(device, descent::CLOSE, room)?,
                left: List::new(device, "triangles that may share a point", counter::TOUCHING_PAIRS, room)?,
            }),
        };
        Ok(PairSearch { bodies, wanted, words, close })
    }

    /// The words, for kernels.
    fn words(&self) -> RelationWords {
        let [least, touching, first] = self.words.each_ref().map(List::entries);
        let Wanted::Within { within, only_nearest } = self.wanted else {
            return RelationWords { least, touching, first, within: 0.0 };
        };
        // One bound for all relations.
        let least = if only_nearest { least.part(0, 1) } else { least };
        RelationWords { least, touching, first, within }
    }

    /// Finds related bodies that share a point. Lists what is left.
    fn touching<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        args: &RelationsArgs,
        (flags, left): (TouchingFlags, Output<Pair>),
    ) -> Result<(), Error> {
        let device = given.device;
        let descent = &mut self.bodies.descent;
        let (relations, pairs) = ((args.relations, args.counters), self.bodies.relations.capacity());
        descent.run(given, relations, pairs, |args| striding::<entry::traverse_nodes>(device, args))?;
        let of = descent.triangles(args, left);
        striding::<entry::traverse_touching>(device, &TouchingArgs { of, words: self.words(), flags, pad: 0 })
    }

    /// Lists candidates of related bodies that are not known to share a point.
    fn within<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        of: &RelationsArgs,
        candidates: &Candidates,
    ) -> Result<(), Error> {
        let (device, words) = (given.device, self.words());
        let room = self.bodies.relations.capacity();
        let Some(Close { descent, .. }) = &mut self.close else { return Err(without_lists()) };
        descent.run(given, (of.relations, of.counters), room, |args| {
            let args = NodesWithinArgs { of: *args, words };
            let of_pairs = args.of.pairs.room() as usize;
            let room = if of_pairs == 0 { room } else { of_pairs };
            launch::striding::<entry::traverse_bounds>(device, room, &args)?;
            striding::<entry::traverse_nodes_within>(device, &args)
        })?;
        let args = InstancesWithinArgs { of: descent.triangles(of, candidates.pairs), words };
        striding::<entry::traverse_corners>(device, &args)?;
        striding::<entry::traverse_instances_within>(device, &args)
    }
}

/// Error for a query of distances without its lists: a fault of the pipeline.
fn without_lists() -> Error {
    Error::Bug { what: "distances of bodies have lists, and there are none".into() }
}

impl<R: Precision> CandidateSearch<R> for PairSearch {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        let instances = given.instances.ok_or_else(without_instances)?;
        // Fixed bodies are fitted here, and need the boxes of this frame's vertices.
        instances.refit(given.device, given.frames.still)?;
        self.bodies.construct(given, layout)
    }

    fn learn(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// Boxes of bodies grow by the margin. Those of fixed bodies are fitted again if it grows.
    fn set_growth(&mut self, growth: Growth) -> bool {
        self.bodies.groups.set_margin(growth.margin) | self.bodies.is_stale
    }

    fn set(&mut self, query: &Query) {
        self.wanted = Wanted::of(query);
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        let instances = given.instances.ok_or_else(without_instances)?;
        instances.refit(given.device, given.frames.still)?;
        self.bodies.groups.fit(given.device, instances)
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.bodies.groups.refit(given.device)
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        // Relations have new numbers each time.
        self.words.iter_mut().try_for_each(List::clear)?;
        let (device, room) = (given.device, self.bodies.body_pairs.capacity());
        let args = self.bodies.relations_args(given, candidates.counters)?;
        match self.wanted {
            Wanted::Touching { only_first } => {
                launch::striding::<entry::traverse_relations>(device, room, &args)?;
                let flags = TouchingFlags::FIRST.when(only_first);
                self.touching(given, &args, (flags, candidates.pairs))
            }
            Wanted::Within { .. } => {
                let of = RelationsWithinArgs { of: args, words: self.words() };
                launch::striding::<entry::traverse_relations_within>(device, room, &of)?;
                let close = self.close.as_ref().ok_or_else(without_lists)?;
                let left = close.left.output(candidates.counters);
                self.touching(given, &args, (TouchingFlags::KEYS, left))?;
                self.within(given, &args, candidates)
            }
        }
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let mut all = self.bodies.all_lists();
        all.extend(self.words.iter_mut().map(|list| list as &mut dyn GrowableOutput));
        if let Some(close) = &mut self.close {
            all.extend(close.descent.lists());
            all.push(&mut close.left);
        }
        all
    }

    fn placeable(&self) -> Option<Placeable> {
        let met = &self.bodies.descent;
        match &self.close {
            None => self.bodies.place(met, self.words(), (Span::EMPTY, Span::EMPTY)),
            Some(close) => {
                let left = (close.left.entries(), met.tile_pairs.entries());
                self.bodies.place(&close.descent, self.words(), left)
            }
        }
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.bodies.count(counters);
        Ok(())
    }

    fn depths(&self) -> Vec<usize> {
        self.bodies.groups.depths()
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        CandidateSearch::<R>::fingerprints(&self.bodies)
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.bodies.check(layout, faces, frames)
    }
}
