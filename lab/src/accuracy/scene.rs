//! Whole scenes: every choice runs on the same bodies. The finest certified contacts, or a list,
//! judge it.

use super::input::{Choice, truth};
use super::judge::{Counts, Judge, Judged, Truth};
use super::row::Row;
use super::truth::{Key, List};
use crate::OneQuery;
use crate::case::{Case, Features};
use crate::pairs::{Options, Outcome, ask};
use nearmiss::contacts::{Contact, Contacts, Kind, Status};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Positions, Topology};
use nearmiss::query::{Continuous, Query, QueryKind};
use nearmiss::research::pipeline::mean_side;
use nearmiss::research::{
    BoundingVolume, Certified, CertifiedPrecision, QueryExt, Search, Solver, WithSolver,
};
use rayon::prelude::*;

/// A body whose contacts are known.
pub struct Scene {
    /// Its name.
    pub name: String,
    /// The body: in motion for contacts, still for triangle pairs.
    pub body: Body,
    /// Mean side length of its triangles.
    pub edge: f64,
    reference: &'static str,
    edges: Vec<[u32; 2]>,
    /// Positions of the vertices at both ends of the step.
    ends: [Vec<[f64; 3]>; 2],
    /// Known answer of each pair that may meet, ascending; all others are apart.
    truths: Vec<(Key, Truth)>,
    /// Triangle pairs that meet, ascending.
    pairs: Vec<[u32; 2]>,
}

/// Tolerance of the reference, in mean edges.
const FINEST: f64 = 1e-9;
/// Most undecided pairs of the reference that the oracle decides: some seconds of work.
const FEW: usize = 20_000;

impl Scene {
    /// Finds the true contacts. A discrete scene uses exact signs. A moving one uses the certified
    /// solver in f64 at 1e-9 of the mean edge. It proves an interval of each first time. The oracle
    /// decides the undecided pairs, if there is no list and there are at most `FEW`.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a list of the other kind; device errors.
    pub fn new(device: &Device, name: &str, body: Body, list: Option<List>) -> Result<Scene, Error> {
        let edge = mean_side(std::slice::from_ref(&body));
        let mut scene = Scene {
            name: format!("{name}, {} triangles", body.face_count()),
            edge,
            reference: if list.is_some() { "list" } else { "certified" },
            edges: Vec::new(),
            ends: body.ends().map(Positions::to_f64),
            truths: Vec::new(),
            pairs: Vec::new(),
            body,
        };
        if !scene.body.is_moving() {
            scene.pairs = match list {
                Some(List::Triangles(pairs)) => pairs,
                Some(List::Contacts(_)) => return Err(other_kind("one frame", "tri_a,tri_b")),
                None => scene.answer(device, Query::discrete())?.triangles(),
            };
            return Ok(scene);
        }
        scene.edges = Topology::of(&scene.body).edges;
        let finest = Certified { tolerance: Some(FINEST * edge), ..Certified::by(CertifiedPrecision::F64) };
        let found = scene.answer(device, Continuous::by(finest).into())?;
        let bounds = |c: &Contact| Truth::Meet { not_before: c.toi, by: c.toi_upper };
        let of = |c: &Contact| (c.kind, c.feature_a, c.feature_b);
        scene.truths = match list {
            None => {
                let undecided = found.contacts().iter().filter(|c| c.status == Status::Undecided).count();
                let known = |c: &Contact| match c.status {
                    Status::Undecided if undecided > FEW => Truth::Unknown,
                    Status::Undecided => truth(&scene.case(of(c))),
                    _ => bounds(c),
                };
                found.contacts().par_iter().map(|c| (of(c), known(c))).collect()
            }
            Some(List::Triangles(_)) => return Err(other_kind("two frames", "kind,a,b")),
            Some(List::Contacts(keys)) => {
                let known = found.contacts();
                let truth = |key: &Key| match known.binary_search_by_key(key, of) {
                    Ok(at) => bounds(&known[at]),
                    // The reference misses it: the list only says that it meets.
                    Err(_) => Truth::Meet { not_before: 0.0, by: 1.0 },
                };
                keys.iter().map(|key| (*key, truth(key))).collect()
            }
        };
        Ok(scene)
    }

    fn answer(&self, device: &Device, query: Query) -> Result<Contacts, Error> {
        OneQuery::new(device.clone(), vec![self.body.clone()], query)?.detect()
    }

    /// Runs one choice on the scene, `repeats` times after a warm-up; returns its row.
    ///
    /// # Errors
    /// Device errors.
    pub fn row(
        &self,
        device: &Device,
        choice: Choice,
        volume: Option<BoundingVolume>,
        repeats: u32,
    ) -> Result<Row, Error> {
        let query = choice.query(self.edge);
        let query = query.with_search(Search { volume, ..query.search() });
        let tolerance = query.certified().and_then(|certified| certified.tolerance);
        let held = device.bytes().0;
        let mut detector = OneQuery::new(device.clone(), vec![self.body.clone()], query)?;
        let mut contacts = detector.detect()?;
        let mut times = Vec::new();
        for _ in 0..repeats.max(1) {
            contacts = detector.detect()?;
            times.push((contacts.stats.stages.total, contacts.stats.stages.narrow));
        }
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (total, narrow) = times[times.len() / 2];
        let judged = if query.kind() == QueryKind::Discrete {
            self.judge_pairs(&contacts.triangles())
        } else {
            let found = contacts.contacts();
            let exhausted = self.exhausted(device, &query, found)?;
            self.judge(query.solver(), tolerance.unwrap_or(0.0), found, &exhausted)
        };
        let row = Row {
            input: self.name.clone(),
            reference: self.reference,
            tolerance_edges: choice.tolerance,
            tolerance,
            precision: if self.body.positions_t0().is_f64() { "f64" } else { "f32" },
            bv: Some(query.volume().name()),
            escalated: contacts.stats.escalated_vf_ee.iter().sum(),
            ns: Some(narrow * 1e6 / contacts.stats.candidates.max(1) as f64),
            ms: Some(total),
            bytes: device.bytes().0 - held,
            ..Row::default()
        };
        Ok(Row { cases: contacts.stats.candidates, ..row.judged(query.solver(), &judged) })
    }

    /// Returns the features of a pair.
    fn case(&self, (kind, a, b): Key) -> Case {
        let (features, corners) = match kind {
            Kind::Ee => {
                let (p, q) = (self.edges[a as usize], self.edges[b as usize]);
                (Features::EdgeEdge, [p[0], p[1], q[0], q[1]])
            }
            Kind::Vf => {
                let [p, q, r] = self.body.faces()[b as usize];
                (Features::VertexFace, [a, p, q, r])
            }
            Kind::Ev => {
                let [p, q] = self.edges[a as usize];
                (Features::VertexFace, [b, p, q, q])
            }
            Kind::Vv => (Features::VertexFace, [a, b, b, b]),
        };
        Case {
            features,
            positions_t0: corners.map(|v| self.ends[0][v as usize]),
            positions_t1: corners.map(|v| self.ends[1][v as usize]),
        }
    }

    /// Returns the undecided contacts whose iterations ran out. A frame does not report that, so
    /// each is tested alone.
    fn exhausted(&self, device: &Device, query: &Query, found: &[Contact]) -> Result<Vec<Key>, Error> {
        let undecided = found.iter().filter(|c| c.status == Status::Undecided);
        let keys: Vec<Key> = undecided.map(|c| (c.kind, c.feature_a, c.feature_b)).collect();
        let cases: Vec<Case> = keys.iter().map(|key| self.case(*key)).collect();
        let answers = ask(device, &cases, query, Options::default())?;
        let ended = answers.verdicts.iter().map(|met| met.is_some_and(|met| met.exhausted));
        Ok(keys.into_iter().zip(ended).filter(|(_, ended)| *ended).map(|(key, _)| key).collect())
    }

    /// Judges contacts, ascending, by the known answers, ascending; `exhausted` has those whose
    /// iterations ran out.
    fn judge(&self, solver: Solver, tolerance: f64, found: &[Contact], exhausted: &[Key]) -> Judged {
        let mut judge = Judge::new(solver, tolerance, self.edge);
        let mut known = self.truths.iter().peekable();
        for contact in found {
            let key = (contact.kind, contact.feature_a, contact.feature_b);
            while let Some((missed, truth)) = known.next_if(|(k, _)| *k < key) {
                judge.note(&self.case(*missed), *truth, None);
            }
            let truth = known.next_if(|(k, _)| *k == key).map_or(Truth::Apart, |(_, truth)| *truth);
            let Contact { status, toi, toi_upper, .. } = *contact;
            let exhausted = exhausted.binary_search(&key).is_ok();
            let met = Outcome { status, toi, toi_upper, exhausted, boxes: 0 };
            judge.note(&self.case(key), truth, Some(met));
        }
        for (missed, truth) in known {
            judge.note(&self.case(*missed), *truth, None);
        }
        judge.judged()
    }

    /// Judges triangle pairs, ascending.
    fn judge_pairs(&self, found: &[[u32; 2]]) -> Judged {
        let without = |all: &[[u32; 2]], known: &[[u32; 2]]| {
            all.iter().filter(|pair| known.binary_search(pair).is_err()).count() as u64
        };
        let counts = Counts {
            contacts: self.pairs.len() as u64,
            missed: without(&self.pairs, found),
            false_alarms: without(found, &self.pairs),
            ..Counts::default()
        };
        Judged { counts, ..Judged::default() }
    }
}

fn other_kind(frames: &str, rows: &str) -> Error {
    Error::InvalidArgument {
        what: format!("the list of --truth has the wrong kind for a scene of {frames}"),
        advice: format!("give --truth a list of {rows}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::soup;
    use nearmiss::device::emulator::{Emulator, Mode};

    /// Contacts that are removed, delayed and invented are counted, in the order of the lists.
    #[test]
    fn planted_faults_are_counted() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let body = soup(120, 4, true).expect("a scene");
        let scene = Scene::new(&device, "soup", body, None).expect("known");
        let choice = Choice { asked: Query::continuous(), tolerance: Some(1e-6) };
        let found = scene.answer(&device, choice.query(scene.edge)).expect("an answer");
        let tolerance = 1e-6 * scene.edge;
        let of = |found: &[Contact]| scene.judge(Solver::Certified, tolerance, found, &[]).counts;
        let right = of(found.contacts());
        assert!(right.contacts > 10 && right.missed + right.late + right.violations == 0, "{right:?}");
        let mut without = found.contacts().to_vec();
        without.remove(0);
        without.pop();
        assert_eq!(of(&without).missed, 2);
        let mut late = found.contacts().to_vec();
        late[3].toi = (late[3].toi_upper + 1.0) / 2.0;
        late[3].toi_upper = 1.0;
        assert_eq!(of(&late).late, 1);
        let mut invented = found.contacts().to_vec();
        let Some(free) = (0..120).find(|&f| {
            invented.binary_search_by_key(&(Kind::Vf, 0, f), |c| (c.kind, c.feature_a, c.feature_b)).is_err()
                && f > 60
        }) else {
            panic!("vertex 0 meets every face");
        };
        invented.push(Contact {
            bodies: Default::default(),
            kind: Kind::Vf,
            feature_a: 0,
            feature_b: free,
            toi: 0.0,
            toi_upper: 0.0,
            status: Status::Certified,
        });
        invented.sort_by_key(|c| (c.kind, c.feature_a, c.feature_b));
        let of_invented = of(&invented);
        assert_eq!(
            (of_invented.false_alarms, of_invented.false_certificates, of_invented.violations),
            (1, 1, 1)
        );
    }
}
