//! Place: the vertices of all bodies on the device, at the positions of each frame.

mod device_arrays;
pub mod turns;
mod vertices;

pub use device_arrays::{DeviceArrays, Seen, Whereabouts};

use super::layout::Layout;
use super::precision::Precision;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::mesh;
use crate::pipeline::{launch, purpose};
use crate::scene::{Body, BodyKind, DeviceMotion, Pose};
use bytemuck::Pod;
use nearmiss_kernels::abi::{
    KEEPS_END, LENT, LENT_POSES, POSED, PlaceArgs, Placement, Point, PoseRecord, Positions, RESTING, Span,
    StartsArgs, TurnRecord, TurnsArgs, UPLOADED,
};
use nearmiss_kernels::math::{Real, Vec3, round};
use turns::Turns;
use vertices::Vertices;

/// A body that a frame moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moved {
    /// The body's index.
    pub body: usize,
    /// Whether it rests at the end of the last step, instead of at its new position.
    pub rests: bool,
}

impl Moved {
    /// Returns the move for vertices with one end. A body that the host knows is placed at its new
    /// position; only the device has the end of the others.
    fn at_one_end(self, bodies: &[Body]) -> Moved {
        Moved { rests: self.rests && bodies[self.body].is_device_resident(), ..self }
    }
}

/// The source of the last frame's placing.
enum Last<R: Real> {
    /// None.
    Nothing,
    /// Device memory: it can be placed again.
    Device(Box<(PlaceArgs<R>, TurnsArgs)>),
    /// Host memory.
    Host,
}

/// The vertices of a scene, and the memory to move them.
pub struct Placing<R: Precision> {
    vertices: Vertices<R>,
    /// Positions at t = 0 alone, if vertices have two ends and a query reads one; and whether they
    /// are current.
    at_rest: Buffer<Point<R>>,
    is_at_rest_current: bool,
    /// Vertices of rigid bodies without a pose, and each body's start there.
    rest: Buffer<Point<R>>,
    rest_starts: Vec<u32>,
    /// Each body's first vertex here, then the end of the last one. A body that is not placed has no
    /// vertex here.
    starts: Vec<u32>,
    /// Each body's first vertex in the scene.
    in_scene: Vec<u32>,
    /// Whether each body is placed.
    are_placed: Vec<bool>,
    /// For vertices with one end: ends of steps with both ends in the caller's memory, and which
    /// bodies have them.
    later: Buffer<Point<R>>,
    keeps: Vec<bool>,
    /// The last frame's data: vertices that came from the host, unless all did, and the placements.
    uploaded: Vertices<R>,
    placements: Buffer<Placement>,
    poses: Buffer<PoseRecord>,
    /// The values in `placements`.
    placed: Vec<Placement>,
    /// Data of bodies in memory of the caller; empty if there are none.
    arrays: DeviceArrays,
    /// The thickness of every vertex, rounded up, here and on the device; empty in a scene without.
    thick: (Vec<R>, Buffer<R>),
    /// The largest coordinate of fixed bodies.
    fixed: f64,
    /// Bodies that may turn in the last frame's step.
    turns: Turns,
    last: Last<R>,
}

impl<R: Precision> Placing<R> {
    /// Allocates the vertices of the bodies that are placed, moving or still, and places them.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        layout: &Layout,
        (bodies, are_placed): (&[Body], Vec<bool>),
        moving: bool,
    ) -> Result<Self, Error> {
        let is_rigid = |i: usize| are_placed[i] && bodies[i].kind() == BodyKind::Rigid;
        let rest: Vec<Point<R>> = (0..bodies.len())
            .filter(|&i| is_rigid(i))
            .flat_map(|i| R::points(bodies[i].positions_t0()).map(Point::from))
            .collect();
        let rest_starts = starts(bodies, is_rigid);
        let starts = starts(bodies, |i| are_placed[i]);
        // Queries that read a thickness place all bodies.
        let radii = if are_placed.contains(&false) { &[][..] } else { &layout.radii };
        let radii: Vec<R> = radii.iter().map(|&radius| R::of(round::up(radius).into())).collect();
        let fixed = |&i: &usize| are_placed[i] && bodies[i].kind() == BodyKind::Fixed;
        let fixed = largest((0..bodies.len()).filter(fixed).map(|i| &bodies[i]));
        let of_radii = device.of(purpose::RADII).upload(&radii)?;
        let mut placing = Placing {
            vertices: Vertices::new(device, moving, starts[bodies.len()] as usize)?,
            at_rest: device.buffer(0)?,
            is_at_rest_current: false,
            rest_starts,
            starts,
            in_scene: layout.starts.iter().map(|at| at.vertex).collect(),
            are_placed,
            later: device.buffer(0)?,
            keeps: vec![false; bodies.len()],
            rest: device.of(purpose::REST).upload(&rest)?,
            uploaded: Vertices::new(device, moving, 0)?,
            placements: device.buffer(0)?,
            poses: device.buffer(0)?,
            placed: Vec::new(),
            arrays: DeviceArrays::new(&device.of(purpose::DEVICE_ARRAYS))?,
            thick: (radii, of_radii),
            fixed,
            turns: Turns::new(device)?,
            last: Last::Host,
        };
        placing.write_all(bodies)?;
        let moved: Vec<Moved> = (0..bodies.len())
            .filter(|&i| bodies[i].kind() == BodyKind::Rigid || bodies[i].device_motion().is_some())
            .map(|body| Moved { body, rests: false })
            .collect();
        placing.put(device, bodies, &moved)?;
        Ok(placing)
    }

    /// Returns positions for a query at one time, or in motion; they must be
    /// [ready](Placing::ready).
    pub fn frames(&self, at_rest: bool) -> Positions<R> {
        match &self.vertices {
            Vertices::Moving(_) if at_rest => {
                Positions { still: self.at_rest.span(), moving: Span::EMPTY, turns: Span::EMPTY }
            }
            Vertices::Still(_) | Vertices::Moving(_) => {
                Positions { turns: self.turns.span(), ..self.vertices.span() }
            }
        }
    }

    /// Returns the vertices of rigid bodies, as they are without a pose.
    pub fn rest(&self) -> Span<Point<R>> {
        self.rest.span()
    }

    /// Returns each body's first vertex here, then the end of the last one.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Returns the thickness of every vertex, rounded up; empty in a scene without.
    pub fn radii(&self) -> &[R] {
        &self.thick.0
    }

    /// Downloads the bodies that may turn.
    ///
    /// # Errors
    /// Device errors.
    pub fn turn_records(&self) -> Result<Vec<TurnRecord>, Error> {
        self.turns.read()
    }

    /// Returns whether a body may turn in the step.
    pub fn turns(&self) -> bool {
        !self.turns.is_empty()
    }

    /// Returns whether positions are ready for a query at one time, or in motion.
    pub fn is_ready(&self, at_rest: bool) -> bool {
        !at_rest || self.is_at_rest_current || matches!(self.vertices, Vertices::Still(_))
    }

    /// Copies positions at t = 0 from those of the whole step. Cost: a launch, and no transfer from
    /// the host.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready(&mut self, device: &Device) -> Result<(), Error> {
        let Vertices::Moving(motions) = &self.vertices else { return Ok(()) };
        if self.at_rest.len() != motions.len() {
            self.at_rest = device.buffer(motions.len())?;
        }
        let args = StartsArgs { moving: motions.span(), still: self.at_rest.span() };
        launch::striding::<R::Starts>(&device.undisturbed(), motions.len(), &args)?;
        self.is_at_rest_current = true;
        Ok(())
    }

    /// Returns the positions that a query reads: at t = 0 and, in motion, at t = 1.
    ///
    /// # Errors
    /// Device errors.
    pub fn positions(&self, at_rest: bool) -> Result<Vec<Vec<Vec3<R>>>, Error> {
        let mut ends = self.all_positions()?;
        ends.truncate(if at_rest { 1 } else { 2 });
        Ok(ends)
    }

    fn all_positions(&self) -> Result<Vec<Vec<Vec3<R>>>, Error> {
        Ok(match &self.vertices {
            Vertices::Still(points) => vec![points.read(points.len())?.iter().map(|p| p.at).collect()],
            Vertices::Moving(motions) => {
                let motions = motions.read(motions.len())?;
                vec![motions.iter().map(|m| m.t0.at).collect(), motions.iter().map(|m| m.t1.at).collect()]
            }
        })
    }

    /// Moves bodies, named in ascending order. It uploads positions and poses, and placements if
    /// other bodies move than in the frame before; then it launches once. If all bodies are
    /// deformable and all move, it uploads and launches nothing. For vertices with one end, resting
    /// bodies of the host have a launch of their own. It runs before that for the caller's memory,
    /// which alone is placed [again](Placing::again).
    ///
    /// # Errors
    /// Device errors.
    pub fn put(&mut self, device: &Device, bodies: &[Body], moved: &[Moved]) -> Result<(), Error> {
        let own: Vec<Moved>;
        let moved = if self.are_placed.contains(&false) {
            own = moved.iter().copied().filter(|m| self.are_placed[m.body]).collect();
            &own
        } else {
            moved
        };
        self.is_at_rest_current = false;
        if matches!(self.vertices, Vertices::Moving(_)) {
            return self.put_together(device, bodies, moved);
        }
        let any_in_arrays = moved.iter().any(|m| bodies[m.body].device_motion().is_some());
        let goes_first = |m: &Moved| any_in_arrays && m.rests && !bodies[m.body].is_device_resident();
        let one_end = |first: bool| {
            let group = moved.iter().filter(|m| goes_first(m) == first);
            group.map(|m| m.at_one_end(bodies)).collect::<Vec<_>>()
        };
        let first = one_end(true);
        if !first.is_empty() {
            self.put_together(device, bodies, &first)?;
        }
        self.put_together(device, bodies, &one_end(false))
    }

    /// Uploads the positions of all bodies that are placed.
    fn write_all(&mut self, bodies: &[Body]) -> Result<(), Error> {
        let placed = bodies.iter().zip(&self.are_placed).filter(|(_, is_placed)| **is_placed);
        self.vertices.write(placed.map(|(body, _)| body), &self.thick.0)
    }

    fn put_together(&mut self, device: &Device, bodies: &[Body], moved: &[Moved]) -> Result<(), Error> {
        let all = moved.len() == self.are_placed.iter().filter(|&&is| is).count();
        self.turns.hold(device, Vec::new())?;
        (self.last, self.arrays.any) = (Last::Nothing, false);
        let comes = |m: &Moved| {
            !m.rests && bodies[m.body].kind() != BodyKind::Rigid && bodies[m.body].device_motion().is_none()
        };
        if all && moved.iter().all(comes) {
            self.keeps.fill(false);
            self.last = Last::Host;
            return self.write_all(bodies);
        }
        let moving = matches!(self.vertices, Vertices::Moving(_));
        let ends = if moving { 2 } else { 1 };
        let (mut placed, mut poses, mut uploads, mut arrays) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut turning = Vec::new();
        let (mut before, mut uploaded) = (0, 0);
        for &Moved { body: i, rests } in moved {
            let (body, vertex) = (&bodies[i], self.starts[i]);
            let count = body.vertex_count() as u32;
            if count == 0 {
                continue;
            }
            let keeps = !moving && (rests || body.device_motion().is_some_and(DeviceMotion::is_moving));
            self.keeps[i] = keeps;
            let placement = Placement { vertex, before, source: self.rest_starts[i], ..Placement::default() };
            placed.push(match (rests, body.device_motion(), body.kind()) {
                (true, _, _) => Placement { from: RESTING, ..placement },
                (false, Some(input), kind) => {
                    let first = arrays.len() as u32;
                    arrays.extend(input.records(if keeps { 2 } else { ends }));
                    let is_rigid = kind == BodyKind::Rigid;
                    let from = if is_rigid { LENT_POSES } else { LENT };
                    let from = if keeps { from | KEEPS_END } else { from };
                    let source = if is_rigid { placement.source } else { self.in_scene[i] };
                    let placement = Placement { from, source, lent: first, pose: 2 * i as u32, ..placement };
                    if moving && kind == BodyKind::Rigid && input.is_moving() {
                        turning.extend(turns::source(body, &placement, self.fixed));
                    }
                    placement
                }
                (false, None, BodyKind::Rigid) => {
                    let pose = poses.len() as u32;
                    poses.extend(body.poses().iter().take(ends).map(Pose::record));
                    let placement = Placement { from: POSED, pose, ..placement };
                    if moving {
                        turning.extend(turns::source(body, &placement, self.fixed));
                    }
                    placement
                }
                (false, None, BodyKind::Deformable | BodyKind::Fixed) => {
                    uploads.push(i);
                    uploaded += count;
                    Placement { from: UPLOADED, source: uploaded - count, ..placement }
                }
            });
            before += count;
        }
        if placed.is_empty() {
            return Ok(());
        }
        if uploaded as usize > self.uploaded.len() {
            self.uploaded = Vertices::new(&device.of(purpose::UPLOADED), moving, uploaded as usize)?;
        }
        if uploaded > 0 {
            self.uploaded.write(uploads.iter().map(|&i| &bodies[i]), &[])?;
        }
        write(&device.of(purpose::POSES), &mut self.poses, &poses)?;
        if placed != self.placed {
            write(&device.of(purpose::PLACEMENTS), &mut self.placements, &placed)?;
            self.placed = placed;
        }
        self.arrays.hold(&device.of(purpose::DEVICE_ARRAYS), arrays, 2 * bodies.len())?;
        if self.later.is_empty() && self.keeps.contains(&true) {
            self.later = device.of(purpose::DEVICE_ARRAYS).buffer(self.vertices.len())?;
        }
        let args = PlaceArgs {
            placements: self.placements.span().part(0, self.placed.len() as u64),
            uploaded: self.uploaded.span(),
            rest: self.rest.span(),
            poses: self.poses.span(),
            found: self.arrays.found.span(),
            lent: self.arrays.places.span(),
            vertices: self.vertices.span(),
            later: self.later.span(),
            radii: self.thick.1.span(),
            seen: self.arrays.seen.span(),
            most: if R::WIDE { mesh::MAX_ABS_F64 } else { mesh::MAX_ABS_F32.into() },
            count: before,
            pad: 0,
        };
        self.turns.hold(device, turning)?;
        let of_turns = self.turns.args(args.poses, args.found);
        let is_repeatable = uploaded == 0 && poses.is_empty();
        self.last = if is_repeatable { Last::Device(Box::new((args, of_turns))) } else { Last::Host };
        launch::striding::<R::Place>(&device.undisturbed(), before as usize, &args)?;
        turns::launch(device, &of_turns)
    }
}

/// Returns each body's first vertex among those of some bodies, and their number.
fn starts(bodies: &[Body], is_one: impl Fn(usize) -> bool) -> Vec<u32> {
    let count = |i: usize| if is_one(i) { bodies[i].vertex_count() as u32 } else { 0 };
    let ends = (0..bodies.len()).scan(0, |at, i| {
        *at += count(i);
        Some(*at)
    });
    std::iter::once(0).chain(ends).collect()
}

/// Returns the largest coordinate of vertices of bodies.
fn largest<'a>(bodies: impl Iterator<Item = &'a Body>) -> f64 {
    let points = bodies.flat_map(|body| f64::points(body.positions_t0()));
    points.flat_map(|point| point.0).filter(|x| x.is_finite()).fold(0.0, |most, x| most.max(x.abs()))
}

/// Sets the first elements of a buffer, which grows if it must.
///
/// # Errors
/// Device errors.
pub fn write<T: Pod>(device: &Device, buffer: &mut Buffer<T>, items: &[T]) -> Result<(), Error> {
    if items.len() > buffer.len() {
        *buffer = device.buffer(items.len())?;
    }
    if items.is_empty() { Ok(()) } else { buffer.write(items) }
}
