use super::*;
use crate::prim::approach::forms::{end, start};
use crate::prim::approach::tests::forms;
use crate::random::Random;

limbs! { Widest, 64, 64, 64, 64, 64, 64 }
// The fewest limbs for pairs of 286 bits, and one less of each kind.
limbs! { Fewest, 10, 19, 28, 37, 55, 64 }
limbs! { ShortOne, 8, 20, 30, 40, 60, 70 }
limbs! { ShortTwo, 10, 17, 30, 40, 60, 70 }
limbs! { ShortThree, 10, 20, 26, 40, 60, 70 }
limbs! { ShortFour, 10, 20, 30, 35, 60, 70 }
limbs! { ShortSix, 10, 20, 30, 40, 53, 70 }
limbs! { ShortSeven, 10, 20, 30, 40, 60, 61 }

/// Vertices whose coordinates span so many bits: random ones, or of the largest magnitude.
fn spanning(r: &mut Random, bits: i32, is_extreme: bool) -> Vertices<f64> {
    let grid = r.below(40) as i32 - 20;
    let top = bits - 1;
    let mut vertices = [[Vec3([0.0; 3]); 2]; 4].map(|ends: [Vec3<f64>; 2]| {
        ends.map(|at| {
            Vec3(at.0.map(|_| {
                let sign = if r.below(2) == 0 { 1.0 } else { -1.0 };
                // 53 bits below the top, or fewer.
                let low = (top - 52).max(0);
                let at = if is_extreme || r.below(2) == 0 { low } else { r.below(low as u64 + 1) as i32 };
                let most = (1u64 << (top - low + 1).min(53)) - 1;
                let mantissa = if is_extreme && r.below(4) > 0 { most } else { r.below(most + 1) };
                sign * mantissa as f64 * f64::pow2(at + grid)
            }))
        })
    });
    // Some alike, so that forms are 0, and one on the grid's last bit.
    if !is_extreme && r.below(2) == 0 {
        vertices[r.below(4) as usize] = vertices[r.below(4) as usize];
        vertices[r.below(4) as usize][1] = vertices[r.below(4) as usize][0];
    }
    vertices[0][0].0[0] = f64::pow2(grid);
    vertices[1][1].0[1] = -f64::pow2(top + grid);
    vertices
}

/// How many signs of a type differ from those of 2,048 bits.
fn faults(bits: i32, count: u32, sign: impl Fn(Form, &Vertices<f64>, bool, i32) -> i32) -> u32 {
    let mut r = Random(bits as u64);
    let mut faults = 0;
    for i in 0..count {
        let vertices = spanning(&mut r, bits, i % 2 == 0);
        let (grid, spanned) = common_grid(&vertices);
        assert!(spanned <= bits && spanned > bits - 2, "{spanned} for {bits}");
        for is_face in [true, false] {
            for form in forms(is_face) {
                let wanted = form.value(&Widest::of(&vertices, is_face, grid));
                faults += u32::from(sign(form, &vertices, is_face, grid) != wanted);
            }
        }
    }
    faults
}

fn in_small(form: Form, vertices: &Vertices<f64>, is_face: bool, grid: i32) -> i32 {
    small(form, &Small::new(vertices, is_face, grid))
}

#[test]
fn sizes_of_integers_have_the_same_signs() {
    for bits in [8, 24, 40, 53, 58, 59, SMALL] {
        assert_eq!(faults(bits, 200, in_small), 0, "{bits}");
    }
    for bits in [24, 61, 64, 120, 277, LARGE] {
        assert_eq!(faults(bits, 60, |form, v, is_face, grid| form.value(&Large::of(v, is_face, grid))), 0);
        assert_eq!(faults(bits, 60, |form, v, is_face, grid| form.value(&Fewest::of(v, is_face, grid))), 0);
    }
}

/// Numbers of the large size are compared with those of the small one, too, through the choice.
#[test]
fn the_choice_takes_a_size_that_holds_the_pair() {
    for bits in [30, SMALL, SMALL + 1, LARGE] {
        let chosen = |form, v: &Vertices<f64>, is_face, _| Exact::new(v, is_face).sign(form).expect("a sign");
        assert_eq!(faults(bits, 40, chosen), 0, "{bits}");
    }
    let mut r = Random(1);
    let vertices = spanning(&mut r, LARGE + 1, true);
    assert_eq!(Exact::new(&vertices, true).sign(Form::PlaneHeight), None);
}

/// One limb less than any kind needs, and bits beyond the small size, are noticed.
#[test]
fn a_size_that_is_too_small_is_noticed() {
    for bits in [62, 63, 64, 66] {
        assert!(faults(bits, 200, in_small) > 0, "{bits}");
    }
    macro_rules! noticed {
        ($($short:ident)*) => { $(
            let of = |form: Form, v: &Vertices<f64>, is_face, grid| form.value(&$short::of(v, is_face, grid));
            assert!(faults(LARGE, 200, of) > 0, stringify!($short));
        )* };
    }
    noticed! { ShortOne ShortTwo ShortThree ShortFour ShortSix ShortSeven }
}

/// Products of all signs against machine integers, at the ends of the range too.
#[test]
fn products_are_those_of_machine_integers() {
    let mut r = Random(5);
    let ends = [0, 1, -1, i64::MAX, i64::MIN, i64::MIN + 1, 1 << 32, -(1 << 32)];
    for i in 0..2_000 {
        let mut one = || if i % 2 == 0 { ends[r.below(8) as usize] } else { r.next() as i64 };
        let (a, b) = (one(), one());
        let wanted = a as i128 * b as i128;
        let whole = |x: i128| Wide([x as u64, (x >> 64) as u64]);
        let found = Wide::<2>::product(&Wide([a as u64]), &Wide([b as u64]));
        assert_eq!((found, found.sign()), (whole(wanted), wanted.signum() as i32), "{a} {b}");
        assert_eq!(Small::two(&Wide([a as u64]), &Wide([b as u64])), found);
        let [c, d] = [a as i128 * 3 - 1, b as i128 - a as i128];
        assert_eq!(whole(c).plus(&whole(d)), whole(c + d));
        assert_eq!(whole(c).minus(&whole(d)), whole(c - d));
    }
    assert_eq!([start(1), end(1)].map(|at| at.is_end), [false, true]);
}
