//! `picture`: the bodies of a frame as a PNG, with what meets in red.

mod camera;
mod draw;
mod marks;
mod raster;
mod shade;

use crate::args::PictureArgs;
use crate::args::picture::{Around, check};
use crate::detect::{Question, keeps, promise, question};
use crate::output::{Target, print, say};
use crate::paint::{self, GREY, ORANGE, RED};
use crate::progress::during;
use draw::Picture;
use nearmiss::contacts::{Geometry, Rows};
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::words::counted;
use nearmiss_kernels::math::Vec3;
use nearmiss_lab::OneQuery;
use std::io::Write;
use std::process::ExitCode;

/// Runs the query, draws the frame, and prints the colours.
///
/// # Errors
/// - [`Error::InvalidArgument`] for a name that is not of a PNG, for several steps, and for a time of a
///   frame at rest;
/// - [`Error::Output`] for a file that cannot be written;
/// - [`Error::OutOfMemory`] before the picture is drawn;
/// - those of the query and the machine.
pub fn picture(args: &PictureArgs) -> Result<ExitCode, Error> {
    let Some(out) = &args.detect.out.out else {
        return Err(Error::Bug { what: "a picture without --out".into() });
    };
    check(out)?;
    keeps(&args.detect)?;
    let target = Target::open(out)?;
    let Question { scene, query, sequence, notes, .. } = question(&args.detect)?;
    notes.iter().for_each(|note| say(note));
    let steps = sequence.map_or(1, |all| all.steps(query.kind().is_at_rest()));
    if steps > 1 {
        let what = format!("a picture shows one step or frame, got {steps}");
        let advice = "give one mesh, or both ends of a step".into();
        return Err(Error::InvalidArgument { what, advice });
    }
    if args.look.time > 0.0 && query.kind().is_at_rest() {
        let what = format!("--time has no effect: a {} query is about t = 0", query.kind());
        return Err(Error::InvalidArgument { what, advice: "remove it, or use --continuous".into() });
    }
    let look = &args.look;
    let device = args.detect.machine.open()?;
    promise(&query);
    let mut detector = during("building", || OneQuery::new(device, scene, query))?;
    let found = during("detecting", || detector.detect())?;
    let geometry = match &found.rows {
        Rows::Contacts(_) | Rows::Near(_) => detector.geometry(&found)?,
        // Triangles are coloured by their numbers.
        Rows::Pairs(_)
        | Rows::Distance(_)
        | Rows::BodyPairs(_)
        | Rows::BodyDistances(_)
        | Rows::Earliest(_) => Geometry::default(),
    };
    let bodies = detector.scene().bodies();
    let triangles: usize = bodies.iter().map(|body| body.faces().len()).sum();
    memory::require("the picture", draw::bytes(look.size, triangles))?;
    let (mesh, mut colours) = paint::paint(bodies, look.time, &found, geometry.contacts())?;
    let [red, orange] = [RED, ORANGE].map(|of| colours.iter().filter(|colour| **colour == of).count());
    let points = mesh.positions().to_f64();
    let marks = marks::of(bodies, &points, &found, geometry.contacts());
    let own = shade::colours(bodies, mesh.faces(), points.len());
    let met = |(at, colour): (usize, &[u8; 3])| (*colour != GREY).then_some(at as u32);
    let met: Vec<u32> = colours.iter().enumerate().filter_map(met).collect();
    let free = colours.iter_mut().zip(own).filter(|(colour, _)| **colour == GREY);
    free.for_each(|(colour, own)| *colour = own);
    let picture =
        Picture { points: &points, faces: mesh.faces(), colours: &colours, met: &met, marks: &marks };
    let framed = look.around == Around::Contacts;
    let pixels = during("drawing", || picture.draw([look.view, look.up].map(unit), look.size, framed));
    target.write(|out| encode(out, look.size, &pixels).map_err(|e| e.to_string()))?;
    let of = counted(triangles as u64, "triangle", "triangles");
    let [width, height] = look.size;
    print(&format!("{}: {width}x{height}, {of}, {red} red, {orange} orange\n", out.display()))?;
    Ok(ExitCode::SUCCESS)
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
