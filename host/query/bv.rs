//! The choice of a bounding volume: made of the list of volumes, [`nearmiss_kernels::volumes`].

use super::{QueryKind, named};
use nearmiss_kernels::bv;
use nearmiss_kernels::entry::Kernels;

/// What is done with a volume that was chosen by name.
#[doc(hidden)]
pub trait WithVolume {
    /// What comes of it.
    type Out;
    /// Does it, with that type.
    fn with<V: Kernels>(self) -> Self::Out;
}

macro_rules! choices {
    ($($Volume:ident = $volume:literal [$($groups:ident)?], $about:literal;)*) => {
        named! {
            /// The bounding volume of each node.
            pub enum Bv {
                $(#[doc = $about] $Volume = $volume,)*
            }
        }

        impl Bv {
            /// Does something with the type that it names.
            #[doc(hidden)]
            pub fn with<W: WithVolume>(self, what: W) -> W::Out {
                match self {
                    $(Bv::$Volume => what.with::<bv::$Volume>(),)*
                }
            }
        }
    };
}

nearmiss_kernels::volumes!(choices);

impl Bv {
    /// The fastest volume that the real scenes have (measured, `docs/performance.md`): what stands still needs no more
    /// than a box; of what moves, boxes that move with it let a third to a tenth of the pairs through.
    pub fn default_for(kind: QueryKind) -> Bv {
        if kind.is_at_rest() { Bv::Aabb } else { Bv::Linear }
    }
}
