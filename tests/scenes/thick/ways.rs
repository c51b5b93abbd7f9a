//! The same rows on every machine and by every way: searches, frames, submissions, slices, devices.

use super::*;
use crate::submit::Points;
use nearmiss::contacts::on_device::FrameStatus;
use nearmiss::query::QueryKind;
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::scene::{BodyId, DeviceMotion, Motion};
use nearmiss::{MultiDetector, Query};
use nearmiss_lab::OneQuery;
use support::{machines, some_ways};

fn certified() -> Certified {
    Certified { tolerance: Some(1e-3), ..Certified::default() }
}

/// Every volume, walk and refit; every machine.
#[test]
fn every_machine_and_every_way_has_the_same_rows() {
    for (turn, (name, bodies)) in scenes().into_iter().enumerate() {
        for query in [Query::from(Continuous::by(certified())), Earliest::by(certified()).into()] {
            let mut one = detector(engine(), &bodies);
            let wanted = one.query(&query).expect("an answer");
            for way in some_ways(query, turn) {
                let found = detector(engine(), &bodies).query(&way).expect("an answer");
                assert_eq!(found.rows, wanted.rows, "{name}, {way:?}");
            }
            let mut prints = None;
            for device in machines() {
                let machine = device.name();
                let mut own = OneQuery::new(device, bodies.clone(), query).expect("a detector");
                let found = own.detect().expect("an answer");
                assert_eq!(
                    (&found.rows, found.caveats()),
                    (&wanted.rows, wanted.caveats()),
                    "{name}, {machine}"
                );
                if query.kind() == QueryKind::Continuous {
                    assert_eq!(found.stats.candidates_vf_ee, wanted.stats.candidates_vf_ee, "{machine}");
                    assert_eq!(found.stats.escalated_vf_ee, wanted.stats.escalated_vf_ee, "{machine}");
                }
                let own = own.fingerprints().expect("hashes");
                assert_eq!(prints.get_or_insert_with(|| own.clone()), &own, "{name}, {machine}");
            }
        }
    }
}

/// Bodies that meet ever more: lists grow within frames, and each frame has the rows of a new detector.
#[test]
fn lists_grow_from_frame_to_frame() {
    let size = 3000;
    let mut made = vec![soup(size, 1, 0.0), soup(size, 2, 0.004)];
    let thin: Vec<BodyId> = Scene::from(made.clone()).ids().collect();
    let mut detector = detector(engine(), &made);
    let mut counts = Vec::new();
    for frame in 0..4 {
        let scale = 2.0 - 0.5 * f64::from(frame);
        let at = |body: &Body, end: usize| {
            let points = body.ends()[end].to_f64();
            Positions::F64(points.into_iter().map(|p| p.map(|x| scale * x)).collect())
        };
        let ends: Vec<[Positions; 2]> = made.iter().map(|body| [at(body, 0), at(body, 1)]).collect();
        let inputs: Vec<_> =
            thin.iter().zip(&ends).map(|(id, [t0, t1])| (*id, Motion::step(t0, t1))).collect();
        let answer = detector.step(&inputs, &Continuous::by(certified())).expect("an answer");
        let frames = ends.iter().zip(&made).map(|([t0, t1], body)| {
            let mesh =
                |at: &Positions| Mesh::new("frame", at.clone(), body.faces().to_vec()).expect("a mesh");
            let moved = Body::moving(mesh(t0), mesh(t1)).expect("a step").with_filter(*body.filter());
            moved.with_thickness(body.thickness().clone())
        });
        let bodies: Vec<Body> = frames.collect();
        let wanted = found(engine(), &bodies, Continuous::by(certified()));
        let all = sorted(&mut detector, &bodies, &answer);
        assert_eq!(fault(&all.rows, &wanted.rows), None, "frame {frame}");
        counts.push(answer.len());
    }
    assert!(counts[3] > 2 * counts[0], "{counts:?}");
    // Another thickness, and none.
    for radius in [0.01, 0.0, 0.004] {
        made[1] = made[1].clone().with_thickness(radius);
        detector.set_thickness(thin[1], radius).expect("a thickness");
        let answer = detector.query(&Continuous::by(certified())).expect("an answer");
        assert!(!answer.is_empty());
    }
}

/// Submissions: with a separation and without, both queries at once.
#[test]
fn submissions_have_both_sorts() {
    let (scene, id, ends) = crate::submit::pair(200);
    let mut mixed = Scene::new();
    for (at, body) in scene.bodies().iter().enumerate() {
        mixed.add(body.clone().with_thickness([0.0, 0.01][at]));
    }
    let device = engine();
    let mut memory = ends.each_ref().map(|points| Points::new(&device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let own = |device: &Device| Detector::new(device.clone(), mixed.clone()).expect("a detector");
    let (mut detector, mut by_host) = (own(&device), own(&engine()));
    let apart = Certified { min_separation: 0.01, ..certified() };
    let queries: [Query; 3] =
        [Continuous::by(certified()).into(), Earliest::by(certified()).into(), Continuous::by(apart).into()];
    detector.prepare(&[(id, input)], &queries).expect("prepared");
    let mut whole = 0;
    for frame in 0..4 {
        let ends = ends.each_ref().map(|points| {
            points.iter().map(|p| p.map(|x| x * (1.0 - 0.1 * frame as f32))).collect::<Vec<_>>()
        });
        ends.iter().zip(&mut memory).for_each(|(points, to)| to.write(points));
        if !detector.is_prepared() {
            detector.prepare(&[(id, input)], &queries).expect("prepared");
        }
        detector.submit().expect("submitted");
        let [t0, t1] = ends.map(Positions::F32);
        by_host.update(&[(id, Motion::step(&t0, &t1))]).expect("placed");
        for query in &queries {
            let answer = detector.on_device(query).expect("prepared");
            // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
            let status = unsafe { *(answer.status as *const FrameStatus) };
            let is_whole = detector.is_prepared() && status.short == 0;
            let (found, wanted) =
                (detector.collect(query).expect("an answer"), by_host.query(query).expect("one"));
            assert_eq!(found.rows, wanted.rows, "frame {frame} of {query:?}");
            if is_whole && query.kind() == QueryKind::Continuous {
                assert_eq!(status.first + status.second, wanted.len() as u64);
                whole += 1;
            }
            if !detector.is_prepared() {
                break;
            }
        }
    }
    assert!(whole > 0);
    assert!(detector.on_device(&queries[0].with_broad_phase(BroadPhase::Tree)).is_none());
}

/// Slices of one device, and shares of several.
#[test]
fn slices_and_shares_have_both_sorts() {
    let bodies = vec![soup(1500, 1, 0.0), soup(1500, 2, 0.004), soup(300, 3, partial(300, 0.004))];
    for query in [Query::from(Continuous::by(certified())), Earliest::by(certified()).into()] {
        let whole = engine();
        let wanted = detector(whole.clone(), &bodies).query(&query).expect("an answer");
        let sliced = (1..40).rev().find_map(|part| {
            let device = engine().with_memory_limit(whole.bytes().1 * part / 40);
            let mut own = Detector::new(device, Scene::from(bodies.clone())).ok()?;
            own.query(&query).ok().filter(|found| found.stats.slices > 1)
        });
        let sliced = sliced.expect("a part of the memory in which slices have room");
        assert_eq!(sliced.rows, wanted.rows);
        for count in [2, 3] {
            let devices = (0..count).map(|_| engine()).collect();
            let mut several = MultiDetector::new(devices, Scene::from(bodies.clone())).expect("detectors");
            for frame in 0..2 {
                let found = several.query(&query).expect("an answer");
                assert_eq!(found.rows, wanted.rows, "{count} devices, frame {frame}");
            }
        }
    }
}
