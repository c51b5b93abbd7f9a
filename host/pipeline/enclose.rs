//! Every node of every tree holds everything below it: asked exactly, of each volume, machine by machine.

use super::precision::Precision;
use super::tree::Tree;
use super::volumes::{Kernels, Volumes};
use crate::device::Device;
use crate::device::emulator::{Emulator, Mode};
use crate::mesh::Body;
use crate::query::Refit;
use crate::scene;
use nearmiss_kernels::abi::{Frames, Motion, Node, Point, ROOT, Span};
use nearmiss_kernels::bv::{Aabb, Axes, Contain, Linear, Obb};
use nearmiss_kernels::math::Vec3;

/// A body's positions, one frame or two, turned and put elsewhere so that f64 is not f32.
fn frames<R: Precision>(body: &Body, size: f64, at: f64) -> Vec<Vec<Vec3<R>>> {
    let moved = |[x, y, z]: [f64; 3]| {
        Vec3([0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0].map(|x| R::of(size * x + at)))
    };
    let positions = std::iter::once(body.positions_t0()).chain(body.positions_t1());
    positions.map(|p| p.to_f64().into_iter().map(moved).collect()).collect()
}

/// Ways to go from a point, of a length just below 1: so that a coordinate of f64 may round on its way.
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

/// Pairs of a node and a corner below it around which it does not hold everything within `near`, of volumes that were told
/// to grow by `grow`, after `fault`.
fn outside<R: Precision, V: Kernels + Contain>(
    body: &Body,
    (size, at): (f64, f64),
    (refit, axes): (Refit, Axes),
    (grow, near): (f32, f32),
    fault: impl Fn(&mut [Node<V>]),
) -> usize {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
    let positions = frames::<R>(body, size, at);
    let still: Vec<Point<R>> = positions[0].iter().map(|&p| p.into()).collect();
    let points = device.upload(&still).expect("points");
    let ends = positions.get(1).unwrap_or(&positions[0]).iter();
    let moving: Vec<Motion<R>> =
        still.iter().zip(ends).map(|(&t0, &t1)| Motion { t0, t1: t1.into() }).collect();
    let motions = device.upload(&moving).expect("motions");
    let frames = if positions.len() == 1 {
        Frames { still: points.span(), moving: Span::EMPTY }
    } else {
        Frames { still: Span::EMPTY, moving: motions.span() }
    };
    let faces = device.upload(body.faces()).expect("faces");
    let count = body.face_count() as u32;
    let mut tree = Tree::new(&device, (0, count), refit, V::group(axes) > 0).expect("a tree");
    tree.construct::<R>(&device, frames, faces.span()).expect("built");
    let volumes = Volumes::<V>::new(&device, &tree, (axes, grow)).expect("room");
    volumes.fit(&device, &tree, frames, faces.span()).expect("fitted");
    volumes.refit(&device, &tree, frames, faces.span()).expect("refitted");
    volumes.check(&tree, body.faces(), &positions).expect("sound");
    let (mut nodes, links) = (volumes.download().expect("nodes"), tree.download().expect("links"));
    fault(&mut nodes);
    let parents = tree.pair_parents.read(tree.leaves()).expect("parents");
    let mut outside = 0;
    for (leaf, link) in links.iter().enumerate().skip(1).filter(|(_, link)| link.is_leaf()) {
        let face = body.faces()[link.triangle() as usize];
        let mut at = leaf as u32;
        loop {
            let volume = nodes[at as usize].volume;
            let held = |v: u32| {
                let motion = &moving[v as usize];
                let t1 = if positions.len() == 1 { motion.t0 } else { motion.t1 };
                WAYS[..if near > 0.0 { WAYS.len() } else { 1 }].iter().all(|way| {
                    let step = Vec3(*way) * f64::from(near);
                    volume.holds(motion.t0.at.wide() + step, t1.at.wide() + step)
                })
            };
            outside += face.iter().filter(|&&v| !held(v)).count();
            if at == ROOT {
                break;
            }
            at = parents[at as usize / 2];
        }
    }
    outside
}

fn all<R: Precision, V: Kernels + Contain>(axes: Axes) {
    let bodies = [scene::single(), scene::soup(700, 4, false), scene::soup(700, 4, true), scene::draped(800)];
    for (i, body) in bodies.map(|body| body.expect("a scene")).iter().enumerate() {
        for place in [(1.0, 0.0), (1e-3, 1e3), (1e25, 0.0)] {
            let refit = [Refit::Levels, Refit::Treelets, Refit::BottomUp][i % 3];
            assert_eq!(
                outside::<R, V>(body, place, (refit, axes), (0.0, 0.0), |_| ()),
                0,
                "{} {place:?}",
                body.name()
            );
        }
    }
    let body = scene::soup(300, 8, true).expect("a scene");
    for (refit, place) in
        [(Refit::Levels, (1.0, 0.0)), (Refit::Treelets, (1e-3, 1e3)), (Refit::BottomUp, (1e25, 0.0))]
    {
        let near = 0.125 * place.0 as f32;
        let out = |grow| outside::<R, V>(&body, place, (refit, axes), (grow, near), |_| ());
        assert_eq!(out(near), 0, "{refit:?}, {place:?}: what is near is held as well");
        assert!(out(0.0) > 0, "{refit:?}, {place:?}: forgotten growth is noticed");
        // Far from the origin a hundredth of it is less than what bounds are rounded by.
        assert!(place.1 > 0.0 || out(0.99 * near) > 0, "{refit:?}, {place:?}: too little growth is noticed");
    }
    // A node with its left child's volume: what is below the right one shows.
    let few = outside::<R, V>(&body, (1.0, 0.0), (Refit::Levels, axes), (0.0, 0.0), |nodes| {
        let at = (ROOT as usize..nodes.len()).rfind(|&at| !nodes[at].is_leaf()).expect("an inner node");
        nodes[at].volume = nodes[nodes[at].link as usize].volume;
    });
    assert!((1..=3).contains(&few), "{few}");
}

#[test]
fn every_node_holds_what_is_below_it() {
    all::<f32, Aabb>(Axes::PCA);
    all::<f64, Aabb>(Axes::PCA);
    all::<f32, Linear>(Axes::PCA);
    all::<f64, Linear>(Axes::PCA);
    for axes in [Axes::PCA, Axes::CHILD] {
        all::<f32, Obb>(axes);
        all::<f64, Obb>(axes);
    }
}
