use super::forms::start;
use super::*;
use crate::exec::RowMap;
use crate::math::Vec3;
use crate::prim::cubic::Moving;
use crate::prim::isolate::{Edges, Face};
use crate::prim::near::Filter;
use crate::random::Random;

/// Every form of a pair.
pub(super) fn forms(is_face: bool) -> impl Iterator<Item = Form> {
    let corners = if is_face { 3 } else { 4 };
    let places = move || (0..corners).flat_map(|k| [start(k), end(k)]);
    let sides = if is_face { [[0, 1], [0, 2], [1, 2], [1, 2]] } else { [[0, 1], [0, 2], [1, 3], [2, 3]] };
    let of_corners = (0..corners).flat_map(move |a| {
        let motions = (0..3).map(move |axis| Form::Motion { k: a, axis });
        let heights = places().map(move |to| Form::Corner { a, to });
        motions.chain(heights).chain([Form::CornerSquare { a }])
    });
    let of_sides = sides.into_iter().flat_map(move |side| {
        let lengths = [Form::SideHeight { side }, Form::SideSquare { side }, Form::SideRate { side }];
        let along = side.into_iter().map(move |at| Form::Along { side, at });
        lengths.into_iter().chain(along).chain(places().map(move |to| Form::Side { side, to }))
    });
    let of_plane = [Form::PlaneHeight, Form::PlaneSquare, Form::PlaneRate, Form::Weight { k: 1 }];
    let normals = (0..3).map(|axis| Form::Normal { axis });
    let of_plane = of_plane.into_iter().chain([Form::Weight { k: 2 }]).chain(normals);
    of_corners.chain(of_sides).chain(of_plane).chain(places().map(|to| Form::Plane { to }))
}

/// Signs by integers alone.
struct Integers<'a>(Exact<'a>);

impl Signs for Integers<'_> {
    fn sign(&self, _: &Motion<f64>, form: Form) -> Option<i32> {
        self.0.sign(form)
    }
    const SEARCHES: bool = true;
}

/// A pair: dyadic, so that signs are often 0; on a fine grid; scaled by much; with some vertices alike
/// or at rest; of f32 and of f64.
fn hostile(r: &mut Random) -> Vertices<f64> {
    let kind = r.below(6);
    let coordinate = |r: &mut Random, kind: u64| -> f64 {
        match kind {
            0 | 1 => (r.below(9) as f64 - 4.0) / 4.0,
            2 => (r.below(1 << 20) as f64 - 524_288.0) * 1e-6,
            3 => ((r.below(1 << 24) as f64 - 8_388_608.0) * 1e-9) as f32 as f64 + 1.0,
            4 => (r.below(1 << 53) as f64 - 4e15) * f64::pow2(-52 - r.below(40) as i32),
            _ => (r.below(3) as f64 - 1.0) * f64::pow2(r.below(30) as i32 - 15),
        }
    };
    let mut vertices = [[Vec3([0.0; 3]); 2]; 4];
    for ends in &mut vertices {
        for at in ends.iter_mut() {
            *at = Vec3(at.0.map(|_| coordinate(r, kind)));
        }
        // At rest, sliding in a plane, or moving alike.
        match r.below(5) {
            0 => ends[1] = ends[0],
            1 => ends[1].0[2] = ends[0][2],
            2 => ends[1] = ends[0] + Vec3([0.25, -0.5, 0.125]),
            _ => {}
        }
    }
    if r.below(4) == 0 {
        vertices[r.below(4) as usize] = vertices[r.below(4) as usize];
    }
    if r.below(3) == 0 {
        // A flat start.
        for (k, ends) in vertices.iter_mut().enumerate() {
            ends[0].0[2] = if k == 0 { 0.25 } else { 0.0 };
        }
    }
    vertices
}

fn with<T>(v: &Vertices<f64>, is_face: bool, p: &Params, test: impl FnOnce(&Motion<f64>) -> T) -> T {
    let [a, b, c, d] = v.map(|[t0, t1]| Moving { t0, t1 });
    let pair = if is_face { Face::new(a, [b, c, d], p).of_four() } else { Edges::new([a, b], [c, d], p) };
    test(&Motion { vertices: v, pair: &pair })
}

/// Integers decide the same as bounds. The search finds the nearest point that is suggested. The parts in sequence are the course.
#[test]
fn the_parts_have_the_course_of_the_whole() {
    let mut r = Random(7);
    let (mut by_bounds, mut suggested, mut open, mut advancing) = (0, 0, 0, 0);
    for i in 0..40_000 {
        let v = hostile(&mut r);
        let is_face = i % 2 == 0;
        let p = Params { min_separation: [0.0, 0.25, 1.0, 50.0][i / 2 % 4], ..Params::new(1e-6) };
        with(&v, is_face, &p, |motion| {
            let course = motion.course([0.0; 4], &p);
            let Begin::Within(near) = motion.begin([0.0; 4], &p) else {
                assert_eq!(course, Course::Solver);
                return;
            };
            let exact = Integers(Exact::new(&v, is_face));
            for form in forms(is_face).step_by(1 + i % 5) {
                if let Some(sign) = motion.bounded(form).sign() {
                    assert_eq!(exact.0.sign(form), Some(sign), "{form:?} {v:?}");
                }
            }
            if let Some(nearest) = motion.suggested() {
                suggested += 1;
                assert_eq!(motion.nearest(&exact), Some(nearest), "{is_face} {v:?}");
                assert_eq!(motion.touches(&exact, nearest), Some(false), "{is_face} {v:?}");
            }
            let full = motion.by_integers(&near, &p);
            if let Some(decided) = motion.by_bounds(&near, &p) {
                by_bounds += 1;
                assert_eq!(decided, full, "{is_face} {v:?}");
            } else {
                open += 1;
            }
            let told = match full {
                Decided::Course(course) => course,
                Decided::From(from) => {
                    advancing += 1;
                    motion.advance(from, &near, &p)
                }
            };
            assert_eq!(told, course, "{is_face} {v:?}");
        });
    }
    // Each part has its share.
    assert!(by_bounds > 5_000 && suggested > 5_000, "{by_bounds} {suggested}");
    assert!(open > 2_000 && advancing > 500, "{open} {advancing}");
}

/// Distances in f32 drop only pairs that begin beyond the separation, also if radii differ and if
/// positions are of f32.
#[test]
fn pairs_that_f32_drops_begin_beyond() {
    let mut r = Random(11);
    let (mut dropped, mut beyond, mut near, mut at_the_limit) = (0, 0, 0, 0);
    for i in 0..40_000 {
        let mut v = hostile(&mut r);
        if i % 3 == 0 {
            v = v.map(|ends| ends.map(|at| Vec3(at.0.map(|x| x as f32 as f64))));
        }
        let is_face = i % 2 == 0;
        let row = v.map(|[start, _]| start);
        let radii =
            if i % 5 == 0 { [0.125, 0.25, 0.0, 0.5].map(|x| x * (r.below(3) as f64)) } else { [0.0; 4] };
        let distance = if is_face {
            crate::prim::near::distance::<f64, true>(row).0
        } else {
            crate::prim::near::distance::<f64, false>(row).0
        };
        // Also separations just below and above the distance, by roundings of f64 and of f32.
        let is_at_the_limit = i / 2 % 3 == 0 && distance.is_finite();
        let min_separation = if is_at_the_limit {
            let parts = [0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-7, -1e-7, 1e-5, -1e-5, -1e-4, -1e-3];
            Real::max(distance * (1.0 + parts[i / 6 % parts.len()]), 0.0)
        } else {
            [0.0, 0.25, 1.0, 50.0][i / 2 % 4]
        };
        let p = Params { min_separation, ..Params::new(1e-6) };
        let within = min_separation + largest(radii);
        let (of_r, of_f32) = if is_face {
            let single = row.map(|at| Vec3(at.0.map(|x| x as f32)));
            (Filter::<f64, true>::new(within).at_once(row), Filter::<f32, true>::new(within).at_once(single))
        } else {
            let single = row.map(|at| Vec3(at.0.map(|x| x as f32)));
            (
                Filter::<f64, false>::new(within).at_once(row),
                Filter::<f32, false>::new(within).at_once(single),
            )
        };
        let is_single = row.iter().all(|at| at.0.iter().all(|&x| x as f32 as f64 == x));
        let drops = [of_r, if is_single { of_f32 } else { 1 }].contains(&0);
        with(&v, is_face, &p, |motion| match motion.begin(radii, &p) {
            Begin::Beyond => {
                beyond += 1;
                dropped += drops as u32;
                at_the_limit += (drops && is_at_the_limit) as u32;
            }
            Begin::Within(_) => {
                assert!(!drops, "{is_face} {within:e} {distance:e} {v:?}");
                near += 1;
            }
        });
    }
    assert!(
        dropped > 10_000 && near > 5_000 && at_the_limit > 500,
        "{dropped} {beyond} {near} {at_the_limit}"
    );
}
