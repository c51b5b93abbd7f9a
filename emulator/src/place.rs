//! Cores that threads run on. Linux may wake a helper on the core of its launcher, though another
//! one is idle: a virtual machine's takes idle cores for those that its host has taken away.

/// No core's number.
pub const UNKNOWN: usize = usize::MAX;

#[cfg(target_os = "linux")]
mod system {
    use super::UNKNOWN;
    use libc::{CPU_CLR, CPU_COUNT, CPU_SETSIZE, cpu_set_t};
    use libc::{sched_getaffinity, sched_getcpu, sched_setaffinity};

    /// Size of a set of cores.
    const SIZE: usize = size_of::<cpu_set_t>();
    /// The calling thread.
    const OWN: libc::pid_t = 0;

    /// The core that this thread runs on now.
    pub fn core() -> usize {
        // SAFETY: it takes nothing.
        usize::try_from(unsafe { sched_getcpu() }).unwrap_or(UNKNOWN)
    }

    /// The cores that this thread may run on.
    pub fn cores() -> Option<cpu_set_t> {
        // SAFETY: a set is an array of integers.
        let mut cores = unsafe { std::mem::zeroed() };
        // SAFETY: the set is of this size, and lives until the call has ended.
        let error = unsafe { sched_getaffinity(OWN, SIZE, &mut cores) };
        (error == 0).then_some(cores)
    }

    /// Lets this thread run on these cores only.
    fn limit(cores: &cpu_set_t) {
        // SAFETY: the set is of this size, and lives until the call has ended.
        unsafe { sched_setaffinity(OWN, SIZE, cores) };
    }

    /// The set without this core, if that leaves one.
    fn without(core: usize, mut cores: cpu_set_t) -> Option<cpu_set_t> {
        if core >= CPU_SETSIZE as usize {
            return None;
        }
        // SAFETY: the set has this core's bit.
        unsafe { CPU_CLR(core, &mut cores) };
        // SAFETY: it reads the set alone.
        let left = unsafe { CPU_COUNT(&cores) };
        (left > 0).then_some(cores)
    }

    /// Moves this thread away from this core, if it is there and may run on another one. Later it
    /// may run where it did before. Errors of the system are ignored: the thread only stays.
    pub fn leave(core: usize) {
        if core != self::core() {
            return;
        }
        let Some(own) = cores() else { return };
        if let Some(others) = without(core, own) {
            limit(&others);
            limit(&own);
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod system {
    /// Only Linux is known to need it.
    pub fn core() -> usize {
        super::UNKNOWN
    }

    pub fn leave(_: usize) {}
}

pub use system::{core, leave};

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    /// The numbers of the cores that this thread may run on.
    fn cores() -> Vec<usize> {
        let cores = system::cores().expect("cores");
        let all = 0..libc::CPU_SETSIZE as usize;
        // SAFETY: the set has a bit for each of these.
        all.filter(|&core| unsafe { libc::CPU_ISSET(core, &cores) }).collect()
    }

    #[test]
    fn a_thread_moves_and_may_run_where_it_did() {
        let before = cores();
        // The system may move the thread back at once, so one of many tries counts.
        let moves = (0..100).any(|_| {
            let from = core();
            leave(from);
            assert_eq!(cores(), before);
            core() != from
        });
        assert_eq!(moves, before.len() > 1);
    }

    #[test]
    fn a_thread_that_is_elsewhere_stays() {
        let before = cores();
        leave(UNKNOWN);
        assert_eq!(cores(), before);
    }
}
