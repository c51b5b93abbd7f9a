//! The sizes of work queues.

use crate::error::Error;
use nearmiss_kernels::abi::control::{MOST_BLOCKS, MOST_PLACES};
use nearmiss_kernels::queue::worker::ROOM;

/// How queues are evened between launches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Balance {
    /// The paper's: a kernel copies units from segment to segment; the host looks after each round whether any are left.
    Copy,
    /// What is left goes to one list, and each queue takes its share of it: nothing is copied, no host in between.
    View,
}

/// Work queues that are evened between launches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct QueueShape {
    /// Queues, a block each; `None` for as many as the machine runs at once.
    pub cores: Option<u32>,
    /// Units that a queue holds on chip, up to [`QueueShape::ROOM`].
    pub local: u32,
    /// Units that a queue takes at a time from its share of what was left.
    pub take: u32,
    /// Units of a queue that device memory has room for at first. Too few are not an error: it grows.
    pub segment: u32,
    /// A block leaves when more than this share of all has run dry: numerator, denominator.
    pub idle: (u32, u32),
    /// Steps that a block takes before it heeds those that ran dry: a launch must be worth its cost.
    pub patience: u32,
    /// How queues are evened.
    pub balance: Balance,
}

/// Work queues that help each other out within one launch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StealShape {
    /// Queues, a block each; `None` for as many as the machine runs at once.
    pub cores: Option<u32>,
    /// Units that a queue holds on chip, up to [`QueueShape::ROOM`].
    pub local: u32,
    /// Units of a queue that device memory has room for at first. Too few are not an error: it grows.
    pub segment: u32,
    /// Chunks of at most 64 units that may be offered in one launch, up to [`StealShape::MOST_POOL`]; when they have been,
    /// blocks keep what they have. `None` for 32 a queue.
    pub pool: Option<u32>,
    /// How often a block without work looks for some, while others have work, before it leaves.
    pub tries: u32,
    /// Whether units are offered even when no block looks for some.
    pub eager: bool,
}

/// A front of pairs of nodes, kept from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FrontShape {
    /// The queues by which pairs that meet anew go deeper. Their units come from one list, whatever `balance` says.
    pub queue: QueueShape,
    /// Every so many frames pairs that are apart give way to an ancestor that is; 0 for never. A test more for each pair,
    /// and a shorter front.
    pub prune_every: u32,
    /// Whether the front is given up while it costs more overlap tests than a descent from the roots.
    pub drop: bool,
}

impl FrontShape {
    /// Native queues; pruned every fourth frame, given up where it does not pay.
    pub const fn native() -> FrontShape {
        FrontShape { queue: QueueShape::native(), prune_every: 4, drop: true }
    }
}

impl QueueShape {
    /// Units that a queue can hold on chip.
    pub const ROOM: u32 = ROOM;

    /// The paper's machine with the constants of the released program. The paper gives each core a queue and balances
    /// them; its machine has 30 cores. The released program runs 128 queues of 64 threads, about four a core, with room
    /// for 600 units each: 4,800 B, of which the 16 KB of shared memory of a core hold three, with other state besides.
    /// So not all 128 are on the machine at once: those that are not start when others leave.
    pub const fn gtx285() -> QueueShape {
        QueueShape {
            cores: Some(128),
            local: 600,
            take: 192,
            segment: 50_000,
            idle: (2, 3),
            patience: 0,
            balance: Balance::Copy,
        }
    }

    /// As many queues as the machine runs at once, without a copy and without the host.
    pub const fn native() -> QueueShape {
        QueueShape {
            cores: None,
            local: ROOM,
            take: 64,
            segment: 256,
            idle: (1, 2),
            patience: 8,
            balance: Balance::View,
        }
    }

    /// Whether the sizes are possible.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub fn check(&self) -> Result<(), Error> {
        sizes(self.cores, self.local, self.segment)?;
        if self.take == 0 || self.idle.1 == 0 || self.idle.0 > self.idle.1 {
            return Err(Error::InvalidArgument {
                what: format!("queues that take {} units, idle share {:?}", self.take, self.idle),
                advice: "take at least 1, and give the idle share as a fraction from 0 to 1".into(),
            });
        }
        Ok(())
    }
}

impl StealShape {
    /// Chunks that a pool can hold.
    pub const MOST_POOL: u32 = MOST_PLACES;

    /// As many queues as the machine runs at once.
    pub const fn native() -> StealShape {
        StealShape { cores: None, local: ROOM, segment: 256, pool: None, tries: 1 << 14, eager: false }
    }

    /// Whether the sizes are possible.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub fn check(&self) -> Result<(), Error> {
        sizes(self.cores, self.local, self.segment)?;
        match self.pool {
            Some(pool) if pool > Self::MOST_POOL => Err(Error::InvalidArgument {
                what: format!("a pool of {pool} chunks"),
                advice: format!("use at most {}", Self::MOST_POOL),
            }),
            _ => Ok(()),
        }
    }
}

/// The most queues: more than any machine runs at once.
const MOST_CORES: u32 = MOST_BLOCKS;

fn sizes(cores: Option<u32>, local: u32, segment: u32) -> Result<(), Error> {
    let fits =
        cores.is_none_or(|n| (1..=MOST_CORES).contains(&n)) && (1..=ROOM).contains(&local) && segment > 0;
    if fits {
        return Ok(());
    }
    Err(Error::InvalidArgument {
        what: format!("{} queues of {local} units on chip and {segment} behind", cores.unwrap_or(0)),
        advice: format!("use 1 to {MOST_CORES} queues of 1 to {ROOM} units"),
    })
}
