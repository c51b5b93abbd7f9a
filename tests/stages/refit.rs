//! Every way to refit gives the same bits, frame after frame, on every machine; and what it costs in launches.

use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::Rebuild;
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt, Refit};
use nearmiss::{Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{ORDERS, cases, engine, machines};

const WAYS: [Refit; 2] = [Refit::Levels, Refit::Treelets];

/// A triangle far from everything: tested against it, a body of equal triangles has no contacts to
/// count.
fn far() -> Body {
    support::loose(&[[[1e6, 1e6, 1e6], [1e6 + 1.0, 1e6, 1e6], [1e6, 1e6 + 1.0, 1e6]]])
}

/// The body and the far triangle, neither tested against itself.
fn from_afar(body: &Body) -> Vec<Body> {
    support::between(vec![body.clone(), far()])
}

/// The deepest codes: for each of 63 bits a centre whose code has that bit alone, and `copies` triangles at each.
fn deep(copies: usize) -> Body {
    let corners: Vec<[f32; 3]> = (0..63 * copies)
        .flat_map(|i| {
            let mut at = [0.0; 3];
            at[i % 3] = 0.5f32.powi((i % 63 / 3) as i32);
            [at, at, at]
        })
        .collect();
    let faces = (0..63 * copies as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Body::deformable(Mesh::new("deep", Positions::F32(corners), faces).expect("a mesh"))
}

/// The body a frame later: every vertex elsewhere, some volumes larger and some smaller.
fn frame(body: &Body, turn: u32) -> Body {
    let points = body.positions_t0().to_f64().into_iter().enumerate().map(|(i, p)| {
        let sway =
            f64::from((i as u32).wrapping_add(turn * 40_503).wrapping_mul(2_654_435_761) >> 20) / 4_096.0;
        p.map(|x| (x * (1.0 + 0.125 * f64::from(turn)) + sway) as f32)
    });
    let points: Vec<[f32; 3]> = points.collect();
    let mesh = Mesh::new(body.name(), Positions::F32(points), body.faces().to_vec()).expect("a mesh");
    Body::deformable(mesh)
}

type Prints = Vec<(&'static str, u64)>;

/// The state after construction, fit and refit of each frame: as built, moved three times, rebuilt,
/// and moved again.
fn prints(device: Device, body: &Body, refit: Refit, volume: BoundingVolume) -> Vec<Prints> {
    let query = Query::discrete().with_refit(refit).with_volume(volume).with_rebuild(Rebuild::Manual);
    let mut detector = OneQuery::new(device, from_afar(body), query).expect("a detector");
    let mut all = Vec::new();
    for turn in 0..5 {
        if turn > 0 {
            detector.move_to(0, frame(body, turn)).expect("a frame of the mesh");
        }
        if turn == 3 {
            detector.rebuild().expect("another tree");
        }
        detector.detect().expect("an answer");
        detector.check_volumes().expect("sound trees");
        let mut prints = detector.fingerprints().expect("prints");
        prints.retain(|(stage, _)| ["construct", "fit", "refit"].contains(stage));
        assert_eq!(prints.len(), 3);
        all.push(prints);
    }
    all
}

/// Volumes that are merged all, and those of which small nodes are fitted to points.
const VOLUMES: [BoundingVolume; 2] = [BoundingVolume::Aabb, BoundingVolume::Obb];

fn agree(device: impl Fn() -> Device, body: &Body) {
    // The largest is for what all volumes share.
    let volumes = if body.face_count() > 100_000 { &VOLUMES[..1] } else { &VOLUMES };
    for &volume in volumes {
        let truth = prints(engine(), body, Refit::Levels, volume);
        for refit in WAYS {
            let device = device();
            let what = format!("{volume:?}, {refit:?}, {} triangles, {}", body.face_count(), device.name());
            assert_eq!(prints(device, body, refit, volume), truth, "{what}");
        }
    }
}

#[test]
fn every_way_gives_the_same_bits() {
    let known = [scene::single(), scene::line(1_500), scene::soup(1_500, 5, false), scene::draped(1_500)];
    let mut bodies: Vec<Body> = known.map(|body| body.expect("a scene")).to_vec();
    // Around the sizes of treelets and their chunks; nodes of the top more than a block has lanes.
    let sizes = [2, 3, 255, 256, 257, 511, 512, 513, 140_000];
    bodies.extend(sizes.map(|n| scene::identical(n).expect("a scene")));
    // A long chain above treelets, as deep as trees get here, and one in which every leaf is alone.
    bodies.extend([deep(1), deep(300), deep(257)]);
    for body in &bodies {
        agree(engine, body);
    }
}

#[test]
fn machines_cannot_be_told_apart() {
    let bodies = [
        scene::single().expect("a scene"),
        scene::identical(3).expect("a scene"),
        scene::soup(160, 9, false).expect("a scene"),
        deep(6),
    ];
    let seeds = 0..3u64;
    let both = |(at, body)| [(at, body, BoundingVolume::Aabb), (at, body, BoundingVolume::Obb)];
    for (at, body, volume) in bodies.iter().enumerate().flat_map(both) {
        let truth = prints(engine(), body, Refit::Levels, volume);
        let interleaved = seeds.clone().map(|seed| {
            let order = Mode::Sanitizer(ORDERS[seed as usize]);
            let emulator = Emulator::new(order, None).expect("threads").with_interleave(seed);
            // Small blocks: many of them, and several rounds of lanes in each.
            Device::emulator(emulator.with_lanes(32))
        });
        for (turn, device) in (at..).zip(machines().into_iter().chain(interleaved)) {
            // Both ways take turns: every machine has both with each volume.
            let refits = WAYS.into_iter().cycle().skip(turn % 2).take(cases(1, 2));
            for refit in refits {
                let what =
                    format!("{volume:?}, {refit:?}, {} triangles, {}", body.face_count(), device.name());
                assert_eq!(prints(device.clone(), body, refit, volume), truth, "{what}");
            }
        }
    }
}

#[test]
fn a_stale_volume_is_noticed() {
    let body = scene::soup(600, 2, false).expect("a scene");
    let of = |turn| {
        let query = Query::discrete().with_refit(Refit::Treelets).with_rebuild(Rebuild::Manual);
        let mut detector = OneQuery::new(engine(), from_afar(&body), query).expect("a detector");
        detector.move_to(0, frame(&body, turn)).expect("a frame");
        detector.detect().expect("an answer");
        detector.fingerprints().expect("prints")
    };
    let stages = |prints: &Prints, others: &Prints| -> Vec<&'static str> {
        prints.iter().zip(others).filter(|(a, b)| a != b).map(|(a, _)| a.0).collect()
    };
    assert_eq!(of(1), of(1));
    // A frame in which nothing moved: what is left in memory is the last one's.
    assert_eq!(stages(&of(1), &of(2)), ["fit", "refit"]);
    // One triangle whose volume is another frame's.
    let query = Query::default().with_broad_phase(BroadPhase::Tree).with_rebuild(Rebuild::Manual);
    let mut detector = OneQuery::new(engine(), from_afar(&body), query).expect("a detector");
    let mut points = frame(&body, 1).positions_t0().to_f64();
    points[300..303].copy_from_slice(&frame(&body, 2).positions_t0().to_f64()[300..303]);
    let points = points.into_iter().map(|p| p.map(|x| x as f32)).collect();
    let moved = Mesh::new("late", Positions::F32(points), body.faces().to_vec()).expect("a mesh");
    detector.move_to(0, Body::deformable(moved)).expect("a frame");
    detector.detect().expect("an answer");
    assert_eq!(stages(&detector.fingerprints().expect("prints"), &of(1)), ["fit", "refit"]);
}

#[test]
fn a_frame_costs_as_few_launches_as_promised() {
    let launches = |body: Body, refit| {
        let device = engine();
        let query = Query::discrete().with_refit(refit);
        let mut detector = OneQuery::new(device.clone(), from_afar(&body), query).expect("a detector");
        detector.detect().expect("an answer");
        let built = device.launches();
        detector.detect().expect("an answer");
        (device.launches() - built) as i64
    };
    for body in [scene::identical(10_000), scene::soup(9_000, 1, false), scene::single()] {
        let body = body.expect("a scene");
        let [levels, treelets] = WAYS.map(|refit| launches(body.clone(), refit));
        // One launch for fit and refit together; one each for fit and refit.
        let levels_launched = if body.face_count() == 1 { 0 } else { 1 };
        assert!(levels - treelets >= levels_launched, "{levels} {treelets}");
    }
}
