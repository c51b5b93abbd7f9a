//! No refusal is lost: of each query, by each tolerance, each way of being refused, queried,
//! submitted, and submitted again.

use super::*;
use nearmiss::contacts::Contacts;

/// Queries of each kind; of those that have one with tolerances that doubles give, that they do
/// not, and 0.
fn queries() -> Vec<Query> {
    let of = |kind: QueryKind| {
        let all: &[f64] = if kind.is_at_rest() { &[1e-4] } else { &[1e-4, 1e-9, 1e-17, 0.0] };
        all.iter().map(move |&tolerance| support::asked::at(kind, tolerance, 0.02)).collect::<Vec<_>>()
    };
    support::asked::KINDS.into_iter().flat_map(of).collect()
}

/// Each of them on the CPU and, with feature `cuda`, on the GPU.
fn queries_on_machines() -> Vec<(Query, Device)> {
    let machines = support::engine_and_gpu();
    queries().into_iter().flat_map(|query| machines.iter().map(move |on| (query, on.clone()))).collect()
}

/// Whether the submitted frame's status reports an invalid vertex or pose. `None` on a GPU, whose memory this test does not read.
fn seen(device: &Device, detector: &OneQuery) -> Option<bool> {
    (!device.is_gpu()).then(|| status(detector).invalid > 0)
}

/// A fault: an answer, where there must be none.
fn lost(what: &str, said: Result<Contacts, Error>, named: &str) -> Option<String> {
    match said {
        Ok(found) => Some(format!("{what}: {} contacts, first at {:?}", found.len(), found.earliest_toi())),
        Err(error) if !error.to_string().contains(named) => Some(format!("{what}: {error}")),
        Err(_) => None,
    }
}

/// Ways of spoiling a vertex, and what names it.
const SPOILT: [(f32, &str); 2] = [(f32::NAN, "NaN"), (f32::NEG_INFINITY, "inf")];

#[test]
fn a_vertex_that_is_no_point_is_refused_every_time() {
    let (scene, id, [t0, t1]) = pair(40);
    for (query, device) in queries_on_machines() {
        for (value, what) in SPOILT {
            let mut bad = t0.clone();
            bad[17][1] = value;
            let mut memory = [&t0, &t1].map(|points| Points::new(&device, points));
            let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
            let mut detector = OneQuery::new(device.clone(), scene.clone(), query).expect("a detector");
            let good = detector.prepare(&[(id, input)]).expect("an answer");
            let mut again = |detector: &mut OneQuery, points: &[[f32; 3]], fetches: bool| {
                memory[0].write(points);
                detector.submit().expect("submitted");
                // Faults on the device are refused there, too.
                let is_bad = !points[17][1].is_finite();
                assert!(seen(&device, detector).is_none_or(|invalid| invalid == is_bad), "{query:?}");
                if fetches {
                    let fetched = detector.download_positions();
                    assert_eq!(fetched.is_err(), is_bad, "{query:?}: {fetched:?}");
                }
                detector.collect()
            };
            for (turn, fetches) in [false, false, true, true].into_iter().enumerate() {
                let name = format!("{query:?}, {what}, turn {turn}");
                let odd = lost(&name, again(&mut detector, &bad, fetches), "vertex 17 has y");
                assert_eq!(odd, None);
                // A frame between those that are refused, and bodies that came back in between.
                let found = again(&mut detector, &t0, false).expect("an answer");
                assert_eq!(found.rows, good.rows, "{name}");
                if turn % 2 == 1 {
                    detector.download_positions().expect("positions");
                }
            }
            // A recording that is launched again reports nothing: the next query finds it.
            memory[0].write(&bad);
            detector.submit().expect("submitted");
            assert_eq!(lost(&format!("{query:?} detected"), detector.detect(), "vertex 17 has y"), None);
            let asked = detector.frame(&[(id, Motion::OnDevice(input))]);
            assert_eq!(lost(&format!("{query:?} asked"), asked, "vertex 17 has y"), None);
            memory[0].write(&t0);
            let found = detector.frame(&[(id, Motion::OnDevice(input))]).expect("an answer");
            assert_eq!(found.rows, good.rows, "{query:?}");
        }
    }
}

#[test]
fn a_pose_that_is_none_is_refused_every_time() {
    let mut scene = Scene::new();
    let rigid = scene.add(Body::rigid(soup(20, 5).0));
    scene.add(Body::deformable(soup(20, 6).0));
    let good = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0f32];
    let wrong = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.2], [0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 1.0]];
    for (query, device) in queries_on_machines() {
        let mut buffer = device.upload(&good).expect("memory");
        let at = buffer.span().addr();
        // SAFETY: the buffer is kept.
        let row = |at| unsafe { DeviceRows::new(at, 1, 0, Number::F32) }.expect("a row");
        let pose = DevicePose { translation: row(at), rotation: row(at + 12) };
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query).expect("a detector");
        let first = detector.prepare(&[(rigid, DeviceMotion::PoseStep([pose; 2]))]).expect("an answer");
        for numbers in wrong.into_iter().cycle().take(4) {
            buffer.write(&numbers).expect("written");
            detector.submit().expect("submitted");
            assert_ne!(seen(&device, &detector), Some(false), "{query:?}");
            assert_eq!(lost(&format!("{query:?}"), detector.collect(), "the pose"), None);
            buffer.write(&good).expect("written");
            detector.submit().expect("submitted");
            assert_eq!(detector.collect().expect("an answer").rows, first.rows, "{query:?}");
            detector.download_positions().expect("a pose");
        }
    }
}

/// Too large for singles is no refusal: all goes over to doubles, and answers as the host's.
#[test]
fn what_singles_cannot_hold_is_answered_in_doubles_every_time() {
    let (scene, id, [t0, t1]) = pair(40);
    let large = |points: &[[f32; 3]]| points.iter().map(|p| p.map(|x| x * 1e25)).collect::<Vec<_>>();
    for (query, device) in queries_on_machines() {
        let mut memory = [&t0, &t1].map(|points| Points::new(&device, points));
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query).expect("a detector");
        detector.prepare(&[(id, input)]).expect("an answer");
        detector.download_positions().expect("positions");
        memory[0].write(&large(&t0));
        memory[1].write(&large(&t1));
        detector.submit().expect("submitted");
        assert_ne!(seen(&device, &detector), Some(false), "{query:?}");
        let found = detector.collect().expect("an answer");
        let ends = [&t0, &t1].map(|points| Positions::F32(large(points)));
        let mut by_host = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
        let wanted = by_host.frame(&[(id, Motion::step(&ends[0], &ends[1]))]).expect("an answer");
        assert_eq!(found.rows, wanted.rows, "{query:?}");
    }
}

/// A refusal that is lost would be named.
#[test]
fn an_answer_instead_of_a_refusal_is_named() {
    let (scene, ..) = pair(40);
    let mut detector = OneQuery::new(engine(), scene, query(QueryKind::Earliest)).expect("a detector");
    let fault = lost("planted", detector.detect(), "vertex 17");
    assert!(fault.is_some_and(|fault| fault.starts_with("planted: 0 contacts")));
    let other = Error::InvalidArgument { what: "another".into(), advice: "reason".into() };
    assert!(lost("planted", Err(other), "vertex 17").is_some_and(|fault| fault.contains("another")));
}
