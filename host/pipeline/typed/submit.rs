//! A frame that is submitted and not waited for: launches alone, that a stream which is being captured takes, and an answer that
//! stays on the device.

use super::TypedPipeline;
use crate::contacts::{DeviceAnswer, DeviceList};
use crate::device::{Buffer, Replay};
use crate::error::Error;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::Found;
use crate::pipeline::{launch, purpose};
use crate::scene::Pose;
use crate::stages::{Stage, Stages};
use nearmiss_kernels::abi::{Counter, FrameStatus, Room, Span, StatusArgs, seen};
use nearmiss_kernels::entry::status_frame;

/// What such a frame needs beside what every frame has.
pub struct Submission {
    /// Every list that a frame fills.
    pub rooms: Buffer<Room>,
    /// What it came to.
    pub status: Buffer<FrameStatus>,
    /// What it launches.
    replay: Replay,
    /// Where nothing of the caller's memory is placed.
    unseen: Buffer<u64>,
}

/// A pipeline that can be submitted to.
pub trait Submits {
    /// Takes what a submission needs, once a frame has run whole: from then on the lists do not grow until one is asked for with
    /// [`Pipeline::frame`](super::Pipeline::frame).
    ///
    /// # Errors
    /// [`Error::Choice`] where the walk cannot do without the host, and where the host's positions were placed last; those of the
    /// device.
    fn prepare(&mut self) -> Result<(), Error>;
    /// Whether it is prepared.
    fn is_prepared(&self) -> bool;
    /// Submits a frame: where bodies are is read again from where it lay.
    ///
    /// # Errors
    /// [`Error::Choice`] when it is not prepared; those of the device.
    fn submit(&mut self) -> Result<(), Error>;
    /// What the last submission found; `None` where a list had too little room. Waits.
    ///
    /// # Errors
    /// Those of the device.
    fn collect(&mut self) -> Result<Option<(Found<'_>, Stages)>, Error>;
    /// Where it is.
    fn answer(&self) -> Option<DeviceAnswer>;
    /// Poses that were found in memory of the caller, at both ends or at the only one, of each body; others are none.
    ///
    /// # Errors
    /// Those of the device.
    fn poses(&self) -> Result<Vec<Pose>, Error>;
}

impl<R: Precision> Submits for TypedPipeline<R> {
    fn poses(&self) -> Result<Vec<Pose>, Error> {
        self.vertices.poses()
    }

    fn prepare(&mut self) -> Result<(), Error> {
        let refused = |what: &str, advice: &str| {
            Err(Error::Choice { what: what.to_owned(), advice: advice.to_owned() })
        };
        if let Err(why) = self.broad.without_host() {
            return refused(why, "ask for another traversal, or for frames that wait");
        }
        if !self.vertices.is_repeatable() {
            return refused(
                "a submission that reads positions of the host",
                "give every body that moves by what lies on the device",
            );
        }
        let room =
            |list: &&mut dyn GrowableOutput| Room { entries: list.room(), counter: list.counter(), pad: 0 };
        let mut rooms: Vec<Room> = self.broad.lists().iter().map(room).collect();
        rooms.push(room(&(&mut self.pairs as &mut dyn GrowableOutput)));
        for step in self.narrow_steps_at() {
            rooms.extend(self.narrow.lists(step).iter().map(room));
        }
        rooms.extend(self.narrow.ordered().iter().map(room));
        let device = self.device.of(purpose::STATUS);
        let mut unseen = device.buffer(seen::COUNT as usize)?;
        unseen.clear()?;
        let (rooms, status) = (device.upload(&rooms)?, device.buffer(1)?);
        self.submission = Some(Submission { rooms, status, replay: Replay::default(), unseen });
        // Once as it will be: the driver loads a kernel when it is first launched.
        self.submit()
    }

    fn is_prepared(&self) -> bool {
        self.submission.is_some()
    }

    fn submit(&mut self) -> Result<(), Error> {
        let submission = self.submission.as_mut().map(|submission| std::mem::take(&mut submission.replay));
        let mut replay = submission.ok_or_else(|| Error::Choice {
            what: "a submission that is not prepared".into(),
            advice: "call `prepare` first, and again after every other call that changes the detector".into(),
        })?;
        let device = self.device.clone();
        // SAFETY: it launches and clears; what memory it holds it keeps.
        let done = unsafe { replay.run(&device, |_| self.enqueue()) };
        self.submission.iter_mut().for_each(|submission| submission.replay = std::mem::take(&mut replay));
        done
    }

    fn collect(&mut self) -> Result<Option<(Found<'_>, Stages)>, Error> {
        // The caller may have launched a recorded submission again.
        self.device.changed();
        self.read_ahead()?;
        let counters = self.counters.read()?;
        if self.has_overflowed(&counters) {
            self.settled = false;
            return Ok(None);
        }
        self.last.clone_from(&counters);
        self.gather(counters, 0).map(|found| Some((found, Stages::default())))
    }

    fn answer(&self) -> Option<DeviceAnswer> {
        let submission = self.submission.as_ref()?;
        let lists = self.narrow.answer();
        let list = |&(address, room): &(u64, usize)| DeviceList { address, room };
        let starts = self.layout.starts.iter().map(|at| [at.vertex, at.triangle, at.edge]);
        Some(DeviceAnswer {
            entries: lists.entries,
            lists: lists.lists.iter().map(list).collect(),
            is_ordered: lists.is_ordered,
            status: submission.status.span().addr(),
            earliest: lists.earliest,
            edges: DeviceList { address: lists.edges.addr(), room: lists.edges.len() as usize },
            starts: starts.collect(),
        })
    }
}

impl<R: Precision> TypedPipeline<R> {
    /// Launches a frame, behind the placing of what it places, and what tells how it went.
    fn enqueue(&mut self) -> Result<(), Error> {
        let Some(submission) = &self.submission else { return Ok(()) };
        let seen = self.vertices.seen_span();
        let seen = if seen.is_empty() { submission.unseen.span() } else { seen };
        let (rooms, status) = (submission.rooms.span(), submission.status.span());
        self.vertices.again(&self.device)?;
        self.counters.clear()?;
        [Stage::Fit, Stage::Refit, Stage::Traverse, Stage::Narrow, Stage::Order]
            .into_iter()
            .try_for_each(|stage| self.run(stage))?;
        let (lists, all) = (self.narrow.answer(), self.counters.counters());
        let count = |which: Option<&Counter>| which.map_or(Span::EMPTY, |&which| all.word(which));
        let args = StatusArgs {
            counters: all,
            rooms,
            seen,
            status,
            first: count(lists.counters.first()),
            second: count(lists.counters.get(1)),
            crossing: count(lists.crossing.as_ref()),
        };
        launch::blocks::<status_frame>(&self.device, 1, &args)
    }
}
