//! Every answer is that of one machine.

use crate::compare::difference;
use crate::scenes::{Case, Random, Step, cases};
use nearmiss::device::Backend;
use nearmiss::scene::{BodyId, Motion};
use nearmiss::{Continuous, Detector, Device, Discrete, Earliest, Error, Near, Query};
use nearmiss_mpi::{Division, RankDetector, RankError, Ranks, left_out, pieces};

/// A device of one thread.
pub fn device() -> Result<Device, Error> {
    Device::open(Backend::Cpu, Some(1))
}

/// Distributed detector of a case.
pub fn detector<'a>(
    ranks: &'a Ranks,
    case: &Case,
    division: Division,
) -> Result<RankDetector<'a>, RankError> {
    let own = ranks.run(|| Ok((pieces(&case.scene, division, ranks.rank(), ranks.count())?, device()?)))?;
    RankDetector::new(ranks, own.1, own.0, &left_out(&case.scene))
}

/// Detector of the whole scene, on rank 0.
pub fn whole(ranks: &Ranks, case: &Case) -> Result<Option<Detector>, RankError> {
    ranks.run(|| match ranks.rank() {
        0 => Detector::new(device()?, case.scene.clone()).map(Some),
        _ => Ok(None),
    })
}

/// Queries of all kinds that ranks share.
pub fn queries(edge: f64, has_thickness: bool) -> Vec<Query> {
    let apart = 0.05 * edge;
    let mut all: Vec<Query> = vec![
        Discrete::default().into(),
        Discrete::default().with_adjacent(true).into(),
        Discrete::default().with_only_crossing(true).into(),
        Continuous::default().into(),
        Earliest::default().into(),
        Near::within(0.3 * edge).into(),
        Near::within(0.01 * edge).into(),
        Continuous::default().with_tolerance(1e-9 * edge).into(),
        Continuous::default().with_min_separation(apart).assuming_free(true).into(),
        Earliest::default().with_min_separation(apart).into(),
    ];
    if has_thickness {
        all.push(Near::within(0.0).into());
    }
    all
}

/// Compares all queries at the current positions, and returns how many there were.
pub fn compare(
    ranks: &Ranks,
    detector: &mut RankDetector,
    one: &mut Option<Detector>,
    (queries, place): (&[Query], &str),
) -> Result<usize, RankError> {
    for query in queries {
        let found = detector.query(*query);
        let wanted = one.as_mut().map(|one| one.query(query));
        // A query that one machine refuses is refused by the ranks.
        let refused = ranks.run(|| match (&found, &wanted) {
            (_, None) => Ok(false),
            (Ok(_), Some(Ok(_))) => Ok(false),
            (Err(_), Some(Err(_))) => Ok(true),
            (Ok(_), Some(Err(error))) => panic!("{place}: {query:?} is refused by one machine: {error}"),
            (Err(error), Some(Ok(_))) => panic!("{place}: {query:?} is refused by ranks: {error}"),
        })?;
        let Ok(found) = found else { continue };
        assert!(!refused);
        let all = detector.gather(&found)?;
        ranks.run(|| {
            if let (Some(all), Some(Ok(wanted))) = (&all, &wanted)
                && let Some(difference) = difference(all, wanted)
            {
                panic!("{place}: {query:?}: {difference}");
            }
            Ok(())
        })?;
    }
    Ok(queries.len())
}

/// Every scene at rest and in motion, divided in both ways.
pub fn laws(ranks: &Ranks) -> Result<(), RankError> {
    let (mut count, mut rows) = (0, 0);
    for case in &cases() {
        for division in [Division::Stretches, Division::Bodies] {
            let mut detector = detector(ranks, case, division)?;
            let mut one = whole(ranks, case)?;
            let thick = case.scene.bodies().iter().any(|body| body.thickness().largest() > 0.0);
            let queries = queries(case.edge, thick);
            let mut random = Random(case.name.len() as u64);
            for (step, ends) in [0, 2, 1, 2].into_iter().enumerate() {
                let place = format!("{}, {division:?}, step {step}", case.name);
                if ends > 0 {
                    let motions = Step::random(case, ends, &mut random);
                    update(ranks, &mut detector, &mut one, &motions)?;
                }
                count += compare(ranks, &mut detector, &mut one, (&queries, &place))?;
                rows += one
                    .as_mut()
                    .and_then(|one| one.query(&Continuous::default()).ok())
                    .map_or(0, |all| all.len());
            }
        }
    }
    ranks.run(|| {
        assert!(ranks.rank() > 0 || rows > 2_000, "{rows} rows are too few to compare");
        Ok(())
    })?;
    if ranks.rank() == 0 {
        println!("{count} queries, {rows} contacts in motion: all answers are equal");
    }
    Ok(())
}

/// Moves the bodies of both detectors.
fn update(
    ranks: &Ranks,
    detector: &mut RankDetector,
    one: &mut Option<Detector>,
    motions: &[(usize, Step)],
) -> Result<(), RankError> {
    let motions: Vec<(usize, Motion)> = motions.iter().map(|(body, step)| (*body, step.motion())).collect();
    detector.update_whole(&motions)?;
    ranks.run(|| {
        let Some(one) = one else { return Ok(()) };
        let ids: Vec<BodyId> = one.scene().ids().collect();
        one.update(&motions.iter().map(|(body, motion)| (ids[*body], *motion)).collect::<Vec<_>>())
    })
}

/// Many small steps: triangles of other ranks come and go, and some steps move them alone.
pub fn stepping(ranks: &Ranks) -> Result<(), RankError> {
    let queries: [Query; 2] = [Continuous::default().into(), Near::within(0.02).into()];
    for case in cases().iter().filter(|case| ["one sheet", "many bodies"].contains(&case.name)) {
        let mut detector = detector(ranks, case, Division::Stretches)?;
        let mut one = whole(ranks, case)?;
        let mut random = Random(3);
        for step in 0..12 {
            let place = format!("{}, step {step}", case.name);
            match step % 4 {
                // Nothing moves.
                3 => update(ranks, &mut detector, &mut one, &[])?,
                _ => {
                    let motions = Step::random(case, 2, &mut random);
                    update(ranks, &mut detector, &mut one, &motions)?;
                }
            }
            compare(ranks, &mut detector, &mut one, (&queries, &place))?;
            compare(ranks, &mut detector, &mut one, (&queries, &place))?;
        }
    }
    if ranks.rank() == 0 {
        println!("all steps are equal");
    }
    Ok(())
}
