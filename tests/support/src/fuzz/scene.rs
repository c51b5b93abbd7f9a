//! A handful of triangles, whole: every solver, volume, walk and refit, against every pair by the
//! oracle.

use super::bytes::Bytes;
use super::device_arrays;
use crate::brute::{Row, row};
use nearmiss::contacts::{Contact, Kind, Rows, Status};
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::{Body, Mesh, Positions, Topology};
use nearmiss::query::QueryKind;
use nearmiss::research::{
    BoundingVolume, BroadPhase, FrontShape, QueryExt, QueueShape, Refit, Search, StealShape, Traversal,
};
use nearmiss::scene::CollisionFilter;
use nearmiss::{Contacts, Detector, Device, Error, Query};
use nearmiss_lab::oracle::{Toi, first_contact, triangles_meet};
use nearmiss_lab::{Case, Features};
use std::collections::BTreeMap;

/// One or two bodies of one to eight triangles, moving or at rest; any index may be any corner.
///
/// # Errors
/// Errors of the library.
pub fn decode(bytes: &[u8]) -> Result<(Vec<Body>, Query), Error> {
    let mut b = Bytes::new(bytes);
    let (choice, shape) = (b.byte(), b.byte());
    let kind = [QueryKind::Continuous, QueryKind::Discrete, QueryKind::Earliest][usize::from(choice) % 3];
    let queries: Vec<Query> = Query::every().filter(|query| query.kind() == kind).collect();
    let queue = QueueShape { cores: Some(5), local: 3, segment: 2, take: 1, ..QueueShape::native() };
    let walks = [
        Traversal::PerLeaf { budget: None },
        Traversal::PerLeaf { budget: Some(2) },
        Traversal::Queue(queue),
        Traversal::Steal(StealShape { cores: Some(3), ..StealShape::native() }),
        Traversal::Front(FrontShape { queue, ..FrontShape::native() }),
    ];
    // After the last walk: tiles, which have one traversal.
    let traversal = walks.get(usize::from(shape >> 2 & 15) % (walks.len() + 1)).copied();
    let refit = [Refit::Levels, Refit::Treelets][usize::from(shape >> 6) % 2];
    let query = queries[usize::from(choice / 3) % queries.len()].with_search(Search {
        broad_phase: Some(if traversal.is_some() { BroadPhase::Tree } else { BroadPhase::Tiles }),
        volume: Some(BoundingVolume::ALL[usize::from(shape) % BoundingVolume::ALL.len()]),
        traversal,
        refit: traversal.map(|_| refit),
        ..Search::default()
    });
    let count = 1 + b.below(8) % 2;
    let bodies = (0..count).map(|_| body(&mut b)).collect::<Result<_, _>>()?;
    Ok((bodies, query))
}

fn body(b: &mut Bytes) -> Result<Body, Error> {
    let (faces, vertices) = (1 + b.below(5), 3 + b.below(7));
    let moves = b.below(4) > 0;
    let faces: Vec<[u32; 3]> = (0..faces).map(|_| [0; 3].map(|_| b.below(vertices) as u32)).collect();
    let mut points: Vec<[f64; 3]> = Vec::new();
    for _ in 0..if moves { 2 * vertices } else { vertices } {
        let point = b.point_or(&points);
        points.push(point);
    }
    let mesh = |points: &[[f64; 3]]| {
        let positions = if b.is_single() {
            Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
        } else {
            Positions::F64(points.to_vec())
        };
        Mesh::new("fuzz", positions, faces.clone())
    };
    let first = mesh(&points[..vertices])?;
    if moves { Body::moving(first, mesh(&points[vertices..])?) } else { Ok(Body::deformable(first)) }
}

thread_local! {
    /// Small blocks, for small scenes.
    static ENGINE: Device =
        Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread").with_lanes(16));
}

/// Queries a scene, and judges the contacts after `lie` has changed them. A typed error is a valid
/// answer, except a fault of ours.
pub fn ask(bytes: &[u8], lie: impl Fn(&mut Rows)) -> Result<(), String> {
    let (bodies, query) = match decode(bytes) {
        Ok(all) => all,
        Err(error) => return typed(&error),
    };
    let mut contacts = match detect(&bodies, query) {
        Ok(contacts) => contacts,
        Err(error) => return typed(&error),
    };
    match ENGINE.with(|engine| device_arrays::detect(engine, &bodies, query)) {
        Ok(other) if other.rows == contacts.rows => {}
        Ok(other) => {
            let (resident, host) = (other.rows, contacts.rows);
            return Err(format!(
                "device-resident {resident:?}, from the host {host:?}; {query:?}, {bodies:?}"
            ));
        }
        Err(error) => return Err(format!("device-resident: {error}; {query:?}, {bodies:?}")),
    }
    lie(&mut contacts.rows);
    judge(&bodies, &query, &contacts.rows).map_err(|what| format!("{what}; {query:?}, {bodies:?}"))
}

/// The bodies as the judges test them: one against itself, two against each other only.
pub fn asked(bodies: &[Body]) -> Vec<Body> {
    let filter = if bodies.len() == 1 {
        CollisionFilter::with_self_collision()
    } else {
        CollisionFilter::without_self_collision()
    };
    bodies.iter().map(|body| body.clone().with_filter(filter)).collect()
}

/// The answer of a query.
///
/// # Errors
/// Errors of the library.
pub fn detect(bodies: &[Body], query: Query) -> Result<Contacts, Error> {
    ENGINE.with(|engine| Detector::new(engine.clone(), asked(bodies))?.query(&query))
}

/// Accepts a typed error, except a fault of ours.
///
/// # Errors
/// The text of a fault of ours.
pub fn typed(error: &Error) -> Result<(), String> {
    if matches!(error, Error::Bug { .. }) { Err(error.to_string()) } else { Ok(()) }
}

/// A planted fault: the last contact is left out.
pub fn forget(answer: &mut Rows) {
    match answer {
        Rows::Pairs(pairs) => drop(pairs.to_mut().pop()),
        Rows::Contacts(all) => drop(all.to_mut().pop()),
        Rows::Earliest(toi) => *toi = None,
        Rows::Near(near) => drop(near.to_mut().pop()),
        Rows::Distance(nearest) => *nearest = None,
        Rows::BodyPairs(pairs) => drop(pairs.to_mut().pop()),
        Rows::BodyDistances(all) => drop(all.to_mut().pop()),
    }
}

/// The fault of an answer, if it has one.
pub fn judge(bodies: &[Body], query: &Query, answer: &Rows) -> Result<(), String> {
    let certain = query.solver().is_certain();
    match answer {
        Rows::Pairs(pairs) => {
            let truth = triangle_pairs(bodies);
            if certain && *pairs != truth { Err(format!("pairs {pairs:?}, truly {truth:?}")) } else { Ok(()) }
        }
        Rows::Contacts(found) => {
            let all = every_pair(bodies);
            found.iter().try_for_each(|contact| judge_one(contact, &all, certain))?;
            let listed = |key: &Row| found.iter().any(|c| row(c) == *key);
            match all.iter().find(|(key, toi)| certain && toi.is_some() && !listed(key)) {
                Some((key, toi)) => Err(format!("missed {key:?} at {:?}", toi.as_ref().map(Toi::bracket))),
                None => Ok(()),
            }
        }
        // The target `near` compares distances with the oracle, `tests/scenes/bodies` pairs of bodies.
        Rows::Near(_) | Rows::Distance(_) | Rows::BodyPairs(_) | Rows::BodyDistances(_) => Ok(()),
        Rows::Earliest(found) => {
            let all = every_pair(bodies);
            let first = all.values().flatten().min();
            match (found, first) {
                (Some(toi), _) if !(0.0..=1.0).contains(toi) => {
                    Err(format!("earliest {toi}, which is not in [0, 1]"))
                }
                (None, Some(first)) if certain => Err(format!("none, truly first at {:?}", first.bracket())),
                (Some(toi), Some(first)) if certain && first.cmp_f64(*toi).is_lt() => {
                    Err(format!("late: {toi}, truly {:?}", first.bracket()))
                }
                _ => Ok(()),
            }
        }
    }
}

fn judge_one(c: &Contact, all: &BTreeMap<Row, Option<Toi>>, certain: bool) -> Result<(), String> {
    let Some(truth) = all.get(&row(c)) else { return Err(format!("{c:?} is not a pair of the scene")) };
    if !(0.0 <= c.toi && c.toi <= c.toi_upper && c.toi_upper <= 1.0) {
        return Err(format!("{c:?}: times out of range"));
    }
    let sure = c.status == Status::Certified;
    match truth {
        None if sure => Err(format!("{c:?}: a false certificate")),
        Some(truth) if certain && truth.cmp_f64(c.toi).is_lt() => {
            Err(format!("{c:?}: late, truly {:?}", truth.bracket()))
        }
        Some(truth) if sure && truth.cmp_f64(c.toi_upper).is_gt() => {
            Err(format!("{c:?}: a false certificate, truly {:?}", truth.bracket()))
        }
        _ => Ok(()),
    }
}

/// Every pair of features that a query tests, and its first contact.
fn every_pair(bodies: &[Body]) -> BTreeMap<Row, Option<Toi>> {
    let ends: Vec<[Vec<[f64; 3]>; 2]> = bodies
        .iter()
        .map(|body| {
            let first = body.positions_t0().to_f64();
            [first.clone(), body.positions_t1().map_or(first, Positions::to_f64)]
        })
        .collect();
    let first_of = |features, vertices: [(usize, u32); 4]| {
        let at = |end: usize| vertices.map(|(body, v)| ends[body][end][v as usize]);
        first_contact(&Case { features, positions_t0: at(0), positions_t1: at(1) })
    };
    let mut all = BTreeMap::new();
    let (a, b) = (0, bodies.len() - 1);
    let one = a == b;
    let mut faces_of = |v_of: usize, f_of: usize| {
        for v in used(&bodies[v_of]) {
            for (f, corners) in
                bodies[f_of].faces().iter().enumerate().filter(|(_, c)| !one || !c.contains(&v))
            {
                let [i, j, k] = corners.map(|c| (f_of, c));
                let toi = first_of(Features::VertexFace, [(v_of, v), i, j, k]);
                all.insert((Kind::Vf, [v_of, f_of], [v, f as u32]), toi);
            }
        }
    };
    faces_of(a, b);
    if !one {
        faces_of(b, a);
    }
    let edges = [a, b].map(|i| Topology::new(bodies[i].faces(), bodies[i].vertex_count()).edges);
    for (i, e) in edges[0].iter().enumerate() {
        let others = edges[1].iter().enumerate().skip(if one { i + 1 } else { 0 });
        for (j, g) in others.filter(|(_, g)| !one || !e.iter().any(|v| g.contains(v))) {
            let toi = first_of(Features::EdgeEdge, [(a, e[0]), (a, e[1]), (b, g[0]), (b, g[1])]);
            all.insert((Kind::Ee, [a, b], [i as u32, j as u32]), toi);
        }
    }
    all
}

/// The vertices that faces use.
fn used(body: &Body) -> Vec<u32> {
    let mut all: Vec<u32> = body.faces().iter().flatten().copied().collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Triangle pairs that share a point at t = 0 and no vertex.
fn triangle_pairs(bodies: &[Body]) -> Vec<[u32; 2]> {
    let triangles = |body: &Body| {
        let at = body.positions_t0().to_f64();
        body.faces().iter().map(|f| f.map(|v| at[v as usize])).collect::<Vec<_>>()
    };
    let (a, b) = (&bodies[0], &bodies[bodies.len() - 1]);
    let (p, q) = (triangles(a), triangles(b));
    let one = bodies.len() == 1;
    let mut pairs = Vec::new();
    for (i, first) in p.iter().enumerate() {
        for (j, second) in q.iter().enumerate().skip(if one { i + 1 } else { 0 }) {
            let adjacent = one && a.faces()[i].iter().any(|v| b.faces()[j].contains(v));
            if !adjacent && triangles_meet(first, second) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}
