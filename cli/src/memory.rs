//! Host memory that ends. Allocations that a user can make large are checked before
//! (`nearmiss::memory`). All others would abort the program; here it ends with a message and an
//! exit status.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;

/// The system's memory. If it ends, so does the program, with status 4.
pub struct Memory;

#[global_allocator]
static MEMORY: Memory = Memory;

// SAFETY: all that is handed on is the system's own, unchanged.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract, which is the same.
        some(unsafe { System.alloc(layout) }, layout.size())
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        some(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }
    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        some(unsafe { System.realloc(old, layout, size) }, size)
    }
    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(old, layout) }
    }
}

fn some(start: *mut u8, bytes: usize) -> *mut u8 {
    if start.is_null() {
        ended(bytes);
    }
    start
}

/// Says so, without taking memory for it.
#[cold]
fn ended(bytes: usize) -> ! {
    let _ = writeln!(
        std::io::stderr(),
        "nearmiss: host memory: {bytes} bytes were needed and not free; use a smaller scene or a larger machine"
    );
    std::process::exit(4)
}
