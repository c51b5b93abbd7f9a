//! The oracle against answers that need no computing.

use nearmiss_lab::oracle::simplex::{Outcome, maximize};
use nearmiss_lab::oracle::{Triangle, exact, triangles_meet, triangles_meet_beyond};

const UNIT: Triangle = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];

fn at(t: &Triangle, d: [f64; 3]) -> Triangle {
    t.map(|x| [x[0] + d[0], x[1] + d[1], x[2] + d[2]])
}

#[test]
fn programs_have_their_three_outcomes() {
    let n = |x: &[f64]| x.iter().map(|x| exact(*x)).collect::<Vec<_>>();
    // x + y = 2, x - z = 1: most of y is 1; -x = 1 has no point; x - y = 0 lets x grow.
    assert_eq!(
        maximize(&[n(&[1., 1., 0.]), n(&[1., 0., -1.])], &n(&[2., 1.]), &n(&[0., 1., 0.])),
        Outcome::Most(exact(1.))
    );
    assert_eq!(maximize(&[n(&[-1.])], &n(&[1.]), &n(&[1.])), Outcome::Infeasible);
    assert_eq!(maximize(&[n(&[1., -1.])], &n(&[0.]), &n(&[1., 0.])), Outcome::Unbounded);
    // The same row twice: an artificial variable stays in the basis.
    assert_eq!(
        maximize(&[n(&[1., 1.]), n(&[1., 1.])], &n(&[2., 2.]), &n(&[3., 1.])),
        Outcome::Most(exact(6.))
    );
}

#[test]
fn triangles_meet_where_they_touch_and_not_beyond() {
    let tiny = f64::from_bits(1);
    for (d, meets) in [
        ([0., 0., 0.], true),
        ([1., 0., 0.], true),
        ([1. + f64::EPSILON, 0., 0.], false),
        ([0.5, 0.5, 0.], true),
        ([0., 0., tiny], false),
    ] {
        assert_eq!(triangles_meet(&UNIT, &at(&UNIT, d)), meets, "{d:?}");
    }
    let needle = [[0.25, 0.25, -1.], [0.25, 0.25, 1.], [0.25, 0.25, 0.5]];
    assert!(triangles_meet(&UNIT, &needle));
    assert!(!triangles_meet(&UNIT, &at(&needle, [0.75, 0., 0.])));
    assert!(triangles_meet(&UNIT, &[[0.25; 3].map(|x| x * 2. - 0.5); 3]), "a point");
}

#[test]
fn beyond_a_shared_feature() {
    let [v, a, b] = UNIT;
    let fold = |apex| triangles_meet_beyond(&UNIT, &[v, a, apex], &[v, a]);
    assert!(fold([0.5, 0.5, 0.]) && fold([3., 1., 0.]));
    assert!(!fold([0.5, -0.5, 0.]) && !fold([0., 1., 1.]) && !fold([0.5, 0., 0.]));
    let fan = |x, y| triangles_meet_beyond(&UNIT, &[v, x, y], &[v]);
    assert!(fan([1., 1., 1.], [1., 1., -1.]) && fan([2., 0., 0.], [1., 0., 1.]) && fan(a, b));
    assert!(!fan([-1., 0., 1.], [-1., 0., -1.]) && !fan([-1., 0., 0.], [0., -1., 0.]));
}
