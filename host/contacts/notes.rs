//! Notes with an answer: facts that its user should know.

use super::{Contacts, Rows};
use crate::query::Query;
use crate::scene::{Body, BodyKind, CollisionFilter};
use crate::words::counted;
use std::collections::HashMap;
use std::fmt;

/// Note with an answer. Its text is the same in every language:
/// [`Summary::notes`](super::Summary::notes).
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Note {
    /// Note of a mesh file's reader, made by the package `nearmiss-io`.
    File {
        /// Text of the note.
        text: String,
    },
    /// A query in motion of bodies at rest: none has positions or another pose for the step's end.
    OneFrame,
    /// A query in motion of bodies with equal start and end.
    SameFrames,
    /// A query of pairs of bodies, of bodies of which no two may meet.
    NoTwoBodies,
    /// Triangle pairs that share a point at the start of the step.
    StartsCrossing {
        /// Number of pairs.
        pairs: u64,
    },
    /// An earliest time of 0.
    ContactAtStart,
    /// Vertices that coincide with another, with at least [`Note::MANY`] contacts.
    Coincident {
        /// Number of vertices.
        vertices: u64,
    },
}

impl Note {
    /// Number of contacts from which on coincident vertices are counted.
    pub const MANY: usize = 1_000;

    /// Returns the notes of an answer; bodies are still in the answer's positions. Cost: a pass
    /// over positions that do not move; with [`Note::MANY`] contacts a sort of all vertices.
    #[doc(hidden)]
    pub fn of(bodies: &[Body], query: &Query, contacts: &Contacts) -> Vec<Note> {
        let rests = || (!query.kind().is_at_rest()).then(|| resting(bodies)).flatten();
        let apart = match &contacts.rows {
            Rows::Distance(nearest) => nearest.is_none(),
            Rows::BodyPairs(_) | Rows::BodyDistances(_) => contacts.is_empty() && !any_two_meet(bodies),
            Rows::Pairs(_) | Rows::Contacts(_) | Rows::Earliest(_) | Rows::Near(_) => false,
        };
        let start = match contacts.starts_crossing {
            Some(pairs @ 1..) => Some(Note::StartsCrossing { pairs }),
            _ => (contacts.rows == Rows::Earliest(Some(0.0))).then_some(Note::ContactAtStart),
        };
        let coincide = || bodies.iter().map(Body::coincident).sum::<usize>() as u64;
        let vertices = if contacts.len() < Note::MANY { 0 } else { coincide() };
        let seams = (vertices > 0).then_some(Note::Coincident { vertices });
        rests().into_iter().chain(apart.then_some(Note::NoTwoBodies)).chain(start).chain(seams).collect()
    }
}

/// Whether kinds and filters let any two bodies meet. Cost: linear for few different filters in an
/// environment.
fn any_two_meet(bodies: &[Body]) -> bool {
    // Bodies that all others treat alike, and whether there are two of them.
    let mut alike: HashMap<Option<u32>, HashMap<(CollisionFilter, bool), bool>> = HashMap::new();
    for body in bodies.iter().filter(|body| !body.elements().is_empty()) {
        let filter = CollisionFilter { self_collision: None, ..*body.filter() };
        let own = alike.entry(filter.environment).or_default();
        let key = (filter, body.kind() == BodyKind::Fixed);
        own.entry(key).and_modify(|is_twice| *is_twice = true).or_insert(false);
    }
    let meet = |a: &(CollisionFilter, bool), b: &(CollisionFilter, bool)| !(a.1 && b.1) && a.0.allows(&b.0);
    let everywhere = alike.get(&None);
    alike.values().any(|own| {
        let twice = own.iter().any(|(one, is_twice)| *is_twice && meet(one, one));
        let others = || own.keys().chain(everywhere.into_iter().flat_map(HashMap::keys));
        twice || own.keys().any(|one| others().any(|other| one != other && meet(one, other)))
    })
}

/// Returns why nothing moves; `None` if something does. A device-resident body moves if it was
/// given two ends.
fn resting(bodies: &[Body]) -> Option<Note> {
    let moves = |body: &Body| {
        let [start, end] = body.poses();
        let is_posed = body.kind() == BodyKind::Rigid && start != end;
        let has_end = || body.positions_t1().is_some_and(|t1| t1 != body.positions_t0());
        if body.is_device_resident() { body.is_moving() } else { is_posed || has_end() }
    };
    match (bodies.iter().any(moves), bodies.iter().any(Body::is_moving)) {
        (true, _) => None,
        (false, true) => Some(Note::SameFrames),
        (false, false) => Some(Note::OneFrame),
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Note::File { text } => f.write_str(text),
            Note::OneFrame => write!(
                f,
                "nothing moves: there is one frame of every body, or two equal poses; give positions or poses for the end of the step"
            ),
            Note::SameFrames => write!(f, "nothing moves: both frames are the same"),
            Note::NoTwoBodies => {
                write!(f, "no two bodies may meet: give a second one, or filters that allow a pair")
            }
            Note::StartsCrossing { pairs } => {
                let meet = counted(*pairs, "triangle pair meets", "triangle pairs meet");
                write!(
                    f,
                    "{meet} at the start of the step already: no step is free of contact; a discrete query lists them"
                )
            }
            Note::ContactAtStart => {
                write!(f, "in contact at the start of the step, or undecided there: no step can be taken")
            }
            Note::Coincident { vertices } => {
                let share = counted(*vertices, "vertex shares its", "vertices share their");
                write!(f, "{share} place with another: contacts at seams are listed too; --weld merges them")
            }
        }
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Note {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}
