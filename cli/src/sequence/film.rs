//! Frames of a film: their files, the numbers in the names of these, and frames that cannot be used.

use nearmiss::error::Error;
use nearmiss::words::counted;
use serde::Serialize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A step or frame of a sequence, as rows and lines name it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Moment {
    /// The step or frame, from 0.
    pub step: usize,
    /// Number of the frame in the name of its file; of a step that of its start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<u64>,
    /// The file; of a step that of its start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

impl Moment {
    /// The number that people know it by: that of its file, or else its place from 0.
    pub fn number(&self) -> u64 {
        self.frame.unwrap_or(self.step as u64)
    }
}

/// The files of a sequence, one a frame.
#[derive(Default)]
pub struct Film {
    /// Empty if no body has a file for each frame.
    files: Vec<PathBuf>,
    /// Their numbers; empty if one has none, or if two have the same.
    numbers: Vec<u64>,
    /// Why a frame cannot be used.
    reasons: Vec<Option<String>>,
}

impl Film {
    /// The film of these files.
    pub fn new(files: Vec<PathBuf>) -> Film {
        let numbers = numbers(&files).unwrap_or_default();
        Film { files, numbers, reasons: Vec::new() }
    }

    /// Adds the reasons why frames of a body cannot be used. The first of a frame stays.
    pub fn mark(&mut self, reasons: Vec<Option<String>>) {
        self.reasons.resize(self.reasons.len().max(reasons.len()), None);
        for (own, other) in self.reasons.iter_mut().zip(reasons) {
            *own = own.take().or(other);
        }
    }

    /// A step or frame.
    pub fn moment(&self, step: usize) -> Moment {
        let file = self.files.get(step).map(|file| file.display().to_string());
        Moment { step, frame: self.numbers.get(step).copied(), file }
    }

    /// Why frame `step` cannot be used, or in motion the step from it to the next.
    pub fn reason(&self, step: usize, at_rest: bool) -> Option<&str> {
        let ends = if at_rest { step..=step } else { step..=step + 1 };
        ends.filter_map(|frame| self.reasons.get(frame)).flatten().next().map(String::as_str)
    }

    /// Notes of numbers that are missing, and of numbers that are not in order.
    pub fn notes(&self) -> Vec<String> {
        let pairs = || self.numbers.windows(2).enumerate().map(|(at, pair)| (at, pair[0], pair[1]));
        let stride = pairs().filter(|(_, a, b)| a < b).map(|(_, a, b)| b - a).min().unwrap_or(1);
        let missing = |a: u64, b: u64| b.saturating_sub(a).saturating_sub(1) / stride;
        let count = pairs().fold(0, |sum: u64, (_, a, b)| sum.saturating_add(missing(a, b)));
        let gap = pairs().find(|(_, a, b)| missing(*a, *b) > 0).map(|(at, a, b)| {
            let frames = counted(count, "frame is", "frames are");
            let files = [at, at + 1].map(|at| self.files[at].display());
            format!("{frames} missing; the first between {a} ({}) and {b} ({})", files[0], files[1])
        });
        let back = pairs().find(|(_, a, b)| a > b).map(|(at, a, b)| {
            let file = self.files[at + 1].display();
            format!("frame {b} ({file}) comes after frame {a}; give files in order, as `ls -v` lists them")
        });
        back.or(gap).into_iter().collect()
    }
}

/// The numbers of files. Names may have several: the last that differs between the first two counts.
/// `None` if a file has no number, or if two have the same.
fn numbers(files: &[PathBuf]) -> Option<Vec<u64>> {
    let all: Vec<Vec<u64>> = files.iter().map(|file| runs(file)).collect();
    let [first, second, ..] = &all[..] else { return None };
    let differs = |at: &usize| first.get(*at) != second.get(*at);
    let place = (0..first.len().min(second.len())).rev().find(differs)?;
    let numbers: Vec<u64> = all.iter().map(|runs| runs.get(place).copied()).collect::<Option<_>>()?;
    let mut sorted = numbers.clone();
    sorted.sort_unstable();
    sorted.windows(2).all(|pair| pair[0] != pair[1]).then_some(numbers)
}

/// The numbers in a file's path, extensions left out.
fn runs(file: &Path) -> Vec<u64> {
    let bare = crate::output::unpacked(file).with_extension("");
    let digits = |text: &str| -> Vec<u64> {
        text.split(|c: char| !c.is_ascii_digit()).filter_map(|run| run.parse().ok()).collect()
    };
    digits(&bare.to_string_lossy())
}

/// The key by which files of a film are sorted: their numbers count as numbers.
pub fn natural(file: &Path) -> (Vec<(String, u64)>, PathBuf) {
    let text = file.as_os_str().to_string_lossy().into_owned();
    let mut parts = Vec::new();
    let mut rest = text.as_str();
    while let Some(from) = rest.find(|c: char| c.is_ascii_digit()) {
        let length = rest[from..].find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len() - from);
        let number = rest[from..from + length].parse().unwrap_or(u64::MAX);
        parts.push((rest[..from].to_owned(), number));
        rest = &rest[from + length..];
    }
    parts.push((rest.to_owned(), 0));
    (parts, file.to_owned())
}

/// The name of a frame's file: the last run of `#` is its number, padded with zeros. `None` if the
/// name has no `#`.
pub fn named(pattern: &Path, number: u64) -> Option<PathBuf> {
    let name = pattern.file_name().and_then(OsStr::to_str)?;
    let end = name.rfind('#')? + 1;
    let start = name[..end].trim_end_matches('#').len();
    let width = end - start;
    Some(pattern.with_file_name(format!("{}{number:0width$}{}", &name[..start], &name[end..])))
}

/// Refuses a name without `#` for several files.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(option: &str, pattern: &Path, steps: usize) -> Result<(), Error> {
    match named(pattern, 0) {
        None if steps > 1 => Err(Error::InvalidArgument {
            what: format!(
                "{option} must have a # for the number of each of {steps} frames, got {}",
                pattern.display()
            ),
            advice: "write #### for four digits, or give one step or frame".into(),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(names: &[&str]) -> Film {
        Film::new(names.iter().map(PathBuf::from).collect())
    }

    #[test]
    fn numbers_are_those_of_the_names() {
        let of = |names: &[&str]| numbers(&names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(of(&["a.1001.obj", "a.1002.obj.gz"]), Some(vec![1001, 1002]));
        assert_eq!(of(&["v2/a_07_lod0.ply", "v2/a_09_lod0.ply"]), Some(vec![7, 9]));
        assert_eq!(of(&["f1/cloth.obj", "f2/cloth.obj", "f3/cloth.obj"]), Some(vec![1, 2, 3]));
        for none in [&["a.obj", "b.obj"][..], &["a.1.obj"], &["a.1.obj", "a.2.obj", "a.1.obj"]] {
            assert_eq!(of(none), None, "{none:?}");
        }
        assert_eq!(of(&["a.1.obj", "a.2.obj", "b.obj"]), None);
        assert_eq!(of(&["a.99999999999999999999999.obj", "a.1.obj"]), None);
    }

    #[test]
    fn gaps_and_wrong_orders_are_notes() {
        assert!(film(&["a.1.obj", "a.2.obj", "a.3.obj"]).notes().is_empty());
        // Every fifth frame is no gap.
        assert!(film(&["a.1001.obj", "a.1006.obj", "a.1011.obj"]).notes().is_empty());
        let gaps = film(&["a.1.obj", "a.2.obj", "a.5.obj", "a.6.obj", "a.8.obj"]).notes();
        assert_eq!(gaps, ["3 frames are missing; the first between 2 (a.2.obj) and 5 (a.5.obj)"]);
        let back = film(&["a.1.obj", "a.10.obj", "a.2.obj", "a.3.obj"]).notes();
        assert!(
            back.len() == 1 && back[0].starts_with("frame 2 (a.2.obj) comes after frame 10;"),
            "{back:?}"
        );
    }

    #[test]
    fn numbers_of_any_size_are_counted() {
        let most = u64::MAX;
        let files = [0, most, 1, most - 1, 2, 3].map(|number| format!("a.{number}.obj"));
        let notes = film(&files.each_ref().map(String::as_str)).notes();
        assert!(notes.len() == 1 && notes[0].starts_with("frame 1 (a.1.obj) comes after frame"), "{notes:?}");
    }

    #[test]
    fn files_are_sorted_by_their_numbers() {
        let mut files = ["a.10.obj", "a.9.obj", "b.1.obj", "a.obj", "a.09.obj"].map(PathBuf::from);
        files.sort_by_key(|file| natural(file));
        assert_eq!(files, ["a.09.obj", "a.9.obj", "a.10.obj", "a.obj", "b.1.obj"].map(PathBuf::from));
    }

    #[test]
    fn names_have_the_number_of_the_frame() {
        let of = |pattern: &str, number| named(Path::new(pattern), number);
        assert_eq!(of("d#/a.####.png", 7), Some("d#/a.0007.png".into()));
        assert_eq!(of("a#b##.ply.gz", 1001), Some("a#b1001.ply.gz".into()));
        assert_eq!(of("d#/a.png", 7), None);
    }

    #[test]
    fn a_step_needs_both_of_its_ends() {
        let mut film = film(&["a.1.obj", "a.2.obj", "a.3.obj"]);
        film.mark(vec![None, Some("torn".into()), None]);
        film.mark(vec![Some("gone".into()), Some("late".into()), None]);
        let reasons = |at_rest| [0, 1, 2].map(|step| film.reason(step, at_rest).map(str::to_owned));
        let [gone, torn] = ["gone", "torn"].map(|why| Some(why.to_owned()));
        assert_eq!(reasons(true), [gone.clone(), torn.clone(), None]);
        assert_eq!(reasons(false), [gone, torn, None]);
        assert_eq!(film.moment(1), Moment { step: 1, frame: Some(2), file: Some("a.2.obj".into()) });
    }
}
