//! The status of a submission on the device; faults are planted and must be noticed.

use super::*;
use crate::contacts::DeviceExtras;
use crate::device::emulator::{Emulator, Mode};
use crate::pipeline::Layout;
use crate::pipeline::list::List;
use crate::samples;
use nearmiss_kernels::abi::{Pair, Room, counter};

/// Returns a pipeline over a soup that has answered a frame, and its query.
fn answered(device: &Device) -> (TypedPipeline<f32>, usize) {
    let bodies = [samples::soup(300, 5, false)];
    let layout = Arc::new(Layout::new(&bodies, Query::discrete().kind()));
    let query = Query::discrete();
    let (mut pipeline, at) = one(device, &bodies, &layout, query);
    pipeline.place(&bodies, &[]).expect("nothing to place");
    pipeline.ready(at, &bodies).expect("ready");
    pipeline.frame(at).expect("a frame");
    (pipeline, at)
}

/// A list of pairs that has too little room for a frame.
fn short(device: &Device) -> List<Pair> {
    List::new(device, "candidate triangle pairs", counter::PAIRS, 3).expect("memory")
}

/// The same, prepared. Then its list of pairs gets too little room, which the status must show.
fn prepared(device: &Device) -> TypedPipeline<f32> {
    let (mut pipeline, at) = answered(device);
    assert!(pipeline.prepare(&[at], &DeviceExtras::default()).expect("prepared"));
    pipeline.scene.pairs = short(device);
    let rooms = device.upload(&pipeline.queries[at].rooms(&mut pipeline.scene)).expect("memory");
    pipeline.submission.as_mut().expect("prepared").queries[0].rooms = rooms;
    pipeline
}

/// A first submission without room, as on a schedule that needs more than that of the frame
/// before. Lists grow by its demand, and nothing is prepared until a frame has followed.
#[test]
fn a_preparation_whose_submission_is_short_is_none() {
    let device = engine();
    let (mut pipeline, at) = answered(&device);
    let demand = pipeline.scene.pairs.demand(&pipeline.queries[at].last);
    pipeline.scene.pairs = short(&device);
    assert!(!pipeline.prepare(&[at], &DeviceExtras::default()).expect("no error"));
    assert!(!pipeline.is_prepared() && pipeline.submit().is_err());
    assert!(pipeline.scene.pairs.capacity() as u64 >= demand);
    pipeline.frame(at).expect("a frame");
    assert!(pipeline.prepare(&[at], &DeviceExtras::default()).expect("prepared") && pipeline.is_prepared());
    assert_eq!(reported(&mut pipeline), (0, false));
}

/// A list for which there is no memory ends the preparation with that error. An error that is
/// dropped would end it as "lists are too short", after some rounds.
#[test]
fn a_preparation_without_memory_returns_the_error() {
    let device = engine();
    let (mut pipeline, at) = answered(&device);
    let demand = pipeline.scene.pairs.demand(&pipeline.queries[at].last);
    pipeline.scene.pairs = short(&device);
    // Enough for the status, but less than the list with its margin of an eighth.
    let limit = device.bytes().0 + demand * size_of::<Pair>() as u64;
    assert!(demand > 200, "{demand}");
    let limited = device.clone().with_memory_limit(limit);
    let error = pipeline.prepare(&[at], &DeviceExtras::default()).expect_err("no memory");
    assert!(matches!(error, Error::OutOfMemory { .. }), "{error}");
    assert!(!pipeline.is_prepared());
    let _ = limited.with_memory_limit(u64::MAX);
    pipeline.frame(at).expect("a frame");
    assert!(pipeline.prepare(&[at], &DeviceExtras::default()).expect("prepared") && pipeline.is_prepared());
}

/// A list that a submission found too short has grown when `collect` says so.
#[test]
fn a_short_submission_grows_its_lists_and_ends_the_preparation() {
    let device = engine();
    let mut pipeline = prepared(&device);
    let demand = pipeline.scene.pairs.demand(&pipeline.queries[0].last);
    assert_eq!(reported(&mut pipeline), (1, true));
    assert!(pipeline.scene.pairs.capacity() as u64 >= demand && !pipeline.is_prepared());
}

fn engine() -> Device {
    Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"))
}

/// Returns how many lists a submission reports as too short, and whether the host reports any.
fn reported(pipeline: &mut TypedPipeline<f32>) -> (u64, bool) {
    pipeline.submit().expect("submitted");
    let status = pipeline.submission.as_ref().expect("prepared").queries[0].status.read(1).expect("read");
    (status[0].short, pipeline.collect(0).expect("counters").is_none())
}

#[test]
fn a_list_without_room_is_told_on_the_device() {
    assert_eq!(reported(&mut prepared(&engine())), (1, true));
}

/// If a list's room is wrong, device and host disagree.
#[test]
fn a_room_that_is_not_there_is_noticed() {
    let mut pipeline = prepared(&engine());
    let rooms = &mut pipeline.submission.as_mut().expect("prepared").queries[0].rooms;
    let mut wrong = rooms.read(rooms.len()).expect("read");
    let pairs = wrong.iter_mut().find(|room| room.counter == counter::PAIRS).expect("a list of pairs");
    *pairs = Room { entries: u64::MAX, ..*pairs };
    rooms.write(&wrong).expect("written");
    assert_eq!(reported(&mut pipeline), (0, true));
}

/// A submission that allocates, reads, writes or marks the time is refused, and the call is named.
#[test]
fn a_submission_that_does_more_than_launch_is_noticed() {
    let device = engine();
    let mut buffer = device.upload(&[1u32, 2]).expect("memory");
    let only = device.launches_only();
    let refused = [
        device.buffer::<u32>(1).map(drop),
        buffer.write(&[3]),
        buffer.read(1).map(drop),
        buffer.view(1).map(drop),
        device.event().map(drop),
        device.read_ahead(&[buffer.ahead(1)]),
    ];
    for error in refused.map(|result| result.expect_err("refused").to_string()) {
        assert!(error.contains("in a frame that only launches"), "{error}");
    }
    buffer.clear().expect("a launch of its own kind");
    drop(only);
    assert_eq!(buffer.read(2).expect("read"), [0, 0]);
}
