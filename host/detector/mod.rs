//! The front door: a scene on a device, asked frame after frame.

mod caveats;
mod edits;
mod engine;
mod figures;
mod frame;
mod geometry;
mod interrupted;
mod moves;
mod placed;
pub mod plan;
mod portion;
mod question;
mod ready;
mod resident;
mod slices;
mod stages;
mod submit;
mod wear;

use crate::device::Device;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::Share;
use crate::query::Query;
use crate::scene::{Body, Scene};
use engine::Engine;
use placed::Placed;
use portion::Portion;
use question::Question;
use resident::Resident;
pub(crate) use wear::Wear;

/// A scene on a device, ready to be asked frame after frame.
///
/// A frame is one submission, whatever the number of bodies: [`Detector::frame`] says where bodies are now, and answers. What
/// is static was built and fitted once, a rigid body costs its poses, and what no body does costs nothing.
///
/// ```
/// use nearmiss::{Body, Detector, Device, Mesh, Query, device::Backend, mesh::Positions, scene::Input};
///
/// // A triangle that rests, and one whose corner falls through it.
/// let faces = vec![[0, 1, 2], [3, 4, 5]];
/// let at = |z| Positions::F32(vec![
///     [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, z], [1.0, 9.0, 9.0], [9.0, 1.0, 9.0],
/// ]);
/// let body = Body::still(Mesh::new("two triangles", at(1.0), faces)?);
/// let device = Device::open(Backend::Auto, None)?;
/// // A deformable body is tested against itself.
/// let mut detector = Detector::new(device, body, Query::continuous())?;
/// let triangles = detector.scene().ids().next().expect("a body");
/// let contacts = detector.frame(&[(triangles, Input::Step([&at(1.0), &at(-1.0)]))])?;
/// println!("{} contacts, first at {:?}", contacts.len(), contacts.earliest_toi());
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct Detector {
    device: Device,
    scene: Scene,
    question: Question,
    engine: Engine,
    portion: Portion,
    placed: Placed,
    resident: Resident,
}

impl Detector {
    /// Uploads a scene and builds its trees: of a single body, or of a list of bodies, too. A scene without bodies answers nothing,
    /// whatever the query, until a body is [added](Detector::add). Cost: linear in triangles; memory grows with what is found.
    ///
    /// # Errors
    /// [`Error::Choice`] for self-contact of a static body and for numbers that mean nothing; those of the device.
    pub fn new(device: Device, scene: impl Into<Scene>, query: impl Into<Query>) -> Result<Detector, Error> {
        Detector::with_share(device, scene.into(), query.into(), Share::WHOLE)
    }

    /// The same, for a share of the work.
    ///
    /// # Errors
    /// As there; [`Error::Choice`] where work cannot be divided.
    pub(crate) fn with_share(
        device: Device,
        mut scene: Scene,
        query: Query,
        share: Share,
    ) -> Result<Detector, Error> {
        query.check()?;
        start_threads()?;
        scene.bodies().iter().try_for_each(Body::check_meets)?;
        let mut detector = Detector {
            device: device.for_one(),
            question: Question::new(query, &mut scene),
            scene,
            engine: Engine::default(),
            portion: Portion::new(share),
            placed: Placed::default(),
            resident: Resident::default(),
        };
        let begun = detector.begun().map(drop);
        detector.ended(begun)?;
        Ok(detector)
    }

    /// The bodies, where they are now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What is asked.
    pub fn query(&self) -> &Query {
        &self.question.query
    }
}
