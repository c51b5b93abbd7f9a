//! Nothing small takes seconds: scenes that once did leave few pairs to the rungs that cost much. Counted, not timed; the
//! times are printed, and `cargo bench --bench stages -- hard` measures them.

use nearmiss::contacts::Status;
use nearmiss::device::Backend;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss::{Contacts, Device, Query};
use nearmiss_lab::OneQuery;
use std::time::Instant;
use support::asked::{by, of};
use support::{ask, data, engine, hard};

/// A test takes a fourth of the triangles.
const PART: usize = 4;
/// At most so many in a hundred candidates are cut into slices.
const SLICED: u64 = 5;

fn total([vf, ee]: [u64; 2]) -> u64 {
    vf + ee
}

/// Prints the work of the rungs, and microseconds a candidate on one thread.
fn asked(name: &str, bodies: Vec<nearmiss::Body>, solver: Solver) -> Contacts {
    let device = Device::open(Backend::Cpu, Some(1)).expect("a CPU");
    let query = by(QueryKind::Continuous, solver);
    let mut detector = OneQuery::new(device, bodies, query).expect("a detector");
    detector.detect().expect("an answer");
    let start = Instant::now();
    let all = detector.detect().expect("an answer");
    let us = start.elapsed().as_secs_f64() * 1e6;
    let sure = all.contacts().iter().filter(|c| c.status == Status::Certified).count();
    println!(
        "{name}, {solver:?}: {} candidates, {} for f64, {} open, {} in slices; {} listed, {sure} of them certain; \
         {:.2} us a candidate",
        all.stats.candidates,
        total(all.stats.escalated_vf_ee),
        total(all.stats.open_vf_ee),
        total(all.stats.sliced_vf_ee),
        all.len(),
        us / all.stats.candidates.max(1) as f64
    );
    all
}

#[test]
fn few_pairs_reach_the_rungs_that_cost_much() {
    for (name, body) in hard::hard(PART) {
        for solver in [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64] {
            let all = asked(name, vec![body.clone()], solver);
            assert!(all.stats.candidates > 500, "{name}: nothing is asked");
            assert!(
                total(all.stats.sliced_vf_ee) * 100 <= all.stats.candidates * SLICED,
                "{name}, {solver:?}: too many slices"
            );
            // Slices and searches are of what isolation leaves, and no rung has more than the one before.
            let left = [all.stats.escalated_vf_ee, all.stats.open_vf_ee, all.stats.sliced_vf_ee].map(total);
            if solver == Solver::Certified {
                assert!(left.is_sorted_by(|a, b| a >= b), "{name}: {left:?}");
            }
        }
    }
}

/// A flat fan at rest round one vertex, which the boxes of all its triangles share.
fn fan(n: usize) -> Body {
    let rim = (0..n).map(|i| hard::around(i, n).map(|x| x as f32));
    let faces = (0..n as u32).map(|i| [0, 1 + i, 1 + (i + 1) % n as u32]).collect();
    let points = [[0.0; 3]].into_iter().chain(rim).collect();
    let mesh = Mesh::new("fan", Positions::F32(points), faces).expect("a mesh");
    Body::moving(mesh.clone(), mesh).expect("two frames")
}

/// The boxes of all triangles round one vertex overlap, but few pairs are tested: pairs of tiles that share it are left out.
#[test]
fn a_fan_round_one_vertex_is_not_tested_pair_by_pair() {
    const TRIANGLES: u64 = 400;
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        let all = ask(engine(), vec![fan(TRIANGLES as usize)], of(motion));
        let pairs = TRIANGLES * (TRIANGLES - 1) / 2;
        println!(
            "{motion:?}: {} node tests, {} triangle pairs, {} candidates",
            all.stats.overlap_tests(),
            all.stats.triangle_pairs,
            all.stats.candidates
        );
        assert!(all.stats.overlap_tests() < pairs, "{}", all.stats.overlap_tests());
        assert!(
            all.stats.candidates < TRIANGLES / 10 && all.is_empty(),
            "{} asked, {} listed",
            all.stats.candidates,
            all.len()
        );
    }
}

/// Features that touch from the start are certain contacts, by the exact rung: no search could
/// certify them.
#[test]
fn what_rests_is_certain() {
    for (name, body) in hard::hard(PART).into_iter().filter(|(name, _)| name.contains("equal")) {
        let all = asked(name, vec![body], Solver::Certified);
        let sure = |c: &&nearmiss::Contact| c.status == Status::Certified && c.toi_upper == 0.0;
        assert_eq!(all.contacts().iter().filter(sure).count(), all.len(), "{name}");
        assert_eq!((all.undecided, total(all.stats.sliced_vf_ee)), (0, 0), "{name}");
        assert!(all.len() > 100_000, "{name}");
    }
}

/// Inputs that took seconds where two triangles should take none.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn what_was_slow_is_not() {
    for name in ["slow-sliver-2tri", "slow-sliver-100702"] {
        let folder = data(&format!("finds/{name}"));
        let mesh = |name: &str| nearmiss_io::MeshFile::read(&folder.join(name)).expect("a mesh").into_mesh();
        let body = nearmiss::Body::moving(mesh("a0.ply"), mesh("a1.ply")).expect("two frames");
        for solver in [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64] {
            asked(name, vec![body.clone()], solver);
        }
        // The same pairs by every machine's count of rungs.
        let [one, two] = [0; 2].map(|_| ask(engine(), vec![body.clone()], Query::continuous()));
        assert_eq!((one.hash(), one.stats.sliced_vf_ee), (two.hash(), two.stats.sliced_vf_ee), "{name}");
        let sliced = total(one.stats.sliced_vf_ee);
        // 23 slivers that meet at a grazing angle all along: a fifth, and 4 us a candidate.
        assert!(sliced * 5 <= one.stats.candidates + 10, "{name}: {sliced} of {}", one.stats.candidates);
    }
}
