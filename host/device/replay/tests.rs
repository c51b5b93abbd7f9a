//! Replays, refusals and events.

use super::*;
use crate::device::Buffer;
use crate::device::emulator::{Emulator, Mode};
use nearmiss_kernels::abi::{Counters, FrameStatus, Room, Span, StatusArgs, counter, seen};
use nearmiss_kernels::entry::status_frame;

fn engine() -> Device {
    Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"))
}

/// Memory that a small launch writes.
struct Memory {
    counters: Buffer<u64>,
    rooms: Buffer<Room>,
    seen: Buffer<u64>,
    status: [Buffer<FrameStatus>; 2],
}

impl Memory {
    fn of(device: &Device) -> Memory {
        let words = |count| device.buffer(count).expect("memory");
        let status = [(); 2].map(|()| device.buffer(1).expect("memory"));
        Memory {
            counters: words(counter::COUNT),
            rooms: device.buffer(0).expect("none"),
            seen: words(seen::COUNT as usize),
            status,
        }
    }

    fn launch(&self, device: &Device, which: usize) -> Result<(), Error> {
        let args = StatusArgs {
            counters: Counters::new(self.counters.span()),
            rooms: self.rooms.span(),
            seen: self.seen.span(),
            posed: Span::EMPTY,
            status: self.status[which].span(),
            first: Span::EMPTY,
            second: Span::EMPTY,
            crossing: Span::EMPTY,
        };
        // SAFETY: buffers of this device that outlive the launch; no list, and capacity for all
        // counts.
        unsafe { device.launch::<status_frame>(1, &args) }
    }
}

type Frame = fn(&Device, &mut Memory, &mut Marks, u32) -> Result<(), Error>;

/// Runs frames in sequence; returns how many were replays.
fn replays(frame: Frame) -> u64 {
    let device = engine();
    let (mut memory, mut replay) = (Memory::of(&device), Replay::new(&device, 2).expect("marks"));
    for round in 0..4 {
        let work = |marks: &mut Marks| frame(&device, &mut memory, marks, round);
        // SAFETY: the memory outlives all frames.
        unsafe { replay.run(&device, work) }.expect("a frame");
    }
    device.replays()
}

#[test]
fn what_is_the_same_is_done_at_once_and_nothing_else() {
    let same = replays(|device, memory, marks, _| {
        memory.counters.clear()?;
        marks.pass(0)?;
        memory.launch(device, 0)?;
        marks.pass(1)
    });
    assert_eq!(same, 3);
    let faults: [Frame; 5] = [
        // Other arguments.
        |device, memory, _, round| memory.launch(device, round as usize % 2),
        // More launches.
        |device, memory, _, round| (0..round).try_for_each(|_| memory.launch(device, 0)),
        // Another byte.
        |_, memory, _, round| memory.counters.fill(round as u8),
        // Another buffer.
        |_, memory, _, round| memory.status[round as usize % 2].clear(),
        // Another mark.
        |_, _, marks, round| marks.pass(round as usize % 2),
    ];
    // The first frame is never a replay. An empty frame equals the state before the first one.
    assert_eq!(faults.map(replays), [0, 1, 0, 0, 0]);
}

#[test]
fn what_does_more_than_launch_is_refused_and_the_next_frame_is_none_the_worse() {
    let device = engine();
    let (memory, mut replay) = (Memory::of(&device), Replay::default());
    for _ in 0..2 {
        // SAFETY: nothing is launched.
        let error =
            unsafe { replay.run(&device, |_| device.buffer::<u32>(1).map(drop)) }.expect_err("memory");
        assert!(error.to_string().contains("in a frame that only launches"), "{error}");
        // SAFETY: the memory outlives the frame.
        unsafe { replay.run(&device, |_| memory.launch(&device, 0)) }.expect("a frame");
    }
    assert_eq!(device.replays(), 1);
    device.buffer::<u32>(1).expect("nothing is listed any more");
}

#[test]
fn marks_tell_the_time_between_them() {
    let device = engine();
    let mut replay = Replay::new(&device, 2).expect("marks");
    let pass = |marks: &mut Marks| {
        marks.pass(0)?;
        std::thread::sleep(std::time::Duration::from_millis(2));
        marks.pass(1)
    };
    for _ in 0..2 {
        // SAFETY: nothing is launched.
        unsafe { replay.run(&device, pass) }.expect("marks");
        assert!(replay.ms(0, 1).expect("a time") >= 2.0);
    }
}

/// Work of other threads on the device is neither refused nor listed meanwhile. Another device of
/// this thread is not restricted.
#[test]
fn a_thread_is_held_alone_and_on_one_device() {
    let (device, other) = (engine(), engine());
    let (memory, mut replay) = (Memory::of(&device), Replay::default());
    for round in 0..3 {
        let work = |_: &mut Marks| {
            memory.launch(&device, 0)?;
            std::thread::scope(|scope| {
                let there = || {
                    let own = Memory::of(&device);
                    // Different work in each round.
                    (0..round).try_for_each(|_| own.launch(&device, 1))
                };
                scope.spawn(there).join().expect("no panic")
            })?;
            other.buffer::<u32>(1 + round).map(drop)
        };
        // SAFETY: the memory outlives this thread's launches on it.
        unsafe { replay.run(&device, work) }.expect("a frame");
    }
    assert_eq!(device.replays(), 2);
}

/// Work with two parts aside, and perhaps a flag between them that later work comes after.
fn branches(device: &Device, memory: &Memory, [flag, join_flag]: [bool; 2]) -> Result<(), Error> {
    device.beside(|| memory.launch(device, 0))?;
    if flag {
        device.flag();
    }
    device.beside(|| memory.launch(device, 1))?;
    memory.launch(device, 0)?;
    if join_flag {
        device.join_flag();
    }
    memory.launch(device, 1)?;
    device.join();
    Ok(())
}

/// A CPU does branches in their turn: where they part and meet is no part of its work.
#[test]
fn a_cpu_does_branches_in_turn() {
    let frames: [Frame; 4] = [
        |device, memory, _, _| branches(device, memory, [true, true]),
        |device, memory, _, round| branches(device, memory, [round % 2 == 0, true]),
        |device, memory, _, round| branches(device, memory, [true, round % 2 == 0]),
        |device, memory, _, round| branches(device, memory, [round % 2 == 0; 2]),
    ];
    assert_eq!(frames.map(replays), [3; 4]);
}

/// A GPU has a list of the steps at which branches part and meet. Another step is another list.
#[test]
fn branches_are_the_same_work_if_they_part_and_meet_at_the_same_steps() {
    let list = |acts: &[Act]| {
        let mut list = Listing::default();
        acts.iter().for_each(|&act| list.push(act));
        list
    };
    let all = [Act::Aside, Act::Back, Act::Flag, Act::Aside, Act::Back, Act::JoinFlag, Act::Join];
    assert_eq!(list(&all), list(&all));
    for left_out in 0..all.len() {
        let others: Vec<Act> = (0..all.len()).filter(|&at| at != left_out).map(|at| all[at]).collect();
        assert_ne!(list(&others), list(&all), "{:?}", all[left_out]);
    }
    assert_eq!(list(&all).acts().map(|(act, _)| act).collect::<Vec<_>>(), all);
}
