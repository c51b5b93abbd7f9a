//! A scene on several devices of one host.

use crate::answer::{Answer, typed};
use crate::asked::{Asked, Does};
use crate::detector::Answered;
use crate::device::Device;
use crate::errors::raised;
use crate::exclusions;
use crate::frame::{Frame, Named, Reader, keyed};
use crate::geometry;
use crate::grouped::extras_of;
use crate::key::{self, Key, Pairs, body_of, numbers, pairs_of};
use crate::on_device::{DeviceAnswer, Owner};
use crate::opened::take;
use crate::pairs::Curves;
use crate::query::{Query, queries_of};
use crate::scene::{Body, scene_of};
use crate::thickness::thickness_of;
use crate::turns::python;
use crate::watch::{self, Calls, Watch, watched};
use nearmiss::Error;
use nearmiss::scene::BodyId;
use nearmiss::words::counted;
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard};

/// Scene on several devices of one host, which divide the work of each query.
///
/// Each device has all positions and finds the pairs of its share. Answers and hashes are those of a
/// Detector. The first frame is divided evenly, the next ones by the times of the last.
///
/// - `scene`: a Scene, or one Body, whose number is then 0.
/// - `devices`: at least one Device, such as [Device(gpu=0), Device(gpu=1)].
///
/// Takes Discrete, Continuous, Earliest and Near. Each device has a copy of positions. Raises
/// InvalidArgumentError without devices.
#[pyclass(module = "nearmiss", frozen)]
pub struct MultiDetector {
    one: Mutex<Several>,
    devices: Vec<Py<Device>>,
    /// Ends its calls.
    calls: Calls,
}

type Several = Asked<nearmiss::MultiDetector>;

/// The locks of all devices, in one order for all threads.
fn locks(devices: &[Py<Device>]) -> Vec<&Mutex<()>> {
    let mut locks: Vec<&Mutex<()>> = devices.iter().map(|device| &device.get().turn).collect();
    locks.sort_by_key(|lock| std::ptr::from_ref(*lock));
    locks.dedup_by_key(|lock| std::ptr::from_ref(*lock));
    locks
}

/// Waits for the turn of each device.
fn turns<'a>(devices: &'a [Py<Device>], watch: &Watch) -> Result<Vec<MutexGuard<'a, ()>>, Error> {
    locks(devices).into_iter().map(|lock| watch.lock(lock)).collect()
}

impl MultiDetector {
    /// Runs a call, in turn with all that share a device. A signal ends it.
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        does: Does,
        call: impl FnOnce(&mut Several) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let (done, unread) = self.work(py, |one| {
            one.count(does);
            (call(one), one.unread())
        })?;
        drop(unread);
        done.map_err(raised)
    }

    /// Works with the detector, in turn with all that share a device. A signal ends it.
    fn work<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Several) -> T + Send) -> PyResult<T> {
        let done = watched(py, &self.calls, |watch| {
            let mut one = watch.lock(&self.one)?;
            let _turns = turns(&self.devices, watch)?;
            watch.begins();
            Ok(work(&mut one))
        });
        done?.map_err(raised)
    }

    /// Waits for the turn of each device. Never called while the interpreter is held.
    ///
    /// # Errors
    /// As [`Watch::lock`].
    pub fn turns(&self, watch: &Watch) -> Result<Vec<MutexGuard<'_, ()>>, Error> {
        turns(&self.devices, watch)
    }

    /// Works with an answer of this detector, while bodies are where it found them.
    pub fn work_of<T: Send>(
        &self,
        py: Python<'_>,
        answer: &Answer,
        work: impl FnOnce(&mut nearmiss::MultiDetector, &nearmiss::Contacts) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        self.run(py, Does::Reads, |one| {
            one.check(answer.stamp)?;
            work(&mut one.detector, &answer.contacts)
        })
    }

    /// Looks at the detector.
    fn look<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&nearmiss::MultiDetector) -> T + Send,
    ) -> PyResult<T> {
        self.look_at(py, |one| look(&one.detector))
    }

    /// The same, with what is known of earlier calls.
    pub fn look_at<T: Send>(&self, py: Python<'_>, look: impl FnOnce(&Several) -> T + Send) -> PyResult<T> {
        watch::look(py, &self.calls, &self.one, look)
    }

    /// Runs a call that returns an answer.
    fn answer<'py>(
        &self,
        py: Python<'py>,
        does: Does,
        call: impl FnOnce(&mut Several) -> Result<nearmiss::Contacts, Error> + Send,
    ) -> Answered<'py> {
        let (contacts, stamp, names) = self.run(py, does, |one| {
            let contacts = call(one)?;
            Ok((contacts, one.stamp(), one.names()))
        })?;
        typed(py, contacts, stamp, names)
    }

    /// Motions of bodies. Arrays of numpy are read in place, or copied.
    fn frame_of(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>, in_place: bool) -> PyResult<Frame> {
        let (keys, places): (Vec<_>, Vec<_>) = keyed(inputs)?.into_iter().unzip();
        let named = self.look(py, |detector| Named::all(detector.scene(), &keys))?.map_err(raised)?;
        let devices: Vec<_> = self.devices.iter().map(|device| &device.get().device).collect();
        Frame::of(named.into_iter().zip(places).collect(), Reader { devices: &devices, in_place })
    }

    pub fn body(&self, py: Python<'_>, body: Key) -> PyResult<BodyId> {
        let [id] = self.look(py, |detector| key::each(detector.scene(), &[body]))?.map_err(raised)?;
        Ok(id)
    }
}

#[pymethods]
impl MultiDetector {
    #[new]
    #[pyo3(signature = (scene, devices))]
    fn new(py: Python<'_>, scene: &Bound<'_, PyAny>, devices: Vec<Py<Device>>) -> PyResult<MultiDetector> {
        let is_gpu = devices.iter().any(|device| device.get().device.is_gpu());
        let (all, calls) = (scene_of(scene)?, Calls::new(is_gpu));
        let one = |device: &Py<Device>| device.get().device.clone().with_interrupt(&calls.interrupt);
        let on = devices.iter().map(one).collect();
        let detector = watched(py, &calls, |watch| {
            let _turns = turns(&devices, watch)?;
            watch.begins();
            nearmiss::MultiDetector::new(on, all)
        });
        let detector = detector?.map_err(raised)?;
        take(scene)?;
        let one = Mutex::new(Several::new(detector, false));
        Ok(MultiDetector { one, devices, calls })
    }

    /// Move bodies for the next queries: see Detector.update for the arguments.
    ///
    /// Arrays may be on any of the GPUs; the others get copies. All have read them when the call
    /// returns.
    ///
    /// Raises as Detector.update does, and InvalidArgumentError for arrays of another GPU, or of a GPU if
    /// a device is a CPU: then nothing has moved.
    fn update(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<()> {
        let frame = self.frame_of(py, inputs, false)?;
        let given = frame.inputs();
        self.run(py, Does::Moves, |one| one.detector.update(&given))
    }

    /// Return the answer to a query, of the bodies where they are.
    ///
    /// Raises as Detector.query does, and InvalidArgumentError for a query that cannot be divided: Distance,
    /// BodyPairs and BodyDistances.
    fn query<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        let query = query.query;
        self.answer(py, Does::Queries, |one| one.detector.query(&query))
    }

    /// Move bodies and return the answer to a query.
    ///
    /// As `update` and `query`. An error of the motions or of the query has moved nothing.
    fn step<'py>(&self, py: Python<'py>, inputs: &Bound<'_, PyAny>, query: &Query) -> Answered<'py> {
        let frame = self.frame_of(py, inputs, false)?;
        let (given, query) = (frame.inputs(), query.query);
        self.answer(py, Does::Moves, |one| one.detector.step(&given, &query))
    }

    /// Prepare submissions: see Detector.prepare.
    ///
    /// Arrays may be on any of the GPUs; every submission copies them to the others. The work is
    /// divided by what it costs now, until the next preparation. Raises InvalidArgumentError for
    /// `first_contacts`: each GPU has the time of its share alone.
    #[pyo3(signature = (
        inputs, queries, *, geometry = false, least_by_vertex = false, grouped = None,
        first_contacts = false
    ))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn prepare(
        &self,
        py: Python<'_>,
        inputs: &Bound<'_, PyAny>,
        queries: &Bound<'_, PyAny>,
        geometry: bool,
        least_by_vertex: bool,
        grouped: Option<Vec<String>>,
        first_contacts: bool,
    ) -> PyResult<()> {
        let extras = extras_of(geometry, least_by_vertex, grouped, first_contacts)?;
        let (queries, frame) = (queries_of(queries)?, self.frame_of(py, inputs, true)?);
        let (given, held) = (frame.on_device()?, frame.held);
        let (done, unread) = self
            .work(py, |one| one.prepare(held, |detector| detector.prepare_with(&given, &queries, &extras)))?;
        drop(unread);
        done.map_err(raised)
    }

    /// Whether `submit` may be called.
    #[getter]
    fn is_prepared(&self, py: Python<'_>) -> PyResult<bool> {
        self.look(py, nearmiss::MultiDetector::is_prepared)
    }

    /// Launch the prepared queries on the streams of all GPUs: see Detector.submit.
    ///
    /// The stream of a GPU that has arrays goes on when the others have their copies. No graph can
    /// record it.
    fn submit(&self, py: Python<'_>) -> PyResult<()> {
        self.run(py, Does::Submits, |one| one.detector.submit())
    }

    /// Return the answers to a prepared query in device memory, one a device; None if it is not prepared.
    ///
    /// Each has the rows of the device's share: see Detector.on_device. An Earliest query has
    /// the time of each share.
    fn on_device(detector: Bound<'_, Self>, query: &Query) -> PyResult<Option<Vec<DeviceAnswer>>> {
        let (py, own) = (detector.py(), detector.get());
        let (answers, asked) = own.look_at(py, |one| (one.detector.on_device(&query.query), one.asked))?;
        let of = |(answer, device): (_, &Py<Device>)| {
            let owner = Owner::Several(detector.clone().unbind());
            DeviceAnswer { answer, device: device.get().device.clone(), owner, asked }
        };
        Ok(answers.map(|answers| answers.into_iter().zip(&own.devices).map(of).collect()))
    }

    /// Wait for the last submission, and return the answer to one of its queries: see Detector.collect.
    fn collect<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        let query = query.query;
        self.answer(py, Does::Collects(query), |one| one.detector.collect(&query))
    }

    /// Return where the features or triangles of an answer's rows meet: see Detector.geometry.
    fn geometry<'py>(&self, py: Python<'py>, answer: &Answer) -> Answered<'py> {
        geometry::typed(py, self.work_of(py, answer, |detector, found| detector.geometry(found))?)
    }

    /// Return the curves in which surfaces cross: see Detector.curves.
    fn curves(&self, py: Python<'_>, answer: &Answer) -> PyResult<Curves> {
        self.work_of(py, answer, |own, found| Curves::of(&own.geometry(found)?, own.scene()))
    }

    /// Return the contacts at the time of an earliest answer: see Detector.first_contacts.
    fn first_contacts<'py>(&self, py: Python<'py>, first: &Answer) -> Answered<'py> {
        self.answer(py, Does::Queries, |one| {
            one.check(first.stamp)?;
            one.detector.first_contacts(&first.contacts).map(nearmiss::Contacts::from)
        })
    }

    /// Return the part of each device in the last frame of a query; empty before the first frame.
    ///
    /// A dictionary a device: `device`, its name; `tiles`, its part of them, 0 to 1; `ms`, milliseconds by
    /// its own clock.
    fn shares<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        let query = query.query;
        python(py, &self.look(py, |detector| detector.shares(&query))?)
    }

    /// End the call of another thread or, if none runs, the next call: see Detector.interrupt.
    fn interrupt(&self) {
        self.calls.interrupt.trigger();
    }

    /// Add a body, and return its number.
    fn add(&self, py: Python<'_>, body: &Body) -> PyResult<usize> {
        self.run(py, Does::Edits, |one| one.detector.add(&body.body)).map(BodyId::index)
    }

    /// Remove a body, by number or name. The next body that is added may take its number.
    fn remove(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.run(py, Does::Edits, |one| one.detector.remove(id).map(drop))
    }

    /// Replace a body, by number or name.
    fn replace(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key, by: &Body) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.run(py, Does::Edits, |one| one.detector.replace(id, &by.body))
    }

    /// Replace the list of pairs of bodies that are not tested: see Detector.leave_out.
    fn leave_out(&self, py: Python<'_>, #[pyo3(from_py_with = pairs_of)] pairs: Pairs) -> PyResult<()> {
        self.run(py, Does::Queries, |one| {
            let list = key::pairs(one.detector.scene(), &pairs)?;
            one.detector.leave_out(&list)
        })
    }

    /// Pairs of bodies that are left out: the smaller number first, ascending.
    #[getter]
    fn left_out(&self, py: Python<'_>) -> PyResult<Vec<(usize, usize)>> {
        self.look(py, |detector| numbers(detector.left_out()))
    }

    /// Set the thickness of a body, from the next query on: see Detector.set_thickness.
    fn set_thickness(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        thickness: Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let id = self.body(py, body)?;
        let thickness = thickness_of(&thickness, &format!("body {id}"))?;
        self.run(py, Does::Edits, |one| one.detector.set_thickness(id, thickness))
    }

    /// Replace the exclusions of a body: see Scene.exclude for the arguments, and Detector.exclude.
    #[pyo3(signature = (body, *, ring = None, within = None, rest = None, faces = None))]
    fn exclude(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        ring: Option<&Bound<'_, PyAny>>,
        within: Option<f64>,
        rest: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (id, given) = (self.body(py, body)?, exclusions::Given::of(ring, within, rest, faces)?);
        self.run(py, Does::Queries, |one| {
            if given.rests_now() {
                one.detector.download_positions()?;
            }
            let own = given.of_body(one.detector.scene(), id);
            one.detector.exclude(id, &own)
        })
    }

    /// Replace the list of pairs of vertices of two bodies: see Detector.exclude_pairs.
    fn exclude_pairs(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        #[pyo3(from_py_with = body_of)] other: Key,
        pairs: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (both, pairs) = ([body, other], exclusions::pairs(pairs)?);
        self.run(py, Does::Queries, |one| {
            let ids = key::each(one.detector.scene(), &both)?;
            one.detector.exclude_pairs(ids, &pairs)
        })
    }

    /// Numbers of all bodies, ascending.
    #[getter]
    fn bodies(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.look(py, |detector| detector.scene().ids().map(BodyId::index).collect())
    }

    /// Devices of this detector.
    #[getter]
    fn devices(&self, py: Python<'_>) -> Vec<Py<Device>> {
        self.devices.iter().map(|device| device.clone_ref(py)).collect()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let bodies = self.look(py, |detector| detector.scene().ids().count())?;
        let bodies = counted(bodies as u64, "body", "bodies");
        let devices = counted(self.devices.len() as u64, "device", "devices");
        Ok(format!("<nearmiss.MultiDetector: {bodies}, {devices}>"))
    }
}
