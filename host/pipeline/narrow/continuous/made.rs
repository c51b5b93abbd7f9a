//! How the phase is made: for all contacts, or for the first.

use super::ContinuousNarrow;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::List;
use crate::pipeline::narrow::Capacities;
use crate::pipeline::narrow::left::{OfKinds, USUAL, lists};
use crate::pipeline::narrow::rungs::Rungs;
use crate::pipeline::narrow::start::StartCheck;
use crate::pipeline::narrow::thin::{Thin, is_mixed, solver_in};
use crate::pipeline::narrow::turning::Turning;
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use crate::query::{Certified, ContinuousSolver};
use nearmiss_kernels::abi::{Hit, counter, earliest};

/// Pairs that the cull keeps.
pub(super) const MAY_MEET: OfKinds = [
    ("narrow: vf that may meet", "vertex/face pairs that may meet", counter::VF_SURVIVORS),
    ("narrow: ee that may meet", "edge/edge pairs that may meet", counter::EE_SURVIVORS),
];
/// The contacts; their order is compared, not their lists.
const HITS: OfKinds =
    [("", "vertex/face contacts", counter::VF_HITS), ("", "edge/edge contacts", counter::EE_HITS)];

impl ContinuousNarrow {
    /// Allocates the phase for all contacts of a scene.
    ///
    /// # Errors
    /// Device errors.
    pub fn all(
        device: &Device,
        solver: ContinuousSolver,
        layout: &Layout,
        few: usize,
    ) -> Result<Self, Error> {
        ContinuousNarrow::in_scene(device, (solver, layout), || Capacities::usual(few))
    }

    /// Allocates the phase for the smallest time alone.
    ///
    /// # Errors
    /// Device errors.
    pub fn first(
        device: &Device,
        solver: ContinuousSolver,
        layout: &Layout,
        few: usize,
    ) -> Result<Self, Error> {
        let capacities = || Capacities { hits: [0, 0], ..Capacities::usual(few) };
        let narrow = ContinuousNarrow::in_scene(device, (solver, layout), capacities)?;
        Ok(ContinuousNarrow {
            earliest: Some(device.of(purpose::EARLIEST).buffer(earliest::WORDS as usize)?),
            ..narrow
        })
    }

    /// Allocates it by the thickness of a scene: its features may have none, one, or some one.
    fn in_scene(
        device: &Device,
        (solver, layout): (ContinuousSolver, &Layout),
        capacities: impl Fn() -> Capacities,
    ) -> Result<Self, Error> {
        let is_thick = layout.is_thick();
        let mut narrow = ContinuousNarrow::new(device, solver_in(solver, is_thick), capacities())?;
        narrow.is_thick = is_thick;
        if layout.is_uneven {
            narrow.rungs.thicken(device, &layout.radii)?;
        }
        if let Some(certified) = solver.certified().filter(|_| is_mixed(solver, layout)) {
            narrow.thin = Some(Thin::new(device, certified, layout, &capacities())?);
        }
        Ok(narrow)
    }

    /// Allocates the lists with these capacities.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, solver: ContinuousSolver, capacities: Capacities) -> Result<Self, Error> {
        let survivors = || lists(device, MAY_MEET, capacities.survivors);
        let is_apart = solver.certified().is_some_and(Certified::is_apart);
        let [vf_hits, ee_hits] = ContinuousNarrow::hits(device, capacities.hits)?;
        Ok(ContinuousNarrow {
            solver,
            start: None,
            survivors: (!is_apart).then(survivors).transpose()?,
            kept: None,
            vf_hits,
            ee_hits,
            rungs: Rungs::new(device, (solver.certified(), &USUAL), &capacities)?,
            turning: Turning::new(device)?,
            counters: [
                counter::VF_OPEN,
                counter::EE_OPEN,
                counter::UNDECIDED,
                counter::ENDED,
                counter::ENDED_UNDECIDED,
                counter::BELOW_PRECISION,
            ],
            finest: None,
            below_precision: None,
            is_thick: false,
            thin: None,
            earliest: None,
            bound: None,
            second: None,
            ordered: None,
        })
    }

    /// Returns the lists of contacts.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn hits(device: &Device, room: [usize; 2]) -> Result<[List<Hit>; 2], Error> {
        lists(device, HITS, room)
    }

    /// Adds the check of the start: it counts crossing pairs, with room for `few` pairs that
    /// filters leave uncertain.
    ///
    /// # Errors
    /// Device errors.
    pub fn checking_start<R: Precision>(self, device: &Device, few: usize) -> Result<Self, Error> {
        Ok(ContinuousNarrow { start: Some(StartCheck::new::<R>(device, few)?), ..self })
    }
}
