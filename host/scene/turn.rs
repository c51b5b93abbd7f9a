//! Circles and waves by `+ - * /` alone: the same on every machine.

/// Cosine and sine of so many whole turns: Taylor's series of an eighth of the angle, then doubled three times. Off by
/// less than 1e-14.
pub(super) fn circle(turns: f64) -> [f64; 2] {
    let x = (turns - (turns + 0.5).floor()) * (std::f64::consts::TAU / 8.0);
    let square = x * x;
    // 1 - x^2/(1 2) (1 - x^2/(3 4) (...)) and x (1 - x^2/(2 3) (1 - ...)): |x| <= 0.4, the first term left out is 1e-17.
    let series = |first: f64| {
        (0..6).rev().fold(1.0, |sum, k| {
            let n = first + 2.0 * f64::from(k);
            1.0 - square / (n * (n + 1.0)) * sum
        })
    };
    let (mut c, mut s) = (series(1.0), x * series(2.0));
    for _ in 0..3 {
        (c, s) = (c * c - s * s, 2.0 * c * s);
    }
    [c, s]
}

/// A wave of period 1 and height 1 made of two parabolas: nearly a sine, the same on every machine.
pub(super) fn wave(x: f64) -> f64 {
    let t = x - (x + 0.5).floor();
    8.0 * t * (1.0 - 2.0 * t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_a_circle() {
        for k in -40..=40 {
            let turns = f64::from(k) / 16.0;
            let ([c, s], x) = (circle(turns), turns * std::f64::consts::TAU);
            assert!((c - x.cos()).abs() < 1e-14 && (s - x.sin()).abs() < 1e-14, "{turns}: {c} {s}");
            assert!((wave(turns) - s).abs() < 0.06, "{turns}");
        }
    }
}
