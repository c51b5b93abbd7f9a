//! Submissions of scenes of which pairs of bodies are left out.

use super::*;

/// A submission leaves out what a frame leaves out. Another list ends the preparation; the same one
/// does not.
#[test]
fn a_submission_leaves_out_the_pairs_of_the_list() {
    for kind in support::asked::KINDS {
        let (mut scene, cloth, [t0, t1]) = pair(120);
        let ground = scene.id(1).expect("the fixed body");
        let wall = scene.add(Body::fixed(soup(60, 3).0));
        scene.leave_out(&[[wall, cloth]]).expect("bodies");
        let device = engine();
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let mut detector = OneQuery::new(device.clone(), scene, query(kind)).expect("a detector");
        let memory = [&t0, &t1].map(|points| Points::new(&device, points));
        let input = [(cloth, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
        let [t0, t1] = [&t0, &t1].map(|points| Positions::F32(points.clone()));
        let mut answers = Vec::new();
        for list in [&[[cloth, wall]][..], &[[ground, cloth]], &[], &[[cloth, ground], [wall, cloth]]] {
            detector.leave_out(list).expect("bodies");
            by_host.leave_out(list).expect("bodies");
            assert!(!detector.is_prepared());
            let error = detector.submit().expect_err("not prepared").to_string();
            assert!(error.contains("prepare"), "{error}");
            detector.prepare(&input).expect("an answer");
            let turned: Vec<_> = list.iter().rev().map(|&[a, b]| [b, a]).collect();
            detector.leave_out(&turned).expect("the same list");
            assert!(detector.is_prepared() && detector.leave_out(&[[cloth, cloth]]).is_err());
            detector.submit().expect("submitted");
            let found = detector.collect().expect("an answer");
            let wanted = by_host.frame(&[(cloth, Motion::step(&t0, &t1))]).expect("an answer");
            assert_eq!(found.rows, wanted.rows, "{kind:?}, {list:?}");
            assert_eq!(found.starts_crossing, wanted.starts_crossing, "{kind:?}, {list:?}");
            answers.push(found);
        }
        let counts = answers.iter().map(|found| found.len()).collect::<Vec<_>>();
        // Without self-collision nothing is left for a distance if all pairs are left out.
        assert!(kind != QueryKind::Distance || counts[3] == 0);
        if !matches!(kind, QueryKind::Earliest | QueryKind::Distance) {
            assert!(counts[2] > counts[0] && counts[2] > counts[1] && counts[3] < counts[0], "{counts:?}");
            assert_eq!(counts[0] + counts[1], counts[2] + counts[3]);
        }
    }
}
