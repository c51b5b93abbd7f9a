//! A mesh with a colour a triangle, drawn.

use super::camera::Camera;
use super::raster::{self, Canvas, Corner, FINE, Sides};
use super::shade::{INK, PAPER, lit, normals};

/// The scene of a picture.
pub struct Picture<'a> {
    pub points: &'a [[f64; 3]],
    pub faces: &'a [[u32; 3]],
    /// A colour a triangle.
    pub colours: &'a [[u8; 3]],
    /// Triangles that meet.
    pub met: &'a [u32],
    /// Lines between points of contacts.
    pub marks: &'a [[[f64; 3]; 2]],
}

/// Bytes that a triangle takes while it is drawn: its corners' normals, places and neighbours.
const OF_A_TRIANGLE: u64 = 300;

/// Bytes that drawing takes.
pub fn bytes([width, height]: [usize; 2], triangles: usize) -> u64 {
    let samples = (width * height * FINE * FINE) as u64;
    samples * raster::BYTES + (6 * width * height) as u64 + triangles as u64 * OF_A_TRIANGLE
}

/// Sides of triangles, pixels: from the first on sides are drawn, from the second on in full, that much darker.
const SIDES: [f64; 2] = [7.0, 24.0];
const DARK: f64 = 0.3;
/// Half the width of a mark's line, and the radius of its ends, in pixels of a picture of 900; larger in larger ones.
const LINE: f64 = 1.0;
const POINT: f64 = 2.6;
/// The radius of points of no face, as above.
const DOT: f64 = 1.8;
/// How light edges and points of no face are: darker than surfaces, so that they are seen on paper.
const THREAD: f32 = 0.7;
/// How much of a mark is seen behind a surface.
const FAINT: f32 = 0.25;

/// Both ends of a face that repeats a vertex, as edges and points of no face do; a point has one end twice.
fn ends([a, b, c]: [u32; 3]) -> Option<[u32; 2]> {
    match [a == b, b == c || a == c] {
        [true, _] => Some([a, c]),
        [false, true] => Some([a, b]),
        [false, false] => None,
    }
}

impl Picture<'_> {
    /// The camera that looks from the first direction with the second up, both of length 1. Around what
    /// meets, or around everything.
    pub fn camera(&self, directions: [[f64; 3]; 2], size: [usize; 2], around_met: bool) -> Camera {
        // A vertex of no triangle may be anywhere.
        let corners = |face: &[u32; 3]| face.map(|vertex| self.points[vertex as usize]);
        let framed = if around_met { self.met } else { &[] };
        let framed = framed.iter().flat_map(|triangle| corners(&self.faces[*triangle as usize]));
        Camera::new(self.faces.iter().flat_map(corners), framed, directions, size)
    }

    /// The pixels, three bytes each, row by row from the top.
    pub fn draw(&self, camera: &Camera, size: [usize; 2]) -> Vec<u8> {
        let places: Vec<[f64; 3]> = self.points.iter().map(|point| camera.place(*point)).collect();
        let normals = normals(self.points, self.faces);
        let sides = self.sides(&places);
        let mut canvas = Canvas::new(size, PAPER);
        // Triangles in contact come first, so that they are seen if two lie in one place.
        let mut is_met = vec![false; self.faces.len()];
        self.met.iter().for_each(|triangle| is_met[*triangle as usize] = true);
        for now in [true, false] {
            for at in (0..self.faces.len()).filter(|at| is_met[*at] == now) {
                let corner = |k: usize| Corner {
                    place: places[self.faces[at][k] as usize],
                    colour: lit(self.colours[at], normals[at][k], camera),
                };
                canvas.triangle([corner(0), corner(1), corner(2)], sides);
            }
        }
        let larger = (size[0].min(size[1]) as f64 / 900.0).max(0.5);
        for now in [false, true] {
            for at in (0..self.faces.len()).filter(|at| is_met[*at] == now) {
                let Some(ends) = ends(self.faces[at]) else { continue };
                let radius = if ends[0] == ends[1] { DOT } else { LINE };
                let colour = self.colours[at].map(|part| THREAD * f32::from(part) / 255.0);
                canvas.line(ends.map(|vertex| places[vertex as usize]), radius * larger, colour, 0.0);
            }
        }
        // A few may be large: they hide little.
        let larger = if self.marks.len() < 10 { 1.8 * larger } else { larger };
        for mark in self.marks {
            let ends = mark.map(|point| camera.place(point));
            canvas.line(ends, LINE * larger, INK, FAINT);
            ends.iter().for_each(|end| canvas.line([*end; 2], POINT * larger, INK, FAINT));
        }
        canvas.pixels()
    }

    /// How dark sides are: not at all where triangles are small.
    fn sides(&self, places: &[[f64; 3]]) -> Sides {
        let length = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|vertex| places[vertex as usize]);
            let apart =
                |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
            (apart(a, b) + apart(b, c) + apart(c, a)) / 3.0
        };
        let mut lengths: Vec<f64> = self.faces.iter().map(length).collect();
        lengths.sort_by(f64::total_cmp);
        let middle = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
        let part = ((middle - SIDES[0]) / (SIDES[1] - SIDES[0])).clamp(0.0, 1.0);
        Sides((part * DARK) as f32)
    }
}
