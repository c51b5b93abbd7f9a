//! The cost of exclusions: launches and bytes. Scenes without them have neither.

use super::*;

const BUFFERS: [&str; 3] =
    ["vertices whose features are not tested together", "vertices of rest shapes", "faces that take no part"];

#[test]
fn a_launch_and_the_bytes_of_tables_are_of_scenes_with_exclusions() {
    let mut rng = SmallRng::seed_from_u64(1);
    let mesh = Mesh::new("cloth", sheet(4, 0.3, false, &mut rng), sheet_faces(4)).expect("a mesh");
    let end = Mesh::new("cloth", sheet(4, 0.3, false, &mut rng), sheet_faces(4)).expect("a mesh");
    let rest = RestShape { within: 0.1, positions: mesh.positions().clone() };
    let body = Body::moving(mesh, end).expect("two frames");
    for (query, behind) in [
        (Query::discrete(), 1),
        // Near looks them up in the launch that measures.
        (Query::near(0.1), 0),
        // One of the start, one of features.
        (support::asked::with_tolerance(Query::continuous(), 1e-4), 2),
        (support::asked::with_tolerance(Query::earliest(), 1e-4), 2),
        (nearmiss::Continuous::default().assuming_free(true).into(), 1),
    ] {
        let cost = |own: Exclusions| {
            let mut scene = Scene::from(body.clone());
            let id = scene.id(0).expect("a body");
            scene.exclude(id, own).expect("exclusions");
            let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
            for _ in 0..2 {
                detector.detect().expect("an answer");
            }
            let plan = detector.plan().expect("a plan");
            let bytes = BUFFERS.map(|what| plan.buffer(what).map_or(0, |buffer| buffer.held.bytes));
            let kernels: Vec<String> = plan
                .frame
                .iter()
                .flat_map(|stage| &stage.kernels)
                .map(|kernel| kernel.kernel.to_string())
                .collect();
            let excludes = kernels.iter().filter(|name| name.contains("exclud")).count();
            (plan.launches(), bytes, excludes)
        };
        let (launches, bytes, none) = cost(Exclusions::default());
        assert_eq!((bytes, none), ([0; 3], 0), "{query:?}");
        let own = || Exclusions { ring: Some(1), rest: Some(rest.clone()), faces: vec![31] };
        let (more, bytes, some) = cost(own());
        assert_eq!(more, launches + behind, "{query:?}");
        // 25 vertices: ranges, each with itself, and bits; places and reaches.
        let of_pairs = 4 * (25 + 1 + 25) + 16 * 25;
        assert_eq!(bytes, [of_pairs, (32 + 16) * 25, 4], "{query:?}");
        assert!(some > 0);
        let (_, bytes, _) = cost(Exclusions { rest: None, faces: Vec::new(), ..own() });
        assert_eq!(bytes, [of_pairs, 0, 0], "{query:?}");
        // A distance of 0 excludes nothing, so there is no table.
        let nothing = RestShape { within: 0.0, ..rest.clone() };
        assert_eq!(cost(Exclusions { rest: Some(nothing), ..Exclusions::default() }), (launches, [0; 3], 0));
    }
}
