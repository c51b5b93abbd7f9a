//! Rows, first times, caveats and launches.

use super::*;
use nearmiss::Query;
use nearmiss::contacts::Caveat;
use support::solids::cuboid;

/// Rows of both sorts are those of the two queries that have one sort, to the bit.
#[test]
fn each_row_is_that_of_its_own_pair() {
    for (name, bodies) in scenes() {
        for certified in solvers(false) {
            let (found, wanted) =
                (found(engine(), &bodies, Continuous::by(certified)), wanted(&bodies, certified));
            assert_eq!(fault(&found.rows, &wanted), None, "{name}, {certified:?}");
            assert!(
                found.rows.iter().all(|rows| rows.len() > 5),
                "{name}: {:?}",
                found.rows.each_ref().map(Vec::len)
            );
            let without: Vec<Body> = bodies.iter().map(|body| body.clone().with_thickness(0.0)).collect();
            let crossing = super::found(engine(), &without, Continuous::by(certified)).starts_crossing;
            assert_eq!(found.starts_crossing, crossing, "{name}");
            let least = found.rows.iter().flatten().map(|row| f64::from_bits(row.1[0])).reduce(f64::min);
            let mut detector = detector(engine(), &bodies);
            let first = detector.query(&Earliest::by(certified)).expect("an answer");
            assert_eq!(first.as_ref().map(|first| first.toi), least, "{name}");
            let contacts = detector.first_contacts(&first).expect("contacts");
            let contacts = sorted(&mut detector, &bodies, &contacts).rows;
            let of_least: Sorted = found.rows.map(|rows| {
                let is_first = |row: &Row| Some(f64::from_bits(row.1[0])) == least;
                rows.into_iter().filter(is_first).collect()
            });
            assert_eq!(contacts, of_least, "{name}");
        }
    }
}

/// Pairs that must approach are decided in both sorts alike.
#[test]
fn what_approaches_is_that_of_its_own_pair() {
    let mut fewer = 0;
    for (name, bodies) in scenes() {
        for certified in solvers(true) {
            let (found, wanted) =
                (found(engine(), &bodies, Continuous::by(certified)), wanted(&bodies, certified));
            assert_eq!(fault(&found.rows, &wanted), None, "{name}, {certified:?}");
            let all = Certified { approaching: false, ..certified };
            let all = super::found(engine(), &bodies, Continuous::by(all)).rows;
            let less = |at: usize| usize::from(found.rows[at].len() < all[at].len());
            fewer += less(0) + less(1);
        }
    }
    assert!(fewer > 10, "{fewer}");
}

/// A judge that accepts everything proves nothing.
#[test]
fn the_judge_names_planted_faults() {
    let (_, bodies) = scenes().swap_remove(0);
    let certified = solvers(false)[1];
    let wanted = wanted(&bodies, certified);
    let says = |rows: &Sorted| fault(rows, &wanted).unwrap_or_default();
    assert_eq!(says(&wanted), "");
    // A pair that the division drops.
    for (at, name) in ["thin", "thick"].into_iter().enumerate() {
        let mut rows = wanted.clone();
        let lost = rows[at].swap_remove(3);
        assert_eq!(says(&rows), format!("a {name} pair is missing: {lost:?}"));
    }
    // Pairs without a thickness in the list of the others: those of the least separation.
    let apart = Certified { min_separation: f64::MIN_POSITIVE, ..certified };
    let all_thick = found(engine(), &bodies, Continuous::by(apart)).rows;
    assert!(says(&all_thick).starts_with("a thin pair is"), "{}", says(&all_thick));
    // Pairs with one in the list of those without.
    let without: Vec<Body> = bodies.iter().map(|body| body.clone().with_thickness(0.0)).collect();
    let mut of_without = detector(engine(), &without);
    let answer = of_without.query(&Continuous::by(certified)).expect("an answer");
    let all_thin = sorted(&mut of_without, &bodies, &answer).rows;
    assert!(says(&all_thin).starts_with("a thick pair is"), "{}", says(&all_thin));
}

/// Filters, pairs of bodies that are left out, and exclusions hold for both sorts.
#[test]
fn filters_and_exclusions_hold_for_both() {
    let certified = solvers(false)[1];
    let group = |body: Body, group, mask| {
        body.with_filter(CollisionFilter { group, mask, ..CollisionFilter::without_self_collision() })
    };
    let mixed = [soup(40, 1, 0.0), soup(40, 2, 0.0), soup(40, 3, 0.02)];
    let [a, b, c] = mixed.clone();
    let grouped = vec![group(a, 1, 4), group(b, 2, 4), group(c, 4, 7)];
    // Two without a thickness that never meet: nothing is divided.
    let mut apart = detector(engine(), &grouped);
    let plan = apart.plan(&Continuous::by(certified).into()).expect("a plan");
    let has =
        |kernel: &str| plan.frame.iter().flat_map(|stage| &stage.kernels).any(|own| own.kernel == kernel);
    assert!(!has("narrow_divide_thick") && has("narrow_separate_f32_f32"));
    let rows = found(engine(), &grouped, Continuous::by(certified)).rows;
    assert_eq!(fault(&rows, &wanted(&grouped, certified)), None);
    // Lists of a scene.
    let edit = |bodies: &[Body]| {
        let mut scene = Scene::from(bodies.to_vec());
        let ids: Vec<_> = scene.ids().collect();
        scene.leave_out(&[[ids[0], ids[1]]]).expect("bodies");
        let ring = nearmiss::scene::Exclusions { ring: Some(1), faces: vec![0, 5, 9], ..Default::default() };
        scene.exclude(ids[0], ring.clone()).expect("a ring");
        scene.exclude(ids[2], ring).expect("a ring");
        scene.exclude_pairs([ids[0], ids[2]], &[[3, 4], [5, 6], [30, 31]]).expect("pairs");
        Detector::new(engine(), scene).expect("a detector")
    };
    let ask = |bodies: &[Body], certified: Certified| {
        let mut detector = edit(bodies);
        let answer = detector.query(&Continuous::by(certified)).expect("an answer");
        sorted(&mut detector, &mixed, &answer).rows
    };
    let without: Vec<Body> = mixed.iter().map(|body| body.clone().with_thickness(0.0)).collect();
    let least = Certified { min_separation: f64::MIN_POSITIVE, ..certified };
    let ([thin, _], [_, of_thick]) = (ask(&without, certified), ask(&mixed, least));
    let rows = ask(&mixed, certified);
    assert_eq!(fault(&rows, &[thin, of_thick]), None);
    assert!(rows.iter().all(|rows| !rows.is_empty()));
    let all = found(engine(), &mixed, Continuous::by(certified)).rows;
    assert!(rows[0].len() < all[0].len() && rows[1].len() <= all[1].len());
}

/// A rigid body that turns: both sorts on its path.
#[test]
fn bodies_that_turn_have_both_sorts() {
    use nearmiss::scene::{Pose, PoseStep};
    let end = Pose { rotation: [0.0, 0.0, 0.6, 0.8], ..Pose::default() };
    let bar = Body::rigid(cuboid([-2.0, -0.1, -0.1], [2.0, 0.1, 0.1]));
    let bar = bar.at(PoseStep::new(Pose::default(), end)).expect("a step");
    let peg = |x: f64, radius: f64| {
        Body::fixed(cuboid([x - 0.1, 1.0, -1.0], [x + 0.1, 1.2, 1.0])).with_thickness(radius)
    };
    let straight = soup(40, 4, 0.0);
    let bodies = vec![bar, peg(0.8, 0.0), peg(1.2, 0.0625), straight];
    for certified in solvers(false) {
        let rows = found(engine(), &bodies, Continuous::by(certified)).rows;
        assert_eq!(fault(&rows, &wanted(&bodies, certified)), None, "{certified:?}");
        let has = |at: usize, bodies: [u32; 2]| rows[at].iter().any(|row| row.0.1 == bodies);
        assert!(has(0, [0, 1]) && has(1, [0, 2]), "{certified:?}");
    }
}

/// A tolerance below the precision is a caveat of both sorts.
#[test]
fn caveats_count_both_sorts() {
    let far = |body: Body| {
        let frames = body.frames().into_iter().map(|mesh| {
            let points = mesh.positions().to_f64().into_iter().map(|p| p.map(|x| 1e6 * x)).collect();
            Mesh::new("far", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
        });
        let [t0, t1] = <[Mesh; 2]>::try_from(frames.collect::<Vec<_>>()).expect("two frames");
        Body::moving(t0, t1).expect("a step").with_filter(CollisionFilter::with_self_collision())
    };
    let bodies = [far(soup(30, 7, 0.0)), far(soup(30, 8, 0.0)).with_thickness(3e4)];
    let certified = Certified { tolerance: Some(1e-12), ..Certified::default() };
    let mut detector = detector(engine(), &bodies);
    let answer = detector.query(&Continuous::by(certified)).expect("an answer");
    let rows = sorted(&mut detector, &bodies, &answer).rows;
    assert!(rows.iter().all(|rows| !rows.is_empty()));
    let all = answer.caveats().iter().find_map(|caveat| match caveat {
        Caveat::ToleranceBelowPrecision { pairs } => *pairs,
        _ => None,
    });
    assert!(all.is_some_and(|pairs| pairs > 0 && pairs as usize <= answer.len()), "{:?}", answer.caveats());
}

/// One launch divides, a second one only if a body has vertices of both sorts. Other scenes and other
/// queries have none.
#[test]
fn only_such_a_step_is_divided() {
    let launches = |bodies: Vec<Body>, query: Query| {
        let mut detector = detector(engine(), &bodies);
        let plan = detector.plan(&query).expect("a plan");
        let kernels: Vec<_> = plan.frame.iter().flat_map(|stage| &stage.kernels).collect();
        ["narrow_divide_thick", "narrow_sift_thick"]
            .map(|name| kernels.iter().filter(|own| own.kernel == name).map(|own| own.launches).sum::<u64>())
    };
    let certified = solvers(false)[1];
    let apart = Certified { min_separation: 0.01, ..certified };
    let mixed = || vec![soup(40, 1, 0.0), soup(40, 2, 0.02)];
    for query in [Query::from(Continuous::by(certified)), Earliest::by(certified).into()] {
        assert_eq!(launches(mixed(), query), [1, 0]);
        assert_eq!(launches(vec![soup(40, 1, partial(40, 0.02))], query), [1, 1]);
        assert_eq!(launches(vec![soup(40, 1, 0.0), soup(40, 2, 0.0)], query), [0, 0]);
        assert_eq!(launches(vec![soup(40, 1, 0.01), soup(40, 2, 0.02)], query), [0, 0]);
        let lone = soup(40, 1, 0.0).with_filter(CollisionFilter::without_self_collision());
        assert_eq!(launches(vec![lone, soup(40, 2, 0.02)], query), [0, 0]);
    }
    assert_eq!(launches(mixed(), Continuous::by(apart).into()), [0, 0]);
    assert_eq!(launches(mixed(), Query::near(0.01)), [0, 0]);
}
