//! Triangles at t = 0.

use super::{ListedRows, Question, Search, Solver};
use crate::contacts::TrianglePair;
use crate::error::Error;

/// Triangle pairs that share a point at t = 0, by exact signs.
///
/// No pair is missed, and every pair of the answer shares a point.
///
/// ```
/// use nearmiss::Discrete;
///
/// // Also triangles that share a vertex, if they meet outside it.
/// let query = Discrete::default().with_adjacent(true);
/// // Only triangles that cross: a wall that stands on a floor is left out.
/// let query = Discrete::default().with_only_crossing(true);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Discrete {
    /// Test of a pair.
    pub(crate) test: TriangleTest,
    /// Whether pairs that touch without crossing are left out.
    pub(crate) only_crossing: bool,
    /// How candidates are found.
    pub(crate) search: Search,
}

/// Test of a pair of triangles at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TriangleTest {
    /// Exact signs, by a float filter and then by integers. Never wrong.
    Exact {
        /// Also triangles that share a vertex, if they meet outside it.
        adjacent: bool,
    },
    /// The paper's float test. Can miss contacts, and can report false ones.
    Moller,
}

impl Default for TriangleTest {
    fn default() -> Self {
        TriangleTest::Exact { adjacent: false }
    }
}

impl TriangleTest {
    /// Every test, the default first.
    pub const ALL: [TriangleTest; 2] = [TriangleTest::Exact { adjacent: false }, TriangleTest::Moller];

    /// Returns its name.
    pub const fn name(&self) -> Solver {
        match self {
            TriangleTest::Exact { .. } => Solver::Exact,
            TriangleTest::Moller => Solver::Moller,
        }
    }

    /// Returns whether triangles that share a vertex are tested.
    pub(crate) const fn has_adjacent(&self) -> bool {
        match self {
            TriangleTest::Exact { adjacent } => *adjacent,
            TriangleTest::Moller => false,
        }
    }
}

impl Discrete {
    /// Returns a query by a test, with all other choices at their defaults.
    pub(crate) fn by(test: TriangleTest) -> Discrete {
        Discrete { test, ..Discrete::default() }
    }

    /// Sets whether triangles that share a vertex are tested; they are reported if they meet
    /// outside it. The test is by exact signs.
    #[must_use]
    pub const fn with_adjacent(self, adjacent: bool) -> Discrete {
        Discrete { test: TriangleTest::Exact { adjacent }, ..self }
    }

    /// Sets whether only triangles that cross are reported, see
    /// [`PairKind::Crossing`](crate::contacts::PairKind::Crossing). Triangles that touch in a point or
    /// in an edge and triangles in one plane are left out. It holds on the device too; the cost is
    /// some exact signs for each pair that touches. Only the exact test has it.
    #[must_use]
    pub const fn with_only_crossing(self, only_crossing: bool) -> Discrete {
        Discrete { only_crossing, ..self }
    }

    /// Returns whether only triangles that cross are reported.
    pub const fn is_only_crossing(&self) -> bool {
        self.only_crossing
    }
}

impl Question for Discrete {
    fn is_at_rest() -> bool {
        true
    }
    fn is_of_features() -> bool {
        false
    }
    fn every() -> Vec<Discrete> {
        TriangleTest::ALL.map(Discrete::by).into()
    }
    fn search(&self) -> &Search {
        &self.search
    }
    fn search_mut(&mut self) -> &mut Search {
        &mut self.search
    }
    fn solver(&self) -> Solver {
        self.test.name()
    }
    fn keeps_adjacent(&self) -> bool {
        self.test.has_adjacent()
    }
    fn check(&self) -> Result<(), Error> {
        if self.only_crossing && self.test == TriangleTest::Moller {
            return Err(Error::InvalidArgument {
                what: "a query for crossing triangles alone cannot use the solver moller".into(),
                advice: "use the solver exact, or leave out the choice of crossing triangles".into(),
            });
        }
        Ok(())
    }
    fn rows(&self) -> Option<ListedRows> {
        let advice = "use a smaller scene, or test bodies against each other only";
        Some(ListedRows { bytes: size_of::<TrianglePair>(), within: None, advice })
    }
}
