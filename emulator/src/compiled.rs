//! Every kernel of the table, compiled here for the emulator. A crate that launches one does not
//! compile it again.

use crate::{Emulator, Error, Interrupt};
use nearmiss_kernels::entry::{Entry, Visit, visit};
use std::any::TypeId;
use std::sync::OnceLock;

/// [`Emulator::run`] of a kernel, with a pointer to its arguments.
type Run = unsafe fn(&Emulator, u32, *const (), Option<&Interrupt>) -> Result<(), Error>;

/// The kernels in the order of the table.
#[derive(Default)]
struct All(Vec<(TypeId, Run)>);

impl Visit for All {
    fn kernel<E: Entry>(&mut self) {
        self.0.push((TypeId::of::<E>(), run::<E>));
    }
}

/// All kernels. Not generic, so that they are compiled here.
fn all() -> &'static All {
    static ALL: OnceLock<All> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut all = All::default();
        visit(&mut all);
        all
    })
}

/// # Safety
/// As for [`Emulator::launch`], and `args` points to the kernel's arguments.
unsafe fn run<E: Entry>(
    emulator: &Emulator,
    blocks: u32,
    args: *const (),
    interrupt: Option<&Interrupt>,
) -> Result<(), Error> {
    // SAFETY: the caller's promise.
    emulator.run::<E>(blocks, unsafe { &*args.cast::<E::Args>() }, interrupt)
}

/// Runs the kernel at that place of the table.
///
/// # Safety
/// As for [`Emulator::launch`].
///
/// # Panics
/// If another kernel is there.
pub unsafe fn launch<E: Entry>(
    emulator: &Emulator,
    place: usize,
    blocks: u32,
    args: &E::Args,
    interrupt: Option<&Interrupt>,
) -> Result<(), Error> {
    let (kernel, run) = all().0[place];
    assert_eq!(kernel, TypeId::of::<E>(), "{} has the place of another kernel", E::NAME);
    // SAFETY: the arguments are this kernel's, as just asserted; the rest is the caller's promise.
    unsafe { run(emulator, blocks, (args as *const E::Args).cast(), interrupt) }
}
