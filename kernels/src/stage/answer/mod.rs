//! # Answer: rows on the device → what a caller's kernels want to know of them
//! Paper    not in the paper.
//!
//! Only in submissions, on request.
//!
//! | kernel | does |
//! | --- | --- |
//! | [`geometry::geometry`] | vertices, weights, nearest points, distance and normal of each row |
//! | [`least::infinite`], [`least::least`] | the least time or distance of each vertex |
//! | [`groups::keys`], [`crate::sort::pass`], [`groups::groups`] | the rows of each feature |
//!
//! Rows are numbered through both lists.

pub mod geometry;
pub mod groups;
pub mod least;

use crate::abi::rows::code;
use crate::abi::{AnswerRows, Element, Hit, Name, Named, NearHit};
use crate::exec::{Block, Lane};
use crate::math::Real;

/// A contact with a number that can be the least one.
pub trait Measured: Named {
    /// The time at which its geometry is computed.
    fn time(&self) -> f64;
    /// Its time of contact, or its distance: at least 0.
    fn measure(&self) -> f64;
}

impl Measured for Hit {
    #[inline(always)]
    fn time(&self) -> f64 {
        self.verdict.toi
    }
    #[inline(always)]
    fn measure(&self) -> f64 {
        self.verdict.toi
    }
}

impl Measured for NearHit {
    #[inline(always)]
    fn time(&self) -> f64 {
        0.0
    }
    #[inline(always)]
    fn measure(&self) -> f64 {
        Real::sqrt(self.squared)
    }
}

/// How many rows there are: of the first list, and of both.
#[derive(Clone, Copy)]
struct Count {
    first: u32,
    all: u32,
}

impl Count {
    /// Those with room. In order, all places up to the room are written, whatever was too short.
    fn of<T: Named, B: Block>(block: &B, rows: &AnswerRows<T>) -> Count {
        let first = rows.first.listed(block);
        let second = if rows.second.room() == 0 { 0 } else { rows.second.listed(block) };
        let all = first as u64 + second as u64;
        let room = if rows.ordered.is_empty() { all } else { rows.ordered.len() };
        Count { first, all: all.min(room) as u32 }
    }

    #[inline(always)]
    fn get<T: Named, L: Lane>(&self, lane: &L, rows: &AnswerRows<T>, row: u32) -> T {
        if !rows.ordered.is_empty() {
            lane.read(rows.ordered, row)
        } else if row < self.first {
            rows.first.get(lane, row)
        } else {
            rows.second.get(lane, row - self.first)
        }
    }

    /// The name of the contact of a row.
    #[inline(always)]
    fn name<T: Named, L: Lane>(&self, lane: &L, rows: &AnswerRows<T>, row: u32, contact: &T) -> Name {
        let [x, y] = contact.name();
        if !T::OF_FEATURES {
            Name::of_triangles([x, y])
        } else if row >= self.first {
            Name::of_edges([x, y])
        } else if rows.elements.is_empty() {
            Name::of_element(x, Element::face(y))
        } else {
            Name::of_element(x, lane.read(rows.elements, y))
        }
    }
}

/// The four vertices of a row of features, numbered through all bodies.
#[inline(always)]
fn corners<T: Named, L: Lane>(lane: &L, rows: &AnswerRows<T>, name: &Name) -> [u32; 4] {
    let [p, q] = name.features;
    match name.kind {
        code::VERTEX_FACE => {
            let [x, y, z] = lane.read(rows.faces, q);
            [p, x, y, z]
        }
        code::EDGE_EDGE => {
            let ([w, x], [y, z]) = (lane.read(rows.edges, p), lane.read(rows.edges, q));
            [w, x, y, z]
        }
        code::EDGE_VERTEX => {
            let [w, x] = lane.read(rows.edges, p);
            [w, x, q, q]
        }
        _ => [p, q, q, q],
    }
}
