//! Rows of a rank: those that it owns, in numbers of whole bodies; and rows in messages.

use crate::local::{LocalBody, Names, Owner};
use bytemuck::{Pod, Zeroable};
use nearmiss::Contact;
use nearmiss::contacts::{Closest, Kind, NearPair, Status, TrianglePair};
use nearmiss::scene::{BodyId, Scene};

/// Which rows a rank keeps; a test plants a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// Rows of which this rank owns a feature, and has the triangle that owns the other.
    Owned,
    /// All rows.
    All,
}

impl Keep {
    fn keeps(self, owners: [Owner; 2]) -> bool {
        self == Keep::All || owners.contains(&Owner::Own) && !owners.contains(&Owner::Absent)
    }
}

/// A row that names two features.
pub(crate) trait Row: Copy {
    /// The row in a message.
    type Packed: Pod;

    /// The features of a row.
    fn names<'a>(&self, bodies: &'a [LocalBody]) -> [&'a Names; 2];
    /// Their numbers.
    fn features(&mut self) -> [&mut u32; 2];
    /// The canonical order of rows.
    fn key(&self) -> (u8, [(BodyId, u32); 2]);
    fn pack(&self) -> Self::Packed;
    /// Returns a row of a message; `None` if the scene lacks its bodies.
    fn unpack(packed: &Self::Packed, scene: &Scene) -> Option<Self>;
}

/// Returns the rows that a rank keeps, in numbers of whole bodies.
pub(crate) fn kept<T: Row>(rows: &[T], bodies: &[LocalBody], keep: Keep) -> Vec<T> {
    let own = |row: &T| {
        let mut row = *row;
        let names = row.names(bodies);
        let features = row.features();
        let at = [0, 1].map(|k| *features[k] as usize);
        let owners = [0, 1].map(|k| names[k].owners[at[k]]);
        for ((feature, names), at) in features.into_iter().zip(names).zip(at) {
            *feature = names.numbers[at];
        }
        keep.keeps(owners).then_some(row)
    };
    rows.iter().filter_map(own).collect()
}

fn of_kind(body: &LocalBody, kind: Kind, k: usize) -> &Names {
    match (kind, k) {
        (Kind::Vf, 1) => &body.faces,
        (Kind::Vf | Kind::Vv, _) | (Kind::Ev, 1) => &body.vertices,
        (Kind::Ee | Kind::Ev, _) => &body.edges,
    }
}

const KINDS: [Kind; 4] = [Kind::Vf, Kind::Ee, Kind::Ev, Kind::Vv];
const STATUSES: [Status; 3] = [Status::Unverified, Status::Certified, Status::Undecided];
const CLOSEST: [Closest; 4] =
    [Closest::VertexFace, Closest::VertexEdge, Closest::VertexVertex, Closest::EdgeEdge];

fn ids(bodies: [u32; 2], scene: &Scene) -> Option<[BodyId; 2]> {
    Some([scene.id(bodies[0] as usize)?, scene.id(bodies[1] as usize)?])
}

fn numbers(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|id| id.index() as u32)
}

/// Two triangles, in a message.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PackedPair {
    bodies: [u32; 2],
    triangles: [u32; 2],
}

impl Row for TrianglePair {
    type Packed = PackedPair;

    fn names<'a>(&self, bodies: &'a [LocalBody]) -> [&'a Names; 2] {
        self.bodies.map(|id| &bodies[id.index()].faces)
    }
    fn features(&mut self) -> [&mut u32; 2] {
        self.triangles.each_mut()
    }
    fn key(&self) -> (u8, [(BodyId, u32); 2]) {
        (0, [0, 1].map(|k| (self.bodies[k], self.triangles[k])))
    }
    fn pack(&self) -> PackedPair {
        PackedPair { bodies: numbers(self.bodies), triangles: self.triangles }
    }
    fn unpack(packed: &PackedPair, scene: &Scene) -> Option<TrianglePair> {
        Some(TrianglePair { bodies: ids(packed.bodies, scene)?, triangles: packed.triangles })
    }
}

/// A contact or a near pair, in a message.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PackedFeatures {
    bodies: [u32; 2],
    features: [u32; 2],
    numbers: [f64; 3],
    kind: u32,
    choice: u32,
}

/// Names, numbers and order of a row of two features.
macro_rules! of_features {
    () => {
        fn names<'a>(&self, bodies: &'a [LocalBody]) -> [&'a Names; 2] {
            [0, 1].map(|k| of_kind(&bodies[self.bodies[k].index()], self.kind, k))
        }
        fn features(&mut self) -> [&mut u32; 2] {
            [&mut self.feature_a, &mut self.feature_b]
        }
        fn key(&self) -> (u8, [(BodyId, u32); 2]) {
            (self.kind as u8, [(self.bodies[0], self.feature_a), (self.bodies[1], self.feature_b)])
        }
    };
}

impl Row for Contact {
    type Packed = PackedFeatures;

    of_features!();
    fn pack(&self) -> PackedFeatures {
        PackedFeatures {
            bodies: numbers(self.bodies),
            features: [self.feature_a, self.feature_b],
            numbers: [self.toi, self.toi_upper, 0.0],
            kind: self.kind as u32,
            choice: self.status as u32,
        }
    }
    fn unpack(packed: &PackedFeatures, scene: &Scene) -> Option<Contact> {
        let ([feature_a, feature_b], [toi, toi_upper, _]) = (packed.features, packed.numbers);
        Some(Contact {
            bodies: ids(packed.bodies, scene)?,
            feature_a,
            feature_b,
            toi,
            toi_upper,
            kind: *KINDS.get(packed.kind as usize)?,
            status: *STATUSES.get(packed.choice as usize)?,
        })
    }
}

impl Row for NearPair {
    type Packed = PackedFeatures;

    of_features!();
    fn pack(&self) -> PackedFeatures {
        PackedFeatures {
            bodies: numbers(self.bodies),
            features: [self.feature_a, self.feature_b],
            numbers: [self.squared_distance, self.at[0], self.at[1]],
            kind: self.kind as u32,
            choice: self.closest as u32,
        }
    }
    fn unpack(packed: &PackedFeatures, scene: &Scene) -> Option<NearPair> {
        let ([feature_a, feature_b], [squared_distance, x, y]) = (packed.features, packed.numbers);
        Some(NearPair {
            bodies: ids(packed.bodies, scene)?,
            feature_a,
            feature_b,
            squared_distance,
            at: [x, y],
            kind: *KINDS.get(packed.kind as usize)?,
            closest: *CLOSEST.get(packed.choice as usize)?,
        })
    }
}
