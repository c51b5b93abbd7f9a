//! Free memory of the machine, for callers that check it before a large allocation.
//!
//! An allocation that fails ends a program without a message. On Linux an allocation without memory
//! behind it does not even fail: the system ends the process later.

use crate::error::Error;
use std::fs::read_to_string;

/// Smallest size that is checked, in bytes.
const LITTLE: u64 = 16 << 20;

/// Refuses an allocation that exceeds the free memory, before it is made. A few megabytes are never
/// refused, and nothing is if the system does not report its free memory.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub fn require(what: &str, bytes: u64) -> Result<(), Error> {
    match (bytes >= LITTLE).then(free).flatten() {
        Some(given) if bytes > given => Err(Error::OutOfMemory { what: what.into(), asked: bytes, given }),
        _ => Ok(()),
    }
}

/// Bytes that this program may still allocate. The least of the machine's free memory, its control
/// group's limit and its own address space counts. `None` if the system reports none of these.
pub fn free() -> Option<u64> {
    let ways = [
        ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current", "/sys/fs/cgroup/memory.stat"],
        [
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.usage_in_bytes",
            "/sys/fs/cgroup/memory/memory.stat",
        ],
    ];
    let group = ways.iter().filter_map(|files| {
        let [limit, used, parts] = files.map(|file| read_to_string(file).unwrap_or_default());
        of_group(&limit, &used, &parts)
    });
    let process = read_to_string("/proc/self/limits").ok().and_then(|limits| {
        let status = read_to_string("/proc/self/status").ok()?;
        of_process(&limits, &status)
    });
    machine().into_iter().chain(group).chain(process).min()
}

/// Free memory of the machine.
#[cfg(not(windows))]
fn machine() -> Option<u64> {
    read_to_string("/proc/meminfo").ok().and_then(|text| kilobytes(&text, "MemAvailable:"))
}

/// Free memory of the machine. An allocation also needs room in the page file.
#[cfg(windows)]
fn machine() -> Option<u64> {
    use windows_sys::Win32::System::SystemInformation::{GlobalMemoryStatusEx, MEMORYSTATUSEX};
    let mut status = MEMORYSTATUSEX { dwLength: size_of::<MEMORYSTATUSEX>() as u32, ..Default::default() };
    // SAFETY: the structure is ours and has its length.
    let is_known = unsafe { GlobalMemoryStatusEx(&mut status) } != 0;
    is_known.then_some(status.ullAvailPhys.min(status.ullAvailPageFile))
}

/// The number after `name` in a text of lines `name number kB`, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(name))?;
    value.split_whitespace().next()?.parse::<u64>().ok().map(|k| k.saturating_mul(1024))
}

/// Bytes that a group of processes has left of its limit. Pages of files that can be dropped are
/// not in use.
fn of_group(limit: &str, used: &str, parts: &str) -> Option<u64> {
    let [limit, used] = [limit, used].map(|text| text.trim().parse::<u64>().ok());
    let dropped = parts.lines().find_map(|line| line.strip_prefix("inactive_file "));
    let dropped = dropped.and_then(|bytes| bytes.parse().ok()).unwrap_or(0);
    Some(limit?.saturating_sub(used?.saturating_sub(dropped)))
}

/// Bytes that a process has left of its address space.
fn of_process(limits: &str, status: &str) -> Option<u64> {
    let row = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = row.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(kilobytes(status, "VmSize:")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_tells_is_read() {
        let meminfo = "MemTotal:       100 kB\nMemAvailable:    40 kB\n";
        assert_eq!(kilobytes(meminfo, "MemAvailable:"), Some(40 << 10));
        assert_eq!(kilobytes(meminfo, "Swap:"), None);
        assert_eq!(of_group("1000\n", "700\n", "active_file 9\ninactive_file 100\n"), Some(400));
        assert_eq!(of_group("max\n", "700\n", ""), None);
        assert_eq!(of_group("", "", ""), None);
        let limits = |of| format!("Limit  Soft Hard\nMax address space   {of}   unlimited   bytes\n");
        assert_eq!(of_process(&limits("4096"), "VmPeak: 9 kB\nVmSize:\t1 kB\n"), Some(3072));
        assert_eq!(of_process(&limits("unlimited"), "VmSize:\t1 kB\n"), None);
    }

    #[test]
    fn more_than_there_is_is_refused() {
        require("a little", LITTLE - 1).expect("never refused");
        if let Some(free) = free() {
            assert!(free > 0);
            let error = require("too much", u64::MAX).expect_err("no machine has it");
            assert!(error.exit_code() == 4 && error.to_string().starts_with("too much: "), "{error}");
        }
    }
}
