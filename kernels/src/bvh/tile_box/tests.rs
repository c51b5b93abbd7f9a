//! The boxes and their tests, by exact signs and by their own bounds.

use super::*;
use crate::abi::{InstanceFrame, MeshRecord};
use crate::bvh::relation::size;
use crate::math::rigid;
use crate::prim::tri_tri::meets_exactly;

/// The largest difference of a distance of centres and both radii, along the six face normals. Boxes
/// of triangles that share a point have none above [`TILE_SLACK`] times the slack of the relation.
fn gap(relation: &Relation, a: &TileBox, b: &TileBox) -> f32 {
    along(relation, a, b).into_iter().fold(0.0, |most, (distance, radii)| most.max(distance.abs() - radii))
}

/// Numbers without an order.
struct Numbers(u64);

impl Numbers {
    /// From -1 to 1.
    fn any(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> Vec3<f64> {
        Vec3([self.any(), self.any(), self.any()])
    }
    /// From 1 to a power of ten, most of them small.
    fn size(&mut self, digits: f64) -> f64 {
        let steps = (self.any().abs() * digits * 3.33) as i32;
        (0..steps).fold(1.0, |size, _| 2.0 * size)
    }
    fn turn(&mut self) -> [f64; 4] {
        unit([self.any(), self.any(), self.any(), self.any()])
    }
}

fn unit<const N: usize>(v: [f64; N]) -> [f64; N] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

fn single(v: Vec3<f64>) -> [f32; 3] {
    v.map(|x| x as f32).0
}

#[test]
fn a_box_holds_its_points_and_a_smaller_one_does_not() {
    let mut of = Numbers(1);
    for case in 0..4_000 {
        let (at, scale) = (of.vector() * of.size(6.0), 1.0 / of.size(4.0));
        let flat = [1.0, 1e-3, 1e-9, 0.0][case % 4];
        let n = Vec3(unit(of.vector().0));
        let count = 1 + case % 96;
        let mut points = [[0.0; 3]; 96];
        for p in &mut points[..count] {
            let v = of.vector();
            *p = single(at + (v - n * (v.dot(n) * (1.0 - flat))) * scale);
        }
        let points = &points[..count];
        let around = TileBox::around(points, [single(n), single(of.vector())]);
        assert!(points.iter().all(|&p| around.holds(p)), "{points:?}");
        for k in 0..3 {
            let mut smaller = around;
            let sum: f32 = around.half.iter().sum();
            smaller.half[k] -= 1e-5 * sum;
            let is_named = !points.iter().all(|&p| smaller.holds(p));
            assert!(is_named | (sum == 0.0), "axis {k} of {around:?} around {points:?}");
        }
    }
    let large = TileBox::around(&[[f32::NAN, 0.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(large, TileBox::EVERYTHING);
}

/// Two tiles whose placed triangles share a point, face to face: none of the second's corners is
/// below the face of the first by more than rounding. `None` if rounding parts them.
fn touching(of: &mut Numbers) -> Option<(Relation, [TileBox; 2])> {
    let (place, off) = (of.size(10.0), [of.size(4.0), of.size(4.0)]);
    let first = of.turn();
    let by = 1.0 / of.size(30.0);
    let second = unit([0, 1, 2, 3].map(|k| first[k] + by * of.any()));
    let rows = [first, second].map(rigid::rows);
    let up = Vec3(unit(of.vector().0));
    let back = |rows: &[[f64; 3]; 3], v: Vec3<f64>| {
        Vec3([0, 1, 2].map(|i| rows[0][i] * v[0] + rows[1][i] * v[1] + rows[2][i] * v[2]))
    };
    let across = unit(up.cross(of.vector()).0);
    let across = [Vec3(across), up.cross(Vec3(across))];
    // A triangle in the upper face, and a corner of the other above its inside.
    let along = |x: f64, y: f64, z: f64| across[0] * x + across[1] * y + up * z;
    let p = [along(1.0, 0.1, 0.0), along(-0.7, 0.8, 0.0), along(-0.6, -0.9, 0.0), along(0.0, 0.0, -0.3)];
    let rise = of.any().abs();
    let q = [along(0.0, 0.0, 0.0), along(0.5, of.any(), rise), along(of.any(), -0.5, 0.2 * rise)];
    let base = [of.vector() * off[0], of.vector() * off[1]];
    let local = |side: usize, v: Vec3<f64>| back(&rows[side], v) + base[side];
    let (p, q) = (p.map(|v| local(0, v)), q.map(|v| local(1, v)));
    let translation = (of.vector() * place).0;
    let at = |side: usize, t: &[f64; 3], v: Vec3<f64>| rigid::moved(&rows[side], t, v);
    let target = at(0, &translation, p[0] * 0.4 + p[1] * 0.3 + p[2] * 0.3);
    let there = at(1, &[0.0; 3], q[0]);
    let depth = of.any().abs() * 8.0 * f64::EPSILON * (place + off[0] + off[1]);
    let other = (target - there - up * depth).0;
    let placed = [p[0], p[1], p[2]].map(|v| at(0, &translation, v));
    if !meets_exactly(&placed, &q.map(|v| at(1, &other, v))) {
        return None;
    }
    let frame = |side: usize, t: [f64; 3]| InstanceFrame {
        rows: rows[side],
        translation: t,
        origin: at(side, &t, Vec3([0.0; 3])).0,
        far: size(&t),
    };
    let radius = |points: &[Vec3<f64>]| points.iter().map(|v| v.dot(*v)).fold(0.0, f64::max).sqrt();
    let mesh = |radius| MeshRecord { radius, ..MeshRecord::default() };
    let (a, b) = (frame(0, translation), frame(1, other));
    let relation = Relation::of([0, 1], [&a, &b], [&mesh(radius(&p)), &mesh(radius(&q))]);
    let axes = |side: usize| [up, across[0]].map(|v| single(back(&rows[side], v)));
    let boxes = [TileBox::around(&p.map(single), axes(0)), TileBox::around(&q.map(single), axes(1))];
    Some((relation, boxes))
}

#[test]
fn tiles_that_meet_are_never_apart() {
    let mut of = Numbers(2);
    // Lost without the slack, and with a hundredth of it. No coordinate needs all its roundings.
    let (mut met, mut lost, mut most) = (0, [0, 0], 0.0_f32);
    for _ in 0..400_000 {
        let Some((relation, [a, b])) = touching(&mut of) else { continue };
        met += 1;
        let gap = gap(&relation, &a, &b);
        assert!(gap <= TILE_SLACK * relation.slack, "{relation:?} {a:?} {b:?}");
        assert_eq!(TilesApart { relation }.at_once([a, b]), 0);
        most = most.max(gap / (TILE_SLACK * relation.slack));
        for (lost, part) in lost.iter_mut().zip([0.0, 0.01]) {
            *lost += u32::from(gap > part * TILE_SLACK * relation.slack);
        }
    }
    assert!(met > 50_000 && lost[0] > met / 20 && lost[1] > 0, "{lost:?} of {met}; at most {most}");
}

/// [`gap`] of the same stored numbers, in f64.
fn wide_gap(relation: &Relation, a: &TileBox, b: &TileBox) -> f64 {
    let wide = |v: [f32; 3]| Vec3(v).wide();
    let axes = |of: &TileBox| three(of.axes.map(Vec3)).map(|a| a.wide());
    let turned = |v: Vec3<f64>| Vec3(relation.turn.map(|row| wide(row).dot(v)));
    let (x, y) = (axes(a), axes(b).map(turned));
    let t = turned(wide(b.centre)) + wide(relation.shift) - wide(a.centre);
    let reach = |l: Vec3<f64>| -> f64 {
        (0..3).map(|k| a.half[k].wide() * l.dot(x[k]).abs() + b.half[k].wide() * l.dot(y[k]).abs()).sum()
    };
    x.into_iter().chain(y).map(|l| l.dot(t).abs() - reach(l)).fold(0.0, f64::max)
}

/// Measured: the roundings of a gap of two boxes of about one size, at about that distance, in parts
/// of [`TILE_BOX`]. Axes that are not quite orthonormal are the other half of the bound.
#[test]
fn roundings_of_a_gap() {
    let (mut of, mut most, mut open) = (Numbers(3), 0.0_f64, 0);
    for _ in 0..200_000 {
        let mut around = || {
            let points = [(); 4].map(|()| single(of.vector()));
            TileBox::around(&points, [single(of.vector()), single(of.vector())])
        };
        let [a, b] = [around(), around()];
        let rows = rigid::rows(of.turn()).map(|row| row.map(|x| x as f32));
        let relation = Relation { turn: rows, shift: single(of.vector() * 4.0), ..Relation::default() };
        let sum: f64 = a.half.iter().chain(&b.half).map(|h| h.wide()).sum();
        let exact = wide_gap(&relation, &a, &b);
        // Boxes that are far apart have no bound, and need none.
        if exact > 0.0 && exact < 0.2 * sum {
            open += 1;
            most = most.max((gap(&relation, &a, &b).wide() - exact).abs() / (TILE_BOX * sum));
        }
    }
    assert!(open > 1_000 && (1.0 / 40.0..=1.0).contains(&most), "{most} of the bound, {open} boxes");
}

#[test]
fn tiles_that_are_apart_are_found_and_everything_is_apart_from_none() {
    let one = MeshRecord { radius: 2.0, ..MeshRecord::default() };
    let at = |x: f64| InstanceFrame {
        rows: rigid::rows([0.0, 0.0, 0.0, 1.0]),
        translation: [x, 0.0, 0.0],
        origin: [x, 0.0, 0.0],
        far: x,
    };
    // Two plates across the diagonal: boxes along the axes overlap.
    let plate = [[-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0]];
    let plate = TileBox::around(&plate, [[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let relation = |x: f64| Relation::of([0, 1], [&at(0.0), &at(x)], [&one, &one]);
    let verdict = |relation: Relation, a, b| TilesApart { relation }.at_once([a, b]);
    assert_eq!(verdict(relation(0.1), plate, plate), APART);
    assert_eq!(verdict(relation(0.0), plate, plate), 0);
    assert_eq!(verdict(relation(1e40), plate, plate), 0, "no frames");
    for [a, b] in [[plate, TileBox::EVERYTHING], [TileBox::EVERYTHING, plate], [TileBox::EVERYTHING; 2]] {
        assert_eq!(verdict(relation(100.0), a, b), 0);
    }
}
