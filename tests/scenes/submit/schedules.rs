//! A successful `prepare` is a promise: the answer is there, and a submission may follow at once,
//! on any schedule of blocks. A later schedule may need more room: `collect` then reruns.

use super::*;
use nearmiss::Detector;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::research::KindExt;
use nearmiss::research::StatsExt;
use std::collections::BTreeSet;
use support::cases;

/// Queues so small that units spill in every round: rounds and lengths depend on the schedule.
const SMALL: QueueShape =
    QueueShape { cores: Some(5), local: 3, segment: 2, take: 1, ..QueueShape::native() };

/// A preparation and a submission, as a caller sees them.
#[derive(Clone, Copy, Debug)]
struct Observed {
    /// After a successful `prepare`.
    is_prepared: bool,
    /// After a `collect` that follows it.
    stays_prepared: bool,
    /// Whether `submit` was accepted.
    is_submitted: bool,
    /// Lists without room, by the status on the device.
    short: u64,
    /// After the `collect` that follows the submission.
    is_prepared_after: bool,
    /// Whether the answers are those of a frame through the host.
    are_equal: bool,
    /// Whether the status counts the crossings of the answer.
    counts_crossing: bool,
}

/// An observation that breaks no law.
const LAWFUL: Observed = Observed {
    is_prepared: true,
    stays_prepared: true,
    is_submitted: true,
    short: 0,
    is_prepared_after: true,
    are_equal: true,
    counts_crossing: true,
};

impl Observed {
    /// The first law that it breaks.
    fn broken(&self) -> Option<&'static str> {
        let laws = [
            (self.is_prepared, "a successful prepare leaves the detector prepared"),
            (self.stays_prepared, "the answer of a preparation is whole"),
            (self.is_submitted, "a prepared detector accepts a submission"),
            (self.are_equal, "every answer is that of the same frame through the host"),
            ((self.short == 0) == self.is_prepared_after, "a short submission ends the preparation"),
            (self.short > 0 || self.counts_crossing, "the status of a whole answer counts its crossings"),
        ];
        laws.into_iter().find(|(holds, _)| !holds).map(|(_, law)| law)
    }
}

/// Preparations and submissions, and the rounds that the queues took.
#[derive(Default)]
struct Seen {
    prepared: u32,
    short: u32,
    rounds: BTreeSet<u64>,
    faults: Vec<String>,
}

impl Seen {
    /// Prepares a new detector, submits so often, and prepares again after each short submission.
    fn observe(&mut self, device: &Device, query: Query, submissions: usize) {
        let (scene, id, ends) = pair(60);
        let memory = ends.each_ref().map(|points| Points::new(device, points));
        let input = [(id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
        let [start, end] = ends.map(Positions::F32);
        let mut by_host = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
        let wanted = by_host.frame(&[(id, Motion::step(&start, &end))]).expect("an answer");
        let mut detector = Detector::new(device.clone(), scene).expect("a detector");
        for _ in 0..submissions {
            let mut seen = LAWFUL;
            if !detector.is_prepared() {
                detector.prepare(&input, &[query]).expect("prepared");
                self.prepared += 1;
                seen.is_prepared = detector.is_prepared();
                seen.are_equal &= detector.collect(&query).expect("an answer").rows == wanted.rows;
                seen.stays_prepared = detector.is_prepared();
            }
            seen.is_submitted = detector.submit().is_ok();
            if seen.is_submitted {
                let at = detector.on_device(&query).expect("prepared").status as *const FrameStatus;
                // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
                let status = unsafe { *at };
                let found = detector.collect(&query).expect("an answer");
                seen.short = status.short;
                seen.is_prepared_after = detector.is_prepared();
                seen.are_equal &=
                    found.rows == wanted.rows && found.starts_crossing == wanted.starts_crossing;
                seen.counts_crossing = status.crossing == wanted.starts_crossing.unwrap_or(u64::MAX);
                self.short += u32::from(status.short > 0);
                self.rounds.insert(found.stats.queues().rounds);
            }
            self.faults.extend(seen.broken().map(|law| format!("{law}: {seen:?}, {query:?}")));
        }
    }

    /// Nothing broke a law.
    fn check(&self, what: &str) {
        let Seen { faults, prepared, short, .. } = self;
        let counts = format!("{prepared} preparations, {short} short submissions, {} faults", faults.len());
        assert!(faults.is_empty(), "{what}: {counts}, first {}", faults[0]);
    }
}

fn queries() -> impl Iterator<Item = Query> {
    let walked = |kind| {
        let search = Search { traversal: Some(Traversal::Queue(SMALL)), ..Search::default() };
        query(kind).with_search(search)
    };
    support::asked::KINDS.into_iter().filter(|kind| kind.takes_traversals()).map(walked)
}

/// Another schedule each launch, and the same ones each time that the test runs.
#[test]
fn a_prepared_detector_is_submittable_on_any_schedule() {
    for query in queries() {
        // Blocks one after the other in any order; those of one kind also interleaved.
        let mut ways = vec![(cases(3, 8), false)];
        ways.extend((query.kind() == QueryKind::Near).then_some((cases(4, 12), true)));
        for (seeds, interleaves) in ways {
            let mut seen = Seen::default();
            for seed in 0..seeds as u64 {
                let order = Mode::Sanitizer(Order::Shuffled(seed));
                let emulator = Emulator::new(order, None).expect("threads");
                let emulator = if interleaves { emulator.with_interleave(seed) } else { emulator };
                seen.observe(&Device::emulator(emulator), query, 6);
            }
            assert!(seen.rounds.len() > 1, "every schedule took {:?} rounds", seen.rounds);
            seen.check(query.kind().name());
        }
    }
}

/// The engine, whose threads are shared with other detectors.
#[test]
fn a_prepared_detector_is_submittable_under_load() {
    let observe = || {
        let mut seen = Seen::default();
        queries().for_each(|query| (0..6).for_each(|_| seen.observe(&engine(), query, 6)));
        seen
    };
    let all: Vec<Seen> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(observe)).collect();
        threads.into_iter().map(|thread| thread.join().expect("a thread's end")).collect()
    });
    all.iter().for_each(|seen| seen.check("under load"));
}

/// Each broken law is named.
#[test]
fn a_broken_promise_is_named() {
    assert_eq!(LAWFUL.broken(), None);
    let short = Observed { short: 1, is_prepared_after: false, counts_crossing: false, ..LAWFUL };
    assert_eq!(short.broken(), None, "a short submission is lawful, and its counts are not used");
    let broken = [
        (Observed { is_prepared: false, ..LAWFUL }, "leaves the detector prepared"),
        (Observed { stays_prepared: false, ..LAWFUL }, "preparation is whole"),
        (Observed { is_submitted: false, ..LAWFUL }, "accepts a submission"),
        (Observed { are_equal: false, ..LAWFUL }, "through the host"),
        (Observed { short: 1, ..LAWFUL }, "ends the preparation"),
        (Observed { is_prepared_after: false, ..LAWFUL }, "ends the preparation"),
        (Observed { counts_crossing: false, ..LAWFUL }, "counts its crossings"),
    ];
    for (observed, law) in broken {
        assert!(observed.broken().is_some_and(|named| named.contains(law)), "{observed:?}");
    }
}
