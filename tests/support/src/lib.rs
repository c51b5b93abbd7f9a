//! Shared parts of the test binaries: devices, scenes, public data, judges, and the inputs of the
//! fuzz targets.
#![allow(missing_docs, reason = "only tests read it")]

mod amount;
pub mod asked;
pub mod brute;
pub mod candidates;
mod data;
pub mod folder;
pub mod fuzz;
pub mod hard;
pub mod judges;
mod kernels;
pub mod ptx;
pub mod shrinking;
pub mod solids;
pub mod triangles;
pub mod truth;

pub use amount::{cases, some_ways};
pub use data::data;

use nearmiss::device::Backend;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{
    BoundingVolume, BroadPhase, FrontShape, KindExt, QueryExt, QueueShape, Refit, Search, StealShape,
    Traversal,
};
use nearmiss::scene::{CollisionFilter, Scene};
use nearmiss::{Device, Error, Query};
use nearmiss_io::MeshFile;
use nearmiss_lab::OneQuery;
use std::io::Read;

/// A mesh of the public test data.
pub fn mesh(path: &str) -> Mesh {
    MeshFile::read(&data(path)).expect("public data is a mesh").into_mesh()
}

/// Rows of a gzip CSV of the public test data, without the header.
pub fn rows(path: &str) -> Vec<Vec<String>> {
    let file = std::fs::File::open(data(path)).expect("readable");
    let mut text = String::new();
    flate2::read::GzDecoder::new(file).read_to_string(&mut text).expect("gzip text");
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The engine, on all cores.
pub fn engine() -> Device {
    Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"))
}

/// A sanitizer with that order.
pub fn sanitizer(order: Order) -> Device {
    Device::emulator(Emulator::new(Mode::Sanitizer(order), None).expect("threads"))
}

/// Every order in the tests.
pub const ORDERS: [Order; 3] = [Order::Forward, Order::Reverse, Order::Shuffled(20_261_121)];

/// Every walk, some with sizes so small that every list overflows and grows.
pub fn walks() -> Vec<Traversal> {
    let small = QueueShape { cores: Some(5), local: 3, segment: 2, take: 1, ..QueueShape::native() };
    vec![
        Traversal::PerLeaf { budget: None },
        Traversal::PerLeaf { budget: Some(3) },
        Traversal::Queue(QueueShape { cores: Some(9), ..QueueShape::native() }),
        Traversal::Queue(small),
        Traversal::Queue(QueueShape { segment: 999, ..QueueShape::gtx285() }),
        Traversal::Steal(StealShape { cores: Some(9), ..StealShape::native() }),
        Traversal::Front(FrontShape { queue: small, ..FrontShape::native() }),
    ]
}

/// Every walk of queries of that kind; `None` if there is only one.
pub fn walks_of(kind: QueryKind) -> Vec<Option<Traversal>> {
    if kind.takes_traversals() { walks().into_iter().map(Some).collect() } else { vec![None] }
}

/// The query with every volume, every walk and every refit of trees, and by tiles.
pub fn ways(query: Query) -> impl Iterator<Item = Query> {
    let refits = [Refit::Levels, Refit::Treelets];
    let walks = move || walks_of(query.kind());
    let of_trees = move |volume| {
        walks().into_iter().flat_map(move |traversal| {
            let search = Search {
                broad_phase: Some(BroadPhase::Tree),
                volume: Some(volume),
                traversal,
                ..Search::default()
            };
            refits.map(|refit| query.with_search(Search { refit: Some(refit), ..search }))
        })
    };
    let tiles = move |volume| {
        query.kind().takes_traversals().then(|| query.with_volume(volume).with_broad_phase(BroadPhase::Tiles))
    };
    BoundingVolume::ALL.into_iter().flat_map(move |volume| of_trees(volume).chain(tiles(volume)))
}

/// One answer on one device: of one body against itself, of more against each other only.
pub fn ask(device: Device, bodies: Vec<Body>, query: Query) -> nearmiss::Contacts {
    ask_scene(device, judged(bodies), query)
}

/// The bodies as judges test them: one against itself, more against each other only.
pub fn judged(bodies: Vec<Body>) -> Vec<Body> {
    if bodies.len() == 1 { bodies } else { between(bodies) }
}

/// The bodies, none tested against itself.
pub fn between(bodies: Vec<Body>) -> Vec<Body> {
    let other = |body: Body| {
        let filter = CollisionFilter { self_collision: Some(false), ..*body.filter() };
        body.with_filter(filter)
    };
    bodies.into_iter().map(other).collect()
}

/// One answer on one device, for any scene.
pub fn ask_scene(device: Device, scene: impl Into<Scene>, query: Query) -> nearmiss::Contacts {
    let mut detector = OneQuery::new(device, scene, query).expect("a detector");
    let contacts = detector.detect().expect("an answer");
    detector.check_volumes().expect("sound trees");
    contacts
}

/// A body at rest, of triangles given by their vertices.
pub fn still(points: &[[f32; 3]], faces: &[[u32; 3]]) -> Body {
    Body::deformable(Mesh::new("test", Positions::F32(points.to_vec()), faces.to_vec()).expect("a mesh"))
}

/// A body that moves from `t0` to `t1`.
pub fn moving(t0: &[[f32; 3]], t1: &[[f32; 3]], faces: &[[u32; 3]]) -> Body {
    let frame = |points: &[[f32; 3]]| {
        Mesh::new("test", Positions::F32(points.to_vec()), faces.to_vec()).expect("a mesh")
    };
    Body::moving(frame(t0), frame(t1)).expect("two frames of one mesh")
}

/// A body at rest, of triangles that share no vertex.
pub fn loose(triangles: &[[[f32; 3]; 3]]) -> Body {
    let faces: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    still(triangles.as_flattened(), &faces)
}

/// The GPU, in a build with feature `cuda`. Such tests fail if there is none: they would have
/// compared nothing. `NEARMISS_NO_GPU` says that there is none.
fn gpu() -> Option<Device> {
    if std::env::var_os("NEARMISS_NO_GPU").is_some() {
        return None;
    }
    match Device::open(Backend::Cuda, None) {
        Ok(device) => Some(device),
        // Only the library knows its features; this package would have to repeat them.
        Err(Error::Device { text, .. }) if text.contains("built without the feature `cuda`") => None,
        Err(error) => panic!("a test with feature `cuda` needs a GPU, or NEARMISS_NO_GPU=1: {error}"),
    }
}

/// The engine and, with feature `cuda`, the GPU.
pub fn engine_and_gpu() -> Vec<Device> {
    [engine()].into_iter().chain(gpu()).collect()
}

/// Every machine that must return the same answers. These are the engine on all threads and on one,
/// with unusual blocks, the sanitizer in each order, and the GPU.
pub fn machines() -> Vec<Device> {
    let emulator = |mode, threads| Emulator::new(mode, threads).expect("threads");
    let mut all = vec![emulator(Mode::Engine, None), emulator(Mode::Engine, Some(1))];
    all.extend([1, 7, 33, 1024].map(|lanes| emulator(Mode::Engine, None).with_lanes(lanes)));
    all.extend(ORDERS.map(|order| emulator(Mode::Sanitizer(order), None)));
    all.push(emulator(Mode::Sanitizer(ORDERS[2]), None).with_lanes(32));
    all.into_iter().map(Device::emulator).chain(gpu()).collect()
}
