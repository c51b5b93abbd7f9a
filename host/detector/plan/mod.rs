//! Plan of a frame: its launches, memory and transfers, and the parts left out, by the device's
//! counts.

mod left_out;
mod words;

use super::Detector;
use crate::device::{Count, Work};
use crate::error::Error;
use crate::query::Query;
use crate::scene::{Body, BodyKind};
pub use left_out::LeftOut;
use nearmiss_kernels::entry::TABLE;
use std::collections::BTreeMap;

/// Work of a detector for a frame: [`Detector::plan`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Plan {
    /// Counts of bodies.
    pub bodies: Bodies,
    /// Launches of the last build of the trees: once, until bodies are added or removed, or
    /// [`Detector::rebuild`].
    pub build: Vec<PlannedStage>,
    /// Launches of the frame, stage by stage.
    pub frame: Vec<PlannedStage>,
    /// Device memory, by purpose.
    pub buffers: Vec<Buffer>,
    /// Copies of the frame to the device and back.
    pub transfers: Vec<Transfer>,
    /// Memory that the frame set to zero.
    pub clears: Count,
    /// Parts that were left out, and why.
    pub left_out: Vec<LeftOut>,
}

/// Number of bodies of each kind, and of their triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Bodies {
    /// Fixed bodies, and their triangles.
    pub fixed: [usize; 2],
    /// Rigid bodies, and their triangles.
    pub rigid: [usize; 2],
    /// Deformable bodies, and their triangles.
    pub deformable: [usize; 2],
    /// Vertices of all bodies.
    pub vertices: usize,
}

/// A stage, and its launches.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PlannedStage {
    /// Its name: `place`, `construct`, `fit`, `refit`, `traverse`, `balance`, `narrow`, `order`.
    pub stage: &'static str,
    /// Its purpose.
    pub what: &'static str,
    /// Launches of all of its kernels.
    pub launches: u64,
    /// The kernels.
    pub kernels: Vec<PlannedKernel>,
}

/// A kernel, and its launches.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PlannedKernel {
    /// Its name: that of the PTX entry, and of a profiler's row.
    pub kernel: &'static str,
    /// Its purpose.
    pub what: &'static str,
    /// Number of launches.
    pub launches: u64,
}

/// Device memory of one purpose.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Buffer {
    /// Its purpose.
    pub what: &'static str,
    /// Number of allocations, and the bytes of all.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub held: Count,
}

/// Copies between the host and device memory in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Transfer {
    /// Purpose of the memory.
    pub what: &'static str,
    /// Copies from the host.
    pub to_device: Count,
    /// Copies to the host; on a CPU also memory that the host reads in place.
    pub to_host: Count,
}

impl Plan {
    fn new(bodies: &[Body], (build, frame): (&Work, &Work), held: BTreeMap<&'static str, Count>) -> Plan {
        let vertices = bodies.iter().map(Body::vertex_count).sum();
        let mut counts = Bodies { vertices, ..Bodies::default() };
        for body in bodies.iter().filter(|body| body.element_count() > 0) {
            let own = match body.kind() {
                BodyKind::Fixed => &mut counts.fixed,
                BodyKind::Rigid => &mut counts.rigid,
                BodyKind::Deformable => &mut counts.deformable,
            };
            own[0] += 1;
            own[1] += body.element_count();
        }
        let mut transfers: BTreeMap<&'static str, [Count; 2]> = BTreeMap::new();
        for (way, all) in [&frame.writes, &frame.reads].into_iter().enumerate() {
            all.iter().for_each(|(what, count)| transfers.entry(what).or_default()[way] = *count);
        }
        let clears = frame.clears.values().fold(Count::default(), |all, own| Count {
            count: all.count + own.count,
            bytes: all.bytes + own.bytes,
        });
        let transfer = |(what, [to_device, to_host]): (_, [Count; 2])| Transfer { what, to_device, to_host };
        Plan {
            bodies: counts,
            build: stages(build, true),
            frame: stages(frame, false),
            buffers: held.into_iter().map(|(what, held)| Buffer { what, held }).collect(),
            transfers: transfers.into_iter().map(transfer).collect(),
            clears,
            left_out: Vec::new(),
        }
    }

    /// Launches of the frame.
    pub fn launches(&self) -> u64 {
        self.frame.iter().map(|stage| stage.launches).sum()
    }

    /// Bytes of device memory.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.held.bytes).sum()
    }

    /// Bytes that the frame copied to the device.
    pub fn bytes_to_device(&self) -> u64 {
        self.transfers.iter().map(|transfer| transfer.to_device.bytes).sum()
    }

    /// Bytes that the frame brought to the host.
    pub fn bytes_to_host(&self) -> u64 {
        self.transfers.iter().map(|transfer| transfer.to_host.bytes).sum()
    }

    /// Returns the stage of that name in the frame, if it has launches.
    pub fn stage(&self, name: &str) -> Option<&PlannedStage> {
        self.frame.iter().find(|stage| stage.stage == name)
    }

    /// Returns the memory of that purpose, if there is any.
    pub fn buffer(&self, what: &str) -> Option<&Buffer> {
        self.buffers.iter().find(|buffer| buffer.what == what)
    }
}

/// Launches by stage.
fn stages(work: &Work, building: bool) -> Vec<PlannedStage> {
    let mut all: BTreeMap<usize, PlannedStage> = BTreeMap::new();
    let mut launched: Vec<_> = work.launches.iter().collect();
    // In the order of the data flow.
    launched.sort_by_key(|(kernel, _)| TABLE.iter().position(|(name, _)| name == *kernel));
    for (&kernel, &launches) in launched {
        let (stage, what) = words::of(kernel, building);
        let (name, purpose) = words::STAGES[stage];
        let empty = || PlannedStage { stage: name, what: purpose, launches: 0, kernels: Vec::new() };
        let own = all.entry(stage).or_insert_with(empty);
        own.launches += launches;
        own.kernels.push(PlannedKernel { kernel, what, launches });
    }
    all.into_values().collect()
}

impl Detector {
    /// Returns the launches, memory and transfers of a query's frame, as the device counted them in
    /// the last one. If the last two frames were not of this query, they run now, at the current
    /// positions. The first of them finds the lengths of lists, and waits step by step. Uploads and
    /// placing of [`Detector::step`] are included if that was the last call. Memory is that of all
    /// queries so far.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Mesh, Query, device::Backend, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 2.0, 1.0], [9.0, 1.0, 9.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let device = Device::open(Backend::Cpu, None)?;
    /// let mut detector = Detector::new(device.clone(), Body::deformable(mesh))?;
    /// let plan = detector.plan(&Query::discrete())?;
    /// assert_eq!(plan.bytes(), device.bytes().0);
    /// assert!(plan.stage("traverse").is_some() && plan.stage("place").is_none());
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Detector::query`].
    pub fn plan(&mut self, query: &Query) -> Result<Plan, Error> {
        let of_answer = self.query_of_answer(query);
        let query = &self.ended(of_answer)?;
        let question = self.question(*query)?;
        let begun = self.begun(&question).map(|at| at.is_some());
        if self.ended(begun)? {
            while !self.engine.has_run_twice(&question.query) {
                self.query(query)?;
            }
        }
        let layout = self.layout(query)?;
        let mut plan = Plan::new(
            self.scene.bodies(),
            (&self.engine.build_work, &self.engine.frame_work),
            self.device.held(),
        );
        plan.left_out = left_out::of(&plan, &layout, query, self.device.is_gpu());
        Ok(plan)
    }
}
