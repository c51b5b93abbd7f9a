//! An answer about a frame depends on that frame's positions and the query alone: a body that no
//! frame names is where its step ended.

use super::*;
use nearmiss::Device;
use nearmiss::device::Buffer;
use nearmiss::query::QueryKind;
use nearmiss::research::KindExt;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number};
use nearmiss_lab::OneQueryOnSeveral;

/// Place of a body: at both ends of the last step that named it, or at its end twice.
#[derive(Clone)]
enum Place {
    Points([Positions; 2]),
    Poses([Pose; 2]),
    Fixed,
}

impl Place {
    fn random(rng: &mut SmallRng, body: &Body, steps: bool) -> Place {
        if body.kind() == nearmiss::scene::BodyKind::Rigid {
            let mut one = || pose(rng, [0.0; 3], 0.3);
            let start = one();
            return Place::Poses([start, if steps { one() } else { start }]);
        }
        let mut one = || {
            let by: [f32; 3] = [(); 3].map(|()| rng.random_range(-0.3..0.3));
            let points = body.positions_t0().to_f64();
            Positions::F32(points.iter().map(|p| [0, 1, 2].map(|k| p[k] as f32 * 0.9 + by[k])).collect())
        };
        let start = one();
        Place::Points([start.clone(), if steps { one() } else { start }])
    }

    fn rest(&mut self) {
        match self {
            Place::Points([start, end]) => start.clone_from(end),
            Place::Poses([start, end]) => *start = *end,
            Place::Fixed => {}
        }
    }

    /// As an input of a frame: with both ends, or one if they are the same.
    fn input(&self) -> Option<Motion<'_>> {
        match self {
            Place::Points([start, end]) if start == end => Some(Motion::positions(start)),
            Place::Points([start, end]) => Some(Motion::step(start, end)),
            Place::Poses([start, end]) if start == end => Some(Motion::pose(*start)),
            Place::Poses(poses) => Some(Motion::PoseStep((*poses).into())),
            Place::Fixed => None,
        }
    }
}

/// Memory of the caller's, which is overwritten when it is given back.
enum Held {
    Points([Buffer<[f32; 3]>; 2]),
    Poses([Buffer<[f64; 7]>; 2]),
}

impl Held {
    fn of(device: &Device, place: &Place) -> Option<Held> {
        let mut held = match place {
            Place::Points([t0, _]) => {
                Held::Points([(); 2].map(|()| device.buffer(t0.len()).expect("memory")))
            }
            Place::Poses(_) => Held::Poses([(); 2].map(|()| device.buffer(1).expect("memory"))),
            Place::Fixed => return None,
        };
        held.write(place);
        Some(held)
    }

    fn write(&mut self, place: &Place) {
        match (self, place) {
            (Held::Points(buffers), Place::Points(ends)) => {
                for (buffer, end) in buffers.iter_mut().zip(ends) {
                    let Positions::F32(points) = end else { panic!("in single precision") };
                    buffer.write(points).expect("written");
                }
            }
            (Held::Poses(buffers), Place::Poses(poses)) => {
                for (buffer, Pose { rotation: [x, y, z, w], translation: [a, b, c] }) in
                    buffers.iter_mut().zip(*poses)
                {
                    buffer.write(&[[a, b, c, x, y, z, w]]).expect("written");
                }
            }
            _ => panic!("another kind"),
        }
    }

    fn input(&self, steps: bool) -> DeviceMotion {
        // SAFETY: the test keeps the memory until the frame is answered.
        let rows =
            |at, len, stride, number| unsafe { DeviceRows::new(at, len, stride, number) }.expect("rows");
        match self {
            Held::Points(ends) => {
                let [t0, t1] = ends.each_ref().map(|end| rows(end.span().addr(), end.len(), 12, Number::F32));
                if steps { DeviceMotion::Step([t0, t1]) } else { DeviceMotion::Positions(t0) }
            }
            Held::Poses(ends) => {
                let [t0, t1] = ends.each_ref().map(|end| DevicePose {
                    translation: rows(end.span().addr(), 1, 0, Number::F64),
                    rotation: rows(end.span().addr() + 24, 1, 0, Number::F64),
                });
                if steps { DeviceMotion::PoseStep([t0, t1]) } else { DeviceMotion::Pose(t0) }
            }
        }
    }

    fn spoil(&mut self) {
        match self {
            Held::Points(ends) => ends.iter_mut().for_each(|end| end.fill(0xff).expect("written")),
            Held::Poses(ends) => ends.iter_mut().for_each(|end| end.fill(0xff).expect("written")),
        }
    }
}

fn bodies(seed: u64) -> Vec<Body> {
    let mesh = |k| scene::soup(12, 20 * seed + k, false).expect("a soup").frames().swap_remove(0);
    let kinds = [Body::rigid, Body::deformable, Body::rigid, Body::deformable, Body::fixed];
    (0..).zip(kinds).map(|(k, kind)| kind(mesh(k))).collect()
}

fn start(body: &Body) -> Place {
    match body.kind() {
        nearmiss::scene::BodyKind::Rigid => Place::Poses(body.poses()),
        nearmiss::scene::BodyKind::Fixed => Place::Fixed,
        _ => Place::Points(body.ends().map(Clone::clone)),
    }
}

/// A detector, and the place of every body by its inputs so far.
struct Told {
    device: Device,
    detector: OneQuery,
    query: Query,
    bodies: Vec<(BodyId, Body, Place)>,
    /// Whether what rests is forgotten to be moved: a fault of the judge.
    is_planted: bool,
    told: Vec<String>,
}

impl Told {
    fn new(seed: u64, query: Query, is_planted: bool) -> Told {
        let device = engine();
        let mut scene = Scene::new();
        let add = |body: Body| (scene.add(body.clone()), start(&body), body);
        let bodies = bodies(seed).into_iter().map(add).map(|(id, place, body)| (id, body, place)).collect();
        let detector = OneQuery::new(device.clone(), scene, query).expect("a detector");
        Told { device, detector, query, bodies, is_planted, told: Vec::new() }
    }

    /// The answer of a fresh detector with all positions.
    fn fresh(&self) -> String {
        let mut scene = Scene::new();
        let mut all: Vec<_> = self.bodies.iter().collect();
        all.sort_by_key(|(id, ..)| *id);
        let at = |(_, body, place): &&(BodyId, Body, Place)| match place.input() {
            Some(input) => body.clone().at(input).expect("a place"),
            None => body.clone(),
        };
        let ids: Vec<BodyId> = all.iter().map(|own| scene.add(at(own))).collect();
        assert!(ids.iter().zip(&all).all(|(id, (own, ..))| id == own), "numbers without gaps");
        let mut detector = OneQuery::new(engine(), scene, self.query).expect("a detector");
        rows(&detector.detect().expect("an answer"))
    }

    fn judge(&mut self, found: &Contacts, what: &str) {
        if rows(found) != self.fresh() {
            self.told.push(what.to_owned());
        }
    }

    /// Some of the bodies that move go to new places, the others rest.
    fn go(&mut self, rng: &mut SmallRng, rests: bool) -> Vec<(usize, bool)> {
        let mut named = Vec::new();
        for (k, (_, body, place)) in self.bodies.iter_mut().enumerate() {
            if !matches!(place, Place::Fixed) && rng.random_bool(0.4) {
                // A frame of a query in motion has a body at both ends.
                let moves = named.is_empty() && !self.query.kind().is_at_rest();
                let steps = rng.random_bool(0.7) || moves;
                *place = Place::random(rng, body, steps);
                named.push((k, steps));
            } else if rests && !self.is_planted {
                place.rest();
            }
        }
        named
    }

    fn frame(&mut self, rng: &mut SmallRng, places: bool) {
        let named = self.go(rng, true);
        let mut held: Vec<Option<Held>> = named
            .iter()
            .map(
                |&(k, _)| if rng.random_bool(0.5) { Held::of(&self.device, &self.bodies[k].2) } else { None },
            )
            .collect();
        let inputs: Vec<(BodyId, Motion)> = named
            .iter()
            .zip(&held)
            .filter_map(|(&(k, steps), held)| {
                let (id, _, place) = &self.bodies[k];
                let lent = held.as_ref().map(|held| Motion::OnDevice(held.input(steps)));
                Some((*id, lent.or_else(|| place.input())?))
            })
            .collect();
        let found = if places {
            self.detector.update(&inputs).and_then(|()| self.detector.detect())
        } else {
            self.detector.frame(&inputs)
        };
        held.iter_mut().flatten().for_each(Held::spoil);
        self.judge(&found.expect("an answer"), if places { "update" } else { "frame" });
    }

    /// A frame that is prepared, and another that is submitted.
    fn submit(&mut self, rng: &mut SmallRng) {
        let named = self.go(rng, true);
        let mut held: Vec<Held> =
            named.iter().filter_map(|&(k, _)| Held::of(&self.device, &self.bodies[k].2)).collect();
        let inputs: Vec<(BodyId, DeviceMotion)> = named
            .iter()
            .zip(&held)
            .map(|(&(k, steps), held)| (self.bodies[k].0, held.input(steps)))
            .collect();
        let found = self.detector.prepare(&inputs).expect("an answer");
        self.judge(&found, "prepare");
        if !self.is_planted {
            self.bodies.iter_mut().for_each(|(.., place)| place.rest());
        }
        for (&(k, steps), held) in named.iter().zip(&mut held) {
            let (_, body, place) = &mut self.bodies[k];
            *place = Place::random(rng, body, steps);
            held.write(place);
        }
        self.detector.submit().expect("submitted");
        let found = self.detector.collect().expect("an answer");
        held.iter_mut().for_each(Held::spoil);
        self.judge(&found, "submit");
    }

    /// A frame that is refused, and changes nothing.
    fn refused(&mut self, rng: &mut SmallRng) {
        let movers: Vec<&(BodyId, Body, Place)> =
            self.bodies.iter().filter(|(.., place)| !matches!(place, Place::Fixed)).collect();
        let (good, bad) = (movers[0], movers[rng.random_range(1..movers.len())]);
        let elsewhere = Place::random(rng, &good.1, true);
        let nowhere = match &bad.2 {
            Place::Points([t0, _]) => {
                Place::Points([(); 2].map(|()| Positions::F32(vec![[f32::NAN; 3]; t0.len()])))
            }
            _ => Place::Poses([Pose::at([f64::NAN; 3]); 2]),
        };
        let lent = Held::of(&self.device, &nowhere).map(|held| (held.input(true), held)).expect("memory");
        let wrong = match rng.random_bool(0.5) {
            true => Motion::OnDevice(lent.0),
            false => nowhere.input().expect("a place"),
        };
        let inputs = [(good.0, elsewhere.input().expect("a place")), (bad.0, wrong)];
        assert!(self.detector.frame(&inputs).is_err());
        let found = self.detector.detect().expect("an answer");
        self.judge(&found, "refused");
    }

    fn edit(&mut self, rng: &mut SmallRng) {
        let fresh = bodies(rng.random_range(0..9));
        let body = fresh[rng.random_range(0..fresh.len())].clone();
        if rng.random_bool(0.4) {
            let id = self.detector.add(body.clone()).expect("added");
            self.bodies.push((id, body.clone(), start(&body)));
        } else {
            let k = rng.random_range(0..self.bodies.len());
            let id = self.bodies[k].0;
            if rng.random_bool(0.5) {
                self.detector.remove(id).expect("removed");
                assert_eq!(self.detector.add(body.clone()).expect("added"), id);
            } else {
                self.detector.replace(id, body.clone()).expect("replaced");
            }
            self.bodies[k] = (id, body.clone(), start(&body));
        }
        let found = self.detector.detect().expect("an answer");
        self.judge(&found, "edit");
    }
}

fn hunt(kind: QueryKind, seed: u64, is_planted: bool) -> Vec<String> {
    let mut rng = SmallRng::seed_from_u64(100 * seed + 7);
    let mut told = Told::new(seed, support::asked::at(kind, 1e-4, 0.05), is_planted);
    for _ in 0..16 {
        match rng.random_range(0..12) {
            0..=5 => told.frame(&mut rng, false),
            6 => told.frame(&mut rng, true),
            7 => told.refused(&mut rng),
            8 => told.edit(&mut rng),
            9 => told.detector.download_positions().expect("fetched"),
            10 => told.detector.rebuild().expect("built"),
            _ => told.submit(&mut rng),
        }
    }
    told.told.into_iter().map(|what| format!("{kind:?} {seed}: {what}")).collect()
}

#[test]
fn a_frame_is_its_positions() {
    for kind in support::asked::KINDS {
        for seed in 0..support::cases(4, 12) as u64 {
            let told = hunt(kind, seed, false);
            assert!(told.is_empty(), "{told:?}");
        }
    }
}

/// A judge that does not move what rests disagrees, in every kind of query.
#[test]
fn a_body_that_does_not_rest_is_found_out() {
    for kind in support::asked::KINDS {
        assert!((0..4).any(|seed| !hunt(kind, seed, true).is_empty()), "{kind:?}");
    }
}

#[test]
fn on_several_devices_too() {
    for kind in support::asked::KINDS.into_iter().filter(|kind| kind.takes_traversals()) {
        let mut rng = SmallRng::seed_from_u64(3);
        let mut told = Told::new(1, support::asked::at(kind, 1e-4, 0.05), false);
        let scene = told.detector.scene().clone();
        let mut several =
            OneQueryOnSeveral::new(vec![engine(), engine()], scene, told.query).expect("detectors");
        for step in 0..12 {
            let named = told.go(&mut rng, true);
            let inputs: Vec<(BodyId, Motion)> = named
                .iter()
                .filter_map(|&(k, _)| Some((told.bodies[k].0, told.bodies[k].2.input()?)))
                .collect();
            let found = several.frame(&inputs).expect("an answer");
            if step == 5 {
                let body = bodies(8).swap_remove(0);
                let id = several.add(&body).expect("added");
                told.bodies.push((id, body.clone(), start(&body)));
                let found = several.detect().expect("an answer");
                told.judge(&found, "added");
            } else {
                told.judge(&found, "frame");
            }
        }
        assert!(told.told.is_empty(), "{kind:?}: {:?}", told.told);
    }
}
