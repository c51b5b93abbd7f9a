//! Pairs one by one against exact oracles: without a thickness the first common point, with one the
//! distance at many times.

use super::*;
use nearmiss::contacts::Status;
use nearmiss_lab::case::{Case, Features};
use nearmiss_lab::oracle::near::{Places, Shape};
use nearmiss_lab::oracle::{first_contact, meet_at};
use std::collections::BTreeMap;

/// Times at which pairs with a thickness are compared: dyadic, so exact.
const TIMES: u32 = 8;

/// Triangles of a body.
const SIZE: usize = 6;

/// All pairs of features of two bodies: their names, points at both ends, and radii.
type Pairs = BTreeMap<(Kind, [u32; 2], [u32; 2]), (Features, [[[f64; 3]; 2]; 4], [f64; 4])>;

fn pairs(bodies: &[Body; 2]) -> Pairs {
    let shape = |body: &Body| Shape { points: body.ends()[0].to_f64(), faces: body.faces().to_vec() };
    let edges = bodies.each_ref().map(|body| shape(body).edges());
    let at = |body: usize, v: u32| bodies[body].ends().map(|end| end.get_f64(v as usize).expect("a vertex"));
    let radius = |body: usize, v: u32| match bodies[body].thickness() {
        Thickness::Same(radius) => *radius,
        Thickness::Each(radii) => radii[v as usize],
    };
    let of = |features, all: [(usize, u32); 4]| {
        (features, all.map(|(body, v)| at(body, v)), all.map(|(body, v)| radius(body, v)))
    };
    let mut found = Pairs::new();
    for [a, b] in [[0, 1], [1, 0]] {
        for v in 0..bodies[a].vertex_count() as u32 {
            for (f, [x, y, z]) in bodies[b].faces().iter().enumerate() {
                let pair = of(Features::VertexFace, [(a, v), (b, *x), (b, *y), (b, *z)]);
                found.insert((Kind::Vf, [a as u32, b as u32], [v, f as u32]), pair);
            }
        }
    }
    for (i, [w, x]) in edges[0].iter().enumerate() {
        for (j, [y, z]) in edges[1].iter().enumerate() {
            let pair = of(Features::EdgeEdge, [(0, *w), (0, *x), (1, *y), (1, *z)]);
            found.insert((Kind::Ee, [0, 1], [i as u32, j as u32]), pair);
        }
    }
    found
}

/// The first fault of rows: a pair that is missed, late, or falsely certain.
fn judged(pairs: &Pairs, rows: &[Row]) -> Option<String> {
    let rows: BTreeMap<_, _> = rows.iter().copied().collect();
    pairs.iter().find_map(|(name, &(features, ends, radii))| {
        let row = rows.get(name).map(|[toi, upper, status]| {
            (f64::from_bits(*toi), f64::from_bits(*upper), *status == Status::Certified as u64)
        });
        let toi = row.map_or(2.0, |(toi, ..)| toi);
        let is_thin = radii == [0.0; 4];
        if is_thin {
            let case = Case { features, positions_t0: ends.map(|p| p[0]), positions_t1: ends.map(|p| p[1]) };
            match first_contact(&case) {
                Some(first) if first.cmp_f64(toi).is_lt() => {
                    Some(format!("thin pair {name:?} is late or missed"))
                }
                None if row.is_some_and(|(.., is_certain)| is_certain) && !meet_at(&case, toi) => {
                    Some(format!("thin pair {name:?} never meets"))
                }
                _ => None,
            }
        } else {
            let within = |t: f64| Places::at(features, ends, t, radii).within(0.0)[0];
            let late = (0..=TIMES).map(|k| f64::from(k) / f64::from(TIMES)).find(|&t| t < toi && within(t));
            let is_false = row.is_some_and(|(_, upper, is_certain)| is_certain && !within(upper));
            let late = late.map(|t| format!("thick pair {name:?} is within at {t}, before {toi}"));
            late.or_else(|| is_false.then(|| format!("thick pair {name:?} is not within at its latest time")))
        }
    })
}

/// Two bodies of few large triangles, of which one has radii at some vertices.
fn bodies(seed: u64) -> [Body; 2] {
    let mut rng = scene::Rng::new(seed);
    let mut points = || {
        let mut number = |_| (rng.bits() % 129) as f32 / 64.0 - 1.0;
        Positions::F32((0..3 * SIZE).map(|_| [0, 1, 2].map(&mut number)).collect())
    };
    let faces: Vec<_> = (0..SIZE as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut body = |thickness: Thickness| {
        let mesh = |points| Mesh::new("large", points, faces.clone()).expect("a mesh");
        let moved = Body::moving(mesh(points()), mesh(points())).expect("a step");
        moved.with_filter(CollisionFilter::without_self_collision()).with_thickness(thickness)
    };
    [body(0.0.into()), body(partial(SIZE, 0.25).into())]
}

#[test]
fn no_pair_of_either_sort_is_missed_late_or_falsely_certain() {
    let mut counts = [0; 2];
    for seed in 1..4 {
        let bodies = bodies(seed);
        for certified in solvers(false) {
            let found = found(engine(), &bodies, Continuous::by(certified));
            let rows: Vec<Row> = found.rows.iter().flatten().copied().collect();
            assert_eq!(judged(&pairs(&bodies), &rows), None, "seed {seed}, {certified:?}");
            counts.iter_mut().zip(&found.rows).for_each(|(count, rows)| *count += rows.len());
        }
    }
    assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
}

#[test]
fn the_oracles_name_planted_faults() {
    let (bodies, certified) = (bodies(2), solvers(false)[1]);
    let (all, found) = (pairs(&bodies), found(engine(), &bodies, Continuous::by(certified)).rows);
    let says = |rows: [&[Row]; 2]| judged(&all, &rows.concat()).unwrap_or_default();
    let [thin, thick] = &found;
    assert_eq!(says([thin, thick]), "");
    assert!(says([&[], thick]).contains("thin pair") && says([thin, &[]]).contains("is within at"));
    // Each later than it is.
    let later = |rows: &[Row]| -> Vec<Row> {
        let late = |toi: u64| (f64::from_bits(toi) + 0.2).min(1.0).to_bits();
        rows.iter().map(|(name, [toi, upper, status])| (*name, [late(*toi), *upper, *status])).collect()
    };
    assert!(says([&later(thin), thick]).contains("late") && says([thin, &later(thick)]).contains("before"));
    // A pair that never meets, said to be certain.
    let apart = all.iter().find(|(name, (features, ends, radii))| {
        let case =
            Case { features: *features, positions_t0: ends.map(|p| p[0]), positions_t1: ends.map(|p| p[1]) };
        *radii == [0.0; 4] && first_contact(&case).is_none() && !thin.iter().any(|row| row.0 == **name)
    });
    let (name, _) = apart.expect("a pair that never meets");
    let invented = [(*name, [0.5f64.to_bits(), 0.5f64.to_bits(), Status::Certified as u64])];
    assert!(says([&[thin.as_slice(), &invented].concat(), thick]).contains("never meets"));
}
