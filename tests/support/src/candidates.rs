//! Pairs of features of the public meshes whose boxes overlap, found without a kernel, and their
//! known contacts.
#![allow(clippy::unwrap_used, reason = "public data are as they were published")]

use crate::{cases, data};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use std::collections::HashSet;
use std::io::Read;
use std::path::PathBuf;

/// Rows of a gzip CSV, with its header.
pub fn table(path: PathBuf) -> Vec<csv::StringRecord> {
    let file = flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap());
    csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(file)
        .records()
        .map(Result::unwrap)
        .collect()
}

/// A mesh of the public data, read without our readers.
pub struct Mesh {
    pub x: Vec<Vec3<f32>>,
    pub faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads binary PLY of `float x y z` and `list uchar int`, the format of the data.
    pub fn read(path: PathBuf) -> Mesh {
        let mut all = Vec::new();
        std::fs::File::open(path).unwrap().read_to_end(&mut all).unwrap();
        let end = all.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let head = String::from_utf8_lossy(&all[..end]).into_owned();
        let count = |what: &str| -> usize {
            head.split(what).nth(1).unwrap().split_whitespace().next().unwrap().parse().unwrap()
        };
        let big = head.contains("big_endian");
        let mut at = end;
        let mut word = || {
            let b: [u8; 4] = all[at..at + 4].try_into().unwrap();
            at += 4;
            if big { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) }
        };
        let x = (0..count("element vertex"))
            .map(|_| Vec3(std::array::from_fn(|_| f32::from_bits(word()))))
            .collect();
        let body = &all[at..];
        let corner = |b: &[u8]| {
            if big {
                u32::from_be_bytes(b.try_into().unwrap())
            } else {
                u32::from_le_bytes(b.try_into().unwrap())
            }
        };
        let faces = body.chunks_exact(13).take(count("element face"));
        let faces = faces.map(|f| std::array::from_fn(|k| corner(&f[1 + 4 * k..5 + 4 * k]))).collect();
        Mesh { x, faces }
    }
    pub fn triangle(&self, f: usize) -> [Vec3<f32>; 3] {
        self.faces[f].map(|k| self.x[k as usize])
    }
}

/// A box: its lowest and highest corner.
pub type Bounds = (Vec3<f32>, Vec3<f32>);

pub fn bounds(points: &[Vec3<f32>]) -> Bounds {
    points.iter().fold((points[0], points[0]), |(l, h), p| (l.min(*p), h.max(*p)))
}

/// Strips of space in which [`overlaps`] searches.
const STRIPS: usize = 64;

/// Visits all pairs of boxes that overlap: in strips across y, by sorting along x. A pair belongs to
/// the strip in which the overlap begins.
pub fn overlaps(a: &[Bounds], b: &[Bounds], mut visit: impl FnMut(usize, usize)) {
    let all = || a.iter().chain(b);
    let low = all().map(|x| x.0[1]).fold(f32::INFINITY, f32::min);
    let high = all().map(|x| x.1[1]).fold(f32::NEG_INFINITY, f32::max);
    let strip = |y: f32| (((y - low) / (high - low) * STRIPS as f32) as usize).min(STRIPS - 1);
    let mut strips: Vec<Vec<(f32, bool, usize)>> = vec![Vec::new(); STRIPS];
    for (second, boxes) in [(false, a), (true, b)] {
        for (i, x) in boxes.iter().enumerate() {
            let own = strip(x.0[1])..=strip(x.1[1]);
            strips[own].iter_mut().for_each(|strip| strip.push((x.0[0], second, i)));
        }
    }
    for (at, mut here) in strips.into_iter().enumerate() {
        here.sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut open: [Vec<usize>; 2] = Default::default();
        for (low, second, i) in here {
            let (own, others) = if second { (&b[i], a) } else { (&a[i], b) };
            let list = &mut open[usize::from(!second)];
            list.retain(|&j| others[j].1[0] >= low);
            for &j in list.iter() {
                let meets = (1..3).all(|k| own.0[k] <= others[j].1[k] && others[j].0[k] <= own.1[k]);
                if meets && strip(own.0[1].max(others[j].0[1])) == at {
                    if second { visit(j, i) } else { visit(i, j) }
                }
            }
            open[usize::from(second)].push(i);
        }
    }
}

/// Edges in the order of the data: by larger, then smaller vertex.
pub fn edges(m: &Mesh) -> Vec<[u32; 2]> {
    let all =
        m.faces.iter().flat_map(|f| (0..3).map(|k| (f[k].max(f[(k + 1) % 3]), f[k].min(f[(k + 1) % 3]))));
    let mut e: Vec<_> = all.collect::<HashSet<_>>().into_iter().collect();
    e.sort();
    e.into_iter().map(|(big, small)| [small, big]).collect()
}

/// A vertex and a face (true), or two edges, by index.
pub type Key = (bool, usize, usize);

/// A pair and its four points in motion.
pub type Candidate = (Key, [Moving<f32>; 4]);

/// The true contacts of a table.
pub fn truths(path: PathBuf) -> HashSet<Key> {
    let rows = table(path);
    rows.iter().skip(1).map(|r| (&r[0] == "vf", r[1].parse().unwrap(), r[2].parse().unwrap())).collect()
}

/// Visits all pairs without a common vertex whose swept boxes overlap: vertex/face (true), then
/// edge/edge; both indices and the four points.
pub fn candidates_of(m: &Mesh, n: &Mesh, mut visit: impl FnMut(bool, usize, usize, [Moving<f32>; 4])) {
    let at = |k: u32| Moving { t0: m.x[k as usize], t1: n.x[k as usize] };
    let swept = |v: &[u32]| bounds(&v.iter().flat_map(|k| [at(*k).t0, at(*k).t1]).collect::<Vec<_>>());
    let vertices: Vec<_> = (0..m.x.len() as u32).map(|v| swept(&[v])).collect();
    let faces: Vec<_> = m.faces.iter().map(|f| swept(f)).collect();
    overlaps(&vertices, &faces, |v, f| {
        if !m.faces[f].contains(&(v as u32)) {
            let [a, b, c] = m.faces[f].map(at);
            visit(true, v, f, [at(v as u32), a, b, c]);
        }
    });
    let e = edges(m);
    let boxes: Vec<_> = e.iter().map(|x| swept(x)).collect();
    overlaps(&boxes, &boxes, |i, j| {
        if i < j && !e[i].iter().any(|v| e[j].contains(v)) {
            let ([a, b], [c, d]) = (e[i].map(at), e[j].map(at));
            visit(false, i, j, [a, b, c, d]);
        }
    });
}

/// Whether a candidate is one of those that are tested: all true contacts, and every eighth of the
/// others; in nightly runs all.
pub fn is_tested(key: &Key, truth: &HashSet<Key>) -> bool {
    (key.1 + key.2).is_multiple_of(cases(8, 1)) || truth.contains(key)
}

/// A scene's candidates that [`is_tested`] names, its true contacts and its mean edge.
pub fn scene(scene: &str, before: &str, after: &str) -> (Vec<Candidate>, HashSet<Key>, f64) {
    let frame = |name| Mesh::read(data(&format!("{scene}/{name}.ply")));
    let (m, n) = (frame(before), frame(after));
    let truth = truths(data(&format!("{scene}/true_contacts.csv.gz")));
    let mut all = Vec::new();
    candidates_of(&m, &n, |face, a, b, points| {
        if is_tested(&(face, a, b), &truth) {
            all.push(((face, a, b), points));
        }
    });
    let e = edges(&m);
    let length = |e: &[u32; 2]| {
        let d = m.x[e[0] as usize].wide() - m.x[e[1] as usize].wide();
        d.dot(d).sqrt()
    };
    let mean = e.iter().map(length).sum::<f64>() / e.len() as f64;
    (all, truth, mean)
}
