//! Tiles with one planted fault each: the checker must name it.

use super::*;
use crate::device::emulator::{Emulator, Mode};
use crate::mesh::{Mesh, Positions};
use crate::pipeline::broad::Checked;
use crate::query::QueryKind;
use crate::samples::soup;
use crate::scene::{Body, CollisionFilter};
use nearmiss_kernels::abi::{self, LEAF, Point};
use nearmiss_kernels::bv::{Aabb, Volume};
use nearmiss_kernels::math::Vec3;

/// A change to sound tiles.
type Fault = fn(&mut Tiles<Aabb>);

/// Returns the checker's verdict on tiles over three bodies, one of them fixed, after `fault`.
fn checked(fault: impl Fn(&mut Tiles<Aabb>)) -> Result<(), Error> {
    let bodies = [
        soup(700, 5, false),
        soup(1_000, 6, false).with_filter(CollisionFilter::without_self_collision()),
        Body::fixed(soup(900, 7, false).frames().swap_remove(0)),
    ];
    checked_of(&bodies, fault)
}

/// Returns the checker's verdict on 4,096 faces round one hub, with rims, after `fault`.
fn checked_rims(fault: impl Fn(&mut Tiles<Aabb>)) -> Result<(), Error> {
    let n = 4_096;
    let on_rim = |k: u32| [(k % 64) as f32, (k / 64) as f32, 1.0];
    let points = std::iter::once([0.0; 3]).chain((0..n).map(on_rim)).collect();
    let faces = (0..n).map(|k| [1 + k, 0, 1 + (k + 1) % n]).collect();
    checked_of(&[Body::deformable(Mesh::new("fan", Positions::F32(points), faces)?)], fault)
}

/// Returns the checker's verdict on tiles over these bodies after `fault`.
fn checked_of(bodies: &[Body], fault: impl Fn(&mut Tiles<Aabb>)) -> Result<(), Error> {
    let device = Device::emulator(Emulator::new(Mode::Engine, None)?);
    let mut layout = Layout::new(bodies, QueryKind::Discrete);
    layout.find_hubs(true);
    let positions = |body: &Body| body.positions_t0().to_f64();
    let at: Vec<Vec3<f32>> = bodies.iter().flat_map(positions).map(|p| Vec3(p.map(|x| x as f32))).collect();
    let points = device.upload(&at.iter().map(|&p| p.into()).collect::<Vec<Point<f32>>>())?;
    let (faces, records) = (device.upload(&layout.faces)?, device.upload(&layout.records)?);
    let given = BroadContext {
        device: &device,
        frames: abi::Positions { still: points.span(), moving: Span::EMPTY, turns: Span::EMPTY },
        faces: faces.span(),
        records: records.span(),
        filters: FilterArgs::NONE,
        is_submitted: false,
        instances: None,
    };
    let mut tiles = Tiles::<Aabb>::new(&device, &layout, abi::Growth::margin(0.01))?;
    tiles.construct(&given, &layout)?;
    CandidateSearch::fit(&mut tiles, &given)?;
    CandidateSearch::refit(&mut tiles, &given)?;
    fault(&mut tiles);
    CandidateSearch::<f32>::check(&tiles, &layout, &layout.faces, &Checked::new(vec![at], Vec::new()))
}

/// Changes one element.
fn change<T: bytemuck::Pod>(buffer: &mut Buffer<T>, at: usize, change: impl Fn(&mut T)) {
    let mut all = buffer.read(buffer.len()).expect("read");
    change(&mut all[at]);
    buffer.write(&all).expect("written");
}

/// The first leaf of the fixed body: after three and a half groups of 16 tiles.
const STATIC_LEAF: usize = 4 * 512;
/// The node above the second 16 tiles: after all tiles.
const ABOVE: usize = 6 * 16 + 1;

#[test]
fn sound_tiles_pass() {
    checked(|_| ()).expect("sound tiles");
}

/// Volumes are checked against other positions than those that they were fitted to.
#[test]
fn a_triangle_outside_is_named() {
    let held = |by: f64| {
        let volume =
            |lo: f32, hi: f32| -> Aabb { Volume::still([Vec3([lo; 3]), Vec3([hi; 3]), Vec3([lo, hi, lo])]) };
        let (levels, count) = (Levels::of([40, 0]), 40);
        let leaf = |last: u32| Node {
            volume: volume(0.0, 1.0),
            link: if last < count { LEAF | last } else { NONE },
            last,
        };
        let leaves: Vec<_> = (0..levels.leaves()).map(leaf).collect();
        let mut nodes = vec![leaf(0); levels.first(levels.count) as usize];
        // The second tile is too small for its triangles.
        nodes[1].volume = volume(0.0, 0.5);
        let tiles =
            tiles::Tiles { levels, triangles: [count, 0], leaves: &leaves, nodes: &nodes, filters: &[] };
        let at = |triangle: u32| if triangle < 32 { by } else { 0.5 };
        tiles::check_held(&tiles, |triangle| [[Vec3([0.0; 3]), Vec3([at(triangle); 3])]; 3])
    };
    use nearmiss_kernels::bvh::Violation::Outside;
    assert_eq!(held(1.0), Ok(()));
    // The positions at the end count, and so does the least step beyond the volume.
    assert_eq!(held(1.0f64.next_up()), Err(Outside { leaf: 0, level: 0 }));
}

#[test]
fn every_fault_is_named() {
    let faults: [(&str, Fault); 14] = [
        ("Fit { node: 40 }", |tiles| change(&mut tiles.leaves, 40, |node| node.link = LEAF | 3)),
        ("Leaf { leaf: 41 }", |tiles| change(&mut tiles.leaves, 41, |node| node.last = 3)),
        ("Leaf { leaf: 42 }", |tiles| change(&mut tiles.leaves, 42, |node| node.link &= !LEAF)),
        // A triangle of the fixed body among moving ones, and one past the last triangle.
        ("Leaf { leaf: 43 }", |tiles| change(&mut tiles.leaves, 43, |node| node.link = LEAF | 1_700)),
        ("Leaf { leaf: 1700 }", |tiles| change(&mut tiles.leaves, 1_700, |node| node.link = LEAF | 3)),
        ("Leaf { leaf: 2050 }", |tiles| {
            let twice = tiles.leaves.read(STATIC_LEAF + 2).expect("read")[STATIC_LEAF];
            change(&mut tiles.leaves, STATIC_LEAF + 2, |node| node.link = twice.link);
        }),
        ("Fit { node: 77 }", |tiles| {
            let other = tiles.leaves.read(1).expect("read")[0].volume;
            change(&mut tiles.leaves, 77, |node| node.volume = other);
        }),
        ("Merge { node: 9 }", |tiles| {
            let other = tiles.nodes.read(1).expect("read")[0].volume;
            change(&mut tiles.nodes, 9, |node| node.volume = other);
        }),
        ("Merge { node: 10 }", |tiles| change(&mut tiles.nodes, 10, |node| node.last = 11)),
        ("Merge { node: 97 }", |tiles| change(&mut tiles.nodes, ABOVE, |node| node.link = 0)),
        ("Filter { node: 3 }", |tiles| change(&mut tiles.filters, 3, |filter| filter.who ^= 1)),
        ("Filter { node: 97 }", |tiles| change(&mut tiles.filters, ABOVE, |filter| filter.last += 1)),
        ("Filter { node: 4 }", |tiles| change(&mut tiles.filters, 4, |filter| filter.hub ^= 1)),
        ("Filter { node: 97 }", |tiles| change(&mut tiles.filters, ABOVE, |filter| filter.hub = 9)),
    ];
    for (name, fault) in faults {
        let error = checked(fault).expect_err(name).to_string();
        assert!(error.contains(name), "{name}: {error}");
    }
}

/// Rims and their hubs, of tiles and of nodes above.
#[test]
fn every_fault_of_a_rim_is_named() {
    checked_rims(|tiles| assert_eq!(tiles.rims.len(), 136)).expect("sound rims");
    let faults: [(&str, Fault); 5] = [
        ("Rim { node: 5 }", |tiles| change(&mut tiles.rims, 5, |rim| rim.link = 2)),
        ("Rim { node: 6 }", |tiles| change(&mut tiles.rims, 6, |rim| rim.link = 0)),
        ("Rim { node: 7 }", |tiles| {
            let other = tiles.rims.read(9).expect("read")[8].volume;
            change(&mut tiles.rims, 7, |rim| rim.volume = other);
        }),
        ("Rim { node: 128 }", |tiles| change(&mut tiles.rims, 128, |rim| rim.link = 0)),
        ("Rim { node: 130 }", |tiles| {
            let other = tiles.rims.read(9).expect("read")[8].volume;
            change(&mut tiles.rims, 130, |rim| rim.volume = other);
        }),
    ];
    for (name, fault) in faults {
        let error = checked_rims(fault).expect_err(name).to_string();
        assert!(error.contains(name), "{name}: {error}");
    }
}

/// Memory for another number of tiles.
#[test]
fn another_number_of_triangles_is_named() {
    let error = checked(|tiles| tiles.triangles[FIXED] = 3_000).expect_err("too few places");
    assert!(error.to_string().contains("Levels"), "{error}");
}
