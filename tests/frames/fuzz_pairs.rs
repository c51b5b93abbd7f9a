//! The targets of the fuzzers, run with random bytes on stable: two triangles, two moving features,
//! whole small scenes, each judged by the oracle. Finds of a fuzzer are kept in tests/finds and run
//! again.
//!
//! The first random number is printed; `NEARMISS_SEED` sets it, `NEARMISS_FUZZ_SECONDS` the time of
//! each target [default: 5].
#![allow(clippy::unwrap_used, reason = "tests")]

use nearmiss::contacts::Rows;
use nearmiss_kernels::prim::inclusion::Verdict;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::path::Path;
use std::time::{Duration, Instant};
use support::fuzz::{bytes, continuous, discrete, distance, near, scene};

/// One question: the name of its target, the most bytes that it reads, and the judged answer.
type Question = (&'static str, usize, fn(&[u8]) -> Result<(), String>);

/// The default: `cargo test` runs the same bytes every time, the fuzzers other ones.
const SEED: u64 = 1;

const QUESTIONS: [Question; 5] = [
    ("discrete_pair", 60, |bytes| discrete::ask(bytes, |meets| meets)),
    ("continuous_pair", 80, |bytes| continuous::ask(bytes, |verdict| verdict)),
    ("scene", 120, |bytes| scene::ask(bytes, |_| ())),
    ("near", 120, |bytes| near::ask(bytes, |_| ())),
    ("distance", 120, |bytes| distance::ask(bytes, |_| ())),
];

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable)
        .ok()
        .map(|text| text.parse().unwrap_or_else(|_| panic!("{variable}={text} is no number")))
}

/// Random bytes, most of them few different ones.
fn random_bytes(r: &mut SmallRng, most: usize) -> Vec<u8> {
    let mask = [0xff, 0xff, 0x1f, 0xe7][r.random_range(0..4)];
    (0..r.random_range(1..=most)).map(|_| r.random::<u8>() & mask).collect()
}

/// Runs for a while; returns the number of runs, and the first fault with the bytes that show it.
fn search(question: Question, seed: u64, time: Duration) -> (u64, Option<String>) {
    let (_, length, ask) = question;
    let mut r = SmallRng::seed_from_u64(seed);
    let start = Instant::now();
    let mut asked = 0;
    while start.elapsed() < time {
        let bytes = random_bytes(&mut r, length);
        if let Err(what) = ask(&bytes) {
            let hex: String = bytes.iter().map(|b| format!("{b:02x}")).collect();
            return (
                asked,
                Some(format!("{what}\nkeep it: echo {hex} | xxd -r -p > tests/finds/{}/NAME", question.0)),
            );
        }
        asked += 1;
    }
    (asked, None)
}

fn random(i: usize) {
    let seed = number("NEARMISS_SEED").unwrap_or(SEED);
    let time = Duration::from_secs(number("NEARMISS_FUZZ_SECONDS").unwrap_or(5));
    let (asked, fault) = search(QUESTIONS[i], seed, time);
    println!("{}: {asked} asked, NEARMISS_SEED={seed}", QUESTIONS[i].0);
    assert!(fault.is_none(), "NEARMISS_SEED={seed}: {}", fault.unwrap_or_default());
    assert!(asked > 20, "only {asked}");
}

#[test]
fn random_triangles() {
    random(0);
}

#[test]
fn random_motions() {
    random(1);
}

/// The same with the axes stretched to the ends of the range, a share for each family and precision.
#[test]
fn directed_motions() {
    for first in (bytes::DIRECTED..=0xff).step_by(5) {
        let mut r = SmallRng::seed_from_u64(SEED);
        let mut met = 0;
        for _ in 0..40 {
            let mut bytes = random_bytes(&mut r, 80);
            bytes[0] = first;
            let said = continuous::ask(&bytes, |verdict| verdict);
            assert!(said.is_ok(), "{first:#x}: {}", said.unwrap_err());
            met += u32::from(continuous::ask(&bytes, |_| Verdict::separated(1.0, 0)).is_err());
        }
        println!("{first:#x}: {met} of 40 meet");
        assert!(met > 0, "{first:#x}: a fault that is planted would not be noticed");
    }
}

#[test]
fn random_scenes() {
    random(2);
}

#[test]
fn random_distances() {
    random(3);
}

#[test]
fn random_nearest_triangles() {
    random(4);
}

/// Inputs that once failed, and a few that reach far into the code and never did (`widest`).
#[test]
fn finds_stay_mended() {
    for (name, _, ask) in QUESTIONS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/finds").join(name);
        let mut asked = 0;
        for file in std::fs::read_dir(&folder).unwrap() {
            let path = file.unwrap().path();
            let said = ask(&std::fs::read(&path).unwrap());
            assert!(said.is_ok(), "{}: {}", path.display(), said.unwrap_err());
            asked += 1;
        }
        assert!(asked > 0, "{name}");
    }
}

/// Each judge is shown to condemn: an answer is changed before it is judged, and soon that is named.
#[test]
fn planted_faults_are_named() {
    let plants: [(Question, &str); 11] = [
        (("a turned answer", 60, |b| discrete::ask(b, |meets| !meets)), "returns true, the oracle false"),
        (("always apart", 60, |b| discrete::ask(b, |_| false)), "returns false, the oracle true"),
        (("always separated", 80, |b| continuous::ask(b, |_| Verdict::separated(1.0, 0))), "missed"),
        (
            ("always certain", 80, |b| continuous::ask(b, |_| Verdict::contact(0.0, 0.0, 0, false))),
            "false certificate",
        ),
        (("at the end", 80, |b| continuous::ask(b, |v| Verdict { toi: 1.0, toi_upper: 1.0, ..v })), "late"),
        (("no number", 80, |b| continuous::ask(b, |v| Verdict { toi: f64::NAN, ..v })), "times out of range"),
        (("one left out", 120, |b| scene::ask(b, scene::forget)), "truly"),
        (("one left out", 120, |b| near::ask(b, scene::forget)), "is missed"),
        (("none told", 120, |b| distance::ask(b, scene::forget)), "but the least is"),
        (("a little nearer", 120, |b| distance::ask(b, a_little_nearer)), "a distance"),
        (("all certified", 120, |b| scene::ask(b, all_certified)), "false certificate"),
    ];
    for ((plant, length, ask), named) in plants {
        let mut r = SmallRng::seed_from_u64(SEED);
        let asked =
            (0..5000).find(|_| ask(&random_bytes(&mut r, length)).is_err_and(|fault| fault.contains(named)));
        println!("{plant}: {named:?} after {asked:?}");
        assert!(asked.is_some(), "{plant}: not noticed");
    }
}

/// A lie: a distance that is off in its tenth digit.
fn a_little_nearer(answer: &mut Rows) {
    if let Rows::Distance(Some(nearest)) = answer {
        nearest.distance *= 1.0 - 1e-10;
    }
}

/// A lie: what is only near is certain.
fn all_certified(answer: &mut Rows) {
    if let Rows::Contacts(all) = answer {
        for contact in all.iter_mut() {
            (contact.status, contact.toi, contact.toi_upper) =
                (nearmiss::contacts::Status::Certified, 0.0, 0.0);
        }
    }
}
