//! Cases as a soup of vertices, faces and edges.

use super::Stored;
use crate::case::{Case, Features};
use nearmiss::device::{Buffer, Device};
use nearmiss::error::Error;
use nearmiss::mesh::{MAX_ABS_F32, MAX_ABS_F64, Problem};
use nearmiss::research::pipeline::precision::Precision;
use nearmiss::research::pipeline::{FeatureTopology, Layout};
use nearmiss_kernels::abi::{Pair, VertexMotion};
use nearmiss_kernels::math::Vec3;
use std::sync::Arc;

/// Number of cases of one batch: half a gigabyte of device memory, and far below 32 bits.
pub const AT_ONCE: usize = 1 << 20;

/// Returns the mean length of the features' edges at t = 0, over all cases: three of a face, one of
/// an edge. It is 0 if there are none.
pub fn mean_edge(cases: &[Case]) -> f64 {
    let (mut sum, mut count) = (0.0, 0u64);
    for case in cases {
        let edges: &[[usize; 2]] = match case.features {
            Features::VertexFace => &[[1, 2], [2, 3], [3, 1]],
            Features::EdgeEdge => &[[0, 1], [2, 3]],
        };
        for &[a, b] in edges {
            let [p, q] = [a, b].map(|i| case.positions_t0[i]);
            // Scaled by the largest, so that squares neither underflow nor overflow.
            let d = [0, 1, 2].map(|k| (p[k] - q[k]).abs());
            let most = d[0].max(d[1]).max(d[2]);
            if most > 0.0 {
                let [x, y, z] = d.map(|d| d / most);
                sum += most * (x * x + y * y + z * z).sqrt();
            }
            count += 1;
        }
    }
    sum / count.max(1) as f64
}

/// Refuses coordinates that a mesh would refuse, and those that f32 does not hold if they are
/// stored in f32.
pub fn check(cases: &[Case], stored: Stored) -> Result<(), Error> {
    let most = if stored == Stored::F32 { f64::from(MAX_ABS_F32) } else { MAX_ABS_F64 };
    for (at, case) in cases.iter().enumerate() {
        let points = case.positions_t0.iter().chain(&case.positions_t1).enumerate();
        for (vertex, axis, value) in
            points.flat_map(|(v, p)| [0, 1, 2].map(|k| (v, ['x', 'y', 'z'][k], p[k])))
        {
            let input = |problem| Err(Error::Input { file: format!("case {at}"), problem });
            if !value.is_finite() {
                return input(Problem::NonFinite { vertex, axis, value });
            }
            if value.abs() > MAX_ABS_F64 {
                return input(Problem::TooLarge { vertex, axis, value, limit: "2^480" });
            }
            if stored == Stored::F32 && (value.abs() > most || f64::from(value as f32) != value) {
                return Err(Error::InvalidArgument {
                    what: format!("case {at} has a coordinate {value:e} that f32 does not hold"),
                    advice: "store it in f64".into(),
                });
            }
        }
    }
    Ok(())
}

/// Returns the pairs of the cases, vertex/face and edge/edge, each in the cases' order; and the
/// faces and edges for them.
pub fn topology(cases: &[Case]) -> (Layout, [Vec<Pair>; 2]) {
    let (mut faces, mut edges) = (Vec::<[u32; 3]>::new(), Vec::<[u32; 2]>::new());
    let [mut vf, mut ee] = [Vec::new(), Vec::new()];
    for (case, first) in cases.iter().zip((0u32..).step_by(4)) {
        match case.features {
            Features::VertexFace => {
                vf.push(Pair { a: first, b: faces.len() as u32 });
                faces.push([first + 1, first + 2, first + 3]);
            }
            Features::EdgeEdge => {
                let edge = edges.len() as u32;
                ee.push(Pair { a: edge, b: edge + 1 });
                edges.extend([[first, first + 1], [first + 2, first + 3]]);
            }
        }
    }
    let features = Arc::new(FeatureTopology { edges, ..FeatureTopology::default() });
    (Layout { faces: Arc::new(faces), features, ..Layout::default() }, [vf, ee])
}

/// Uploads the vertices of the cases, in motion.
pub fn vertices<R: Precision>(device: &Device, cases: &[Case]) -> Result<Buffer<VertexMotion<R>>, Error> {
    let at = |p: [f64; 3]| Vec3(p.map(R::of)).into();
    let moving = |case: &Case| [0, 1, 2, 3].map(|i| (case.positions_t0[i], case.positions_t1[i]));
    let all: Vec<VertexMotion<R>> =
        cases.iter().flat_map(moving).map(|(t0, t1)| VertexMotion { t0: at(t0), t1: at(t1) }).collect();
    device.upload(&all)
}
