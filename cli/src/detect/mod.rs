//! `detect`.

pub mod text;

use crate::args::DetectArgs;
use crate::meshes::Reader;
use crate::output::{self, Target, print, say};
use crate::paint::{self, Paint};
use crate::progress::during;
use crate::report::{self, FileFaces, Format, Report};
use crate::rows::numbered;
use crate::sequence::{self, Sequence, is_scene, steps};
use nearmiss::Stages;
use nearmiss::contacts::{Contacts, Curves, Geometry, Note, Rows, crossing_curves};
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::{Discrete, Query, QueryKind};
use nearmiss::research::{DetectorExt, QueryExt, Traversal};
use nearmiss::scene::Scene;
use nearmiss::words::counted;
use nearmiss_io::Polygons;
use nearmiss_lab::OneQuery;
use std::ops::DerefMut;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A body from one file, or from two frames. Notes of its readers go to standard error.
pub fn body(files: &[PathBuf]) -> Result<Body, Error> {
    let mut reader = Reader::default();
    let (body, _) = body_of(files, &mut reader)?;
    reader.notes.iter().for_each(|note| say(note));
    Ok(body)
}

/// The same with the faces of the file; the reader keeps the notes.
pub fn body_of(files: &[PathBuf], reader: &mut Reader) -> Result<(Body, Polygons), Error> {
    match files {
        [t0, t1] => {
            let t0 = reader.mesh(t0)?;
            let t1 = reader.frame(&t0, t1)?;
            let polygons = t0.polygons().clone();
            Ok((Body::moving(t0.into_mesh(), t1.into_mesh())?, polygons))
        }
        [still] => {
            let file = reader.mesh(still)?;
            let polygons = file.polygons().clone();
            Ok((Body::deformable(file.into_mesh()), polygons))
        }
        // `args` takes one or two.
        _ => Err(Error::Bug { what: format!("{} files for a mesh", files.len()) }),
    }
}

/// The query and its bodies.
pub struct Question {
    /// The bodies, at the first step or frame.
    pub scene: Scene,
    /// The query.
    pub query: Query,
    /// All frames, of a scene's file and of more than two frames.
    pub sequence: Option<Sequence>,
    /// Faces of the files behind the triangles of each body.
    pub polygons: Vec<Polygons>,
    /// Notes of the readers of its files.
    pub notes: Vec<String>,
}

/// Reads the bodies and makes the query; `--weld` merges vertices.
pub fn question(args: &DetectArgs) -> Result<Question, Error> {
    let files = [&args.meshes, &args.query.with];
    let is_read = args.query.scene.is_none();
    if is_read && !files.iter().any(|files| files.iter().any(|file| is_scene(file))) {
        // Before anything is read.
        let frames = files.map(Vec::len).into_iter().max().unwrap_or(1);
        let query = args.to_query(frames > 1)?;
        steps::check(args, Sequence::steps_of(frames, query.kind().is_at_rest()))?;
    }
    let mut reader = Reader {
        strict: args.query.strict,
        keep_going: args.query.keep_going,
        problems: args.query.problems,
        ..Reader::default()
    };
    if is_read && let Some(all) = during("reading", || Sequence::of(args, &mut reader))? {
        let query = args.to_query(all.frames > 1)?;
        steps::check(args, all.steps(query.kind().is_at_rest()))?;
        let scene = all.scene(query.kind().is_at_rest())?;
        let polygons = all.polygons.clone();
        return Ok(Question { scene, query, sequence: Some(all), polygons, notes: reader.notes });
    }
    let (bodies, polygons) = bodies(args, &mut reader)?;
    let query = args.to_query(bodies.iter().any(Body::is_moving))?;
    Ok(Question { scene: bodies.into(), query, sequence: None, polygons, notes: reader.notes })
}

/// One mesh or two, at one frame or two, and the faces of their files.
fn bodies(args: &DetectArgs, reader: &mut Reader) -> Result<(Vec<Body>, Vec<Polygons>), Error> {
    let mut told = Vec::new();
    match &args.query.scene {
        Some(name) => {
            let body = during("making the scene", || {
                nearmiss_lab::scene::scene(
                    name,
                    args.query.triangles.unwrap_or(nearmiss_lab::scene::usual(name)),
                    args.query.seed,
                )
            })?;
            told.push((body, Polygons::default()));
        }
        None => told.push(during("reading", || body_of(&args.meshes, reader))?),
    }
    if !args.query.with.is_empty() {
        told.push(during("reading", || body_of(&args.query.with, reader))?);
    }
    let (bodies, polygons): (Vec<Body>, Vec<Polygons>) = told.into_iter().unzip();
    let mut bodies: Vec<Body> = bodies.into_iter().map(|body| args.body(body)).collect();
    if args.query.weld {
        for body in &mut bodies {
            let (welded, merged) = body.weld();
            let vertices = counted(merged as u64, "vertex", "vertices");
            say(&format!("{}: {vertices} merged", body.name()));
            *body = welded;
        }
    }
    Ok((bodies, polygons))
}

/// Warns if the solver can miss contacts.
pub fn promise(query: &Query) {
    if !query.solver().is_certain() {
        say(&format!("warning: the solver is {}", query.solver().promise()));
    }
}

/// The answer that is shown: with `--first-contacts` the contacts at an earliest time.
///
/// # Errors
/// Those of the device.
pub fn shown(args: &DetectArgs, detector: &mut OneQuery, found: Contacts) -> Result<Contacts, Error> {
    match args.query.first_contacts {
        true => detector.first_contacts(&found).map(Contacts::from),
        false => Ok(found),
    }
}

/// How many triangle pairs share a point where the bodies are, for queries at rest whose rows do not
/// show it: a face that is pierced in its middle has no features near.
///
/// # Errors
/// Those of the device.
pub fn crossing(detector: &mut OneQuery) -> Result<Option<u64>, Error> {
    match detector.query().kind() {
        QueryKind::Near | QueryKind::Distance | QueryKind::BodyDistances => {
            Ok(Some(detector.deref_mut().query(&Discrete::default())?.len() as u64))
        }
        _ => Ok(None),
    }
}

/// Refuses to write over what is read.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn keeps(args: &DetectArgs) -> Result<(), Error> {
    let targets = [("--out", &args.out.out), ("--out-mesh", &args.out.out_mesh)];
    // A file that does not exist is not read either.
    let mut there = targets
        .iter()
        .filter_map(|(option, to)| Some((*option, to.as_ref()?)))
        .filter(|(_, to)| to.exists())
        .peekable();
    if there.peek().is_none() {
        return Ok(());
    }
    let files = sequence::files(args);
    there.try_for_each(|(option, to)| output::keeps(option, to, files.iter().map(PathBuf::as_path)))
}

/// Runs the query; writes and prints the answer.
pub fn detect(args: &DetectArgs) -> Result<ExitCode, Error> {
    keeps(args)?;
    let target = match &args.out.out {
        Some(out) => Some((Format::of(out)?, Target::open(out)?)),
        None => None,
    };
    // The files of a sequence are known when its frames are.
    let painted = match &args.out.out_mesh {
        Some(out) if sequence::named(out, 0).is_some() => paint::check(out).map(|()| None)?,
        Some(out) => paint::check(out).and_then(|()| Target::open(out).map(Some))?,
        None => None,
    };
    let Question { scene, query, sequence, polygons, notes: of_files } = question(args)?;
    if let Some(all) = sequence.as_ref().filter(|all| all.steps(query.kind().is_at_rest()) > 1) {
        of_files.iter().for_each(|note| say(note));
        let painted = match &args.out.out_mesh {
            Some(out) => series(args, all, ("--out-mesh", out), query.kind().is_at_rest())?,
            None => Vec::new(),
        };
        return steps::detect(args, all, (scene, query), target, painted);
    }
    let painted = match (painted, &args.out.out_mesh) {
        (None, Some(out)) => Some(Target::open(out)?),
        (painted, _) => painted,
    };
    let device = args.machine.open()?;
    promise(&query);
    let mut detector = during("building", || OneQuery::new(device.clone(), scene, query))?;
    let research = &args.research;
    let often = if research.only.is_some() { 1 } else { research.repeat };
    let is_gpu = device.is_gpu();
    let (contacts, times) = during("detecting", || repeated(&mut detector, often, is_gpu))?;
    let contacts = shown(args, &mut detector, contacts)?;
    let mut summary = detector.summary(&contacts);
    summary.ms = times;
    if let Some(stage) = research.only {
        let times = during("repeating a stage", || detector.repeat_stage(stage, research.repeat))?;
        *summary.ms.of_mut(stage) = middle(times);
    }
    let faces = args.out.file_faces.then(|| FileFaces::of(detector.scene().bodies(), &polygons));
    if let Some(all) = &sequence {
        summary.frames = all.frames;
    }
    let places = places(args, &mut detector, &contacts)?;
    if let Some(target) = painted {
        let (geometry, of) = (places.geometry.contacts(), Paint::of(args.out.heat));
        let bodies = detector.scene().bodies();
        paint::write(target, &paint::paint(bodies, 0.0, (&contacts, geometry), of)?)?;
    }
    summary.notes.splice(..0, of_files.into_iter().map(|text| Note::File { text }));
    let told = Report { moment: None, crossing: crossing(&mut detector)?, summary };
    if let Some((format, target)) = target {
        let names = match &sequence {
            Some(all) => all.names.clone(),
            None => numbered(detector.scene().bodies().len()),
        };
        let places = (args.out.geometry || format == Format::Vtp).then_some(&places);
        report::write(target, format, &contacts, &told, (faces.as_ref(), names.as_deref()), places)?;
    }
    if args.out.json {
        let text = serde_json::to_string(&told).map_err(|e| Error::Bug { what: e.to_string() })?;
        print(&(text + "\n"))?;
    } else {
        // Medians are for reading.
        let verbose = args.out.verbose || research.repeat > 1;
        print(&text::human(&told, &contacts, verbose))?;
    }
    Ok(args.out.fails(text::meets(&contacts, told.crossing)))
}

/// The files of a sequence, one a step: `#` in the name is the number of the frame.
///
/// # Errors
/// [`Error::InvalidArgument`] for a file that is read; [`Error::Output`].
pub fn series(
    args: &DetectArgs,
    all: &Sequence,
    (option, pattern): (&str, &Path),
    at_rest: bool,
) -> Result<Vec<Target>, Error> {
    let read = sequence::files(args);
    let open = |step: usize| {
        let file = sequence::named(pattern, all.film.moment(step).number());
        let file = file.unwrap_or_else(|| pattern.to_owned());
        output::keeps(option, &file, read.iter().map(PathBuf::as_path))?;
        Target::open(&file)
    };
    (0..all.steps(at_rest)).map(open).collect()
}

/// The places of contacts.
#[derive(Default)]
pub struct Places {
    /// Geometry of each row; empty if no file needs it.
    pub geometry: Geometry,
    /// The curves in which triangles cross, for a `.vtp`.
    pub curves: Curves,
}

/// The places of contacts that a file needs.
///
/// # Errors
/// [`Error::OutOfMemory`]; those of the device.
pub fn places(args: &DetectArgs, detector: &mut OneQuery, found: &Contacts) -> Result<Places, Error> {
    let is_written = args.out.geometry || args.writes_vtp();
    let is_needed = match &found.rows {
        // A coloured mesh has the triangles of features, by their vertices.
        Rows::Contacts(_) | Rows::Near(_) => is_written || args.out.out_mesh.is_some(),
        Rows::Pairs(_) => is_written,
        // A time has none; a file of the nearest triangles takes their points from the answer.
        Rows::Earliest(_) | Rows::Distance(_) | Rows::BodyPairs(_) | Rows::BodyDistances(_) => false,
    };
    if !is_needed {
        return Ok(Places::default());
    }
    let geometry = detector.geometry(found)?;
    let curves = match args.writes_vtp() {
        true => crossing_curves(geometry.pairs(), detector.scene().bodies())?,
        false => Curves::default(),
    };
    Ok(Places { geometry, curves })
}

/// The answer, and the times: of several runs each stage's median. The first run only warms up.
/// Frames run without marks between their stages, then some with them, for the times of stages.
fn repeated(detector: &mut OneQuery, repeat: u32, is_gpu: bool) -> Result<(Contacts, Stages), Error> {
    let keeps_front = matches!(detector.query().search().traversal, Some(Traversal::Front(_)));
    let contacts = detector.detect()?;
    if repeat <= 1 {
        let times = contacts.stats.stages;
        return Ok((contacts, times));
    }
    let mut last = contacts;
    let mut run = |are_timed: bool, frames: u32| {
        let times = detector.times(are_timed, frames, |detector| {
            // A rebuilt tree would lose the front.
            if !keeps_front {
                detector.rebuild()?;
            }
            last = detector.detect()?;
            Ok(last.stats.stages)
        })?;
        Ok::<_, Error>(Stages::each(|stage| middle(times.iter().map(stage).collect())))
    };
    let times = run(false, repeat)?;
    let times = if is_gpu { times.with_stages(&run(true, repeat.min(MARKED))?) } else { times };
    Ok((last, times))
}

/// Frames at most that are run again for the times of their stages.
const MARKED: u32 = 10;

/// The median; of an even number the upper of the two in the middle, of none 0.
pub fn middle(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}
