//! When the order of triangles is stale: decided by counted tests, so that every machine decides alike.

/// What building anew costs a triangle, in tests of two volumes: measured with tiles, cloth-ball, as the time of a construction over that of
/// a test in a frame, 80 on an H200 and 30 to 60 on a CPU. It is in no answer.
const OF_A_TRIANGLE: u64 = 64;

/// Tests beyond those of the first frame after building, and bodies that got a place since.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wear {
    first: Option<u64>,
    beyond: u64,
    /// Whether a frame has placed a body for the first time since then.
    has_new_place: bool,
}

impl Wear {
    /// A frame took so many tests.
    pub fn add(&mut self, tests: u64) {
        match self.first {
            None => self.first = Some(tests),
            Some(first) => self.beyond = self.beyond.saturating_add(tests.saturating_sub(first)),
        }
    }

    /// A frame places a body for the first time, as a rigid one that was added without its pose.
    pub fn add_new_place(&mut self) {
        self.has_new_place = true;
    }

    /// The query has other numbers: its next frame is the first to compare with.
    pub fn forget_first(&mut self) {
        self.first = None;
    }

    /// Whether the next frame builds again: there is a new place, or tests beyond have cost as much as building anew: then at most twice as much is spent as by who knows what comes (Karlin,
    /// Manasse, Rudolph and Sleator, "Competitive snoopy caching", 1988).
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
        // However much the first one takes, and those that take less.
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
