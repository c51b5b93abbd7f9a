//! An answer about a frame depends on that frame's positions and the query alone: not on earlier
//! frames, earlier queries, the bodies that were named, or refused frames in between.

use super::*;
use nearmiss::Rows;
use nearmiss::device::Buffer;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number};
use support::cases;

/// Positions of a body at both ends of the last step.
#[derive(Clone, Debug, PartialEq)]
enum Place {
    Vertices([Positions; 2]),
    Poses([Pose; 2]),
    Fixed,
}

impl Place {
    /// Positions of a body after a frame that does not name it: the end of its step.
    fn rests(&mut self) {
        match self {
            Place::Vertices([t0, t1]) => *t0 = t1.clone(),
            Place::Poses([start, end]) => *start = *end,
            Place::Fixed => {}
        }
    }

    /// As a frame names it: at one end if it rests, or at both.
    fn input(&self, at_both: bool) -> Option<Motion<'_>> {
        Some(match self {
            Place::Vertices([t0, t1]) if t0 == t1 && !at_both => Motion::positions(t0),
            Place::Vertices([t0, t1]) => Motion::step(t0, t1),
            Place::Poses([start, end]) if start == end && !at_both => Motion::pose(*start),
            Place::Poses(poses) => Motion::PoseStep((*poses).into()),
            Place::Fixed => return None,
        })
    }
}

/// A body and where it is.
struct Placed {
    id: BodyId,
    /// As it was added.
    body: Body,
    place: Place,
}

/// A body of any kind, in or near a unit cube; sometimes in doubles.
fn body(rng: &mut SmallRng) -> (Body, Place) {
    let is_f64 = rng.random_bool(0.2);
    let mesh = mesh(rng, 0.5, 0.0, is_f64);
    let at = mesh.positions().clone();
    let meets = |is_fixed: bool| CollisionFilter {
        self_collision: (!is_fixed).then_some(true),
        ..CollisionFilter::default()
    };
    match rng.random_range(0..4) {
        0 => (Body::fixed(mesh).with_filter(meets(true)), Place::Fixed),
        1 => (Body::rigid(mesh).with_filter(meets(false)), Place::Poses([Pose::default(); 2])),
        _ => (Body::deformable(mesh).with_filter(meets(false)), Place::Vertices([at.clone(), at])),
    }
}

/// The next place of a body: on from the last one, or anywhere; a step, or no motion.
fn next(rng: &mut SmallRng, place: &Place) -> Place {
    let moves = rng.random_bool(0.7);
    match place {
        Place::Vertices([_, end]) => {
            let start = if rng.random_bool(0.5) { end.clone() } else { moved(rng, end, 0.1) };
            let end = if moves { moved(rng, &start, 0.2) } else { start.clone() };
            Place::Vertices([start, end])
        }
        Place::Poses([_, end]) => {
            let start = if rng.random_bool(0.5) { *end } else { pose(rng) };
            Place::Poses([start, if moves { pose(rng) } else { start }])
        }
        Place::Fixed => Place::Fixed,
    }
}

/// The same bodies in a detector that was made for this frame.
fn fresh(bodies: &[Placed], query: Query) -> Contacts {
    let mut scene = Scene::new();
    for placed in bodies {
        let body = placed.body.clone();
        let body = match placed.place.input(false) {
            Some(input) => body.at(input).expect("a place"),
            None => body,
        };
        scene.add(body);
    }
    let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
    detector.detect().expect("an answer")
}

/// Numbers of the caller's, for one frame.
enum Arrays {
    Rows([Buffer<f64>; 2]),
    Poses([[Buffer<f64>; 2]; 2]),
}

impl Arrays {
    fn new(place: &Place) -> Option<Arrays> {
        let device = engine();
        let upload = |numbers: &[f64]| device.upload(numbers).expect("memory");
        Some(match place {
            Place::Vertices(ends) => {
                Arrays::Rows(ends.each_ref().map(|end| upload(end.to_f64().as_flattened())))
            }
            Place::Poses(ends) => {
                Arrays::Poses(ends.map(|pose| [upload(&pose.translation), upload(&pose.rotation)]))
            }
            Place::Fixed => return None,
        })
    }

    /// As a frame names it.
    fn input(&self) -> DeviceMotion {
        // SAFETY: the buffers live and stay as they are until the frame has been answered.
        let rows = |buffer: &Buffer<f64>, width: usize| unsafe {
            DeviceRows::new(buffer.span().addr(), buffer.len() / width, 8 * width, Number::F64).expect("rows")
        };
        match self {
            Arrays::Rows(ends) => DeviceMotion::Step(ends.each_ref().map(|end| rows(end, 3))),
            Arrays::Poses(ends) => DeviceMotion::PoseStep(ends.each_ref().map(|[translation, rotation]| {
                DevicePose { translation: rows(translation, 3), rotation: rows(rotation, 4) }
            })),
        }
    }

    /// Overwrites them.
    fn spoil(&mut self) {
        let buffers: Vec<&mut Buffer<f64>> = match self {
            Arrays::Rows(ends) => ends.iter_mut().collect(),
            Arrays::Poses(ends) => ends.as_flattened_mut().iter_mut().collect(),
        };
        for buffer in buffers {
            let spoilt = vec![f64::NAN; buffer.len()];
            buffer.write(&spoilt).expect("written");
        }
    }
}

/// A detector's life, frame after frame, each compared with a detector that was made for it; how
/// many contacts there were.
fn life(seed: u64, query: Query, fault: impl Fn(&mut Contacts)) -> Result<usize, String> {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut bodies: Vec<Placed> = Vec::new();
    let mut scene = Scene::new();
    for _ in 0..rng.random_range(2..5) {
        let (body, place) = body(&mut rng);
        bodies.push(Placed { id: scene.add(body.clone()), body, place });
    }
    let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
    let mut all = 0;
    for frame in 0..8 {
        if rng.random_bool(0.2) {
            refused(&mut detector, &bodies);
        }
        if rng.random_bool(0.2) {
            detector.detect().expect("an answer");
        }
        if rng.random_bool(0.2) {
            detector.rebuild().expect("built");
        }
        if rng.random_bool(0.2) {
            edit(&mut rng, &mut detector, &mut bodies);
        }
        let mut arrays = Vec::new();
        let mut named = Vec::new();
        for placed in &mut bodies {
            if rng.random_bool(0.6) {
                placed.place = next(&mut rng, &placed.place);
                named.push((placed.id, rng.random_bool(0.4)));
            } else {
                placed.place.rests();
            }
        }
        let mut inputs = Vec::new();
        for (id, in_arrays) in named {
            let placed = bodies.iter().find(|placed| placed.id == id).expect("a body");
            // A frame of a query in motion has a body at both ends.
            let at_both = inputs.is_empty() && !query.kind().is_at_rest();
            match (Arrays::new(&placed.place).filter(|_| in_arrays), placed.place.input(at_both)) {
                (Some(numbers), _) => {
                    inputs.push((id, Motion::OnDevice(numbers.input())));
                    arrays.push(numbers);
                }
                (None, Some(input)) => inputs.push((id, input)),
                (None, None) => {}
            }
        }
        let mut found = detector.frame(&inputs).expect("an answer");
        arrays.iter_mut().for_each(Arrays::spoil);
        fault(&mut found);
        let wanted = fresh(&bodies, query);
        if renumbered(&bodies, &found) != wanted.rows {
            return Err(format!(
                "frame {frame} of seed {seed}, {query:?}: {:?}, made for it {:?}",
                found.rows, wanted.rows
            ));
        }
        all += found.len();
    }
    Ok(all)
}

/// A frame that is refused, of a body that there is.
fn refused(detector: &mut OneQuery, bodies: &[Placed]) {
    let nan = |positions: &Positions| Positions::F64(vec![[f64::NAN; 3]; positions.len()]);
    for placed in bodies {
        let refused = match &placed.place {
            Place::Vertices([t0, t1]) => {
                let bad = nan(t1);
                detector.frame(&[(placed.id, Motion::step(t0, &bad))])
            }
            Place::Poses(_) => detector.frame(&[(placed.id, Motion::pose(Pose::at([f64::NAN; 3])))]),
            Place::Fixed => detector.frame(&[(placed.id, Motion::pose(Pose::default()))]),
        };
        assert!(refused.is_err());
    }
}

/// A body comes, or one goes.
fn edit(rng: &mut SmallRng, detector: &mut OneQuery, bodies: &mut Vec<Placed>) {
    if bodies.len() > 2 && rng.random_bool(0.5) {
        let gone = bodies.remove(rng.random_range(0..bodies.len()));
        detector.remove(gone.id).expect("a body");
    } else {
        let (body, place) = body(rng);
        let id = detector.add(body.clone()).expect("room");
        bodies.push(Placed { id, body, place });
    }
    // A number that was free is taken again: bodies are listed in the order of their numbers.
    bodies.sort_by_key(|placed| placed.id);
}

/// An answer with bodies numbered as in a scene that has no gaps.
fn renumbered(bodies: &[Placed], contacts: &Contacts) -> Rows {
    let mut scene = Scene::new();
    let places: Vec<BodyId> = bodies.iter().map(|_| scene.add(bodies[0].body.clone())).collect();
    let place =
        |id: BodyId| places[bodies.iter().position(|placed| placed.id == id).expect("a body of the scene")];
    let mut answer = contacts.rows.clone();
    match &mut answer {
        Rows::Pairs(all) => all.iter_mut().for_each(|row| row.bodies = row.bodies.map(place)),
        Rows::Contacts(all) => all.iter_mut().for_each(|row| row.bodies = row.bodies.map(place)),
        Rows::Near(all) => all.iter_mut().for_each(|row| row.bodies = row.bodies.map(place)),
        Rows::Distance(nearest) => nearest.iter_mut().for_each(|row| row.bodies = row.bodies.map(place)),
        Rows::BodyPairs(all) => all.to_mut().iter_mut().for_each(|row| row.bodies = row.bodies.map(place)),
        Rows::BodyDistances(all) => {
            all.to_mut().iter_mut().for_each(|row| row.bodies = row.bodies.map(place))
        }
        Rows::Earliest(_) => {}
    }
    answer
}

#[test]
fn a_frame_depends_on_its_positions_alone() {
    let (mut found, seeds) = (0, cases(2, 12));
    for (at, query) in queries().into_iter().enumerate() {
        // Every query has other seeds.
        for seed in (0..seeds).map(|seed| (at + seed) % 12) {
            found += life(seed as u64, query, |_| ()).unwrap_or_else(|difference| panic!("{difference}"));
        }
    }
    assert!(found > 300 * seeds, "{found}");
}

/// A comparison that nothing passes would be none.
#[test]
fn a_forgotten_contact_is_named() {
    let forget = |contacts: &mut Contacts| {
        if let Rows::Contacts(all) = &mut contacts.rows {
            all.to_mut().pop();
        }
    };
    let named = (0..8).filter_map(|seed| life(seed, Query::continuous(), forget).err()).next();
    assert!(named.expect("a difference").contains("made for it"));
}

/// A query at rest, of a body at both ends of a step: first at the start of the step, then, not
/// named, at its end. `end` is the expected end of the first answer. Returns whether the ends could
/// be distinguished.
fn at_rest(seed: u64, query: Query, end: usize) -> Result<bool, String> {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut bodies: Vec<Placed> = Vec::new();
    let mut scene = Scene::new();
    for _ in 0..3 {
        let (body, place) = body(&mut rng);
        let place = next(&mut rng, &place);
        bodies.push(Placed { id: scene.add(body.clone()), body, place });
    }
    let at = |end: usize| {
        let one = |place: &Place| match place {
            Place::Vertices(ends) => Place::Vertices([ends[end].clone(), ends[end].clone()]),
            Place::Poses(ends) => Place::Poses([ends[end]; 2]),
            Place::Fixed => Place::Fixed,
        };
        let moved =
            |placed: &Placed| Placed { id: placed.id, body: placed.body.clone(), place: one(&placed.place) };
        fresh(&bodies.iter().map(moved).collect::<Vec<_>>(), query).rows
    };
    let steps: Vec<(BodyId, Motion)> =
        bodies.iter().filter_map(|placed| Some((placed.id, placed.place.input(true)?))).collect();
    let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
    let first = detector.frame(&steps).expect("an answer");
    let second = detector.frame(&[]).expect("an answer");
    detector.update(&steps).expect("placed");
    let placed = detector.detect().expect("an answer");
    for (name, found, wanted) in
        [("frame", first.rows, at(end)), ("place", placed.rows, at(end)), ("rest", second.rows, at(1))]
    {
        if found != wanted {
            return Err(format!("{name} of seed {seed}, {query:?}: {found:?}, at one end {wanted:?}"));
        }
    }
    Ok(at(0) != at(1))
}

#[test]
fn a_query_at_rest_answers_where_a_step_begins() {
    let mut told_apart = 0;
    for query in queries().into_iter().filter(|query| query.kind().is_at_rest()) {
        for seed in 0..20 {
            let is_told = at_rest(seed, query, 0).unwrap_or_else(|difference| panic!("{difference}"));
            told_apart += usize::from(is_told);
            assert!(
                !is_told || at_rest(seed, query, 1).is_err(),
                "the other end passes: seed {seed}, {query:?}"
            );
        }
    }
    assert!(told_apart > 40, "{told_apart}");
}
