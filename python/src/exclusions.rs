//! Exclusions of bodies, as Python names them.

use crate::asked::Does;
use crate::detector::Detector;
use crate::errors::{choice, integer, raised};
use crate::host::{Most, indices, positions, rows};
use crate::key::{self, Key};
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Exclusions, RestShape, Scene};
use pyo3::prelude::*;

/// Exclusions of a body as given: without a rest shape it is the body's place.
pub struct Given {
    ring: Option<u32>,
    within: Option<f64>,
    rest: Option<Positions>,
    faces: Vec<u32>,
}

impl Given {
    pub fn of(
        ring: Option<&Bound<'_, PyAny>>,
        within: Option<f64>,
        rest: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Given> {
        if rest.is_some() && within.is_none() {
            return Err(choice("rest without within", "give the distance at rest, or leave rest out"));
        }
        let faces = faces.map(|faces| indices::<1>(faces, "faces")).transpose()?.unwrap_or_default();
        Ok(Given {
            // 0 is refused with the others' faults.
            ring: ring.map(|ring| integer(ring, "ring", [0, u32::MAX.into()])).transpose()?.map(|n| n as u32),
            within,
            rest: rest.map(|rest| positions(rest, "rest", Most::OfAnyMesh)).transpose()?,
            faces: faces.into_iter().flatten().collect(),
        })
    }

    /// Whether the place of the body is its rest shape.
    pub fn rests_now(&self) -> bool {
        self.within.is_some() && self.rest.is_none()
    }

    /// The exclusions of that body.
    pub fn of_body(self, scene: &Scene, id: BodyId) -> Exclusions {
        let now = || scene.get(id).map_or(Positions::F64(Vec::new()), |body| body.positions_t0().clone());
        let shape = |within| RestShape { within, positions: self.rest.unwrap_or_else(now) };
        Exclusions { ring: self.ring, rest: self.within.map(shape), faces: self.faces }
    }
}

/// Pairs of vertices: an array (n, 2), or a list of pairs.
pub fn pairs(given: &Bound<'_, PyAny>) -> PyResult<Vec<[u32; 2]>> {
    indices(given, "pairs")
}

impl Detector {
    /// Replaces the exclusions of a body.
    ///
    /// # Errors
    /// Those of the library.
    pub fn set_exclusions(&self, py: Python<'_>, body: Key, given: Given) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.run(py, Does::Queries, |detector| {
            if given.rests_now() {
                detector.download_positions()?;
            }
            let own = given.of_body(detector.scene(), id);
            detector.exclude(id, own)
        })
    }

    /// Replaces the pairs of vertices of two bodies that are left out.
    ///
    /// # Errors
    /// Those of the library.
    pub fn set_excluded_pairs(&self, py: Python<'_>, both: &[Key; 2], pairs: &[[u32; 2]]) -> PyResult<()> {
        self.run(py, Does::Queries, |detector| {
            let ids = key::each(detector.scene(), both)?;
            detector.exclude_pairs(ids, pairs)
        })
    }

    /// Returns the pairs of vertices of two bodies that are left out.
    ///
    /// # Errors
    /// Those of the library.
    pub fn excluded_rows<'py>(
        &self,
        py: Python<'py>,
        both: &[Key; 2],
    ) -> PyResult<Bound<'py, numpy::PyArray2<u32>>> {
        let list = self.look(py, |detector| {
            key::each(detector.scene(), both).map(|ids| detector.scene().excluded_pairs(ids))
        })?;
        Ok(rows(py, &list.map_err(raised)?))
    }
}
