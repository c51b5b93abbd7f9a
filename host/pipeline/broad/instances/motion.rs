//! The search of queries of features: bodies as instances, in a step or at rest, down to triangles of
//! the scene with their vertices.

use super::descent::Counted;
use super::{BodyGroups, striding, without_instances};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::{BroadContext, CandidateSearch, Candidates, Checked};
use crate::pipeline::counts::Counts;
use crate::pipeline::instances::InMotion;
use crate::pipeline::launch;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{
    Growth, InstancesArgs, MovingInstancesArgs, MovingNodesArgs, MovingRelation, MovingRelationsArgs, Output,
};
use nearmiss_kernels::entry;

/// Bodies in groups, around the whole step.
pub struct MotionSearch {
    bodies: BodyGroups<MovingRelation>,
    is_at_rest: bool,
    /// Growth of each box: half of the distance that counts as meeting.
    margin: f32,
}

impl MotionSearch {
    /// Allocates groups over the bodies of a layout, for a query at rest or in motion, with these
    /// counters of nodes and tiles. At least one body moves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        layout: &Layout,
        counted: Counted,
        (is_at_rest, margin): (bool, f32),
    ) -> Result<Self, Error> {
        let mut bodies = BodyGroups::new(device, layout, counted)?;
        bodies.groups.read_poses(if is_at_rest { 1 } else { 2 });
        bodies.groups.set_margin(margin);
        Ok(MotionSearch { bodies, is_at_rest, margin })
    }
}

/// The motions of a context's bodies.
pub fn motion<'a, R: Precision>(given: &BroadContext<'a, R>) -> Result<&'a InMotion, Error> {
    given.instances.and_then(|instances| instances.motion()).ok_or_else(without_instances)
}

impl<R: Precision> CandidateSearch<R> for MotionSearch {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        self.bodies.put_in_order(given, layout)
    }

    fn learn(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// Boxes of bodies and relations grow by the margin. Boxes of fixed bodies are fitted again if it
    /// grows.
    fn set_growth(&mut self, growth: Growth) -> bool {
        self.margin = growth.margin;
        self.bodies.groups.set_margin(growth.margin) | self.bodies.is_stale
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.bodies.groups.fit(given.device, given.instances.ok_or_else(without_instances)?)
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.bodies.groups.refit(given.device)
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        let (device, motion) = (given.device, motion(given)?);
        let tables = given.instances.ok_or_else(without_instances)?.tables();
        let (counters, bodies) = (candidates.counters, &mut self.bodies);
        let pairs = bodies.pairs_of_bodies(given, counters)?;
        let relations = bodies.relations.output(counters);
        let args = MovingRelationsArgs {
            tables,
            ends: motion.ends(),
            motions: motion.motions(),
            pairs,
            relations,
            left_out: given.filters.left_out,
            counters,
            within: 2.0 * f64::from(self.margin),
            steps: (!self.is_at_rest).into(),
            pad: 0,
        };
        launch::striding::<entry::traverse_moving_relations>(device, bodies.body_pairs.capacity(), &args)?;
        let room = bodies.relations.capacity();
        bodies.descent.run(given, (Output::EMPTY, counters), room, |of| {
            striding::<entry::traverse_moving_nodes>(device, &MovingNodesArgs { of: *of, relations })
        })?;
        let tile_pairs = bodies.descent.tile_pairs.output(counters);
        let pairs = candidates.pairs;
        let of = InstancesArgs { tables, relations: Output::EMPTY, tile_pairs, pairs, counters };
        striding::<entry::traverse_moving_instances>(device, &MovingInstancesArgs { of, relations })?;
        let (relations, tile_pairs) = (bodies.relations.entries(), bodies.descent.tile_pairs.entries());
        let args = motion.vertices_args(tables, (relations, tile_pairs, pairs), self.is_at_rest);
        launch::striding::<entry::traverse_vertices>(device, pairs.room() as usize, &args)
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.bodies.all_lists()
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.bodies.count(counters);
        Ok(())
    }

    fn depths(&self) -> Vec<usize> {
        self.bodies.groups.depths()
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.bodies.prints()
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.bodies.check_boxes(layout, faces, frames)
    }
}
