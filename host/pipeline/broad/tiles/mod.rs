//! Tiles: groups of 32 triangles that are neighbours along a curve, and link-free nodes above them;
//! see `nearmiss_kernels::bvh::tiles`.

mod check;
#[cfg(test)]
mod faults;
mod fixed_growth;
mod rims;

use super::sorted::{Sorted, SortedFor};
use super::{BroadContext, CandidateSearch, Candidates, Which};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::broad::Checked;
use crate::pipeline::counts::Counts;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use fixed_growth::FixedGrowth;
use nearmiss_kernels::abi::{
    FilterArgs, FitTilesArgs, Growth, NONE, Node, NodeFilter, Pair, RefitTilesArgs, Span, TileFiltersArgs,
    TilePairsArgs, TileTrianglesArgs, TreeBody, counter,
};
use nearmiss_kernels::bvh::tiles::{self, Levels, Part, TILE};
use nearmiss_kernels::entry::{self, Entry, Kernels};
use nearmiss_kernels::stage::traverse::tile_triangles::turns;
use std::collections::BTreeSet;
use xxhash_rust::xxh3::xxh3_64;

/// Initial capacity, in pairs of tiles per tile. Cloth at rest has 12. A list that is too short
/// grows within the frame.
const PAIRS_A_TILE: usize = 32;
/// A sample has one of so many tiles, with all tiles that it meets.
const SAMPLE: u32 = 64;
/// Least number of tiles for which a sample saves more than it costs. On a GPU its cost is
/// launches: with 1,000 tiles it slows an H200 down.
const SAMPLED: u32 = 2048;
/// The two parts of the memory: moving and fixed.
const MOVING: usize = 0;
const FIXED: usize = 1;

/// The order of fixed triangles: bodies and triangles.
struct StaticOrder {
    bodies: Vec<TreeBody>,
    triangles: Buffer<u64>,
}

/// Tiles over the bodies of a layout.
pub struct Tiles<V> {
    levels: Levels,
    /// Number of moving and of fixed triangles.
    triangles: [u32; 2],
    /// The order of moving triangles.
    sorted: Sorted,
    /// Fixed triangles in order, once their tiles exist.
    fixed: Option<StaticOrder>,
    fixed_growth: FixedGrowth,
    leaves: Buffer<Node<V>>,
    nodes: Buffer<Node<V>>,
    /// Filters of the triangles below each node; empty if no filter applies.
    filters: Buffer<NodeFilter>,
    /// Filter of each triangle; empty in the same case.
    whose: Buffer<NodeFilter>,
    /// The hub of every triangle and the rim of every node; both empty if no pair is left out by
    /// them.
    hubs: Buffer<u32>,
    rims: Buffer<Node<V>>,
    tile_pairs: List<Pair>,
    /// Cost of each tile, if work is divided.
    work: Option<Buffer<u64>>,
    /// End of the last share's tiles, and how many pairs of tiles it listed.
    listed: (u32, u64),
    growth: Growth,
}

impl<V: Kernels> Tiles<V> {
    /// Allocates tiles over the bodies of a layout. At least one body moves. Volumes hold
    /// everything within `growth` of the triangles.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, growth: Growth) -> Result<Self, Error> {
        let triangles =
            layout.trees.each_ref().map(|bodies| bodies.iter().map(|&body| layout.triangles(body).1).sum());
        let levels = Levels::of(triangles);
        let count = levels.first(levels.count) as usize;
        let volumes = device.of(purpose::TILES);
        let mut leaves = volumes.buffer(levels.leaves() as usize)?;
        // Memory between the parts is never written. Only a comparison of all memory reads it.
        leaves.clear()?;
        let nothing = Node { volume: V::zeroed(), link: NONE, last: 0 };
        let whose: Vec<NodeFilter> = if layout.has_filters() { layout.whose().collect() } else { Vec::new() };
        let filters = device.of(purpose::FILTERS);
        let mut of_nodes = filters.buffer(if whose.is_empty() { 0 } else { count })?;
        of_nodes.clear()?;
        let mut rims = device.of(purpose::RIMS).buffer(if layout.rims.is_empty() { 0 } else { count })?;
        // Fixed tiles have no rims.
        rims.clear()?;
        let room = PAIRS_A_TILE * triangles[MOVING].div_ceil(TILE) as usize;
        Ok(Tiles {
            sorted: Sorted::new(device, layout, &layout.trees[MOVING], SortedFor::Tiles)?,
            listed: (0, 0),
            fixed: None,
            fixed_growth: FixedGrowth::default(),
            leaves,
            nodes: volumes.upload(&vec![nothing; count])?,
            filters: of_nodes,
            whose: filters.upload(&whose)?,
            hubs: device.of(purpose::RIMS).upload(&layout.rims)?,
            rims,
            tile_pairs: List::new(device, "pairs of tiles", counter::TILE_PAIRS, room)?,
            work: None,
            levels,
            triangles,
            growth,
        })
    }

    /// Returns a part's nodes of a level, and those one level below. Below tiles there are none:
    /// they start at [`NONE`].
    fn own_and_below(&self, level: u32, part: usize) -> [Part; 2] {
        let of = |level| self.levels.part(level, part, self.triangles[part]);
        [of(level), level.checked_sub(1).map_or(Part { first: NONE, count: 0 }, of)]
    }

    /// Writes the filter below each node of a part, once its triangles are in order.
    fn filter(&self, device: &Device, part: usize, triangles: Span<u64>) -> Result<(), Error> {
        if self.filters.is_empty() {
            return Ok(());
        }
        for level in 0..self.levels.count {
            let [own, below] = self.own_and_below(level, part);
            let args = TileFiltersArgs {
                triangles,
                whose: self.whose.span(),
                filters: self.filters.span(),
                first: own.first,
                count: own.count,
                below: below.first,
                below_count: below.count,
            };
            launch::each::<entry::construct_tile_filters>(device, own.count as usize, &args)?;
        }
        Ok(())
    }

    /// Fits the volumes of a part's triangles, of its tiles, and of the nodes above these.
    fn fit<R: Precision>(
        &self,
        given: &BroadContext<R>,
        part: usize,
        triangles: Span<u64>,
        growth: Growth,
    ) -> Result<(), Error> {
        let above = self.levels.part(1, part, self.triangles[part]);
        let args = FitTilesArgs {
            frames: given.frames,
            faces: given.faces,
            triangles,
            leaves: self.leaves.span(),
            nodes: self.nodes.span(),
            tile: self.levels.part(0, part, self.triangles[part]).first,
            above: above.first,
            growth,
        };
        launch::blocks::<entry::fit_tiles<R, V>>(given.device, above.count, &args)
    }

    /// Fits fixed tiles, unless they are already fitted with a suitable growth.
    fn fit_static<R: Precision>(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        let fixed = self.fixed.as_ref().map(|fixed| fixed.triangles.span());
        let Some(triangles) = fixed.filter(|_| self.fixed_growth.take(self.growth, !given.is_submitted))
        else {
            return Ok(());
        };
        let given = &given.of_fixed();
        Tiles::fit(self, given, FIXED, triangles, self.fixed_growth.fitted())?;
        Tiles::refit(self, given.device, FIXED)
    }

    /// Refits a part's nodes from the third level on.
    fn refit(&self, device: &Device, part: usize) -> Result<(), Error> {
        refit_nodes(device, &self.levels, (part, self.triangles[part]), self.nodes.span())
    }

    /// Returns the number of moving tiles.
    fn tiles(&self) -> u32 {
        self.levels.part(0, MOVING, self.triangles[MOVING]).count
    }

    /// Returns the filters of the pairs; `of_bodies` has no nodes.
    fn filters(&self, of_bodies: FilterArgs) -> FilterArgs {
        FilterArgs { nodes: self.filters.span(), ..of_bodies }
    }
}

/// Refits a part's nodes from the third level on; the part has so many items.
///
/// # Errors
/// Device errors.
pub(super) fn refit_nodes<V: Kernels>(
    device: &Device,
    levels: &Levels,
    (part, items): (usize, u32),
    nodes: Span<Node<V>>,
) -> Result<(), Error> {
    for level in 2..levels.count {
        let of = |level| levels.part(level, part, items);
        let (own, below) = (of(level), of(level - 1));
        let args = RefitTilesArgs {
            nodes,
            first: own.first,
            count: own.count,
            below: below.first,
            below_count: below.count,
            tile: of(0).first,
            tiles: tiles::below(level),
        };
        launch::each::<entry::refit_tiles<V>>(device, own.count as usize * tiles::FAN as usize, &args)?;
    }
    Ok(())
}

/// Lists pairs of tiles, then their pairs of triangles.
pub(super) fn walk<V, Pairs, Triangles>(
    device: &Device,
    (pairs, triangles): (&TilePairsArgs<V>, &TileTrianglesArgs<V>),
) -> Result<(), Error>
where
    V: Kernels,
    Pairs: Entry<Args = TilePairsArgs<V>>,
    Triangles: Entry<Args = TileTrianglesArgs<V>>,
{
    // A GPU has a block for each moving tile; the few blocks of a CPU stride over them.
    let seeking = (pairs.to - pairs.from).div_ceil(pairs.every);
    let few = || device.blocks_striding::<Pairs>((seeking * TILE) as usize);
    let blocks = if device.is_gpu() { seeking } else { few() };
    launch::blocks::<Pairs>(device, blocks, pairs)?;
    let resident = device.blocks_at_once::<Triangles>(u32::MAX as usize)?;
    launch::blocks::<Triangles>(device, resident * turns::<V>(), triangles)
}

impl<R: Precision, V: Kernels> CandidateSearch<R> for Tiles<V> {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        let BroadContext { device, frames, faces, .. } = *given;
        self.sorted.construct(device, frames, faces)?;
        self.filter(device, MOVING, self.sorted.triangles())?;
        if self.fixed.is_none() && self.triangles[FIXED] > 0 {
            let mut sorted = Sorted::new(device, layout, &layout.trees[FIXED], SortedFor::Tiles)?;
            sorted.construct(device, frames, faces)?;
            self.filter(device, FIXED, sorted.triangles())?;
            let (bodies, triangles) = sorted.into_order();
            self.fixed = Some(StaticOrder { bodies, triangles });
            self.fit_static(given)?;
        }
        Ok(())
    }

    fn set_growth(&mut self, growth: Growth) -> bool {
        self.growth = growth;
        false
    }

    fn learn(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.fit_static(given)?;
        Tiles::fit(self, given, MOVING, self.sorted.triangles(), self.growth)?;
        self.fit_rims(given)
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        Tiles::refit(self, given.device, MOVING)
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        let Candidates { pairs, counters, flags, which, share } = *candidates;
        let (every, known) = match which {
            Which::All => (1, Span::EMPTY),
            Which::Sample => (SAMPLE, Span::EMPTY),
            Which::Before(time) => (1, time),
        };
        let (device, filters) = (given.device, self.filters(given.filters));
        let own = share.of(self.tiles());
        if let Some(work) = &mut self.work {
            work.clear()?;
        }
        self.listed = (own.end, 0);
        let tile_pairs = self.tile_pairs.output(counters);
        let args = TilePairsArgs {
            nodes: self.nodes.span(),
            filters,
            rims: self.rims.span(),
            tile_pairs,
            counters,
            top: self.levels.first(self.levels.count - 1),
            tops: self.levels.tops.iter().sum(),
            shift: self.levels.shift(),
            from: own.start,
            to: own.end,
            every,
            known,
        };
        let of_tiles = TileTrianglesArgs {
            leaves: self.leaves.span(),
            nodes: self.nodes.span(),
            faces: given.faces,
            filters,
            whose: self.whose.span(),
            tile_pairs,
            pairs,
            counters,
            from: own.start,
            to: own.end,
            flags,
            every,
            known,
            work: self.work.as_ref().map_or(Span::EMPTY, Buffer::span),
        };
        if known.is_empty() {
            walk::<V, entry::traverse_tiles<V>, entry::traverse_triangles<V>>(device, (&args, &of_tiles))
        } else {
            walk::<V, entry::traverse_tiles_before<V>, entry::traverse_triangles_before<V>>(
                device,
                (&args, &of_tiles),
            )
        }
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        vec![&mut self.tile_pairs]
    }

    fn can_sample(&self) -> bool {
        self.tiles() >= SAMPLED
    }

    fn divide(&mut self, device: &Device) -> Result<(), Error> {
        if self.work.is_none() {
            let tiles = self.tiles() as usize;
            self.work = Some(device.of(purpose::SHARES).buffer(tiles)?);
        }
        Ok(())
    }

    fn work(&self) -> Result<Vec<u64>, Error> {
        self.work.as_ref().map_or(Ok(Vec::new()), |work| work.read(work.len()))
    }

    fn met_beyond(&self) -> Result<u64, Error> {
        let (end, count) = self.listed;
        // The first tile of a pair is the earlier one, and in the share. Fixed tiles come last and
        // belong to every share.
        let beyond = end..self.tiles();
        let pairs = self.tile_pairs.first(count)?;
        let met: BTreeSet<u32> =
            pairs.iter().map(|pair| pair.b).filter(|tile| beyond.contains(tile)).collect();
        Ok(met.len() as u64)
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.listed.1 = self.tile_pairs.demand(counters);
        Ok(())
    }

    fn depths(&self) -> Vec<usize> {
        // The triangles are a level, too.
        let parts = self.triangles.iter().filter(|&&triangles| triangles > 0);
        parts.map(|_| self.levels.count as usize + 1).collect()
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let order = self.sorted.download()?;
        let leaves = self.leaves.read(self.leaves.len())?;
        let nodes = self.nodes.read(self.nodes.len())?;
        Ok(vec![
            ("construct", xxh3_64(bytemuck::cast_slice(&order))),
            ("fit", xxh3_64(bytemuck::cast_slice(&leaves))),
            ("refit", xxh3_64(bytemuck::cast_slice(&nodes))),
        ])
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.check_tiles(layout, faces, frames)
    }
}
