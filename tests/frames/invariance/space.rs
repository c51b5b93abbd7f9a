//! Other units, another origin, other axes, another precision.

use super::*;

#[test]
fn other_units() {
    for power in [-20, -7, -1, 1, 13, 20] {
        let scaled = |body: &Body| mapped(body, |p| p.map(|x| x * 2f64.powi(power)));
        for body in still_scenes() {
            let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
            let again = found(&[scaled(&body)], QueryKind::Discrete);
            assert_eq!(again.hash(), truth.hash(), "{}, 2^{power}", body.name());
            assert_eq!(again.stats.triangle_pairs, truth.stats.triangle_pairs);
        }
        for body in moving_scenes() {
            let truth = found(std::slice::from_ref(&body), QueryKind::Continuous);
            let again = found(&[scaled(&body)], QueryKind::Continuous);
            // Times have no unit: not a bit changes.
            assert_eq!(again.rows, truth.rows, "{}, 2^{power}", body.name());
        }
    }
}

#[test]
fn another_origin() {
    // Multiples of 1/4 up to 16: sums with these are exact in floats.
    for shift in [[1.0, 0.0, 0.0], [-3.25, 1024.0, 0.5], [4096.0, -4096.0, 65_536.0]] {
        let shifted = |body: &Body| mapped(body, |p| [p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]]);
        let body = scene::grid(3).expect("a scene");
        let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
        assert_eq!(found(&[shifted(&body)], QueryKind::Discrete).hash(), truth.hash(), "{shift:?}");
        let body = falling_grid();
        let truth = found(std::slice::from_ref(&body), QueryKind::Continuous);
        assert!(truth.len() > 10);
        // The solver sees only differences.
        assert_eq!(found(&[shifted(&body)], QueryKind::Continuous).rows, truth.rows, "{shift:?}");
    }
}

/// The grid, whose walls move up and aside by quarters, and whose floor stands still.
fn falling_grid() -> Body {
    let body = scene::grid(3).expect("a scene");
    let t0 = body.positions_t0().to_f64();
    let floor = 16;
    let t1 = t0
        .iter()
        .enumerate()
        .map(|(v, p)| if v < floor { *p } else { [p[0] + 0.5, p[1] + 0.25, p[2] + 1.25] });
    let mesh = |points: Vec<[f64; 3]>| {
        let points = points.into_iter().map(|p| p.map(|x| x as f32)).collect();
        Mesh::new("falling grid", Positions::F32(points), body.faces().to_vec()).expect("a mesh")
    };
    Body::moving(mesh(t0.clone()), mesh(t1.collect())).expect("two frames")
}

#[test]
fn other_axes() {
    const TURNS: [fn([f64; 3]) -> [f64; 3]; 6] = [
        |p| [p[1], p[2], p[0]],
        |p| [p[2], p[0], p[1]],
        |p| [p[1], p[0], p[2]],
        |p| [-p[0], p[1], p[2]],
        |p| [p[0], p[2], -p[1]],
        |p| [-p[0], -p[1], -p[2]],
    ];
    for (i, turn) in TURNS.into_iter().enumerate() {
        for body in still_scenes() {
            let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
            let again = found(&[mapped(&body, turn)], QueryKind::Discrete);
            assert_eq!(again.hash(), truth.hash(), "{}, turn {i}", body.name());
        }
        for body in moving_scenes() {
            let truth = found(std::slice::from_ref(&body), QueryKind::Continuous);
            let other = mapped(&body, turn);
            let again = found(std::slice::from_ref(&other), QueryKind::Continuous);
            // Sums of products come in another order: times may differ in the last bits, contacts may not.
            let (one, two) = (named(&other, again.contacts(), |v| v), named(&body, truth.contacts(), |v| v));
            assert_close(&one, &two, body.name());
            let of = |body: &Body| boxed(std::slice::from_ref(body), QueryKind::Continuous);
            assert_eq!(of(&other), of(&body), "boxes know no axes");
        }
    }
}

#[test]
fn the_same_numbers_in_doubles() {
    let promoted = |body: &Body| {
        let f64s = |positions: &Positions| {
            Mesh::new(body.name(), Positions::F64(positions.to_f64()), body.faces().to_vec()).expect("a mesh")
        };
        let t0 = f64s(body.positions_t0());
        match body.positions_t1() {
            None => Body::deformable(t0),
            Some(t1) => Body::moving(t0, f64s(t1)).expect("two frames"),
        }
    };
    for body in still_scenes() {
        let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
        let again = found(&[promoted(&body)], QueryKind::Discrete);
        assert_eq!(
            (again.hash(), again.stats.triangle_pairs),
            (truth.hash(), truth.stats.triangle_pairs),
            "{}",
            body.name()
        );
    }
    for body in moving_scenes() {
        let truth = found(std::slice::from_ref(&body), QueryKind::Continuous);
        let again = found(&[promoted(&body)], QueryKind::Continuous);
        // Differences of floats of like size are exact, in floats and in doubles: so the same bits.
        assert_eq!(again.rows, truth.rows, "{}", body.name());
        // One body in each precision: both are taken in doubles.
        let still = scene::soup(100, 8, false).expect("a scene");
        let mixed = found(&[promoted(&body), still.clone()], QueryKind::Continuous);
        assert_eq!(mixed.rows, found(&[body.clone(), still], QueryKind::Continuous).rows);
    }
}
