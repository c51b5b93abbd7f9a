//! Broad phase: from where vertices are to candidate pairs of triangles. Each is a strategy with its own memory; after the narrow phase
//! all give one answer.

mod prefix;
mod sorted;
mod tiles;
pub mod trees;

use super::counts::Counts;
use super::layout::Layout;
use super::list::GrowableOutput;
use super::precision::Precision;
use crate::device::Device;
use crate::error::Error;
use crate::query::{Broad, Order, Query, WithVolume};
use nearmiss_kernels::abi::{BodyRecord, Counters, Output, Pair, Positions, Span, TraverseFlags};
use nearmiss_kernels::bv::Axes;
use nearmiss_kernels::bvh::Violation;
use nearmiss_kernels::entry::Kernels;
use nearmiss_kernels::math::{Vec3, round};
use tiles::Tiles;
use trees::Trees;

/// What a broad phase is given: the machine, and where what lies there.
#[derive(Clone, Copy)]
pub struct BroadContext<'a, R: Precision> {
    /// The machine.
    pub device: &'a Device,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// What the kernels know of the bodies; empty where there is one alone.
    pub records: Span<BodyRecord>,
    /// Whether launches may be recorded and run later, or never: then the host must not rely on them.
    pub is_submitted: bool,
}

/// A part of the tiles of what moves, in parts of 2^32 of their number: whose first tile it is, finds a pair. Shares that touch leave
/// nothing out and have nothing twice, whatever that number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Where it begins.
    pub from: u64,
    /// Where it ends.
    pub to: u64,
}

impl Share {
    /// The unit.
    pub const ALL: u64 = 1 << 32;
    /// All tiles.
    pub const WHOLE: Share = Share { from: 0, to: Share::ALL };

    /// Slice `k` of so many.
    pub fn slice(&self, k: u32, slices: u32) -> Share {
        let at = |k: u32| self.from + (self.to - self.from) * u64::from(k) / u64::from(slices);
        Share { from: at(k), to: at(k + 1) }
    }

    /// The tiles of so many that are its.
    pub fn of(&self, tiles: u32) -> std::ops::Range<u32> {
        let [from, to] = [self.from, self.to].map(|part| (u64::from(tiles) * part / Share::ALL) as u32);
        from..to
    }
}

/// Where candidates go.
#[derive(Clone, Copy)]
pub struct Candidates {
    /// Out: candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// The frame's counters, all zero before.
    pub counters: Counters,
    /// What is asked of them all.
    pub flags: TraverseFlags,
    /// Which are asked for.
    pub which: Which,
    /// Whose: of what part of the tiles.
    pub share: Share,
}

/// Which candidates are asked for.
#[derive(Clone, Copy, Debug)]
pub enum Which {
    /// All.
    All,
    /// Those of a sample, the same whenever the same is asked.
    Sample,
    /// At least those that meet before a time, which lies there as bits: those of no number for none.
    Before(Span<u64>),
}

/// A broad phase of a scene, of what moves with itself and with what is static.
pub trait BroadPhase<R: Precision>: Send {
    /// Makes it anew, from the positions at t = 0; of what is static once, the first time. Volumes are not fitted yet.
    ///
    /// # Errors
    /// Those of the device.
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error>;

    /// Reads what the host must know of what was just made; waits for it.
    ///
    /// # Errors
    /// [`Error::Bug`] for what cannot be; those of the device.
    fn learn(&mut self) -> Result<(), Error>;

    /// From the next fit on, volumes hold everything within `margin` of the triangles. Whether it must be constructed again for
    /// that: true of static trees that were built with a smaller one.
    fn set_margin(&mut self, margin: f32) -> bool;

    /// Fits the volumes of the triangles.
    ///
    /// # Errors
    /// Those of the device.
    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error>;

    /// Refits all other volumes.
    ///
    /// # Errors
    /// Those of the device.
    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error>;

    /// Lists the pairs of triangles whose volumes overlap.
    ///
    /// # Errors
    /// Those of the device.
    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error>;

    /// Its own lists, which may turn out too short: then they grow and [`BroadPhase::traverse`] runs again.
    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput>;

    /// Whether it can list a sample, and leave out what only meets later.
    fn can_sample(&self) -> bool {
        false
    }

    /// Prepares for a share that is not the whole.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where work cannot be divided; those of the device.
    fn divide(&mut self, _device: &Device) -> Result<(), Error> {
        Err(Error::InvalidArgument {
            what: "a tree that several devices go down".into(),
            advice: "find candidates by tiles, or ask one device".into(),
        })
    }

    /// What each tile of its last share cost, where it was divided.
    ///
    /// # Errors
    /// Those of the device.
    fn work(&self) -> Result<Vec<u64>, Error> {
        Ok(Vec::new())
    }

    /// How many tiles beyond its last share those of the share have met.
    ///
    /// # Errors
    /// Those of the device.
    fn met_beyond(&self) -> Result<u64, Error> {
        Ok(0)
    }

    /// The frame is answered: what was learnt may be kept for the next one.
    ///
    /// # Errors
    /// Those of the device.
    fn finish(&mut self, _counters: &Counts) -> Result<(), Error> {
        Ok(())
    }

    /// Whether the next frame does without the host: else why not.
    ///
    /// # Errors
    /// What it needs the host for.
    fn without_host(&self) -> Result<(), &'static str> {
        Ok(())
    }

    /// Whether the last frame, once finished, had no front though one was asked for, or dropped it.
    fn front_dropped(&self) -> bool {
        false
    }

    /// Milliseconds that the last traversal spent on balancing; waits for it.
    ///
    /// # Errors
    /// Those of the device.
    fn balance_ms(&self) -> Result<f64, Error> {
        Ok(0.0)
    }

    /// Levels of what moves and, where there is something, of what is static.
    fn depths(&self) -> Vec<usize>;

    /// A hash of what each stage left in memory after the last frame.
    ///
    /// # Errors
    /// Those of the device.
    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error>;

    /// Checks how it is made, and every volume against the positions, at t = 0 and, when anything moves, at t = 1.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &[Vec<Vec3<R>>]) -> Result<(), Error>;
}

/// The broad phase that a query asks for, over the bodies of a layout, of which some move; its volumes hold everything within
/// `margin` of the triangles.
///
/// # Errors
/// Those of the device.
pub fn broad_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
    query: &Query,
    margin: f32,
) -> Result<Box<dyn BroadPhase<R>>, Error> {
    query.bv().with(New { device, layout, query, margin, precision: std::marker::PhantomData })
}

/// What a broad phase is made of.
struct New<'a, R> {
    device: &'a Device,
    layout: &'a Layout,
    query: &'a Query,
    margin: f32,
    precision: std::marker::PhantomData<R>,
}

impl<R: Precision> WithVolume for New<'_, R> {
    type Out = Result<Box<dyn BroadPhase<R>>, Error>;

    fn with<V: Kernels>(self, axes: Axes) -> Self::Out {
        let New { device, layout, query, margin, .. } = self;
        Ok(match query.broad_on(device.is_gpu()) {
            Broad::Tree => Box::new(Trees::<R, V>::new(device, layout, query, (axes, margin))?),
            Broad::Tiles => {
                let order = query.search().order.unwrap_or(Order::DEFAULT);
                Box::new(Tiles::<V>::new(device, layout, (order, axes, margin))?)
            }
        })
    }
}

/// How much each of two volumes grows so that what is listed makes them meet: half of the distance within which it comes,
/// rounded up.
pub fn growth(distance: f64) -> f32 {
    let half = round::up(0.5 * distance);
    if 2.0 * f64::from(half) < distance { half.next_up() } else { half }
}

/// The volume around a triangle at t = 0 and, when there are two frames, at t = 1.
fn leaf_volume<R: Precision, V: Kernels>(face: [u32; 3], frames: &[Vec<Vec3<R>>]) -> V {
    let corners = |frame: &Vec<Vec3<R>>| face.map(|v| frame[v as usize]);
    match frames {
        [t0, t1] => V::moving(corners(t0), corners(t1)),
        _ => V::still(corners(&frames[0])),
    }
}

/// What a checker found, as an error.
fn broken(violation: Violation) -> Error {
    Error::Bug { what: format!("the broad phase is broken: {violation:?}") }
}
