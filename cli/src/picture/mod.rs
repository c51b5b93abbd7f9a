//! `picture`: the bodies of a frame as a PNG, or of each frame, with what meets in red.

mod camera;
mod draw;
mod marks;
mod raster;
mod shade;

use crate::args::PictureArgs;
use crate::args::picture::{Around, Fit, LookArgs, check};
use crate::detect::{Question, keeps, promise, question, series};
use crate::output::{Target, print, say};
use crate::paint::{self, GREY, ORANGE, Paint, Painted, RED};
use crate::progress::during;
use crate::sequence::{PARTIAL, Sequence, Walk, check_name, named, untested};
use camera::Camera;
pub use camera::bounds;
use draw::Picture;
use nearmiss::contacts::{Contacts, Geometry, Rows};
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::Body;
use nearmiss::query::Query;
use nearmiss::scene::Scene;
use nearmiss::words::counted;
use nearmiss_kernels::math::Vec3;
use nearmiss_lab::OneQuery;
pub use shade::colours as body_colours;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

/// Runs the query, draws the frame or each frame of a sequence, and prints the colours.
///
/// # Errors
/// - [`Error::InvalidArgument`] for a name that is not of a PNG, for several steps and a name without
///   `#`, and for a time of a frame at rest;
/// - [`Error::Output`] for a file that cannot be written;
/// - [`Error::OutOfMemory`] before the picture is drawn;
/// - those of the query and the machine.
pub fn picture(args: &PictureArgs) -> Result<ExitCode, Error> {
    let Some(out) = &args.detect.out.out else {
        return Err(Error::Bug { what: "a picture without --out".into() });
    };
    check("--out", out)?;
    keeps(&args.detect)?;
    // The files of a sequence are known when its frames are.
    let target = if named(out, 0).is_none() { Some(Target::open(out)?) } else { None };
    let Question { scene, query, sequence, notes, .. } = question(&args.detect)?;
    notes.iter().for_each(|note| say(note));
    let (look, at_rest) = (&args.look, query.kind().is_at_rest());
    let steps = sequence.as_ref().map_or(1, |all| all.steps(at_rest));
    check_name("--out", out, steps)?;
    if look.time > 0.0 && at_rest {
        let what = format!("--time has no effect: a {} query is about t = 0", query.kind());
        return Err(Error::InvalidArgument { what, advice: "remove it, or use --continuous".into() });
    }
    promise(&query);
    if let Some(all) = sequence.filter(|_| steps > 1) {
        return film(args, out, &all, (scene, query));
    }
    if look.fit.is_some() {
        let what = "--fit has no effect: there is one step or frame".into();
        return Err(Error::InvalidArgument { what, advice: "remove it, or give more frames".into() });
    }
    let target = target.map_or_else(|| Target::open(out), Ok)?;
    let device = args.detect.machine.open()?;
    let mut detector = during("building", || OneQuery::new(device, scene, query))?;
    let found = during("detecting", || detector.detect())?;
    draw(args, (&mut detector, &found), None, (target, &out.display().to_string()))?;
    Ok(ExitCode::SUCCESS)
}

/// Draws all frames of a sequence.
fn film(
    args: &PictureArgs,
    out: &Path,
    all: &Sequence,
    (scene, query): (Scene, Query),
) -> Result<ExitCode, Error> {
    let (look, at_rest) = (&args.look, query.kind().is_at_rest());
    let around_met = look.around == Around::Contacts;
    if look.fit == Some(Fit::All) && around_met {
        return Err(Error::InvalidArgument {
            what: "--fit all cannot be used with --around contacts".into(),
            advice: "remove one of them".into(),
        });
    }
    let targets = series(&args.detect, all, ("--out", out), at_rest)?;
    let is_one = look.fit == Some(Fit::All) || (look.fit.is_none() && !around_met);
    let directions = [look.direction.view, look.direction.up].map(unit);
    let camera = is_one.then(|| Camera::new(all.corners(), std::iter::empty(), directions, look.size));
    let mut walk = Walk::new(&args.detect, all, (scene, query))?;
    let mut code = ExitCode::SUCCESS;
    for (step, target) in targets.into_iter().enumerate() {
        let moment = all.film.moment(step);
        if let Some(reason) = all.film.reason(step, at_rest) {
            print(&untested(&moment, at_rest, reason))?;
            code = ExitCode::from(PARTIAL);
            continue;
        }
        let found = walk.at(step)?;
        let name = named(out, moment.number()).unwrap_or_default().display().to_string();
        draw(args, (&mut walk.detector, &found), camera.as_ref(), (target, &name))?;
    }
    Ok(code)
}

/// Draws a frame, by this camera or by its own, and prints the colours.
fn draw(
    args: &PictureArgs,
    (detector, found): (&mut OneQuery, &Contacts),
    camera: Option<&Camera>,
    (target, name): (Target, &str),
) -> Result<(), Error> {
    let look = &args.look;
    let geometry = match &found.rows {
        Rows::Contacts(_) | Rows::Near(_) => detector.geometry(found)?,
        // Triangles are coloured by their numbers.
        Rows::Pairs(_)
        | Rows::Distance(_)
        | Rows::BodyPairs(_)
        | Rows::BodyDistances(_)
        | Rows::Earliest(_) => Geometry::default(),
    };
    let (bodies, paint) = (detector.scene().bodies(), Paint::of(args.detect.out.heat));
    let triangles: usize = bodies.iter().map(Body::element_count).sum();
    memory::require("the picture", draw::bytes(look.size, triangles))?;
    let painted = paint::paint(bodies, look.time, (found, geometry.contacts()), paint)?;
    let points = painted.mesh.positions().to_f64();
    let marks = marks::of(bodies, &points, found, geometry.contacts());
    let pixels = pixels(look, bodies, &painted, (&points, &marks), camera);
    target.write(|out| encode(out, look.size, &pixels).map_err(|e| e.to_string()))?;
    let of = counted(triangles as u64, "triangle", "triangles");
    let [width, height] = look.size;
    let coloured = |colour| painted.colours.iter().filter(|own| **own == colour).count();
    let colours = match paint {
        Paint::Contact => format!("{} red, {} orange", coloured(RED), coloured(ORANGE)),
        Paint::Heat => {
            let most = painted.counts.iter().max().copied().unwrap_or(0);
            format!("{} in contact, at most {most} contacts each", triangles - coloured(GREY))
        }
    };
    print(&format!("{name}: {width}x{height}, {of}, {colours}\n"))
}

/// Draws coloured bodies at rest, as without options.
///
/// # Errors
/// [`Error::OutOfMemory`], and [`Error::Output`].
pub fn write(target: Target, bodies: &[Body], painted: &Painted) -> Result<(), Error> {
    let look = LookArgs::usual();
    memory::require("the picture", draw::bytes(look.size, painted.mesh.face_count()))?;
    let pixels = pixels(&look, bodies, painted, (&painted.mesh.positions().to_f64(), &[]), None);
    target.write(|out| encode(out, look.size, &pixels).map_err(|e| e.to_string()))
}

/// The pixels of coloured bodies; triangles without a colour have that of their body.
fn pixels(
    look: &LookArgs,
    bodies: &[Body],
    painted: &Painted,
    (points, marks): (&[[f64; 3]], &[[[f64; 3]; 2]]),
    camera: Option<&Camera>,
) -> Vec<u8> {
    let Painted { mesh, colours, .. } = painted;
    let own = shade::colours(bodies, mesh.faces(), points.len());
    let met = |(at, colour): (usize, &[u8; 3])| (*colour != GREY).then_some(at as u32);
    let met: Vec<u32> = colours.iter().enumerate().filter_map(met).collect();
    let colours: Vec<[u8; 3]> =
        colours.iter().zip(own).map(|(colour, own)| if *colour == GREY { own } else { *colour }).collect();
    let picture = Picture { points, faces: mesh.faces(), colours: &colours, met: &met, marks };
    let (directions, around_met) =
        ([look.direction.view, look.direction.up].map(unit), look.around == Around::Contacts);
    let fitted = || picture.camera(directions, look.size, around_met);
    during("drawing", || match camera {
        Some(camera) => picture.draw(camera, look.size),
        None => picture.draw(&fitted(), look.size),
    })
}

/// Writes pixels of three bytes as a PNG: the same bytes for the same pixels.
fn encode(out: &mut dyn Write, [width, height]: [usize; 2], pixels: &[u8]) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(out, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()
}

/// The product of two vectors that is at right angles to both.
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    Vec3(a).cross(Vec3(b)).0
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vec3(a).dot(Vec3(b))
}

fn scaled(of: [f64; 3], by: f64) -> [f64; 3] {
    of.map(|x| x * by)
}

/// A vector made of length 1; zeros of none.
fn unit(of: [f64; 3]) -> [f64; 3] {
    let length = dot(of, of).sqrt();
    if length > 0.0 { of.map(|x| x / length) } else { [0.0; 3] }
}
