//! All figures together: text, CSV files and pictures.

use super::bodies::BodiesRow;
use super::figures::{Figure612, Figure613, Figure614, Paper};
use super::front::FrontRow;
use super::paper_reference::PAPER_GPU;
use super::picture::{Bar, Chart, Curve, Panel, Stack, bars, curves, stacks};
use super::scale::ScaleRow;
use super::text::text;
use nearmiss::error::Error;
use nearmiss::words::counted;
use serde::Serialize;

/// The requested figures; the others have no rows.
#[derive(Debug, Serialize)]
pub struct Figures {
    /// Our machine.
    pub device: String,
    /// Size of the work queues, or `fastest`.
    pub profile: &'static str,
    /// The thesis's machine.
    pub theirs: &'static str,
    /// Construction and refit.
    pub figure_6_12: Vec<Figure612>,
    /// Frames.
    pub figure_6_13: Vec<Figure613>,
    /// Figure 6.14: shares of the stages.
    pub figure_6_14: Vec<Figure614>,
    /// Savings of a front.
    pub front: Vec<FrontRow>,
    /// Scenes of many bodies.
    pub bodies: Vec<BodiesRow>,
    /// Sizes, on one device and on several.
    pub scale: Vec<ScaleRow>,
}

impl Figures {
    /// Returns no figures.
    pub fn new(device: String, profile: &'static str) -> Figures {
        let (figure_6_12, figure_6_13, figure_6_14) = Default::default();
        let (front, bodies, scale) = Default::default();
        Figures {
            device,
            profile,
            theirs: PAPER_GPU,
            figure_6_12,
            figure_6_13,
            figure_6_14,
            front,
            bodies,
            scale,
        }
    }

    /// Returns the figures as text, for a terminal.
    pub fn text(&self) -> String {
        let figures = [
            text(&self.figure_6_12),
            text(&self.figure_6_13),
            text(&self.figure_6_14),
            text(&self.front),
            text(&self.bodies),
            text(&self.scale),
        ];
        let mut all = format!("ours on {}\n\n", self.machine());
        for figure in figures.iter().filter(|figure| !figure.is_empty()) {
            all += figure;
        }
        for remark in self.remarks() {
            all += &format!("{remark}\n");
        }
        all
    }

    /// Returns the machine, and the work queues if they have a size.
    fn machine(&self) -> String {
        let queues =
            if self.profile == "fastest" { String::new() } else { format!(", work queues {}", self.profile) };
        format!("{}{queues}", self.device)
    }

    /// Returns the remarks that a reader of the figures needs.
    fn remarks(&self) -> Vec<String> {
        let of_612 = self.figure_6_12.iter().map(|r| (&r.scene, r.triangles, r.their_triangles));
        let of_613 = self.figure_6_13.iter().map(|r| (&r.scene, r.triangles, r.their_triangles));
        let mut remarks = Vec::new();
        for (scene, ours, theirs) in of_612.chain(of_613) {
            let Some(theirs) = theirs.filter(|_| !is_like(scene, ours)) else { continue };
            let remark = format!(
                "{scene}: ours has {ours} triangles and theirs {theirs}; the ratios compare different scenes."
            );
            if !remarks.contains(&remark) {
                remarks.push(remark);
            }
        }
        let differing: usize = self.figure_6_13.iter().map(|row| row.differing).sum();
        if differing > 0 {
            remarks.push(format!(
                "{} between volumes or walks: their solver can err, and errs on other candidates.",
                counted(differing as u64, "frame differs", "frames differ")
            ));
        }
        let reruns: u64 = self.figure_6_13.iter().map(|row| row.reruns).sum();
        if reruns > 0 {
            remarks.push(format!(
                "{} again because a list was too short: times of such frames are too long.",
                counted(reruns, "run was done", "runs were done")
            ));
        }
        remarks
    }

    /// Returns `figure-6.12.csv`, `figure-6.12.svg` and so on: file names and bytes.
    ///
    /// # Errors
    /// Drawing errors.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Error> {
        let mut files = Vec::new();
        let mut both = |name: &str, rows: Result<Vec<u8>, Error>, svg: Result<String, Error>| {
            files.push((format!("{name}.csv"), rows?));
            files.push((format!("{name}.svg"), svg?.into_bytes()));
            Ok::<_, Error>(())
        };
        if !self.figure_6_12.is_empty() {
            let title = "Figure 6.12: construction and refit of a tree";
            let panels = panels(
                &self.figure_6_12,
                |row| titled(&row.scene, row.triangles, row.their_triangles),
                |row| Bar {
                    label: format!("{} {}", row.stage, row.bv.to_uppercase()),
                    ours: row.ours_ms,
                    theirs: row.theirs_ms,
                },
            );
            both("figure-6.12", csv(&self.figure_6_12), bars(title, &self.machine(), &panels))?;
        }
        if !self.figure_6_13.is_empty() {
            let title = "Figure 6.13: a frame, from positions to contacts";
            let panels = panels(
                &self.figure_6_13,
                |row| titled(&row.scene, row.triangles, row.their_triangles),
                |row| Bar {
                    label: label(row.motion, row.bv, row.front),
                    ours: row.ours_ms,
                    theirs: row.theirs_ms,
                },
            );
            both("figure-6.13", csv(&self.figure_6_13), bars(title, &self.machine(), &panels))?;
        }
        if !self.figure_6_14.is_empty() {
            let title = "Figure 6.14: where a frame's time goes";
            let all: Vec<Stack> = self.figure_6_14.iter().map(stack).collect();
            both("figure-6.14", csv(&self.figure_6_14), stacks(title, &self.machine(), &all))?;
        }
        if !self.front.is_empty() {
            let title = "A front: its cost, of that of the same frame without it";
            let bound = (50.0, "half: the bound of Lauterbach 2010");
            both("front", csv(&self.front), curves(title, &self.machine(), bound, &charts(&self.front)))?;
        }
        if !self.bodies.is_empty() {
            files.push(("bodies.csv".into(), csv(&self.bodies)?));
        }
        if !self.scale.is_empty() {
            files.push(("scale.csv".into(), csv(&self.scale)?));
        }
        Ok(files)
    }
}

/// Returns a chart per scene, motion and volume; rows without a front are the reference of the
/// others.
fn charts(rows: &[FrontRow]) -> Vec<Chart> {
    let fronts: Vec<&FrontRow> = rows.iter().filter(|row| row.front).collect();
    let title = |row: &FrontRow| format!("{}, {}", row.scene, label(row.motion, row.bv, false));
    let chart = |rows: &[&FrontRow]| {
        let curve = |label: &str, is_time, of: fn(&FrontRow) -> f64| Curve {
            label: label.into(),
            points: rows.iter().map(|row| (row.part, 100.0 * of(row))).collect(),
            is_time,
        };
        Chart {
            title: rows.first().map(|row| title(row)).unwrap_or_default(),
            curves: vec![
                curve("node tests", false, |row| row.tests_ratio),
                curve("traversal time", true, |row| row.time_ratio),
            ],
        }
    };
    fronts.chunk_by(|a, b| title(a) == title(b)).map(chart).collect()
}

fn label(motion: &str, bv: &str, front: bool) -> String {
    format!("{motion} {}{}", bv.to_uppercase(), if front { ", front" } else { "" })
}

fn is_like(scene: &str, triangles: usize) -> bool {
    Paper::new(scene, triangles, String::new(), "").is_like()
}

/// Returns a panel's title, with the thesis's size if it differs.
fn titled(scene: &str, triangles: usize, theirs: Option<usize>) -> String {
    match theirs {
        Some(theirs) if !is_like(scene, triangles) => {
            format!("{scene}, {triangles} triangles (theirs: {theirs})")
        }
        _ => format!("{scene}, {triangles} triangles"),
    }
}

fn stack(row: &Figure614) -> Stack {
    Stack {
        panel: titled(&row.scene, row.triangles, None),
        label: label(row.motion, row.bv, row.front),
        shares: [row.refit, row.traverse, row.balance, row.triangle_tests],
        ms: row.ms,
    }
}

/// Returns one panel per scene; a scene's rows are adjacent.
fn panels<T>(rows: &[T], title: fn(&T) -> String, bar: fn(&T) -> Bar) -> Vec<Panel> {
    let panel = |rows: &[T]| Panel {
        title: rows.first().map(title).unwrap_or_default(),
        bars: rows.iter().map(bar).collect(),
    };
    rows.chunk_by(|a, b| title(a) == title(b)).map(panel).collect()
}

/// Returns rows with a header, as CSV.
///
/// # Errors
/// [`Error::Bug`] for rows that a table cannot hold.
pub fn csv<T: Serialize>(rows: &[T]) -> Result<Vec<u8>, Error> {
    let bug = |text: String| Error::Bug { what: text };
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| csv.serialize(row)).map_err(|e| bug(e.to_string()))?;
    csv.into_inner().map_err(|e| bug(e.to_string()))
}
