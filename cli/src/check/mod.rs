//! `check`: whether meshes are free of faults that a solver or a printer cannot start with.

mod colours;
mod faces;
mod findings;
mod pairs;
mod text;

use crate::args::CheckArgs;
use crate::args::MEETS;
use crate::detect::body_of;
use crate::meshes::Reader;
use crate::output::{self, Target, print, say};
use crate::progress::during;
use crate::{paint, picture};
use findings::{Findings, Report};
use nearmiss::Discrete;
use nearmiss::contacts::crossing_curves;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::scene::{CollisionFilter, Scene};
use nearmiss::words::counted;
use nearmiss_io::Polygons;
use nearmiss_lab::OneQuery;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Checks the meshes; prints the findings, and writes the coloured mesh and the picture.
///
/// # Errors
/// Those of the files, of the machine and of output.
pub fn check(args: &CheckArgs) -> Result<ExitCode, Error> {
    let mesh = target("--out-mesh", args.out_mesh.as_deref(), &args.meshes, paint::check)?;
    let picture = target("--picture", args.picture.as_deref(), &args.meshes, picture_name)?;
    let mut reader = Reader { strict: args.strict, problems: args.problems, ..Reader::default() };
    let read = |(at, file): (usize, &PathBuf)| -> Result<(Body, Polygons), Error> {
        let (body, polygons) = body_of(std::slice::from_ref(file), &mut reader)?;
        let environment = if args.each { at as u32 } else { 0 };
        let body = body.with_filter(CollisionFilter::in_environment(environment));
        let (body, merged) = if args.weld { body.weld() } else { (body, 0) };
        if args.weld {
            say(&format!("{}: {} merged", body.name(), counted(merged as u64, "vertex", "vertices")));
        }
        Ok((body, polygons))
    };
    let read = during("reading", || args.meshes.iter().enumerate().map(read).collect::<Result<Vec<_>, _>>())?;
    let (bodies, polygons): (Vec<Body>, Vec<Polygons>) = read.into_iter().unzip();
    let found = findings(args, Scene::from(bodies), &polygons)?;
    if mesh.is_some() || picture.is_some() {
        let painted = colours::painted(&found)?;
        mesh.map_or(Ok(()), |target| paint::write(target, &painted))?;
        picture.map_or(Ok(()), |target| picture::write(target, &found.bodies, &painted))?;
    }
    let report = Report::new(&found, args, reader.notes);
    if args.json {
        let text = serde_json::to_string(&report).map_err(|e| Error::Bug { what: e.to_string() })?;
        print(&(text + "\n"))?;
    } else {
        print(&text::text(&report))?;
    }
    Ok(if report.free { ExitCode::SUCCESS } else { ExitCode::from(MEETS) })
}

/// A file to write, if it is given.
fn target(
    option: &str,
    to: Option<&Path>,
    read: &[PathBuf],
    check: impl Fn(&Path) -> Result<(), Error>,
) -> Result<Option<Target>, Error> {
    let open = |to: &Path| {
        check(to)?;
        output::keeps(option, to, read.iter().map(PathBuf::as_path))?;
        Target::open(to)
    };
    to.map(open).transpose()
}

fn picture_name(path: &Path) -> Result<(), Error> {
    crate::args::picture::check("--picture", path)
}

/// Runs the query, and looks for all other faults.
fn findings(args: &CheckArgs, scene: Scene, polygons: &[Polygons]) -> Result<Findings, Error> {
    let device = args.machine.open()?;
    let query = Discrete::default().with_adjacent(true);
    let mut detector = during("building", || OneQuery::new(device, scene, query))?;
    let found = during("detecting", || detector.detect())?;
    let geometry = during("locating", || detector.geometry(&found))?;
    let curves = crossing_curves(geometry.pairs(), detector.scene().bodies())?;
    let bodies = detector.scene().bodies().to_vec();
    Ok(Findings::new(bodies, polygons, (geometry.pairs(), &curves.row_groups)))
}
