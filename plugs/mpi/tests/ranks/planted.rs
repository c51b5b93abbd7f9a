//! Planted faults: the judge names each.

use crate::compare::difference;
use crate::laws::{detector, whole};
use crate::scenes::cases;
use nearmiss::{Near, Query};
use nearmiss_mpi::plant::Fault;
use nearmiss_mpi::{Division, RankError, Ranks};

fn named(ranks: &Ranks, fault: Fault, query: &Query) -> Result<(), RankError> {
    let cases = cases();
    let case = &cases[0];
    let mut detector = detector(ranks, case, Division::Stretches)?;
    let mut one = whole(ranks, case)?;
    for planted in [None, Some(fault)] {
        detector.plant(planted);
        let found = detector.query(*query)?;
        let all = detector.gather(&found)?;
        ranks.run(|| {
            let (Some(all), Some(one)) = (all, &mut one) else { return Ok(()) };
            let difference = difference(&all, &one.query(query)?);
            assert_eq!(difference.is_some(), planted.is_some(), "{difference:?}");
            println!("{planted:?}: {difference:?}");
            Ok(())
        })?;
    }
    Ok(())
}

pub fn chunk(ranks: &Ranks) -> Result<(), RankError> {
    named(ranks, Fault::ChunkNotSent, &Near::within(0.05).into())
}

pub fn boxes(ranks: &Ranks) -> Result<(), RankError> {
    named(ranks, Fault::BoxesNotGrown, &Near::within(0.5).into())
}

pub fn twice(ranks: &Ranks) -> Result<(), RankError> {
    named(ranks, Fault::RowsKeptTwice, &Near::within(0.05).into())
}
