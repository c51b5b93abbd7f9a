//! Axes: logarithmic if numbers span decades, with a place for zero below the smallest; round
//! numbers at both ends.

/// Map from numbers to pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// Powers of ten `from..=to`; zero at `from - 1`, if there is a zero.
    Log {
        /// Lowest power.
        from: i32,
        /// Highest power.
        to: i32,
        /// Whether there is a place for zero.
        zero: bool,
    },
    /// Even steps from `first` to `last`, each `digit` times a power of ten.
    Even {
        /// Lowest value, in steps.
        first: i64,
        /// Highest value, in steps.
        last: i64,
        /// A step's digit: 1, 2 or 5.
        digit: i64,
        /// A step's power of ten.
        power: i32,
    },
}

/// Approximate number of steps of an even axis.
const STEPS: f64 = 6.0;

impl Axis {
    /// Returns an axis that holds these numbers. It is logarithmic, except in three cases: one
    /// number is negative, all are small whole numbers, or those above zero are within a decade.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Axis {
        let finite = values.filter(|x| x.is_finite());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        finite.clone().for_each(|x| (low, high) = (low.min(x), high.max(x)));
        if low > high {
            return Axis::even(0.0, 1.0, false);
        }
        let whole = finite.clone().all(|x| x == x.trunc());
        let least = finite.filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
        if low < 0.0 || (whole && high <= 20.0) || least.is_infinite() || high < 10.0 * least {
            return Axis::even(low, high, whole);
        }
        let from = least.log10().floor() as i32;
        Axis::Log { from, to: (high.log10().ceil() as i32).max(from + 1), zero: low == 0.0 }
    }

    /// Returns even steps that hold both numbers; whole steps for whole numbers.
    fn even(low: f64, high: f64, whole: bool) -> Axis {
        let (low, high) = match high - low {
            span if span > 0.0 => (low, high),
            _ if low == 0.0 => (0.0, 1.0),
            _ => (low - low.abs() / 4.0, low + low.abs() / 4.0),
        };
        let raw = ((high - low) / STEPS).max(if whole { 1.0 } else { 0.0 });
        let mut power = raw.log10().floor() as i32;
        let part = raw / 10f64.powi(power);
        let digit = [1, 2, 5].into_iter().find(|digit| part <= *digit as f64 + 1e-9).unwrap_or(1);
        if part > 5.0 + 1e-9 {
            power += 1;
        }
        let steps = |x: f64| x / (digit as f64 * 10f64.powi(power));
        // A number on a grid line stays there.
        let (first, last) = ((steps(low) + 1e-9).floor() as i64, (steps(high) - 1e-9).ceil() as i64);
        Axis::Even { first, last, digit, power }
    }

    /// Returns whether the axis is logarithmic.
    pub fn is_log(&self) -> bool {
        matches!(self, Axis::Log { .. })
    }

    /// Returns the axis's name, with "log scale" if it is logarithmic.
    pub fn named(&self, what: &str) -> String {
        if self.is_log() { format!("{what}, log scale") } else { what.to_owned() }
    }

    /// Returns the place of a number, from 0 to 1.
    pub fn part(&self, x: f64) -> f64 {
        match *self {
            Axis::Log { from, to, zero } => {
                let low = f64::from(from) - if zero { 0.5 } else { 0.0 };
                let at = if x > 0.0 { x.log10() } else { low };
                ((at - low) / (f64::from(to) - low)).clamp(0.0, 1.0)
            }
            Axis::Even { first, last, digit, power } => {
                let steps = x / (digit as f64 * 10f64.powi(power));
                ((steps - first as f64) / (last - first).max(1) as f64).clamp(0.0, 1.0)
            }
        }
    }

    /// Returns the places of grid lines with their labels: at most ten.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        match *self {
            Axis::Log { from, to, zero } => {
                let every = ((to - from) / 8 + 1) as usize;
                let decade = |e: i32| {
                    let text =
                        if (-2..=4).contains(&e) { format!("{}", 10f64.powi(e)) } else { format!("1e{e}") };
                    (10f64.powi(e), text)
                };
                let zero = zero.then(|| (0.0, "0".to_owned()));
                zero.into_iter().chain((from..=to).step_by(every).map(decade)).collect()
            }
            Axis::Even { first, last, digit, power } => {
                let tick = |step: i64| {
                    let x = (step * digit) as f64 * 10f64.powi(power);
                    let digits = power.min(0).unsigned_abs() as usize;
                    let text =
                        if (-5..12).contains(&power) { format!("{x:.digits$}") } else { format!("{x:.0e}") };
                    (x, text)
                };
                (first..=last).map(tick).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the ticks that are not round: neither 0 nor a multiple of 1, 2 or 5 times a power of
    /// ten. On a logarithmic axis only powers of ten are round.
    fn not_round(axis: &Axis, ticks: &[(f64, String)]) -> Vec<f64> {
        let power = |x: f64| (x.log10() - x.log10().round()).abs() < 1e-6;
        let above = ticks.iter().map(|tick| tick.0);
        if axis.is_log() {
            return above.filter(|x| *x != 0.0 && !power(*x)).collect();
        }
        let apart = above.clone().zip(above.skip(1)).map(|(a, b)| b - a);
        apart.filter(|step| ![1.0, 2.0, 5.0].iter().any(|digit| power(step / digit))).collect()
    }

    #[test]
    fn an_axis_holds_its_numbers() {
        let log = Axis::of([0.0, 0.02, 500.0].into_iter());
        assert_eq!(log, Axis::Log { from: -2, to: 3, zero: true });
        assert_eq!((log.part(0.0), log.part(1000.0)), (0.0, 1.0));
        assert!(log.part(0.01) > 0.05 && log.named("x") == "x, log scale");
        let even = |values: &[f64]| {
            let axis = Axis::of(values.iter().copied());
            assert_eq!(axis.named("x"), "x", "{axis:?}");
            axis.ticks().into_iter().map(|tick| tick.1).collect::<Vec<_>>()
        };
        assert_eq!(Axis::of([-100.0, 100.0].into_iter()).part(0.0), 0.5);
        assert_eq!(even(&[-100.0, 100.0]), ["-100", "-50", "0", "50", "100"]);
        assert_eq!(even(&[1.0, 1.3]), ["1.00", "1.05", "1.10", "1.15", "1.20", "1.25", "1.30"]);
        assert_eq!(even(&[0.0, 12.0]), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(even(&[0.0, 1.0]), ["0", "1"]);
        assert_eq!(even(&[2.1, 8.7]), ["2", "4", "6", "8", "10"]);
        assert_eq!(even(&[0.0, 0.0]), ["0", "1"]);
        assert_eq!(even(&[12.0]), ["9", "10", "11", "12", "13", "14", "15"]);
        assert_eq!(even(&[]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    }

    #[test]
    fn ticks_are_round_and_few() {
        let mut value = 3e-12;
        while value < 1e13 {
            for other in [value * 1.0001, value * 1.7, value * 6.3, value * 2e4, 0.0, -value / 3.0] {
                let axis = Axis::of([value, other].into_iter());
                let ticks = axis.ticks();
                assert!((2..=10).contains(&ticks.len()), "{axis:?}");
                assert_eq!(not_round(&axis, &ticks), Vec::<f64>::new(), "{axis:?}");
                assert!((0.0..=1.0).contains(&axis.part(value)), "{axis:?}");
                let (low, high) = (ticks[0].0.min(0.0), ticks[ticks.len() - 1].0);
                let holds = low <= value * 1.000_001 && value <= high * 1.000_001;
                assert!(axis.is_log() || holds, "{axis:?}: {value}");
            }
            value *= 1.37;
        }
        // The checker must notice ticks that are not round.
        let axis = Axis::of([1.0, 1.3].into_iter());
        let bad = [1.0, 1.06, 1.12].map(|x| (x, String::new()));
        assert_eq!(not_round(&axis, &bad).len(), 2);
        assert_eq!(not_round(&Axis::Log { from: 0, to: 2, zero: false }, &[(30.0, String::new())]), [30.0]);
    }
}
