//! A front of pairs of nodes, kept from frame to frame.

use super::queue::Queue;
use super::{Walk, WalkContext};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::precision::Precision;
use crate::query::FrontShape;
use nearmiss_kernels::abi::{FrontArgs, FrontFlags, Pair, TraverseFlags, counter};
use nearmiss_kernels::entry::{self, Kernels};

/// Initial capacity, in pairs of the front per triangle. Cloth at rest has 30, cloth swept over a
/// step 100.
const PAIRS_A_TRIANGLE: usize = 48;
/// Number of positions without a front, after a new front did not pay.
const REST: u32 = 8;

/// The walk of [`crate::query::Traversal::Front`].
pub struct Front {
    device: Device,
    shape: FrontShape,
    queue: Queue,
    /// Pairs at which the last descent ended.
    front: List<Pair>,
    /// Pairs at which this descent ends.
    ends: List<Pair>,
    state: State,
    /// Positions since the front was last pruned.
    age: u32,
    /// Number of overlap tests of the last descent from the roots.
    from_roots: u64,
    /// Whether the last frame dropped the front, or ran without it.
    dropped: bool,
}

/// State left by the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// No front: descend from the roots and list the ends.
    New,
    /// A front of `count` pairs; `fresh` if the last frame made it from the roots.
    Kept { count: u32, fresh: bool },
    /// The front does not pay: descend from the roots for so many more frames.
    Resting(u32),
}

impl Front {
    /// Allocates fronts over trees of `triangles` triangles.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<V: Kernels>(device: &Device, shape: FrontShape, triangles: usize) -> Result<Self, Error> {
        let list = || Self::list(device, PAIRS_A_TRIANGLE * triangles);
        let queue = crate::query::QueueShape { balance: crate::query::Balance::View, ..shape.queue };
        Ok(Front {
            device: device.clone(),
            shape,
            queue: Queue::new::<V>(device, queue)?,
            front: list()?,
            ends: list()?,
            state: State::New,
            age: 0,
            from_roots: 0,
            dropped: false,
        })
    }

    fn list(device: &Device, capacity: usize) -> Result<List<Pair>, Error> {
        List::new(device, "pairs of the front", counter::ENDS, capacity)
    }

    /// Returns whether this frame prunes. Volumes whose tests do not nest cannot.
    fn prunes<V: Kernels>(&self) -> bool {
        V::NESTS && self.shape.prune_every > 0 && self.age + 1 >= self.shape.prune_every
    }
}

impl<R: Precision, V: Kernels> Walk<R, V> for Front {
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        if let State::Resting(_) = self.state {
            return self.queue.launch(given);
        }
        let flags = given.flags | TraverseFlags::FRONT;
        let given = WalkContext { ends: self.ends.output(given.counters), flags, ..*given };
        let State::Kept { count, .. } = self.state else { return self.queue.launch(&given) };
        let blocks = given.device.blocks_striding::<entry::traverse_front<V>>(count as usize);
        let (front, flags) = (self.front.entries(), FrontFlags::PRUNE.when(self.prunes::<V>()));
        self.queue.launch_from(&given, &|units| {
            let args = FrontArgs {
                to: given.pair_args(1),
                front,
                units,
                pair_parents: given.forest.tree.pair_parents.span(),
                count,
                flags,
            };
            launch::blocks::<entry::traverse_front<V>>(given.device, blocks, &args)
        })
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let mut lists = Walk::<R, V>::lists(&mut self.queue);
        lists.push(&mut self.ends);
        lists
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        Walk::<R, V>::finish(&mut self.queue, counters)?;
        // A unit is a test of a pair of siblings against a node.
        let tests = counters[counter::FRONT_TESTS] + 2 * counters[counter::STEPS];
        // Lists are no longer than 32 bits can index.
        let count = counters[counter::ENDS] as u32;
        let pruned = self.prunes::<V>();
        let rested = matches!(self.state, State::Resting(_));
        let had = matches!(self.state, State::Kept { .. });
        self.state = match self.state {
            State::Resting(0 | 1) => State::New,
            State::Resting(frames) => State::Resting(frames - 1),
            State::New => {
                self.from_roots = tests;
                self.age = 0;
                State::Kept { count, fresh: true }
            }
            State::Kept { fresh, .. } if self.shape.drop && tests > self.from_roots => {
                if fresh {
                    State::Resting(REST)
                } else {
                    State::New
                }
            }
            State::Kept { .. } => {
                self.age = if pruned { 0 } else { self.age + 1 };
                State::Kept { count, fresh: false }
            }
        };
        let kept = matches!(self.state, State::Kept { .. });
        self.dropped = rested || had && !kept;
        if kept {
            std::mem::swap(&mut self.front, &mut self.ends);
            // The next frame will need as much as this one: so no frame reruns for that.
            if self.ends.capacity() < self.front.capacity() {
                self.ends = Self::list(&self.device, self.front.capacity())?;
            }
        }
        Ok(())
    }

    fn without_host(&self) -> Result<(), &'static str> {
        self.queue.is_planned(matches!(self.state, State::Kept { .. }))
    }

    fn front_dropped(&self) -> bool {
        self.dropped
    }

    fn invalidate(&mut self) {
        self.state = State::New;
    }
}
