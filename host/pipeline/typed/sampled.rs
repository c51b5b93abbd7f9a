//! In a sample of an earliest query f64 works only if f32 has found no time.

use super::*;
use crate::device::emulator::{Emulator, Mode, Order};
use crate::mesh::{Mesh, Positions};
use crate::pipeline::Layout;
use crate::query::{Certified, CertifiedPrecision, Earliest};
use nearmiss_kernels::abi::counter;

/// A face, and triangles whose first corners are above it: one falls through, which f32 decides; one
/// touches at the start, which it leaves to f64.
fn triangles(falls: bool, touches: bool) -> Body {
    let mut ends = [0; 2].map(|_| vec![[-4.0, -4.0, 0.0], [8.0, -4.0, 0.0], [-4.0, 8.0, 0.0]]);
    for (is_there, x, heights) in [(falls, 0.0, [0.5, -0.7]), (touches, 1.0, [0.0, 1.0])] {
        for (end, height) in ends.iter_mut().zip(heights).filter(|_| is_there) {
            end.extend(
                [[0.0, 0.0, 0.0], [0.1, 0.2, 2.0], [0.3, 0.1, 2.0]]
                    .map(|[u, v, w]| [x + u, 0.25 + v, height + w]),
            );
        }
    }
    let faces: Vec<_> = (0..ends[0].len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let [t0, t1] = ends.map(|end| Mesh::new("sample", Positions::F32(end), faces.clone()).expect("a mesh"));
    Body::moving(t0, t1).expect("a step")
}

/// Returns how many pairs f32 leaves to f64, and how many f64 leaves, if all pairs are a sample.
fn left(mode: Mode, body: Body, precision: CertifiedPrecision) -> [u64; 2] {
    let device = Device::emulator(Emulator::new(mode, None).expect("threads"));
    let certified = Certified { tolerance: Some(1e-3), ..Certified::by(precision) };
    let query = Query::from(Earliest::by(certified));
    let bodies = [body];
    let layout = Arc::new(Layout::new(&bodies, query.kind()));
    let (mut pipeline, at) = one(&device, &bodies, &layout, query);
    let (scene, own) = (&mut pipeline.scene, &mut pipeline.queries[at]);
    own.counters.clear().expect("counters");
    for stage in [Stage::Fit, Stage::Refit] {
        own.run(scene, stage).expect("volumes");
    }
    own.step(scene, Step::Traverse).expect("candidates");
    own.narrow.take_samples(&device).expect("memory");
    for k in own.narrow_steps_at() {
        own.step(scene, Step::Narrow(k, true)).expect("a step of the sample");
    }
    let counts = own.counters.read().expect("counters");
    [
        counts[counter::VF_ESCALATED] + counts[counter::EE_ESCALATED],
        counts[counter::VF_OPEN] + counts[counter::EE_OPEN],
    ]
}

#[test]
fn f64_works_in_a_sample_only_if_f32_found_nothing() {
    use CertifiedPrecision::{F64, Mixed};
    for mode in [Mode::Engine, Mode::Sanitizer(Order::Forward), Mode::Sanitizer(Order::Reverse)] {
        let both = || triangles(true, true);
        let [escalated, open] = left(mode, both(), Mixed);
        assert!(escalated > 0 && open == 0, "f32 has found a time: {escalated}, {open}");
        let [escalated, open] = left(mode, triangles(false, true), Mixed);
        assert!(escalated > 0 && open > 0, "f32 has found none: {escalated}, {open}");
        let [escalated, open] = left(mode, both(), F64);
        assert!(escalated == 0 && open > 0, "f64 is alone: {escalated}, {open}");
    }
}
