//! Threads take turns at a detector and at its device, while the interpreter runs on.

use crate::answer::{Answer, typed};
use crate::asked::{Asked, Does};
use crate::borrowed::Held;
use crate::detector::Detector;
use crate::errors::{choice, raised};
use crate::frame::{Frame, Named, known, numbered};
use crate::watch::watched;
use nearmiss::Error;
use nearmiss::scene::BodyId;
use pyo3::prelude::*;
use serde::Serialize;
use std::sync::{MutexGuard, PoisonError};

impl Detector {
    /// Runs a call, in turn with all that share the device. A signal ends it.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        does: Does,
        call: impl FnOnce(&mut nearmiss::Detector) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let (done, unread) = self.work(py, |one| {
            one.count(does);
            (call(&mut one.detector), one.unread())
        })?;
        drop(unread);
        done.map_err(raised)
    }

    /// Works with the detector, in turn with all that share its device. A signal ends it.
    pub fn work<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Asked) -> T + Send) -> PyResult<T> {
        let turn = &self.device.get().turn;
        let done = watched(py, &self.interrupt, |watch| {
            let mut one = watch.lock(&self.one)?;
            let _turn = watch.lock(turn)?;
            watch.begins();
            Ok(work(&mut one))
        });
        done?.map_err(raised)
    }

    /// Runs a call that waits for an answer; `held` keeps the arrays that it reads.
    pub fn answer<'py>(
        &self,
        py: Python<'py>,
        does: Does,
        held: Vec<Held>,
        call: impl FnOnce(&mut nearmiss::Detector) -> Result<nearmiss::Contacts, Error> + Send,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (answer, stamp, unread) = self.work(py, |one| {
            one.count(does);
            let answer = call(&mut one.detector);
            let unread = one.read(held, answer.is_ok());
            (answer, one.stamp(), unread)
        })?;
        drop(unread);
        typed(py, answer.map_err(raised)?, stamp)
    }

    /// The answer to a query, of the bodies where they are.
    pub fn answer_to<'py>(&self, py: Python<'py>, query: nearmiss::Query) -> PyResult<Bound<'py, PyAny>> {
        self.answer(py, Does::Queries, Vec::new(), |detector| detector.query(&query))
    }

    /// Works with an answer of this detector, of the bodies where they are.
    pub fn work_of<T: Send>(
        &self,
        py: Python<'_>,
        answer: &Answer,
        work: impl FnOnce(&mut nearmiss::Detector, &nearmiss::Contacts) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let done = self.work(py, |one| {
            one.check(answer.stamp)?;
            work(&mut one.detector, &answer.contacts)
        })?;
        done.map_err(raised)
    }

    /// Looks at the detector.
    pub fn look<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&nearmiss::Detector) -> T + Send,
    ) -> PyResult<T> {
        self.look_at(py, |one| look(&one.detector))
    }

    /// The same, with what is known of earlier calls.
    pub fn look_at<T: Send>(&self, py: Python<'_>, look: impl FnOnce(&Asked) -> T + Send) -> PyResult<T> {
        // The lock is mostly free. Its holder may wait for the interpreter.
        if let Ok(one) = self.one.try_lock() {
            return Ok(look(&one));
        }
        let done = watched(py, &self.interrupt, |watch| watch.lock(&self.one).map(|one| look(&one)));
        done?.map_err(raised)
    }

    /// Does something with the device, in turn with all that share it.
    pub fn in_turn<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
        py.detach(|| {
            let _turn = self.device.get().turn();
            work()
        })
    }

    /// Never called while the interpreter is held: the lock's holder may wait for that. Called before
    /// the device's turn.
    pub fn locked(&self) -> MutexGuard<'_, Asked> {
        self.one.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The motions of bodies, as Python gives them.
    pub fn frame_of(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<Frame> {
        let (numbers, places): (Vec<_>, Vec<_>) = numbered(inputs)?.into_iter().unzip();
        let bodies = self.bodies_of(py, &numbers)?;
        Frame::of(bodies.into_iter().zip(places).collect(), &self.device.get().device)
    }

    /// The bodies with these numbers.
    fn bodies_of(&self, py: Python<'_>, numbers: &[usize]) -> PyResult<Vec<Named>> {
        let found = self.look(py, |detector| {
            let scene = detector.scene();
            let named = |id| scene.get(id).map(|body| (id, body.name().to_owned(), body.vertex_count()));
            numbers.iter().map(|&number| scene.id(number).and_then(named)).collect::<Vec<_>>()
        })?;
        let named =
            |(&number, found)| known(number, found).map(|(id, name, vertices)| Named { id, name, vertices });
        numbers.iter().zip(found).map(named).collect()
    }

    pub fn body(&self, py: Python<'_>, number: usize) -> PyResult<BodyId> {
        known(number, self.look(py, |detector| detector.scene().id(number))?)
    }

    /// Does something with the answer that was on the device after so many calls, if it still is there.
    pub fn with_answer<T: Send>(
        &self,
        py: Python<'_>,
        asked: u64,
        with: impl FnOnce() -> T + Send,
    ) -> PyResult<T> {
        let there = |one: &Asked| (one.detector.is_prepared() && one.asked == asked).then(with);
        self.look_at(py, there)?.ok_or_else(|| {
            choice(
                "the answer on the device is gone: another call has used the detector, or a list grew",
                "call on_device after prepare, and again whenever is_prepared was False",
            )
        })
    }
}

/// As Python's own values.
pub fn python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value)
        .map_err(|error| raised(Error::Bug { what: format!("figures that are no JSON: {error}") }))?;
    py.import("json")?.call_method1("loads", (text,))
}
