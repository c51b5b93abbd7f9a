//! The contacts at the earliest time on the device: those that `first_contacts` returns, bit by bit.

mod parts;
mod rigid;

use super::*;
use nearmiss::contacts::on_device::{DeviceExtras, Hit};
use nearmiss::contacts::{Contact, DeviceAnswer, DeviceList, Kind, Status};
use nearmiss::research::{Certified, CertifiedPrecision, ContinuousSolver, Precision, WithSolver};
use nearmiss::{Continuous, Detector, Earliest, MultiDetector, Near};

/// A row: whether it is of edges, its bodies, both features, both times, whether it is undecided.
type Row = (bool, [usize; 2], [u32; 2], [u64; 2], bool);

/// Numbers in the memory of a CPU.
fn read<T: Copy>(list: DeviceList, count: u64) -> Vec<T> {
    assert!(count as usize <= list.room, "{count} rows in {list:?}");
    if count == 0 {
        return Vec::new();
    }
    // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
    unsafe { std::slice::from_raw_parts(list.address as *const T, count as usize) }.to_vec()
}

fn status_of(answer: &DeviceAnswer) -> FrameStatus {
    // SAFETY: as above.
    unsafe { *(answer.status as *const FrameStatus) }
}

/// The rows on the device, in order of their names.
fn on_device(answer: &DeviceAnswer) -> Vec<Row> {
    let status = status_of(answer);
    let place = |of: usize, number: u32| {
        let body = answer.starts.iter().rposition(|first| first[of] <= number).expect("a body");
        (body, number - answer.starts[body][of])
    };
    let mut rows = Vec::new();
    for (is_edges, count) in [(false, status.first), (true, status.second)] {
        for hit in read::<Hit>(answer.lists[usize::from(is_edges)], count) {
            let of = if is_edges { [2, 2] } else { [0, 1] };
            let [(a, first), (b, second)] = [place(of[0], hit.a), place(of[1], hit.b)];
            let times = [hit.verdict.toi, hit.verdict.toi_upper].map(f64::to_bits);
            rows.push((is_edges, [a, b], [first, second], times, !hit.verdict.is_contact()));
        }
    }
    rows.sort_unstable();
    rows
}

/// The rows of an answer, in the same order.
fn by_host(rows: &[Contact]) -> Vec<Row> {
    let row = |own: &Contact| {
        let times = [own.toi, own.toi_upper].map(f64::to_bits);
        let is_undecided = own.status == Status::Undecided;
        let bodies = own.bodies.map(|body| body.index());
        (own.kind == Kind::Ee, bodies, [own.feature_a, own.feature_b], times, is_undecided)
    };
    let mut rows: Vec<Row> = rows.iter().map(row).collect();
    rows.sort_unstable();
    rows
}

/// The first difference, in words.
fn difference(own: &[Row], wanted: &[Row]) -> Option<String> {
    if let Some(row) = wanted.iter().find(|row| !own.contains(row)) {
        return Some(format!("a contact is missing: {row:?}"));
    }
    if let Some(row) = own.iter().find(|row| !wanted.contains(row)) {
        return Some(format!("a contact of another time, or none: {row:?}"));
    }
    (own.len() != wanted.len()).then(|| "a contact is there twice".into())
}

/// A scene with one body that the caller moves, and its positions in each frame.
struct Case {
    scene: Scene,
    id: BodyId,
    frames: Vec<[Vec<[f32; 3]>; 2]>,
}

/// A soup whose triangles move more and more, rest, cross at the start, and stay apart.
fn soups(n: usize) -> Case {
    let (scene, id, [t0, t1]) = pair(n);
    let spread = |points: &[[f32; 3]]| {
        let of = |triangle: &[[f32; 3]]| {
            let by = triangle[0].map(|x| 40.0 * x);
            triangle.iter().map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2] + 90.0]).collect::<Vec<_>>()
        };
        points.chunks(3).flat_map(of).collect::<Vec<_>>()
    };
    let mut frames: Vec<_> = (0..3).map(|frame| [moved(&t0, frame), moved(&t1, 2 * frame)]).collect();
    frames.push([spread(&t0), spread(&t0)]);
    frames.push([t1, t0]);
    Case { scene, id, frames }
}

/// A floor of two triangles, and tetrahedra whose tips fall by 2 from these heights: a frame each.
fn falling(frames: &[&dyn Fn(usize) -> f32], tips: usize) -> Case {
    let mut faces = vec![[0, 1, 2], [2, 1, 3]];
    let wide = 2.0 * tips as f32 + 9.0;
    let floor = [[-1.0, -1.0, 0.0], [wide, -1.0, 0.0], [-1.0, 9.0, 0.0], [wide, 9.0, 0.0]];
    let points = |height: &dyn Fn(usize) -> f32, by: f32| {
        let tip = |i: usize| {
            let (x, z) = (2.0 * i as f32, height(i) - by);
            [[x, 1.0, z], [x + 1.0, 1.0, z + 1.0], [x, 2.0, z + 1.0], [x - 0.5, 0.5, z + 1.0]]
        };
        floor.into_iter().chain((0..tips).flat_map(tip)).collect::<Vec<_>>()
    };
    for i in 0..tips as u32 {
        let first = 4 + 4 * i;
        faces.extend([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]].map(|face| face.map(|k| first + k)));
    }
    let frames: Vec<_> = frames.iter().map(|height| [points(height, 0.0), points(height, 2.0)]).collect();
    let mesh = Mesh::new("falling", Positions::F32(frames[0][0].clone()), faces).expect("a mesh");
    let mut scene = Scene::new();
    let id = scene.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision()));
    Case { scene, id, frames }
}

fn wanted() -> DeviceExtras {
    DeviceExtras::default().with_first_contacts()
}

/// Seen over the frames of a case: rows, frames without any, and submissions that were too short.
#[derive(Debug, Default, PartialEq)]
struct Seen {
    rows: usize,
    most: usize,
    empty: u32,
    short: u32,
}

/// Submits each frame, and compares with the contacts that the host returns.
fn compared(device: &Device, case: &Case, query: Earliest) -> Seen {
    let of = |device: &Device| Detector::new(device.clone(), case.scene.clone()).expect("a detector");
    let (mut detector, mut host) = (of(device), of(&engine()));
    let mut memory = case.frames[0].each_ref().map(|points| Points::new(device, points));
    let input = [(case.id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let named = Query::from(query);
    let mut seen = Seen::default();
    for ends in &case.frames {
        ends.iter().zip(&mut memory).for_each(|(points, to)| to.write(points));
        let [t0, t1] = ends.each_ref().map(|points| Positions::F32(points.clone()));
        host.update(&[(case.id, Motion::step(&t0, &t1))]).expect("placed");
        let first = host.query(&query).expect("an answer");
        let contacts = host.first_contacts(&first).expect("contacts");
        loop {
            if !detector.is_prepared() {
                detector.prepare_with(&input, &[named], &wanted()).expect("prepared");
            }
            let before = (device.allocations(), device.waits());
            detector.submit().expect("submitted");
            assert_eq!((device.allocations(), device.waits()), before, "{query:?}");
            let answer = detector.on_device(&named).expect("prepared");
            let is_short = status_of(&answer).short > 0;
            let rows = if is_short { Vec::new() } else { on_device(&answer) };
            let found = detector.collect(&query).expect("an answer");
            assert_eq!((found.rows, found.starts_crossing), (first.rows, first.starts_crossing), "{query:?}");
            assert_eq!(detector.is_prepared(), !is_short);
            if is_short {
                seen.short += 1;
                continue;
            }
            assert_eq!(difference(&rows, &by_host(&contacts)), None, "{query:?}");
            (seen.rows, seen.most) = (seen.rows + rows.len(), seen.most.max(rows.len()));
            seen.empty += u32::from(rows.is_empty());
            break;
        }
    }
    seen
}

fn certified(change: impl FnOnce(&mut Certified)) -> Earliest {
    let mut certified = Certified { tolerance: Some(1e-4), ..Certified::default() };
    change(&mut certified);
    Earliest::by(certified)
}

/// Every solver, with a separation, and of what approaches.
fn queries() -> Vec<Earliest> {
    let precisions = [CertifiedPrecision::Mixed, CertifiedPrecision::F32, CertifiedPrecision::F64];
    let mut all: Vec<Earliest> =
        precisions.map(|precision| certified(|own| own.precision = precision)).into();
    all.extend(
        precisions.map(|precision| certified(|own| (own.precision, own.min_separation) = (precision, 0.01))),
    );
    all.push(certified(|own| (own.min_separation, own.approaching) = (0.01, true)));
    all.extend([Precision::F32, Precision::F64].map(|own| Earliest::by(ContinuousSolver::Cubic(own))));
    all
}

#[test]
fn rows_on_the_device_are_those_of_the_host() {
    let case = soups(120);
    for device in ORDERS.map(sanitizer).into_iter().chain([engine()]) {
        for query in queries() {
            let seen = compared(&device, &case, query);
            assert!(seen.rows >= 4 && seen.empty >= 1, "{query:?}: {seen:?}");
        }
    }
}

#[test]
fn every_way_to_candidates_has_the_same_rows() {
    let case = soups(90);
    let mut all = Vec::new();
    for way in support::ways(certified(|_| {}).into()) {
        if way.search().traversal.is_some_and(needs_the_host) {
            continue;
        }
        let Query::Earliest(query) = way else { panic!("an earliest query") };
        all.push(compared(&engine(), &case, query));
    }
    assert!(all.len() > 5 && all.iter().all(|seen| seen.rows == all[0].rows), "{all:?}");
}

/// A scene with a sample: the pass reads pairs that the bound of the sample has left.
#[test]
fn a_large_scene_has_a_sample_and_the_same_rows() {
    let seen = compared(&engine(), &soups(66_000), certified(|_| {}));
    assert!(seen.rows >= 4, "{seen:?}");
}

/// Many contacts at one time: all of them are there. A list that is too short is reported, grows, and
/// the next preparation has room.
#[test]
fn lists_of_many_contacts_at_once_grow() {
    let one = |i: usize| if i == 7 { 0.5 } else { 1.0 + 1e-3 * (i % 97) as f32 };
    let all = |_: usize| 1.25;
    let none = |_: usize| 3.0;
    let case = falling(&[&one, &all, &none, &one, &all], 2_500);
    let seen = compared(&engine(), &case, Earliest::default());
    assert!(seen.most > 2_400 && seen.empty == 1, "{seen:?}");
    assert_eq!(seen.short, 1, "{seen:?}");
}

/// Tips that touch the floor at the start have time 0, and so have all that cross it.
#[test]
fn contacts_at_the_start_are_there() {
    let touching = |i: usize| if i.is_multiple_of(3) { 0.0 } else { 0.5 };
    let crossing = |i: usize| if i.is_multiple_of(4) { -0.5 } else { 0.25 };
    let case = falling(&[&touching, &crossing], 40);
    for device in [engine(), sanitizer(ORDERS[0])] {
        for query in queries() {
            let seen = compared(&device, &case, query);
            // Pairs that approach have times of their own.
            let most = if query.certified().is_some_and(|own| own.approaching) { 1 } else { 10 };
            assert!(seen.most >= most, "{query:?}: {seen:?}");
        }
    }
}

/// A thickness is part of the distance that is tested: of one radius, of radii that differ, and of
/// triangles some of which have none. Features without a thickness have a solver of their own.
#[test]
fn thick_bodies_have_their_first_contacts() {
    let soup = soups(90);
    let count = soup.frames[0][0].len();
    let every = |radius: &dyn Fn(usize) -> f64| (0..count).map(radius).collect::<Vec<_>>();
    let one = every(&|_| 1e-3);
    let uneven = every(&|i| 1e-3 * (1 + i % 5) as f64);
    let some = every(&|i| 1e-3 * (i / 3 % 2) as f64);
    for (first, others) in [(&one, 1e-3), (&uneven, 1e-3), (&one, 0.0), (&some, 0.0)] {
        let mut scene = Scene::new();
        for body in soup.scene.bodies() {
            let is_first = scene.bodies().is_empty();
            scene.add(match is_first {
                true => body.clone().with_thickness(first.clone()),
                false => body.clone().with_thickness(others),
            });
        }
        let case = Case { scene, id: soup.id, frames: soup.frames.clone() };
        let approaching = certified(|own| (own.min_separation, own.approaching) = (0.01, true));
        for query in [Earliest::default(), approaching] {
            let seen = compared(&engine(), &case, query);
            assert!(seen.rows >= 4, "{query:?}, {:?}: {seen:?}", &first[..6]);
        }
    }
}

/// A pair at the time that is dropped, a later one that is kept, a number that differs, and a row that is
/// there twice are each named.
#[test]
fn a_fault_in_the_rows_is_named() {
    let case = falling(&[&|i| if i % 2 == 0 { 0.5 } else { 1.0 }], 8);
    let mut host = Detector::new(engine(), case.scene.clone()).expect("a detector");
    let [t0, t1] = case.frames[0].each_ref().map(|points| Positions::F32(points.clone()));
    host.update(&[(case.id, Motion::step(&t0, &t1))]).expect("placed");
    let first = host.query(&Earliest::default()).expect("an answer");
    let right = by_host(&host.first_contacts(&first).expect("contacts"));
    let all = by_host(host.query(&Continuous::default()).expect("an answer").rows.as_ref());
    assert_eq!((difference(&right, &right), right.len()), (None, 4));
    let named = |own: &[Row]| difference(own, &right).unwrap_or_default();
    assert!(named(&right[1..]).starts_with("a contact is missing"));
    assert!(named(&[]).starts_with("a contact is missing"));
    let later = *all.iter().find(|row| !right.contains(row)).expect("a later contact");
    assert!(named(&[&right[..], &[later]].concat()).starts_with("a contact of another time"));
    let mut other = right.clone();
    other[2].3[1] ^= 1;
    assert!(named(&other).starts_with("a contact is missing"));
    assert!(named(&[&right[..], &right[..1]].concat()).starts_with("a contact is there twice"));
}
