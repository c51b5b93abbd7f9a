//! Ending the work of a device early.

#[cfg(feature = "cuda")]
use super::held;
use super::{Device, Machine};
use crate::error::Error;
use nearmiss_emulator::{Interrupt, Looks};

impl Device {
    /// The same machine; `interrupt` ends the work of every detector that is made with it, and its
    /// making.
    pub fn with_interrupt(self, interrupt: &Interrupt) -> Device {
        Device { interrupt: Some(interrupt.clone()), ..self }
    }

    /// The handle that ends its work, if there is one.
    pub(crate) fn interrupt(&self) -> Option<&Interrupt> {
        self.interrupt.as_ref()
    }

    /// The same machine, for work that nothing ends early: what would be left half done could not
    /// be used again.
    pub(crate) fn undisturbed(&self) -> Device {
        Device { interrupt: None, ..self.clone() }
    }

    /// Looks of the host at the handle, for one piece of its own work.
    pub(crate) fn looks(&self) -> Looks<'_> {
        Looks::new(self.interrupt())
    }

    /// Whether work goes on.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when the handle was triggered.
    pub(crate) fn goes_on(&self) -> Result<(), Error> {
        if self.looks().ends() { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// The same, before a launch. A GPU's launches that are recorded are recorded whole.
    pub(super) fn may_launch(&self) -> Result<(), Error> {
        match &*self.machine {
            Machine::Emulator(_) => self.goes_on(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(_) if held::is_held(&self.usage) => Ok(()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(_) => self.goes_on(),
        }
    }
}
