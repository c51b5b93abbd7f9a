//! Initial capacities of a continuous query.

/// Initial capacities of the lists of a continuous query: vertex/face, edge/edge.
pub struct Capacities {
    /// Pairs that may meet.
    pub survivors: [usize; 2],
    /// Contacts.
    pub hits: [usize; 2],
    /// Pairs that a rung leaves to the next.
    pub left: [usize; 2],
    /// Pairs that may be near at the start, in a query of what approaches.
    pub near: [usize; 2],
    /// Pairs that a long list leaves to be settled.
    pub asked: [usize; 2],
}

impl Capacities {
    /// Those of a query with so many pairs.
    pub fn usual(few: usize) -> Capacities {
        let (left, near) = ([few / 4, few / 4], [few / 64, few / 64]);
        Capacities { survivors: [few, 2 * few], hits: [few, few], left, near, asked: [0, 0] }
    }
}
