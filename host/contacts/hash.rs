//! Hash of an answer.

use super::{Contacts, Kind, Rows};
use crate::scene::BodyId;

impl Kind {
    /// Number of the kind in hashes. Edges keep the 2 of the first recorded hashes, so that those
    /// stay comparable.
    pub(super) fn in_hash(self) -> u8 {
        match self {
            Kind::Vf => 0,
            Kind::Ee => 2,
            Kind::Ev => 3,
            Kind::Vv => 4,
        }
    }
}

impl Contacts {
    /// xxh3 over the canonical answer, little-endian: equal answers have equal hashes on every
    /// machine. A contact adds its kind, status, indices and times. A near pair adds its squared
    /// distance and weights instead of times. The nearest triangles add their distance, weights and
    /// points. A pair of bodies adds their numbers. Bodies come first in each row. They are left out if all rows are within body 0, or
    /// all are between bodies 0 and 1.
    pub fn hash(&self) -> u64 {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        match &self.rows {
            Rows::Pairs(pairs) => {
                let has_bodies = need_bodies(pairs.iter().map(|pair| pair.bodies));
                for pair in pairs {
                    let bodies = pair.bodies.iter().map(|body| body.0).filter(|_| has_bodies);
                    bodies.chain(pair.triangles).for_each(|i| hash.update(&i.to_le_bytes()));
                }
            }
            Rows::Contacts(contacts) => {
                let has_bodies = need_bodies(contacts.iter().map(|contact| contact.bodies));
                for c in contacts {
                    if has_bodies {
                        c.bodies.iter().for_each(|body| hash.update(&body.0.to_le_bytes()));
                    }
                    hash.update(&[c.kind.in_hash(), c.status as u8]);
                    hash.update(&c.feature_a.to_le_bytes());
                    hash.update(&c.feature_b.to_le_bytes());
                    hash.update(&c.toi.to_le_bytes());
                    hash.update(&c.toi_upper.to_le_bytes());
                }
            }
            Rows::Near(near) => {
                let has_bodies = need_bodies(near.iter().map(|pair| pair.bodies));
                for pair in near {
                    if has_bodies {
                        pair.bodies.iter().for_each(|body| hash.update(&body.0.to_le_bytes()));
                    }
                    hash.update(&pair.bytes());
                }
            }
            Rows::Distance(nearest) => nearest.iter().for_each(|nearest| hash.update(&nearest.bytes())),
            Rows::BodyPairs(pairs) => pairs.iter().for_each(|pair| hash.update(&pair.bytes())),
            Rows::BodyDistances(all) => all.iter().for_each(|nearest| hash.update(&nearest.bytes())),
            Rows::Earliest(toi) => toi.iter().for_each(|toi| hash.update(&toi.to_le_bytes())),
        }
        hash.digest()
    }
}

/// Whether rows need their bodies: not all are within body 0, nor all between bodies 0 and 1.
fn need_bodies(mut bodies: impl Iterator<Item = [BodyId; 2]>) -> bool {
    let first = bodies.next().unwrap_or_default();
    let plain = [0, 1].map(|second| [BodyId(0), BodyId(second)]);
    !plain.contains(&first) || bodies.any(|other| other != first)
}
