//! Bodies of which only the device knows where they are.

use super::Detector;
use crate::error::Error;
use crate::mesh::Positions;
use crate::pipeline::{Layout, Seen, Whereabouts};
use crate::scene::{Body, Pose};
use std::sync::Arc;

/// Knowledge of the bodies that are on the device.
#[derive(Default)]
pub struct Resident {
    /// The largest coordinate that was seen in memory of the caller so far.
    pub largest: f64,
    /// Whether the last frame that placed each body was refused: its earlier position is not known either.
    lost: Vec<bool>,
}

impl Resident {
    /// Whether a body was placed in a frame that was refused, and in none since.
    pub fn is_lost(&self, body: usize) -> bool {
        self.lost.get(body).is_some_and(|is_lost| *is_lost)
    }

    /// Whether nobody knows where a body is; one that is placed again is not lost.
    pub fn set_lost(&mut self, body: usize, is_lost: bool) {
        if is_lost {
            self.lost.resize(self.lost.len().max(body + 1), false);
        }
        if let Some(was_lost) = self.lost.get_mut(body) {
            *was_lost = is_lost;
        }
    }

    /// A frame saw this.
    pub fn saw(&mut self, seen: Option<Seen>) {
        self.largest = seen.map_or(self.largest, |seen| seen.largest.max(self.largest));
    }
}

impl Detector {
    /// Brings the bodies to the host of which only the device knows where they are ([`Body::is_device_resident`]), so that
    /// [`Detector::scene`] has them. Cost: a copy of all vertices, and a wait.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for positions and poses of the caller that cannot be computed with; those of the device.
    pub fn download_positions(&mut self) -> Result<(), Error> {
        self.read_again(false);
        if !self.scene.bodies().iter().any(Body::is_device_resident) {
            return Ok(());
        }
        self.all_known()?;
        if let Some(places) = self.places()? {
            if places.all.seen.is_some_and(|seen| seen.invalid) {
                self.check_places(&places)?;
            }
            self.bring(&places);
        }
        Ok(())
    }

    /// Bodies that a submission reads are where their memory says, however often that was read: by a submission, or by one
    /// that was recorded and launched again, of which nobody tells the detector. Those of one that was refused only if there
    /// is another.
    pub(super) fn read_again(&mut self, is_another: bool) {
        if !self.engine.is_prepared() {
            return;
        }
        for submitted in &self.placed.submitted {
            let body = submitted.body.index();
            if is_another || !self.resident.is_lost(body) {
                self.resident.set_lost(body, false);
                self.scene.bodies_mut()[body].placed_again(submitted.moves);
            }
        }
    }

    /// Where the device has placed all bodies; `None` where nothing can meet, and nothing was placed.
    fn places(&mut self) -> Result<Option<Places>, Error> {
        let layout = self.any_layout()?;
        let Some(pipeline) = &self.engine.pipeline else { return Ok(None) };
        Ok(Some(Places { all: pipeline.whereabouts()?, layout }))
    }

    /// Brings bodies back from there.
    fn bring(&mut self, places: &Places) {
        for (i, body) in self.scene.bodies_mut().iter_mut().enumerate() {
            // Who is lent has another place now.
            if body.is_device_resident() && body.lent().is_none() {
                let (ends, poses) = places.of(i);
                body.bring(&ends, poses);
                self.resident.set_lost(i, false);
            }
        }
    }

    /// Nobody knows where a body is.
    fn lose(&mut self, body: usize) {
        self.resident.set_lost(body, true);
        self.scene.bodies_mut()[body].placed_again(false);
    }

    /// Brings every body to the host, before the device's memory goes. Bodies of the last frame whose positions no mesh may
    /// have are lost: they have to be named again.
    pub(super) fn bring_all(&mut self) {
        let lost: Vec<bool> =
            (0..self.scene.bodies().len()).map(|body| self.resident.is_lost(body)).collect();
        let places = self.places().ok().flatten();
        let is_valid = places.as_ref().is_some_and(|places| {
            let mut away =
                self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_device_resident());
            away.all(|(i, body)| {
                let (ends, poses) = places.of(i);
                body.check_found(&ends, poses).is_ok()
            })
        });
        if let Some(places) = &places {
            self.bring(places);
        }
        for (body, was_lost) in lost.into_iter().enumerate() {
            if was_lost || self.placed.is_named(body) && !is_valid {
                self.lose(body);
            }
        }
    }

    /// Whether every body is where the host or a pipeline knows it to be.
    pub(super) fn all_known(&self) -> Result<(), Error> {
        self.none_lost()?;
        let gone = |body: &&Body| body.is_device_resident() && body.lent().is_none();
        match self.scene.bodies().iter().find(gone) {
            Some(body) if self.engine.pipeline.is_none() => Err(Error::InvalidArgument {
                what: format!("only the device knew where {} was, and that memory is gone", body.name()),
                advice: "say again where it is".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Whether no body was placed in a frame that was refused, and in none since.
    pub(super) fn none_lost(&self) -> Result<(), Error> {
        let mut bodies = self.scene.bodies().iter().enumerate();
        match bodies.find(|(body, _)| self.resident.is_lost(*body)) {
            Some((_, body)) => Err(Error::InvalidArgument {
                what: format!(
                    "nobody knows where {} is: the frame that named it last was refused, and has overwritten where it was",
                    body.name()
                ),
                advice: "name it again, and all others of that frame".into(),
            }),
            None => Ok(()),
        }
    }

    /// Whether the answer holds, by what placing saw of positions in memory of the caller. Where these need doubles and the pipeline has
    /// singles, the pipeline goes and the frame is to be run again: false.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for what no precision can compute with, naming the body and the vertex; those of the
    /// device.
    pub(super) fn check_seen(&mut self, seen: Option<Seen>) -> Result<bool, Error> {
        if !seen.is_some_and(|seen| seen.invalid) {
            return Ok(true);
        }
        let Some(places) = self.places()? else { return Ok(true) };
        let are_single = self.check_places(&places)?;
        if self.engine.holds_f64 || are_single {
            // Only vertices that no face uses.
            return Ok(true);
        }
        self.bring(&places);
        self.engine.drop_pipeline();
        Ok(false)
    }

    /// Whether singles can compute with what was placed from memory of the caller. If nothing can, nobody knows where the bodies of
    /// that frame are.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`], naming the body and the vertex.
    fn check_places(&mut self, places: &Places) -> Result<bool, Error> {
        let away = self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_device_resident());
        let checked = away.map(|(i, body)| {
            let (ends, poses) = places.of(i);
            body.check_found(&ends, poses)
        });
        let are_single = checked.reduce(|all, own| Ok(all? & own?)).unwrap_or(Ok(true));
        if are_single.is_err() {
            let named: Vec<usize> =
                (0..self.scene.bodies().len()).filter(|&body| self.placed.is_named(body)).collect();
            named.into_iter().for_each(|body| self.lose(body));
        }
        are_single
    }
}

/// Where all bodies are, by body.
struct Places {
    all: Whereabouts,
    layout: Arc<Layout>,
}

impl Places {
    /// A body's vertices at both ends or at the only one, and the poses that it was found in.
    fn of(&self, i: usize) -> (Vec<Positions>, &[Pose]) {
        let range = self.layout.starts[i].vertex as usize..self.layout.starts[i + 1].vertex as usize;
        let part = |positions: &Positions| match positions {
            Positions::F32(points) => Positions::F32(points[range.clone()].to_vec()),
            Positions::F64(points) => Positions::F64(points[range.clone()].to_vec()),
        };
        let ends = self.all.ends.len();
        let poses = self.all.poses.get(i * ends..(i + 1) * ends).unwrap_or_default();
        (self.all.ends.iter().map(part).collect(), poses)
    }
}
