//! Bodies that must be refused, with the words of the message; and similar ones that must be
//! accepted.

use super::Numbers;

/// Numbers and words of their refusal; no words if they must be accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// Its id in `docs/internals/robustness.md`.
    pub id: &'static str,
    /// Description of its extreme.
    pub what: &'static str,
    /// One body.
    pub body: Numbers,
    /// Required parts of the message.
    pub words: &'static [&'static str],
}

/// Returns all rows.
pub fn refused() -> Vec<Refused> {
    const NAN: f64 = f64::NAN;
    const INF: f64 = f64::INFINITY;
    let side = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0, 9.0, 9.0]];
    let body = || Numbers { t0: side.to_vec(), faces: vec![[0, 1, 2]], ..Numbers::default() };
    let with = |wide: bool, vertex: usize, x: f64| {
        let mut body = Numbers { wide, ..body() };
        body.t0[vertex][1] = x;
        body
    };
    let later = |x: f64| {
        let mut body = body().by([1.0, 0.0, 0.0]);
        body.t1[2][0] = x;
        body
    };
    let faces = |faces: &[[u32; 3]]| Numbers { faces: faces.to_vec(), ..body() };
    let least = |of: f64| f64::from_bits(of.to_bits() + 1);
    let row = |id, what, body, words| Refused { id, what, body, words };
    let (f32s, f64s) = (2f64.powi(60), 2f64.powi(480));
    vec![
        row("X01", "NaN in f32", with(false, 2, NAN), &["vertex 2 has y = NaN", "must be finite"]),
        row("X01", "NaN in f64", with(true, 0, NAN), &["vertex 0 has y = NaN", "must be finite"]),
        row("X01", "NaN at the end of the step", later(NAN), &["vertex 2 has x = NaN"]),
        row("X02", "NaN in a vertex that no face uses", with(false, 3, NAN), &[]),
        row("X02", "infinity in a vertex that no face uses", with(true, 3, INF), &[]),
        row("X03", "infinity", with(false, 1, INF), &["vertex 1 has y = inf", "must be finite"]),
        row("X03", "minus infinity in f64", with(true, 1, -INF), &["vertex 1 has y = -inf"]),
        row("X03", "infinity at the end of the step", later(-INF), &["vertex 2 has x = -inf"]),
        row("X65", "2^60 in f32", with(false, 1, -f32s), &[]),
        row("X65", "2^61 in f32", with(false, 1, -2.0 * f32s), &[]),
        row("X65", "the largest f32", with(false, 1, f32::MAX.into()), &[]),
        row("X04", "2^480", with(true, 1, f64s), &[]),
        row("X04", "a bit more than 2^480", with(true, 1, least(f64s)), &["vertex 1 has y", "2^480"]),
        row("X46", "an index of 2^31", faces(&[[0, 1, 1 << 31]]), &["face 0 corner 2", "vertex 2147483648"]),
        row(
            "X46",
            "the largest index",
            faces(&[[0, 1, 2], [u32::MAX, 1, 2]]),
            &["face 1 corner 0", "4294967295"],
        ),
        row("X46", "one past the end", faces(&[[0, 4, 2]]), &["face 0 corner 1", "vertex 4", "4 vertices"]),
        row("X46", "a vertex twice in a face", faces(&[[0, 1, 1], [2, 2, 2]]), &[]),
        row("X41", "vertices without faces", faces(&[]), &[]),
        row("X41", "nothing", Numbers::default(), &[]),
    ]
}
