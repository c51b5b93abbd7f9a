//! Lists with too little room grow; frames whose answer has no room are refused by its count.

use super::Step;
use super::query::QueryMemory;
use super::scene::SceneMemory;
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;

impl<R: Precision> QueryMemory<R> {
    /// Returns whether a list of any step had too little room.
    pub(super) fn has_overflowed(&mut self, scene: &mut SceneMemory<R>, counters: &Counts) -> bool {
        let mut steps = self.narrow_steps_at();
        let is_short = |list: &&mut dyn GrowableOutput| list.has_overflowed(counters);
        scene.lists_of_traversal(self.broad).iter().any(is_short)
            || steps.any(|at| self.narrow.lists(at, &mut scene.features).iter().any(is_short))
            || self.narrow.ordered().iter().any(is_short)
    }

    /// Grows every list that a submission found too short, by the demand of its schedule. The next
    /// frame may have another schedule, and need less.
    ///
    /// # Errors
    /// [`Error::AnswerTooLarge`], before any list grows. [`Error::OutOfMemory`] of the first list
    /// without room; the others have grown. Device errors.
    pub(super) fn grow_all(&mut self, scene: &mut SceneMemory<R>, counters: &Counts) -> Result<(), Error> {
        self.refuse(scene, Step::Traverse, counters)?;
        self.demand.counted(counters, &scene.device)?;
        let device = scene.device.of(purpose::WALK);
        let mut grown = Ok(());
        let mut grow = |list: &mut dyn GrowableOutput| {
            let own = list.grow(&device, counters).map(drop);
            if grown.is_ok() {
                grown = own;
            }
        };
        scene.lists_of_traversal(self.broad).into_iter().for_each(&mut grow);
        for at in self.narrow_steps_at() {
            self.narrow.lists(at, &mut scene.features).into_iter().for_each(&mut grow);
        }
        self.narrow.ordered().into_iter().for_each(&mut grow);
        grown
    }

    /// Refuses a step's counted rows, before its lists grow.
    ///
    /// # Errors
    /// [`Error::AnswerTooLarge`]; device errors.
    pub(super) fn refuse(&self, scene: &SceneMemory<R>, step: Step, counters: &Counts) -> Result<(), Error> {
        match step {
            // Rows of excluded pairs are not foreseen, but counted.
            Step::Traverse if !self.layout.excluded.is_empty() => Ok(()),
            Step::Traverse => {
                let positions = || {
                    let at = scene.all_positions(self, 0)?;
                    let wide = |point: &nearmiss_kernels::math::Vec3<R>| {
                        let point = point.wide();
                        [point[0], point[1], point[2]]
                    };
                    Ok(at.iter().map(wide).collect())
                };
                let pairs = scene.candidates(self).demand(counters);
                self.demand.foreseen(pairs, (&self.layout, &scene.device), positions)
            }
            Step::Narrow(_, false) => self.demand.counted(counters, &scene.device),
            Step::Sample | Step::Narrow(_, true) | Step::Order => Ok(()),
        }
    }
}
