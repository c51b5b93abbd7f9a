//! The lines of a sequence: one for each step, and their sum.

use super::film::Moment;
use crate::detect::text;
use crate::report::Report;
use nearmiss::contacts::Contacts;
use nearmiss::query::QueryKind;
use nearmiss::words::counted;
use nearmiss_lab::tables::digits;

/// A step or frame as lines begin: its number, and its file.
fn called(moment: &Moment, at_rest: bool) -> String {
    let file = moment.file.as_ref().map_or(String::new(), |file| format!(" ({file})"));
    format!("{} {}{file}", if at_rest { "frame" } else { "step" }, moment.number())
}

/// A step on a line, with its notes and caveats below.
pub fn line(report: &Report, moment: &Moment, at_rest: bool, verbose: bool) -> String {
    let summary = &report.summary;
    let found = text::found(summary, report.crossing);
    let mut text = format!("{}: {found}; {} ms", called(moment, at_rest), digits(summary.ms.wall));
    if verbose {
        text += &format!(", frame {:.3} ms, wall {:.3} ms", summary.ms.total, summary.ms.wall);
        text += &format!("; hash {}", summary.hash);
    }
    text + "\n" + &text::remarks(summary)
}

/// A step that cannot be tested, on a line.
pub fn untested(moment: &Moment, at_rest: bool, reason: &str) -> String {
    format!("{}: not tested: {reason}\n", called(moment, at_rest))
}

/// The sum of all steps.
#[derive(Default)]
pub struct Total {
    steps: u64,
    untested: u64,
    contacts: u64,
    /// Wall time, milliseconds.
    ms: f64,
    /// The first step with contacts, and its time if it has one.
    first: Option<(u64, Option<f64>)>,
    /// The least distance, and its frame.
    nearest: Option<(f64, u64)>,
    /// Frames in which triangles meet, and the first of them; of queries whose rows do not show it.
    crossing: Option<(u64, u64)>,
    /// Whether something meets in a step.
    pub meets: bool,
}

impl Total {
    /// Adds a step.
    pub fn add(&mut self, moment: &Moment, found: &Contacts, crossing: Option<u64>) {
        let number = moment.number();
        self.steps += 1;
        self.contacts += found.len() as u64;
        self.ms += found.stats.stages.wall;
        if self.first.is_none() && !found.is_empty() {
            self.first = Some((number, found.earliest_toi()));
        }
        let nearer = |least: f64| self.nearest.is_none_or(|(other, _)| least < other);
        if let Some(least) = found.distance().filter(|&least| nearer(least)) {
            self.nearest = Some((least, number));
        }
        if crossing.is_some_and(|pairs| pairs > 0) {
            let (frames, first) = self.crossing.unwrap_or((0, number));
            self.crossing = Some((frames + 1, first));
        }
        self.meets |= text::meets(found, crossing);
    }

    /// Whether no step has been tested.
    pub fn is_empty(&self) -> bool {
        self.steps == 0
    }

    /// Whether one step has been tested.
    pub fn is_first(&self) -> bool {
        self.steps == 1
    }

    /// Adds a step that is not tested.
    pub fn pass(&mut self) {
        self.untested += 1;
    }

    /// Whether a step is not tested.
    pub fn is_partial(&self) -> bool {
        self.untested > 0
    }

    /// The sum, on a line.
    pub fn text(&self, kind: QueryKind) -> String {
        let [name, names] = if kind.is_at_rest() { ["frame", "frames"] } else { ["step", "steps"] };
        let time = |toi| format!(" at t = {}", text::below(toi));
        let first = |(step, toi): (u64, Option<f64>)| {
            format!(", first in {name} {step}{}", toi.map_or(String::new(), time))
        };
        let mut found = match self.nearest {
            Some((least, step)) => format!("least distance {least}, in {name} {step} of {}", self.steps),
            None => format!(
                "{} in {}{}",
                text::rows(kind, self.contacts),
                counted(self.steps, name, names),
                self.first.map_or(String::new(), first)
            ),
        };
        if let Some((frames, first)) = self.crossing {
            found += &format!("; triangles meet in {}, first in {first}", counted(frames, name, names));
        }
        if self.untested > 0 {
            found += &format!("; {} not tested", counted(self.untested, name, names));
        }
        format!("{found}; {} ms\n", digits(self.ms))
    }
}
