//! Rounds of work queues, until no unit is left.

use super::segments::Segments;
use super::{Walk, WalkContext, resident};
use crate::device::{Buffer, Device, Event};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::query::{Balance, QueueShape};
use nearmiss_kernels::abi::{BalanceArgs, Counter, Output, Pair, QueueArgs, QueueFlags, counter};
use nearmiss_kernels::entry::{self, Kernels};

/// Rounds that are launched between two reads by the host, while their number is unknown. Even: the
/// two copies of the list swap places each round.
const BATCH: u32 = 8;
/// Most rounds that can be launched without the host.
const MOST_ROUNDS: u32 = 128;
/// Rounds launched in addition to those that the last frames needed. A round without work costs a
/// launch.
const MORE_ROUNDS: u32 = 2;
/// Limit of idle blocks that no machine reaches: blocks of such a round work off all units that
/// have room on chip.
const NEVER_IDLE: u32 = u32::MAX;
/// Units that the first block makes of the roots before other blocks help.
const FIRST_UNITS: u32 = 64;

/// The walk of [`crate::query::Traversal::Queue`].
pub struct Queue {
    shape: QueueShape,
    cores: u32,
    units: Segments<2>,
    /// Copy: number of units of each queue, for each copy. View: number of units of each round; the
    /// second is unused.
    counts: [Buffer<u64>; 2],
    /// Number of queues that ran dry in each round.
    idle: Buffer<u64>,
    /// Copy: start of each queue's units among all.
    starts: Buffer<u64>,
    plan: Plan,
    balances: Vec<[Event; 2]>,
}

/// A round of a launch.
struct Round {
    round: u32,
    flags: QueueFlags,
    /// Blocks leave when more than so many have run dry.
    idle_limit: u32,
}

/// Number of rounds to launch, from the roots and from a seed; `None`: read the counters between
/// rounds.
#[derive(Default)]
struct Plan {
    rounds: [Option<u32>; 2],
    /// Least rounds of the next plan, because the last one was too short.
    least: [u32; 2],
    /// Whether the last launch began with a seed.
    seeded: bool,
}

impl Plan {
    /// Returns the number of rounds for the last kind of launch.
    fn of_last(&mut self) -> &mut Option<u32> {
        &mut self.rounds[usize::from(self.seeded)]
    }

    /// Plans the next launch of the last kind, after one with so many rounds that had work. A
    /// machine's rounds vary with the schedule: a plan shrinks by one a frame at most.
    fn learn(&mut self, worked: u64) {
        let least = std::mem::take(&mut self.least[usize::from(self.seeded)]);
        let before = self.of_last().unwrap_or(0).saturating_sub(1);
        let rounds = (worked + u64::from(MORE_ROUNDS)).max(before.max(least).into());
        *self.of_last() = (rounds <= MOST_ROUNDS.into()).then_some(rounds as u32);
    }
}

impl GrowableOutput for Plan {
    fn counter(&self) -> Counter {
        counter::UNFINISHED
    }
    fn room(&self) -> u64 {
        0
    }
    /// The next launch looks when it is done. The plan after it is twice as long as this one, since
    /// that launch may have a schedule that needs fewer rounds.
    fn grow(&mut self, _: &Device, counters: &Counts) -> Result<bool, Error> {
        let short = self.has_overflowed(counters);
        if short && let Some(rounds) = self.of_last().take() {
            self.least[usize::from(self.seeded)] = (2 * rounds).min(MOST_ROUNDS);
        }
        Ok(short)
    }
}

impl Queue {
    /// Allocates the queues.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<V: Kernels>(device: &Device, shape: QueueShape) -> Result<Self, Error> {
        let cores = shape.cores.unwrap_or_else(|| resident::<entry::traverse_queue<V>>(device));
        let (segments, counts, rounds) = match shape.balance {
            Balance::Copy => ((cores, shape.segment as u64), [cores, cores], 1),
            Balance::View => ((1, cores as u64 * shape.segment as u64), [MOST_ROUNDS + 1, 0], MOST_ROUNDS),
        };
        let words = |len: u32| device.buffer(len as usize);
        Ok(Queue {
            shape,
            cores,
            units: Segments::new(device, segments.0, segments.1)?,
            counts: [words(counts[0])?, words(counts[1])?],
            idle: words(rounds)?,
            starts: words(counts[1])?,
            plan: Plan::default(),
            balances: Vec::new(),
        })
    }

    /// How many blocks may have run dry before the others leave. At most the number of cores, since
    /// the share is at most 1.
    fn idle_limit(&self) -> u32 {
        let (numerator, denominator) = self.shape.idle;
        (u64::from(self.cores) * u64::from(numerator) / u64::from(denominator)) as u32
    }

    /// Launches a round that reads copy `from`.
    fn round<R: Precision, V: Kernels>(
        &self,
        given: &WalkContext<R, V>,
        from: usize,
        Round { round, flags, idle_limit }: Round,
    ) -> Result<(), Error> {
        let QueueShape { local, take, patience, balance, .. } = self.shape;
        let lanes = given.device.lanes::<entry::traverse_queue<V>>();
        let start = flags.has(QueueFlags::START);
        let copy = balance == Balance::Copy;
        // One list for all: only the first block runs, until there are units to share.
        let alone = start && !copy;
        let args = QueueArgs {
            to: given.pair_args(local),
            units: self.units.span(from),
            counts: self.counts[if copy { from % 2 } else { 0 }].span(),
            left: self.units.span(from + 1),
            left_counts: self.counts[if copy { (from + 1) % 2 } else { 0 }].span(),
            idle: self.idle.span(),
            round,
            segment: if copy { self.units.len() } else { 0 },
            take,
            idle_limit,
            patience,
            full: match (copy, alone) {
                (true, _) => local.saturating_sub(lanes),
                (false, true) => FIRST_UNITS.min(local / 2),
                (false, false) => u32::MAX,
            },
            flags,
            pad: 0,
        };
        launch::blocks::<entry::traverse_queue<V>>(given.device, if alone { 1 } else { self.cores }, &args)
    }

    /// Returns whether rounds from the roots, or from a seed, can run without the host. Copies need
    /// it between rounds. Views need it until a frame has found the number of rounds.
    ///
    /// # Errors
    /// The reason why not.
    pub fn is_planned(&self, seeded: bool) -> Result<(), &'static str> {
        match (self.shape.balance, self.plan.rounds[usize::from(seeded)]) {
            (Balance::Copy, _) => Err("traversal `queue` with balance `copy` needs the host between rounds"),
            (Balance::View, None) => Err("traversal `queue` needs too many rounds to plan them ahead"),
            (Balance::View, Some(_)) => Ok(()),
        }
    }

    /// Runs rounds with a balance between them, until the host reads that no unit is left.
    fn by_copy<R: Precision, V: Kernels>(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        let (mut from, mut flags) = (0, QueueFlags::START);
        loop {
            self.idle.clear()?;
            self.round(given, from, Round { round: 0, flags, idle_limit: self.idle_limit() })?;
            flags = QueueFlags::NONE;
            let to = 1 - from;
            let counts = self.counts[to].read(self.cores as usize)?;
            let most = counts.iter().max().copied().unwrap_or(0);
            // No unit is left. Or a segment was too short, as its counter shows: it grows, and the
            // walk restarts.
            if most == 0 || most > self.units.len() as u64 {
                return Ok(());
            }
            let nearly_full = most + self.shape.local as u64 > self.units.len() as u64;
            if nearly_full || counts.iter().any(|&count| count < self.shape.take as u64) {
                let before = given.device.event()?;
                launch::blocks::<entry::balance_copy>(
                    given.device,
                    1,
                    &BalanceArgs {
                        units: self.units.span(to),
                        counts: self.counts[to].span(),
                        starts: self.starts.span(),
                        even: self.units.span(from),
                        even_counts: self.counts[from].span(),
                        counters: given.counters,
                        cores: self.cores,
                        segment: self.units.len(),
                    },
                )?;
                self.balances.push([before, given.device.event()?]);
            } else {
                from = to;
            }
        }
    }

    /// Runs rounds that share one list: as many as planned, or until the host reads that no unit is
    /// left. They begin with the roots, or with the units that `seed` writes to the list and
    /// counts.
    fn by_view<R: Precision, V: Kernels>(
        &mut self,
        given: &WalkContext<R, V>,
        seed: Option<Seed>,
    ) -> Result<(), Error> {
        let first = QueueFlags::START.when(seed.is_none());
        let begin = |queue: &mut Self| -> Result<(), Error> {
            queue.counts[0].clear()?;
            queue.idle.clear()
        };
        begin(self)?;
        if let Some(seed) = seed {
            seed(Output::new(self.units.span(0), self.counts[0].span().part(0, 1)))?;
        }
        self.plan.seeded = seed.is_some();
        let idle_limit = self.idle_limit();
        if let Some(rounds) = *self.plan.of_last() {
            return (0..rounds).try_for_each(|round| {
                let start = first.when(round == 0);
                let last = QueueFlags::LAST.when(round + 1 == rounds);
                // Rounds that another schedule may need. No block leaves one early, so it leaves to
                // the next only units that had no room on chip.
                let is_spare = round + MORE_ROUNDS >= rounds;
                let idle_limit = if is_spare { NEVER_IDLE } else { idle_limit };
                self.round(given, round as usize, Round { round, flags: start | last, idle_limit })
            });
        }
        let mut flags = first;
        loop {
            for round in 0..BATCH {
                self.round(given, round as usize, Round { round, flags, idle_limit })?;
                flags = QueueFlags::NONE;
            }
            let left = self.counts[0].read(BATCH as usize + 1)?[BATCH as usize];
            if left == 0 {
                return Ok(());
            }
            begin(self)?;
            self.counts[0].write(&[left])?;
        }
    }

    /// Runs rounds that share one list and begin with the units that `seed` writes.
    ///
    /// # Errors
    /// Device errors.
    pub fn launch_from<R: Precision, V: Kernels>(
        &mut self,
        given: &WalkContext<R, V>,
        seed: Seed,
    ) -> Result<(), Error> {
        self.by_view(given, Some(seed))
    }
}

/// Appends units to a list.
pub type Seed<'a> = &'a dyn Fn(Output<Pair>) -> Result<(), Error>;

impl<R: Precision, V: Kernels> Walk<R, V> for Queue {
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        self.balances.clear();
        match self.shape.balance {
            Balance::Copy => self.by_copy(given),
            Balance::View => self.by_view(given, None),
        }
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        vec![&mut self.units, &mut self.plan]
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.plan.learn(counters[counter::QUEUE_ROUNDS]);
        Ok(())
    }

    fn without_host(&self) -> Result<(), &'static str> {
        self.is_planned(false)
    }

    fn balance_ms(&self) -> Result<f64, Error> {
        // From 0.0: the sum of no values would be -0.0.
        self.balances.iter().try_fold(0.0, |sum, [from, to]| Ok(sum + from.to(to)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};

    /// A plan that was too short doubles, even if the next schedule needs less; then it shrinks by
    /// one a frame.
    #[test]
    fn a_plan_that_was_too_short_doubles() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let short = |plan: &mut Plan, units: u64| {
            let mut counts = Counts::default();
            counts[counter::UNFINISHED] = units;
            plan.grow(&device, &counts).expect("nothing to take")
        };
        let mut plan = Plan::default();
        plan.learn(5);
        assert_eq!(plan.rounds, [Some(7), None]);
        assert!(!short(&mut plan, 0) && plan.rounds[0] == Some(7));
        assert!(short(&mut plan, 3) && plan.rounds[0].is_none());
        let planned = [4, 4, 4, 20].map(|worked| {
            plan.learn(worked);
            plan.rounds[0]
        });
        assert_eq!(planned, [14, 13, 12, 22].map(Some));
        // At most as long as any plan; more rounds are not planned.
        for _ in 0..8 {
            assert!(short(&mut plan, 1));
            plan.learn(1);
        }
        assert_eq!(plan.rounds[0], Some(MOST_ROUNDS));
        plan.learn(u64::from(MOST_ROUNDS));
        assert_eq!(plan.rounds, [None, None]);
    }
}
