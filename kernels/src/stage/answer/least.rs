//! # Answer, least: rows → the least time or distance of each vertex
//! Paper    not in the paper.
//! Launch   `infinite`: a lane a vertex; `least`: a lane a row; grids of any size stride.
//! Reads    rows, faces or edges.   Writes   a number a vertex.
//! Before   lists are complete; `least`: all numbers are infinite.
//! After    least\[v\] = min {measure(row) : v is a corner of row}, infinite without such a row.
//! Room     fixed; cannot run out.
//! Cost     8 B a vertex; 32 B a row, 16 B indices, four atomics (scattered).

use super::{Count, Measured, corners};
use crate::abi::{AnswerInfiniteArgs, AnswerLeastArgs};
use crate::exec::{Block, Lane};

/// Makes all numbers infinite.
pub fn infinite<B: Block>(block: &mut B, args: &AnswerInfiniteArgs) {
    let (vertices, stride) = (args.least.len() as u32, block.blocks() * block.lanes());
    block.phase(|lane| {
        let mut vertex = lane.global();
        while vertex < vertices {
            lane.write(args.least, vertex, f64::INFINITY.to_bits());
            vertex = vertex.saturating_add(stride);
        }
    });
}

/// Lowers the numbers of each row's vertices.
pub fn least<T: Measured, B: Block>(block: &mut B, args: &AnswerLeastArgs<T>) {
    let count = Count::of(block, &args.rows);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut row = lane.global();
        while row < count.all {
            let contact = count.get(lane, &args.rows, row);
            let name = count.name(lane, &args.rows, row, &contact);
            // No measure is negative, so the bits are ordered as they are.
            let bits = contact.measure().to_bits();
            let vertices = corners(lane, &args.rows, &name);
            let mut k = 0;
            while k < 4 {
                if bits < lane.fetch_load(args.least, vertices[k]) {
                    lane.fetch_min(args.least, vertices[k], bits);
                }
                k += 1;
            }
            row = row.saturating_add(stride);
        }
    });
}
