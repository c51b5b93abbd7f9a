//! Bodies are added, replaced and removed between frames, and pairs of them left out.

use super::Detector;
use super::engine::fits;
use crate::error::Error;
#[cfg(doc)]
use crate::scene::Scene;
use crate::scene::{Body, BodyId, Exclusions, Thickness};

impl Detector {
    /// Replaces a body by another, of any mesh, under its number, from the next frame on. It keeps
    /// the pairs of bodies that are left out. It loses its exclusions, whose numbers of vertices and
    /// faces may mean others now: [exclude](Detector::exclude) again. Cost: as of [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, and for self-collision of a
    /// fixed body. [`Error::Input`] for more triangles than indices reach. On an error nothing has
    /// changed.
    pub fn replace(&mut self, id: BodyId, body: Body) -> Result<(), Error> {
        let old = self.scene.get(id).ok_or_else(|| empty(id))?;
        body.validate()?;
        self.fits(Some(old), &body)?;
        self.download_positions()?;
        *self.scene.get_mut(id).ok_or_else(|| empty(id))? = body;
        self.scene.excluded.forget(id);
        self.changed();
        self.placed.forget(id);
        Ok(())
    }

    /// Adds a body to the scene, from the next frame on. Cost: as of [`Detector::new`], at the next
    /// frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for self-collision of a fixed body. [`Error::Input`] for more
    /// triangles than indices reach. On an error nothing has changed.
    pub fn add(&mut self, body: Body) -> Result<BodyId, Error> {
        body.validate()?;
        self.fits(None, &body)?;
        self.download_positions()?;
        let id = self.scene.add(body);
        self.changed();
        self.placed.forget(id);
        Ok(id)
    }

    /// Removes a body from the scene, from the next frame on, and its pairs in the list of those
    /// that are left out, and its exclusions. Other bodies keep their numbers. Cost: as of [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene.
    pub fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        self.scene.get(id).ok_or_else(|| empty(id))?;
        self.download_positions()?;
        let body = self.scene.remove(id).ok_or_else(|| empty(id))?;
        self.changed();
        Ok(body)
    }

    /// Replaces the list of pairs of bodies that are not tested against each other, from the next
    /// frame on: see [`Scene::leave_out`]. Cost: as of [`Detector::new`], at the next frame. If the
    /// list is the same, nothing changes. Another list ends the preparation of submissions.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, and for a body with itself.
    /// On an error nothing has changed.
    pub fn leave_out(&mut self, pairs: &[[BodyId; 2]]) -> Result<(), Error> {
        let list = self.scene.checked(pairs)?;
        if list != self.scene.left_out {
            self.download_positions()?;
            self.scene.left_out = list;
            self.changed();
        }
        Ok(())
    }

    /// Sets the thickness of a body, from the next frame on. Cost: as of [`Detector::new`], at the next
    /// frame. If it is the same, nothing changes. Another one ends the preparation of submissions.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, and for a thickness that is no
    /// length. On an error nothing has changed.
    pub fn set_thickness(&mut self, id: BodyId, thickness: impl Into<Thickness>) -> Result<(), Error> {
        let (old, thickness) = (self.scene.get(id).ok_or_else(|| empty(id))?, thickness.into());
        thickness.check(old.name(), old.vertex_count())?;
        if *old.thickness() != thickness {
            self.download_positions()?;
            self.scene.get_mut(id).ok_or_else(|| empty(id))?.thickness = thickness;
            self.changed();
        }
        Ok(())
    }

    /// As [`Scene::left_out`].
    pub fn left_out(&self) -> &[[BodyId; 2]] {
        self.scene.left_out()
    }

    /// Replaces the exclusions of a body, from the next frame on: see [`Scene::exclude`]. Cost: as of
    /// [`Detector::new`], at the next frame. If they are the same, nothing changes. Others end the
    /// preparation of submissions.
    ///
    /// # Errors
    /// As of [`Scene::exclude`]. On an error nothing has changed.
    pub fn exclude(&mut self, id: BodyId, exclusions: Exclusions) -> Result<(), Error> {
        let own = self.scene.checked_exclusions(id, exclusions)?;
        if own.as_ref() != self.scene.exclusions(id) {
            self.download_positions()?;
            self.scene.excluded.set(id, own);
            self.changed();
        }
        Ok(())
    }

    /// Replaces the pairs of vertices of two bodies that are left out, from the next frame on: see
    /// [`Scene::exclude_pairs`]. Cost: as of [`Detector::exclude`].
    ///
    /// # Errors
    /// As of [`Scene::exclude_pairs`]. On an error nothing has changed.
    pub fn exclude_pairs(&mut self, bodies: [BodyId; 2], pairs: &[[u32; 2]]) -> Result<(), Error> {
        let (key, list) = self.scene.checked_pairs(bodies, pairs)?;
        if list != self.scene.excluded_pairs(key) {
            self.download_positions()?;
            self.scene.excluded.set_pairs((key, list));
            self.changed();
        }
        Ok(())
    }

    /// Checks that there is room for a body, in place of an old one if there is one.
    fn fits(&self, old: Option<&Body>, new: &Body) -> Result<(), Error> {
        let all = |count: fn(&Body) -> usize| {
            let others: usize = self.scene.bodies().iter().map(count).sum();
            others - old.map_or(0, count) + count(new)
        };
        fits(all(Body::element_count), all(Body::vertex_count))
    }

    /// Drops all that depends on the bodies: the next frame builds it again.
    fn changed(&mut self) {
        self.engine.drop_all();
        self.portion.forget_slices();
        self.tolerances = None;
        self.thick = None;
    }
}

/// Error for a body that is not in the scene.
pub(super) fn empty(id: BodyId) -> Error {
    Error::InvalidArgument {
        what: format!("there is no body {id} in the scene"),
        advice: "name a body by the number that adding it returned, until it is removed".into(),
    }
}
