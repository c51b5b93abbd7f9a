//! Bodies come, go and change between frames.

use super::Detector;
use crate::error::Error;
use crate::mesh::Body;
use crate::scene::{BodyId, Scene};

impl Detector {
    /// Puts another body, of any mesh, in the place of one: under its number, from the next frame on. Cost: as of
    /// [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::Choice`] for a body that is not in the scene, and for more triangles than indices reach: then nothing has changed.
    pub fn replace(&mut self, id: BodyId, body: Body) -> Result<(), Error> {
        self.change(|scene| {
            *scene.get_mut(id).ok_or_else(|| nobody(id))? = body;
            Ok(())
        })
    }

    /// Adds a body to the scene, from the next frame on. Cost: as of [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::Choice`] for more triangles than indices reach: then nothing has changed.
    pub fn add(&mut self, body: Body) -> Result<BodyId, Error> {
        self.change(|scene| Ok(scene.add(body)))
    }

    /// Takes a body out of the scene, from the next frame on; other bodies keep their numbers. Cost: as of
    /// [`Detector::new`], at the next frame.
    ///
    /// # Errors
    /// [`Error::Choice`] for a body that is not in the scene.
    pub fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        self.change(|scene| scene.remove(id).ok_or_else(|| nobody(id)))
    }

    /// Changes the scene, if the result has room.
    fn change<T>(&mut self, change: impl FnOnce(&mut Scene) -> Result<T, Error>) -> Result<T, Error> {
        let mut scene = self.scene.clone();
        let told = change(&mut scene)?;
        let old = std::mem::replace(&mut self.scene, scene);
        if let Err(error) = self.lay_out() {
            self.scene = old;
            return Err(error);
        }
        self.pipeline = None;
        self.answered = false;
        Ok(told)
    }
}

/// There is no such body.
pub(super) fn nobody(id: BodyId) -> Error {
    Error::Choice {
        what: format!("there is no body {id} in the scene"),
        advice: "name a body by what adding it gave, until it is removed".into(),
    }
}
