//! Decides when the order of triangles is stale. It counts tests, so that every machine decides
//! alike.

/// Cost of a rebuild per triangle, in tests of two volumes. It was measured with tiles on
/// cloth-ball: the time of a construction, divided by that of a test in a frame. That is 80 on an
/// H200, and 30 to 60 on a CPU. It affects no answer.
const OF_A_TRIANGLE: u64 = 64;

/// Excess tests since the last rebuild, and whether a body got its first position since.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wear {
    first: Option<u64>,
    beyond: u64,
    /// Whether a frame has placed a body for the first time since the last rebuild.
    has_new_place: bool,
}

impl Wear {
    /// Adds the tests of a frame.
    pub fn add(&mut self, tests: u64) {
        match self.first {
            None => self.first = Some(tests),
            Some(first) => self.beyond = self.beyond.saturating_add(tests.saturating_sub(first)),
        }
    }

    /// Notes that a frame places a body for the first time, such as a rigid one that was added
    /// without its pose.
    pub fn add_new_place(&mut self) {
        self.has_new_place = true;
    }

    /// Forgets the reference: the query has other numbers, so its next frame is the first to
    /// compare with.
    pub fn forget_first(&mut self) {
        self.first = None;
    }

    /// Returns whether the next frame rebuilds: after a new place, or when the excess tests have
    /// cost as much as a rebuild. The total cost is then at most twice that of an optimal schedule
    /// (Karlin, Manasse, Rudolph and Sleator, "Competitive snoopy caching", 1988).
    pub fn is_worn(&self, triangles: usize) -> bool {
        self.has_new_place || self.beyond > OF_A_TRIANGLE * triangles as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_the_first_frame_is_summed() {
        let mut wear = Wear::default();
        // The first frame counts nothing, nor do frames with fewer tests.
        for tests in [9_000, 8_000, 9_000] {
            wear.add(tests);
            assert!(!wear.is_worn(10));
        }
        wear.add(9_000 + 64 * 5);
        wear.add(9_000 + 64 * 5);
        assert!(!wear.is_worn(10), "as much as building");
        wear.add(9_001);
        assert!(wear.is_worn(10));
    }
}
