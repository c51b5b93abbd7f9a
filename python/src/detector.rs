//! A scene on a device, asked frame after frame.

use crate::answer::DeviceAnswer;
use crate::asked::{Asked, Does};
use crate::contacts::Contacts;
use crate::device::Device;
use crate::errors::{choice, raised};
use crate::frame::{Frame, Named, known, numbered};
use crate::geometry::Geometry;
use crate::query::Query;
use crate::scene::{Body, Scene};
use crate::watch::watched;
use nearmiss::scene::BodyId;
use nearmiss::words::counted;
use nearmiss::{Error, Interrupt};
use pyo3::prelude::*;
use serde::Serialize;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A scene on a device, asked frame after frame.
///
/// scene:  a Scene, or one Body.
/// query:  Discrete, Continuous, Earliest, Near or Distance.
/// device: default: Device(), a GPU where there is one.
///
/// Other threads of Python run while a frame is computed; arrays that were given must not be written meanwhile.
#[pyclass(module = "nearmiss", frozen)]
pub struct Detector {
    one: Mutex<Asked>,
    query: nearmiss::Query,
    device: Py<Device>,
    /// What ends its calls.
    interrupt: Interrupt,
}

impl Detector {
    /// Asks the detector, in turn with all that share its device, while the interpreter runs on.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        does: Does,
        ask: impl FnOnce(&mut nearmiss::Detector) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let (told, unread) = self.work(py, |one| {
            one.count(does);
            (ask(&mut one.detector), one.unread())
        })?;
        drop(unread);
        told.map_err(raised)
    }

    /// Works with the detector, in turn with all that share its device, while the interpreter runs
    /// on. A signal ends it.
    fn work<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Asked) -> T + Send) -> PyResult<T> {
        let turn = &self.device.get().turn;
        let done = watched(py, &self.interrupt, |watch| {
            let mut one = watch.lock(&self.one)?;
            let _turn = watch.lock(turn)?;
            watch.begins();
            Ok(work(&mut one))
        });
        done?.map_err(raised)
    }

    /// Asks what is answered by contacts.
    fn told(
        &self,
        py: Python<'_>,
        does: Does,
        ask: impl FnOnce(&mut nearmiss::Detector) -> Result<nearmiss::Contacts, Error> + Send,
    ) -> PyResult<Contacts> {
        let (told, stamp, unread) = self.work(py, |one| {
            one.count(does);
            (ask(&mut one.detector), one.stamp(), one.unread())
        })?;
        drop(unread);
        Ok(Contacts::new(told.map_err(raised)?, stamp))
    }

    /// Looks at the detector.
    fn look<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&nearmiss::Detector) -> T + Send,
    ) -> PyResult<T> {
        self.look_at(py, |one| look(&one.detector))
    }

    /// The same, with what is known of what was asked.
    fn look_at<T: Send>(&self, py: Python<'_>, look: impl FnOnce(&Asked) -> T + Send) -> PyResult<T> {
        // Mostly nobody has the lock. Who has it may wait for the interpreter.
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

    /// Never while the interpreter is held: whoever has the lock may wait for that. Before the device's turn.
    fn locked(&self) -> MutexGuard<'_, Asked> {
        self.one.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn frame_of(&self, py: Python<'_>, inputs: Option<&Bound<'_, PyAny>>) -> PyResult<Frame> {
        let inputs = inputs.map_or_else(|| Ok(Vec::new()), numbered)?;
        let (numbers, places): (Vec<_>, Vec<_>) = inputs.into_iter().unzip();
        let bodies = self.bodies(py, &numbers)?;
        Frame::of(bodies.into_iter().zip(places).collect(), &self.device.get().device)
    }

    /// The bodies with these numbers.
    fn bodies(&self, py: Python<'_>, numbers: &[usize]) -> PyResult<Vec<Named>> {
        let found = self.look(py, |detector| {
            let scene = detector.scene();
            let named = |id| scene.get(id).map(|body| (id, body.name().to_owned(), body.vertex_count()));
            numbers.iter().map(|&number| scene.id(number).and_then(named)).collect::<Vec<_>>()
        })?;
        let named =
            |(&number, found)| known(number, found).map(|(id, name, vertices)| Named { id, name, vertices });
        numbers.iter().zip(found).map(named).collect()
    }

    fn body(&self, py: Python<'_>, number: usize) -> PyResult<BodyId> {
        known(number, self.look(py, |detector| detector.scene().id(number))?)
    }

    /// The named tolerance of a certified solver, or one of the defaults.
    fn tolerance_of(
        &self,
        py: Python<'_>,
        default: fn(&mut nearmiss::Detector) -> f64,
    ) -> PyResult<Option<f64>> {
        match self.query.certified().map(|certified| certified.tolerance) {
            Some(None) => self.work(py, |one| default(&mut one.detector)).map(Some),
            named => Ok(named.flatten()),
        }
    }

    /// Does something with the answer that lay on the device when so many questions had been asked, if it still does.
    pub fn with_answer<T: Send>(
        &self,
        py: Python<'_>,
        asked: u64,
        with: impl FnOnce() -> T + Send,
    ) -> PyResult<T> {
        let there = |one: &Asked| (one.detector.is_prepared() && one.asked == asked).then(with);
        self.look_at(py, there)?.ok_or_else(|| {
            choice(
                "an answer on the device whose detector was asked anew, or has grown",
                "ask `on_device` after `prepare`, and again when `is_prepared` is no longer true",
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

#[pymethods]
impl Detector {
    #[new]
    #[pyo3(signature = (scene, query, device = None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        query: &Query,
        device: Option<Py<Device>>,
    ) -> PyResult<Detector> {
        let device = match device {
            Some(device) => device,
            None => py.get_type::<Device>().call0()?.cast_into::<Device>()?.unbind(),
        };
        let bodies = match (scene.cast::<Body>(), scene.cast::<Scene>()) {
            (Ok(body), _) => nearmiss::Scene::from(body.get().body.clone()),
            (_, Ok(scene)) => scene.borrow().scene.clone(),
            _ => {
                return Err(choice(
                    format!("a detector of {}", scene.get_type()),
                    "give a Scene or a Body: Detector(Scene(*bodies), query)",
                ));
            }
        };
        let (query, turn, interrupt) = (query.query, &device.get().turn, Interrupt::new());
        let on = device.get().device.clone().with_interrupt(&interrupt);
        let detector = watched(py, &interrupt, |watch| {
            let _turn = watch.lock(turn)?;
            watch.begins();
            let mut detector = nearmiss::Detector::new(on, bodies)?;
            detector.begin(&query)?;
            Ok(detector)
        });
        let one = Mutex::new(Asked::new(detector?.map_err(raised)?));
        if let Ok(scene) = scene.cast::<Scene>() {
            scene.try_borrow_mut()?.taken = true;
        }
        Ok(Detector { one, query, device, interrupt })
    }

    /// Moves bodies, and answers.
    ///
    /// inputs: a mapping from a body's number to where it is: of a deformable body (n, 3) numbers, or two such arrays for the
    ///         ends of a step; of a rigid body a Pose, or two. A body that is not named rests
    ///         where it is, or where its step ended. Discrete, Near and Distance test a step where
    ///         it begins. Arrays of the detector's GPU, and on a CPU numpy's arrays of packed rows,
    ///         are read where they lie.
    #[pyo3(signature = (inputs = None))]
    fn frame(&self, py: Python<'_>, inputs: Option<&Bound<'_, PyAny>>) -> PyResult<Contacts> {
        let frame = self.frame_of(py, inputs)?;
        let given = frame.inputs();
        self.told(py, Does::Moves, |detector| detector.step(&given, &self.query))
    }

    /// Answers for where the bodies are.
    fn detect(&self, py: Python<'_>) -> PyResult<Contacts> {
        self.told(py, Does::AsksAnew, |detector| detector.query(&self.query))
    }

    /// Where contacts or near pairs are, of Continuous and Near; else InvalidArgumentError. Of this
    /// detector, and before it is asked to move, add, remove or replace bodies.
    fn geometry(&self, py: Python<'_>, contacts: &Contacts) -> PyResult<Geometry> {
        let told = self.work(py, |one| {
            one.check(contacts.stamp)?;
            one.detector.geometry(&contacts.contacts)
        })?;
        told.map(Geometry::from).map_err(raised)
    }

    /// All figures of an answer, as the command line prints them: counts, milliseconds by stage,
    /// what it came to less than was asked, and `notes`: a sentence each.
    /// Of the contacts that `geometry` takes.
    fn summary<'py>(&self, py: Python<'py>, contacts: &Contacts) -> PyResult<Bound<'py, PyAny>> {
        let told = self
            .work(py, |one| one.check(contacts.stamp).map(|()| one.detector.summary(&contacts.contacts)))?;
        python(py, &told.map_err(raised)?)
    }

    /// What a frame launches, holds and moves, by kernel and purpose: counted, as a dictionary.
    fn plan<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.ask(py, Does::AsksAnew, |detector| detector.plan(&self.query))?)
    }

    /// Prepares frames that nobody waits for: `submit` then takes no memory and moves nothing through the host.
    ///
    /// inputs: as for `frame`, of arrays that stay where they are: of the GPU, or on a CPU numpy's. Write into them between submissions; they
    ///         are held until the next `prepare` or `frame`.
    fn prepare(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<Contacts> {
        let frame = self.frame_of(py, Some(inputs))?;
        let given = frame.on_device()?;
        let held = frame.held;
        let (told, stamp, unread) = self.work(py, |one| {
            one.count(Does::Moves);
            let told =
                one.detector.prepare(&given, &[self.query]).and_then(|()| one.detector.collect(&self.query));
            // A refusal may leave it as it was prepared before.
            let as_before = told.is_err() && one.detector.is_prepared();
            let unread = if as_before { held } else { std::mem::replace(&mut one.held, held) };
            (told, one.stamp(), unread)
        })?;
        drop(unread);
        Ok(Contacts::new(told.map_err(raised)?, stamp))
    }

    /// Whether `submit` may be called, and a graph that recorded it be launched again.
    #[getter]
    fn is_prepared(&self, py: Python<'_>) -> PyResult<bool> {
        self.look(py, nearmiss::Detector::is_prepared)
    }

    /// Puts a frame into the device's stream and returns: may be captured in a graph (torch.cuda.graph, cupy).
    fn submit(&self, py: Python<'_>) -> PyResult<()> {
        if self.device.get().device.is_gpu() {
            // Launches alone, and by the thread that may capture them.
            let done = py.detach(|| {
                let (mut one, _turn) = (self.locked(), self.device.get().turn());
                one.count(Does::Submits);
                (one.detector.submit(), one.unread())
            });
            return done.0.map_err(raised);
        }
        self.ask(py, Does::Submits, nearmiss::Detector::submit)
    }

    /// Where the answer of a submission will lie; None where it is not prepared.
    fn on_device(detector: Bound<'_, Self>) -> PyResult<Option<DeviceAnswer>> {
        let own = detector.get();
        let (answer, asked) =
            own.look_at(detector.py(), |one| (one.detector.on_device(&own.query), one.asked))?;
        let Some(answer) = answer else { return Ok(None) };
        let device = own.device.get().device.clone();
        Ok(Some(DeviceAnswer { answer, device, detector: detector.unbind(), asked }))
    }

    /// Waits for what was submitted last, and brings the answer to the host. Where a list was too short the frame is asked again, and
    /// the answer is whole; then the detector is no longer prepared.
    fn collect(&self, py: Python<'_>) -> PyResult<Contacts> {
        self.told(py, Does::Submits, |detector| detector.collect(&self.query))
    }

    /// Makes tiles or trees anew: pays when bodies have moved far from where they were made.
    fn rebuild(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Does::AsksAnew, nearmiss::Detector::rebuild)
    }

    /// Ends the call that another thread makes or, if none runs, the next one: it raises
    /// Interrupted, and the detector can be used again. Bodies that the call named are where it
    /// said. On the main thread Ctrl-C does the same, and raises KeyboardInterrupt.
    fn interrupt(&self) {
        self.interrupt.trigger();
    }

    /// Adds a body: its number.
    fn add(&self, py: Python<'_>, body: &Body) -> PyResult<usize> {
        self.ask(py, Does::Moves, |detector| detector.add(body.body.clone())).map(BodyId::index)
    }

    /// Takes the body of that number out.
    fn remove(&self, py: Python<'_>, body: usize) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.ask(py, Does::Moves, |detector| detector.remove(id).map(drop))
    }

    /// Puts another body in the place of that number.
    fn replace(&self, py: Python<'_>, body: usize, by: &Body) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.ask(py, Does::Moves, |detector| detector.replace(id, by.body.clone()))
    }

    /// Smallest tolerance of a pair of bodies by a certified solver, a length.
    #[getter]
    fn tolerance(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.tolerance_of(py, nearmiss::Detector::tolerance)
    }

    /// Largest tolerance of a pair of bodies: that of `tolerance` if all pairs have the same.
    #[getter]
    fn largest_tolerance(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.tolerance_of(py, nearmiss::Detector::largest_tolerance)
    }

    /// Where it is asked.
    #[getter]
    fn device(&self, py: Python<'_>) -> Py<Device> {
        self.device.clone_ref(py)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (query, bodies) = (self.query.kind(), self.look(py, |d| d.scene().ids().count())?);
        let bodies = counted(bodies as u64, "body", "bodies");
        Ok(format!("<nearmiss.Detector: {query}, {bodies}, {}>", self.device.get().device.name()))
    }
}
