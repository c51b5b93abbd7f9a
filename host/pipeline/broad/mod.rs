//! Broad phase: from positions to candidate pairs of triangles. Each broad phase is a strategy with
//! its own memory; after the narrow phase all give the same answer.

mod checked;
mod instances;
mod prefix;
mod sorted;
mod tiles;
pub mod trees;

use super::counts::Counts;
use super::instances::Instances;
use super::layout::Layout;
use super::list::GrowableOutput;
use super::precision::Precision;
use crate::device::Device;
use crate::error::Error;
use crate::query::{BroadPhase, Query, WithVolume};
use nearmiss_kernels::abi::{
    BodyRecord, Counters, FilterArgs, Growth, InstanceTables, NodePair, Output, Pair, Positions, Relation,
    RelationWords, Span, TraverseFlags,
};
use nearmiss_kernels::bvh::Violation;
use nearmiss_kernels::entry::Kernels;
use nearmiss_kernels::math::round;
use tiles::Tiles;
use trees::Trees;

pub use checked::Checked;

/// Inputs of a broad phase: the device and the spans on it.
#[derive(Clone, Copy)]
pub struct BroadContext<'a, R: Precision> {
    /// The device.
    pub device: &'a Device,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Records of the bodies for the kernels; empty if there is only one body.
    pub records: Span<BodyRecord>,
    /// Filters of the bodies, without nodes: groups and pairs that are left out.
    pub filters: FilterArgs,
    /// Whether launches may be recorded, and run later or never: the host must not rely on them.
    pub is_submitted: bool,
    /// Meshes and poses, if a query reads bodies as instances.
    pub instances: Option<&'a Instances>,
}

impl<R: Precision> BroadContext<'_, R> {
    /// Returns the same for fixed bodies: none turns, and their volumes are fitted once.
    fn of_fixed(&self) -> Self {
        BroadContext { frames: Positions { turns: Span::EMPTY, ..self.frames }, ..*self }
    }
}

/// Candidates of instances, as the narrow phase reads them.
#[derive(Clone, Copy)]
pub struct Placeable {
    /// Meshes and bodies.
    pub tables: InstanceTables,
    /// Pairs of bodies whose meshes may meet.
    pub relations: Span<Relation>,
    /// Pairs of tiles.
    pub tile_pairs: Span<NodePair>,
    /// Words of each relation; empty except for queries of pairs of bodies.
    pub words: RelationWords,
    /// Candidates that are left of bodies that share a point, and their pairs of tiles: for distances.
    pub left: (Span<Pair>, Span<NodePair>),
}

/// A range of the moving tiles, in units of 1/2^32 of their number. A pair belongs to the share
/// that has its first tile. Adjacent shares have no gap and no overlap, for any number of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Start of the range.
    pub from: u64,
    /// End of the range, exclusive.
    pub to: u64,
}

impl Share {
    /// The number of units in the whole range.
    pub const ALL: u64 = 1 << 32;
    /// All tiles.
    pub const WHOLE: Share = Share { from: 0, to: Share::ALL };

    /// Returns slice `k` of `slices` equal ones.
    pub fn slice(&self, k: u32, slices: u32) -> Share {
        let at = |k: u32| self.from + (self.to - self.from) * u64::from(k) / u64::from(slices);
        Share { from: at(k), to: at(k + 1) }
    }

    /// Returns the range of this share among `tiles` tiles.
    pub fn of(&self, tiles: u32) -> std::ops::Range<u32> {
        let [from, to] = [self.from, self.to].map(|part| (u64::from(tiles) * part / Share::ALL) as u32);
        from..to
    }
}

/// Outputs and options of a traversal.
#[derive(Clone, Copy)]
pub struct Candidates {
    /// Out: candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// The frame's counters, all zero before.
    pub counters: Counters,
    /// Options of every pair's test.
    pub flags: TraverseFlags,
    /// Which candidates are listed.
    pub which: Which,
    /// The range of tiles to traverse.
    pub share: Share,
}

/// Selection of candidates.
#[derive(Clone, Copy, Debug)]
pub enum Which {
    /// All.
    All,
    /// Those of a sample, the same for the same input.
    Sample,
    /// At least those that meet before a time, given as its bits on the device. NaN sets
    /// no limit.
    Before(Span<u64>),
}

/// A broad phase of a scene: moving bodies against each other and against fixed ones.
pub trait CandidateSearch<R: Precision>: Send {
    /// Builds the structure from the positions at t = 0. The fixed part is built only the first
    /// time. Volumes are not fitted yet.
    ///
    /// # Errors
    /// Device errors.
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error>;

    /// Reads back what the host must know of the structure just built; waits for it.
    ///
    /// # Errors
    /// [`Error::Bug`] for an impossible value; device errors.
    fn learn(&mut self) -> Result<(), Error>;

    /// Sets the growth: from the next fit on, volumes hold everything within `growth` of the
    /// triangles. Returns whether the structure must be built again: true for fixed trees that
    /// were built with a smaller growth.
    fn set_growth(&mut self, growth: Growth) -> bool;

    /// Sets the numbers of another query of the same shape.
    fn set(&mut self, _query: &Query) {}

    /// Fits the volumes of the triangles.
    ///
    /// # Errors
    /// Device errors.
    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error>;

    /// Refits all other volumes.
    ///
    /// # Errors
    /// Device errors.
    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error>;

    /// Lists the pairs of triangles whose volumes overlap.
    ///
    /// # Errors
    /// Device errors.
    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error>;

    /// Returns its own lists. One that turns out too short grows, and
    /// [`CandidateSearch::traverse`] runs again.
    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput>;

    /// Returns what candidates of instances refer to; `None` if candidates are triangles of the
    /// scene.
    fn placeable(&self) -> Option<Placeable> {
        None
    }

    /// Returns whether it can list a sample, and leave out pairs that only meet later.
    fn can_sample(&self) -> bool {
        false
    }

    /// Prepares for shares smaller than the whole.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if this broad phase cannot be divided; device errors.
    fn divide(&mut self, _device: &Device) -> Result<(), Error> {
        Err(Error::InvalidArgument {
            what: "broad phase `tree` cannot be divided among several devices".into(),
            advice: "use the broad phase `tiles`, or one device".into(),
        })
    }

    /// Returns the cost of each tile of its last share, if it was divided.
    ///
    /// # Errors
    /// Device errors.
    fn work(&self) -> Result<Vec<u64>, Error> {
        Ok(Vec::new())
    }

    /// Returns how many tiles outside its last share met tiles of the share.
    ///
    /// # Errors
    /// Device errors.
    fn met_beyond(&self) -> Result<u64, Error> {
        Ok(0)
    }

    /// Ends an answered frame: results may be kept for the next one.
    ///
    /// # Errors
    /// Device errors.
    fn finish(&mut self, _counters: &Counts) -> Result<(), Error> {
        Ok(())
    }

    /// Returns whether the next frame can run without the host, else the reason.
    ///
    /// # Errors
    /// The reason why it needs the host.
    fn without_host(&self) -> Result<(), &'static str> {
        Ok(())
    }

    /// Returns whether the last finished frame dropped its front, or had none though the query uses
    /// one.
    fn front_dropped(&self) -> bool {
        false
    }

    /// Returns the milliseconds that the last traversal spent on balancing; waits for it.
    ///
    /// # Errors
    /// Device errors.
    fn balance_ms(&self) -> Result<f64, Error> {
        Ok(0.0)
    }

    /// Returns the number of levels of the moving part and, if there is one, of the fixed part.
    fn depths(&self) -> Vec<usize>;

    /// Returns a hash of each stage's memory after the last frame.
    ///
    /// # Errors
    /// Device errors.
    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error>;

    /// Checks the structure, and every volume against the positions at t = 0 and, if anything
    /// moves, at t = 1.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error>;
}

/// Returns the broad phase of a query over the bodies of a layout. At least one body moves. Its
/// volumes hold everything within `growth` of the triangles.
///
/// # Errors
/// Device errors.
pub fn broad_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
    query: &Query,
    growth: Growth,
) -> Result<Box<dyn CandidateSearch<R>>, Error> {
    query.volume().with(New { device, layout, query, growth, precision: std::marker::PhantomData })
}

/// Returns the broad phase of a discrete query over bodies as instances. At least one body moves.
///
/// # Errors
/// Device errors.
pub fn instance_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
) -> Result<Box<dyn CandidateSearch<R>>, Error> {
    Ok(Box::new(<instances::BodyGroups>::new(device, layout, instances::MEETING)?))
}

/// Returns the broad phase of a query of features over bodies as instances, at rest or in motion. At
/// least one body moves. Boxes of bodies grow by `margin`.
///
/// # Errors
/// Device errors.
pub fn motion_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
    is_at_rest: bool,
    margin: f32,
) -> Result<Box<dyn CandidateSearch<R>>, Error> {
    Ok(Box::new(instances::MotionSearch::new(device, layout, instances::MEETING, (is_at_rest, margin))?))
}

/// Returns the broad phase of a query, but of pairs of bodies, over rigid bodies as instances and
/// others that deform. At least one deforms. Volumes and boxes of bodies grow by `growth`.
///
/// # Errors
/// Device errors.
pub fn mixed_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
    (query, bodies): (&Query, &[usize]),
    growth: Growth,
) -> Result<Box<dyn CandidateSearch<R>>, Error> {
    let new = NewMixed { device, layout, query, bodies, growth, precision: std::marker::PhantomData };
    query.volume().with(new)
}

/// Arguments for the constructors of mixed ones.
struct NewMixed<'a, R> {
    device: &'a Device,
    layout: &'a Layout,
    query: &'a Query,
    bodies: &'a [usize],
    growth: Growth,
    precision: std::marker::PhantomData<R>,
}

impl<R: Precision> WithVolume for NewMixed<'_, R> {
    type Out = Result<Box<dyn CandidateSearch<R>>, Error>;

    fn with<V: Kernels>(self) -> Self::Out {
        let NewMixed { device, layout, query, bodies, growth, .. } = self;
        let is_at_rest = query.kind().is_at_rest();
        Ok(Box::new(instances::MixedSearch::<V>::new(device, (layout, bodies), is_at_rest, growth)?))
    }
}

/// Returns the broad phase of a query of pairs of bodies. At least one body moves. Boxes of bodies
/// grow by `margin`.
///
/// # Errors
/// Device errors.
pub fn pair_phase<R: Precision>(
    device: &Device,
    layout: &Layout,
    query: &Query,
    margin: f32,
) -> Result<Box<dyn CandidateSearch<R>>, Error> {
    Ok(Box::new(instances::PairSearch::new(device, layout, query, margin)?))
}

/// Arguments for the constructors of broad phases.
struct New<'a, R> {
    device: &'a Device,
    layout: &'a Layout,
    query: &'a Query,
    growth: Growth,
    precision: std::marker::PhantomData<R>,
}

impl<R: Precision> WithVolume for New<'_, R> {
    type Out = Result<Box<dyn CandidateSearch<R>>, Error>;

    fn with<V: Kernels>(self) -> Self::Out {
        let New { device, layout, query, growth, .. } = self;
        Ok(match query.broad_phase_on(device.is_gpu()) {
            BroadPhase::Tree => Box::new(Trees::<R, V>::new(device, layout, query, growth)?),
            BroadPhase::Tiles => Box::new(Tiles::<V>::new(device, layout, growth)?),
        })
    }
}

/// Returns the growth of each volume that makes volumes of listed pairs overlap: half of the list's
/// distance, rounded up.
pub fn growth(distance: f64) -> f32 {
    let half = round::up(0.5 * distance);
    if 2.0 * f64::from(half) < distance { half.next_up() } else { half }
}

/// Returns a checker's violation as an error.
fn broken(violation: Violation) -> Error {
    Error::Bug { what: format!("the broad phase is broken: {violation:?}") }
}
