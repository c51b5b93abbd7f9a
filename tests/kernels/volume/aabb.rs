//! Boxes: they hold what they were made of, as tightly as floats allow; union and overlap are exact.

use nearmiss_kernels::bv::Aabb;
use nearmiss_kernels::math::Vec3;
use nearmiss_lab::scene::Rng;

/// Numbers of every size and sign that a mesh in doubles may have, some of them floats.
fn number(rng: &mut Rng) -> f64 {
    let power = (rng.bits() % 340) as i32 - 170;
    match rng.bits() % 8 {
        0 => 0.0,
        1 => -0.0,
        2 => rng.around(8.0).round(),
        3 => rng.around(1.0) as f32 as f64,
        // The smallest doubles, and next to the largest float.
        4 => rng.around(1.0) * f64::MIN_POSITIVE,
        5 => f64::from(f32::MAX) * (1.0 + rng.around(1e-9)),
        _ => rng.around(1.0) * 2f64.powi(power),
    }
}

fn point(rng: &mut Rng) -> Vec3<f64> {
    Vec3([(); 3].map(|()| number(rng)))
}

/// The first rule that a box of these points breaks.
fn broken(of: &[Vec3<f64>], volume: &Aabb) -> Option<String> {
    for axis in 0..3 {
        let (lo, hi) = (volume.lo[axis], volume.hi[axis]);
        let least = of.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let most = of.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        if !(f64::from(lo) <= least && most <= f64::from(hi)) {
            return Some(format!("axis {axis}: {lo:e} to {hi:e} does not hold {least:e} to {most:e}"));
        }
        if f64::from(lo.next_up()) <= least || f64::from(hi.next_down()) >= most {
            return Some(format!("axis {axis}: {lo:e} to {hi:e} is wide for {least:e} to {most:e}"));
        }
    }
    None
}

#[test]
fn a_box_holds_its_points_as_tightly_as_floats_allow() {
    let mut rng = Rng::new(3);
    for _ in 0..20_000 {
        let points = [(); 3].map(|()| point(&mut rng));
        assert_eq!(broken(&points, &Aabb::of(points)), None, "{points:?}");
        let floats = points.map(|p| p.map(|x| x.clamp(-1e30, 1e30) as f32));
        let exact = Aabb::of(floats);
        for axis in 0..3 {
            let of = floats.map(|p| p[axis]);
            let (least, most) = (of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2]));
            assert_eq!((exact.lo[axis], exact.hi[axis]), (least, most), "floats are held exactly");
        }
    }
}

#[test]
fn a_wrong_box_is_noticed() {
    let points = [[0.1, -0.1, 3.0], [0.2, 0.7, 3.0], [0.15, 0.0, 3.0]].map(Vec3);
    let sound = Aabb::of(points);
    assert_eq!(broken(&points, &sound), None);
    for axis in 0..3 {
        let faults: [fn(&mut Aabb, usize); 4] = [
            |b, axis| b.lo[axis] = b.lo[axis].next_up(),
            |b, axis| b.lo[axis] = b.lo[axis].next_down(),
            |b, axis| b.hi[axis] = b.hi[axis].next_up(),
            |b, axis| b.hi[axis] = b.hi[axis].next_down(),
        ];
        for fault in faults {
            let mut volume = sound;
            fault(&mut volume, axis);
            assert!(broken(&points, &volume).is_some_and(|text| text.contains(&format!("axis {axis}"))));
        }
    }
}

#[test]
fn union_is_exact_and_knows_no_order() {
    let mut rng = Rng::new(4);
    for _ in 0..5_000 {
        let [a, b, c] = [(); 3].map(|()| [point(&mut rng), point(&mut rng)]);
        let [p, q, r] = [a, b, c].map(Aabb::of);
        assert_eq!(p.merge(q), Aabb::of([a[0], a[1], b[0], b[1]]));
        assert_eq!(p.merge(q), q.merge(p));
        assert_eq!(p.merge(q).merge(r), p.merge(q.merge(r)));
        assert_eq!((p.merge(p), p.merge(Aabb::EMPTY), Aabb::EMPTY.merge(p)), (p, p, p));
    }
}

#[test]
fn overlap_is_closed_and_needs_every_axis() {
    let unit = Aabb { lo: [0.0; 3], hi: [1.0; 3] };
    assert!(unit.overlaps(&unit) && !Aabb::EMPTY.overlaps(&unit) && !unit.overlaps(&Aabb::EMPTY));
    for axis in 0..3 {
        for (from, to, meets) in [
            (1.0, 2.0, true),
            (1f32.next_up(), 2.0, false),
            (-1.0, 0.0, true),
            (-1.0, 0f32.next_down(), false),
            (0.5, 0.5, true),
            (-1.0, 2.0, true),
            (-1.0, -0.0, true),
        ] {
            let mut other = unit;
            (other.lo[axis], other.hi[axis]) = (from, to);
            assert_eq!(unit.overlaps(&other), meets, "axis {axis}: {from} to {to}");
            assert_eq!(other.overlaps(&unit), meets, "axis {axis}: {from} to {to}");
        }
    }
}
