//! Choices of a near query that mean nothing are refused.

use nearmiss::Query;
use nearmiss::query::{Motion, Solver};

#[test]
fn a_distance_is_a_length_above_nothing() {
    let refused = |query: Query| query.check().err().map(|error| error.to_string());
    assert_eq!(refused(Query::near(1e-300)), None);
    assert_eq!(refused(Query::near(1e300)), None);
    for distance in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            refused(Query::near(distance)).is_some_and(|text| text.contains("a distance of")),
            "{distance}"
        );
    }
    assert!(refused(Query::of(Motion::Near)).is_some_and(|text| text.contains("without a distance")));
    for motion in [Motion::Discrete, Motion::Continuous, Motion::Earliest] {
        let query = Query { motion, ..Query::near(1.0) };
        assert!(refused(query).is_some_and(|text| text.contains("takes no distance")), "{motion:?}");
    }
    let near = Query::near(1.0);
    for query in [
        Query { solver: Some(Solver::Exact), ..near },
        Query { solver: Some(Solver::Certified), ..near },
        Query { tolerance: Some(1e-3), ..near },
        Query { separation: Some(1e-3), ..near },
        Query { boxes: Some(9), ..near },
        Query { adjacent: true, ..near },
        Query { solver: Some(Solver::Bounded), ..Query::of(Motion::Discrete) },
        Query { solver: Some(Solver::Bounded), ..Query::of(Motion::Continuous) },
    ] {
        assert!(refused(query).is_some(), "{query:?}");
    }
    assert!(Query::every().all(|query| query.check().is_ok()));
    assert!(Query::every().any(|query| query.motion == Motion::Near));
}
