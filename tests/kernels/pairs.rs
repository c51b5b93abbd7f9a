//! Single questions: the answers of the solvers themselves, in the cases' order, on every machine and in every storage.

use nearmiss::contacts::Status;
use nearmiss::query::{Discrete, QueryKind};
use nearmiss::research::{Solver, TriangleTest, WithSolver};
use nearmiss::{Error, Query};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::{Rungs, ee_certified, vf_certified};
use nearmiss_lab::oracle::crossing::meeting;
use nearmiss_lab::oracle::triangles_meet;
use nearmiss_lab::pairs::{Answers, Options, Stored, ask, ask_triangles, mean_edge};
use nearmiss_lab::{Case, Features};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::asked::{by, with_tolerance};
use support::machines;

fn continuous() -> Query {
    with_tolerance(Query::continuous(), 1e-6)
}

/// Features among each other, every third an edge pair; exact in f32.
fn cases(n: usize) -> Vec<Case> {
    let mut r = SmallRng::seed_from_u64(11);
    let mut point = || std::array::from_fn(|_| f64::from(r.random_range(-512..513)) / 256.0);
    let features = |i: usize| if i.is_multiple_of(3) { Features::EdgeEdge } else { Features::VertexFace };
    let mut case = |i| Case {
        features: features(i),
        positions_t0: std::array::from_fn(|_| point()),
        positions_t1: std::array::from_fn(|_| point()),
    };
    (0..n).map(&mut case).collect()
}

fn moving(case: &Case) -> [Moving<f64>; 4] {
    std::array::from_fn(|i| Moving { t0: Vec3(case.positions_t0[i]), t1: Vec3(case.positions_t1[i]) })
}

#[test]
fn every_case_has_the_solvers_own_answer() {
    let cases = cases(700);
    for device in machines() {
        for filters in [false, true] {
            let how = Options { filters, ..Options::default() };
            let query = with_tolerance(by(QueryKind::Continuous, Solver::CertifiedF64), 1e-6);
            let certified = ask(&device, &cases, &query, how).expect("answers");
            let query = by(QueryKind::Continuous, Solver::CubicF64);
            let cubic = ask(&device, &cases, &query, how).expect("answers");
            let params = Params::new(1e-6);
            let mut met = 0;
            for (i, case) in cases.iter().enumerate() {
                let p = moving(case);
                let (verdict, toi) = match case.features {
                    Features::VertexFace => {
                        let face = [p[1], p[2], p[3]];
                        (vf_certified(p[0], face, Rungs::Double, &params), vf_toi::<f64, f64>(p[0], face))
                    }
                    Features::EdgeEdge => {
                        let (a, b) = ([p[0], p[1]], [p[2], p[3]]);
                        (ee_certified(a, b, Rungs::Double, &params), ee_toi::<f64, f64>(a, b))
                    }
                };
                let own = certified.verdicts[i];
                assert_eq!(own.is_none(), verdict.is_separated(), "case {i}");
                if let Some(own) = own {
                    met += 1;
                    assert_eq!(
                        (own.toi, own.toi_upper, own.boxes),
                        (verdict.toi, verdict.toi_upper, verdict.boxes)
                    );
                    assert_eq!(own.status == Status::Certified, verdict.is_contact());
                }
                assert_eq!(cubic.verdicts[i].map(|own| own.toi), toi, "case {i}");
            }
            assert!(
                met > 40 && certified.rejected[0] > 0 && filters || !filters && certified.rejected == [0; 2]
            );
            assert!(certified.bytes > 0 && certified.ns() > 0.0);
        }
    }
}

/// f32 and f64 together: the same cases meet, on every machine to the bit, stored either way.
#[test]
fn machines_and_storage_agree() {
    let cases = cases(900);
    let mut first: Option<Answers> = None;
    for device in machines() {
        for stored in [Stored::F64, Stored::F32] {
            let how = Options { filters: true, stored, repeats: 1 };
            let one = ask(&device, &cases, &with_tolerance(continuous(), 0.0), how).expect("answers");
            assert!(one.escalated.iter().all(|&n| n > 0), "{:?}", one.escalated);
            let first = first.get_or_insert(one.clone());
            assert_eq!(
                (&one.verdicts, one.rejected, one.escalated),
                (&first.verdicts, first.rejected, first.escalated)
            );
        }
    }
}

/// More pairs than fit at once; each has the answer that it has among few.
#[test]
#[ignore = "takes a gigabyte"]
fn a_million_cases() {
    let few = cases(1000);
    let how = Options { filters: true, ..Options::default() };
    let device = support::engine();
    let want = ask(&device, &few, &continuous(), how).expect("answers");
    let many: Vec<Case> = few.iter().copied().cycle().take(1_100_003).collect();
    let answers = ask(&device, &many, &continuous(), how).expect("answers");
    assert!(answers.verdicts.iter().zip(want.verdicts.iter().cycle()).all(|(a, b)| a == b));
    assert_eq!(answers.verdicts.len(), many.len());
    println!("{:.0} ns a case", answers.ns());
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let device = support::engine();
    let refused = |cases: &[Case], query: Query, stored| {
        let error =
            ask(&device, cases, &query, Options { stored, ..Options::default() }).expect_err("refused");
        let is_data = matches!(error, Error::Input { .. });
        assert!(is_data || matches!(error, Error::InvalidArgument { .. }), "{error}");
        (is_data, error.to_string())
    };
    let mut case = cases(1);
    let (is_data, text) = refused(&case, Query::discrete(), Stored::F64);
    assert!(!is_data && text.contains("continuous"), "{text}");
    case[0].positions_t1[3][2] = 0.1;
    let (is_data, text) = refused(&case, continuous(), Stored::F32);
    assert!(!is_data && text.contains("that f32 does not hold; store it in f64"), "{text}");
    // Numbers that no precision holds are data, stored either way; so of triangles.
    for (x, named) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (1e300, "1e300")] {
        case[0].positions_t0[2][1] = x;
        for stored in [Stored::F64, Stored::F32] {
            let (is_data, text) = refused(&case, continuous(), stored);
            assert!(
                is_data && text.starts_with("case 0: vertex 2 has y = ") && text.contains(named),
                "{text}"
            );
        }
        let mut pair = [[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]; 2];
        pair[1][2][0] = x;
        for stored in [Stored::F64, Stored::F32] {
            let error = ask_triangles(&device, &[pair], &Query::default(), stored).expect_err("refused");
            assert!(matches!(error, Error::Input { .. }), "{error}");
        }
    }
    let none = ask(&device, &[], &continuous(), Options::default()).expect("no answers");
    assert!(none.verdicts.is_empty() && mean_edge(&[]) == 0.0);
}

#[test]
fn triangles_meet_as_the_oracle_says() {
    let mut r = SmallRng::seed_from_u64(3);
    let mut corner = || std::array::from_fn(|_| f64::from(r.random_range(0..4)));
    let pairs: Vec<_> =
        (0..150).map(|_| std::array::from_fn(|_| std::array::from_fn(|_| corner()))).collect();
    let truth: Vec<bool> = pairs.iter().map(|[p, q]| triangles_meet(p, q)).collect();
    for device in machines() {
        for stored in [Stored::F64, Stored::F32] {
            let exact = ask_triangles(&device, &pairs, &Query::default(), stored).expect("answers");
            assert_eq!(exact.meet, truth);
            assert!(exact.uncertain > 0);
            let moller = Discrete::by(TriangleTest::Moller).into();
            let float = ask_triangles(&device, &pairs, &moller, stored).expect("answers");
            assert_eq!(float.meet.len(), truth.len());
        }
    }
    let device = support::engine();
    assert!(ask_triangles(&device, &pairs, &continuous(), Stored::F64).is_err());
}

/// The kernels list the pairs that cross, among pairs that touch in all ways.
#[test]
fn only_crossing_triangles_are_those_of_the_oracle() {
    let mut r = SmallRng::seed_from_u64(4);
    let mut corner = || std::array::from_fn(|_| f64::from(r.random_range(0..4)) - 1.5);
    let pairs: Vec<_> =
        (0..300).map(|_| std::array::from_fn(|_| std::array::from_fn(|_| corner()))).collect();
    let truth: Vec<bool> =
        pairs.iter().map(|[p, q]| meeting(p, q).is_some_and(|meeting| meeting.is_crossing)).collect();
    let [all, crossing] = [false, true].map(|only| Query::from(Discrete::default().with_only_crossing(only)));
    for device in machines() {
        for stored in [Stored::F64, Stored::F32] {
            for some in [2, 300] {
                let found = ask_triangles(&device, &pairs[..some], &crossing, stored).expect("answers");
                assert_eq!(found.meet, truth[..some], "{stored:?}");
            }
            let touching = ask_triangles(&device, &pairs, &all, stored).expect("answers");
            let count = |meet: &[bool]| meet.iter().filter(|meet| **meet).count();
            // Many touch without crossing.
            assert!(count(&touching.meet) > count(&truth) + 50 && count(&truth) > 50);
        }
    }
    let moller = Query::from(Discrete::by(TriangleTest::Moller).with_only_crossing(true));
    let refused = ask_triangles(&support::engine(), &pairs, &moller, Stored::F64).expect_err("refused");
    assert!(refused.to_string().contains("cannot use the solver moller"), "{refused}");
}

/// On a grid of three points a side most triangles touch or are in one plane: more are left to
/// exact signs than there is room for at first. Stored in f32 with f64 pairs between, or in f64,
/// all are answered, each once.
#[test]
fn more_undecided_pairs_than_room() {
    let mut r = SmallRng::seed_from_u64(7);
    let mut corner = || std::array::from_fn(|_| f64::from(r.random_range(0..3)));
    let pairs: Vec<[[[f64; 3]; 3]; 2]> =
        (0..4_000).map(|_| std::array::from_fn(|_| std::array::from_fn(|_| corner()))).collect();
    let truth: Vec<bool> = pairs.iter().map(|[p, q]| triangles_meet(p, q)).collect();
    for (device, stored) in machines().into_iter().flat_map(|d| [(d.clone(), Stored::F32), (d, Stored::F64)])
    {
        let found = ask_triangles(&device, &pairs, &Query::default(), stored).expect("answers");
        assert_eq!(found.meet, truth, "{stored:?}");
        assert_eq!(found.listed, truth.iter().filter(|meet| **meet).count() as u64, "{stored:?}");
        assert!(found.uncertain > pairs.len() as u64 / 4, "{stored:?}: {}", found.uncertain);
    }
}
