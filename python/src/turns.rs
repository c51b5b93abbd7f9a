//! Threads take turns at a detector and at its device, while the interpreter runs on.

use crate::answer::{Answer, typed};
use crate::asked::{Asked, Does};
use crate::borrowed::Held;
use crate::detector::Detector;
use crate::errors::raised;
use crate::frame::{Frame, Named, Reader, keyed};
use crate::key::{self, Key};
use crate::pose::{Ends, Pose};
use crate::watch::{self, watched};
use nearmiss::Error;
use nearmiss::contacts::DeviceExtras;
use nearmiss::scene::{BodyId, BodyKind};
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
        let done = watched(py, &self.calls, |watch| {
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
        let (answer, stamp, names, unread) = self.work(py, |one| {
            one.count(does);
            let answer = call(&mut one.detector);
            let unread = one.read(held, answer.is_ok());
            (answer, one.stamp(), one.names(), unread)
        })?;
        drop(unread);
        typed(py, answer.map_err(raised)?, stamp, names)
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

    /// The answer to a query about another answer of this detector, of the bodies where they are.
    pub fn answer_about<'py>(
        &self,
        py: Python<'py>,
        about: &Answer,
        call: impl FnOnce(&mut nearmiss::Detector, &nearmiss::Contacts) -> Result<nearmiss::Contacts, Error>
        + Send,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (answer, stamp, names) = self.work(py, |one| {
            let answer = one.check(about.stamp).and_then(|()| {
                one.count(Does::Queries);
                call(&mut one.detector, &about.contacts)
            });
            (answer, one.stamp(), one.names())
        })?;
        typed(py, answer.map_err(raised)?, stamp, names)
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
        watch::look(py, &self.calls, &self.one, look)
    }

    /// Never called while the interpreter is held: the lock's holder may wait for that. Called before
    /// the device's turn.
    pub fn locked(&self) -> MutexGuard<'_, Asked> {
        self.one.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The motions of bodies, as Python gives them.
    pub fn frame_of(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<Frame> {
        let (keys, places): (Vec<_>, Vec<_>) = keyed(inputs)?.into_iter().unzip();
        let named = self.look(py, |detector| Named::all(detector.scene(), &keys))?;
        let reader = Reader { devices: &[&self.device.get().device], in_place: true };
        Frame::of(named.map_err(raised)?.into_iter().zip(places).collect(), reader)
    }

    /// Moves bodies.
    pub fn moved(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut frame = self.frame_of(py, inputs)?;
        let held = std::mem::take(&mut frame.held);
        let given = frame.inputs();
        let (done, unread) = self.work(py, |one| {
            one.count(Does::Moves);
            let done = one.detector.update(&given);
            let unread = one.read(held, false);
            (done, unread)
        })?;
        drop(unread);
        done.map_err(raised)
    }

    /// Prepares submissions of queries.
    pub fn prepared(
        &self,
        py: Python<'_>,
        inputs: &Bound<'_, PyAny>,
        queries: &[nearmiss::Query],
        extras: &DeviceExtras,
    ) -> PyResult<()> {
        let frame = self.frame_of(py, inputs)?;
        let given = frame.on_device()?;
        let held = frame.held;
        let (done, unread) = self
            .work(py, |one| one.prepare(held, |detector| detector.prepare_with(&given, queries, extras)))?;
        drop(unread);
        done.map_err(raised)
    }

    /// The body of a key.
    pub fn body(&self, py: Python<'_>, key: Key) -> PyResult<BodyId> {
        let [id] = self.look(py, |detector| key::each(detector.scene(), &[key]))?.map_err(raised)?;
        Ok(id)
    }

    /// The place of a body at both ends of its step.
    pub fn ends_of(&self, py: Python<'_>, body: Key) -> PyResult<Ends> {
        let id = self.body(py, body)?;
        self.run(py, Does::Reads, |detector| {
            detector.download_positions()?;
            let gone = || Error::Bug { what: format!("body {id} is gone") };
            detector.scene().get(id).map(Ends::of).ok_or_else(gone)
        })
    }

    /// The poses of a rigid body at both ends of its step.
    pub fn poses_of(&self, py: Python<'_>, body: Key) -> PyResult<(Pose, Pose)> {
        let id = self.body(py, body)?;
        let [start, end] = self.run(py, Does::Reads, |detector| {
            if let Some(body) = detector.scene().get(id).filter(|body| body.kind() != BodyKind::Rigid) {
                return Err(Error::InvalidArgument {
                    what: format!("body {id}, {}, is not rigid and has no pose", body.name()),
                    advice: "use download_positions for its vertices".into(),
                });
            }
            detector.download_positions()?;
            let gone = || Error::Bug { what: format!("body {id} is gone") };
            detector.scene().get(id).map(nearmiss::Body::poses).ok_or_else(gone)
        })?;
        Ok((Pose::known(py, start)?, Pose::known(py, end)?))
    }
}

/// As Python's own values.
pub fn python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value)
        .map_err(|error| raised(Error::Bug { what: format!("figures that are no JSON: {error}") }))?;
    py.import("json")?.call_method1("loads", (text,))
}
