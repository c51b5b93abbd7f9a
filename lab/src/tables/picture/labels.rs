//! Names of lines at their ends, at least a line of text apart.

use super::{At, Drawn, INK, Sheet};
use plotters::style::RGBColor;

/// Least distance between the middles of two names, in pixels.
const LINE: i32 = 14;
/// Font size of the names.
const SIZE: i32 = 12;

/// Returns the approximate width of a text of that size, in pixels. It is an upper estimate, as
/// fonts differ.
pub fn width(text: &str, size: i32) -> i32 {
    text.chars().count() as i32 * size * 60 / 100 + 2
}

/// The end of a line, and its name.
pub struct End<'a> {
    /// Its position in pixels.
    pub at: (i32, i32),
    /// Colour of the line.
    pub colour: RGBColor,
    /// Name of the line.
    pub label: &'a str,
}

/// Draws names in a column from `left`, each next to its line's end or joined to it, none below
/// `bottom`.
pub fn draw(sheet: &Sheet, mut ends: Vec<End>, left: i32, bottom: i32) -> Drawn {
    ends.sort_by_key(|end| end.at.1);
    let heights = apart(ends.iter().map(|end| end.at.1).collect(), bottom);
    for (end, y) in ends.into_iter().zip(heights) {
        sheet.line(vec![(end.at.0 + 4, end.at.1), (left - 14, y), (left - 4, y)], end.colour, 1)?;
        sheet.text(end.label, (left, y), SIZE, At::Left, INK)?;
    }
    Ok(())
}

/// Moves ascending heights apart so that a line of text fits between any two, none below `bottom`.
fn apart(mut heights: Vec<i32>, bottom: i32) -> Vec<i32> {
    for i in 1..heights.len() {
        heights[i] = heights[i].max(heights[i - 1] + LINE);
    }
    let mut most = bottom;
    for height in heights.iter_mut().rev() {
        *height = (*height).min(most);
        most = *height - LINE;
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_apart() {
        assert_eq!(apart(vec![10, 10, 50], 100), [10, 24, 50]);
        assert_eq!(apart(vec![95, 100, 100], 100), [72, 86, 100]);
    }
}
