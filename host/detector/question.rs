//! The question of a detector: a query, and the tolerances of its pairs.

use crate::pipeline::Tolerances;
use crate::query::Query;
use crate::scene::{Body, Scene};

/// A query, with the tolerances of a certified solver for the bodies of a scene.
pub struct Question {
    pub query: Query,
    /// `None` without a certified solver.
    pub tolerances: Option<Tolerances>,
}

impl Question {
    /// A query of these bodies.
    pub fn new(query: Query, scene: &mut Scene) -> Question {
        let mut question = Question { query, tolerances: None };
        question.choose_tolerances(scene);
        question
    }

    /// The tolerances of the bodies that there are now.
    pub fn choose_tolerances(&mut self, scene: &mut Scene) {
        self.tolerances = self.query.certified().copied().map(|certified| match certified.tolerance {
            Some(tolerance) => Tolerances::named(tolerance),
            None => {
                scene.bodies_mut().iter_mut().for_each(Body::keep_tolerance);
                Tolerances::of(scene.bodies())
            }
        });
    }

    /// The query, with the largest tolerance of its pairs: volumes grow by it.
    pub fn with_largest_tolerance(&self) -> Query {
        let mut query = self.query;
        if let (Some(certified), Some(tolerances)) = (query.certified_mut(), &self.tolerances) {
            certified.tolerance = Some(tolerances.largest);
        }
        query
    }
}
