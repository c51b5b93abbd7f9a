//! A forked process has none of the threads: calls return an error instead of waiting for ever.
#![cfg(target_os = "linux")]

use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::query::{Discrete, Near};
use nearmiss::scene::{Motion, Scene};
use nearmiss::{Body, Detector, Device, Error, Mesh};
use nearmiss_lab::OneQuery;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

unsafe extern "C" {
    fn fork() -> i32;
    fn alarm(seconds: u32) -> u32;
    fn waitpid(process: i32, status: *mut i32, options: i32) -> i32;
    fn _exit(status: i32) -> !;
}

/// The signal of an alarm.
const WAITED: i32 = 14;

/// Exit of a fork that runs this: 0 if it is true; [`WAITED`] if there is no result after so many
/// seconds.
fn forked(seconds: u32, is_so: impl FnOnce() -> bool) -> i32 {
    // SAFETY: the fork has this thread alone, runs what needs no other or is ended by the alarm, and leaves without what others would do at
    // an exit; the status is there while it is waited for.
    unsafe {
        let child = fork();
        if child == 0 {
            alarm(seconds);
            let is_so = catch_unwind(AssertUnwindSafe(is_so)).unwrap_or(false);
            _exit(i32::from(!is_so));
        }
        let mut status = 0;
        assert_eq!(waitpid(child, &mut status, 0), child);
        status
    }
}

fn scene() -> Scene {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].repeat(2);
    let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]]);
    Body::deformable(mesh.expect("a mesh")).into()
}

fn is_told<T>(asked: Result<T, Error>) -> bool {
    let Err(Error::InvalidArgument { what, advice }) = asked else { return false };
    what.contains("forked") && advice.contains("spawn")
}

// One test: which process starts threads first is the question.
#[test]
fn a_fork_is_told_that_it_has_no_threads() {
    let open = |threads| Device::open(Backend::Cpu, threads);
    let new = |device| OneQuery::new(device, scene(), Near::within(0.5));
    // Before anything has started it is a process like any other.
    let whole = || new(open(Some(2))?)?.detect();
    assert_eq!(forked(60, || whole().is_ok_and(|found| found.len() == 15)), 0);

    let device = open(Some(2)).expect("a device");
    assert_eq!(forked(60, || is_told(new(device.clone()))), 0, "a device from before");
    let mut all = Detector::new(device.clone(), scene()).expect("a detector");
    let pairs = all.query(&Discrete::default()).expect("an answer");
    let mut own = new(device).expect("a detector");
    let found = own.detect().expect("an answer");
    let id = own.scene().ids().next().expect("a body");
    let at = Positions::F32([[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].repeat(2));
    assert_eq!(forked(60, || is_told(open(None)) && is_told(open(Some(2)))), 0);
    assert_eq!(forked(60, || is_told(own.detect())), 0);
    assert_eq!(forked(60, || is_told(own.frame(&[(id, Motion::positions(&at))]))), 0);
    assert_eq!(forked(60, || is_told(own.update(&[(id, Motion::positions(&at))]))), 0);
    assert_eq!(forked(60, || is_told(own.geometry(&found))), 0);
    assert_eq!(forked(60, || is_told(all.geometry(&pairs))), 0);
    assert_eq!(forked(60, || is_told(own.rebuild()) && is_told(own.fingerprints())), 0);
    assert_eq!(forked(60, || is_told(own.narrow_steps()) && is_told(own.plan())), 0);
    own.prepare(&[]).expect("prepared");
    assert_eq!(forked(60, || is_told(own.submit()) && is_told(own.collect())), 0);
    // The answer is there, and the process itself goes on.
    assert_eq!(forked(60, || found.len() == 15), 0);
    assert_eq!(own.detect().expect("an answer").rows, found.rows);

    // The same without the check.
    assert_eq!(forked(1, || (0..1000).into_par_iter().map(|i| i % 2).sum::<i32>() == 500), WAITED);
}
