//! Laws over 1 to 4 ranks: every answer is that of one machine, and an error of a rank ends all.
//!
//! The program starts itself by mpirun. A filter on the command line selects tests by name.

mod compare;
mod failures;
mod laws;
mod planted;
mod scenes;

use nearmiss_mpi::{RankError, Ranks, program};
use std::process::{Command, ExitCode};

/// Work of the ranks of a test.
type Role = fn(&Ranks) -> Result<(), RankError>;

/// A test: what its ranks do, on so many ranks, and what mpirun prints and returns.
struct Test {
    name: &'static str,
    ranks: &'static [usize],
    role: Role,
    /// Text that must be printed, and whether the status is 0.
    expects: (&'static str, bool),
}

const TESTS: [Test; 12] = [
    Test { name: "laws", ranks: &[1, 2, 3, 4], role: laws::laws, expects: ("all answers are equal", true) },
    Test {
        name: "short_messages",
        ranks: &[3],
        role: |ranks| laws::stepping(&ranks.with_most(4096)),
        expects: ("all steps are equal", true),
    },
    Test {
        name: "stepping",
        ranks: &[1, 2, 4],
        role: laws::stepping,
        expects: ("all steps are equal", true),
    },
    Test { name: "a_chunk_not_sent", ranks: &[2, 4], role: planted::chunk, expects: ("is missing", true) },
    Test { name: "boxes_not_grown", ranks: &[2, 4], role: planted::boxes, expects: ("is missing", true) },
    Test { name: "rows_kept_twice", ranks: &[2, 4], role: planted::twice, expects: ("is there twice", true) },
    Test {
        name: "bad_positions",
        ranks: &[1, 3, 4],
        role: failures::positions,
        expects: ("all ranks agree", true),
    },
    Test { name: "a_panic", ranks: &[1, 3, 4], role: failures::panic, expects: ("all ranks agree", true) },
    Test {
        name: "an_interrupt",
        ranks: &[2, 4],
        role: failures::interrupt,
        expects: ("all ranks agree", true),
    },
    Test { name: "refusals", ranks: &[2, 3], role: failures::refusals, expects: ("all ranks agree", true) },
    Test {
        name: "a_failing_program",
        ranks: &[3],
        role: failures::program_fails,
        expects: ("rank 1: sheet: vertex", false),
    },
    Test {
        name: "a_panic_outside",
        ranks: &[3],
        role: failures::outside,
        expects: ("rank 2: panicked outside", false),
    },
];

fn main() -> ExitCode {
    let filter = std::env::args().skip(1).find(|arg| !arg.starts_with('-')).unwrap_or_default();
    if std::env::var_os("OMPI_COMM_WORLD_RANK").is_some() {
        let Some(test) = TESTS.iter().find(|test| test.name == filter) else { return ExitCode::from(2) };
        return program(test.role).into();
    }
    if std::env::args().any(|arg| arg == "--list") {
        TESTS.iter().for_each(|test| println!("{}: test", test.name));
        return ExitCode::SUCCESS;
    }
    let mut failed = 0;
    for test in TESTS.iter().filter(|test| test.name.contains(&filter)) {
        for &ranks in test.ranks {
            let verdict = run(test, ranks);
            println!(
                "test {} on {ranks} ranks ... {}",
                test.name,
                if verdict.is_ok() { "ok" } else { "FAILED" }
            );
            if let Err(text) = verdict {
                println!("{text}");
                failed += 1;
            }
        }
    }
    println!("test result: {}. {failed} failed", if failed == 0 { "ok" } else { "FAILED" });
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs a test by mpirun; the error is what was wrong.
fn run(test: &Test, ranks: usize) -> Result<(), String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    // A rank that hangs ends with the others, and the test fails.
    let mut command = Command::new("timeout");
    command.args([
        "--kill-after=10",
        "900",
        "mpirun",
        "--allow-run-as-root",
        "--oversubscribe",
        "--bind-to",
        "none",
    ]);
    command.args(["-n", &ranks.to_string()]).arg(program).arg(test.name);
    let output = command.output().map_err(|error| format!("mpirun cannot be started: {error}"))?;
    let text =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    let (part, succeeds) = test.expects;
    // 124 and 137 are those of `timeout`.
    let ended = !matches!(output.status.code(), Some(124 | 137) | None);
    let is_as_expected = text.contains(part) && output.status.success() == succeeds && ended;
    if is_as_expected { Ok(()) } else { Err(format!("expected {part:?}; {}\n{text}", output.status)) }
}
