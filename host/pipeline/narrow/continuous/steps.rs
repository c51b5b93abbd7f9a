//! The steps of the phase, in order, and the step that drops pairs that a scene excludes.

use super::ContinuousNarrow;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::narrow::exclude::Kept;
use crate::pipeline::narrow::{Capacities, NarrowContext};
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::counter;

/// A step of the phase.
#[derive(Clone, Copy)]
pub(super) enum Step {
    /// Lists vertex/face and edge/edge candidates.
    Features,
    /// Lists those that may meet.
    Cull,
    /// Lists those of them that are not excluded, in a scene that excludes some.
    Exclude,
    /// Counts the triangle pairs that share a point at the start, at the same time as the next step.
    /// That one mostly waits for few pairs.
    Start,
    /// Solves for contacts.
    Solve,
}

impl Step {
    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Step::Start => "start",
            Step::Features => "features",
            Step::Cull => "cull",
            Step::Exclude => "exclude",
            Step::Solve => "solve",
        }
    }
}

impl ContinuousNarrow {
    /// Drops pairs that are excluded before the solver, with room for `few` pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn exclude(&mut self, device: &Device, few: usize) -> Result<(), Error> {
        let names = [
            ("vertex/face pairs that are not excluded", counter::VF_KEPT),
            ("edge/edge pairs that are not excluded", counter::EE_KEPT),
        ];
        let capacities = Capacities::usual(few);
        self.kept = Some(Kept::new(device, names, capacities.survivors)?);
        self.turning.exclude(device)?;
        if let Some(thin) = &mut self.thin {
            thin.exclude(device, &capacities)?;
        }
        self.start.as_mut().map_or(Ok(()), |start| start.exclude(device, few / 4))
    }

    /// Returns the steps, in order. Pairs with a separation have no cull: signs could reject none.
    pub(super) fn all_steps(&self) -> impl Iterator<Item = Step> {
        let step = |is_there: bool, step| is_there.then_some(step);
        let between = [
            step(self.survivors.is_some() || self.thin.is_some(), Step::Cull),
            step(self.kept.is_some(), Step::Exclude),
            step(self.start.is_some(), Step::Start),
        ];
        [Some(Step::Features)].into_iter().chain(between).chain([Some(Step::Solve)]).flatten()
    }

    /// Returns one of the steps, by its place.
    pub(super) fn step_at(&self, place: usize) -> Result<Step, Error> {
        self.all_steps().nth(place).ok_or_else(|| Error::Bug { what: format!("no step {place}") })
    }

    /// Launches the step that drops pairs that are excluded.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn keep<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        if let Some(kept) = &self.kept {
            kept.run(given, self.may_meet(given.features))?;
        }
        if let Some(thin) = &self.thin {
            thin.keep(given)?;
        }
        self.turning.keep(given)
    }
}
