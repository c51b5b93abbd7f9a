//! The nearest two bodies of a scene of rigid and fixed bodies: the least of the distances of pairs of
//! bodies within a limit, which grows until a pair is within it.
//!
//! Meshes are kept once, nothing is fitted but a box a body, and a limit leaves out all bodies that
//! are farther. One bound for all pairs ends the work of those that are not the nearest. The first
//! limit follows from the triangles that were nearest last, where they are now. It is a cost and no part
//! of the answer: every limit with a row has the nearest pair in its rows.

use super::Detector;
use super::question::Question;
use crate::contacts::{Contacts, Keep, NearestTriangles, Rows};
use crate::error::Error;
use crate::pipeline::Stages;
use crate::query::{BodyDistances, Query};
use crate::scene::{Body, BodyKind, Scene};
use nearmiss_kernels::prim::nearest::Nearest;
use std::time::Instant;

/// Factor of a distance, so that roundings of places leave it within the limit.
const FARTHER: f64 = 1.0 + 1e-9;
/// Bodies before each in the scene's list whose distance from it is seen before the first limit. The
/// next link of a chain is mostly left out.
const NEIGHBOURS: usize = 2;
/// Limits that are twice as large as the one before. Then their ratio is squared each time.
const DOUBLED: usize = 16;

/// The limits of a search: it ends at the first with a row. The last one has all pairs.
fn limits(first: f64, near: f64) -> impl Iterator<Item = f64> {
    let mut next = Some((first, 2.0, 0));
    std::iter::from_fn(move || {
        let (limit, ratio, turns) = next?;
        let ratio = if turns < DOUBLED { ratio } else { ratio * ratio };
        let larger = (limit * ratio).max(near).min(f64::MAX);
        next = (limit < f64::MAX).then_some((larger, ratio, turns + 1));
        Some(limit)
    })
}

/// The distance of two triangles of bodies, where they are now.
fn distance(scene: &Scene, nearest: &NearestTriangles) -> Option<f64> {
    let of = |side: usize| scene.get(nearest.bodies[side])?.corners(nearest.triangles[side] as usize);
    Some(Nearest::of(&of(0)?, &of(1)?).distance)
}

/// The nearest of rows: among those with the least distance, the one whose triangles are first in the
/// scene.
fn nearest(rows: &[NearestTriangles]) -> Option<NearestTriangles> {
    let first = |row: &NearestTriangles| {
        let ([a, b], [p, q]) = (row.bodies, row.triangles);
        [(a, p), (b, q)]
    };
    let order = |a: &NearestTriangles, b: &NearestTriangles| {
        a.distance.total_cmp(&b.distance).then_with(|| first(a).cmp(&first(b)))
    };
    rows.iter().min_by(|a, b| order(a, b)).copied()
}

impl Detector {
    /// Whether the nearest bodies are found among instances: all bodies are rigid or fixed, the host has
    /// their poses, and no choice of trees is made.
    pub(super) fn is_of_nearest_instances(&self, query: &Query) -> bool {
        let Query::Distance(distance) = query else { return false };
        let is_solid = |body: &Body| {
            let has_pose = body.kind() != BodyKind::Deformable && !body.is_device_resident();
            has_pose || body.element_count() == 0
        };
        !distance.search.is_chosen() && self.is_whole() && self.scene.bodies().iter().all(is_solid)
    }

    /// The query of the frame that answers a query: for the nearest of instances, that of the last limit,
    /// or one without a length before there is one.
    pub(super) fn query_of_frame(&self, query: &Query) -> Query {
        let Query::Distance(distance) = query else { return *query };
        if !self.is_of_nearest_instances(query) {
            return *query;
        }
        match self.engine.answered {
            Some(Query::BodyDistances(last)) if last.only_nearest => last.into(),
            _ => BodyDistances { within: 0.0, only_nearest: true, search: distance.search }.into(),
        }
    }

    /// The same, of an answer that the device holds: it is made if there is none.
    ///
    /// # Errors
    /// As of [`Detector::answer`].
    pub(super) fn query_of_answer(&mut self, query: &Query) -> Result<Query, Error> {
        if self.is_of_nearest_instances(query) && self.engine.answered != Some(self.query_of_frame(query)) {
            let question = self.question(*query)?;
            self.answer(&question, Instant::now())?;
        }
        Ok(self.query_of_frame(query))
    }

    /// The limits of the next search.
    ///
    /// # Errors
    /// Those of the device.
    fn limits(&mut self, query: &Query) -> Result<impl Iterator<Item = f64> + use<>, Error> {
        let layout = self.layout(query)?;
        let bodies = self.scene.bodies();
        let first: Vec<_> = bodies.iter().map(|body| Some(body.corners(0)?[0])).collect();
        let apart = |a: usize, b: usize| {
            let d = first[a]? - first[b]?;
            Some(d.dot(d).sqrt())
        };
        let pairs = (0..bodies.len()).flat_map(|b| (b.saturating_sub(NEIGHBOURS)..b).map(move |a| (a, b)));
        let near = pairs.fold(f64::INFINITY, |near, (a, b)| match apart(a, b) {
            Some(d) if d > 0.0 && d < near && layout.tests(a, b) => d,
            _ => near,
        });
        let near = if near < f64::INFINITY { near } else { 1.0 };
        let first = match &self.engine.nearest {
            None => near,
            Some(None) => f64::MAX,
            Some(Some(last)) => distance(&self.scene, last).map_or(near, |last| (FARTHER * last).min(near)),
        };
        Ok(limits(first, near))
    }

    /// The nearest two bodies of a scene whose bodies can be read as instances.
    ///
    /// # Errors
    /// As of [`Detector::answer`].
    pub(super) fn nearest_instances(
        &mut self,
        question: &Question,
        start: Instant,
    ) -> Result<Contacts, Error> {
        let Query::Distance(distance) = question.query else {
            return Err(Error::Bug { what: "nearest bodies are the answer to a distance query".into() });
        };
        let (mut all, mut found) = (Vec::new(), None);
        for within in self.limits(&question.query)? {
            let of_pairs =
                self.question(BodyDistances { within, only_nearest: true, search: distance.search }.into())?;
            let mut round = self.answer_once(&of_pairs, start)?;
            let Rows::BodyDistances(rows) = &round.rows else {
                return Err(Error::Bug { what: "distances of bodies have other rows".into() });
            };
            found = nearest(rows);
            round.rows = Rows::Distance(found);
            round.query = question.query;
            all.push(round);
            if found.is_some() {
                break;
            }
        }
        // Only now: after an error nothing is known of limits that were not taken.
        self.engine.nearest = Some(found);
        let device = self.device.clone();
        let keep: Keep = &|bytes, fill| device.keep_filled(bytes, fill);
        let mut whole = Contacts::merged(all, |a, b| a + b, keep, &device.looks())?;
        whole.stats.slices = 1;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        let stages = whole.stats.stages;
        whole.stats.stages = Stages { construct: self.engine.construct_ms, wall, ..stages };
        Ok(whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_grow_to_all_in_few_turns() {
        for (first, near) in [(0.0, 1e-3), (1.0, 0.1), (5e-324, 5e-324), (1e300, 1e300), (f64::MAX, 1.0)] {
            let all: Vec<f64> = limits(first, near).collect();
            assert_eq!((all[0], all.last()), (first, Some(&f64::MAX)), "{first} {near}");
            assert!(all.is_sorted_by(|a, b| a < b) && all.len() < 40, "{all:?}");
            // A search that begins below the distance ends at most at twice of it, near its beginning.
            let doubled = all.windows(2).take(DOUBLED).skip(1).all(|w| w[1] <= 2.0 * w[0].max(near));
            assert!(doubled, "{all:?}");
        }
    }

    #[test]
    fn the_first_of_equal_rows_is_nearest() {
        use crate::scene::BodyId;
        let row = |[a, b]: [u32; 2], distance| NearestTriangles {
            bodies: [BodyId(0), BodyId(a)],
            triangles: [b, 0],
            distance,
            weights: [[1.0, 0.0, 0.0]; 2],
            points: [[0.0; 3]; 2],
        };
        let rows = [row([1, 0], 2.0), row([2, 5], 1.0), row([3, 4], 1.0), row([4, 4], 1.0)];
        assert_eq!(nearest(&rows).map(|row| row.bodies[1]), Some(BodyId(3)));
        assert_eq!(nearest(&[]), None);
    }
}
