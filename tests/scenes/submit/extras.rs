//! Parts of an answer on the device, on request: those that the host makes of the collected answer.

use super::*;
use nearmiss::contacts::on_device::{DeviceExtras, Entries, RowGeometry};
use nearmiss::contacts::{DeviceAnswer, DeviceList, GroupBy, Kind};
use nearmiss::{Continuous, Detector, Discrete, Near};
use std::collections::BTreeMap;

/// A row by its features, numbered through all bodies: its list, and both numbers.
type Name = (usize, u32, u32);

/// The parts, as a caller reads them.
#[derive(Clone)]
struct Parts {
    /// Names of rows, in their order.
    names: Vec<Name>,
    geometry: Vec<RowGeometry>,
    least: Vec<f64>,
    groups: Vec<(GroupBy, Vec<u32>, Vec<u32>)>,
}

/// Parts of each body's rows, as the host makes them: rows are numbered as the device numbers them.
struct Wanted {
    /// Vertices, weights, points, distance and normal of each row.
    geometry: Vec<RowGeometry>,
    least: Vec<f64>,
    /// The rows of each feature, ascending.
    groups: Vec<(GroupBy, Vec<Vec<u32>>)>,
}

/// Numbers in the memory of a CPU.
fn read<T: Copy>(list: DeviceList) -> Vec<T> {
    if list.room == 0 {
        return Vec::new();
    }
    // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
    unsafe { std::slice::from_raw_parts(list.address as *const T, list.room) }.to_vec()
}

fn parts(answer: &DeviceAnswer) -> Parts {
    let words = |at: usize| -> Vec<[u32; 2]> {
        // The features are the first eight bytes of an entry.
        let list = answer.lists[at];
        match answer.entries {
            Entries::TrianglePairs => read::<[u32; 2]>(list),
            _ => read::<[u32; 8]>(list).into_iter().map(|[a, b, ..]| [a, b]).collect(),
        }
    };
    // SAFETY: as above.
    let status = unsafe { *(answer.status as *const FrameStatus) };
    assert_eq!((status.short, status.invalid), (0, 0));
    let mut names = Vec::new();
    for (at, count) in [status.first, status.second].into_iter().enumerate().take(answer.lists.len()) {
        names.extend(words(at)[..count as usize].iter().map(|&[a, b]| (at, a, b)));
    }
    let groups = answer.grouped.iter().map(|own| (own.by, read(own.starts), read(own.rows)));
    Parts {
        names,
        geometry: answer.geometry.map_or(Vec::new(), read),
        least: answer.least_by_vertex.map_or(Vec::new(), read),
        groups: groups.collect(),
    }
}

/// The first difference between the parts of the device and those of the host.
fn difference(parts: &Parts, wanted: &Wanted) -> Option<String> {
    let rows = parts.names.len();
    let geometry = parts.geometry.get(..rows).unwrap_or_default();
    if bytemuck::cast_slice::<_, u64>(geometry) != bytemuck::cast_slice::<_, u64>(&wanted.geometry) {
        return Some("geometry of a row".into());
    }
    let unused = parts.geometry.get(rows..).unwrap_or_default();
    if unused.iter().any(|record| *record != RowGeometry::default()) {
        return Some("geometry of an unused row".into());
    }
    if parts.least.iter().map(|x| x.to_bits()).ne(wanted.least.iter().map(|x| x.to_bits())) {
        return Some("least numbers".into());
    }
    for ((by, starts, rows), (wanted_by, wanted)) in parts.groups.iter().zip(&wanted.groups) {
        assert_eq!((by, starts.len()), (wanted_by, wanted.len() + 1));
        for (feature, wanted) in wanted.iter().enumerate() {
            let own = &rows[starts[feature] as usize..starts[feature + 1] as usize];
            if own != wanted {
                return Some(format!("rows of {} {feature}", by.name()));
            }
        }
        if rows[*starts.last().expect("an end") as usize..].iter().any(|&row| row != u32::MAX) {
            return Some(format!("unused rows by {}", by.name()));
        }
    }
    (parts.groups.len() != wanted.groups.len()).then(|| "number of groups".into())
}

const ALL: [GroupBy; 4] = [GroupBy::Corner, GroupBy::Vertex, GroupBy::Edge, GroupBy::Face];

/// All parts that rows of features, or of triangles, can have.
fn everything(of_features: bool) -> (DeviceExtras, Vec<GroupBy>) {
    if of_features {
        let extras = DeviceExtras::default().with_geometry().with_least_by_vertex();
        return (ALL.into_iter().fold(extras, DeviceExtras::grouped_by), ALL.into());
    }
    let by = vec![GroupBy::Face, GroupBy::Corner];
    (by.iter().fold(DeviceExtras::default(), |extras, &by| extras.grouped_by(by)), by)
}

/// The scene of [`pair`], with threads between the triangles, and points.
fn with_threads(n: usize) -> (Scene, BodyId, [Vec<[f32; 3]>; 2]) {
    let (mesh, ends) = soup(n, 1);
    let last = ends[0].len() as u32 - 1;
    let threads = (0..last / 4).map(|i| [4 * i, 4 * i + 3]).collect();
    let mesh = mesh.with_edges(threads).and_then(|mesh| mesh.with_points((0..last).step_by(9).collect()));
    let mut scene = Scene::new();
    let body = Body::deformable(mesh.expect("a mesh"));
    let id = scene.add(body.with_filter(CollisionFilter::with_self_collision()));
    scene.add(Body::fixed(soup(n / 2, 2).0));
    (scene, id, ends)
}

/// A row's list and the vertices of both features, in any order: the same for the device's numbers and
/// for those of an answer.
fn key(list: usize, mut first: Vec<u32>, mut second: Vec<u32>) -> (usize, Vec<u32>, Vec<u32>) {
    for side in [&mut first, &mut second] {
        side.sort_unstable();
        side.dedup();
    }
    // A vertex comes before an edge or a face, and two vertices by number.
    if (second.len(), &second) < (first.len(), &first) && list == 0 {
        std::mem::swap(&mut first, &mut second);
    }
    (list, first, second)
}

/// Submits one query with all parts; those of the device, and those that the host makes.
fn both(
    device: &Device,
    (scene, id, ends): (Scene, BodyId, [Vec<[f32; 3]>; 2]),
    query: Query,
) -> (Parts, Wanted) {
    let mut detector = Detector::new(device.clone(), scene).expect("a detector");
    let memory = ends.each_ref().map(|points| Points::new(device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let of_features = !matches!(query, Query::Discrete(_));
    let (extras, by) = everything(of_features);
    detector.prepare_with(&[(id, input)], &[query], &extras).expect("prepared");
    let before = (device.allocations(), device.waits());
    detector.submit().expect("submitted");
    assert_eq!((device.allocations(), device.waits()), before);
    let answer = detector.on_device(&query).expect("prepared");
    let parts = parts(&answer);
    // SAFETY: of a CPU the address is the host's; nothing runs.
    let edges: Vec<[u32; 2]> = read(answer.edges);
    let bodies = detector.scene().bodies().iter().zip(&answer.starts);
    let triangles: Vec<[u32; 3]> = bodies
        .flat_map(|(body, first)| body.elements().iter().map(|own| own.map(|v| v + first[0])))
        .collect();
    let of_device = parts.names.iter().map(|&(list, a, b)| match (list, of_features) {
        (_, false) => key(1, triangles[a as usize].into(), triangles[b as usize].into()),
        (0, true) => key(0, vec![a], triangles[b as usize].into()),
        _ => key(1, edges[a as usize].into(), edges[b as usize].into()),
    });
    let places: BTreeMap<_, u32> = of_device.zip(0..).collect();
    assert_eq!(places.len(), parts.names.len());
    let found = detector.collect(&query).expect("an answer");
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    let (mut rows, mut geometry) = (vec![0; found.len()], vec![RowGeometry::default(); found.len()]);
    let mut least = Vec::new();
    if of_features {
        let made = detector.geometry(&found).expect("geometry");
        for (row, at) in made.contacts().iter().enumerate() {
            let vertices =
                [0, 1, 2, 3].map(|k: usize| answer.starts[at.owner[k].index()][0] + at.vertices[k]);
            let (list, first) = (usize::from(at.kind == Kind::Ee), at.kind.vertices_of_a());
            rows[row] = places[&key(list, vertices[..first].into(), vertices[first..].into())];
            geometry[rows[row] as usize] = RowGeometry {
                distance: at.distance,
                normal: at.normal,
                signed_weights: at.signed_weights,
                points: at.points,
                vertices,
            };
        }
        least = ids.iter().flat_map(|&id| detector.least_by_vertex(&found, id).expect("least")).collect();
    } else {
        for (row, pair) in found.pairs().iter().enumerate() {
            let [a, b] = [0, 1].map(|k| {
                triangles[(answer.starts[pair.bodies[k].index()][1] + pair.triangles[k]) as usize].into()
            });
            rows[row] = places[&key(1, a, b)];
        }
        geometry.clear();
    }
    let mut groups = Vec::new();
    for by in by {
        let mut all = Vec::new();
        for &id in &ids {
            let own = detector.grouped(&found, id, by).expect("rows by feature");
            all.extend((0..own.len()).map(|feature| {
                let mut of: Vec<u32> = own.of(feature).iter().map(|&row| rows[row as usize]).collect();
                of.sort_unstable();
                of
            }));
        }
        groups.push((by, all));
    }
    (parts, Wanted { geometry, least, groups })
}

#[test]
fn parts_on_the_device_are_those_of_the_host() {
    let queries: [Query; 4] = [
        Near::within(0.05).into(),
        Continuous::default().into(),
        Continuous::default().with_min_separation(0.01).into(),
        Discrete::default().into(),
    ];
    let machines = ORDERS.map(sanitizer).into_iter().chain([engine()]);
    for device in machines {
        for query in queries {
            for scene in [pair(120), with_threads(90)] {
                let (parts, wanted) = both(&device, scene, query);
                assert!(parts.names.len() > 50, "{} rows of {query:?}", parts.names.len());
                assert_eq!(difference(&parts, &wanted), None, "{query:?}");
            }
        }
    }
}

/// A fault in each part is named.
#[test]
fn a_fault_in_a_part_is_named() {
    let (parts, wanted) = both(&engine(), pair(120), Near::within(0.05).into());
    let named = |fault: &dyn Fn(&mut Parts)| {
        let mut faulty = parts.clone();
        fault(&mut faulty);
        difference(&faulty, &wanted).unwrap_or_default()
    };
    assert_eq!(named(&|_| ()), "");
    assert_eq!(named(&|parts| parts.geometry[3].signed_weights[1] = 0.5), "geometry of a row");
    assert_eq!(
        named(&|parts| parts.geometry.last_mut().expect("room").distance = 1.0),
        "geometry of an unused row"
    );
    assert_eq!(named(&|parts| parts.least[5] = 0.0), "least numbers");
    assert!(named(&|parts| parts.groups[0].2.swap(0, 1)).starts_with("rows of corner"));
    assert!(
        named(&|parts| *parts.groups[2].2.last_mut().expect("room") = 0).starts_with("unused rows by edge")
    );
}

#[test]
fn parts_that_no_answer_has_are_refused() {
    let device = engine();
    let (scene, id, ends) = pair(60);
    let memory = ends.each_ref().map(|points| Points::new(&device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let mut detector = Detector::new(device, scene).expect("a detector");
    let discrete = Query::from(Discrete::default());
    for (extras, part) in [
        (DeviceExtras::default().with_geometry(), "geometry of rows"),
        (DeviceExtras::default().with_least_by_vertex(), "least numbers of vertices"),
        (DeviceExtras::default().grouped_by(GroupBy::Edge), "rows by edge"),
    ] {
        let error = detector.prepare_with(&[(id, input)], &[discrete], &extras).expect_err("refused");
        assert!(error.to_string().contains(part) && !detector.is_prepared(), "{error}");
        // With another query, only that one has it.
        let near = Query::from(Near::within(0.05));
        detector.prepare_with(&[(id, input)], &[discrete, near], &extras).expect("prepared");
        let answer = detector.on_device(&discrete).expect("prepared");
        assert!(answer.geometry.is_none() && answer.least_by_vertex.is_none() && answer.grouped.is_empty());
    }
    // Without a request there is nothing.
    detector.prepare(&[(id, input)], &[Near::within(0.05).into()]).expect("prepared");
    let answer = detector.on_device(&Near::within(0.05).into()).expect("prepared");
    assert!(answer.geometry.is_none() && answer.least_by_vertex.is_none() && answer.grouped.is_empty());
}

/// Points of a body that turns move on arcs, which only the host follows.
#[test]
fn geometry_of_a_turn_is_refused() {
    let (mesh, [t0, _]) = soup(20, 1);
    let device = engine();
    let poses = device.upload(&[[0.0f64, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]; 2]).expect("memory");
    let mut scene = Scene::new();
    let id = scene.add(Body::rigid(mesh));
    scene.add(Body::fixed(soup(20, 2).0));
    let mut detector = Detector::new(device, scene).expect("a detector");
    let pose = |at: u64| {
        let rows = |offset: u64| {
            // SAFETY: the buffer is kept as long as the detector, and nothing writes it.
            unsafe { DeviceRows::new(poses.span().addr() + 56 * at + offset, 1, 56, Number::F64) }
                .expect("rows")
        };
        DevicePose { translation: rows(0), rotation: rows(24) }
    };
    let motion = DeviceMotion::PoseStep([pose(0), pose(1)]);
    let extras = DeviceExtras::default().with_geometry();
    let every = Query::from(Continuous::default());
    let error = detector.prepare_with(&[(id, motion)], &[every], &extras).expect_err("refused");
    assert!(error.to_string().contains("may turn"), "{error}");
    detector.prepare(&[(id, motion)], &[every]).expect("prepared");
    assert_eq!(t0.len(), 60);
}
