//! Instances: candidates of rigid and fixed bodies by the tiles of their meshes, which never change.
//!
//! Bodies take the place of triangles in the search of [`super::tiles`]: groups of 32 along a curve,
//! and nodes above them. Pairs of bodies then go down both meshes, a launch a level.

mod bodies;
mod descent;
mod groups;
mod mixed;
mod motion;

pub use bodies::PairSearch;
pub use descent::MEETING;
pub use mixed::MixedSearch;
pub use motion::MotionSearch;

use super::tiles::walk;
use super::{BroadContext, CandidateSearch, Candidates, Placeable, broken};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::Checked;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use bytemuck::{Pod, Zeroable};
use descent::Descent;
use groups::Groups;
use nearmiss_kernels::abi::{
    Counters, Growth, InstanceTables, NodePair, Output, Pair, Relation, RelationWords, RelationsArgs, Span,
    TilePairsArgs, TileTrianglesArgs, TraverseFlags, counter,
};
use nearmiss_kernels::bv::{Contain, FrameBox};
use nearmiss_kernels::bvh::Violation;
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::math::Vec3;
use xxhash_rust::xxh3::xxh3_64;

/// Initial capacities: pairs of groups a group, pairs of bodies a body, pairs of tiles a body. Lists
/// that are too short grow within the frame.
const GROUP_PAIRS_A_GROUP: usize = 16;
const PAIRS_A_BODY: usize = 8;
const TILE_PAIRS_A_BODY: usize = 32;
/// Least room of every list.
const LEAST_ROOM: usize = 1 << 10;
/// How often a GPU is filled with blocks of a warp, which end at different times.
const TURNS: u32 = 3;
/// Bodies are put in order again when pairs of groups exceed the first ones by a quarter, and by so
/// many. A cost; no answer depends on it.
const STALE: u64 = 64;

/// Bodies in groups, and the lists down to candidates.
pub struct BodyGroups<Q: Pod = Relation> {
    groups: Groups,
    group_pairs: List<Pair>,
    body_pairs: List<Pair>,
    relations: List<Q>,
    descent: Descent,
    /// Meshes and bodies of the last traversal.
    tables: Option<InstanceTables>,
    /// Pairs of groups of the first frame in this order, and whether later ones exceed them.
    first: Option<u64>,
    is_stale: bool,
}

impl<Q: Pod> BodyGroups<Q> {
    /// Allocates groups over the bodies of a layout, with these counters of nodes and tiles. At least
    /// one body moves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, counted: descent::Counted) -> Result<Self, Error> {
        let groups = Groups::new(device, layout)?;
        let bodies = layout.trees.iter().map(Vec::len).sum::<usize>();
        let room = |each: usize| LEAST_ROOM.max(each * bodies);
        let own = LEAST_ROOM.max(GROUP_PAIRS_A_GROUP * groups.moving() as usize);
        Ok(BodyGroups {
            group_pairs: List::new(device, "pairs of groups of bodies", counter::GROUP_PAIRS, own)?,
            body_pairs: List::new(device, "pairs of bodies", counter::BODY_PAIRS, room(PAIRS_A_BODY))?,
            relations: List::new(device, "related bodies", counter::RELATIONS, room(PAIRS_A_BODY))?,
            descent: Descent::new(device, counted, room(TILE_PAIRS_A_BODY))?,
            tables: None,
            first: None,
            is_stale: false,
            groups,
        })
    }

    /// Lists pairs of bodies whose boxes overlap.
    fn pairs_of_bodies<R: Precision>(
        &self,
        given: &BroadContext<R>,
        counters: Counters,
    ) -> Result<Output<Pair>, Error> {
        let groups = &self.groups;
        let (filters, to) = (groups.filters(given.filters), groups.moving());
        let tile_pairs = self.group_pairs.output(counters);
        let pairs = self.body_pairs.output(counters);
        let (top, tops, shift) = groups.top();
        let of_groups = TilePairsArgs::<FrameBox> {
            nodes: groups.nodes(),
            filters,
            rims: Span::EMPTY,
            tile_pairs,
            counters,
            top,
            tops,
            shift,
            from: 0,
            to,
            every: 1,
            known: Span::EMPTY,
        };
        let of_bodies = TileTrianglesArgs::<FrameBox> {
            leaves: groups.leaves(),
            nodes: groups.nodes(),
            faces: Span::EMPTY,
            filters,
            whose: groups.whose(),
            tile_pairs,
            pairs,
            counters,
            from: 0,
            to,
            flags: TraverseFlags::KEEP_ADJACENT,
            every: 1,
            known: Span::EMPTY,
            work: Span::EMPTY,
        };
        walk::<FrameBox, entry::traverse_tiles<FrameBox>, entry::traverse_triangles<FrameBox>>(
            given.device,
            (&of_groups, &of_bodies),
        )?;
        Ok(pairs)
    }

    fn all_lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let mut all: Vec<&mut dyn GrowableOutput> =
            vec![&mut self.group_pairs, &mut self.body_pairs, &mut self.relations];
        all.extend(self.descent.lists());
        all
    }

    /// Notes whether the order of bodies is stale, by a frame's counters.
    fn count(&mut self, counters: &Counts) {
        let pairs = self.group_pairs.demand(counters);
        let first = *self.first.get_or_insert(pairs);
        self.is_stale = pairs > first + first / 4 + STALE;
    }

    /// Puts bodies in order.
    fn put_in_order<R: Precision>(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        let instances = given.instances.ok_or_else(without_instances)?;
        (self.first, self.is_stale) = (None, false);
        self.groups.construct(given.device, layout, instances)
    }

    fn prints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let (order, leaves, nodes) = self.groups.download()?;
        Ok(vec![
            ("construct", xxh3_64(bytemuck::cast_slice(&order))),
            ("fit", xxh3_64(bytemuck::cast_slice(&leaves))),
            ("refit", xxh3_64(bytemuck::cast_slice(&nodes))),
        ])
    }

    /// Checks that each body has one place, and that its box and those above hold its placed
    /// vertices at all ends. Checks of meshes are tests of `pipeline::instances`.
    fn check_boxes<R: Precision>(
        &self,
        layout: &Layout,
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        let mut seen = vec![false; layout.bodies()];
        for (leaf, body, volumes) in self.groups.volumes()? {
            let is_known = seen.get_mut(body).is_some_and(|seen| !std::mem::replace(seen, true));
            if !is_known {
                return Err(broken(Violation::Leaf { leaf }));
            }
            let (first, count) = layout.triangles(body);
            let own = faces.iter().skip(first as usize).take(count as usize).flatten();
            let points: Vec<Vec3<f64>> =
                own.flat_map(|&v| frames.iter().map(move |end| end[v as usize].wide())).collect();
            let outside = |volume: &FrameBox| points.iter().any(|&point| !volume.holds(point, point));
            if let Some(level) = volumes.iter().position(outside) {
                return Err(broken(Violation::Outside { leaf, level: level as u32 }));
            }
        }
        match (0..seen.len()).find(|&body| layout.triangles(body).1 > 0 && !seen[body]) {
            Some(body) => Err(broken(Violation::Leaf { leaf: body as u32 })),
            None => Ok(()),
        }
    }
}

impl BodyGroups {
    /// Lists pairs of bodies whose boxes overlap, and returns arguments to relate them.
    fn relations_args<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        counters: Counters,
    ) -> Result<RelationsArgs, Error> {
        let tables = given.instances.ok_or_else(without_instances)?.tables();
        self.tables = Some(tables);
        let pairs = self.pairs_of_bodies(given, counters)?;
        let (relations, left_out) = (self.relations.output(counters), given.filters.left_out);
        Ok(RelationsArgs { tables, pairs, relations, left_out, counters })
    }

    /// Returns what candidates refer to: those of a descent, with these words and what was left.
    fn place(
        &self,
        of: &Descent,
        words: RelationWords,
        left: (Span<Pair>, Span<NodePair>),
    ) -> Option<Placeable> {
        let (relations, tile_pairs) = (self.relations.entries(), of.tile_pairs.entries());
        self.tables.map(|tables| Placeable { tables, relations, tile_pairs, words, left })
    }
}

/// Launches blocks of a warp that stride: many on a GPU, for they end at different times.
fn striding<E: Entry>(device: &Device, args: &E::Args) -> Result<(), Error> {
    let resident = device.blocks_at_once::<E>(u32::MAX as usize)?;
    launch::blocks::<E>(device, resident * if device.is_gpu() { TURNS } else { 1 }, args)
}

/// Error for a context without instances: a fault of the pipeline.
fn without_instances() -> Error {
    Error::Bug { what: "a query reads instances, and there are none".into() }
}

impl<R: Precision> CandidateSearch<R> for BodyGroups {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        self.put_in_order(given, layout)
    }

    fn learn(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// Volumes of meshes have no margin. A stale order of bodies is built again.
    fn set_growth(&mut self, _growth: Growth) -> bool {
        self.is_stale
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.groups.fit(given.device, given.instances.ok_or_else(without_instances)?)
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.groups.refit(given.device)
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        let device = given.device;
        let args = self.relations_args(given, candidates.counters)?;
        launch::striding::<entry::traverse_relations>(device, self.body_pairs.capacity(), &args)?;
        let room = self.relations.capacity();
        let of = (args.relations, args.counters);
        self.descent.run(given, of, room, |args| striding::<entry::traverse_nodes>(device, args))?;
        striding::<entry::traverse_instances>(device, &self.descent.triangles(&args, candidates.pairs))
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.all_lists()
    }

    fn placeable(&self) -> Option<Placeable> {
        self.place(&self.descent, RelationWords::zeroed(), (Span::EMPTY, Span::EMPTY))
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.count(counters);
        Ok(())
    }

    fn depths(&self) -> Vec<usize> {
        self.groups.depths()
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.prints()
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.check_boxes(layout, faces, frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};
    use crate::pipeline::instances::Instances;
    use crate::query::Query;
    use crate::samples::soup;
    use crate::scene::{Body, Motion, Pose};
    use nearmiss_kernels::abi::{FilterArgs, Positions};

    /// Returns the checker's verdict on the boxes of 80 bodies, some fixed, after a fault.
    fn checked(fault: impl Fn(&mut BodyGroups)) -> Result<(), Error> {
        let device = Device::emulator(Emulator::new(Mode::Engine, None)?);
        let mesh = |at: u64| soup(20, at % 3, false).frames().swap_remove(0);
        let body = |at: u64| match at % 4 {
            0 => Ok(Body::fixed(mesh(at))),
            _ => Body::rigid(mesh(at)).at(Motion::Pose(Pose::at([at as f64, 1e6, 0.3]))),
        };
        let bodies = (0..80).map(body).collect::<Result<Vec<_>, _>>()?;
        let layout = Layout::new(&bodies, Query::discrete().kind());
        let instances = Instances::new(&device, (&bodies, &[]), &layout, &[])?;
        let given = BroadContext::<f64> {
            device: &device,
            frames: Positions { still: Span::EMPTY, moving: Span::EMPTY, turns: Span::EMPTY },
            faces: Span::EMPTY,
            records: Span::EMPTY,
            filters: FilterArgs::NONE,
            is_submitted: false,
            instances: Some(&instances),
        };
        let mut groups = BodyGroups::new(&device, &layout, MEETING)?;
        groups.construct(&given, &layout)?;
        CandidateSearch::<f64>::fit(&mut groups, &given)?;
        CandidateSearch::<f64>::refit(&mut groups, &given)?;
        fault(&mut groups);
        let positions = Checked::new(vec![instances.positions(&layout, 0)?], Vec::new());
        CandidateSearch::<f64>::check(&groups, &layout, &layout.faces, &positions)
    }

    #[test]
    fn a_box_that_holds_too_little_is_named() {
        checked(|_| ()).expect("boxes hold their bodies");
        let error = checked(|groups| groups.groups.shrink_first()).expect_err("a fault").to_string();
        assert!(error.contains("Outside"), "{error}");
    }
}
