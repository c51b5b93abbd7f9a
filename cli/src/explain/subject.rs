//! The pair: from meshes, from a file of queries, or from numbers.

use crate::args::{Between, ExplainArgs};
use crate::detect::body;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Positions, Problem, Topology};
use nearmiss::research::Certified;
use nearmiss::research::pipeline::of_pair;
use nearmiss_kernels::prim::adjacent::Shared;
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_lab::case::{Case, Features, file};
use nearmiss_lab::oracle::Triangle;
use std::path::Path;

/// The tolerance without a mesh to take it from.
const TOLERANCE: f64 = 1e-6;

/// The question.
pub enum Subject {
    Moving(Moving),
    Still(Still),
}

/// Two features that move.
pub struct Moving {
    /// Their origin, in words.
    pub of: [String; 2],
    pub case: Case,
    /// Solvers are given positions in f32, which hold them exactly.
    pub single: bool,
    /// Notes.
    pub notes: Vec<String>,
    pub params: Params,
}

/// Two triangles at t = 0.
pub struct Still {
    pub of: [String; 2],
    pub triangles: [Triangle; 2],
    pub shared: Shared,
    /// The corners that both have by index, each once.
    pub common: Vec<[f64; 3]>,
    pub single: bool,
    pub notes: Vec<String>,
}

/// The subject that the arguments name.
///
/// # Errors
/// [`Error::Input`] for files that cannot be used, and for indices, rows and numbers that there are not.
pub fn of(args: &ExplainArgs) -> Result<Subject, Error> {
    if let (Some(path), Some(row)) = (&args.queries, args.row) {
        return from_file(args, path, row);
    }
    if let Some(points) = &args.points {
        return from_numbers(args, points);
    }
    let mut bodies = vec![body(&args.meshes)?];
    if !args.with.is_empty() {
        bodies.push(body(&args.with)?);
    }
    if args.weld {
        bodies.iter_mut().for_each(|body| *body = body.weld().0);
    }
    let (a, b) = (&bodies[0], &bodies[bodies.len() - 1]);
    let self_query = bodies.len() == 1;
    let pair = |indices: &Option<Vec<u32>>| match indices.as_deref() {
        Some([i, j]) => Some((*i, *j)),
        _ => None,
    };
    if let Some((i, j)) = pair(&args.tt) {
        return triangles(a, b, self_query, [i, j]);
    }
    let ([p, q], features) = if let Some((v, f)) = pair(&args.vf) {
        ([vertex(a, v)?, face(b, f)?], Features::VertexFace)
    } else if let Some((i, j)) = pair(&args.ee) {
        ([edge(a, i)?, edge(b, j)?], Features::EdgeEdge)
    } else if let Some((i, v)) = pair(&args.ev) {
        // The test of an edge or a point is that of a face that repeats a vertex.
        ([vertex(b, v)?, edge(a, i)?.repeated()], Features::VertexFace)
    } else if let Some((v, w)) = pair(&args.vv) {
        ([vertex(a, v)?, vertex(b, w)?.repeated()], Features::VertexFace)
    } else {
        // clap requires one of them.
        return Err(Error::Bug { what: "a pair without features".into() });
    };
    let at = |end: bool| -> Result<Vec<[f64; 3]>, Error> { p.points(end).chain(q.points(end)).collect() };
    let mut notes = Vec::new();
    if self_query && p.corners.iter().any(|v| q.corners.contains(v)) {
        notes.push("they share a vertex: detect does not test such pairs".to_owned());
    }
    let case = Case { features, positions_t0: four(at(false)?)?, positions_t1: four(at(true)?)? };
    let single = bodies.iter().all(is_single);
    let of = [p.called, q.called];
    Ok(Subject::Moving(Moving { of, case, single, notes, params: params(args, of_pair(a, b)) }))
}

fn params(args: &ExplainArgs, default: f64) -> Params {
    let tolerance = args.tolerance.unwrap_or(default);
    Params {
        max_iterations: args.max_iterations.unwrap_or(Certified::MAX_ITERATIONS),
        ..Params::new(tolerance)
    }
}

fn from_file(args: &ExplainArgs, path: &Path, row: usize) -> Result<Subject, Error> {
    let features =
        args.between.map(features).or(file::features(path)).ok_or_else(|| Error::InvalidArgument {
            what: format!("--queries needs the kind of its features, got {}", path.display()),
            advice: "give --between vf or --between ee".into(),
        })?;
    let queries = file::queries(path, features)?;
    let &(case, truth) = queries.get(row).ok_or_else(|| Error::Input {
        file: path.display().to_string(),
        problem: Problem::NoSuch { what: "query", index: row as u64, count: queries.len() as u64 },
    })?;
    let notes = vec![format!("by the file they {}", if truth { "meet" } else { "do not meet" })];
    let of = format!("query {row} of {}", path.display());
    let of = parts(features).map(|part| format!("{part} of {of}"));
    Ok(Subject::Moving(Moving { of, case, single: false, notes, params: params(args, TOLERANCE) }))
}

fn from_numbers(args: &ExplainArgs, points: &[f64]) -> Result<Subject, Error> {
    if points.len() != 24 {
        return Err(Error::InvalidArgument {
            what: format!("--points takes 24 numbers, got {}", points.len()),
            advice: "give x, y, z of four points at t = 0, then at t = 1".into(),
        });
    }
    if let Some(bad) = points.iter().position(|x| !x.is_finite()) {
        let (vertex, axis) = (bad / 3, ['x', 'y', 'z'][bad % 3]);
        let problem = Problem::NonFinite { vertex, axis, value: points[bad] };
        return Err(Error::Input { file: "--points".into(), problem });
    }
    let features = features(args.between.unwrap_or(Between::Vf));
    let all: Vec<[f64; 3]> = points.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    let case =
        Case { features, positions_t0: four(all[..4].to_vec())?, positions_t1: four(all[4..].to_vec())? };
    let of = parts(features).map(|part| format!("{part} of the points given"));
    Ok(Subject::Moving(Moving {
        of,
        case,
        single: false,
        notes: Vec::new(),
        params: params(args, TOLERANCE),
    }))
}

fn triangles(a: &Body, b: &Body, self_query: bool, [i, j]: [u32; 2]) -> Result<Subject, Error> {
    let corners = [face(a, i)?.corners, face(b, j)?.corners];
    let place =
        |body: &Body, ids: &[u32]| ids.iter().map(|v| point(body, *v, false)).collect::<Result<Vec<_>, _>>();
    let triangle = |body, ids| Ok::<Triangle, Error>(three(place(body, ids)?));
    let ids = [0, 1].map(|k: usize| [0, 1, 2].map(|c: usize| corners[k][c]));
    let shared = if self_query { Shared::by_index(ids[0], ids[1]) } else { Shared::Nothing };
    let mut common: Vec<u32> =
        corners[0].iter().filter(|v| self_query && corners[1].contains(v)).copied().collect();
    common.sort_unstable();
    common.dedup();
    let mut notes = Vec::new();
    if shared != Shared::Nothing {
        notes.push(
            "they share corners: the test is whether they meet beyond them, as detect --adjacent does"
                .to_owned(),
        );
    }
    Ok(Subject::Still(Still {
        of: [named("triangle", i, a), named("triangle", j, b)],
        triangles: [triangle(a, &corners[0])?, triangle(b, &corners[1])?],
        shared,
        common: place(a, &common)?,
        single: is_single(a) && is_single(b),
        notes,
    }))
}

fn three(points: Vec<[f64; 3]>) -> Triangle {
    [0, 1, 2].map(|k| points[k])
}

/// The words for the two features.
pub fn parts(features: Features) -> [&'static str; 2] {
    match features {
        Features::VertexFace => ["vertex", "face"],
        Features::EdgeEdge => ["first edge", "second edge"],
    }
}

fn features(between: Between) -> Features {
    match between {
        Between::Vf => Features::VertexFace,
        Between::Ee => Features::EdgeEdge,
    }
}

/// A feature of a body.
struct Feature<'a> {
    body: &'a Body,
    /// Its kind, number and body, in words.
    called: String,
    corners: Vec<u32>,
}

impl<'a> Feature<'a> {
    fn new(body: &'a Body, what: &'static str, i: u32, corners: Vec<u32>) -> Feature<'a> {
        Feature { body, called: named(what, i, body), corners }
    }

    /// Its corners at t = 0, or at the end of the step.
    fn points(&self, end: bool) -> impl Iterator<Item = Result<[f64; 3], Error>> {
        self.corners.iter().map(move |v| point(self.body, *v, end))
    }

    /// The same as a face that repeats its last vertex.
    fn repeated(mut self) -> Feature<'a> {
        let last = self.corners.last().copied().unwrap_or_default();
        self.corners.resize(3, last);
        self
    }
}

fn named(what: &str, i: u32, body: &Body) -> String {
    format!("{what} {i} of {}", body.name())
}

fn is_single(body: &Body) -> bool {
    !body.positions_t0().is_f64() && body.positions_t1().is_none_or(|positions| !positions.is_f64())
}

fn no_such(body: &Body, what: &'static str, i: u32, count: usize) -> Error {
    let problem = Problem::NoSuch { what, index: i.into(), count: count as u64 };
    Error::Input { file: body.name().to_owned(), problem }
}

fn vertex(body: &Body, i: u32) -> Result<Feature<'_>, Error> {
    let count = body.vertex_count();
    let found = ((i as usize) < count).then(|| Feature::new(body, "vertex", i, vec![i]));
    found.ok_or_else(|| no_such(body, "vertex", i, count))
}

fn face(body: &Body, i: u32) -> Result<Feature<'_>, Error> {
    let found = body.elements().get(i as usize).map(|face| Feature::new(body, "face", i, face.to_vec()));
    found.ok_or_else(|| no_such(body, "face", i, body.element_count()))
}

fn edge(body: &Body, i: u32) -> Result<Feature<'_>, Error> {
    let edges = Topology::of(body).edges;
    let found = edges.get(i as usize).map(|ends| Feature::new(body, "edge", i, ends.to_vec()));
    found.ok_or_else(|| no_such(body, "edge", i, edges.len()))
}

/// A vertex at t = 0, or at the end of the step. One that no face uses need not be finite.
fn point(body: &Body, v: u32, end: bool) -> Result<[f64; 3], Error> {
    let positions: &Positions = match body.positions_t1() {
        Some(positions) if end => positions,
        _ => body.positions_t0(),
    };
    let Some(p) = positions.get_f64(v as usize) else {
        return Err(no_such(body, "vertex", v, positions.len()));
    };
    match p.iter().zip(['x', 'y', 'z']).find(|(x, _)| !x.is_finite()) {
        None => Ok(p),
        Some((value, axis)) => Err(Error::Input {
            file: body.name().to_owned(),
            problem: Problem::NonFinite { vertex: v as usize, axis, value: *value },
        }),
    }
}

fn four(points: Vec<[f64; 3]>) -> Result<[[f64; 3]; 4], Error> {
    points.try_into().map_err(|p: Vec<_>| Error::Bug { what: format!("{} points of two features", p.len()) })
}
