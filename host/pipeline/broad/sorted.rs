//! Triangles in the order of a curve through space, body by body: the input of trees and tiles.

use super::prefix::{self, Weight};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::sorter::{counted, sort, words};
use crate::pipeline::{launch, purpose};
use nearmiss_kernels::abi::{BodyRecord, CutArgs, MortonArgs, MortonFlags, Positions, Span, TreeBody};
use nearmiss_kernels::bvh::CODE_BITS;
use nearmiss_kernels::bvh::centres::OF_A_BODY;
use nearmiss_kernels::math::ordered;
use nearmiss_kernels::stage::construct::{cuts, morton};

/// Bit offsets of the code's bytes; the code is above the triangle in the word. Their number is
/// even: the sort ends in the buffer where it began.
const BYTES: [u32; 4] = [32, 40, 48, 56];
const _: () = assert!(8 * BYTES.len() as u32 == CODE_BITS && BYTES.len().is_multiple_of(2));

/// Purpose of a sort.
#[derive(Clone, Copy, PartialEq)]
pub enum SortedFor {
    /// Tiles: along Hilbert's curve, and each run of 16 tiles in halves of halves, cut across the
    /// longest axis.
    Tiles,
    /// A tree: along Morton's curve.
    Tree {
        /// Words of the caller that are zero after every sort.
        extra: usize,
    },
}

/// Triangles of some bodies, and the memory to sort them again: 16 bytes a triangle.
pub struct Sorted {
    /// The bodies, in the order of their triangles, with their records.
    bodies: Vec<TreeBody>,
    records: Vec<BodyRecord>,
    table: Buffer<TreeBody>,
    count: u32,
    is_for_tiles: bool,
    /// Words that are zero before a sort: bounds of each body, counts of each byte of the codes,
    /// and the caller's words.
    begins_zero: Buffer<u64>,
    extra: u64,
    items: [Buffer<u64>; 2],
}

impl Sorted {
    /// Allocates memory for the triangles of these bodies. Bodies ascend, and each has at least one
    /// triangle.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        layout: &Layout,
        bodies: &[usize],
        purpose: SortedFor,
    ) -> Result<Self, Error> {
        let extra = match purpose {
            SortedFor::Tiles => 0,
            SortedFor::Tree { extra } => extra,
        };
        let mut count = 0;
        let table = bodies.iter().map(|&body| {
            let (triangle, triangles) = layout.triangles(body);
            count += triangles;
            TreeBody { triangle, before: count - triangles, ..TreeBody::default() }
        });
        let table: Vec<TreeBody> = table.collect();
        let scratch = device.of(purpose::SCRATCH);
        let counts = BYTES.len() * words(device, count);
        let zero = OF_A_BODY as usize * table.len() + counts + extra;
        let items = || scratch.buffer(count as usize);
        Ok(Sorted {
            records: bodies.iter().map(|&body| layout.records[body]).collect(),
            table: scratch.upload(&table)?,
            bodies: table,
            count,
            is_for_tiles: purpose == SortedFor::Tiles,
            begins_zero: scratch.buffer(zero)?,
            extra: extra as u64,
            items: [items()?, items()?],
        })
    }

    /// Sorts the triangles by their positions at t = 0. All work is on the device, except the order
    /// of the bodies: with more than one, it waits for their boxes. Cost: seven launches, four of
    /// them a radix sort; one more for tiles, whose runs are cut.
    ///
    /// # Errors
    /// Device errors.
    pub fn construct<R: Precision>(
        &mut self,
        device: &Device,
        frames: Positions<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        self.begins_zero.clear()?;
        let zeroed = self.begins_zero.span();
        let extents = OF_A_BODY as usize * self.bodies.len();
        let counts = zeroed.part(extents as u64, (BYTES.len() * words(device, self.count)) as u64);
        let of_tiles = MortonFlags::HILBERT | MortonFlags::APART;
        let morton = MortonArgs {
            frames,
            faces,
            bodies: self.table.span(),
            extents: zeroed.part(0, extents as u64),
            items: self.items[0].span(),
            tiles: counted(device, counts, self.count, 0),
            count: self.count,
            flags: of_tiles.when(self.is_for_tiles),
        };
        let lanes = (self.count as usize).div_ceil(morton::TOGETHER as usize);
        launch::striding::<R::Bounds>(device, lanes, &morton)?;
        if self.bodies.len() > 1 {
            let weights = weights(&self.begins_zero.read(extents)?, &self.bodies, self.count);
            prefix::prefixes(&mut self.bodies, &weights, &self.records);
            self.table.write(&self.bodies)?;
        }
        launch::striding::<R::Morton>(device, self.count as usize, &morton)?;
        sort(device, self.items.each_ref(), (self.count, Span::EMPTY), counts, &BYTES)?;
        self.cut(device, &morton)
    }

    /// Cuts the sorted triangles into runs.
    fn cut<R: Precision>(&self, device: &Device, morton: &MortonArgs<R>) -> Result<(), Error> {
        if !self.is_for_tiles {
            return Ok(());
        }
        let args = CutArgs {
            frames: morton.frames,
            faces: morton.faces,
            bodies: morton.bodies,
            extents: morton.extents,
            items: self.items[0].span(),
            out: self.items[1].span(),
            count: self.count,
            pad: 0,
        };
        let runs = self.count.div_ceil(cuts::RUN);
        launch::blocks::<R::Runs>(device, runs, &args)
    }

    /// Returns the list of the sorted triangles. Cuts leave them in the second one.
    fn in_order(&self) -> &Buffer<u64> {
        &self.items[usize::from(self.is_for_tiles)]
    }

    /// Returns the triangles in order: the lower halves of the words.
    pub fn triangles(&self) -> Span<u64> {
        self.in_order().span()
    }

    /// Returns the same words with their last sort keys in the upper halves.
    ///
    /// # Errors
    /// Device errors.
    pub fn download(&self) -> Result<Vec<u64>, Error> {
        self.in_order().read(self.count as usize)
    }

    /// Returns the bodies and their triangles in order, without the memory to sort again. Cost:
    /// none; one of two lists is freed.
    pub fn into_order(self) -> (Vec<TreeBody>, Buffer<u64>) {
        let is_for_tiles = self.is_for_tiles;
        let [curve, runs] = self.items;
        (self.bodies, if is_for_tiles { runs } else { curve })
    }

    /// Returns the caller's zeroed words.
    pub fn zeroed(&self) -> Span<u64> {
        let all = self.begins_zero.span();
        all.part(all.len() - self.extra, self.extra)
    }

    /// Returns the bodies, in the order of their triangles.
    pub fn bodies(&self) -> &[TreeBody] {
        &self.bodies
    }
}

/// Returns a triangle's place among the `count` triangles of a tree's bodies; `None` if its body is
/// not in the tree.
pub fn place(bodies: &[TreeBody], count: u32, triangle: u32) -> Option<usize> {
    let at = bodies.partition_point(|body| body.triangle <= triangle).checked_sub(1)?;
    let end = bodies.get(at + 1).map_or(count, |next| next.before);
    let place = triangle - bodies[at].triangle + bodies[at].before;
    (place < end).then_some(place as usize)
}

/// Returns each body's box, decoded from its keys, and its number of triangles.
fn weights(keys: &[u64], bodies: &[TreeBody], count: u32) -> Vec<Weight> {
    let ends = bodies.iter().skip(1).map(|next| next.before).chain([count]);
    let boxes = keys.chunks_exact(OF_A_BODY as usize).map(|keys| {
        let upper = [0, 1, 2].map(|k| ordered::number(keys[k]));
        [[0, 1, 2].map(|k| ordered::number(!keys[k + 3])), upper]
    });
    let weight =
        |((body, end), bounds): ((&TreeBody, u32), _)| Weight { bounds, triangles: end - body.before };
    bodies.iter().zip(ends).zip(boxes).map(weight).collect()
}
