//! Queries of bodies with a thickness.

use super::Detector;
use crate::error::Error;
use crate::query::{CertifiedPrecision, Query};
use crate::scene::{BodyId, BodyKind, Scene};
use std::sync::Arc;

/// Thickness of a scene's bodies.
#[derive(Clone, Default)]
pub struct Thick {
    /// The largest radius of each body; empty if none has a thickness.
    radii: Arc<Vec<f64>>,
    /// Two bodies without a thickness, or one twice, that a query may test against each other.
    thin: Option<[usize; 2]>,
    /// A body whose radii differ.
    uneven: Option<usize>,
}

impl Thick {
    /// Cost: linear in vertices with their own radius, and the square of bodies without a thickness,
    /// if filters keep all of them apart.
    fn of(scene: &Scene) -> Thick {
        let bodies = scene.bodies();
        let radii: Vec<f64> = bodies.iter().map(|body| body.thickness().largest()).collect();
        if radii.iter().all(|&radius| radius == 0.0) {
            return Thick::default();
        }
        let is_thin = |&i: &usize| radii[i] == 0.0 && bodies[i].element_count() > 0;
        let thin: Vec<usize> = (0..bodies.len()).filter(is_thin).collect();
        let moves = |i: usize| bodies[i].kind() != BodyKind::Fixed;
        let meet = |i: usize, j: usize| {
            let (a, b) = (bodies[i].filter(), bodies[j].filter());
            let is_listed = || scene.left_out().binary_search(&[i, j].map(|k| BodyId(k as u32))).is_ok();
            if i == j {
                bodies[i].self_collides()
            } else {
                (moves(i) || moves(j)) && a.allows(b) && !is_listed()
            }
        };
        let pairs = thin.iter().enumerate().flat_map(|(at, &i)| thin[at..].iter().map(move |&j| [i, j]));
        let uneven = bodies.iter().position(|body| body.thickness().same().is_none());
        Thick { thin: { pairs }.find(|&[i, j]| meet(i, j)), uneven, radii: Arc::new(radii) }
    }
}

impl Detector {
    /// Whether a body has a thickness. Cost: once as of [`Thick::of`].
    pub(super) fn is_thick(&mut self) -> bool {
        let scene = &self.scene;
        !self.thick.get_or_insert_with(|| Thick::of(scene)).radii.is_empty()
    }

    /// Returns a query with what the thickness of bodies needs, and the radius of each body for a
    /// certified solver. In motion a thickness is a separation: a query without one gets the
    /// smallest there is, which no sum with a radius has.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a distance of 0 without a thickness, and for queries in motion
    /// that have no answer with one.
    pub(super) fn thickened(&mut self, mut query: Query) -> Result<(Query, Arc<Vec<f64>>), Error> {
        let scene = &self.scene;
        let thick = self.thick.get_or_insert_with(|| Thick::of(scene)).clone();
        let bodies = scene.bodies();
        let is_thick = !thick.radii.is_empty();
        if let Query::Near(near) = &query
            && near.distance == 0.0
            && !is_thick
        {
            return Err(Error::InvalidArgument {
                what: "distance must be above 0, got 0, as no body has a thickness".into(),
                advice: "give a length in the unit of the scene, or bodies a thickness".into(),
            });
        }
        if !is_thick || query.kind().is_at_rest() {
            return Ok((query, Arc::default()));
        }
        let refused =
            |what: String, advice: &str| Err(Error::InvalidArgument { what, advice: advice.into() });
        let solver = query.solver();
        let Some(certified) = query.certified_mut().filter(|of| of.precision != CertifiedPrecision::F32)
        else {
            return refused(
                format!("solver {solver} cannot be used with a thickness"),
                "use the solver certified, or give bodies no thickness",
            );
        };
        if let Some(body) = thick.uneven
            && let Some(turning) = bodies.iter().find(|body| body.may_turn())
        {
            return refused(
                format!(
                    "thickness of {} differs between vertices, and {} may turn in the step",
                    bodies[body].name(),
                    turning.name()
                ),
                "give each body one radius, or rigid bodies straight steps",
            );
        }
        if certified.min_separation == 0.0 {
            if let Some([a, b]) = thick.thin {
                return refused(
                    format!(
                        "{} and {} have no thickness, and other bodies have",
                        bodies[a].name(),
                        bodies[b].name()
                    ),
                    "give one of them a thickness, or the query a minimum separation above 0",
                );
            }
            certified.min_separation = f64::MIN_POSITIVE;
        }
        Ok((query, thick.radii))
    }
}
