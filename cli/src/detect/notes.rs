//! What a user should know about an answer that is right and says little.

use crate::sequence::Sequence;
use nearmiss::Detector;
use nearmiss::contacts::{Answer, Contacts};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::{Query, QueryKind};
use nearmiss::scene::Scene;
use nearmiss::words::counted;

/// Whether anything moves within the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    /// There is a step, and something moves in it.
    Yes,
    /// There is one frame of everything.
    OneFrame,
    /// There is one frame of every body of a scene.
    OneFrameOfScene,
    /// The frames are the same.
    SameFrames,
}

impl Moves {
    /// Whether these bodies move.
    pub fn of(bodies: &[Body]) -> Moves {
        let moves = |body: &Body| body.positions_t1().is_some_and(|t1| t1 != body.positions_t0());
        match (bodies.iter().any(moves), bodies.iter().any(Body::is_moving)) {
            (true, _) => Moves::Yes,
            (false, true) => Moves::SameFrames,
            (false, false) => Moves::OneFrame,
        }
    }

    /// Whether the bodies of a scene move in its first step.
    pub fn of_scene(all: &Sequence) -> Moves {
        match (all.frames, all.moves(0)) {
            (1, _) => Moves::OneFrameOfScene,
            (_, true) => Moves::Yes,
            (_, false) => Moves::SameFrames,
        }
    }
}

/// How many pairs of triangles meet at the start of the step already. A time of contact is silent about an edge that is
/// through a face by then. `None` where there is no memory to find out.
///
/// # Errors
/// Those of the device, but for memory.
pub fn at_start(device: Device, scene: Scene) -> Result<Option<usize>, Error> {
    let found = Detector::new(device, scene, Query::discrete()).and_then(|mut all| all.detect());
    Ok(has_memory(found)?.map(|contacts| contacts.len()))
}

/// What was asked beside the answer; `None` where there is no memory for it.
///
/// # Errors
/// All others.
pub fn has_memory<T>(done: Result<T, Error>) -> Result<Option<T>, Error> {
    match done {
        Ok(done) => Ok(Some(done)),
        Err(Error::OutOfMemory { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Contacts from which on vertices that coincide are worth a word.
const MANY: usize = 1_000;

/// How many vertices share their place with another, where contacts are so many that it is worth a sort of the vertices: of welded
/// bodies none.
pub fn coincident(bodies: &[Body], contacts: &Contacts) -> usize {
    if contacts.len() < MANY { 0 } else { bodies.iter().map(Body::coincident).sum() }
}

/// The notes, a line each; of the triangle pairs that meet at the start, and the vertices that share their place with another.
pub fn of(
    motion: QueryKind,
    moves: Moves,
    contacts: &Contacts,
    (at_start, coincident): (Option<usize>, usize),
) -> Vec<String> {
    let mut notes = Vec::new();
    let why = match moves {
        Moves::OneFrame => {
            Some("there is one frame; give a second file with the positions at the end of the step")
        }
        Moves::OneFrameOfScene => {
            Some("there is one frame of every body; give one that moves more `meshes` or `poses`")
        }
        Moves::SameFrames => Some("both frames are the same"),
        Moves::Yes => None,
    };
    if let Some(why) = why.filter(|_| !motion.is_at_rest()) {
        notes.push(format!("nothing moves: {why}"));
    }
    if contacts.answer == Answer::Distance(None) {
        notes.push(
            "no two bodies may meet: give a second mesh by --with, or bodies that meet in a scene file"
                .into(),
        );
    }
    match at_start {
        Some(pairs @ 1..) => {
            let meet = counted(pairs as u64, "triangle pair meets", "triangle pairs meet");
            notes.push(format!(
                "{meet} at the start of the step already: no step is free of contact; --discrete lists them"
            ));
        }
        _ if contacts.answer == Answer::Earliest(Some(0.0)) => {
            notes.push(
                "in contact at the start of the step, or too near to tell: no step can be taken".into(),
            );
        }
        _ => {}
    }
    if coincident > 0 {
        let share = counted(coincident as u64, "vertex shares its", "vertices share their");
        notes.push(format!(
            "{share} place with another: what meets at a seam is listed too; --weld merges them"
        ));
    }
    notes
}
