//! The margin of static tiles, which are fitted once and serve queries of several margins.
//!
//! A larger one is right for every smaller one, at the cost of more candidates. So static tiles are fitted again as soon as a query needs
//! more, and when they have held more than twice the need for some time.

/// Fits in a row after which a margin that is too large shrinks. It is in no answer.
const PATIENCE: u32 = 16;

/// The margin that static tiles were fitted with, and the need since then.
#[derive(Clone, Copy, Debug, Default)]
pub struct StaticMargin {
    /// `None` before the first fit.
    fitted: Option<f32>,
    /// Largest need of the last fits.
    most: f32,
    /// Number of those.
    fits: u32,
}

impl StaticMargin {
    /// A query needs this margin: whether static tiles must be fitted now, with [`StaticMargin::fitted`]. It does not shrink in a
    /// submission, which may be recorded and never run; and it need not grow there, as each query has run before.
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

    /// The margin of the last fit; 0 before there was one.
    pub fn fitted(&self) -> f32 {
        self.fitted.unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_never_holds_less_than_a_query_needs_and_shrinks_after_a_while() {
        let mut margin = StaticMargin::default();
        assert!(margin.take(0.0, true) && margin.fitted() == 0.0);
        assert!(margin.take(1.0, true) && margin.fitted() == 1.0);
        // Two queries by turns fit nothing.
        for _ in 0..5 * PATIENCE {
            assert!(!margin.take(0.1, true) && !margin.take(1.0, true));
        }
        assert_eq!((0..2 * PATIENCE).filter(|_| margin.take(0.1, false)).count(), 0, "in submissions");
        let fits = (0..2 * PATIENCE).filter(|_| margin.take(0.1, true)).count();
        assert!(fits == 1 && margin.fitted() == 0.1, "{margin:?}");
    }

    /// A need that was forgotten would lose pairs, and is seen here.
    #[test]
    fn the_largest_of_the_last_needs_counts() {
        let mut margin = StaticMargin::default();
        margin.take(8.0, true);
        for k in 0..10 * PATIENCE {
            let need = if k % 7 == 0 { 2.0 } else { 0.5 };
            margin.take(need, true);
            assert!(margin.fitted() >= need);
        }
        assert_eq!(margin.fitted(), 2.0);
    }
}
