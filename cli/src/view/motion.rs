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
}

/// Numbers of stored places at the start and at the end, one a body.
pub type Ends = [Vec<usize>; 2];

impl Motions {
    pub fn of(bodies: &[Body]) -> Motions {
        Motions { last: vec![None; bodies.len()], count: 0 }
    }

    /// Both ends of a step, the bodies that turn, and the places that are new.
    pub fn step(&mut self, bodies: &[Body], about: &About) -> (Ends, Vec<Turn>, Vec<(usize, Places)>) {
        let mut stored = Vec::new();
        let mut all = |time: f64| -> Vec<usize> {
            let one = |(at, body): (usize, &Body)| self.number(at, places(body, time, about), &mut stored);
            bodies.iter().enumerate().map(one).collect()
        };
        let start = all(0.0);
        if about.at_rest {
            return ([start.clone(), start], Vec::new(), stored);
        }
        let ends = [start, all(1.0)];
        let turns = |(at, body): (usize, &Body)| turn(at, body, about);
        (ends, bodies.iter().enumerate().filter_map(turns).collect(), stored)
    }

    /// The number of a body's places, which are stored if they are not its last ones.
    fn number(&mut self, at: usize, places: Places, stored: &mut Vec<(usize, Places)>) -> usize {
        match &self.last[at] {
            Some((number, last)) if *last == places => *number,
            _ => {
                let number = self.count;
                self.count += 1;
                stored.push((number, places.clone()));
                self.last[at] = Some((number, places));
                number
            }
        }
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
