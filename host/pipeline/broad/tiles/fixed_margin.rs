//! The margin of fixed tiles, which are fitted once and serve queries of several margins.
//!
//! A larger margin is right for every smaller one, at the cost of more candidates. Fixed tiles are
//! fitted again as soon as a query needs a larger margin. They are also fitted again when the
//! margin has exceeded twice the need for `PATIENCE` queries.

/// Number of queries in a row after which a margin that is too large shrinks. It affects no answer.
const PATIENCE: u32 = 16;

/// The margin that fixed tiles were fitted with, and the largest need since then.
#[derive(Clone, Copy, Debug, Default)]
pub struct FixedMargin {
    /// `None` before the first fit.
    fitted: Option<f32>,
    /// Largest need of the recent queries.
    most: f32,
    /// Number of those queries.
    fits: u32,
}

impl FixedMargin {
    /// Takes the margin that a query needs. Returns whether fixed tiles must be fitted now, with
    /// [`FixedMargin::fitted`]. The margin does not shrink in a submission, which may be recorded
    /// and never run. It need not grow there, as each query has run before.
    pub fn take(&mut self, margin: f32, may_shrink: bool) -> bool {
        (self.most, self.fits) = (self.most.max(margin), self.fits + 1);
        let fitted = match self.fitted {
            Some(fitted) if margin <= fitted => {
                if self.fits < PATIENCE || !may_shrink {
                    return false;
                }
                let most = self.most;
                (self.most, self.fits) = (0.0, 0);
                if 2.0 * most >= fitted {
                    return false;
                }
                most
            }
            _ => margin,
        };
        (self.fitted, self.most, self.fits) = (Some(fitted), 0.0, 0);
        true
    }

    /// Returns the margin of the last fit; 0 before the first.
    pub fn fitted(&self) -> f32 {
        self.fitted.unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_never_holds_less_than_a_query_needs_and_shrinks_after_a_while() {
        let mut margin = FixedMargin::default();
        assert!(margin.take(0.0, true) && margin.fitted() == 0.0);
        assert!(margin.take(1.0, true) && margin.fitted() == 1.0);
        // Two alternating queries cause no fit.
        for _ in 0..5 * PATIENCE {
            assert!(!margin.take(0.1, true) && !margin.take(1.0, true));
        }
        assert_eq!((0..2 * PATIENCE).filter(|_| margin.take(0.1, false)).count(), 0, "in submissions");
        let fits = (0..2 * PATIENCE).filter(|_| margin.take(0.1, true)).count();
        assert!(fits == 1 && margin.fitted() == 0.1, "{margin:?}");
    }

    /// A forgotten need would lose pairs; this test notices it.
    #[test]
    fn the_largest_of_the_last_needs_counts() {
        let mut margin = FixedMargin::default();
        margin.take(8.0, true);
        for k in 0..10 * PATIENCE {
            let need = if k % 7 == 0 { 2.0 } else { 0.5 };
            margin.take(need, true);
            assert!(margin.fitted() >= need);
        }
        assert_eq!(margin.fitted(), 2.0);
    }
}
