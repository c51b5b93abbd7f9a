//! Vertices on the device, and their first places from the host.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::precision::Precision;
use crate::scene::Body;
use nearmiss_kernels::abi::{Point, Positions, Span, VertexMotion as Ends};

/// Positions at t = 0, or at both ends of the step once a query reads them.
pub enum Vertices<R: Precision> {
    /// At t = 0.
    Still(Buffer<Point<R>>),
    /// At both ends.
    Moving(Buffer<Ends<R>>),
}

impl<R: Precision> Vertices<R> {
    /// Allocates so many vertices.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, moving: bool, len: usize) -> Result<Self, Error> {
        Ok(if moving { Vertices::Moving(device.buffer(len)?) } else { Vertices::Still(device.buffer(len)?) })
    }

    /// Returns them as kernels read them.
    pub fn span(&self) -> Positions<R> {
        match self {
            Vertices::Still(points) => {
                Positions { still: points.span(), moving: Span::EMPTY, turns: Span::EMPTY }
            }
            Vertices::Moving(motions) => {
                Positions { still: Span::EMPTY, moving: motions.span(), turns: Span::EMPTY }
            }
        }
    }

    /// Returns their number.
    pub fn len(&self) -> usize {
        match self {
            Vertices::Still(points) => points.len(),
            Vertices::Moving(motions) => motions.len(),
        }
    }

    /// Sets the first vertices: those of the bodies, one behind the other, with these radii. A body
    /// that stands still has the same positions at both ends.
    ///
    /// # Errors
    /// Device errors.
    pub fn write<'a>(&mut self, bodies: impl Iterator<Item = &'a Body>, radii: &[R]) -> Result<(), Error> {
        let mut radii = radii.iter().copied().chain(std::iter::repeat(R::ZERO));
        let mut radius = || radii.next().unwrap_or(R::ZERO);
        match self {
            Vertices::Still(buffer) => {
                let mut points = Vec::with_capacity(buffer.len());
                for body in bodies {
                    points.extend(R::points(body.positions_t0()).map(|at| Point { at, radius: radius() }));
                }
                buffer.write(&points)
            }
            Vertices::Moving(buffer) => {
                let mut ends = Vec::with_capacity(buffer.len());
                for body in bodies {
                    let [t0, t1] = body.ends();
                    let both = R::points(t0).zip(R::points(t1));
                    ends.extend(both.map(|(t0, t1)| {
                        let radius = radius();
                        Ends { t0: Point { at: t0, radius }, t1: Point { at: t1, radius } }
                    }));
                }
                buffer.write(&ends)
            }
        }
    }
}
