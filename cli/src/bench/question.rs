//! What is asked of a case.

use clap::ValueEnum;
use nearmiss::mesh::Body;
use nearmiss::pipeline::of_edges;
use nearmiss::query::{Certified, Continuous, Query};

/// Questions, each with all choices at their defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Question {
    /// Triangle pairs that share a point at t = 0.
    Discrete,
    /// Feature pairs that meet during the step, certified.
    Continuous,
    /// The same, with those that come within a hundredth of the mean edge.
    Separation,
    /// The first time of contact.
    Earliest,
    /// Feature pairs within a tenth of the mean edge at t = 0.
    Near,
    /// The two nearest triangles of different bodies at t = 0.
    Distance,
}

impl Question {
    /// Its name, on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Question::Discrete => "discrete",
            Question::Continuous => "continuous",
            Question::Separation => "separation",
            Question::Earliest => "earliest",
            Question::Near => "near",
            Question::Distance => "distance",
        }
    }

    /// Whether such bodies can be asked it: of what stands still there is no step, of one body no distance, and of points no
    /// part of an edge.
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

    /// The query, of bodies with such edges.
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
