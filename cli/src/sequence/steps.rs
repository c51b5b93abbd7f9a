//! `detect` of several steps or frames, one after the other, by one detector.

use super::Sequence;
use crate::args::DetectArgs;
use crate::detect::{Places, places, promise, text};
use crate::output::{Target, print};
use crate::progress::during;
use crate::report::{FileFaces, Format, Report};
use crate::rows::{Columns, JsonRows};
use crate::vtp::Vtp;
use nearmiss::contacts::{Contacts, Note};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::research::DetectorExt;
use nearmiss::scene::Scene;
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use nearmiss_lab::tables::digits;
use serde::Serialize;
use std::io::Write;
use std::process::ExitCode;

/// Why a sequence ended before its end.
enum Stop {
    /// The file of contacts could not be written.
    File(String),
    /// Anything else.
    Other(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Stop {
        Stop::Other(error)
    }
}

/// The target of rows.
enum Out<'a> {
    Nowhere,
    Csv(Box<csv::Writer<&'a mut dyn Write>>),
    Json(&'a mut dyn Write),
    /// Kept until the last step: its cells stand in another order.
    Vtp(Box<Vtp>, &'a mut dyn Write),
}

/// Refuses options of one step that several do not have.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(args: &DetectArgs, steps: usize) -> Result<(), Error> {
    let refused = |option: &str, why: &str| {
        let what = format!("{option} has no effect: {why}");
        Err(Error::InvalidArgument { what, advice: "remove it, or give one step or frame".into() })
    };
    let research = &args.research;
    match (steps > 1, research.rebuild_every) {
        (true, _) if research.only.is_some() => refused("--only", "each of several steps runs once"),
        (true, _) if args.out.out_mesh.is_some() => Err(Error::InvalidArgument {
            what: format!("--out-mesh holds one step or frame, got {steps}"),
            advice: "give one step or frame, or write contacts with --out".into(),
        }),
        (true, _) if research.repeat > 1 => refused("--repeat", "each of several steps runs once"),
        (false, every) if every.is_some() || research.rebuild.is_some() => {
            let option = if every.is_some() { "--rebuild-every" } else { "--rebuild" };
            Err(Error::InvalidArgument {
                what: format!("{option} has no effect: the tree of the first step is new"),
                advice: "remove it, or give more frames".into(),
            })
        }
        _ => Ok(()),
    }
}

/// Runs step after step; writes and prints each answer.
///
/// # Errors
/// Those of the device, and of output.
pub fn detect(
    args: &DetectArgs,
    all: &Sequence,
    (scene, query): (Scene, Query),
    target: Option<(Format, Target)>,
) -> Result<ExitCode, Error> {
    let device = args.machine.open()?;
    promise(&query);
    let steps = Steps::new(args, all, device, (scene, query))?;
    let Some((format, target)) = target else {
        return match steps.run(Out::Nowhere) {
            Err(Stop::Other(error)) => Err(error),
            Err(Stop::File(text)) => Err(Error::Bug { what: text }),
            Ok(()) => Ok(ExitCode::SUCCESS),
        };
    };
    let mut failed = None;
    let written = target.write(|out| {
        let out = match format {
            Format::Csv => Out::Csv(Box::new(csv::Writer::from_writer(out as &mut dyn Write))),
            Format::Json => Out::Json(out),
            Format::Vtp => Out::Vtp(Box::default(), out),
        };
        steps.run(out).map_err(|stop| match stop {
            Stop::File(text) => text,
            Stop::Other(error) => failed.insert(error).to_string(),
        })
    });
    match failed {
        Some(error) => Err(error),
        None => written.map(|()| ExitCode::SUCCESS),
    }
}

struct Steps<'a> {
    args: &'a DetectArgs,
    all: &'a Sequence,
    query: Query,
    detector: OneQuery,
    faces: Option<FileFaces>,
}

impl Steps<'_> {
    fn new<'a>(
        args: &'a DetectArgs,
        all: &'a Sequence,
        device: Device,
        (scene, query): (Scene, Query),
    ) -> Result<Steps<'a>, Error> {
        let faces = args.out.file_faces.then(|| FileFaces::of(scene.bodies(), &all.polygons));
        let detector = during("building", || OneQuery::new(device, scene, query))?;
        Ok(Steps { args, all, query, detector, faces })
    }

    fn run(mut self, mut out: Out) -> Result<(), Stop> {
        let (at_rest, mut told, mut total) = (self.query.kind().is_at_rest(), Vec::new(), Total::default());
        if let Out::Json(out) = &mut out {
            out.write_all(b"{\"steps\":[").map_err(|e| Stop::File(e.to_string()))?;
        }
        for step in 0..self.all.steps(at_rest) {
            let found = during(format!("step {step}"), || self.ask(step, at_rest))?;
            let report = self.report(step, &found);
            let places = places(self.args, &mut self.detector, &found)?;
            self.put(&mut out, &found, &report, &places).map_err(Stop::File)?;
            total.add(step, &found);
            if self.args.out.json {
                told.push(report);
            } else {
                let verbose = self.args.out.verbose;
                let head = if step == 0 && verbose { self.head(&report) } else { String::new() };
                print(&(head + &line(&report, at_rest, verbose)))?;
            }
        }
        match &mut out {
            Out::Nowhere => Ok(()),
            Out::Csv(csv) => csv.flush().map_err(|e| e.to_string()),
            Out::Json(out) => out.write_all(b"]}").map_err(|e| e.to_string()),
            Out::Vtp(vtp, out) => vtp.write(*out).map_err(|e| e.to_string()),
        }
        .map_err(Stop::File)?;
        if self.args.out.json {
            #[derive(Serialize)]
            struct All {
                steps: Vec<Report>,
            }
            let text = serde_json::to_string(&All { steps: told });
            let text = text.map_err(|e| Error::Bug { what: e.to_string() })?;
            print(&(text + "\n"))?;
        } else {
            print(&total.text(at_rest))?;
        }
        Ok(())
    }

    /// A detector begins where the first step does.
    fn ask(&mut self, step: usize, at_rest: bool) -> Result<Contacts, Error> {
        let anew =
            self.args.research.rebuild_every.is_some_and(|every| (step as u64).is_multiple_of(every.into()));
        let inputs = self.all.inputs(self.detector.scene(), step, at_rest);
        match step {
            0 => self.detector.detect(),
            _ if anew => {
                self.detector.update(&inputs)?;
                self.detector.rebuild()?;
                self.detector.detect()
            }
            _ => self.detector.frame(&inputs),
        }
    }

    /// The summary. Seams of a mesh are noted once.
    fn report(&mut self, step: usize, found: &Contacts) -> Report {
        let mut summary = self.detector.summary(found);
        summary.frames = if self.query.kind().is_at_rest() { 1 } else { 2 };
        summary.notes.retain(|note| step == 0 || !matches!(note, Note::Coincident { .. }));
        Report { step: Some(step), summary }
    }

    fn put(&self, out: &mut Out, found: &Contacts, report: &Report, places: &Places) -> Result<(), String> {
        if matches!(out, Out::Nowhere) {
            return Ok(());
        }
        let named = self.faces.as_ref().map(|faces| faces.name(&found.rows));
        let geometry = self.args.out.geometry.then_some(&places.geometry);
        let (answer, names) = (named.as_ref().unwrap_or(&found.rows), self.all.names.as_deref());
        match out {
            Out::Nowhere => Ok(()),
            Out::Csv(csv) => {
                let columns = Columns { step: report.step, names, faces: named.is_some(), geometry };
                if report.step == Some(0) {
                    columns.head(csv, answer)?;
                }
                columns.rows(csv, answer)
            }
            Out::Vtp(vtp, _) => {
                vtp.add(report.step, answer, places);
                Ok(())
            }
            Out::Json(out) => {
                #[derive(Serialize)]
                struct Step<'a> {
                    step: Option<usize>,
                    summary: &'a Report,
                    contacts: JsonRows<'a>,
                }
                if report.step != Some(0) {
                    out.write_all(b",").map_err(|e| e.to_string())?;
                }
                let step = Step {
                    step: report.step,
                    summary: report,
                    contacts: JsonRows { answer, names, geometry },
                };
                serde_json::to_writer(out, &step).map_err(|e| e.to_string())
            }
        }
    }

    /// The scene and the query, for all steps.
    fn head(&self, report: &Report) -> String {
        let summary = &report.summary;
        format!(
            "{}, {}, {}, {}; {} query by {} on {}\n",
            counted(self.detector.scene().ids().count() as u64, "body", "bodies"),
            counted(summary.triangles as u64, "triangle", "triangles"),
            counted(summary.vertices as u64, "vertex", "vertices"),
            counted(self.all.frames as u64, "frame", "frames"),
            summary.query,
            summary.solver,
            summary.device
        )
    }
}

/// A step on a line, with its notes and caveats below.
fn line(report: &Report, at_rest: bool, verbose: bool) -> String {
    let (summary, name) = (&report.summary, if at_rest { "frame" } else { "step" });
    let found = text::found(summary);
    let mut text = format!("{name} {}: {found}; {} ms", report.step.unwrap_or(0), digits(summary.ms.wall));
    if verbose {
        text += &format!(", frame {:.3} ms, wall {:.3} ms", summary.ms.total, summary.ms.wall);
        text += &format!("; hash {}", summary.hash);
    }
    text + "\n" + &text::remarks(summary)
}

/// The sum of all steps.
#[derive(Default)]
struct Total {
    steps: u64,
    contacts: u64,
    /// Wall time, milliseconds.
    ms: f64,
    first: Option<(usize, f64)>,
    /// The least distance, and its frame.
    nearest: Option<(f64, usize)>,
}

impl Total {
    fn add(&mut self, step: usize, found: &Contacts) {
        self.steps += 1;
        self.contacts += found.len() as u64;
        self.ms += found.stats.stages.wall;
        self.first = self.first.or(found.earliest_toi().map(|toi| (step, toi)));
        let nearer = |least: f64| self.nearest.is_none_or(|(other, _)| least < other);
        if let Some(least) = found.distance().filter(|&least| nearer(least)) {
            self.nearest = Some((least, step));
        }
    }

    fn text(&self, at_rest: bool) -> String {
        let [name, names] = if at_rest { ["frame", "frames"] } else { ["step", "steps"] };
        let first = |(step, toi)| format!(", first in step {step} at t = {}", text::below(toi));
        let found = match self.nearest {
            Some((least, step)) => {
                format!("least distance {least}, in {name} {step} of {}", self.steps)
            }
            None => format!(
                "{} in {}{}",
                counted(self.contacts, "contact", "contacts"),
                counted(self.steps, name, names),
                self.first.map_or(String::new(), first)
            ),
        };
        format!("{found}; {} ms\n", digits(self.ms))
    }
}
