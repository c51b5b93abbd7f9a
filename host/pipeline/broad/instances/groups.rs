//! Groups of 32 bodies along a curve, and nodes above them.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::broad::prefix::along;
use crate::pipeline::broad::tiles::refit_nodes;
use crate::pipeline::instances::Instances;
use crate::pipeline::layout::Layout;
use crate::pipeline::{launch, purpose};
use nearmiss_kernels::abi::{
    BodiesArgs, BodyRecord, FilterArgs, NONE, Node, NodeFilter, Span, TileFiltersArgs,
};
use nearmiss_kernels::bv::FrameBox;
use nearmiss_kernels::bvh::tiles::{self, Levels, Part, TILE};
use nearmiss_kernels::entry;

/// Boxes of fixed bodies that have grown more than so many times what a query needs are fitted again.
/// A cost; no answer depends on it.
const LOOSE: f32 = 16.0;
/// The two parts of the memory: moving and fixed bodies.
const MOVING: usize = 0;
const FIXED: usize = 1;

/// A body's leaf, its number, and the volumes around it: its own, its group's, and those above.
pub type BodyVolumes = (u32, usize, Vec<FrameBox>);

/// Bodies in order, their boxes, and the boxes of groups.
pub struct Groups {
    levels: Levels,
    /// Number of moving and of fixed bodies.
    bodies: [u32; 2],
    order: [Buffer<u64>; 2],
    leaves: Buffer<Node<FrameBox>>,
    nodes: Buffer<Node<FrameBox>>,
    /// Filters of the bodies below each node, and of each body of the scene.
    filters: Buffer<NodeFilter>,
    whose: Buffer<NodeFilter>,
    has_fixed: bool,
    /// Growth of each box of a part. Length.
    margins: [f32; 2],
    /// Poses of a body whose boxes are around a step, or around the one at rest; `None` without a
    /// motion.
    poses: Option<u32>,
}

impl Groups {
    /// Allocates groups over the bodies with triangles.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout) -> Result<Self, Error> {
        let bodies = layout.trees.each_ref().map(|bodies| bodies.len() as u32);
        let levels = Levels::of(bodies);
        let count = levels.first(levels.count) as usize;
        let boxes = device.of(purpose::BODY_BOXES);
        let mut leaves = boxes.buffer(levels.leaves() as usize)?;
        // Memory between the parts is never written. Only a comparison of all memory reads it.
        leaves.clear()?;
        let nothing = Node { volume: FrameBox::default(), link: NONE, last: 0 };
        let filter = |(body, record): (usize, &BodyRecord)| NodeFilter::leaf(body as u32, record, 0);
        let whose: Vec<NodeFilter> = layout.records.iter().enumerate().map(filter).collect();
        let of_filters = device.of(purpose::FILTERS);
        let mut filters = of_filters.buffer(count)?;
        filters.clear()?;
        Ok(Groups {
            levels,
            bodies,
            order: [boxes.buffer(bodies[MOVING] as usize)?, boxes.buffer(bodies[FIXED] as usize)?],
            leaves,
            nodes: boxes.upload(&vec![nothing; count])?,
            filters,
            whose: of_filters.upload(&whose)?,
            has_fixed: false,
            margins: [0.0; 2],
            poses: None,
        })
    }

    /// Makes boxes go around a step, or around this many poses of it.
    pub fn read_poses(&mut self, poses: u32) {
        self.poses = Some(poses);
    }

    /// Sets the growth of each box. Returns whether boxes of fixed bodies must be fitted again.
    pub fn set_margin(&mut self, margin: f32) -> bool {
        self.margins[MOVING] = margin;
        // Fixed boxes keep a larger growth, so that queries with several limits take turns.
        let held = self.margins[FIXED];
        let is_other = margin > held || margin < held / LOOSE;
        if is_other {
            (self.margins[FIXED], self.has_fixed) = (margin, false);
        }
        is_other && self.bodies[FIXED] > 0
    }

    /// Puts bodies in order: environments, then along a curve through the centres. Fixed bodies are
    /// put in order and fitted the first time.
    ///
    /// # Errors
    /// Device errors.
    pub fn construct(
        &mut self,
        device: &Device,
        layout: &Layout,
        instances: &Instances,
    ) -> Result<(), Error> {
        self.put_in_order(device, layout, instances, MOVING)?;
        if self.bodies[FIXED] > 0 && !self.has_fixed {
            self.put_in_order(device, layout, instances, FIXED)?;
            self.fit_part(device, instances, FIXED)?;
            self.refit_part(device, FIXED)?;
            self.has_fixed = true;
        }
        Ok(())
    }

    fn put_in_order(
        &mut self,
        device: &Device,
        layout: &Layout,
        instances: &Instances,
        part: usize,
    ) -> Result<(), Error> {
        let own = &layout.trees[part];
        let all = instances.centres()?;
        let centres: Vec<[f64; 3]> = own.iter().map(|&body| all[body]).collect();
        let order = along(&centres, |i| layout.records[own[i]].environment);
        let items: Vec<u64> = order.into_iter().map(|i| own[i] as u64).collect();
        self.order[part].write(&items)?;
        for level in 0..self.levels.count {
            let of = |level| self.levels.part(level, part, self.bodies[part]);
            let below = level.checked_sub(1).map_or(Part { first: NONE, count: 0 }, of);
            let args = TileFiltersArgs {
                triangles: self.order[part].span(),
                whose: self.whose.span(),
                filters: self.filters.span(),
                first: of(level).first,
                count: of(level).count,
                below: below.first,
                below_count: below.count,
            };
            launch::each::<entry::construct_tile_filters>(device, args.count as usize, &args)?;
        }
        Ok(())
    }

    /// Places moving bodies, and fits their groups.
    ///
    /// # Errors
    /// Device errors.
    pub fn fit(&self, device: &Device, instances: &Instances) -> Result<(), Error> {
        self.fit_part(device, instances, MOVING)
    }

    fn fit_part(&self, device: &Device, instances: &Instances, part: usize) -> Result<(), Error> {
        let above = self.levels.part(1, part, self.bodies[part]);
        let args = BodiesArgs {
            tables: instances.tables(),
            poses: instances.poses(),
            order: self.order[part].span(),
            leaves: self.leaves.span(),
            nodes: self.nodes.span(),
            tile: self.levels.part(0, part, self.bodies[part]).first,
            above: above.first,
            margin: self.margins[part],
            pad: 0,
        };
        match self.poses.zip(instances.motion()) {
            Some((poses, motion)) => {
                launch::blocks::<entry::fit_moving_bodies>(device, above.count, &motion.fit_args(args, poses))
            }
            None => launch::blocks::<entry::fit_bodies>(device, above.count, &args),
        }
    }

    /// Refits the nodes above groups of moving bodies, from the third level on.
    ///
    /// # Errors
    /// Device errors.
    pub fn refit(&self, device: &Device) -> Result<(), Error> {
        self.refit_part(device, MOVING)
    }

    fn refit_part(&self, device: &Device, part: usize) -> Result<(), Error> {
        refit_nodes(device, &self.levels, (part, self.bodies[part]), self.nodes.span())
    }

    /// Returns the number of groups of moving bodies.
    pub fn moving(&self) -> u32 {
        self.levels.part(0, MOVING, self.bodies[MOVING]).count
    }

    /// Returns the first node of the top level, how many it has, and the shift from a group to its
    /// node there.
    pub fn top(&self) -> (u32, u32, u32) {
        (self.levels.first(self.levels.count - 1), self.levels.tops.iter().sum(), self.levels.shift())
    }

    /// Returns the boxes of bodies, in order.
    pub fn leaves(&self) -> Span<Node<FrameBox>> {
        self.leaves.span()
    }

    /// Returns the boxes of groups, and of the nodes above.
    pub fn nodes(&self) -> Span<Node<FrameBox>> {
        self.nodes.span()
    }

    /// Returns the filter of each body of the scene.
    pub fn whose(&self) -> Span<NodeFilter> {
        self.whose.span()
    }

    /// Returns the filters of pairs; `of_bodies` has no nodes.
    pub fn filters(&self, of_bodies: FilterArgs) -> FilterArgs {
        FilterArgs { nodes: self.filters.span(), ..of_bodies }
    }

    /// Returns the number of levels of moving and, if there are any, of fixed bodies.
    pub fn depths(&self) -> Vec<usize> {
        // The bodies are a level, too.
        let parts = self.bodies.iter().filter(|&&bodies| bodies > 0);
        parts.map(|_| self.levels.count as usize + 1).collect()
    }

    /// Returns the order of moving bodies, boxes of bodies, and boxes of groups.
    ///
    /// # Errors
    /// Device errors.
    #[allow(clippy::type_complexity, reason = "three lists as they are in memory")]
    pub fn download(&self) -> Result<(Vec<u64>, Vec<Node<FrameBox>>, Vec<Node<FrameBox>>), Error> {
        let order = self.order[MOVING].read(self.order[MOVING].len())?;
        Ok((order, self.leaves.read(self.leaves.len())?, self.nodes.read(self.nodes.len())?))
    }

    /// Returns the volumes of each body, by leaves.
    ///
    /// # Errors
    /// Device errors.
    pub fn volumes(&self) -> Result<Vec<BodyVolumes>, Error> {
        let (_, leaves, nodes) = self.download()?;
        let mut all = Vec::new();
        for (part, &count) in self.bodies.iter().enumerate() {
            for i in 0..count {
                let leaf = self.levels.part(0, part, count).first * TILE + i;
                let node = &leaves[leaf as usize];
                let above = (0..self.levels.count).map(|level| {
                    let first = self.levels.part(level, part, count).first;
                    nodes[(first + i / (TILE * tiles::below(level))) as usize].volume
                });
                let volumes = std::iter::once(node.volume).chain(above).collect();
                all.push((leaf, node.triangle() as usize, volumes));
            }
        }
        Ok(all)
    }

    /// Changes the box of the first body: a planted fault.
    #[cfg(test)]
    pub fn shrink_first(&mut self) {
        let mut leaves = self.leaves.read(1).expect("read");
        leaves[0].volume.hi = leaves[0].volume.lo;
        self.leaves.write(&leaves).expect("written");
    }
}
