//! The choice of a bounding volume, made from the list [`nearmiss_kernels::volumes`].

use super::{QueryKind, named};
use nearmiss_kernels::bv;
use nearmiss_kernels::entry::Kernels;

/// An action on the type of a volume that was chosen by name.
#[doc(hidden)]
pub trait WithVolume {
    /// Result of the action.
    type Out;
    /// Runs the action with the type `V`.
    fn with<V: Kernels>(self) -> Self::Out;
}

macro_rules! choices {
    ($($Volume:ident = $volume:literal [$($groups:ident)?], $about:literal;)*) => {
        named! {
            /// The bounding volume of each node.
            pub enum BoundingVolume {
                $(#[doc = $about] $Volume = $volume,)*
            }
        }

        impl BoundingVolume {
            /// Runs an action with the type of the volume.
            #[doc(hidden)]
            pub fn with<W: WithVolume>(self, what: W) -> W::Out {
                match self {
                    $(BoundingVolume::$Volume => what.with::<bv::$Volume>(),)*
                }
            }
        }
    };
}

nearmiss_kernels::volumes!(choices);

impl BoundingVolume {
    /// Returns the fastest volume on real scenes, as measured: see `docs/performance.md`. A box is
    /// enough at rest. In motion, boxes that move leave a third to a tenth of the pairs.
    pub fn default_for(kind: QueryKind) -> BoundingVolume {
        if kind.is_at_rest() { BoundingVolume::Aabb } else { BoundingVolume::Linear }
    }
}
