//! Known answers, and for each rung motions that it decides and no rung before it.

use super::rung::{Rung, certified, deciding};
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::Rungs;
use nearmiss_lab::oracle::first_contact;
use nearmiss_lab::{Case, Features};
use support::fuzz::continuous::fault;

type Points = [[f64; 3]; 4];

/// The name of a motion, its features, its points at both ends, the rung.
type Known = (&'static str, Features, [Points; 2], Rung);

const VF: Features = Features::VertexFace;
const EE: Features = Features::EdgeEdge;
const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A vertex that goes from one point to another, and the face that stays.
fn falls(from: [f64; 3], to: [f64; 3]) -> [Points; 2] {
    [from, to].map(|v| [v, FACE[0], FACE[1], FACE[2]])
}

/// A vertex that touches the plane of a face at a time and turns back; its place at the start, and how far it goes along y.
/// It goes along a slope that rises, so that its height over it is a square. Exact for numbers of few digits.
fn touches(time: f64, [x, y]: [f64; 2], along: f64) -> [Points; 2] {
    // Over the plane z = t x' a point at x' = x + t with height h is at h - t (x + t); h is linear, and takes all of it
    // away but (t - time)^2.
    let at = |t: f64| {
        let h = (x + 2.0 * time) * t - time * time;
        [[x + t, y + t * along, h], [0.0; 3], [4.0, 0.0, 4.0 * t], [0.0, 4.0, 0.0]]
    };
    [at(0.0), at(1.0)]
}

fn all() -> Vec<Known> {
    let still = |v: [f64; 3], f: [[f64; 3]; 3]| [[v, f[0], f[1], f[2]]; 2];
    let both = |p: Points| [p; 2];
    let edges = |a: [[f64; 3]; 2], b: [[f64; 3]; 2]| [a[0], a[1], b[0], b[1]];
    vec![
        ("boxes that never meet", VF, falls([0.25, 0.25, 1.0], [0.25, 0.25, 0.5]), Rung::Boxes),
        ("boxes that meet at two times", VF, falls([-2.0, 0.25, 0.0], [0.5, 0.25, 3.0]), Rung::Boxes),
        (
            "always above a slope",
            VF,
            [[0.25, 0.25, 0.75], [0.3, 0.25, 0.7]].map(|v| [v, FACE[0], [1.0, 0.0, 1.0], FACE[2]]),
            Rung::Signs,
        ),
        (
            "through the plane far off, then above a slope",
            VF,
            [[-4.0, 0.25, -4.5], [0.5, 0.25, 0.75]].map(|v| [v, FACE[0], [1.0, 0.0, 1.0], FACE[2]]),
            Rung::Window,
        ),
        ("falls on a face", VF, falls([0.25, 0.25, 1.0], [0.25, 0.25, -2.0]), Rung::Single),
        ("falls beside it", VF, falls([0.75, 0.5, 1.0], [0.75, 0.5, -2.0]), Rung::Single),
        (
            "falls on a face at once, too soon for f32 to tell",
            VF,
            falls([0.25, 0.25, 1e-7], [0.25, 0.25, -2.0]),
            Rung::Double,
        ),
        (
            "edges cross",
            EE,
            [1.0, -2.0].map(|z| edges([[-1.0, 0.1, z], [1.0, 0.2, z]], [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])),
            Rung::Single,
        ),
        ("falls within 1e-5 of a side", VF, falls([0.25, 1e-5, 1.0], [0.25, 1e-5, -2.0]), Rung::Double),
        ("falls 1e-5 beside a side", VF, falls([0.5, 0.50001, 1.0], [0.5, 0.50001, -2.0]), Rung::Double),
        (
            "falls within 1e-6 of a side of a slope",
            VF,
            [1.0, -2.0].map(|z| [[0.25, 1e-6, z], FACE[0], [1.0, 0.0, 0.5], FACE[2]]),
            Rung::Double,
        ),
        ("rests above a corner, less than f32 can tell", VF, still([1.0, 0.0, 1e-300], FACE), Rung::Double),
        ("lies on a face", VF, still([0.25, 0.25, 0.0], FACE), Rung::Touch),
        ("leaves a face", VF, falls([0.25, 0.25, 0.0], [0.25, 0.25, 1.0]), Rung::Touch),
        ("leaves a corner", VF, falls([1.0, 0.0, 0.0], [2.0, 0.5, 1.0]), Rung::Together),
        (
            "lies on a face that is a segment",
            VF,
            still([0.5, 0.5, 0.5], [[0.0; 3], [1.0; 3], [1.0; 3]]),
            Rung::Touch,
        ),
        ("lies on a face that is a point", VF, still([1.0; 3], [[1.0; 3]; 3]), Rung::Together),
        (
            "an edge that is a point leaves another edge",
            EE,
            [
                edges([[0.5, 0.5, 0.0]; 2], [[0.0; 3], [1.0, 1.0, 0.0]]),
                edges([[0.5, 0.5, 1.0]; 2], [[0.0; 3], [1.0, 1.0, 0.0]]),
            ],
            Rung::Touch,
        ),
        ("edges that are one point", EE, both([[3.0; 3]; 4]), Rung::Together),
        (
            "edges on one line overlap",
            EE,
            both(edges([[0.0; 3], [2.0; 3]], [[1.0; 3], [3.0; 3]])),
            Rung::Touch,
        ),
        ("slides into a side in its plane", VF, falls([-1.0, 0.25, 0.0], [0.5, 0.25, 0.0]), Rung::Flat),
        ("passes a side in its plane", VF, falls([1.5, 0.25, 0.0], [0.25, 1.5, 0.0]), Rung::Parted),
        ("touches the plane beside the face", VF, touches(0.25, [0.125, 3.75], 0.0), Rung::Double),
        (
            "touches the plane a little beside a side and goes along it",
            VF,
            touches(0.25, [0.125, 3.875 + 1.0 / 65536.0], -1.0),
            Rung::Double,
        ),
        ("touches the face and turns back", VF, touches(0.5, [0.5, 1.0], 0.0), Rung::Close),
        (
            "nearly parallel edges meet at their ends",
            EE,
            [
                [
                    [360.0, 420.0, -540.0],
                    [228.0, 420.0, 84.0],
                    [360.0, -504.0, -576.0],
                    [108.0, 300.0, 444.0],
                ],
                [
                    [-216.0, -156.0, 228.0],
                    [-156.0, -156.0, -108.0],
                    [-216.0, 264.0, 192.0],
                    [-84.0, -84.0, -324.0],
                ],
            ],
            Rung::Slices,
        ),
        (
            "an edge shrinks to a point where it meets another",
            EE,
            [
                [[0.0, 60.0, -12.0], [-24.0, 36.0, 12.0], [-48.0, 24.0, 60.0], [-84.0, 24.0, -12.0]],
                [
                    [576.0, -708.0, 180.0],
                    [-216.0, -732.0, 12.0],
                    [144.0, -552.0, -708.0],
                    [684.0, -552.0, 372.0],
                ],
            ],
            Rung::Search,
        ),
    ]
}

fn case(features: Features, [positions_t0, positions_t1]: [Points; 2]) -> Case {
    Case { features, positions_t0, positions_t1 }
}

#[test]
fn known_motions_are_decided_by_their_rung() {
    let mut wrong = Vec::new();
    for (what, features, points, rung) in all() {
        // A time within the resolution of f32, if f32 must find it.
        let p = Params::new(if rung == Rung::Single { 1e-4 } else { 1e-6 });
        let case = case(features, points);
        let (by, verdict) = deciding::<f64>(&case, &p);
        println!("{what}: {by:?}, {verdict:?}");
        if by != rung {
            wrong.push(format!("{what}: by {by:?}, not {rung:?}"));
        }
        assert_eq!(verdict, certified::<f64>(&case, Rungs::All, &p), "{what}");
        let truth = first_contact(&case);
        let at_start = matches!(rung, Rung::Together | Rung::Touch);
        for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
            let said = certified::<f64>(&case, rungs, &p);
            let name = format!("{what}, {rungs:?}: {said:?}");
            assert_eq!(fault(&said, truth.as_ref()), None, "{name}");
            // Features that touch at the start are always certain; so are those that pass through
            // during the step.
            if let Some(truth) = &truth
                && (at_start || rung <= Rung::Double && rungs != Rungs::Single)
            {
                assert!(said.is_contact(), "{name}");
                assert!(!at_start || said.toi_upper == 0.0, "{name}");
                assert!(truth.lateness(said.toi) > -1e-4, "{name}");
            }
            assert!(
                truth.is_some() || rung > Rung::Double || rungs == Rungs::Single || said.is_separated(),
                "{name}"
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A contact's time is known as well as the tolerance demands, in either precision, as far as it goes.
#[test]
fn a_finer_tolerance_gives_finer_times() {
    let points = falls([0.25, 0.25, 1.0], [0.25, 0.25, -2.0]);
    let case = case(VF, points);
    let truth = first_contact(&case).expect("a contact");
    let mut rungs = Vec::new();
    for tolerance in [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0] {
        let p = Params::new(tolerance);
        let (rung, verdict) = deciding::<f32>(&case, &p);
        assert_eq!(fault(&verdict, Some(&truth)), None, "{tolerance}");
        // The vertex moves by 3 in the step, and both sides of a time may be the tolerance.
        let most = 2.0 * tolerance.max(1e-13) / 3.0;
        assert!(verdict.is_contact() && verdict.toi_upper - verdict.toi <= most, "{tolerance}: {verdict:?}");
        rungs.push(rung);
    }
    assert!(rungs.is_sorted() && rungs[0] == Rung::Single && rungs[5] == Rung::Double, "{rungs:?}");
}

/// A face that begins as a segment, two of its corners in one place, and a vertex far from it throughout: the nearest point is
/// on the segment, not where the corners are.
#[test]
fn what_is_far_from_a_collapsed_face_is_separated() {
    let from = [[-1.0, 2.0, 0.0], [0.0; 3], [0.0; 3], [4.0, 4.0, 0.0]];
    let to = [[-1.0, 2.0, 0.0], [1.0, -4.0, 0.5], [0.0, -3.0, 1.0], [4.0, 1.0, 0.0]];
    for turn in 0..3 {
        let turned = |p: Points| [p[0], p[1 + turn], p[1 + (turn + 1) % 3], p[1 + (turn + 2) % 3]];
        let case = case(VF, [turned(from), turned(to)]);
        for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
            let p = Params { min_separation: 0.25, ..Params::new(1e-2) };
            let said = certified::<f64>(&case, rungs, &p);
            assert!(said.is_separated(), "{turn}, {rungs:?}: {said:?}");
        }
    }
}
