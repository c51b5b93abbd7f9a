//! A scene on a device, which answers queries step after step.

mod approaching;
mod caveats;
mod edits;
mod engine;
mod extras;
mod figures;
mod first;
mod frame;
mod geometry;
mod grouped;
mod instances;
mod interrupted;
mod layouts;
mod moves;
mod nearest;
mod placed;
pub mod plan;
mod portion;
mod poses;
mod question;
mod ready;
mod resident;
mod slices;
mod stages;
mod submit;
mod thick;

use crate::device::Device;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::{Share, Tolerances};
use crate::query::Query;
use crate::scene::{Body, Scene};
use engine::{Engine, fits};
use placed::Placed;
use portion::Portion;
use question::Question;
use resident::Resident;
use std::sync::Arc;
pub(crate) use submit::check_submission;
use thick::Thick;

/// A scene on a device, which answers queries.
///
/// All queries share one memory: positions are uploaded once a step, for any number of queries. A
/// step is one submission, for any number of bodies. Fixed bodies are built and fitted once, and a
/// rigid body costs its poses. Kinds without bodies cost nothing.
///
/// ```
/// use nearmiss::{Body, Detector, Device, Discrete, Earliest, Mesh, Near, device::Backend, mesh::Positions, scene::Motion};
///
/// // A triangle that rests, and one whose corner falls through it.
/// let faces = vec![[0, 1, 2], [3, 4, 5]];
/// let at = |z| Positions::F32(vec![
///     [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, z], [1.0, 9.0, 9.0], [9.0, 1.0, 9.0],
/// ]);
/// let body = Body::deformable(Mesh::new("two triangles", at(1.0), faces)?);
/// let device = Device::open(Backend::Auto, None)?;
/// // A deformable body is tested against itself.
/// let mut detector = Detector::new(device, body)?;
/// let triangles = detector.scene().ids().next().expect("a body");
/// detector.update(&[(triangles, Motion::step(&at(1.0), &at(-1.0)))])?;
/// let first = detector.query(&Earliest::default())?;
/// println!("first contact at {:?}", first.map(|contact| contact.toi));
/// println!("{} pairs within 1", detector.query(&Near::within(1.0))?.len());
/// assert!(detector.query(&Discrete::default())?.is_empty());
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct Detector {
    device: Device,
    scene: Scene,
    /// Default tolerances of pairs, once a query needed them.
    tolerances: Option<Arc<Tolerances>>,
    /// Thickness of the bodies, once a query needed it.
    thick: Option<Thick>,
    engine: Engine,
    portion: Portion,
    placed: Placed,
    resident: Resident,
}

impl Detector {
    /// A detector for a scene, a single body or a list of bodies. Memory of the device is taken
    /// when the first query needs it. A scene without bodies has empty answers until a body is
    /// [added](Detector::add).
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for self-collision of a fixed body; [`Error::Input`] for more
    /// triangles than indices reach.
    pub fn new(device: Device, scene: impl Into<Scene>) -> Result<Detector, Error> {
        Detector::with_share(device, scene.into(), Share::WHOLE)
    }

    /// Makes a detector for a share of the work.
    ///
    /// # Errors
    /// As of [`Detector::new`].
    pub(crate) fn with_share(device: Device, scene: Scene, share: Share) -> Result<Detector, Error> {
        start_threads()?;
        scene.bodies().iter().try_for_each(Body::validate)?;
        let all = |count: fn(&Body) -> usize| scene.bodies().iter().map(count).sum();
        fits(all(Body::element_count), all(Body::vertex_count))?;
        Ok(Detector {
            device: device.for_one(),
            scene,
            tolerances: None,
            thick: None,
            engine: Engine::default(),
            portion: Portion::new(share),
            placed: Placed::default(),
            resident: Resident::default(),
        })
    }

    /// The device of its work.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The bodies at their current positions; those of device-resident bodies are stale.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Combines a query with the tolerances and the thickness of its pairs.
    fn question(&mut self, query: Query) -> Result<Question, Error> {
        query.check()?;
        self.scene.may_exclude(query.kind())?;
        self.may_pair_bodies(&query)?;
        self.may_approach(&query)?;
        let radii = self.radii_for(&query)?;
        let tolerances = match query.certified().map(|certified| certified.tolerance) {
            Some(Some(tolerance)) => Some(Arc::new(Tolerances::named(tolerance))),
            Some(None) => Some(self.default_tolerances()),
            None => None,
        };
        Ok(Question { query, tolerances, radii })
    }

    /// Default tolerances of the current bodies.
    fn default_tolerances(&mut self) -> Arc<Tolerances> {
        let bodies = self.scene.bodies_mut();
        let made = || {
            bodies.iter_mut().for_each(Body::keep_tolerance);
            Arc::new(Tolerances::of(bodies))
        };
        self.tolerances.get_or_insert_with(made).clone()
    }
}
