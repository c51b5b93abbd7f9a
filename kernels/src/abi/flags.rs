//! Flags of argument blocks: sets of bits that have names. A kernel's flags are no other kernel's.

use bytemuck::{Pod, Zeroable};

/// Declares sets of flags: each flag is the next bit.
macro_rules! flags {
    ($($(#[$doc:meta])* $name:ident { $($(#[$fdoc:meta])* $flag:ident,)* })*) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
        #[repr(transparent)]
        pub struct $name(u32);
        impl $name {
            /// None of them.
            pub const NONE: Self = $name(0);
            flags!(@each $name 1; $($(#[$fdoc])* $flag,)*);

            /// Whether the flag is set; of several flags, whether any is.
            #[inline(always)]
            pub const fn has(self, flag: Self) -> bool {
                self.0 & flag.0 != 0
            }
            /// These if `condition`, else none.
            #[must_use]
            pub const fn when(self, condition: bool) -> Self {
                if condition { self } else { Self::NONE }
            }
        }
        impl core::ops::BitOr for $name {
            type Output = Self;
            fn bitor(self, other: Self) -> Self {
                $name(self.0 | other.0)
            }
        }
    )* };
    (@each $name:ident $bit:expr;) => {};
    (@each $name:ident $bit:expr; $(#[$doc:meta])* $flag:ident, $($rest:tt)*) => {
        $(#[$doc])*
        pub const $flag: Self = $name($bit);
        flags!(@each $name $bit << 1; $($rest)*);
    };
}

flags! {
    /// Flags of [`MortonArgs`](super::MortonArgs).
    MortonFlags {
        /// Along Hilbert's curve, not Morton's: neighbours along it are neighbours in space.
        HILBERT,
        /// Outsized triangles behind all others of their body.
        APART,
    }
    /// Flags of [`TouchingArgs`](super::TouchingArgs).
    TouchingFlags {
        /// Only the first pair of bodies is wanted.
        FIRST,
        /// The first pair of triangles of each pair of bodies is wanted, not a flag.
        KEYS,
    }
    /// Flags of every traversal: [`TraverseArgs`](super::TraverseArgs),
    /// [`PairArgs`](super::PairArgs).
    ///
    /// ```
    /// use nearmiss_kernels::abi::TraverseFlags;
    /// let flags = TraverseFlags::GRAFTED | TraverseFlags::FRONT.when(false);
    /// assert!(flags.has(TraverseFlags::GRAFTED) && !flags.has(TraverseFlags::FRONT));
    /// ```
    /// Bits without a name, and another kernel's flags, do not compile:
    /// ```compile_fail,E0308
    /// use nearmiss_kernels::abi::{QueueFlags, TraverseFlags};
    /// let flags: TraverseFlags = QueueFlags::START;
    /// ```
    /// ```compile_fail,E0423
    /// let flags = nearmiss_kernels::abi::TraverseFlags(1);
    /// ```
    TraverseFlags {
        /// Pairs that share a vertex are emitted too.
        KEEP_ADJACENT,
        /// The root has two trees below it: a fixed one, whose own pairs are not wanted, and a
        /// moving one.
        GRAFTED,
        /// Traversals by pairs of nodes also list the pairs at which the descent ends.
        FRONT,
    }
    /// Flags of a round of queues: [`QueueArgs`](super::QueueArgs).
    QueueFlags {
        /// The first block begins with the pair of roots; no units are read.
        START,
        /// Units left after this round count as unfinished.
        LAST,
    }
    /// Flags of a pass over a front: [`FrontArgs`](super::FrontArgs).
    FrontFlags {
        /// Pairs are replaced by an ancestor that is apart.
        PRUNE,
    }
    /// Flags of queues with stealing: [`StealArgs`](super::StealArgs).
    StealFlags {
        /// Blocks offer units even if no block is idle.
        EAGER,
    }
    /// Flags of tests of triangle pairs: [`DiscreteArgs`](super::DiscreteArgs).
    DiscreteFlags {
        /// Pairs that share a vertex are tested beyond it.
        KEEP_ADJACENT,
        /// Only pairs that cross are listed, none that touch.
        ONLY_CROSSING,
    }
    /// Flags of a rung: [`RungArgs`](super::RungArgs).
    RungFlags {
        /// `narrow_isolate` accepts a contact with any bounds of its time; `narrow_settle` leaves no
        /// pair.
        EVERYTHING,
        /// `narrow_isolate` in f64 lists the pairs to settle, if its list is long.
        DEFERS,
        /// It marks that it has found a time, for an earliest query.
        MARKS,
        /// It does nothing if the rung before it has marked a time.
        UNLESS_MARKED,
    }
}
