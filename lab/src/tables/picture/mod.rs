//! Pictures as SVG text: pure Rust, without fonts of the machine. Colours are those of Okabe and
//! Ito, which remain distinct to colour-blind readers. Every bar and line has its label next to it.

mod bars;
#[cfg(test)]
pub mod check;
mod curves;
pub mod labels;
mod stacks;

pub use bars::{Bar, Panel, bars};
pub use curves::{Chart, Curve, curves};
pub use labels::width;
pub use stacks::{Stack, stacks};

use nearmiss::error::Error;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub const OURS: RGBColor = RGBColor(0, 114, 178);
pub const THEIRS: RGBColor = RGBColor(230, 159, 0);
pub const INK: RGBColor = RGBColor(30, 30, 30);
pub const FAINT: RGBColor = RGBColor(110, 110, 110);
pub const GRID: RGBColor = RGBColor(215, 215, 215);

/// Width of a picture of one column, in pixels.
pub const WIDTH: i32 = 900;
/// Left and right ends of bars; labels are to the left, figures to the right.
pub const LEFT: i32 = 215;
pub const RIGHT: i32 = 770;

/// Alignment of a text at its point.
#[derive(Clone, Copy)]
pub enum At {
    Left,
    Middle,
    Right,
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle, upwards.
    Up,
    /// A triangle, downwards.
    Down,
}

impl Mark {
    /// Returns the corners of a mark about as large as a disc of that radius; none for a disc.
    fn corners(self, (x, y): (i32, i32), radius: i32) -> Vec<(i32, i32)> {
        let (r, high) = (radius, radius + 1);
        match self {
            Mark::Disc => Vec::new(),
            Mark::Square => vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
            Mark::Diamond => vec![(x - high, y), (x, y - high), (x + high, y), (x, y + high)],
            Mark::Up => vec![(x - high, y + r), (x, y - high), (x + high, y + r)],
            Mark::Down => vec![(x - high, y - r), (x, y + high), (x + high, y - r)],
        }
    }
}

/// A sheet to draw on, in pixels from the upper left.
pub struct Sheet<'a>(DrawingArea<SVGBackend<'a>, Shift>);

/// Draws on a sheet of that height; returns the SVG.
pub fn sheet(height: i32, draw: impl FnOnce(&Sheet) -> Drawn) -> Result<String, Error> {
    wide_sheet([WIDTH, height], draw)
}

/// Draws on a sheet of that width and height; returns the SVG.
pub fn wide_sheet(size: [i32; 2], draw: impl FnOnce(&Sheet) -> Drawn) -> Result<String, Error> {
    let mut svg = String::new();
    let [width, height] = size.map(|side| side.max(1) as u32);
    let sheet = Sheet(SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area());
    let drawn = sheet.0.fill(&WHITE).map_err(|e| e.to_string()).and_then(|()| draw(&sheet));
    let done = drawn.and_then(|()| sheet.0.present().map_err(|e| e.to_string()));
    drop(sheet);
    done.map_err(|text| Error::Bug { what: format!("a picture could not be drawn: {text}") })?;
    Ok(svg)
}

/// Success, or the reason of a failure.
pub type Drawn = Result<(), String>;

impl<'a> Sheet<'a> {
    /// Returns a part of the sheet, with pixels from its own upper left.
    pub fn part(&self, corner: (i32, i32), size: (i32, i32)) -> Sheet<'a> {
        Sheet(self.0.clone().shrink(corner, size))
    }

    /// Draws a text of `size` pixels, centred at that height.
    pub fn text(&self, text: &str, (x, y): (i32, i32), size: i32, at: At, colour: RGBColor) -> Drawn {
        let h = match at {
            At::Left => HPos::Left,
            At::Middle => HPos::Center,
            At::Right => HPos::Right,
        };
        // The backend reduces fonts by this factor.
        let font = ("sans-serif", f64::from(size) * 1.24).into_font();
        let style = font.color(&colour).pos(Pos::new(h, VPos::Center));
        self.0.draw_text(text, &style, (x, y)).map_err(|e| e.to_string())
    }

    pub fn bold(&self, text: &str, (x, y): (i32, i32), size: i32) -> Drawn {
        let font = ("sans-serif", f64::from(size) * 1.24).into_font().style(FontStyle::Bold);
        let style = font.color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
        self.0.draw_text(text, &style, (x, y)).map_err(|e| e.to_string())
    }

    pub fn rectangle(&self, corners: [(i32, i32); 2], colour: RGBColor) -> Drawn {
        self.0.draw(&Rectangle::new(corners, colour.filled())).map_err(|e| e.to_string())
    }

    /// Draws a mark, filled or hollow.
    pub fn mark(&self, mark: Mark, at: (i32, i32), radius: i32, colour: RGBColor, filled: bool) -> Drawn {
        let style = if filled { colour.filled() } else { WHITE.filled() };
        let mut corners = mark.corners(at, radius);
        let inside = if corners.is_empty() {
            self.0
                .draw(&Circle::new(at, radius, style))
                .and_then(|()| self.0.draw(&Circle::new(at, radius, colour.stroke_width(2))))
        } else {
            let filled = Polygon::new(corners.clone(), style);
            corners.extend(corners.first().copied());
            self.0
                .draw(&filled)
                .and_then(|()| self.0.draw(&PathElement::new(corners, colour.stroke_width(2))))
        };
        inside.map_err(|e| e.to_string())
    }

    /// Draws a dashed line.
    pub fn dashes(&self, points: Vec<(i32, i32)>, colour: RGBColor, width: u32) -> Drawn {
        let style = colour.stroke_width(width);
        self.0
            .draw(&plotters::element::DashedPathElement::new(points, 7, 4, style))
            .map_err(|e| e.to_string())
    }

    pub fn line(&self, points: Vec<(i32, i32)>, colour: RGBColor, width: u32) -> Drawn {
        self.0.draw(&PathElement::new(points, colour.stroke_width(width))).map_err(|e| e.to_string())
    }

    /// Draws the picture's title, and lines of smaller print below it. Returns the height of its
    /// end.
    pub fn head(&self, title: &str, notes: &[(String, RGBColor)]) -> Result<i32, String> {
        self.bold(title, (20, 26), 18)?;
        let mut y = 50;
        for (note, colour) in notes {
            self.text(note, (20, y), 13, At::Left, *colour)?;
            y += 18;
        }
        Ok(y + 4)
    }
}

/// Returns the height that [`Sheet::head`] takes with that many notes.
pub fn head_height(notes: usize) -> i32 {
    54 + 18 * notes as i32
}
