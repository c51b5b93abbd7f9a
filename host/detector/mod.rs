//! The front door: a scene on a device, asked frame after frame.

mod away;
mod edits;
mod figures;
mod geometry;
mod interrupted;
mod moves;
pub mod plan;
mod share;
mod slices;
mod submit;
mod turns;
mod wear;

use crate::contacts::{Contacts, Degraded};
use crate::device::emulator::{Looks, start_threads};
use crate::device::{Device, Work};
use crate::error::Error;
use crate::memory;
use crate::mesh::{Body, MAX_FACES, MAX_VERTICES, Problem};
use crate::pipeline::{self, Found, Layout, Pipeline, Share, Stage, Stages, Tolerances};
use crate::query::Query;
#[cfg(doc)]
use crate::query::Rebuild;
use crate::scene::{BodyId, Scene};
use std::sync::Arc;
use std::time::Instant;
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
    /// None where bodies came, went or changed since the last frame.
    layout: Option<Arc<Layout>>,
    query: Query,
    /// The tolerances of a certified solver.
    tolerances: Option<Tolerances>,
    construct_ms: f64,
    /// Whether the device holds the answer for where the bodies are now.
    answered: bool,
    /// The largest coordinate that was seen in memory of the caller so far.
    largest: f64,
    /// Of each body, whether a frame has placed it since it was added; and whether one did for the first time since tiles or trees
    /// were made.
    was_placed: Vec<bool>,
    is_new_place: bool,
    /// Of each body, whether the last frame named it.
    named: Vec<bool>,
    /// The bodies that a submission reads, and whether they move in its step; up to date while the pipeline is prepared.
    submits: Vec<(BodyId, bool)>,
    /// Whether the pipeline holds positions in f64: where any body has them so, so that nothing is rounded.
    f64s: bool,
    /// None where nothing can meet, or where memory ended: then the next frame asks for it again.
    pipeline: Option<Box<dyn Pipeline>>,
    /// Whether a [`MultiDetector`](crate::MultiDetector) runs it.
    is_part: bool,
    /// Its part of the work, in how many slices it is asked, and what each tile cost where there are several.
    share: Share,
    slices: u32,
    work_of_tiles: Vec<u64>,
    /// What frames cost since tiles or trees were made, and how often these were.
    wear: Wear,
    builds: u64,
    /// Frames answered since the pipeline began.
    asked: u64,
    /// What the last building of the trees did, and the last frame.
    build: Work,
    work: Work,
}

/// Fewest bytes of the host's memory that a triangle takes in a detector: its topology, and on a CPU its tree and first lists.
const OF_A_TRIANGLE: u64 = 300;

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
        scene: Scene,
        query: Query,
        share: Share,
    ) -> Result<Detector, Error> {
        query.check()?;
        start_threads()?;
        scene.bodies().iter().try_for_each(Body::check_meets)?;
        let mut detector = Detector {
            device: device.for_one(),
            scene,
            layout: None,
            query,
            tolerances: None,
            construct_ms: 0.0,
            answered: false,
            largest: 0.0,
            was_placed: Vec::new(),
            is_new_place: false,
            named: Vec::new(),
            submits: Vec::new(),
            f64s: false,
            pipeline: None,
            is_part: false,
            share,
            slices: 1,
            work_of_tiles: Vec::new(),
            wear: Wear::default(),
            builds: 0,
            asked: 0,
            build: Work::default(),
            work: Work::default(),
        };
        detector.choose_tolerances();
        let begun = detector.begun().map(drop);
        detector.ended(begun)?;
        Ok(detector)
    }

    /// The tolerances of the bodies that there are now.
    fn choose_tolerances(&mut self) {
        self.tolerances = self.query.certified().copied().map(|certified| match certified.tolerance {
            Some(tolerance) => Tolerances::named(tolerance),
            None => {
                self.scene.bodies_mut().iter_mut().for_each(Body::keep_tolerance);
                Tolerances::of(self.scene.bodies())
            }
        });
    }

    /// Where every body lies in the memory that all share. All that is asked begins here, so a process that was forked is told here that it
    /// cannot ask.
    fn layout(&mut self) -> Result<Arc<Layout>, Error> {
        start_threads()?;
        if let Some(layout) = &self.layout {
            return Ok(layout.clone());
        }
        let bodies = self.scene.bodies();
        let triangles: usize = bodies.iter().map(Body::face_count).sum();
        fits(triangles, bodies.iter().map(Body::vertex_count).sum())?;
        memory::require("trees and lists", triangles as u64 * OF_A_TRIANGLE)?;
        let made = Layout::within(bodies, self.query.kind(), &self.device.looks());
        let mut layout = made.ok_or(Error::Interrupted)?;
        layout.find_hubs(self.query.keeps_adjacent());
        if let Some(tolerances) = &self.tolerances {
            layout.tolerances = tolerances.records(&layout.starts);
        }
        let layout = Arc::new(layout);
        self.layout = Some(layout.clone());
        Ok(layout)
    }

    /// Makes the pipeline, where there is none yet, with memory for the bodies where they are and trees built. None is made where
    /// nothing can meet: that costs no memory and no launch.
    fn one_pipeline(&mut self) -> Result<(), Error> {
        let layout = self.layout()?;
        if self.pipeline.is_none() && layout.may_meet() {
            self.all_known()?;
            let bodies = self.scene.bodies();
            self.f64s = bodies.iter().any(Body::needs_f64);
            let query = self.query_with_tolerance();
            let mut pipeline = pipeline::pipeline(
                self.device.clone(),
                bodies,
                layout,
                query,
                (self.f64s, self.first_slice()),
            )?;
            self.device.work();
            let constructed = pipeline.construct();
            if matches!(constructed, Ok(_) | Err(Error::Interrupted)) {
                // Also an interrupted one knows where bodies are.
                self.pipeline = Some(pipeline);
            }
            self.construct_ms = constructed?;
            (self.asked, self.build) = (0, self.device.work());
            self.built();
        }
        Ok(())
    }

    /// Tiles or trees are new.
    fn built(&mut self) {
        (self.wear, self.is_new_place, self.builds) = (Wear::default(), false, self.builds + 1);
    }

    /// How often tiles or trees were made: when the detector began, when asked, by itself where the query allows it, and whenever memory was
    /// taken anew.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// The query, with the largest tolerance of its pairs: volumes grow by it.
    fn query_with_tolerance(&self) -> Query {
        let mut query = self.query;
        if let (Some(certified), Some(tolerances)) = (query.certified_mut(), &self.tolerances) {
            certified.tolerance = Some(tolerances.largest);
        }
        query
    }

    /// Makes tiles, or the tree, over what moves anew: pays when bodies have moved far from where they were made. By itself where
    /// [`Rebuild::Auto`] allows it, the default.
    ///
    /// # Errors
    /// Those of the device.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        self.device.work();
        let renewed = self.renew();
        self.ended(renewed)?;
        self.build = self.device.work();
        Ok(())
    }

    fn renew(&mut self) -> Result<(), Error> {
        let Some(pipeline) = self.begun()? else { return Ok(()) };
        self.construct_ms = pipeline.construct()?;
        self.answered = false;
        self.built();
        Ok(())
    }

    /// Whether the next frame builds again by itself: the first one that places a body, as a rigid one was added without its pose, and
    /// one by which the counted tests have become as many as building is worth.
    fn is_worn(&self, layout: &Layout) -> bool {
        let is_worn = self.is_new_place || self.wear.is_worn(layout.moving_triangles());
        self.query.search().rebuilds() && is_worn
    }

    /// All contacts with the bodies where they are, in canonical order. Where the lists of a frame outgrow the memory, or an index,
    /// candidates by tiles are found slice by slice, a share of the tiles after the other, and the answer is the same:
    /// [`Contacts::slices`] says how many they were.
    ///
    /// # Errors
    /// Those of the device: [`Error::OutOfMemory`] when memory ends all the same. There is no partial answer.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        self.device.work();
        let answered = self.answer(Instant::now());
        self.ended(answered)
    }

    /// The same, of a frame that began then.
    fn answer(&mut self, start: Instant) -> Result<Contacts, Error> {
        self.answered = false;
        self.read_again(false);
        self.none_lost()?;
        let layout = self.layout()?;
        if self.is_worn(&layout) {
            self.renew()?;
        }
        let Some((contacts, seen)) = self.ask(&layout)? else { return Ok(Contacts::none(self.query)) };
        (self.asked, self.work) = (self.asked + 1, self.device.work());
        self.complete(contacts, seen, start)
    }

    /// Runs one stage of this frame `times` times, on the device alone, and gives each run's milliseconds: for profilers,
    /// and for figures of one stage. What the stage needs runs before, once, where it has not yet: the leaves' volumes for
    /// [`Stage::Refit`], a whole frame for [`Stage::Traverse`], [`Stage::Narrow`] and
    /// [`Stage::Order`]. The next [`Detector::detect`] answers as it would have. Where nothing can meet there are no stages, and a CPU orders nothing: no runs.
    ///
    /// # Errors
    /// Those of the device.
    pub fn repeat_stage(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        let ms = self.repeated(stage, times);
        self.ended(ms)
    }

    fn repeated(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        if !self.answered && matches!(stage, Stage::Traverse | Stage::Narrow | Stage::Order) {
            self.detect()?;
        }
        let answered = self.answered;
        let Some(pipeline) = self.begun()? else { return Ok(Vec::new()) };
        if !answered && stage == Stage::Refit {
            pipeline.repeat(Stage::Fit, 1)?;
        }
        let ms = pipeline.repeat(stage, times)?;
        if stage == Stage::Construct {
            self.answered = false;
            self.construct_ms = ms.last().copied().unwrap_or(self.construct_ms);
            self.built();
        }
        Ok(ms)
    }

    /// Runs the narrow stage of this frame once more, step by step: each step's name and milliseconds on the device's own
    /// clock. A frame must have been asked; where nothing can meet there are no steps.
    ///
    /// # Errors
    /// Those of the device.
    pub fn narrow_steps(&mut self) -> Result<Vec<(&'static str, f64)>, Error> {
        if !self.answered {
            self.detect()?;
        }
        let steps = self.pipeline.as_mut().map_or(Ok(Vec::new()), |pipeline| pipeline.narrow_steps());
        self.ended(steps)
    }

    /// The bodies, where they are now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What is asked.
    pub fn query(&self) -> &Query {
        &self.query
    }
}

/// What was found, in the numbering of the bodies.
fn contacts(found: Found, stages: Stages, layout: &Layout, looks: &Looks) -> Result<Contacts, Error> {
    let degraded = Degraded::of(&found);
    memory::require("the contacts", found.bytes())?;
    let contacts = Contacts::new(found, layout, (stages, degraded), looks);
    if looks.ended() { Err(Error::Interrupted) } else { Ok(contacts) }
}

/// Whether indices of 32 bits reach all triangles, vertices and edges (at most three a triangle) of all bodies together.
fn fits(triangles: usize, vertices: usize) -> Result<(), Error> {
    let all = [("triangles", triangles, MAX_FACES), ("vertices", vertices, MAX_VERTICES)];
    match all.into_iter().find(|(_, count, limit)| count > limit) {
        None => Ok(()),
        Some((what, count, limit)) => {
            let problem = Problem::TooMany { what, count: count as u64, limit: limit as u64 };
            Err(Error::Input { file: "the scene".into(), problem })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_indices_reach_is_refused() {
        assert!(fits(MAX_FACES, MAX_VERTICES).is_ok());
        for (triangles, vertices) in [(MAX_FACES + 1, 3), (1, MAX_VERTICES + 1)] {
            let error = fits(triangles, vertices).expect_err("too many").to_string();
            assert!(
                error.contains(&triangles.max(vertices).to_string()) && error.contains("at most"),
                "{error}"
            );
        }
    }
}
