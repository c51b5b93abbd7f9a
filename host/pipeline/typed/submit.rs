//! Submitted queries: launches only, which a stream under capture can record. Their answers stay on
//! the device.

use super::TypedPipeline;
use super::query::QueryMemory;
use super::scene::SceneMemory;
use super::second::room;
use crate::contacts::{DeviceAnswer, DeviceExtras, DeviceList};
use crate::device::{Buffer, Replay};
use crate::error::Error;
use crate::pipeline::counts::{Counts, FrameCounters};
use crate::pipeline::extras::{Extras, Inputs, missing};
use crate::pipeline::layout::Offsets;
use crate::pipeline::placing::DeviceArrays;
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::Found;
use crate::pipeline::{launch, purpose};
use crate::scene::Pose;
use crate::stages::{Stage, Stages};
use nearmiss_kernels::abi::{Counter, FrameStatus, Room, Span, StatusAgainArgs, StatusArgs, seen};
use nearmiss_kernels::entry::{status_again, status_frame};

/// Memory of a submission, in addition to that of its queries.
pub struct Submission {
    /// The queries, in the order in which they run.
    pub queries: Vec<Submitted>,
    replay: Replay,
    /// Checks that are read if no memory of the caller is placed.
    unseen: Buffer<u64>,
}

/// A query that is submitted.
pub struct Submitted {
    /// Its index.
    pub query: usize,
    /// The room of every list that it fills.
    pub rooms: Buffer<Room>,
    /// The room of every list of its second pass, if it has one.
    again: Option<Buffer<Room>>,
    /// Status of its answer: whether it is whole, and its length.
    pub status: Buffer<FrameStatus>,
    /// Parts that are made on request.
    extras: Option<Extras>,
}

/// A pipeline that takes submissions.
pub trait Submits {
    /// Allocates a submission of queries that have each run a whole frame, and submits them once.
    /// From then on the lists do not grow until the next
    /// [`Pipeline::frame`](super::Pipeline::frame). Returns whether that submission had room for
    /// all. If not, its lists have grown, it is not prepared, and each query needs another frame.
    /// Answers that can have them get the `wanted` parts.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if a walk needs the host, if the last placing read host memory, or
    /// if no answer can have a wanted part. [`Error::OutOfMemory`] and [`Error::AnswerTooLarge`] if a list could not grow.
    /// Device errors. It is not prepared then.
    fn prepare(&mut self, queries: &[usize], wanted: &DeviceExtras) -> Result<bool, Error>;
    /// Returns whether it is prepared.
    fn is_prepared(&self) -> bool;
    /// Submits the queries: positions are read again from the same addresses.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if it is not prepared; device errors.
    fn submit(&mut self) -> Result<(), Error>;
    /// Returns the answer of a query in the last submission. `None` if it is not prepared, or if a
    /// list had too little room: that list has grown, and it is no longer prepared. Waits.
    ///
    /// # Errors
    /// Device errors.
    fn collect(&mut self, query: usize) -> Result<Option<(Found<'_>, Stages)>, Error>;
    /// Returns the place of a query's answer; `None` if it is not submitted.
    fn answer(&self, query: usize) -> Option<DeviceAnswer>;
    /// Returns the poses of each body that were read from the caller's memory, at both ends or at
    /// the only one. Other bodies have default poses.
    ///
    /// # Errors
    /// Device errors.
    fn poses(&self) -> Result<Vec<Pose>, Error>;
}

/// Nothing is prepared that could be submitted.
pub fn not_prepared() -> Error {
    Error::InvalidArgument {
        what: "a submission that is not prepared".into(),
        advice: "call `prepare` first, and again after every other call that changes the detector".into(),
    }
}

impl<R: Precision> Submits for TypedPipeline<R> {
    fn poses(&self) -> Result<Vec<Pose>, Error> {
        // Those of instances are the last.
        self.scene.arrays().last().map_or(Ok(Vec::new()), DeviceArrays::poses)
    }

    fn prepare(&mut self, queries: &[usize], wanted: &DeviceExtras) -> Result<bool, Error> {
        let refused = |what: &str, advice: &str| {
            Err(Error::InvalidArgument { what: what.to_owned(), advice: advice.to_owned() })
        };
        for &query in queries {
            if let Err(why) = self.broad(query).without_host() {
                return refused(why, "use another traversal, or do not submit");
            }
        }
        if !self.scene.is_repeatable() {
            return refused(
                "a submission cannot read positions of the host",
                "give the positions of every moving body on the device",
            );
        }
        let device = self.scene.device.of(purpose::STATUS);
        let mut submitted = Vec::new();
        for &query in queries {
            if let Some(ordering) = self.queries[query].narrow.ordering() {
                ordering.prepare(&self.scene.device)?;
            }
            let own = &mut self.queries[query];
            let has_second = own.narrow.take_second(&self.scene.device, wanted.first_contacts)?;
            let rooms = device.upload(&own.rooms(&mut self.scene))?;
            let again = has_second.then(|| device.upload(&own.rooms_of_second())).transpose()?;
            let own = &self.queries[query];
            let rows = own.narrow.rows(own.counters.counters());
            let extras = rows.map(|rows| Extras::new(&self.scene.device, wanted, &own.layout, &rows));
            let extras = extras.transpose()?.flatten();
            submitted.push(Submitted { query, rooms, again, status: device.buffer(1)?, extras });
        }
        let made = submitted.iter().filter_map(|own| own.extras.as_ref());
        if let Some(part) = missing(wanted, &made.collect::<Vec<_>>()) {
            return refused(
                &format!("{part} in device memory, of queries that have none"),
                "prepare a near or a continuous query too, or leave this part out",
            );
        }
        let mut unseen = device.buffer(seen::COUNT as usize)?;
        unseen.clear()?;
        self.submission = Some(Submission { queries: submitted, replay: Replay::default(), unseen });
        // Once as it will be: the driver loads a kernel at its first launch. Its schedule may need
        // more room than that of the frames before.
        let whole = self.submit().and_then(|()| {
            let counts = queries.iter().map(|&query| self.whole(query));
            counts.collect::<Result<Vec<_>, _>>().map(|counts| counts.iter().all(Option::is_some))
        });
        if !matches!(whole, Ok(true)) {
            self.submission = None;
        }
        whole
    }

    fn is_prepared(&self) -> bool {
        self.submission.is_some()
    }

    fn submit(&mut self) -> Result<(), Error> {
        let submission = self.submission.as_mut().map(|submission| std::mem::take(&mut submission.replay));
        let mut replay = submission.ok_or_else(not_prepared)?;
        let device = self.scene.device.clone();
        // SAFETY: it launches and clears; it keeps the memory that it holds.
        let done = unsafe { replay.run(&device, |_| self.enqueue()) };
        self.submission.iter_mut().for_each(|submission| submission.replay = std::mem::take(&mut replay));
        done
    }

    fn collect(&mut self, query: usize) -> Result<Option<(Found<'_>, Stages)>, Error> {
        // The caller may have launched a recorded submission again.
        self.scene.device.changed();
        if self.submitted(query).is_none() {
            return Ok(None);
        }
        self.queries[query].read_ahead(&self.scene)?;
        let counters = match self.whole(query) {
            Ok(Some(counters)) => counters,
            // The frame that follows may need less memory, or divides into slices. Otherwise it
            // returns the error.
            Ok(None) | Err(Error::OutOfMemory { .. } | Error::AnswerTooLarge { .. }) => {
                self.submission = None;
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        let own = &mut self.queries[query];
        if own.demand.counted(&counters, &self.scene.device).is_err() {
            // As above.
            self.submission = None;
            return Ok(None);
        }
        own.last.clone_from(&counters);
        own.gather(&self.scene, counters, 0).map(|found| Some((found, Stages::default())))
    }

    fn answer(&self, query: usize) -> Option<DeviceAnswer> {
        let (submitted, own) = (self.submitted(query)?, &self.queries[query]);
        let lists = own.narrow.answer(&self.scene.features);
        let list = |&(address, room): &(u64, usize)| DeviceList { address, room };
        let starts = own.layout.starts.iter().map(Offsets::starts);
        let extras = submitted.extras.as_ref();
        Some(DeviceAnswer {
            geometry: extras.and_then(Extras::geometry),
            least_by_vertex: extras.and_then(Extras::least),
            grouped: extras.map_or(Vec::new(), Extras::groups),
            entries: lists.entries,
            lists: lists.lists.iter().map(list).collect(),
            is_ordered: lists.is_ordered,
            status: submitted.status.span().addr(),
            earliest: lists.earliest,
            edges: DeviceList { address: lists.edges.addr(), room: lists.edges.len() as usize },
            starts: starts.collect(),
        })
    }
}

impl<R: Precision> TypedPipeline<R> {
    fn submitted(&self, query: usize) -> Option<&Submitted> {
        self.submission.iter().flat_map(|submission| &submission.queries).find(|own| own.query == query)
    }

    /// Returns the counters of a submitted query, if every list had room; otherwise the lists have
    /// grown. Waits.
    ///
    /// # Errors
    /// Those of [`QueryMemory::grow_all`]: some lists are still too short. Device errors.
    fn whole(&mut self, query: usize) -> Result<Option<Counts>, Error> {
        let (own, scene) = (&mut self.queries[query], &mut self.scene);
        let counters = own.counters.read()?;
        let second = own.short_of_second()?;
        if second.is_none() && !own.has_overflowed(scene, &counters) {
            return Ok(Some(counters));
        }
        own.settled = false;
        own.grow_all(scene, &counters)?;
        second.map_or(Ok(()), |counts| own.grow_second(scene, &counts))?;
        Ok(None)
    }

    /// Launches the queries, after the placing, and the status of each.
    fn enqueue(&mut self) -> Result<(), Error> {
        let Some(submission) = &mut self.submission else { return Ok(()) };
        let scene = &mut self.scene;
        let [seen, posed] = scene.seen_words();
        let seen = [if seen.is_empty() { submission.unseen.span() } else { seen }, posed];
        scene.again()?;
        scene.is_submitting = true;
        let queries = &mut self.queries;
        let enqueued = submission.queries.iter_mut().try_for_each(|submitted| {
            let own = &mut queries[submitted.query];
            if !scene.vertices.is_ready(own.is_at_rest()) {
                scene.vertices.ready(&scene.device)?;
            }
            own.enqueue(scene, submitted, seen)
        });
        scene.is_submitting = false;
        enqueued
    }
}

impl<R: Precision> QueryMemory<R> {
    /// Returns the room of every list that a frame fills.
    pub(super) fn rooms(&mut self, scene: &mut SceneMemory<R>) -> Vec<Room> {
        let mut rooms: Vec<Room> = scene.lists_of_traversal(self.broad).iter().map(room).collect();
        for step in self.narrow_steps_at() {
            rooms.extend(self.narrow.lists(step, &mut scene.features).iter().map(room));
        }
        rooms.extend(self.narrow.ordered().iter().map(room));
        rooms
    }

    /// Launches a frame, and its status.
    fn enqueue(
        &mut self,
        scene: &mut SceneMemory<R>,
        submitted: &mut Submitted,
        [seen, posed]: [Span<u64>; 2],
    ) -> Result<(), Error> {
        let growth = self.growth(scene);
        scene.broads[self.broad].phase.set_growth(growth);
        scene.device.beside(|| self.counters.clear())?;
        [Stage::Fit, Stage::Refit].into_iter().try_for_each(|stage| self.run(scene, stage))?;
        scene.device.join();
        self.clear_order(scene)?;
        [Stage::Traverse, Stage::Narrow].into_iter().try_for_each(|stage| self.run(scene, stage))?;
        scene.device.join();
        self.run(scene, Stage::Order)?;
        self.second(scene)?;
        let (lists, all) = (self.narrow.answer(&scene.features), self.counters.counters());
        if let (Some(extras), Some(rows)) = (&mut submitted.extras, self.narrow.rows(all)) {
            let ((frames, _, faces), edges) = (scene.positions_of(self), lists.edges);
            extras.run::<R>(&Inputs { device: &scene.device, rows, frames, faces, edges })?;
        }
        let count = |which: Option<&Counter>| which.map_or(Span::EMPTY, |&which| all.word(which));
        let args = StatusArgs {
            counters: all,
            rooms: submitted.rooms.span(),
            seen,
            posed,
            status: submitted.status.span(),
            first: count(lists.counters.first()),
            second: count(lists.counters.get(1)),
            crossing: count(lists.crossing.as_ref()),
        };
        match &submitted.again {
            Some(rooms) => {
                let counters = self.narrow.counters_of_second().map_or(all, FrameCounters::counters);
                let args = StatusAgainArgs { frame: args, counters, rooms: rooms.span() };
                launch::blocks::<status_again>(&scene.device, 1, &args)
            }
            None => launch::blocks::<status_frame>(&scene.device, 1, &args),
        }
    }
}
