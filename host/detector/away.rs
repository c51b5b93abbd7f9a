//! Bodies of which only the device knows where they are.

use super::Detector;
use crate::contacts::{Contacts, Degraded};
use crate::error::Error;
use crate::mesh::{Body, Positions};
use crate::pipeline::below_precision::BelowPrecision;
use crate::pipeline::{Layout, Seen, Stages, Whereabouts};
use crate::query::{Certified, Query};
use crate::scene::Pose;
use std::sync::Arc;
use std::time::Instant;

impl Detector {
    /// Brings the bodies to the host of which only the device knows where they are ([`Body::is_away`]), so that
    /// [`Detector::scene`] has them. Cost: a copy of all vertices, and a wait.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Choice`] for positions and poses of the caller that cannot be computed with; those of the device.
    pub fn fetch(&mut self) -> Result<(), Error> {
        self.read_again(false);
        if !self.scene.bodies().iter().any(Body::is_away) {
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
        if self.pipeline.as_ref().is_some_and(|pipeline| pipeline.is_prepared()) {
            for &(id, moving) in &self.submits {
                let body = &mut self.scene.bodies_mut()[id.index()];
                if is_another || !body.is_lost() {
                    body.placed_again(moving);
                }
            }
        }
    }

    /// Where the device has placed all bodies; `None` where nothing can meet, and nothing was placed.
    fn places(&mut self) -> Result<Option<Places>, Error> {
        let layout = self.layout()?;
        let Some(pipeline) = &self.pipeline else { return Ok(None) };
        Ok(Some(Places { all: pipeline.whereabouts()?, layout }))
    }

    /// Brings bodies back from there.
    fn bring(&mut self, places: &Places) {
        for (i, body) in self.scene.bodies_mut().iter_mut().enumerate() {
            // Who is lent has another place now.
            if body.is_away() && body.lent().is_none() {
                let (ends, poses) = places.of(i);
                body.bring(&ends, poses);
            }
        }
    }

    /// Brings every body to the host, before the device's memory goes. Bodies of the last frame whose positions no mesh may
    /// have are lost: they have to be named again.
    pub(super) fn bring_all(&mut self) {
        let lost: Vec<bool> = self.scene.bodies().iter().map(Body::is_lost).collect();
        let places = self.places().ok().flatten();
        let is_valid = places.as_ref().is_some_and(|places| {
            let mut away = self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_away());
            away.all(|(i, body)| {
                let (ends, poses) = places.of(i);
                body.check_found(&ends, poses).is_ok()
            })
        });
        if let Some(places) = &places {
            self.bring(places);
        }
        let named = self.named.iter().chain(std::iter::repeat(&false));
        for ((body, lost), named) in self.scene.bodies_mut().iter_mut().zip(lost).zip(named) {
            if lost || *named && !is_valid {
                body.lose();
            }
        }
    }

    /// Whether every body is where the host or a pipeline knows it to be.
    pub(super) fn all_known(&self) -> Result<(), Error> {
        self.none_lost()?;
        let gone = |body: &&Body| body.is_away() && body.lent().is_none();
        match self.scene.bodies().iter().find(gone) {
            Some(body) if self.pipeline.is_none() => Err(Error::Choice {
                what: format!("only the device knew where {} was, and that memory is gone", body.name()),
                advice: "say again where it is".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Whether no body was placed in a frame that was refused, and in none since.
    pub(super) fn none_lost(&self) -> Result<(), Error> {
        match self.scene.bodies().iter().find(|body| body.is_lost()) {
            Some(body) => Err(Error::Choice {
                what: format!(
                    "nobody knows where {} is: the frame that named it last was refused, and has overwritten where it was",
                    body.name()
                ),
                advice: "name it again, and all others of that frame".into(),
            }),
            None => Ok(()),
        }
    }

    /// Looks at numbers of the caller that placing could not compute with. Where doubles can, all goes over to doubles: true.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Choice`] for what no precision can compute with, naming the body and the vertex; those of the
    /// device.
    fn look(&mut self) -> Result<bool, Error> {
        let Some(places) = self.places()? else { return Ok(false) };
        let are_single = self.check_places(&places)?;
        if self.f64s || are_single {
            // Only vertices that no face uses.
            return Ok(false);
        }
        self.bring(&places);
        self.pipeline = None;
        Ok(true)
    }

    /// Whether singles can compute with what was placed from memory of the caller. If nothing can, nobody knows where the bodies of
    /// that frame are.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Choice`], naming the body and the vertex.
    fn check_places(&mut self, places: &Places) -> Result<bool, Error> {
        let away = self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_away());
        let checked = away.map(|(i, body)| {
            let (ends, poses) = places.of(i);
            body.check_found(&ends, poses)
        });
        let are_single = checked.reduce(|all, own| Ok(all? & own?)).unwrap_or(Ok(true));
        if are_single.is_err() {
            let bodies = self.scene.bodies_mut().iter_mut().zip(&self.named);
            bodies.filter(|(_, named)| **named).for_each(|(body, _)| body.lose());
        }
        are_single
    }

    /// The end of a frame: the answer, unless what was seen of the caller's memory says otherwise.
    pub(super) fn complete(
        &mut self,
        mut contacts: Contacts,
        seen: Option<Seen>,
        start: Instant,
    ) -> Result<Contacts, Error> {
        if seen.is_some_and(|seen| seen.invalid) && self.look()? {
            return self.answer(start);
        }
        self.answered = true;
        self.wear.tell(contacts.steps);
        self.largest = seen.map_or(self.largest, |seen| seen.largest.max(self.largest));
        self.tell_below_precision(&mut contacts)?;
        self.tell_turns(&mut contacts)?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        contacts.stages = Stages { construct: self.construct_ms, wall, ..contacts.stages };
        Ok(contacts)
    }

    /// An earliest query lists no pairs, so whether they are too large for the tolerance hangs on where bodies are: of those that are
    /// away on the largest of their coordinates and, where that leaves it open, on themselves.
    fn tell_below_precision(&mut self, contacts: &mut Contacts) -> Result<(), Error> {
        let (Query::Earliest(_), Some(certified), Some(tolerances)) =
            (self.query, self.query.certified().copied(), &self.tolerances)
        else {
            return Ok(());
        };
        let finest = Certified { tolerance: Some(tolerances.finest), ..certified };
        let own = tolerances.least < tolerances.largest;
        let certified = Certified { tolerance: Some(tolerances.largest), ..certified };
        let unlisted = Degraded::ToleranceBelowPrecision { pairs: None };
        // If no body came from memory of the caller the pipeline has looked at all.
        let is_looked_at = self.largest == 0.0 && !self.scene.bodies().iter().any(Body::is_away);
        if is_looked_at || contacts.degraded.contains(&unlisted) {
            return Ok(());
        }
        let largest = self.largest.max(BelowPrecision::largest(self.scene.bodies()));
        if !BelowPrecision::may_be(&finest, 2.0 * largest) {
            return Ok(());
        }
        self.fetch()?;
        let below = BelowPrecision::of_earliest(self.scene.bodies(), &certified, own);
        if below == Some(BelowPrecision::Unlisted) {
            contacts.degraded.push(unlisted);
        }
        Ok(())
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
