//! `view`: the bodies of all frames and the rows of the query as one page, which opens in a browser.

mod columns;
mod motion;
mod page;

use crate::args::ViewArgs;
use crate::args::view::check;
use crate::detect::text::{found as line, remarks};
use crate::detect::{Question, crossing, keeps, promise, question};
use crate::output::{Stop, Target, print, say};
use crate::paint::{self, GREY, Paint};
use crate::picture::{body_colours, bounds};
use crate::progress::during;
use crate::sequence::{Moment, PARTIAL, Sequence, Walk, untested};
use columns::Columns;
use motion::Motions;
use nearmiss::contacts::Contacts;
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::Body;
use nearmiss::query::Query;
use nearmiss::research::{DetectorExt, QueryExt};
use nearmiss::scene::Scene;
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use page::{About, Frame, Page, Tested};
use std::process::ExitCode;

/// Bytes that a triangle takes while the page is written: places, colours and their text.
const OF_A_TRIANGLE: u64 = 300;

/// Runs the query for each step or frame, and writes the page.
///
/// # Errors
/// - [`Error::InvalidArgument`] for a name that is not of a page;
/// - [`Error::Output`] for a file that cannot be written;
/// - [`Error::OutOfMemory`] before the page is begun;
/// - those of the query and the machine.
pub fn view(args: &ViewArgs) -> Result<ExitCode, Error> {
    let Some(out) = &args.detect.out.out else {
        return Err(Error::Bug { what: "a view without --out".into() });
    };
    check(out)?;
    keeps(&args.detect)?;
    let target = Target::open(out)?;
    let Question { scene, query, sequence, notes, .. } = question(&args.detect)?;
    notes.iter().for_each(|note| say(note));
    promise(&query);
    let [triangles, elements] = [Body::face_count, Body::element_count]
        .map(|count| scene.bodies().iter().map(count).sum::<usize>() as u64);
    memory::require("the page", elements * OF_A_TRIANGLE)?;
    let about = about(args, (&scene, &query), sequence.as_ref())?;
    let (mut steps, name) = (0, out.display().to_string());
    let mut code = ExitCode::SUCCESS;
    let at_rest = query.kind().is_at_rest();
    let written = target.write_while(|out| {
        let mut view = View::begin(args, &scene, about, out)?;
        match &sequence {
            None => {
                let device = args.detect.machine.open()?;
                let mut detector = during("building", || OneQuery::new(device, scene, query))?;
                let found = during("detecting", || detector.detect())?;
                let moment = Moment { step: 0, frame: None, file: None };
                view.add(moment, &mut detector, &found)?;
                steps = 1;
            }
            Some(all) => {
                steps = all.steps(at_rest);
                let mut walk = Walk::new(&args.detect, all, (scene, query))?;
                for step in 0..steps {
                    let moment = all.film.moment(step);
                    if let Some(reason) = all.film.reason(step, at_rest) {
                        print(&untested(&moment, at_rest, reason))?;
                        view.page.pass(moment, reason);
                        code = ExitCode::from(PARTIAL);
                        continue;
                    }
                    let found = walk.at(step)?;
                    view.add(moment, &mut walk.detector, &found)?;
                }
            }
        }
        view.end()
    })?;
    let of = if at_rest { ["frame", "frames"] } else { ["step", "steps"] };
    let moments = counted(steps as u64, of[0], of[1]);
    let loose = match elements - triangles {
        0 => String::new(),
        loose => format!(", {}", counted(loose, "edge or point", "edges and points")),
    };
    let triangles = counted(triangles, "triangle", "triangles") + &loose;
    let rows = counted(written.rows, "row", "rows");
    let megabytes = written.bytes as f64 / 1e6;
    print(&format!("{name}: {moments}, {triangles}, {rows}, {megabytes:.1} MB\n"))?;
    Ok(code)
}

/// The part of the page that all frames share.
fn about(
    args: &ViewArgs,
    (scene, query): (&Scene, &Query),
    sequence: Option<&Sequence>,
) -> Result<About, Error> {
    let bodies = scene.bodies();
    let (low, high) = match sequence {
        Some(all) => bounds(all.corners()),
        None => {
            let ends = [paint::merged(bodies, 0.0)?, paint::merged(bodies, 1.0)?];
            let corner = |mesh: &nearmiss::Mesh, vertex: &u32| mesh.positions().get_f64(*vertex as usize);
            bounds(ends.iter().flat_map(|mesh| {
                mesh.faces().iter().flatten().filter_map(move |vertex| corner(mesh, vertex))
            }))
        }
    };
    let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let named = sequence.and_then(|all| all.names.clone()).filter(|_| args.detect.meshes.len() == 1);
    let first = args.detect.meshes.first().map(|file| crate::stem(file));
    let subject = args.detect.query.scene.clone().or(first).unwrap_or_default();
    Ok(About {
        title: format!("{subject}: {} query by {}", query.kind(), query.solver()),
        middle: [0, 1, 2].map(|k| low[k] / 2.0 + high[k] / 2.0),
        side: if longest > 0.0 { longest } else { 1.0 },
        at_rest: query.kind().is_at_rest(),
        direction: [args.direction.view, args.direction.up],
        columns: Columns::of(query, bodies.len()),
        names: named.unwrap_or_else(|| names(bodies)),
    })
}

/// The names of bodies that no scene file has named; several also have their number.
fn names(bodies: &[Body]) -> Vec<String> {
    let name = |(at, body): (usize, &Body)| match bodies {
        [_] => body.name().to_owned(),
        _ => format!("{at} {}", body.name()),
    };
    bodies.iter().enumerate().map(name).collect()
}

/// A page that is being written.
struct View<'a> {
    page: Page<'a>,
    motions: Motions,
    paint: Paint,
}

impl<'a> View<'a> {
    /// Writes the part that all frames share: the triangles and the colours of the bodies.
    fn begin(
        args: &ViewArgs,
        scene: &Scene,
        about: About,
        out: &'a mut dyn std::io::Write,
    ) -> Result<View<'a>, Stop> {
        let bodies = scene.bodies();
        let mesh = paint::merged(bodies, 0.0)?;
        let colours = body_colours(bodies, mesh.faces(), mesh.vertex_count());
        let motions = Motions::of(bodies);
        let page = Page::begin(out, about, bodies, (mesh.faces(), &colours)).map_err(Stop::File)?;
        Ok(View { page, motions, paint: Paint::of(args.detect.out.heat) })
    }

    /// Writes a step or frame that has been tested.
    fn add(&mut self, moment: Moment, detector: &mut OneQuery, found: &Contacts) -> Result<(), Stop> {
        let geometry = match self.page.about.columns.has_geometry {
            true => detector.geometry(found)?,
            false => Default::default(),
        };
        let summary = detector.summary(found);
        let bodies = detector.scene().bodies();
        let (ends, turns, stored) = self.motions.step(bodies, &self.page.about);
        self.page.places(&stored).map_err(Stop::File)?;
        let painted = paint::paint(bodies, 0.0, (found, geometry.contacts()), self.paint)?;
        let met = painted.colours.iter().enumerate().filter(|(_, colour)| **colour != GREY);
        let met = met.flat_map(|(at, [r, g, b])| [at as u32, u32::from_be_bytes([0, *r, *g, *b])]);
        let starts: Vec<u32> = paint::starts(bodies).into_iter().map(|(vertex, _)| vertex).collect();
        let rows = self.page.about.rows(found, &geometry, &starts);
        let lines = remarks(&summary);
        let remarks = std::iter::once(line(&summary, crossing(detector)?))
            .chain(lines.lines().map(|line| line.trim().to_owned()))
            .chain([format!("hash {}", summary.hash)]);
        let [starts, ends] = ends;
        let tested = Tested { rows: found.len(), remarks: remarks.collect(), starts, ends, turns };
        self.page.frame(Frame { moment, tested, met: met.collect(), rows }).map_err(Stop::File)
    }

    fn end(self) -> Result<page::Written, Stop> {
        self.page.end().map_err(Stop::File)
    }
}
