//! Volumes that ignore the separation lose pairs within it, and the test notices it: the growth is
//! necessary.

use super::*;
use crate::device::emulator::{Emulator, Mode};
use crate::pipeline::Layout;
use crate::query::{BoundingVolume, Certified, CertifiedPrecision, Continuous, Refit};
use crate::research::QueryExt;
use crate::samples::soup;
use crate::scene::Scene;
use nearmiss_kernels::abi::Growth;

/// Returns how many pairs of random triangles certainly come within a tenth; `grows` is whether
/// volumes grow for it.
fn certain(query: Query, grows: bool) -> usize {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
    let scene = Scene::from(soup(60, 5, true));
    let bodies = scene.bodies();
    let layout = Arc::new(Layout::new(bodies, query.kind()));
    let (mut pipeline, at) = one(&device, bodies, &layout, query);
    if !grows {
        pipeline.scene.broads[pipeline.queries[at].broad].phase.set_growth(Growth::default());
    }
    let (found, _) = pipeline.frame(at).expect("a frame");
    let Listed::Hits { hits, .. } = found.listed else { panic!("a continuous query lists contacts") };
    let Hits::Lists(lists) = hits else { panic!("a CPU lists them as they are found") };
    lists.iter().flat_map(|list| list.iter()).filter(|hit| hit.verdict.is_contact()).count()
}

#[test]
fn volumes_without_the_separation_lose_pairs() {
    let certified =
        Certified { tolerance: Some(1e-3), min_separation: 0.1, ..Certified::by(CertifiedPrecision::F64) };
    let query = Query::from(Continuous::by(certified));
    let all = certain(query.with_refit(Refit::Levels), true);
    for refit in [Refit::Levels, Refit::Treelets] {
        let counts = |grows| {
            BoundingVolume::ALL.map(|volume| certain(query.with_volume(volume).with_refit(refit), grows))
        };
        assert_eq!(counts(true), [all; BoundingVolume::ALL.len()], "{refit:?}");
        assert!(counts(false).iter().all(|count| *count < all), "{refit:?}: {:?} of {all}", counts(false));
    }
}
