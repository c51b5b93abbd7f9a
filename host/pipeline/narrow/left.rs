//! The lists between the rungs of a certified solver: names, counters, memory.

use super::Capacities;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use bytemuck::Pod;
use nearmiss_kernels::abi::{Begun, Counter, Pair, counter};

/// Lists of both kinds: a name for comparisons of machines, a name for errors, and the counter.
pub type OfKinds = [(&'static str, &'static str, Counter); 2];

/// The lists of a solver.
pub struct Names {
    /// Those that rungs leave.
    pub left: [OfKinds; 2],
    /// Those of a query of what approaches, in the order of [`Approaching`].
    approaching: [OfKinds; 5],
}

/// The lists of a solver that is alone, or of pairs with a thickness.
pub const USUAL: Names = Names {
    left: [
        [
            ("narrow: vf for f64", "vertex/face pairs for f64", counter::VF_ESCALATED),
            ("narrow: ee for f64", "edge/edge pairs for f64", counter::EE_ESCALATED),
        ],
        HARD,
    ],
    approaching: [
        [
            (
                "narrow: vf beyond at the start",
                "vertex/face pairs beyond at the start",
                counter::VF_BEGIN_BEYOND,
            ),
            (
                "narrow: ee beyond at the start",
                "edge/edge pairs beyond at the start",
                counter::EE_BEGIN_BEYOND,
            ),
        ],
        [
            ("narrow: vf near at the start", "vertex/face pairs near at the start", counter::VF_BEGIN_NEAR),
            ("narrow: ee near at the start", "edge/edge pairs near at the start", counter::EE_BEGIN_NEAR),
        ],
        [
            ("narrow: vf for integers", "vertex/face pairs for integers", counter::VF_UNBOUNDED),
            ("narrow: ee for integers", "edge/edge pairs for integers", counter::EE_UNBOUNDED),
        ],
        [
            ("narrow: vf that may approach", "vertex/face pairs that may approach", counter::VF_APPROACHING),
            ("narrow: ee that may approach", "edge/edge pairs that may approach", counter::EE_APPROACHING),
        ],
        [
            ("narrow: vf that advance", "vertex/face pairs that advance", counter::VF_ADVANCING),
            ("narrow: ee that advance", "edge/edge pairs that advance", counter::EE_ADVANCING),
        ],
    ],
};

/// The lists of the solver of pairs without a thickness, next to that of pairs with one. A separation
/// has no pairs for slices and none to settle: these lists are the same.
pub const THIN: Names = Names {
    left: [
        [
            ("narrow: thin vf for f64", "thin vertex/face pairs for f64", counter::VF_THIN_ESCALATED),
            ("narrow: thin ee for f64", "thin edge/edge pairs for f64", counter::EE_THIN_ESCALATED),
        ],
        HARD,
    ],
    approaching: [
        [
            ("narrow: thin vf beyond", "thin vertex/face pairs beyond at the start", counter::VF_THIN_BEYOND),
            ("narrow: thin ee beyond", "thin edge/edge pairs beyond at the start", counter::EE_THIN_BEYOND),
        ],
        [
            ("narrow: thin vf near", "thin vertex/face pairs near at the start", counter::VF_THIN_NEAR),
            ("narrow: thin ee near", "thin edge/edge pairs near at the start", counter::EE_THIN_NEAR),
        ],
        [
            (
                "narrow: thin vf for integers",
                "thin vertex/face pairs for integers",
                counter::VF_THIN_UNBOUNDED,
            ),
            ("narrow: thin ee for integers", "thin edge/edge pairs for integers", counter::EE_THIN_UNBOUNDED),
        ],
        [
            (
                "narrow: thin vf that may approach",
                "thin vertex/face pairs that may approach",
                counter::VF_THIN_APPROACHING,
            ),
            (
                "narrow: thin ee that may approach",
                "thin edge/edge pairs that may approach",
                counter::EE_THIN_APPROACHING,
            ),
        ],
        [
            (
                "narrow: thin vf that advance",
                "thin vertex/face pairs that advance",
                counter::VF_THIN_ADVANCING,
            ),
            ("narrow: thin ee that advance", "thin edge/edge pairs that advance", counter::EE_THIN_ADVANCING),
        ],
    ],
};

/// Pairs for slices.
const HARD: OfKinds = [
    ("narrow: vf for slices", "vertex/face pairs for slices", counter::VF_HARD),
    ("narrow: ee for slices", "edge/edge pairs for slices", counter::EE_HARD),
];

/// The lists of pairs to settle. How many there are depends on the machine, so none is compared.
pub const ASKED: OfKinds = [
    ("", "vertex/face pairs to settle", counter::VF_ASKED),
    ("", "edge/edge pairs to settle", counter::EE_ASKED),
];

/// Pairs that a rung leaves: vertex/face, edge/edge.
pub enum Left {
    /// To isolation, to slices, or to signs.
    Pairs([List<Pair>; 2]),
    /// With a separation: with times that are proven.
    Begun([List<Begun>; 2]),
}

impl Left {
    /// Returns how many pairs both have room for.
    pub fn capacity(&self) -> usize {
        match self {
            Left::Pairs([vf, ee]) => vf.capacity() + ee.capacity(),
            Left::Begun([vf, ee]) => vf.capacity() + ee.capacity(),
        }
    }

    /// Returns the lists.
    pub fn growable(&mut self) -> [&mut dyn GrowableOutput; 2] {
        match self {
            Left::Pairs([vf, ee]) => [vf, ee],
            Left::Begun([vf, ee]) => [vf, ee],
        }
    }

    /// Returns the lists, with these names.
    pub fn named(&self, [of_vf, of_ee]: [&'static str; 2]) -> [Named<'_>; 2] {
        match self {
            Left::Pairs([vf, ee]) => [named(of_vf, vf), named(of_ee, ee)],
            Left::Begun([vf, ee]) => [named(of_vf, vf), named(of_ee, ee)],
        }
    }
}

/// The lists of a query of what approaches.
pub struct Approaching {
    /// Pairs beyond the separation at the start: for the solver.
    pub beyond: Left,
    /// Pairs that may be near at the start.
    pub near: Left,
    /// Pairs that bounds of errors do not decide.
    pub unbounded: Left,
    /// Near pairs that are left for the solver.
    pub approaching: Left,
    /// Pairs whose distance may fall later.
    pub advancing: Left,
}

impl Approaching {
    /// Allocates the lists.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, names: &Names, capacities: &Capacities) -> Result<Self, Error> {
        let [beyond, near, unbounded, approaching, advancing] = names.approaching;
        let pairs = |names, capacity| lists(device, names, capacity).map(Left::Pairs);
        Ok(Approaching {
            beyond: pairs(beyond, capacities.survivors)?,
            near: pairs(near, capacities.near)?,
            unbounded: pairs(unbounded, capacities.near)?,
            approaching: pairs(approaching, capacities.near)?,
            advancing: lists(device, advancing, capacities.near).map(Left::Begun)?,
        })
    }

    /// Returns the lists.
    pub fn growable(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        let Approaching { beyond, near, unbounded, approaching, advancing } = self;
        [beyond, near, unbounded, approaching, advancing].into_iter().flat_map(Left::growable)
    }

    /// Returns the lists, with names.
    pub fn named(&self, names: &Names) -> impl Iterator<Item = Named<'_>> {
        let Approaching { beyond, near, unbounded, approaching, advancing } = self;
        let all = [beyond, near, unbounded, approaching, advancing].into_iter().zip(names.approaching);
        all.flat_map(|(left, names)| left.named(names.map(|(name, ..)| name)))
    }
}

/// Allocates lists of both kinds.
///
/// # Errors
/// Device errors.
pub fn lists<T: Pod>(device: &Device, names: OfKinds, capacity: [usize; 2]) -> Result<[List<T>; 2], Error> {
    let [(_, vf, vf_counter), (_, ee, ee_counter)] = names;
    Ok([List::new(device, vf, vf_counter, capacity[0])?, List::new(device, ee, ee_counter, capacity[1])?])
}

/// Returns lists of both kinds, with their names for comparisons.
pub fn named_lists<T: Pod + Ord + Send>(
    lists: &[List<T>; 2],
    names: OfKinds,
) -> impl Iterator<Item = Named<'_>> {
    lists.iter().zip(names).map(|(list, (name, ..))| named(name, list))
}
