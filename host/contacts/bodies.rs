//! Pairs of bodies.

use crate::scene::BodyId;

/// Two bodies that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct BodyPair {
    /// The bodies, the smaller number first.
    pub bodies: [BodyId; 2],
}

impl BodyPair {
    /// Bytes of the row in a hash.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.bodies.iter().flat_map(|body| body.0.to_le_bytes()).collect()
    }
}
