//! Tiles and trees are built where bodies are first put.

use super::*;
use nearmiss::query::Rebuild;
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss_lab::OneQueryOnSeveral;

/// Spheres that all lie in one place until they get their poses, and those.
fn scattered() -> (Scene, Vec<Pose>) {
    let mesh = sphere(4, 0.45);
    let mut rng = SmallRng::seed_from_u64(5);
    let mut scene = Scene::new();
    // In no order that neighbours have.
    let cell = |k: u32| [f64::from(k * 27 % 64 % 8), f64::from(k * 27 % 64 / 8), 0.0];
    let poses = (0..64).map(|k| pose(&mut rng, cell(k), 0.1)).collect();
    (0..64).for_each(|_| _ = scene.add(Body::rigid(mesh.clone())));
    (scene, poses)
}

#[test]
fn the_first_frame_that_places_bodies_builds() {
    let (scene, poses) = scattered();
    let ids: Vec<BodyId> = scene.ids().collect();
    let inputs: Vec<_> = ids.iter().zip(&poses).map(|(&id, pose)| (id, Motion::pose(*pose))).collect();
    for broad in BroadPhase::ALL {
        let query = Query::discrete().with_broad_phase(broad);
        let detector = |rebuild| {
            OneQuery::new(engine(), scene.clone(), query.with_rebuild(rebuild)).expect("a detector")
        };
        let [mut by_itself, mut never] = [Rebuild::Auto, Rebuild::Manual].map(detector);
        // A frame before the first that places bodies is none of them.
        by_itself.detect().expect("an answer");
        let found = by_itself.frame(&inputs).expect("an answer");
        let slow = never.frame(&inputs).expect("an answer");
        assert_eq!((by_itself.builds(), never.builds()), (2, 1));
        assert_eq!(rows(&found), rows(&slow));
        never.rebuild().expect("built");
        assert_eq!(
            never.detect().expect("an answer").stats.steps,
            found.stats.steps,
            "{broad}: as one rebuild gives"
        );
        println!(
            "{broad}: {} tests where bodies were added, {} where they are",
            slow.stats.steps, found.stats.steps
        );
        assert!(slow.stats.steps > 2 * found.stats.steps, "{broad}");
        by_itself.frame(&inputs).expect("an answer");
        assert_eq!(by_itself.builds(), 2, "once");
        // A body that comes later is placed for the first time, too.
        let id = by_itself.add(scene.bodies()[0].clone()).expect("added");
        by_itself.detect().expect("an answer");
        let before = by_itself.builds();
        by_itself.frame(&[(id, Motion::pose(poses[7]))]).expect("an answer");
        assert_eq!(by_itself.builds(), before + 1);
    }
    let mut several =
        OneQueryOnSeveral::new(vec![engine(), engine()], scene.clone(), Query::discrete()).expect("two");
    let mut one = OneQuery::new(engine(), scene, Query::discrete()).expect("a detector");
    for _ in 0..2 {
        let [found, wanted] =
            [several.frame(&inputs), one.frame(&inputs)].map(|found| found.expect("an answer"));
        assert_eq!(rows(&found), rows(&wanted));
        assert_eq!(several.builds(), 2);
    }
}
