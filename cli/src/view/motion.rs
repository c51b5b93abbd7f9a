//! Places of bodies at both ends of a step. Equal places are stored once, so that a body at rest
//! costs nothing in further frames.

use super::page::About;
use crate::paint;
use nearmiss::mesh::Body;
use nearmiss::scene::{BodyKind, PosePath};
use serde::Serialize;

/// Times of a turn at which the page has the rotation: quarters, each of at most 90 degrees.
const QUARTERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// A body that turns in a step.
#[derive(Serialize)]
pub struct Turn {
    body: usize,
    /// The pivot at both ends of the step.
    pivots: [[f64; 3]; 2],
    /// Unit quaternions `x, y, z, w` at each quarter of the step.
    rotations: [[f64; 4]; 5],
}

/// Coordinates of a body's vertices, one after the other.
pub type Places = Vec<f32>;

/// The places that were stored last, of each body.
pub struct Motions {
    last: Vec<Option<(usize, Places)>>,
    count: usize,
    at_rest: bool,
}

/// Numbers of stored places at the start and at the end, one a body.
pub type Ends = [Vec<usize>; 2];

impl Motions {
    pub fn of(bodies: &[Body], about: &About) -> Motions {
        Motions { last: vec![None; bodies.len()], count: 0, at_rest: about.at_rest }
    }

    /// Both ends of a step, the bodies that turn, and the places that are new.
    pub fn step(&mut self, bodies: &[Body], about: &About) -> (Ends, Vec<Turn>, Vec<(usize, Places)>) {
        let (mut ends, mut stored) = (Ends::default(), Vec::new());
        let times: &[f64] = if self.at_rest { &[0.0, 0.0] } else { &[0.0, 1.0] };
        for (at, body) in bodies.iter().enumerate() {
            for (end, time) in times.iter().enumerate() {
                let places = places(body, *time, about);
                let known = self.last[at].as_ref().filter(|(_, last)| *last == places);
                let number = known.map_or(self.count, |(number, _)| *number);
                if known.is_none() {
                    self.count += 1;
                    stored.push((number, places.clone()));
                    self.last[at] = Some((number, places));
                }
                ends[end].push(number);
            }
        }
        let turns = |(at, body): (usize, &Body)| turn(at, body, about);
        let turns = bodies.iter().enumerate().filter(|_| !self.at_rest).filter_map(turns).collect();
        (ends, turns, stored)
    }
}

/// The places of a body in the cube of the page. A vertex of no triangle may be outside, and is never
/// seen.
fn places(body: &Body, time: f64, about: &About) -> Places {
    let place = |point: [f64; 3]| about.near_origin(point).map(|x| x.clamp(-1.0, 1.0) as f32);
    paint::placed(body, time).into_iter().flat_map(place).collect()
}

fn turn(at: usize, body: &Body, about: &About) -> Option<Turn> {
    if body.kind() != BodyKind::Rigid {
        return None;
    }
    let step = body.pose_step();
    let PosePath::Turn { pivot, .. } = step.path() else { return None };
    if !step.turns() {
        return None;
    }
    let poses = QUARTERS.map(|time| step.at(time).unwrap_or_else(|| step.start()));
    let pivots = [poses[0], poses[4]].map(|pose| about.near_origin(pose.apply(pivot)));
    Some(Turn { body: at, pivots, rotations: poses.map(|pose| pose.rotation) })
}
