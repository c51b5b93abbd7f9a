//! Triangle pairs as cells: curves in which surfaces cross, segments and points in which triangles
//! touch.
//!
//! A curve is one cell, and so is the segment or the point of another row. Overlaps have none.

use super::{array, exponent, section};
use crate::detect::Places;
use nearmiss::contacts::{PairGeometry, PairKind};
use std::io::{self, Write};

/// One cell.
struct Cell {
    step: usize,
    kind: PairKind,
    /// Group of the rows of a curve; -1 for a touch.
    group: i64,
    is_closed: bool,
    points: Vec<[f64; 3]>,
    /// For each point, the row of the segment that begins there; for the last one, that ends there.
    rows: Vec<u32>,
}

/// Cells of one step or of several.
#[derive(Default)]
pub struct Meetings {
    cells: Vec<Cell>,
}

impl Meetings {
    pub fn add(&mut self, step: usize, places: &Places) {
        for curve in places.curves.iter() {
            let rows = curve.rows.iter().chain(curve.rows.last()).copied().collect();
            let (group, is_closed) = (i64::from(curve.group), curve.is_closed);
            let points = curve.points.to_vec();
            self.cells.push(Cell { step, kind: PairKind::Crossing, group, is_closed, points, rows });
        }
        let group = |row: usize| places.curves.row_groups.get(row).copied().flatten().map_or(-1, i64::from);
        for (row, pair) in places.geometry.pairs().iter().enumerate() {
            let PairGeometry { kind, ends: Some(ends), parts: Some(parts), .. } = *pair else { continue };
            let is_point = kind == PairKind::Point || (kind == PairKind::Crossing && parts[0] == parts[1]);
            if kind == PairKind::Crossing && !is_point {
                continue;
            }
            let points = if is_point { vec![ends[0]] } else { ends.to_vec() };
            let rows = vec![row as u32; points.len()];
            self.cells.push(Cell { step, kind, group: group(row), is_closed: false, points, rows });
        }
    }

    /// Writes the file's only piece; with the steps of a sequence.
    pub fn write(&self, out: &mut dyn Write, steps: bool) -> io::Result<()> {
        // VTK lists all vertices before all lines.
        let (vertices, lines): (Vec<&Cell>, Vec<&Cell>) =
            self.cells.iter().partition(|cell| cell.points.len() == 1);
        let order: Vec<&Cell> = vertices.iter().chain(&lines).copied().collect();
        let points: usize = order.iter().map(|cell| cell.points.len()).sum();
        writeln!(
            out,
            "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">",
            vertices.len(),
            lines.len()
        )?;
        section(out, "PointData Scalars=\"row\"", |out| {
            array(out, "Int64", "row", 1, order.iter().flat_map(|cell| &cell.rows))
        })?;
        section(out, "CellData Scalars=\"kind\"", |out| {
            if steps {
                array(out, "Int64", "step", 1, order.iter().map(|cell| cell.step))?;
            }
            array(out, "UInt8", "kind", 1, order.iter().map(|cell| cell.kind as u8))?;
            array(out, "Int64", "group", 1, order.iter().map(|cell| cell.group))?;
            array(out, "UInt8", "is_closed", 1, order.iter().map(|cell| u8::from(cell.is_closed)))
        })?;
        section(out, "Points", |out| {
            let points = order.iter().flat_map(|cell| cell.points.as_flattened());
            array(out, "Float64", "points", 3, points.map(|&x| exponent(x)))
        })?;
        let mut first = 0;
        for (name, cells) in [("Verts", &vertices), ("Lines", &lines)] {
            let begin = first;
            let ends: Vec<usize> = cells
                .iter()
                .scan(0, |sum, cell| {
                    *sum += cell.points.len();
                    Some(*sum)
                })
                .collect();
            first += ends.last().copied().unwrap_or(0);
            section(out, name, |out| {
                array(out, "Int64", "connectivity", 1, begin..first)?;
                array(out, "Int64", "offsets", 1, ends.iter())
            })?;
        }
        out.write_all(b"</Piece>\n")
    }
}
