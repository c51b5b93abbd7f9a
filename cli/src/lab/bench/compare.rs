//! Figures compared with earlier ones.

use super::Figures;
use super::file::{Earlier, EarlierCase};
use super::machine::Machine;
use super::measure::{Measured, TOTAL, WALL, called};
use nearmiss::error::Error;
use serde::Serialize;

/// An earlier file, and the differences from it.
#[derive(Debug, Serialize)]
pub struct Against {
    /// The file.
    pub file: String,
    /// Its machine.
    #[serde(flatten)]
    pub machine: Machine,
    /// Its version of nearmiss.
    pub version: String,
    /// Whether its machine is another: then a ratio compares machines, too.
    pub is_other_machine: bool,
    /// Questions of cases that the file has not.
    pub only_now: Vec<String>,
    /// Questions of cases that it alone has, of those that were chosen.
    pub only_earlier: Vec<String>,
    /// Answers that are others than in the file, and what takes longer than the limit allows.
    pub faults: Vec<String>,
}

/// Whether the figures of another machine may have a limit: they may not.
///
/// # Errors
/// [`Error::InvalidArgument`] naming both machines.
pub fn may_limit(now: &Machine, earlier: &Earlier) -> Result<(), Error> {
    if *now == earlier.machine {
        return Ok(());
    }
    Err(Error::InvalidArgument {
        what: format!(
            "--limit needs a file of this machine, {now}, got {} of {}",
            earlier.file, earlier.machine
        ),
        advice: "remove it, or give --against a file of this machine with as many threads".into(),
    })
}

/// Adds the earlier times to the figures. Returns the faults, answers first. Rows of the file that
/// are not `chosen`, by case and question, are not missed. A frame, or the wait for it, is too slow
/// if it takes more than `limit` times the earlier.
pub fn compare(
    all: &mut Figures,
    earlier: &Earlier,
    chosen: impl Fn(&str, &str) -> bool,
    limit: Option<f64>,
) -> Vec<Error> {
    let (mut other, mut slow, mut only_now) = (Vec::new(), Vec::new(), Vec::new());
    for now in &mut all.cases {
        let Some(then) = earlier.of(&now.case, now.question) else {
            only_now.push(now.called());
            continue;
        };
        now.earlier_hash = Some(then.hash.clone());
        for times in &mut now.stages {
            times.earlier_ms = then.ms.get(times.stage).copied();
            times.ratio = times.earlier_ms.filter(|ms| *ms > 0.0).map(|ms| times.median_ms / ms);
        }
        other.extend(other_answer(now, (&then.hash, &earlier.file)));
        slow.extend(limit.and_then(|limit| too_slow(now, limit, &earlier.file)));
    }
    let is_here =
        |of: &EarlierCase| all.cases.iter().any(|now| now.case == of.case && now.question == of.question);
    let gone = earlier.cases.iter().filter(|of| chosen(&of.case, &of.question) && !is_here(of));
    let only_earlier = gone.map(|of| called(&of.case, &of.question)).collect();
    other.extend(slow);
    all.against = Some(Against {
        file: earlier.file.clone(),
        machine: earlier.machine.clone(),
        version: earlier.version.clone(),
        is_other_machine: all.machine != earlier.machine,
        only_now,
        only_earlier,
        faults: other.iter().map(Error::to_string).collect(),
    });
    other
}

fn other_answer(now: &Measured, (hash, file): (&str, &str)) -> Option<Error> {
    (now.hash != hash).then(|| Error::Regression {
        what: now.called(),
        text: format!("the answer has the hash {}, and in {file} {hash}", now.hash),
        advice: "find the change that made it; if it is intended, measure again",
    })
}

fn too_slow(now: &Measured, limit: f64, file: &str) -> Option<Error> {
    let is_slow = |ms: f64, earlier: f64| ms > limit * earlier;
    let of = |name| now.stages.iter().find(|times| times.stage == name);
    let times = [TOTAL, WALL]
        .into_iter()
        .filter_map(of)
        .find(|times| times.earlier_ms.is_some_and(|earlier| is_slow(times.median_ms, earlier)))?;
    Some(Error::Regression {
        what: now.called(),
        text: format!(
            "{} takes {} ms, and in {file} {} ms: more than {limit} times as long",
            times.stage,
            times.median_ms,
            times.earlier_ms.unwrap_or(0.0)
        ),
        advice: "measure again on a quiet machine; then compare the stages",
    })
}
