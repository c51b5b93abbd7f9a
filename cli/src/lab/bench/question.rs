//! The queries of a case.

use crate::args::Question;
use nearmiss::mesh::Body;
use nearmiss::query::{Continuous, Query};
use nearmiss::research::Certified;
use nearmiss::research::WithSolver;
use nearmiss::research::pipeline::of_edges;

impl Question {
    /// Whether it fits the bodies. Bodies at rest have no step, one body has no distance, and points
    /// have no edge.
    pub fn is_for(self, bodies: &[Body]) -> bool {
        match self {
            Question::Discrete => true,
            Question::Near => of_edges(bodies) > 0.0,
            Question::Continuous | Question::Separation | Question::Earliest => {
                let moves = |body: &Body| {
                    let [from, to] = body.poses();
                    body.is_moving() || from != to
                };
                bodies.iter().any(moves)
            }
            Question::Distance => bodies.len() > 1,
        }
    }

    /// The query; its lengths depend on the mean edge of the bodies.
    pub fn query(self, bodies: &[Body]) -> Query {
        let edge = || of_edges(bodies) / Certified::TOLERANCE;
        match self {
            Question::Discrete => Query::discrete(),
            Question::Continuous => Query::continuous(),
            Question::Separation => {
                Continuous::by(Certified { min_separation: 0.01 * edge(), ..Certified::default() }).into()
            }
            Question::Earliest => Query::earliest(),
            Question::Near => Query::near(0.1 * edge()),
            Question::Distance => Query::distance(),
        }
    }
}
