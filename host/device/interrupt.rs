//! Interruption of a device's work.

#[cfg(feature = "cuda")]
use super::held;
use super::{Device, Machine};
use crate::error::Error;
use nearmiss_emulator::{Interrupt, Looks};

impl Device {
    /// The same machine; `interrupt` ends the work of every detector that is made with it,
    /// including its construction.
    pub fn with_interrupt(self, interrupt: &Interrupt) -> Device {
        Device { interrupt: Some(interrupt.clone()), ..self }
    }

    /// The handle that ends its work, if there is one.
    pub(crate) fn interrupt(&self) -> Option<&Interrupt> {
        self.interrupt.as_ref()
    }

    /// The same machine, for work that nothing ends early: if left half done, its result could not
    /// be used again.
    pub(crate) fn undisturbed(&self) -> Device {
        Device { interrupt: None, ..self.clone() }
    }

    /// Polls of the handle by the host, for one piece of its own work.
    pub(crate) fn looks(&self) -> Looks<'_> {
        Looks::new(self.interrupt())
    }

    /// Checks that work may continue.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if the handle was triggered.
    pub(crate) fn goes_on(&self) -> Result<(), Error> {
        if self.looks().ends() { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Checks that a launch may start. A GPU's recorded launches are recorded whole.
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
