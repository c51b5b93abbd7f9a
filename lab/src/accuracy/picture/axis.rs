//! Axes: logarithmic where numbers span decades, with a place for zero below the smallest.

/// From numbers to pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// Powers of ten `from..=to`; zero at `from - 1`, if there is a zero.
    Log {
        /// The lowest.
        from: i32,
        /// The highest.
        to: i32,
        /// Whether there is a place for zero.
        zero: bool,
    },
    /// Even steps.
    Even {
        /// The least.
        low: f64,
        /// The most.
        high: f64,
    },
}

impl Axis {
    /// An axis that holds those numbers. Logarithmic, unless one is negative or all are within a decade and none is zero.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Axis {
        let finite = values.filter(|x| x.is_finite());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        finite.clone().for_each(|x| (low, high) = (low.min(x), high.max(x)));
        if low > high {
            return Axis::Even { low: 0.0, high: 1.0 };
        }
        let whole = high <= 20.0 && high == high.trunc() && low == low.trunc() && high - low > 1.0;
        if low < 0.0 || whole || (low > 0.0 && high < 10.0 * low) {
            return Axis::Even { low, high };
        }
        let least = finite.filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
        if least.is_infinite() {
            return Axis::Even { low: 0.0, high: 1.0 };
        }
        let from = least.log10().floor() as i32;
        Axis::Log { from, to: (high.log10().ceil() as i32).max(from + 1), zero: low == 0.0 }
    }

    /// Where a number is, from 0 to 1.
    pub fn part(&self, x: f64) -> f64 {
        match *self {
            Axis::Log { from, to, zero } => {
                let low = f64::from(from) - if zero { 0.5 } else { 0.0 };
                let at = if x > 0.0 { x.log10() } else { low };
                ((at - low) / (f64::from(to) - low)).clamp(0.0, 1.0)
            }
            Axis::Even { low, high } if high > low => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Axis::Even { .. } => 0.5,
        }
    }

    /// Where to draw lines, with what beside them: at most nine.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        match *self {
            Axis::Log { from, to, zero } => {
                let every = ((to - from) / 8 + 1) as usize;
                let decade = |e: i32| {
                    (
                        10f64.powi(e),
                        if (-2..=4).contains(&e) { format!("{}", 10f64.powi(e)) } else { format!("1e{e}") },
                    )
                };
                let zero = zero.then(|| (0.0, "0".to_owned()));
                zero.into_iter().chain((from..=to).step_by(every).map(decade)).collect()
            }
            Axis::Even { low, high } => {
                let tick = |i: i32| low + f64::from(i) / 4.0 * (high - low);
                let digits = if high - low >= 8.0 || (high - low) % 4.0 == 0.0 { 0 } else { 2 };
                (0..=4).map(|i| (tick(i), format!("{:.digits$}", tick(i)))).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_holds_its_numbers() {
        let log = Axis::of([0.0, 0.02, 500.0].into_iter());
        assert_eq!(log, Axis::Log { from: -2, to: 3, zero: true });
        assert_eq!((log.part(0.0), log.part(1000.0)), (0.0, 1.0));
        assert!(log.part(0.01) > 0.05);
        assert_eq!(Axis::of([-100.0, 100.0].into_iter()).part(0.0), 0.5);
        assert_eq!(Axis::of([1.0, 1.3].into_iter()), Axis::Even { low: 1.0, high: 1.3 });
        assert_eq!(Axis::of([0.0, 12.0].into_iter()), Axis::Even { low: 0.0, high: 12.0 });
        assert_eq!(Axis::of([0.0, 0.0].into_iter()), Axis::Even { low: 0.0, high: 1.0 });
        assert_eq!(Axis::of(std::iter::empty()), Axis::Even { low: 0.0, high: 1.0 });
        for axis in [log, Axis::Log { from: -9, to: 9, zero: true }, Axis::Even { low: 0.0, high: 3.0 }] {
            assert!((2..=10).contains(&axis.ticks().len()), "{axis:?}");
        }
    }
}
