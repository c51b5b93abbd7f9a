//! Triangles, lines and discs into samples, nine a pixel, each with the depth of what is nearest.
//!
//! Corners are rounded to sixteenths of a sample, and sides are decided in integers. So two triangles
//! with a common side miss no sample between them. Floats are used only for `+ - * /` and roots, so a
//! picture is the same, byte by byte, on every machine.

/// Samples of a pixel in each direction.
pub const FINE: usize = 3;
/// Parts of a sample that corners are rounded to.
const PARTS: f64 = 16.0;
/// Bytes that a sample takes.
pub const BYTES: u64 = 16;

/// A colour: red, green and blue, 0 to 1, as a screen takes them.
pub type Colour = [f32; 3];

/// A corner of a triangle: its place in pixels and depth, towards the one who looks, and its colour.
#[derive(Clone, Copy)]
pub struct Corner {
    pub place: [f64; 3],
    pub colour: Colour,
}

/// Sides of triangles, drawn darker within half a pixel: how much, 0 to 1.
#[derive(Clone, Copy)]
pub struct Sides(pub f32);

/// Samples, row by row from the top.
pub struct Canvas {
    size: [usize; 2],
    colours: Vec<Colour>,
    depths: Vec<f32>,
}

impl Canvas {
    /// A canvas of that many pixels and one colour, with nothing on it.
    pub fn new(pixels: [usize; 2], colour: Colour) -> Canvas {
        let size = pixels.map(|side| side * FINE);
        let count = size[0] * size[1];
        Canvas { size, colours: vec![colour; count], depths: vec![f32::NEG_INFINITY; count] }
    }

    /// A triangle: what is drawn first stays where another is no nearer.
    pub fn triangle(&mut self, corners: [Corner; 3], Sides(dark): Sides) {
        let at = corners.map(|corner| [0, 1].map(|k| (corner.place[k] * FINE as f64 * PARTS).round() as i64));
        let area = doubled(at[0], at[1], at[2]);
        if area == 0 {
            return;
        }
        let range = |k: usize| {
            let of = [at[0][k], at[1][k], at[2][k]];
            let part = |x: i64| x.div_euclid(PARTS as i64);
            let (low, high) =
                (of.iter().min().map_or(0, |x| part(*x)), of.iter().max().map_or(0, |x| part(*x)));
            low.clamp(0, self.size[k] as i64)..(high + 1).clamp(0, self.size[k] as i64)
        };
        // Heights over sides, in pixels, of a weight of 1.
        let heights = [0, 1, 2].map(|k| {
            let [a, b] = [at[(k + 1) % 3], at[(k + 2) % 3]];
            let [x, y] = [0, 1].map(|k| (b[k] - a[k]) as f64);
            area.abs() as f64 / (x * x + y * y).sqrt() / (PARTS * FINE as f64)
        });
        let (columns, rows) = (range(0), range(1));
        for row in rows {
            // A sample stands in the middle of its square; on the inner side of a line where this is not negative.
            let parts = |column: i64| {
                let point = [column, row].map(|x| x * PARTS as i64 + PARTS as i64 / 2);
                [0, 1, 2].map(|k| doubled(point, at[(k + 1) % 3], at[(k + 2) % 3]) * area.signum())
            };
            // It grows by the same from column to column: so those within follow from the first two.
            let (first, second) = (parts(0), parts(1));
            let mut within = columns.clone();
            for (start, next) in first.into_iter().zip(second) {
                let grows = next - start;
                match grows.signum() {
                    1 => within.start = within.start.max(-start.div_euclid(grows)),
                    -1 => within.end = within.end.min(start.div_euclid(-grows) + 1),
                    _ if start < 0 => within.end = within.start,
                    _ => {}
                }
            }
            for column in within {
                let parts = parts(column);
                let weights = parts.map(|part| part as f64 / area.abs() as f64);
                let depth = (0..3).map(|k| weights[k] * corners[k].place[2]).sum::<f64>() as f32;
                let index = row as usize * self.size[0] + column as usize;
                if depth > self.depths[index] {
                    let to_side = (0..3).fold(f64::INFINITY, |least, k| least.min(weights[k] * heights[k]));
                    let shade = if to_side < 0.5 { 1.0 - dark } else { 1.0 };
                    let mixed = [0, 1, 2]
                        .map(|c| (0..3).map(|k| weights[k] as f32 * corners[k].colour[c]).sum::<f32>());
                    (self.depths[index], self.colours[index]) = (depth, mixed.map(|part| part * shade));
                }
            }
        }
    }

    /// A line with round ends over all that is there. `radius` is half its width, in pixels; `behind` is
    /// how much of it is seen, 0 to 1, where something is nearer.
    pub fn line(&mut self, [from, to]: [[f64; 3]; 2], radius: f64, colour: Colour, behind: f32) {
        let range = |k: usize| {
            let [low, high] = [from[k].min(to[k]) - radius, from[k].max(to[k]) + radius];
            let place = |x: f64| (x * FINE as f64).clamp(0.0, self.size[k] as f64) as usize;
            place(low)..place(high.ceil())
        };
        let along = [to[0] - from[0], to[1] - from[1]];
        let squared = along[0] * along[0] + along[1] * along[1];
        let (columns, rows) = (range(0), range(1));
        for row in rows {
            // The part of the line that is within a radius of the row, and a sample to either side for roundings.
            let height = (row as f64 + 0.5) / FINE as f64 - from[1];
            let part = |apart: f64| ((height + apart) / along[1]).clamp(0.0, 1.0);
            let ends = if along[1] == 0.0 { [0.0, 1.0] } else { [part(-radius), part(radius)] };
            let [one, other] = ends.map(|part| from[0] + part * along[0]);
            let place = |x: f64| ((x * FINE as f64).max(0.0) as usize).clamp(columns.start, columns.end);
            let reach = radius + 1.0 / FINE as f64;
            for column in place(one.min(other) - reach)..place((one.max(other) + reach).ceil()) {
                let point = [column, row].map(|x| (x as f64 + 0.5) / FINE as f64);
                let own = [point[0] - from[0], point[1] - from[1]];
                let dot = own[0] * along[0] + own[1] * along[1];
                let part = if squared > 0.0 { (dot / squared).clamp(0.0, 1.0) } else { 0.0 };
                let apart = [0, 1].map(|k| own[k] - part * along[k]);
                if apart[0] * apart[0] + apart[1] * apart[1] > radius * radius {
                    continue;
                }
                let index = row * self.size[0] + column;
                let depth = from[2] + part * (to[2] - from[2]);
                // A line on a surface is not behind it.
                let hidden = f64::from(self.depths[index]) > depth + 2.0 * radius + 1.0;
                let opaque = if hidden { behind } else { 1.0 };
                let under = self.colours[index];
                self.colours[index] = [0, 1, 2].map(|c| under[c] + opaque * (colour[c] - under[c]));
            }
        }
    }

    /// The pixels, three bytes each: the mean of the samples' light, which goes by about the square of a colour.
    pub fn pixels(&self) -> Vec<u8> {
        let [width, height] = self.size.map(|side| side / FINE);
        let mut bytes = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            for x in 0..width {
                let mut light = [0.0f32; 3];
                for row in 0..FINE {
                    let start = (y * FINE + row) * self.size[0] + x * FINE;
                    for colour in &self.colours[start..start + FINE] {
                        (0..3).for_each(|c| light[c] += colour[c] * colour[c]);
                    }
                }
                let part = |light: f32| (light / (FINE * FINE) as f32).sqrt() * 255.0;
                bytes.extend(light.map(|light| part(light).round().clamp(0.0, 255.0) as u8));
            }
        }
        bytes
    }
}

/// Twice the signed area of a triangle.
fn doubled(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Colour = [1.0; 3];
    const RED: Colour = [1.0, 0.0, 0.0];
    const BLUE: Colour = [0.0, 0.0, 1.0];

    fn draw(canvas: &mut Canvas, places: [[f64; 3]; 3], colour: Colour) {
        canvas.triangle(places.map(|place| Corner { place, colour }), Sides(0.0));
    }

    fn pixel(canvas: &Canvas, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * (canvas.size[0] / FINE) + x);
        canvas.pixels()[at..at + 3].try_into().expect("three bytes")
    }

    #[test]
    fn nearer_hides_farther_in_either_order() {
        let [near, far] = [5.0, -5.0].map(|z| [[0.0, 0.0, z], [20.0, 0.0, z], [0.0, 20.0, z]]);
        for first in [true, false] {
            let mut canvas = Canvas::new([10, 10], WHITE);
            let order = if first { [(near, RED), (far, BLUE)] } else { [(far, BLUE), (near, RED)] };
            order.into_iter().for_each(|(places, colour)| draw(&mut canvas, places, colour));
            assert_eq!(pixel(&canvas, 5, 5), [255, 0, 0]);
        }
        // At the same depth what is drawn first stays.
        let mut canvas = Canvas::new([10, 10], WHITE);
        [RED, BLUE].into_iter().for_each(|colour| draw(&mut canvas, near, colour));
        assert_eq!(pixel(&canvas, 5, 5), [255, 0, 0]);
    }

    #[test]
    fn no_seam_shows_between_neighbours() {
        // A fan around an odd point, in both windings, covers a square; with no sample left out.
        let rim =
            [[-3.0, -2.0], [9.3, -1.0], [14.0, -1.7], [13.1, 6.2], [12.0, 13.0], [3.3, 12.0], [-2.0, 11.0]];
        let mut canvas = Canvas::new([10, 10], RED);
        for (k, from) in rim.iter().enumerate() {
            let to = rim[(k + 1) % rim.len()];
            let mut places = [[4.1, 5.7, 0.0], [from[0], from[1], 0.0], [to[0], to[1], 0.0]];
            if k % 2 == 1 {
                places.swap(1, 2);
            }
            draw(&mut canvas, places, BLUE);
        }
        // Red of the ground would show.
        assert!(canvas.colours.iter().all(|colour| colour[0] == 0.0));
    }

    #[test]
    fn samples_within_are_drawn_and_no_others() {
        // Slivers in all directions, some beyond the canvas.
        for turn in 0..64 {
            let direction = |part: usize| f64::from(turn as u32 * 7 + part as u32 * 3) * 0.1;
            let place = |part: usize, far: f64| {
                [10.0 + far * direction(part).cos(), 10.0 + far * direction(part).sin(), 0.0]
            };
            let places = [place(0, 14.0), place(1, 9.0), place(30 + turn, 13.0)];
            let mut canvas = Canvas::new([20, 20], WHITE);
            draw(&mut canvas, places, BLUE);
            let at = places.map(|place| [0, 1].map(|k| (place[k] * FINE as f64 * PARTS).round() as i64));
            let area = doubled(at[0], at[1], at[2]);
            for (index, colour) in canvas.colours.iter().enumerate() {
                let point = [index % canvas.size[0], index / canvas.size[0]].map(|x| x as i64 * 16 + 8);
                let sides =
                    [0, 1, 2].map(|k| doubled(point, at[(k + 1) % 3], at[(k + 2) % 3]) * area.signum());
                assert_eq!(
                    colour[0] == 0.0,
                    area != 0 && sides.iter().all(|side| *side >= 0),
                    "{turn}: {point:?}"
                );
            }
        }
    }

    #[test]
    fn what_covers_a_pixel_in_part_has_its_part_of_the_light() {
        let mut canvas = Canvas::new([2, 1], WHITE);
        // A third of the left pixel's columns.
        let places = [[-9.0, -9.0, 0.0], [1.0 / 3.0, -9.0, 0.0], [1.0 / 3.0, 99.0, 0.0]];
        draw(&mut canvas, places, [0.0; 3]);
        let expected = ((6.0f32 / 9.0).sqrt() * 255.0).round() as u8;
        assert_eq!((pixel(&canvas, 0, 0), pixel(&canvas, 1, 0)), ([expected; 3], [255; 3]));
    }

    #[test]
    fn lines_are_faint_behind_what_is_nearer() {
        let mut canvas = Canvas::new([20, 10], WHITE);
        draw(&mut canvas, [[-50.0, -50.0, 40.0], [10.0, -50.0, 40.0], [10.0, 90.0, 40.0]], WHITE);
        canvas.line([[0.0, 5.0, 0.0], [20.0, 5.0, 0.0]], 2.0, [0.0; 3], 0.25);
        assert_eq!((pixel(&canvas, 4, 5), pixel(&canvas, 15, 5)), ([191; 3], [0; 3]));
        assert_eq!(pixel(&canvas, 15, 1), [255; 3]);
    }

    #[test]
    fn what_lies_outside_or_has_no_area_draws_nothing() {
        let mut canvas = Canvas::new([4, 4], WHITE);
        draw(&mut canvas, [[-9.0, 0.0, 0.0], [-5.0, 0.0, 0.0], [-5.0, 4.0, 0.0]], RED);
        draw(&mut canvas, [[1e6, 0.0, 0.0], [2e6, 0.0, 0.0], [2e6, 4.0, 0.0]], RED);
        draw(&mut canvas, [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [4.0, 4.0, 0.0]], RED);
        canvas.line([[-90.0, -90.0, 0.0], [-80.0, -80.0, 0.0]], 3.0, RED, 0.25);
        assert!(canvas.colours.iter().all(|colour| *colour == WHITE));
    }
}
