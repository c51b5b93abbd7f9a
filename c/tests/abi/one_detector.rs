//! One detector answers several queries: each as a detector that is used for it alone.

use super::*;
use nearmiss_lab::scene::soup;

/// Queries of every kind; some differ in numbers alone.
fn queries() -> Vec<NearmissQuery> {
    let mut apart = nearmiss_query(NearmissQueryKind::NEARMISS_CONTINUOUS as u32);
    (apart.min_separation, apart.tolerance) = (0.02, 1e-3);
    let mut by_trees = nearmiss_query(NearmissQueryKind::NEARMISS_DISCRETE as u32);
    by_trees.research.broad_phase = c"tree".as_ptr();
    let kinds = [0, 1, 2, 4].map(|kind| nearmiss_query(kind)).into_iter();
    kinds.chain([near(0.02), near(0.11), apart, by_trees]).collect()
}

/// Rows of an answer.
#[derive(Debug, PartialEq)]
struct Rows {
    hash: u64,
    is_free: bool,
    pairs: Vec<NearmissTrianglePair>,
    contacts: Vec<NearmissContact>,
    near: Vec<NearmissNearPair>,
}

fn rows_of(answer: &NearmissAnswer) -> Rows {
    Rows {
        hash: summary(answer).hash,
        is_free: got(|to, e| nearmiss_answer_is_free(Some(answer), to, e)).expect("told"),
        pairs: list(|to, n, e| nearmiss_answer_triangle_pairs(Some(answer), to, n, e))
            .unwrap_or_default()
            .into(),
        contacts: list(|to, n, e| nearmiss_answer_contacts(Some(answer), to, n, e))
            .unwrap_or_default()
            .into(),
        near: list(|to, n, e| nearmiss_answer_near_pairs(Some(answer), to, n, e)).unwrap_or_default().into(),
    }
}

/// Bodies of every kind around one place, and positions of a step.
struct Bodies {
    cloth: Body,
    others: [Body; 2],
}

impl Bodies {
    fn new(seed: u64) -> Bodies {
        let soup = |seed, triangles, moves| soup(triangles, seed, moves).expect("a soup");
        Bodies { cloth: soup(seed, 60, true), others: [soup(seed + 1, 40, false), soup(seed + 2, 50, false)] }
    }

    fn detector(&self) -> Box<NearmissDetector> {
        let other = |kind, body: &Body| NearmissBody { kind, self_collision: 0, ..described(body) };
        detector(&[described(&self.cloth), other(1, &self.others[0]), other(0, &self.others[1])])
    }
}

fn pose(turn: f64, shift: f64) -> NearmissPose {
    NearmissPose { rotation: [0.0, 0.0, turn.sin(), turn.cos()], translation: [shift, 0.0, -shift] }
}

/// The cloth moves by a part of its step, and the rigid body turns.
fn positions(bodies: &Bodies, part: f64) -> [Positions; 2] {
    let [start, end] = bodies.cloth.ends().map(Positions::to_f64);
    let moved = |from: &[[f64; 3]], by: f64| {
        let all = from.iter().zip(&end).map(|(a, b)| [0, 1, 2].map(|k| a[k] + by * (b[k] - a[k])));
        Positions::F64(all.collect())
    };
    [moved(&start, 0.0), moved(&start, part)]
}

fn motions(at: &[Positions; 2], part: f64) -> [NearmissMotion; 2] {
    let [start, end] = [&at[0], &at[1]].map(rows);
    let poses = [pose(0.0, 0.1 * part), pose(0.1 * part, 0.2)];
    [nearmiss_motion_step(0, start, end), nearmiss_motion_pose_step(1, poses[0], poses[1])]
}

#[test]
fn every_query_answers_as_in_a_detector_of_its_own() {
    let all = queries();
    let mut found = 0;
    for seed in 0..3 {
        let bodies = Bodies::new(10 * seed);
        let mut made = bodies.detector();
        for (number, part) in [0.2, 0.7, 1.0].into_iter().enumerate() {
            let at = positions(&bodies, part);
            let motions = motions(&at, part);
            assert_eq!(update(&mut made, &motions), Ok(()));
            // Each step begins with another query.
            for asked in all.iter().cycle().skip(3 * number).take(all.len()) {
                let answer = query(&mut made, asked).expect("an answer");
                let wanted = step(&mut bodies.detector(), &motions, asked).expect("an answer");
                assert_eq!(rows_of(&answer), rows_of(&wanted), "{asked:?}, seed {seed}, part {part}");
                found += summary(&answer).contacts;
            }
        }
    }
    assert!(found > 2_000, "{found}");
}

#[test]
fn an_answer_to_other_numbers_is_noticed() {
    let mut made = Bodies::new(5).detector();
    let [small, large] = [near(0.02), near(0.11)].map(|asked| query(&mut made, &asked).expect("an answer"));
    let (small, large) = (rows_of(&small), rows_of(&large));
    assert!(small != large && small.near.len() < large.near.len());
    let [free, crossing] = [2, 0].map(|kind| query(&mut made, &nearmiss_query(kind)).expect("an answer"));
    assert_ne!(rows_of(&free), rows_of(&crossing));
}

/// Answers are handles by themselves: a later query leaves an earlier one as it was.
#[test]
fn answers_stay_when_the_detector_goes_on() {
    let bodies = Bodies::new(5);
    let mut made = bodies.detector();
    let first = query(&mut made, &near(0.11)).expect("an answer");
    let before = rows_of(&first);
    query(&mut made, &near(0.02)).expect("an answer");
    nearmiss_detector_free(Some(made));
    assert_eq!(rows_of(&first), before);
    assert!(!before.near.is_empty());
}

/// Numbers change from call to call: no tiles are built, and no memory is taken.
#[test]
fn other_numbers_build_nothing() {
    let bodies = Bodies::new(7);
    let mut made = bodies.detector();
    query(&mut made, &near(0.2)).expect("an answer");
    let first = summary(&query(&mut made, &near(0.2)).expect("an answer"));
    for k in 1..8 {
        let asked = near(0.2 * f64::from(k) / 8.0);
        let answer = query(&mut made, &asked).expect("an answer");
        let wanted = query(&mut bodies.detector(), &asked).expect("an answer");
        assert_eq!(rows_of(&answer), rows_of(&wanted));
        // The time of the last building, to the bit.
        let own = summary(&answer);
        assert_eq!((own.ms.construct, own.bytes), (first.ms.construct, first.bytes));
    }
}
