//! Down the meshes of related bodies: from roots to pairs of tiles, a launch a level.

use super::without_instances;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::BroadContext;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{
    Counter, Counters, InstancesArgs, MESH_LEVELS, NodePair, NodesArgs, Output, Pair, Relation,
    RelationsArgs, counter,
};

/// The counters of a descent: pairs of nodes after each level, and pairs of tiles.
pub type Counted = ([Counter; MESH_LEVELS as usize], Counter);
/// Those of pairs that may meet.
pub const MEETING: Counted = (counter::NODE_PAIRS, counter::TILE_PAIRS);
/// Those of pairs that may hold the least distance of their bodies.
pub const CLOSE: Counted = (counter::CLOSE_NODES, counter::CLOSE_TILES);

/// The lists of a descent.
pub struct Descent {
    counted: Counted,
    /// Pairs of nodes after each level but the last.
    node_pairs: Vec<List<NodePair>>,
    pub tile_pairs: List<NodePair>,
}

impl Descent {
    /// Allocates lists, with room for so many pairs of tiles.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, counted: Counted, room: usize) -> Result<Self, Error> {
        let tile_pairs = List::new(device, "pairs of tiles", counted.1, room)?;
        Ok(Descent { counted, node_pairs: Vec::new(), tile_pairs })
    }

    /// Goes down the meshes of related bodies to pairs of tiles: `launch` a level, with these relations.
    /// New lists have this room.
    ///
    /// # Errors
    /// Device errors.
    pub fn run<R: Precision>(
        &mut self,
        given: &BroadContext<R>,
        (relations, counters): (Output<Relation>, Counters),
        room: usize,
        launch: impl Fn(&NodesArgs) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let instances = given.instances.ok_or_else(without_instances)?;
        let (tables, boxes, levels) = (instances.tables(), instances.boxes(), instances.levels.max(1));
        let tile_pairs = self.tile_pairs.output(counters);
        debug_assert!(levels <= MESH_LEVELS);
        let mut pairs = Output::EMPTY;
        for level in 0..levels {
            // After the last level all are pairs of tiles.
            let is_last = level + 1 == levels;
            let next = if is_last {
                Output::EMPTY
            } else {
                self.after_level(given.device, level as usize, room)?.output(counters)
            };
            launch(&NodesArgs { tables, relations, pairs, next, tile_pairs, boxes, counters })?;
            pairs = next;
        }
        Ok(())
    }

    /// Returns the pairs of nodes after a level, made with this room if there are none.
    fn after_level(&mut self, device: &Device, level: usize, room: usize) -> Result<&List<NodePair>, Error> {
        while self.node_pairs.len() <= level {
            let which = self.counted.0[self.node_pairs.len()];
            self.node_pairs.push(List::new(device, "pairs of nodes", which, room)?);
        }
        Ok(&self.node_pairs[level])
    }

    /// Returns arguments for the triangles of pairs of tiles, which list candidates.
    pub fn triangles(&self, of: &RelationsArgs, pairs: Output<Pair>) -> InstancesArgs {
        let RelationsArgs { tables, relations, counters, .. } = *of;
        InstancesArgs { tables, relations, tile_pairs: self.tile_pairs.output(counters), pairs, counters }
    }

    /// Returns its lists.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        let nodes = self.node_pairs.iter_mut().map(|list| list as &mut dyn GrowableOutput);
        nodes.chain([&mut self.tile_pairs as &mut dyn GrowableOutput])
    }
}
