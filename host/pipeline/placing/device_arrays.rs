//! Bodies whose vertices or poses are in memory of the caller.

use super::{Last, Placing, turns, write};
use crate::device::{Ahead, Buffer, Device};
use crate::error::Error;
use crate::mesh;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use crate::scene::Pose;
use nearmiss_kernels::abi::{Lent, PoseRecord, seen};

/// Memory to place bodies from the caller's memory.
pub struct DeviceArrays {
    /// Addresses of the caller's numbers.
    pub places: Buffer<Lent>,
    /// The values in `places`.
    held: Vec<Lent>,
    /// Poses that the kernel read: two per body, the second at the end of a step.
    pub found: Buffer<PoseRecord>,
    /// See [`seen`].
    pub seen: Buffer<u64>,
    /// Whether the last frame placed any.
    pub any: bool,
}

/// Checks of the caller's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Whether some of them are invalid, as NaN is.
    pub invalid: bool,
    /// The largest magnitude of the others.
    pub largest: f64,
}

/// Positions of all bodies, as the device has them.
pub struct Whereabouts {
    /// All vertices, at both ends or at the only one.
    pub ends: Vec<mesh::Positions>,
    /// Number of these ends that a frame reads. One, if the other end only serves steps with both
    /// ends in the caller's memory.
    pub looked_at: usize,
    /// Poses that were read from the caller's memory, at as many ends, of each body; default poses
    /// for the others.
    pub poses: Vec<Pose>,
    /// Checks of the caller's numbers; `None` if none were read.
    pub seen: Option<Seen>,
}

impl DeviceArrays {
    /// Allocates empty memory.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device) -> Result<DeviceArrays, Error> {
        Ok(DeviceArrays {
            places: device.buffer(0)?,
            held: Vec::new(),
            found: device.buffer(0)?,
            seen: device.buffer(0)?,
            any: false,
        })
    }

    /// Uploads addresses of the caller's memory, and allocates room for `poses` poses that a launch
    /// reads.
    ///
    /// # Errors
    /// Device errors.
    pub fn hold(&mut self, device: &Device, places: Vec<Lent>, poses: usize) -> Result<(), Error> {
        self.any = !places.is_empty();
        if !self.any {
            return Ok(());
        }
        self.reserve(device, poses)?;
        self.seen.clear()?;
        if places != self.held {
            write(device, &mut self.places, &places)?;
            self.held = places;
        }
        Ok(())
    }
}

impl DeviceArrays {
    /// Allocates the checks, and room for `poses` poses.
    ///
    /// # Errors
    /// Device errors.
    pub fn reserve(&mut self, device: &Device, poses: usize) -> Result<(), Error> {
        if self.seen.is_empty() {
            self.seen = device.buffer(seen::COUNT as usize)?;
            self.found = device.buffer(poses)?;
        }
        Ok(())
    }

    /// Returns the memory that [`DeviceArrays::seen`] reads, to be read ahead.
    pub fn ahead(&self) -> Option<Ahead<'_>> {
        self.any.then(|| self.seen.ahead(seen::COUNT as usize))
    }

    /// Returns the last frame's checks of the caller's numbers; `None` if it read none.
    ///
    /// # Errors
    /// Device errors.
    pub fn seen(&self) -> Result<Option<Seen>, Error> {
        if !self.any {
            return Ok(None);
        }
        let words = self.seen.read(seen::COUNT as usize)?;
        let word = |at: u32| words[at as usize];
        Ok(Some(Seen { invalid: word(seen::INVALID) > 0, largest: f64::from_bits(word(seen::LARGEST)) }))
    }

    /// Returns the poses alone, as in [`Whereabouts::poses`].
    ///
    /// # Errors
    /// Device errors.
    pub fn poses(&self) -> Result<Vec<Pose>, Error> {
        let pose = |found: &PoseRecord| Pose { rotation: found.rotation, translation: found.translation };
        Ok(self.found.read(self.found.len())?.iter().map(pose).collect())
    }
}

impl<R: Precision> Placing<R> {
    /// Places the bodies of the last frame again, from the same addresses: a launch, and no
    /// transfer from the host.
    ///
    /// # Errors
    /// Device errors.
    pub fn again(&mut self, device: &Device) -> Result<(), Error> {
        let Last::Device(args) = &self.last else { return Ok(()) };
        let (args, turns) = &**args;
        self.is_at_rest_current = false;
        if self.arrays.any {
            self.arrays.seen.clear()?;
        }
        launch::striding::<R::Place>(&device.undisturbed(), args.count as usize, args)?;
        turns::launch(device, turns)
    }

    /// Returns whether the last frame placed nothing, or only from device memory.
    pub fn is_repeatable(&self) -> bool {
        !matches!(self.last, Last::Host)
    }

    /// Returns the data of bodies in memory of the caller.
    pub fn arrays(&self) -> &DeviceArrays {
        &self.arrays
    }

    /// Returns the positions of all bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn whereabouts(&self) -> Result<Whereabouts, Error> {
        let mut ends = self.all_positions()?;
        let looked_at = ends.len();
        if self.keeps.contains(&true) {
            let later = self.later.read(self.later.len())?;
            let mut end = ends[0].clone();
            for body in (0..self.keeps.len()).filter(|&body| self.keeps[body]) {
                let own = self.starts[body] as usize..self.starts[body + 1] as usize;
                end[own.clone()].iter_mut().zip(&later[own]).for_each(|(to, from)| *to = from.at);
            }
            ends.push(end);
        }
        // The second pose of a body is valid if it has two ends.
        let found = self.arrays.poses()?;
        let has_end = |body: usize| looked_at == 2 || self.keeps[body];
        let of = |(body, found): (usize, &[Pose])| {
            [0, usize::from(has_end(body))].map(|end| found[end]).into_iter().take(ends.len())
        };
        let poses = found.chunks_exact(2).enumerate().flat_map(of).collect();
        let seen = self.arrays.seen()?;
        Ok(Whereabouts { ends: ends.into_iter().map(R::positions).collect(), looked_at, poses, seen })
    }
}
