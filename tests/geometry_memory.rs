//! Geometry of contacts takes memory, which is checked before it is taken. The only test of its
//! process, whose memory it limits.
#![cfg(target_os = "linux")]

use nearmiss::mesh::Positions;
use nearmiss::query::Near;
use nearmiss::{Body, Error, Mesh};
use nearmiss_lab::OneQuery;
use support::engine;

#[repr(C)]
struct Limit {
    soft: u64,
    hard: u64,
}

unsafe extern "C" {
    fn getrlimit(what: i32, limit: *mut Limit) -> i32;
    fn setrlimit(what: i32, limit: *const Limit) -> i32;
}

/// The addresses that a process may use.
const ADDRESSES: i32 = 9;

/// Does something that may take no more than so many bytes.
fn within<T>(bytes: u64, ask: impl FnOnce() -> T) -> T {
    let status = std::fs::read_to_string("/proc/self/status").expect("a status");
    let size = status.lines().find_map(|line| line.strip_prefix("VmSize:")).expect("a size");
    let held: u64 = size.split_whitespace().next().and_then(|k| k.parse().ok()).expect("kilobytes");
    let mut before = Limit { soft: 0, hard: 0 };
    // SAFETY: the limits are there while they are read and written; the soft one may be any up to the hard one.
    unsafe {
        assert_eq!(getrlimit(ADDRESSES, &mut before), 0);
        assert_eq!(setrlimit(ADDRESSES, &Limit { soft: (held << 10) + bytes, hard: before.hard }), 0);
    }
    let asked = ask();
    // SAFETY: as above.
    assert_eq!(unsafe { setrlimit(ADDRESSES, &before) }, 0);
    asked
}

#[test]
fn geometry_without_memory_is_refused() {
    let n = 120;
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].repeat(n);
    let faces = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh::new("equal triangles", Positions::F32(corners), faces).expect("a mesh");
    let mut detector =
        OneQuery::new(engine(), Body::deformable(mesh), Near::within(0.1)).expect("a detector");
    let found = detector.detect().expect("an answer");
    assert_eq!(found.len(), 15 * n * (n - 1) / 2);
    assert_eq!(detector.geometry(&found).expect("room").len(), found.len());
    let refused = within(8 << 20, || detector.geometry(&found));
    let Err(Error::OutOfMemory { what, asked, given }) = refused else { panic!("not refused") };
    assert!(
        what == "geometry of contacts" && asked > 16 << 20 && given <= 8 << 20,
        "{what}: {asked} of {given}"
    );
    assert_eq!(detector.geometry(&found).expect("room again").len(), found.len());
}
