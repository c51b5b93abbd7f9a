//! Bodies whose vertices or poses lie in memory of the caller.

use super::{Last, Placing, write};
use crate::device::{Ahead, Buffer, Device};
use crate::error::Error;
use crate::mesh;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use crate::scene::Pose;
use nearmiss_kernels::abi::{Lent, PoseRecord, Span, seen};

/// What placing from memory of the caller needs.
pub struct LentMemory {
    /// Where the numbers lie.
    pub places: Buffer<Lent>,
    /// What `places` holds.
    held: Vec<Lent>,
    /// Poses as they were found: two of each body, of which the second is that of a step.
    pub found: Buffer<PoseRecord>,
    /// See [`seen`].
    pub seen: Buffer<u64>,
    /// Whether the last frame placed any.
    pub any: bool,
}

/// What placing saw of the caller's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Whether some of them cannot be computed with.
    pub invalid: bool,
    /// The largest size of the others.
    pub largest: f64,
}

/// Where all bodies are, as the device knows it.
pub struct Whereabouts {
    /// All vertices, at both ends or at the only one.
    pub ends: Vec<mesh::Positions>,
    /// How many of these a frame looks at: one, where the other is that of steps of which the
    /// caller's memory had both ends.
    pub looked_at: usize,
    /// Poses that were found in memory of the caller, at as many ends, of each body; others are none.
    pub poses: Vec<Pose>,
    /// What placing saw of the caller's numbers; `None` if it read none.
    pub seen: Option<Seen>,
}

impl LentMemory {
    /// None yet.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device) -> Result<LentMemory, Error> {
        Ok(LentMemory {
            places: device.buffer(0)?,
            held: Vec::new(),
            found: device.buffer(0)?,
            seen: device.buffer(0)?,
            any: false,
        })
    }

    /// Puts places of the caller's memory where a launch finds them, and takes what it writes: room for so many poses.
    ///
    /// # Errors
    /// Those of the device.
    pub fn hold(&mut self, device: &Device, places: Vec<Lent>, poses: usize) -> Result<(), Error> {
        self.any = !places.is_empty();
        if !self.any {
            return Ok(());
        }
        if self.seen.is_empty() {
            self.seen = device.buffer(seen::COUNT as usize)?;
            self.found = device.buffer(poses)?;
        }
        self.seen.clear()?;
        if places != self.held {
            write(device, &mut self.places, &places)?;
            self.held = places;
        }
        Ok(())
    }
}

impl<R: Precision> Placing<R> {
    /// Places once more what the last frame placed, from where it lay: a launch, and no word of the host.
    ///
    /// # Errors
    /// Those of the device.
    pub fn again(&mut self, device: &Device) -> Result<(), Error> {
        let Last::Device(args) = &self.last else { return Ok(()) };
        self.is_at_rest_current = false;
        if self.lent.any {
            self.lent.seen.clear()?;
        }
        launch::striding::<R::Place>(&device.undisturbed(), args.count as usize, args)
    }

    /// Whether the last frame placed nothing, or only what lies on the device.
    pub fn is_repeatable(&self) -> bool {
        !matches!(self.last, Last::Host)
    }

    /// What is to be read ahead of what [`Placing::seen`] reads.
    pub fn ahead(&self) -> Option<Ahead<'_>> {
        self.lent.any.then(|| self.lent.seen.ahead(seen::COUNT as usize))
    }

    /// Where a kernel finds what was seen of the caller's numbers.
    pub fn seen_span(&self) -> Span<u64> {
        self.lent.seen.span()
    }

    /// What the last frame saw of the caller's numbers; `None` where it read none.
    ///
    /// # Errors
    /// Those of the device.
    pub fn seen(&self) -> Result<Option<Seen>, Error> {
        if !self.lent.any {
            return Ok(None);
        }
        let words = self.lent.seen.read(seen::COUNT as usize)?;
        let word = |at: u32| words[at as usize];
        Ok(Some(Seen { invalid: word(seen::INVALID) > 0, largest: f64::from_bits(word(seen::LARGEST)) }))
    }

    /// Where all bodies are.
    ///
    /// # Errors
    /// Those of the device.
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
        // The second pose of a body is one where it has two ends.
        let found = self.poses()?;
        let has_end = |body: usize| looked_at == 2 || self.keeps[body];
        let of = |(body, found): (usize, &[Pose])| {
            [0, usize::from(has_end(body))].map(|end| found[end]).into_iter().take(ends.len())
        };
        let poses = found.chunks_exact(2).enumerate().flat_map(of).collect();
        let seen = self.seen()?;
        Ok(Whereabouts { ends: ends.into_iter().map(R::positions).collect(), looked_at, poses, seen })
    }

    /// The poses alone, as of [`Whereabouts::poses`].
    ///
    /// # Errors
    /// Those of the device.
    pub fn poses(&self) -> Result<Vec<Pose>, Error> {
        let pose = |found: &PoseRecord| Pose { rotation: found.rotation, translation: found.translation };
        Ok(self.lent.found.read(self.lent.found.len())?.iter().map(pose).collect())
    }
}
