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
    /// Of [`MortonArgs`](super::MortonArgs).
    MortonFlags {
        /// Along Hilbert's curve, not Morton's: neighbours along it are neighbours in space.
        HILBERT,
        /// Outsized triangles behind all others of their body.
        APART,
    }
    /// What every traversal is told: [`TraverseArgs`](super::TraverseArgs),
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
        /// Below the root lie a tree that does not change, whose pairs nobody asks for, and one
        /// that does.
        GRAFTED,
        /// Of traversals by pairs of nodes: the pairs where the descent ends are listed too.
        FRONT,
    }
    /// What a round of queues is told: [`QueueArgs`](super::QueueArgs).
    QueueFlags {
        /// The first block begins with the pair of roots; no units are read.
        START,
        /// What is left then is counted as unfinished.
        LAST,
    }
    /// What a pass over a front is told: [`FrontArgs`](super::FrontArgs).
    FrontFlags {
        /// Pairs give way to an ancestor that is apart.
        PRUNE,
    }
    /// What queues that help each other out are told: [`StealArgs`](super::StealArgs).
    StealFlags {
        /// Units are offered whether or not a block looks for some.
        EAGER,
    }
    /// What tests of triangle pairs are told: [`DiscreteArgs`](super::DiscreteArgs).
    DiscreteFlags {
        /// Pairs that share a vertex are asked whether they meet beyond it.
        KEEP_ADJACENT,
    }
    /// What a rung is told: [`RungArgs`](super::RungArgs).
    RungFlags {
        /// Of `narrow_isolate`, a contact is one however well its time is known; of
        /// `narrow_settle`, nothing is left to a next rung.
        EVERYTHING,
    }
}
