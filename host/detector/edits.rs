//! Bodies come, go and change between frames.

use super::Detector;
use super::engine::fits;
use crate::error::Error;
use crate::scene::{Body, BodyId};

impl Detector {
    /// Puts another body, of any mesh, in the place of one: under its number, from the next frame on. Cost: as of
    /// [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene and for self-collision of a static body, [`Error::Input`] for more triangles
    /// than indices reach: then nothing has changed.
    pub fn replace(&mut self, id: BodyId, body: Body) -> Result<(), Error> {
        let old = self.scene.get(id).ok_or_else(|| nobody(id))?;
        body.check_filter()?;
        self.fits(Some(old), &body)?;
        self.download_positions()?;
        *self.scene.get_mut(id).ok_or_else(|| nobody(id))? = body;
        self.changed();
        self.placed.forget(id);
        Ok(())
    }

    /// Adds a body to the scene, from the next frame on. Cost: as of [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for self-collision of a static body, [`Error::Input`] for more triangles than indices reach: then nothing has
    /// changed.
    pub fn add(&mut self, body: Body) -> Result<BodyId, Error> {
        body.check_filter()?;
        self.fits(None, &body)?;
        self.download_positions()?;
        let id = self.scene.add(body);
        self.changed();
        self.placed.forget(id);
        Ok(id)
    }

    /// Takes a body out of the scene, from the next frame on; other bodies keep their numbers. Cost: as of
    /// [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene.
    pub fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        self.scene.get(id).ok_or_else(|| nobody(id))?;
        self.download_positions()?;
        let body = self.scene.remove(id).ok_or_else(|| nobody(id))?;
        self.changed();
        Ok(body)
    }

    /// Whether there is room for a body, in the place of another.
    fn fits(&self, old: Option<&Body>, new: &Body) -> Result<(), Error> {
        let all = |of: fn(&Body) -> usize| {
            let others: usize = self.scene.bodies().iter().map(of).sum();
            others - old.map_or(0, of) + of(new)
        };
        fits(all(Body::face_count), all(Body::vertex_count))
    }

    /// The next frame begins anew.
    fn changed(&mut self) {
        self.engine.drop_all();
        self.portion.forget_slices();
        self.tolerances = None;
    }
}

/// There is no such body.
pub(super) fn nobody(id: BodyId) -> Error {
    Error::InvalidArgument {
        what: format!("there is no body {id} in the scene"),
        advice: "name a body by what adding it gave, until it is removed".into(),
    }
}
