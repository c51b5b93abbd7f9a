//! Brute force: all pairs of features, tested one by one, and the judge of a frame's answer by
//! them.

use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::{Body, Topology};
use nearmiss::research::Solver;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::{Rungs, ee_certified, vf_certified};
use std::collections::BTreeMap;

/// The certified solvers.
pub const SOLVERS: [Solver; 3] = [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64];

/// A pair as in a list: its kind, the bodies of both features, and the features.
pub type Row = (Kind, [usize; 2], [u32; 2]);

/// The row of a contact.
pub fn row(c: &Contact) -> Row {
    (c.kind, c.bodies.map(|body| body.index()), [c.feature_a, c.feature_b])
}

/// A body for the brute force. Its vertices are doubles: exact, and the input of the cubic in f64.
pub struct Seen {
    pub vertices: Vec<Moving<f64>>,
    pub used: Vec<u32>,
    pub faces: Vec<[u32; 3]>,
    pub edges: Vec<[u32; 2]>,
}

impl Seen {
    pub fn of(body: &Body) -> Seen {
        let t0 = body.positions_t0().to_f64();
        let t1 = body.positions_t1().map_or_else(|| t0.clone(), |t1| t1.to_f64());
        let mut used: Vec<u32> = body.faces().iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        Seen {
            vertices: t0.iter().zip(t1).map(|(p, q)| Moving { t0: Vec3(*p), t1: Vec3(q) }).collect(),
            used,
            faces: body.faces().to_vec(),
            edges: Topology::new(body.faces(), body.vertex_count()).edges,
        }
    }
    pub fn at<const N: usize>(&self, vertices: [u32; N]) -> [Moving<f64>; N] {
        vertices.map(|v| self.vertices[v as usize])
    }
}

/// The rungs of a certified solver.
pub fn rungs(solver: Solver) -> Rungs {
    match solver {
        Solver::CertifiedF32 => Rungs::Single,
        Solver::CertifiedF64 => Rungs::Double,
        _ => Rungs::All,
    }
}

/// The solver's verdict on one pair.
pub fn verdict(solver: Solver, kind: Kind, [a, b, c, d]: [Moving<f64>; 4], p: &Params) -> Verdict {
    if kind == Kind::Ee {
        ee_certified([a, b], [c, d], rungs(solver), p)
    } else {
        vf_certified(a, [b, c, d], rungs(solver), p)
    }
}

/// The fault of an answer, if it has one. An answer lists every pair that is not certainly apart,
/// with its verdict, and no other.
pub fn fault(found: &[Contact], near: &BTreeMap<Row, Verdict>, meet: &[Row]) -> Option<String> {
    let mut listed = BTreeMap::new();
    for c in found {
        let row = row(c);
        let Some(v) = near.get(&row) else { return Some(format!("{c:?} is apart")) };
        let status = if v.is_contact() { Status::Certified } else { Status::Undecided };
        let same = [c.toi, c.toi_upper].map(f64::to_bits) == [v.toi, v.toi_upper].map(f64::to_bits);
        if !same || c.status != status || listed.insert(row, ()).is_some() {
            return Some(format!("{c:?} is {v:?}"));
        }
    }
    near.keys().chain(meet).find(|row| !listed.contains_key(row)).map(|row| format!("{row:?} is missed"))
}
