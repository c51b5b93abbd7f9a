//! The growth of fixed tiles, which are fitted once and serve queries of several margins.
//!
//! A larger growth is right for every smaller one, at the cost of more candidates. Fixed tiles are
//! fitted again as soon as a query needs a larger one. They are also fitted again when the growth
//! has exceeded the need for `PATIENCE` queries: twice the margin, or a thickness that none needed.

use nearmiss_kernels::abi::Growth;

/// Number of queries in a row after which a growth that is too large shrinks. It affects no answer.
const PATIENCE: u32 = 16;

/// The growth that fixed tiles were fitted with, and the largest need since then.
#[derive(Clone, Copy, Debug, Default)]
pub struct FixedGrowth {
    /// `None` before the first fit.
    fitted: Option<Growth>,
    /// Largest need of the recent queries.
    most: Growth,
    /// Number of those queries.
    fits: u32,
}

impl FixedGrowth {
    /// Takes the growth that a query needs. Returns whether fixed tiles must be fitted now, with
    /// [`FixedGrowth::fitted`]. The growth does not shrink in a submission, which may be recorded
    /// and never run. It need not grow there, as each query has run before.
    pub fn take(&mut self, growth: Growth, may_shrink: bool) -> bool {
        (self.most, self.fits) = (self.most.or(growth), self.fits + 1);
        let fitted = match self.fitted {
            Some(fitted) if fitted.serves(growth) => {
                if self.fits < PATIENCE || !may_shrink {
                    return false;
                }
                let most = self.most;
                (self.most, self.fits) = (Growth::default(), 0);
                if 2.0 * most.margin >= fitted.margin && most.is_thick == fitted.is_thick {
                    return false;
                }
                most
            }
            // A thickness and a larger margin alternate without fits.
            Some(fitted) => fitted.or(growth),
            None => growth,
        };
        (self.fitted, self.most, self.fits) = (Some(fitted), Growth::default(), 0);
        true
    }

    /// Returns the growth of the last fit; none before the first.
    pub fn fitted(&self) -> Growth {
        self.fitted.unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn take(held: &mut FixedGrowth, margin: f32) -> bool {
        held.take(Growth::margin(margin), true)
    }

    #[test]
    fn it_never_holds_less_than_a_query_needs_and_shrinks_after_a_while() {
        let mut held = FixedGrowth::default();
        assert!(take(&mut held, 0.0) && held.fitted() == Growth::margin(0.0));
        assert!(take(&mut held, 1.0) && held.fitted() == Growth::margin(1.0));
        // Two alternating queries cause no fit.
        for _ in 0..5 * PATIENCE {
            assert!(!take(&mut held, 0.1) && !take(&mut held, 1.0));
        }
        let submitted = (0..2 * PATIENCE).filter(|_| held.take(Growth::margin(0.1), false)).count();
        assert_eq!(submitted, 0, "in submissions");
        let fits = (0..2 * PATIENCE).filter(|_| take(&mut held, 0.1)).count();
        assert!(fits == 1 && held.fitted() == Growth::margin(0.1), "{held:?}");
    }

    /// A forgotten need would lose pairs; this test notices it.
    #[test]
    fn the_largest_of_the_last_needs_counts() {
        let mut held = FixedGrowth::default();
        take(&mut held, 8.0);
        for k in 0..10 * PATIENCE {
            let need = if k % 7 == 0 { 2.0 } else { 0.5 };
            take(&mut held, need);
            assert!(held.fitted().margin >= need);
        }
        assert_eq!(held.fitted(), Growth::margin(2.0));
    }

    /// Volumes without a thickness never serve a query with one, and those with one go after a while.
    #[test]
    fn a_thickness_is_a_need() {
        let (mut held, thick) = (FixedGrowth::default(), Growth { margin: 0.5, is_thick: 1 });
        assert!(take(&mut held, 1.0) && held.take(thick, true) && held.fitted().serves(thick));
        assert!(!take(&mut held, 1.0), "both are served");
        let fits = (0..2 * PATIENCE).filter(|_| take(&mut held, 0.5)).count();
        assert!(fits == 1 && held.fitted() == Growth::margin(1.0), "{held:?}");
    }
}
