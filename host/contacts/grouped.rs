//! Rows of an answer by the features of a body.

use std::ops::Range;

/// Features of a body by which rows are grouped: see [`Detector::grouped`](crate::Detector::grouped).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroupBy {
    /// The vertex of a vertex/face or edge/vertex row, both of two points.
    Vertex,
    /// Both edges of an edge/edge row, the edge of an edge/vertex row.
    Edge,
    /// The face of a vertex/face row, or both triangles of a row of two, which may be other
    /// [elements](crate::Body::elements).
    Face,
    /// All vertices of a row's features: four of a row of features, six of a row of two triangles.
    Corner,
}

impl GroupBy {
    /// Every choice.
    pub const ALL: [GroupBy; 4] = [GroupBy::Vertex, GroupBy::Edge, GroupBy::Face, GroupBy::Corner];

    /// Returns its name, as other languages have it.
    pub const fn name(self) -> &'static str {
        match self {
            GroupBy::Vertex => "vertex",
            GroupBy::Edge => "edge",
            GroupBy::Face => "face",
            GroupBy::Corner => "corner",
        }
    }
}

/// Rows by feature, in compressed form: the rows of feature `i` are
/// `rows[starts[i]..starts[i + 1]]`, ascending.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Grouped {
    /// One more than there are features.
    pub starts: Vec<u32>,
    /// Numbers of rows in the answer.
    pub rows: Vec<u32>,
}

impl Grouped {
    /// Groups rows 0, 1, … of which `of` gives the features, each below `features` and once a row.
    ///
    /// Linear in rows and features. Two passes: counts, then places.
    pub(crate) fn new<I: IntoIterator<Item = u32>>(
        features: usize,
        rows: Range<u32>,
        of: impl Fn(u32) -> I,
    ) -> Grouped {
        let mut starts = vec![0; features + 1];
        for row in rows.clone() {
            of(row).into_iter().for_each(|feature| starts[feature as usize + 1] += 1);
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let (mut next, mut all) = (starts.clone(), vec![0; sum as usize]);
        for row in rows {
            for feature in of(row) {
                let place = &mut next[feature as usize];
                all[*place as usize] = row;
                *place += 1;
            }
        }
        Grouped { starts, rows: all }
    }

    /// Number of features.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether the body has no such features.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Rows of a feature, ascending.
    ///
    /// # Panics
    /// If the body has no such feature.
    pub fn of(&self, feature: usize) -> &[u32] {
        &self.rows[self.starts[feature] as usize..self.starts[feature + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_ascend_within_a_feature() {
        let of = |row: u32| [[2, 0], [0, 1], [2, 1]][row as usize];
        let grouped = Grouped::new(4, 0..3, of);
        assert_eq!((grouped.starts.as_slice(), grouped.len()), ([0, 2, 4, 6, 6].as_slice(), 4));
        assert_eq!(
            [0, 1, 2, 3].map(|i| grouped.of(i).to_vec()),
            [vec![0, 1], vec![1, 2], vec![0, 2], vec![]]
        );
        assert!(Grouped::new(0, 0..0, |_| []).is_empty());
    }
}
