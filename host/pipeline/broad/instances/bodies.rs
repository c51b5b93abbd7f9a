//! The search of queries of pairs of bodies: relations and their words, down to pairs of triangles
//! that may decide a row.

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
    InstancesWithinArgs, NodesWithinArgs, RelationWords, RelationsWithinArgs, TouchingArgs, counter,
};
use nearmiss_kernels::entry;

/// The query of a search.
#[derive(Clone, Copy)]
enum Wanted {
    /// Bodies that share a point: all, or the first alone.
    Touching { only_first: bool },
    /// Distances up to a limit.
    Within(f64),
}

impl Wanted {
    fn of(query: &Query) -> Wanted {
        if let Query::BodyDistances(query) = query {
            // Adding zero turns -0.0 into 0.0.
            return Wanted::Within(query.within + 0.0);
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
}

impl PairSearch {
    /// Allocates groups over the bodies of a layout, for a query of pairs of bodies. At least one
    /// body moves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, query: &Query, margin: f32) -> Result<Self, Error> {
        let mut bodies = BodyGroups::new(device, layout)?;
        bodies.groups.set_margin(margin);
        let room = bodies.relations.capacity();
        // One counter counts relations and their words, so all have the same room.
        let words = |name| List::new(device, name, counter::RELATIONS, room);
        let words = [
            words("bounds of related bodies")?,
            words("related bodies that share a point")?,
            words("nearest triangles of related bodies")?,
        ];
        Ok(PairSearch { bodies, wanted: Wanted::of(query), words })
    }

    /// The words, for kernels.
    fn words(&self) -> RelationWords {
        let [least, touching, first] = self.words.each_ref().map(List::entries);
        let within = if let Wanted::Within(within) = self.wanted { within } else { 0.0 };
        RelationWords { least, touching, first, within }
    }

    fn touching<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        candidates: &Candidates,
        only_first: bool,
    ) -> Result<(), Error> {
        let (device, words) = (given.device, self.words());
        let room = self.bodies.body_pairs.capacity();
        let args = self.bodies.relations_args(given, candidates.counters)?;
        launch::striding::<entry::traverse_relations>(device, room, &args)?;
        let of = (args.relations, args.counters);
        self.bodies.descend(given, of, |args| striding::<entry::traverse_nodes>(device, args))?;
        let of = self.bodies.instances_args(&args, candidates);
        let args = TouchingArgs { of, words, only_first: only_first.into(), pad: 0 };
        striding::<entry::traverse_touching>(device, &args)
    }

    fn within<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        candidates: &Candidates,
    ) -> Result<(), Error> {
        let (device, words) = (given.device, self.words());
        let (pairs, relations) = (self.bodies.body_pairs.capacity(), self.bodies.relations.capacity());
        let of = self.bodies.relations_args(given, candidates.counters)?;
        let args = RelationsWithinArgs { of, words };
        launch::striding::<entry::traverse_relations_within>(device, pairs, &args)?;
        self.bodies.descend(given, (of.relations, of.counters), |of| {
            let args = NodesWithinArgs { of: *of, words };
            let room = if of.pairs.room() == 0 { relations } else { of.pairs.room() as usize };
            launch::striding::<entry::traverse_bounds>(device, room, &args)?;
            striding::<entry::traverse_nodes_within>(device, &args)
        })?;
        let args = InstancesWithinArgs { of: self.bodies.instances_args(&of, candidates), words };
        striding::<entry::traverse_corners>(device, &args)?;
        striding::<entry::traverse_instances_within>(device, &args)
    }
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
    fn set_margin(&mut self, margin: f32) -> bool {
        self.bodies.groups.set_margin(margin) | self.bodies.is_stale
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
        match self.wanted {
            Wanted::Touching { only_first } => self.touching(given, candidates, only_first),
            Wanted::Within(_) => self.within(given, candidates),
        }
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let mut all = self.bodies.all_lists();
        all.extend(self.words.iter_mut().map(|list| list as &mut dyn GrowableOutput));
        all
    }

    fn placeable(&self) -> Option<Placeable> {
        self.bodies.place(self.words())
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
