//! Rigid bodies that may turn in the step, and their records on the device.

use super::write;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::{launch, purpose};
use crate::scene::Body;
use nearmiss_kernels::abi::{Placement, PoseRecord, Span, TurnRecord, TurnSource, TurnsArgs};
use nearmiss_kernels::entry::place_turns;

/// The bodies of a frame that may turn: those that turn, and those whose poses the host does not
/// know.
pub struct Turns {
    sources: Buffer<TurnSource>,
    records: Buffer<TurnRecord>,
    /// The values in `sources`.
    held: Vec<TurnSource>,
}

impl Turns {
    /// Returns no bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device) -> Result<Self, Error> {
        Ok(Turns { sources: device.buffer(0)?, records: device.buffer(0)?, held: Vec::new() })
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Returns their records.
    pub fn span(&self) -> Span<TurnRecord> {
        self.records.span().part(0, self.held.len() as u64)
    }

    /// Downloads their records.
    ///
    /// # Errors
    /// Device errors.
    pub fn read(&self) -> Result<Vec<TurnRecord>, Error> {
        self.records.read(self.held.len())
    }

    /// Sets the bodies of a frame.
    ///
    /// # Errors
    /// Device errors.
    pub fn hold(&mut self, device: &Device, sources: Vec<TurnSource>) -> Result<(), Error> {
        if sources != self.held {
            let device = device.of(purpose::POSES);
            if sources.len() > self.records.len() {
                self.records = device.buffer(sources.len())?;
            }
            // Forgotten first: an upload that fails leaves no body.
            self.held.clear();
            write(&device, &mut self.sources, &sources)?;
            self.held = sources;
        }
        Ok(())
    }

    /// Returns the arguments of the kernel that makes their records.
    pub fn args(&self, poses: Span<PoseRecord>, found: Span<PoseRecord>) -> TurnsArgs {
        let sources = self.sources.span().part(0, self.held.len() as u64);
        TurnsArgs { sources, poses, found, turns: self.span() }
    }
}

/// Returns the source of a body that is placed by its poses; `None` if it certainly does not turn.
/// `fixed` is the largest coordinate of fixed bodies.
pub fn source(body: &Body, placement: &Placement, fixed: f64) -> Option<TurnSource> {
    let source = TurnSource {
        vertex: placement.vertex,
        end: placement.vertex + body.vertex_count() as u32,
        rest: placement.source,
        pose: placement.pose,
        fixed,
        ..TurnSource::default()
    };
    if body.is_device_resident() {
        return Some(TurnSource { is_lent: 1, ..source });
    }
    let (pivot, turn) = body.turn()?;
    Some(TurnSource { is_given: 1, pivot, turn: turn.0, ..source })
}

/// Makes the records, if there are any.
///
/// # Errors
/// Device errors.
pub fn launch(device: &Device, args: &TurnsArgs) -> Result<(), Error> {
    if args.sources.is_empty() {
        return Ok(());
    }
    launch::striding::<place_turns>(&device.undisturbed(), args.sources.len() as usize, args)
}
