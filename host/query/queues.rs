//! Sizes of work queues.

use crate::error::Error;
use nearmiss_kernels::abi::control::{MOST_BLOCKS, MOST_PLACES};
use nearmiss_kernels::queue::worker::ROOM;

/// Balancing of queues between launches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Balance {
    /// As in the paper: a kernel copies units from segment to segment. After each round the host
    /// checks whether any are left.
    Copy,
    /// Units that are left go to one list, and each queue takes its share. It needs neither a copy
    /// nor the host.
    View,
}

/// Work queues that are balanced between launches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct QueueShape {
    /// Number of queues, one per block; `None` for as many as the machine runs at once.
    pub cores: Option<u32>,
    /// Units that a queue holds on chip, up to [`QueueShape::ROOM`].
    pub local: u32,
    /// Units that a queue takes at a time from its share of the list.
    pub take: u32,
    /// Initial capacity of a queue in device memory, in units. It grows when it is too small.
    pub segment: u32,
    /// Share of empty queues above which a block leaves, as numerator and denominator.
    pub idle: (u32, u32),
    /// Steps that a block takes before it counts empty queues, so that a launch is worth its cost.
    pub patience: u32,
    /// Balancing between launches.
    pub balance: Balance,
}

/// Work queues that share work within one launch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StealShape {
    /// Number of queues, one per block; `None` for as many as the machine runs at once.
    pub cores: Option<u32>,
    /// Units that a queue holds on chip, up to [`QueueShape::ROOM`].
    pub local: u32,
    /// Initial capacity of a queue in device memory, in units. It grows when it is too small.
    pub segment: u32,
    /// Most chunks that may be offered in one launch, up to [`StealShape::MOST_POOL`]; `None` for
    /// 32 a queue. A chunk has at most 64 units. After the last one, blocks keep their units.
    pub pool: Option<u32>,
    /// Attempts of a block without work to get some, while others have work, before it leaves.
    pub tries: u32,
    /// Whether units are offered even if no block is without work.
    pub eager: bool,
}

/// A front of pairs of nodes, kept from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FrontShape {
    /// Queues that descend from pairs that begin to overlap. Their units come from one list, for
    /// any `balance`.
    pub queue: QueueShape,
    /// Frames between prunings; 0 for never. Pruning replaces pairs that are apart by an ancestor
    /// that is apart too. It costs one test per pair, and makes the front shorter.
    pub prune_every: u32,
    /// Whether the front is dropped while it costs more overlap tests than a descent from the
    /// roots.
    pub drop: bool,
}

impl FrontShape {
    /// Returns a front with native queues, pruned every fourth frame, and dropped when a descent
    /// from the roots costs less.
    pub const fn native() -> FrontShape {
        FrontShape { queue: QueueShape::native(), prune_every: 4, drop: true }
    }
}

impl QueueShape {
    /// Most units that a queue can hold on chip.
    pub const ROOM: u32 = ROOM;

    /// Returns the paper's queues, with the constants of the released program.
    ///
    /// In the paper each core has a queue, and its machine has 30 cores. The released program runs
    /// 128 queues of 64 threads, about four a core, of 600 units each. A queue has 4,800 B. The 16
    /// KB of shared memory of a core hold three of them, with other state. So not all 128 run at
    /// once: the others start when some have left.
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

    /// Returns as many queues as the machine runs at once, balanced without a copy and without the
    /// host.
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

    /// Checks that the sizes are possible.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub fn check(&self) -> Result<(), Error> {
        sizes(self.cores, self.local, self.segment)?;
        if self.take == 0 || self.idle.1 == 0 || self.idle.0 > self.idle.1 {
            return Err(Error::InvalidArgument {
                what: format!(
                    "work queues must take at least 1 unit and have an idle share from 0 to 1, got {} and \
                     {} of {}",
                    self.take, self.idle.0, self.idle.1
                ),
                advice: "change `take` or `idle`".into(),
            });
        }
        Ok(())
    }
}

impl StealShape {
    /// Most chunks that a pool can hold.
    pub const MOST_POOL: u32 = MOST_PLACES;

    /// Returns as many queues as the machine runs at once.
    pub const fn native() -> StealShape {
        StealShape { cores: None, local: ROOM, segment: 256, pool: None, tries: 1 << 14, eager: false }
    }

    /// Checks that the sizes are possible.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub fn check(&self) -> Result<(), Error> {
        sizes(self.cores, self.local, self.segment)?;
        match self.pool {
            Some(pool) if pool > Self::MOST_POOL => Err(Error::InvalidArgument {
                what: format!("pool must have at most {} chunks, got {pool}", Self::MOST_POOL),
                advice: "use a smaller pool, or leave it out".into(),
            }),
            _ => Ok(()),
        }
    }
}

/// Most queues, which is more than any machine runs at once.
const MOST_CORES: u32 = MOST_BLOCKS;

fn sizes(cores: Option<u32>, local: u32, segment: u32) -> Result<(), Error> {
    let fits =
        cores.is_none_or(|n| (1..=MOST_CORES).contains(&n)) && (1..=ROOM).contains(&local) && segment > 0;
    if fits {
        return Ok(());
    }
    let queues = cores.map_or_else(|| "as many as run at once".to_owned(), |cores| cores.to_string());
    Err(Error::InvalidArgument {
        what: format!(
            "sizes of work queues are impossible, got {local} units on chip, {segment} in memory, and \
             {queues} queues"
        ),
        advice: format!(
            "use 1 to {MOST_CORES} queues of 1 to {ROOM} units on chip, and at least 1 in memory"
        ),
    })
}
