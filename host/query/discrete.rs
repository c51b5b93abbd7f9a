//! Triangles at t = 0.

use super::{ListedRows, Question, Search, Solver};
use crate::contacts::TrianglePair;

/// Triangle pairs that share a point at t = 0, by exact signs: none is missed, none is invented.
///
/// ```
/// use nearmiss::Discrete;
///
/// // Triangles that share a vertex too, if they meet beyond it.
/// let query = Discrete::default().with_adjacent(true);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Discrete {
    /// The test of a pair.
    pub(crate) test: TriangleTest,
    /// How candidates are found.
    pub(crate) search: Search,
}

/// The test of a pair of triangles that stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TriangleTest {
    /// Exact signs by filter, then integers. Never wrong.
    Exact {
        /// Also triangles that share a vertex, where they meet beyond it.
        adjacent: bool,
    },
    /// The seed's float test. Can miss, can err.
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

    /// Its name.
    pub const fn name(&self) -> Solver {
        match self {
            TriangleTest::Exact { .. } => Solver::Exact,
            TriangleTest::Moller => Solver::Moller,
        }
    }

    /// Whether it answers for triangles that share a vertex.
    pub(crate) const fn has_adjacent(&self) -> bool {
        match self {
            TriangleTest::Exact { adjacent } => *adjacent,
            TriangleTest::Moller => false,
        }
    }
}

impl Discrete {
    /// By that test, all other choices at their defaults.
    pub(crate) fn by(test: TriangleTest) -> Discrete {
        Discrete { test, ..Discrete::default() }
    }

    /// The same, with triangles that share a vertex, if they meet beyond it; or without. By exact
    /// signs.
    #[must_use]
    pub const fn with_adjacent(self, adjacent: bool) -> Discrete {
        Discrete { test: TriangleTest::Exact { adjacent }, ..self }
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
    fn rows(&self) -> Option<ListedRows> {
        let advice = "use a smaller scene, or test bodies against each other only";
        Some(ListedRows { bytes: size_of::<TrianglePair>(), within: None, advice })
    }
}
