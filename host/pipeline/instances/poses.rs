//! Poses of instances on the device, from the host and from the caller's memory.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::mesh::MAX_ABS_F64;
use crate::pipeline::placing::{DeviceArrays, write};
use crate::pipeline::{launch, purpose};
use crate::scene::{Body, BodyKind, Pose};
use nearmiss_kernels::abi::{
    InstanceTables, LENT_POSES, POSED, PlacePosesArgs, PoseRecord, PoseSource, RESTING, Span,
};
use nearmiss_kernels::entry::place_poses;

/// Two poses for each body: at the start and at the end of the step.
pub struct Poses {
    poses: Buffer<PoseRecord>,
    /// The same on the host, of bodies whose poses it has.
    held: Vec<PoseRecord>,
    /// Whether only the device has the poses of each body.
    there: Vec<bool>,
    /// Whether these have two ends.
    moves: Vec<bool>,
    /// Poses in the caller's memory.
    arrays: DeviceArrays,
    uploaded: Buffer<PoseRecord>,
    /// Bodies that the host places, and that rest; bodies from the caller's memory.
    sources: [Buffer<PoseSource>; 2],
    /// The values of the latter.
    lent: Vec<PoseSource>,
    /// The last launch for the caller's memory: it can run again.
    last: Option<PlacePosesArgs>,
}

/// Whether only the device has a body's poses.
fn is_there(body: &Body) -> bool {
    body.kind() == BodyKind::Rigid && body.is_device_resident()
}

/// Both poses of a body; one that is no rigid one is where its mesh is, exactly.
fn poses(body: &Body) -> [PoseRecord; 2] {
    let is_rigid = body.kind() == BodyKind::Rigid;
    if is_rigid { body.poses().map(|pose| pose.record()) } else { [Pose::default().record(); 2] }
}

impl Poses {
    /// Allocates poses of bodies. `found` has two for each whose poses only the device has, as they
    /// were in the caller's memory; it is empty if there is no such body.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, bodies: &[Body], found: &[Pose]) -> Result<Self, Error> {
        let (of_bodies, of_arrays) = (device.of(purpose::POSES), device.of(purpose::DEVICE_ARRAYS));
        let held = bodies.iter().enumerate().flat_map(|(at, body)| {
            let found = found.get(2 * at..2 * at + 2).filter(|_| is_there(body));
            found.map_or_else(|| poses(body), |found| [0, 1].map(|end| found[end].record()))
        });
        let held: Vec<PoseRecord> = held.collect();
        let mut own = Poses {
            poses: of_bodies.upload(&held)?,
            there: bodies.iter().map(is_there).collect(),
            moves: bodies.iter().map(|body| is_there(body) && body.is_moving()).collect(),
            arrays: DeviceArrays::new(&of_arrays)?,
            uploaded: of_bodies.buffer(0)?,
            sources: [of_bodies.buffer(0)?, of_bodies.buffer(0)?],
            lent: Vec::new(),
            last: None,
            held,
        };
        if !found.is_empty() {
            own.arrays.reserve(&of_arrays, 2 * bodies.len())?;
            let raw = |pose: &Pose| PoseRecord { rotation: pose.rotation, ..pose.record() };
            own.arrays.found.write(&found.iter().map(raw).collect::<Vec<_>>())?;
        }
        Ok(own)
    }

    /// Places all bodies. Uploads poses of the host, all of them if it has all, else those that have
    /// changed. Reads the caller's memory by a launch, which can run [again](Poses::again).
    /// `vertices` has the first vertex of each body.
    ///
    /// # Errors
    /// Device errors.
    pub fn put(
        &mut self,
        device: &Device,
        (bodies, tables): (&[Body], InstanceTables),
        vertices: impl Fn(usize) -> u32,
    ) -> Result<(), Error> {
        (self.last, self.arrays.any) = (None, false);
        if !bodies.iter().any(is_there) {
            self.held.clear();
            self.held.extend(bodies.iter().flat_map(poses));
            self.there.fill(false);
            return self.poses.write(&self.held);
        }
        let (mut first, mut uploads, mut lent, mut places) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (at, body) in bodies.iter().enumerate() {
            let source =
                PoseSource { body: at as u32, ends: 1, vertex: vertices(at), ..PoseSource::default() };
            if let Some(motion) = body.device_motion().filter(|_| body.kind() == BodyKind::Rigid) {
                let ends = 1 + u32::from(motion.is_moving());
                lent.push(PoseSource { from: LENT_POSES, at: places.len() as u32, ends, ..source });
                places.extend(motion.records(ends as usize));
                self.moves[at] = motion.is_moving();
            } else if is_there(body) {
                if self.moves[at] && !body.is_moving() {
                    first.push(PoseSource { from: RESTING, ..source });
                    self.moves[at] = false;
                }
            } else {
                let own = poses(body);
                if self.differs(at, &own) {
                    first.push(PoseSource { from: POSED, at: uploads.len() as u32, ends: 2, ..source });
                    uploads.extend(own);
                    self.held[2 * at..2 * at + 2].copy_from_slice(&own);
                }
            }
            self.there[at] = is_there(body);
        }
        let of_arrays = device.of(purpose::DEVICE_ARRAYS);
        self.arrays.reserve(&of_arrays, 2 * bodies.len())?;
        self.arrays.hold(&of_arrays, places, 2 * bodies.len())?;
        let of_bodies = device.of(purpose::POSES);
        write(&of_bodies, &mut self.uploaded, &uploads)?;
        write(&of_bodies, &mut self.sources[0], &first)?;
        self.launch(device, &self.args(tables, 0, first.len()))?;
        if lent != self.lent {
            // Forgotten first: an upload that fails leaves no body.
            self.lent.clear();
            write(&of_bodies, &mut self.sources[1], &lent)?;
            self.lent = lent;
        }
        let args = self.args(tables, 1, self.lent.len());
        self.last = Some(args);
        self.launch(device, &args)
    }

    fn args(&self, tables: InstanceTables, group: usize, count: usize) -> PlacePosesArgs {
        PlacePosesArgs {
            tables,
            sources: self.sources[group].span().part(0, count as u64),
            uploaded: self.uploaded.span(),
            lent: self.arrays.places.span(),
            poses: self.poses.span(),
            found: self.arrays.found.span(),
            seen: self.arrays.seen.span(),
            most: MAX_ABS_F64,
        }
    }

    fn launch(&self, device: &Device, args: &PlacePosesArgs) -> Result<(), Error> {
        let count = args.sources.len() as usize;
        if count == 0 { Ok(()) } else { launch::striding::<place_poses>(&device.undisturbed(), count, args) }
    }

    /// Reads the caller's memory again, at the same addresses: a launch, and no transfer from the host.
    ///
    /// # Errors
    /// Device errors.
    pub fn again(&mut self, device: &Device) -> Result<(), Error> {
        let Some(args) = self.last.filter(|args| !args.sources.is_empty()) else { return Ok(()) };
        self.arrays.seen.clear()?;
        self.launch(device, &args)
    }

    /// Whether the device has another pose than the host. By bytes: the sign of a zero may change the
    /// bits of a placed vertex.
    fn differs(&self, at: usize, own: &[PoseRecord; 2]) -> bool {
        let held = self.held.get(2 * at..2 * at + 2).unwrap_or_default();
        self.there[at] || bytemuck::cast_slice::<_, u8>(held) != bytemuck::bytes_of(own)
    }

    /// Returns whether the host has poses that the device has not.
    pub fn differ(&self, bodies: &[Body]) -> bool {
        bodies.iter().enumerate().any(|(at, body)| !is_there(body) && self.differs(at, &poses(body)))
    }

    /// Returns the poses, for kernels.
    pub fn span(&self) -> Span<PoseRecord> {
        self.poses.span()
    }

    /// Returns the poses of the caller's memory.
    pub fn arrays(&self) -> &DeviceArrays {
        &self.arrays
    }

    /// Returns both poses of all bodies. Reads them from the device if the host has not all.
    ///
    /// # Errors
    /// Device errors.
    pub fn read(&self) -> Result<Vec<PoseRecord>, Error> {
        if self.there.contains(&true) { self.poses.read(self.poses.len()) } else { Ok(self.held.clone()) }
    }
}
