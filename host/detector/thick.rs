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
    /// A body whose radii differ.
    uneven: Option<usize>,
}

impl Thick {
    /// Cost: linear in vertices with their own radius.
    fn of(scene: &Scene) -> Thick {
        let bodies = scene.bodies();
        let radii: Vec<f64> = bodies.iter().map(|body| body.thickness().largest()).collect();
        if radii.iter().all(|&radius| radius == 0.0) {
            return Thick::default();
        }
        let uneven = bodies.iter().position(|body| body.thickness().same().is_none());
        Thick { uneven, radii: Arc::new(radii) }
    }
}

/// Returns whether queries may test two features without a thickness, in a scene in which others have
/// one. Cost: linear in vertices with their own radius, and the square of bodies with a vertex without,
/// if filters keep all of them apart.
pub fn meets_thin(scene: &Scene) -> bool {
    let bodies = scene.bodies();
    if bodies.iter().all(|body| body.thickness().largest() == 0.0) {
        return false;
    }
    let is_thin = |&i: &usize| bodies[i].element_count() > 0 && bodies[i].thickness().is_thin();
    let thin: Vec<usize> = (0..bodies.len()).filter(is_thin).collect();
    let moves = |i: usize| bodies[i].kind() != BodyKind::Fixed;
    let meet = |i: usize, j: usize| {
        let (a, b) = (bodies[i].filter(), bodies[j].filter());
        let is_listed = || scene.left_out().binary_search(&[i, j].map(|k| BodyId(k as u32))).is_ok();
        if i == j { bodies[i].self_collides() } else { (moves(i) || moves(j)) && a.allows(b) && !is_listed() }
    };
    thin.iter().enumerate().any(|(at, &i)| thin[at..].iter().any(|&j| meet(i, j)))
}

impl Detector {
    /// Thickness of the current bodies. Cost: once as of [`Thick::of`].
    fn thick(&mut self) -> &Thick {
        let scene = &self.scene;
        self.thick.get_or_insert_with(|| Thick::of(scene))
    }

    /// Whether a body has a thickness. Cost: once as of [`Thick::of`].
    pub(super) fn is_thick(&mut self) -> bool {
        !self.thick().radii.is_empty()
    }

    /// Returns the radius of each body for a certified solver; none without a thickness.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a distance of 0 without a thickness, and for queries in motion
    /// that have no answer with one.
    pub(super) fn radii_for(&mut self, query: &Query) -> Result<Arc<Vec<f64>>, Error> {
        let thick = self.thick().clone();
        let is_thick = !thick.radii.is_empty();
        if let Query::Near(near) = query
            && near.distance == 0.0
            && !is_thick
        {
            return Err(Error::InvalidArgument {
                what: "distance must be above 0, got 0, as no body has a thickness".into(),
                advice: "give a length in the unit of the scene, or bodies a thickness".into(),
            });
        }
        if !is_thick || query.kind().is_at_rest() {
            return Ok(Arc::default());
        }
        let bodies = self.scene.bodies();
        let refused =
            |what: String, advice: &str| Err(Error::InvalidArgument { what, advice: advice.into() });
        let solver = query.solver();
        if query.certified().is_none_or(|certified| certified.precision == CertifiedPrecision::F32) {
            return refused(
                format!("solver {solver} cannot be used with a thickness"),
                "use the solver certified, or give bodies no thickness",
            );
        }
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
        Ok(thick.radii)
    }
}
