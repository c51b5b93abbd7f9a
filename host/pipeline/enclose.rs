//! Checks that every node of a tree holds everything below it, in every frame. The check is exact,
//! for each volume, on any machine.

use super::broad::trees::{Tree, TreeSpec, Volumes};
use super::layout::Layout;
use super::precision::Precision;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::query::Refit;
use nearmiss_kernels::abi::{Growth, Node, Point, Positions, ROOT, Span, VertexMotion};
use nearmiss_kernels::entry::Kernels;
use nearmiss_kernels::math::Vec3;

/// Directions from a point, of a length just below 1: so that a coordinate in f64 may round.
const WAYS: [[f64; 3]; 7] = {
    const L: f64 = 1.0 - 1e-6;
    const S: f64 = L / 3.0;
    [
        [0.0; 3],
        [L, 0.0, 0.0],
        [0.0, -L, 0.0],
        [0.0, 0.0, L],
        [2.0 * S, 2.0 * S, -S],
        [-S, 2.0 * S, 2.0 * S],
        [-2.0 * S, -S, -2.0 * S],
    ]
};

/// A tree that is built once and refitted in each frame.
pub struct Enclosed<R: Precision, V: Kernels> {
    device: Device,
    triangles: Vec<[u32; 3]>,
    faces: Buffer<[u32; 3]>,
    still: Buffer<Point<R>>,
    moving: Buffer<VertexMotion<R>>,
    /// Positions on the device, and whether they move.
    at: (Vec<[Vec3<R>; 2]>, bool),
    tree: Tree,
    volumes: Volumes<V>,
}

impl<R: Precision, V: Kernels> Enclosed<R, V> {
    /// Builds the tree for these positions, over at least one triangle. `t1` is empty if nothing
    /// moves; volumes grow by `margin`.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        triangles: &[[u32; 3]],
        [t0, t1]: [&[Vec3<R>]; 2],
        (refit, margin): (Refit, f32),
    ) -> Result<Self, Error> {
        let layout = Layout::single(triangles.len() as u32);
        let tree = Tree::new(device, &TreeSpec::alone(&layout, refit, V::GROUP > 0))?;
        let mut enclosed = Enclosed {
            triangles: triangles.to_vec(),
            faces: device.upload(triangles)?,
            still: device.buffer(t0.len())?,
            moving: device.buffer(t0.len())?,
            at: (Vec::new(), false),
            volumes: Volumes::new(device, &tree, Growth::margin(margin))?,
            tree,
            device: device.clone(),
        };
        enclosed.place(t0, t1)?;
        let (frames, faces) = (enclosed.frames(), enclosed.faces.span());
        enclosed.tree.construct::<R>(device, frames, (faces, Span::EMPTY))?;
        enclosed.tree.learn_levels()?;
        enclosed.move_to(t0, t1)?;
        Ok(enclosed)
    }

    fn place(&mut self, t0: &[Vec3<R>], t1: &[Vec3<R>]) -> Result<(), Error> {
        let moves = !t1.is_empty();
        let ends = if moves { t1 } else { t0 };
        let ends = || t0.iter().zip(ends);
        self.still.write(&t0.iter().map(|&p| p.into()).collect::<Vec<_>>())?;
        self.moving
            .write(&ends().map(|(&p, &q)| VertexMotion { t0: p.into(), t1: q.into() }).collect::<Vec<_>>())?;
        self.at = (ends().map(|(&p, &q)| [p, q]).collect(), moves);
        Ok(())
    }

    fn frames(&self) -> Positions<R> {
        match self.at.1 {
            true => Positions { still: Span::EMPTY, moving: self.moving.span(), turns: Span::EMPTY },
            false => Positions { still: self.still.span(), moving: Span::EMPTY, turns: Span::EMPTY },
        }
    }

    /// Fits and refits all volumes to another frame.
    ///
    /// # Errors
    /// Device errors.
    pub fn move_to(&mut self, t0: &[Vec3<R>], t1: &[Vec3<R>]) -> Result<(), Error> {
        self.place(t0, t1)?;
        let (frames, faces) = (self.frames(), self.faces.span());
        self.volumes.fit(&self.device, &self.tree, frames, faces)?;
        self.volumes.refit(&self.device, &self.tree, frames, faces)
    }

    /// Counts the violations after `fault`. A violation is a node and a corner of a triangle below
    /// it. The node does not hold everything within `near` of the corner at all times. Cost: each
    /// corner against each node above it, in exact arithmetic on the host.
    ///
    /// # Errors
    /// Device errors.
    pub fn outside(&self, near: f32, fault: impl Fn(&mut [Node<V>])) -> Result<usize, Error> {
        let ways = &WAYS[..if near > 0.0 { WAYS.len() } else { 1 }];
        let (mut nodes, links) = (self.volumes.download()?, self.tree.download()?);
        fault(&mut nodes);
        let parents = self.tree.pair_parents.read(self.tree.leaves())?;
        let mut outside = 0;
        for (leaf, link) in links.iter().enumerate().skip(1).filter(|(_, link)| link.is_leaf()) {
            let corners = self.triangles[link.triangle() as usize].map(|v| self.at.0[v as usize]);
            let mut at = leaf as u32;
            loop {
                let volume = nodes[at as usize].volume;
                let held = |[t0, t1]: &[Vec3<R>; 2]| {
                    ways.iter().all(|way| {
                        let step = Vec3(*way) * f64::from(near);
                        volume.holds(t0.wide() + step, t1.wide() + step)
                    })
                };
                outside += corners.iter().filter(|&c| !held(c)).count();
                if at == ROOT {
                    break;
                }
                at = parents[at as usize / 2];
            }
        }
        Ok(outside)
    }

    /// Checks the volumes against the children and the points that they were made from.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    #[cfg(test)]
    fn check(&self) -> Result<(), Error> {
        let frame = |k: usize| self.at.0.iter().map(|p| p[k]).collect::<Vec<_>>();
        let frames = if self.at.1 { vec![frame(0), frame(1)] } else { vec![frame(0)] };
        self.volumes.check(
            &self.tree,
            &self.triangles,
            &crate::pipeline::broad::Checked::new(frames, Vec::new()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};
    use crate::query::{BoundingVolume, WithVolume};
    use crate::samples::{sheet, soup};
    use crate::scene::Body;

    /// Returns a body's positions, one frame or two, rotated and moved so that f64 is not f32.
    fn frames<R: Precision>(body: &Body, size: f64, at: f64) -> [Vec<Vec3<R>>; 2] {
        let moved = |[x, y, z]: [f64; 3]| {
            Vec3([0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0].map(|x| R::of(size * x + at)))
        };
        let of = |p: &crate::mesh::Positions| p.to_f64().into_iter().map(moved).collect();
        [of(body.positions_t0()), body.positions_t1().map_or(Vec::new(), of)]
    }

    /// Counts the violations of volumes that grow by `margin`.
    fn outside<R: Precision, V: Kernels>(
        body: &Body,
        (size, at): (f64, f64),
        refit: Refit,
        (margin, near): (f32, f32),
        fault: impl Fn(&mut [Node<V>]),
    ) -> usize {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let [t0, t1] = frames::<R>(body, size, at);
        let way = (refit, margin);
        let enclosed = Enclosed::<R, V>::new(&device, body.elements(), [&t0, &t1], way).expect("a tree");
        enclosed.check().expect("sound");
        enclosed.outside(near, fault).expect("nodes")
    }

    /// The test for one volume type.
    struct All;

    impl WithVolume for All {
        type Out = ();

        fn with<V: Kernels>(self) {
            all::<f32, V>();
            all::<f64, V>();
        }
    }

    fn all<R: Precision, V: Kernels>() {
        let bodies = [soup(1, 3, false), soup(700, 4, false), soup(700, 4, true), sheet(20)];
        for (i, body) in bodies.iter().enumerate() {
            for place in [(1.0, 0.0), (1e-3, 1e3), (1e25, 0.0)] {
                let refit = [Refit::Levels, Refit::Treelets][i % 2];
                let count = outside::<R, V>(body, place, refit, (0.0, 0.0), |_| ());
                assert_eq!(count, 0, "{} {place:?}", body.name());
            }
        }
        let body = soup(300, 8, true);
        for (refit, place) in
            [(Refit::Levels, (1.0, 0.0)), (Refit::Treelets, (1e-3, 1e3)), (Refit::Levels, (1e25, 0.0))]
        {
            let near = 0.125 * place.0 as f32;
            let out = |margin| outside::<R, V>(&body, place, refit, (margin, near), |_| ());
            assert_eq!(out(near), 0, "{refit:?}, {place:?}: what is near is held as well");
            assert!(out(0.0) > 0, "{refit:?}, {place:?}: forgotten growth is noticed");
            // Far from the origin a hundredth of the growth is less than the rounding of bounds.
            assert!(
                place.1 > 0.0 || out(0.99 * near) > 0,
                "{refit:?}, {place:?}: too little growth is noticed"
            );
        }
        // A node with its left child's volume: it does not hold the right one.
        let few = outside::<R, V>(&body, (1.0, 0.0), Refit::Levels, (0.0, 0.0), |nodes| {
            let at = (ROOT as usize..nodes.len()).rfind(|&at| !nodes[at].is_leaf()).expect("an inner node");
            nodes[at].volume = nodes[nodes[at].link as usize].volume;
        });
        assert!((1..=3).contains(&few), "{few}");
    }

    #[test]
    fn every_node_holds_what_is_below_it() {
        BoundingVolume::ALL.into_iter().for_each(|volume| volume.with(All));
    }
}
