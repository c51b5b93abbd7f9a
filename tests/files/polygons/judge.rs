//! Whether triangles cover a polygon once, in integers.

pub type Flat = [i64; 2];

/// Twice the signed area of a triangle.
pub fn sign(flat: &[Flat], triangle: &[u32; 3]) -> i128 {
    let [a, b, c] = triangle.map(|k| flat[k as usize].map(i128::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the signed area of a polygon.
pub fn area(flat: &[Flat]) -> i128 {
    let next = flat.iter().cycle().skip(1);
    let edge =
        |(p, q): (&Flat, &Flat)| i128::from(p[0]) * i128::from(q[1]) - i128::from(p[1]) * i128::from(q[0]);
    flat.iter().zip(next).map(edge).sum()
}

pub fn fan(corners: usize) -> Vec<[u32; 3]> {
    (1..corners as u32 - 1).map(|k| [0, k, k + 1]).collect()
}

/// Faults of the triangles of a polygon that does not cross or touch itself.
pub fn judge(flat: &[Flat], triangles: &[[u32; 3]]) -> Result<(), String> {
    let all = area(flat);
    if triangles.len() + 2 != flat.len() {
        return Err(format!("{} triangles of {} corners", triangles.len(), flat.len()));
    }
    // A right fan may have flat triangles, ears have none.
    let flat_allowed = triangles == fan(flat.len());
    let turns = |t: &&[u32; 3]| {
        let area = sign(flat, t) * all.signum();
        area < 0 || (area == 0 && !flat_allowed)
    };
    if let Some(t) = triangles.iter().find(turns) {
        return Err(format!("{t:?} turns against the polygon"));
    }
    let sum: i128 = triangles.iter().map(|t| sign(flat, t)).sum();
    if sum != all {
        return Err(format!("areas sum to {sum}, not {all}"));
    }
    let n = flat.len() as u32;
    let has = |a: u32, b: u32| triangles.iter().any(|t| (0..3).any(|k| t[k] == a && t[(k + 1) % 3] == b));
    if let Some(k) = (0..n).find(|&k| !has(k, (k + 1) % n)) {
        return Err(format!("the edge of corner {k} is in no triangle"));
    }
    for (k, a) in triangles.iter().enumerate() {
        if let Some(b) = triangles[k + 1..].iter().find(|b| overlap(flat, a, b)) {
            return Err(format!("{a:?} and {b:?} overlap"));
        }
    }
    Ok(())
}

/// Whether triangles have inner points in common: no edge of one has the other beyond it.
fn overlap(flat: &[Flat], a: &[u32; 3], b: &[u32; 3]) -> bool {
    let apart = |s: &[u32; 3], t: &[u32; 3]| {
        let inner = sign(flat, s).signum();
        (0..3).any(|k| t.iter().all(|&p| sign(flat, &[s[k], s[(k + 1) % 3], p]) * inner <= 0))
    };
    !apart(a, b) && !apart(b, a)
}
