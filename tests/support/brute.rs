//! Pairs of features asked one by one, and what is wrong with a frame's answer beside theirs.

use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::{Body, Topology};
use nearmiss::query::Solver;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{
    Params, Verdict, ee_certified, ee_settled, vf_certified, vf_settled,
};
use std::collections::BTreeMap;

/// The certified solvers.
pub const SOLVERS: [Solver; 3] = [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64];

/// A pair as it is listed.
pub type Row = (Kind, u32, u32);

/// A body as the brute force sees it. Its vertices are doubles: exact, and what the cubic in f64 works with.
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
    pub fn at<const N: usize>(&self, of: [u32; N]) -> [Moving<f64>; N] {
        of.map(|v| self.vertices[v as usize])
    }
}

/// What the solver says of a pair by itself.
pub fn verdict(solver: Solver, kind: Kind, [a, b, c, d]: [Moving<f64>; 4], p: &Params) -> Verdict {
    let edges = kind == Kind::Ee;
    let (first, settled) =
        if edges { ee_settled::<_, f32>([a, b], [c, d], p) } else { vf_settled::<_, f32>(a, [b, c, d], p) };
    if solver == Solver::CertifiedF32 || solver == Solver::Certified && settled {
        first
    } else if edges {
        ee_certified::<_, f64>([a, b], [c, d], p)
    } else {
        vf_certified::<_, f64>(a, [b, c, d], p)
    }
}

/// What is wrong with an answer. Pairs that are only near may be left out, where volumes or signs tell them apart.
pub fn fault(found: &[Contact], near: &BTreeMap<Row, Verdict>, meet: &[Row]) -> Option<String> {
    let mut listed = BTreeMap::new();
    for c in found {
        let row = (c.kind, c.a, c.b);
        let Some(v) = near.get(&row) else { return Some(format!("{c:?} is apart")) };
        let status = if v.is_contact() { Status::Certified } else { Status::Unresolved };
        let same = [c.toi, c.toi_hi].map(f64::to_bits) == [v.toi, v.toi_hi].map(f64::to_bits);
        if !same || c.status != status || listed.insert(row, ()).is_some() {
            return Some(format!("{c:?} is {v:?}"));
        }
    }
    let sure = near.iter().filter(|(_, v)| v.is_contact()).map(|(row, _)| row);
    sure.chain(meet).find(|row| !listed.contains_key(row)).map(|row| format!("{row:?} is missed"))
}
