//! `detect` of several steps or frames, one after the other, by one detector.

use super::film::Moment;
use super::lines::{Total, line, untested};
use super::{Sequence, Walk, check_name};
use crate::args::DetectArgs;
use crate::detect::text::elements;
use crate::detect::{Places, crossing, places, promise, shown};
use crate::output::{Stop, Target, print};
use crate::paint::{self, Paint};
use crate::report::{FileFaces, Format, Report};
use crate::rows::{Columns, JsonRows};
use crate::vtp::Vtp;
use nearmiss::contacts::{Contacts, Geometry, Note};
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::research::DetectorExt;
use nearmiss::scene::Scene;
use nearmiss::words::counted;
use serde::Serialize;
use std::io::Write;
use std::process::ExitCode;

/// Exit status of a sequence with steps that could not be tested: that of bad input.
pub const PARTIAL: u8 = 3;

/// The target of rows.
enum Out<'a> {
    Nowhere,
    /// The file, and the number of its columns.
    Csv(Box<csv::Writer<&'a mut dyn Write>>, usize),
    Json(&'a mut dyn Write),
    /// Kept until the last step: its cells stand in another order.
    Vtp(Box<Vtp>, &'a mut dyn Write),
}

/// Refuses options of one step that several do not have, and those of several that one does not have.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(args: &DetectArgs, steps: usize) -> Result<(), Error> {
    let refused = |option: &str, why: &str, advice: &str| {
        let what = format!("{option} has no effect: {why}");
        Err(Error::InvalidArgument { what, advice: advice.into() })
    };
    let one = "remove it, or give one step or frame";
    let research = &args.research;
    match (steps > 1, research.rebuild_every) {
        (true, _) if research.only.is_some() => refused("--only", "each of several steps runs once", one),
        (true, _) if research.repeat > 1 => refused("--repeat", "each of several steps runs once", one),
        (false, every) if every.is_some() || research.rebuild.is_some() => {
            let option = if every.is_some() { "--rebuild-every" } else { "--rebuild" };
            refused(option, "the tree of the first step is new", "remove it, or give more frames")
        }
        (false, _) if args.query.keep_going => {
            refused("--keep-going", "there is one step or frame", "remove it, or give more frames")
        }
        _ => args.out.out_mesh.as_ref().map_or(Ok(()), |out| check_name("--out-mesh", out, steps)),
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
    painted: Vec<Target>,
) -> Result<ExitCode, Error> {
    promise(&query);
    let walk = Walk::new(args, all, (scene, query))?;
    let faces = args.out.file_faces.then(|| FileFaces::of(walk.detector.scene().bodies(), &all.polygons));
    let steps = Steps { args, query, walk, faces, painted, total: Total::default() };
    let Some((format, target)) = target else {
        return match steps.run(Out::Nowhere) {
            Err(Stop::Other(error)) => Err(error),
            Err(Stop::File(text)) => Err(Error::Bug { what: text }),
            Ok(code) => Ok(code),
        };
    };
    target.write_while(|out| {
        steps.run(match format {
            Format::Csv => Out::Csv(Box::new(csv::Writer::from_writer(out)), 0),
            Format::Json => Out::Json(out),
            Format::Vtp => Out::Vtp(Box::default(), out),
        })
    })
}

struct Steps<'a> {
    args: &'a DetectArgs,
    query: Query,
    walk: Walk<'a>,
    faces: Option<FileFaces>,
    /// The coloured meshes to write, one a step.
    painted: Vec<Target>,
    total: Total,
}

/// A step in JSON that could not be tested.
#[derive(Serialize)]
struct Untested<'a> {
    #[serde(flatten)]
    moment: &'a Moment,
    reason: &'a str,
}

/// A step in the printed JSON.
#[derive(Serialize)]
#[serde(untagged)]
enum Printed {
    Tested(Box<Report>),
    Untested {
        #[serde(flatten)]
        moment: Moment,
        reason: String,
    },
}

impl Steps<'_> {
    fn run(mut self, mut out: Out) -> Result<ExitCode, Stop> {
        let (at_rest, all) = (self.query.kind().is_at_rest(), self.walk.all);
        let (json, mut told) = (self.args.out.json, Vec::new());
        self.begin(&mut out).map_err(Stop::File)?;
        let mut painted = std::mem::take(&mut self.painted).into_iter();
        for step in 0..all.steps(at_rest) {
            let (moment, mesh) = (all.film.moment(step), painted.next());
            if let Some(reason) = all.film.reason(step, at_rest) {
                self.pass(&mut out, &moment, reason).map_err(Stop::File)?;
                self.total.pass();
                match json {
                    true => told.push(Printed::Untested { moment, reason: reason.into() }),
                    false => print(&untested(&moment, at_rest, reason))?,
                }
                continue;
            }
            let report = self.step(&moment, &mut out, mesh)?;
            if json {
                told.push(Printed::Tested(Box::new(report)));
            } else {
                let verbose = self.args.out.verbose;
                let is_first = verbose && self.total.is_first();
                let head = if is_first { self.head(&report) } else { String::new() };
                print(&(head + &line(&report, &moment, at_rest, verbose)))?;
            }
        }
        match &mut out {
            Out::Nowhere => Ok(()),
            Out::Csv(csv, _) => csv.flush().map_err(|e| e.to_string()),
            Out::Json(out) => out.write_all(b"]}").map_err(|e| e.to_string()),
            Out::Vtp(vtp, out) => vtp.write(*out).map_err(|e| e.to_string()),
        }
        .map_err(Stop::File)?;
        if json {
            #[derive(Serialize)]
            struct All {
                steps: Vec<Printed>,
            }
            let text = serde_json::to_string(&All { steps: told });
            let text = text.map_err(|e| Error::Bug { what: e.to_string() })?;
            print(&(text + "\n"))?;
        } else {
            print(&self.total.text(self.query.kind()))?;
        }
        Ok(match (self.total.is_partial(), self.args.out.fails(self.total.meets)) {
            (true, _) => ExitCode::from(PARTIAL),
            (false, code) => code,
        })
    }

    /// Runs a step, and writes its rows and its mesh.
    fn step(&mut self, moment: &Moment, out: &mut Out, mesh: Option<Target>) -> Result<Report, Stop> {
        let found = self.walk.at(moment.step)?;
        let found = shown(self.args, &mut self.walk.detector, found)?;
        let mut report = self.report(moment, &found);
        let places = places(self.args, &mut self.walk.detector, &found)?;
        if let Some(target) = mesh {
            let bodies = self.walk.detector.scene().bodies();
            let (geometry, paint) = (places.geometry.contacts(), Paint::of(self.args.out.heat));
            paint::write(target, &paint::paint(bodies, 0.0, (&found, geometry), paint)?)?;
        }
        report.crossing = crossing(&mut self.walk.detector)?;
        self.put(out, &found, &report, &places).map_err(Stop::File)?;
        self.total.add(moment, &found, report.crossing);
        Ok(report)
    }

    /// The summary. Seams of a mesh are noted once.
    fn report(&mut self, moment: &Moment, found: &Contacts) -> Report {
        let mut summary = self.walk.detector.summary(found);
        summary.frames = if self.query.kind().is_at_rest() { 1 } else { 2 };
        let is_first = self.total.is_empty();
        summary.notes.retain(|note| is_first || !matches!(note, Note::Coincident { .. }));
        Report { moment: Some(moment.clone()), crossing: None, summary }
    }

    /// Columns of the rows of a step.
    fn columns<'a>(&'a self, moment: &'a Moment, geometry: Option<&'a Geometry>) -> Columns<'a> {
        Columns {
            moment: Some(moment),
            has_reason: self.args.query.keep_going,
            names: self.walk.all.names.as_deref(),
            faces: self.faces.is_some(),
            geometry,
        }
    }

    /// Writes the beginning of a file.
    fn begin(&self, out: &mut Out) -> Result<(), String> {
        match out {
            Out::Csv(csv, count) => {
                let (moment, none) =
                    (self.walk.all.film.moment(0), Contacts::none(self.args.shown(self.query)));
                let empty = Geometry::default();
                let columns = self.columns(&moment, self.args.out.geometry.then_some(&empty));
                *count = columns.head(csv, &none.rows)?;
                Ok(())
            }
            Out::Json(out) => out.write_all(b"{\"steps\":[").map_err(|e| e.to_string()),
            Out::Nowhere | Out::Vtp(..) => Ok(()),
        }
    }

    /// Writes a step that is not tested.
    fn pass(&self, out: &mut Out, moment: &Moment, reason: &str) -> Result<(), String> {
        match out {
            Out::Csv(csv, count) => self.columns(moment, None).untested(csv, reason, *count),
            Out::Json(out) => self.json(*out, moment, &Untested { moment, reason }),
            Out::Nowhere | Out::Vtp(..) => Ok(()),
        }
    }

    /// Writes a step of JSON.
    fn json(&self, out: &mut dyn Write, moment: &Moment, step: &impl Serialize) -> Result<(), String> {
        if moment.step > 0 {
            out.write_all(b",").map_err(|e| e.to_string())?;
        }
        serde_json::to_writer(out, step).map_err(|e| e.to_string())
    }

    /// Writes the rows of a step.
    fn put(&self, out: &mut Out, found: &Contacts, report: &Report, places: &Places) -> Result<(), String> {
        let Some(moment) = report.moment.as_ref().filter(|_| !matches!(out, Out::Nowhere)) else {
            return Ok(());
        };
        let named = self.faces.as_ref().map(|faces| faces.name(&found.rows));
        let geometry = self.args.out.geometry.then_some(&places.geometry);
        let (answer, names) = (named.as_ref().unwrap_or(&found.rows), self.walk.all.names.as_deref());
        match out {
            Out::Nowhere => Ok(()),
            Out::Csv(csv, _) => self.columns(moment, geometry).rows(csv, answer),
            Out::Vtp(vtp, _) => {
                vtp.add(Some(moment.step), answer, places);
                Ok(())
            }
            Out::Json(out) => {
                #[derive(Serialize)]
                struct Step<'a> {
                    #[serde(flatten)]
                    moment: &'a Moment,
                    summary: &'a Report,
                    contacts: JsonRows<'a>,
                }
                let contacts = JsonRows { answer, names, geometry };
                self.json(*out, moment, &Step { moment, summary: report, contacts })
            }
        }
    }

    /// The scene and the query, for all steps.
    fn head(&self, report: &Report) -> String {
        let summary = &report.summary;
        format!(
            "{}, {}, {}, {}; {} query by {} on {}\n",
            counted(self.walk.detector.scene().ids().count() as u64, "body", "bodies"),
            elements(summary),
            counted(summary.vertices as u64, "vertex", "vertices"),
            counted(self.walk.all.frames as u64, "frame", "frames"),
            summary.query,
            summary.solver,
            summary.device
        )
    }
}
