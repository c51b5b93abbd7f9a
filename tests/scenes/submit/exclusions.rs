//! Submissions of scenes that exclude pairs of features.

use super::*;
use nearmiss::scene::{Exclusions, RestShape};

/// A submission excludes what a frame excludes. Other exclusions end the preparation; the same ones
/// do not.
#[test]
fn a_submission_excludes_what_a_frame_does() {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest, QueryKind::Near];
    for kind in kinds {
        let (scene, cloth, [t0, t1]) = pair(120);
        let ground = scene.id(1).expect("the fixed body");
        let device = engine();
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let mut detector = OneQuery::new(device.clone(), scene, query(kind)).expect("a detector");
        let memory = [&t0, &t1].map(|points| Points::new(&device, points));
        let input = [(cloth, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
        let [start, end] = [&t0, &t1].map(|points| Positions::F32(points.clone()));
        let mut counts = Vec::new();
        let rest = RestShape { within: 0.05, positions: end.clone() };
        for own in [
            Exclusions { faces: (0..40).collect(), ..Exclusions::default() },
            Exclusions { rest: Some(rest), ..Exclusions::default() },
            Exclusions::default(),
        ] {
            let pairs: Vec<[u32; 2]> = own.faces.iter().map(|&face| [300 - face, face]).collect();
            for one in [&mut detector, &mut by_host] {
                one.exclude(cloth, own.clone()).expect("exclusions");
                one.exclude_pairs([cloth, ground], &pairs).expect("vertices");
            }
            assert!(!detector.is_prepared());
            let error = detector.submit().expect_err("not prepared").to_string();
            assert!(error.contains("prepare"), "{error}");
            detector.prepare(&input).expect("an answer");
            detector.exclude(cloth, own.clone()).expect("the same");
            let wrong = Exclusions { ring: Some(0), ..own };
            assert!(detector.exclude(cloth, wrong).is_err() && detector.is_prepared());
            for _ in 0..2 {
                detector.submit().expect("submitted");
                let found = detector.collect().expect("an answer");
                let wanted = by_host.frame(&[(cloth, Motion::step(&start, &end))]).expect("an answer");
                assert_eq!(found.rows, wanted.rows, "{kind:?}");
                assert_eq!(found.starts_crossing, wanted.starts_crossing, "{kind:?}");
                counts.push(found.len());
            }
        }
        assert!(kind == QueryKind::Earliest || counts[0] < counts[4] && counts[2] < counts[4], "{counts:?}");
    }
}
