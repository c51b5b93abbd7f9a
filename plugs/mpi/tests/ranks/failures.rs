//! A rank that fails: all ranks return its error, and can go on.

use crate::laws::{compare, detector, device, queries, whole};
use crate::scenes::{Case, cases, changed};
use nearmiss::device::Backend;
use nearmiss::scene::{CollisionFilter, Motion};
use nearmiss::{Continuous, Device, Discrete, Distance, Interrupt, Near};
use nearmiss_mpi::plant::Fault;
use nearmiss_mpi::{Division, Piece, RankDetector, RankError, Ranks, pieces};

/// Checks that an error has these parts, and that all ranks have the same one.
fn agrees<T>(
    ranks: &Ranks,
    found: Result<T, RankError>,
    rank: usize,
    parts: &[&str],
) -> Result<(), RankError> {
    let error = found.err();
    ranks.run(|| {
        let error = error.as_ref().expect("an error");
        let text = error.to_string();
        assert_eq!(error.rank, rank, "{text}");
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        assert!(text.starts_with(&format!("rank {rank}: ")), "{text}");
        Ok(())
    })
}

fn end(ranks: &Ranks) -> Result<(), RankError> {
    if ranks.rank() == 0 {
        println!("all ranks agree");
    }
    Ok(())
}

fn sheet() -> Case {
    cases().remove(0)
}

/// The last rank has a position that is no number, and names body and vertex of the whole.
pub fn positions(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let mut detector = detector(ranks, &case, Division::Stretches)?;
    let mut one = whole(ranks, &case)?;
    let last = ranks.count() - 1;
    let own = &detector.pieces()[0];
    let (vertex, number) = (own.vertices().len() / 2, own.vertices()[own.vertices().len() / 2]);
    let at = own.body().positions_t0().clone();
    let numbers = ranks.run(|| Ok(number))?;
    for value in [f64::NAN, f64::INFINITY] {
        let bad = if ranks.rank() == last { changed((&at).into(), vertex, value) } else { at.clone() };
        let failed = detector.update(&[(0, Motion::step(&at, &bad))]);
        let is_named = failed.as_ref().is_err_and(|error| error.text.contains(&format!("vertex {numbers} ")));
        ranks.run(|| {
            assert!(is_named || ranks.rank() != last, "{failed:?}");
            Ok(())
        })?;
        agrees(ranks, failed, last, &["sheet: vertex ", &format!("y = {value}")])?;
    }
    // Nothing has moved.
    compare(ranks, &mut detector, &mut one, (&queries(case.edge, false), "after the error"))?;
    let short = if ranks.rank() == last { changed((&at).into(), 0, 0.0) } else { at.clone() };
    let nearmiss::mesh::Positions::F32(mut short) = short else { panic!("singles") };
    (ranks.rank() == last).then(|| short.pop());
    agrees(ranks, detector.update(&[(0, Motion::positions(&short))]), last, &["sheet", "vertices"])?;
    agrees(ranks, detector.update(&[(7, Motion::positions(&at))]), 0, &["there is no body 7"])?;
    compare(ranks, &mut detector, &mut one, (&queries(case.edge, false), "after all errors"))?;
    end(ranks)
}

/// A rank panics within a query.
pub fn panic(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let mut detector = detector(ranks, &case, Division::Stretches)?;
    let mut one = whole(ranks, &case)?;
    let rank = ranks.count() / 2;
    detector.plant((ranks.rank() == rank).then_some(Fault::Panic));
    agrees(ranks, detector.query(Continuous::default()), rank, &["panicked: planted"])?;
    detector.plant(None);
    compare(ranks, &mut detector, &mut one, (&queries(case.edge, false), "after the panic"))?;
    end(ranks)
}

/// The device of a rank fails in the middle of a query.
pub fn interrupt(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let interrupt = Interrupt::new();
    let (own, device) = ranks.run(|| {
        let device = Device::open(Backend::Cpu, Some(1))?.with_interrupt(&interrupt);
        Ok((pieces(&case.scene, Division::Stretches, ranks.rank(), ranks.count())?, device))
    })?;
    let mut detector = RankDetector::new(ranks, device, own, &[])?;
    let mut one = whole(ranks, &case)?;
    if ranks.rank() == 1 {
        interrupt.trigger();
    }
    agrees(ranks, detector.query(Continuous::default()), 1, &["interrupted"])?;
    interrupt.clear();
    compare(ranks, &mut detector, &mut one, (&queries(case.edge, false), "after the interrupt"))?;
    end(ranks)
}

/// Everything that ranks cannot share is refused by name, on all ranks.
pub fn refusals(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let last = ranks.count() - 1;
    let is_last = ranks.rank() == last;
    {
        let mut detector = detector(ranks, &case, Division::Stretches)?;
        agrees(ranks, detector.query(Distance::default()), 0, &["distance query over ranks"])?;
        let limited = Continuous::default().with_max_iterations(5);
        agrees(ranks, detector.query(limited), 0, &["limit of iterations"])?;
        let near = Near::within(if is_last { 0.1 } else { 0.2 });
        agrees(ranks, detector.query(near), last, &["near query that differs"])?;
        agrees(ranks, detector.query(Near::within(-1.0)), 0, &["distance must be"])?;
    }
    let own = || pieces(&case.scene, Division::Stretches, ranks.rank(), ranks.count());
    let all: Vec<u32> = (0..case.scene.bodies()[0].face_count() as u32).collect();
    let body = &case.scene.bodies()[0];
    // A triangle on two ranks, and one on none.
    let twice = ranks.run(|| {
        let owned = if is_last { &all[3..4] } else { &all[..if ranks.rank() == 0 { all.len() } else { 0 }] };
        Ok(vec![Piece::of(body, owned)?])
    })?;
    agrees_of_setup(ranks, twice, &["triangle 3 of sheet is owned by ranks 0 and"])?;
    let none = ranks
        .run(|| Ok(if is_last { vec![Piece::of(body, &all[..5])?] } else { vec![Piece::of(body, &[])?] }))?;
    agrees_of_setup(ranks, none, &["of sheet is owned by no rank"])?;
    // Bodies that differ.
    let mut differs = ranks.run(own)?;
    if is_last {
        let piece = differs.remove(0);
        let body = piece.body().clone().with_filter(CollisionFilter::in_environment(9));
        let whole =
            [case.scene.bodies()[0].vertex_count() as u32, case.scene.bodies()[0].face_count() as u32];
        let other = Piece::new(body, piece.vertices().to_vec(), piece.faces().to_vec(), whole);
        differs.push(ranks_only(other));
    }
    agrees_of_setup(ranks, differs, &["body 0, sheet, differs from that of rank 0"])?;
    let more = if is_last { [ranks_only(own()), ranks_only(own())].concat() } else { ranks_only(own()) };
    agrees_of_setup(ranks, more, &["2 pieces, but rank 0 has 1"])?;
    // A vertex on two ranks, with two positions.
    let mut detector = detector(ranks, &case, Division::Stretches)?;
    let at = detector.pieces()[0].body().positions_t0().clone();
    let nearmiss::mesh::Positions::F32(mut moved) = at else { panic!("singles") };
    if is_last {
        moved.iter_mut().for_each(|p| p[2] += 1e-6);
    }
    detector.update(&[(0, Motion::positions(&moved))])?;
    let found = detector.query(Discrete::default()).err();
    ranks.run(|| {
        let text = found.map(|error| error.to_string()).unwrap_or_default();
        assert!(text.contains("of sheet has different positions on two ranks"), "{text}");
        Ok(())
    })?;
    end(ranks)
}

fn ranks_only<T>(found: Result<T, nearmiss::Error>) -> T {
    found.expect("a piece")
}

fn agrees_of_setup(ranks: &Ranks, pieces: Vec<Piece>, parts: &[&str]) -> Result<(), RankError> {
    let device = ranks.run(device)?;
    let found = RankDetector::new(ranks, device, pieces, &[]).err();
    ranks.run(|| {
        let text = found.as_ref().map(ToString::to_string).unwrap_or_default();
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        Ok(())
    })
}

/// A program that passes an error on: every rank ends with it, and mpirun too.
pub fn program_fails(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let mut detector = detector(ranks, &case, Division::Stretches)?;
    let at = detector.pieces()[0].body().positions_t0().clone();
    let bad = if ranks.rank() == 1 { changed((&at).into(), 0, f64::NAN) } else { at.clone() };
    detector.update(&[(0, Motion::positions(&bad))])?;
    end(ranks)
}

/// A panic outside of all calls, while the other ranks are in one.
pub fn outside(ranks: &Ranks) -> Result<(), RankError> {
    let case = sheet();
    let mut detector = detector(ranks, &case, Division::Stretches)?;
    assert!(ranks.rank() != 2, "planted");
    detector.query(Continuous::default())?;
    end(ranks)
}
