//! Choices of a near query that mean nothing are refused.

use nearmiss::Query;
use nearmiss::query::QueryKind;
use nearmiss::research::QueryExt;

#[test]
fn a_distance_is_a_length_above_nothing() {
    let refused = |query: Query| query.check().err().map(|error| error.to_string());
    assert_eq!(refused(Query::near(1e-300)), None);
    assert_eq!(refused(Query::near(1e300)), None);
    for distance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(
            refused(Query::near(distance))
                .is_some_and(|text| text.contains("distance must be finite and at least 0")),
            "{distance}"
        );
    }
    assert!(Query::every().all(|query| query.check().is_ok()));
    assert!(Query::every().any(|query| query.kind() == QueryKind::Near));
}
