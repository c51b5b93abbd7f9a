//! Public data, found through NEARMISS_DATA: exact pairs of triangles, true contacts of moving meshes, queries.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::adjacent::Shared;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::tri_tri::{Filter, Wide, meets, meets_exactly};
use std::collections::{HashMap, HashSet};
use std::io::Read;
use std::path::PathBuf;
use support::data;

fn table(path: PathBuf) -> Vec<csv::StringRecord> {
    let file = flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap());
    csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(file)
        .records()
        .map(Result::unwrap)
        .collect()
}

struct Mesh {
    x: Vec<Vec3<f32>>,
    faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// Binary PLY of `float x y z` and `list uchar int`, which is what the data are.
    fn read(path: PathBuf) -> Mesh {
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
    fn triangle(&self, f: usize) -> [Vec3<f32>; 3] {
        self.faces[f].map(|k| self.x[k as usize])
    }
}

type Bounds = (Vec3<f32>, Vec3<f32>);

fn bounds(points: &[Vec3<f32>]) -> Bounds {
    points.iter().fold((points[0], points[0]), |(l, h), p| (l.min(*p), h.max(*p)))
}

/// All pairs of boxes that meet, by sorting along x.
fn overlaps(a: &[Bounds], b: &[Bounds], mut visit: impl FnMut(usize, usize)) {
    let mut all: Vec<(f32, bool, usize)> = Vec::new();
    all.extend(a.iter().enumerate().map(|(i, x)| (x.0[0], false, i)));
    all.extend(b.iter().enumerate().map(|(i, x)| (x.0[0], true, i)));
    all.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut open: [Vec<usize>; 2] = Default::default();
    for (low, second, i) in all {
        let (own, others) = if second { (&b[i], a) } else { (&a[i], b) };
        let list = &mut open[!second as usize];
        list.retain(|&j| others[j].1[0] >= low);
        for &j in list.iter() {
            if (1..3).all(|k| own.0[k] <= others[j].1[k] && others[j].0[k] <= own.1[k]) {
                if second { visit(j, i) } else { visit(i, j) }
            }
        }
        open[second as usize].push(i);
    }
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn exact_pairs() {
    for (name, other) in [
        ("bunny_with_bunny_b", true),
        ("bunny", false),
        ("degenerate", false),
        ("coplanar_same", false),
        ("coplanar_z0_shift", false),
        ("height-field", false),
        ("cloth_ball92", false),
        ("noisy", false),
    ] {
        let pairs = data(&format!("exact/{name}.pairs.csv.gz"));
        let first = match name {
            "cloth_ball92" => "cloth-ball/cloth_ball92.ply".into(),
            _ if other => "exact/bunny.ply".into(),
            _ => format!("exact/{name}.ply"),
        };
        let a = Mesh::read(data(&first));
        let b = other.then(|| Mesh::read(data("exact/bunny_b.ply")));
        let truth: HashSet<(usize, usize)> =
            table(pairs).iter().skip(1).map(|r| (r[0].parse().unwrap(), r[1].parse().unwrap())).collect();
        let boxes = |m: &Mesh| (0..m.faces.len()).map(|f| bounds(&m.triangle(f))).collect::<Vec<_>>();
        let (mut found, mut candidates, mut unsure, mut wide) = (HashSet::new(), 0, 0, 0);
        let second = b.as_ref().unwrap_or(&a);
        overlaps(&boxes(&a), &boxes(second), |i, j| {
            if !other && (i >= j || Shared::by_index(a.faces[i], a.faces[j]) != Shared::Nothing) {
                return;
            }
            candidates += 1;
            let (p, q) = (a.triangle(i), second.triangle(j));
            unsure += meets::<f32, Filter>(&p, &q).is_none() as u32;
            wide += meets::<f32, Wide>(&p, &q).is_none() as u32;
            if meets_exactly(&p, &q) {
                found.insert((i, j));
            }
        });
        println!(
            "{name}: {candidates} candidates, {} meet; undecided by f32 {unsure}, by f64 {wide}",
            found.len()
        );
        assert!(
            found == truth,
            "{name}: {} missed, {} too many",
            truth.difference(&found).count(),
            found.difference(&truth).count()
        );
    }
}

/// Edges in the order of the data: by larger, then smaller vertex.
fn edges(m: &Mesh) -> Vec<[u32; 2]> {
    let all =
        m.faces.iter().flat_map(|f| (0..3).map(|k| (f[k].max(f[(k + 1) % 3]), f[k].min(f[(k + 1) % 3]))));
    let mut e: Vec<_> = all.collect::<HashSet<_>>().into_iter().collect();
    e.sort();
    e.into_iter().map(|(big, small)| [small, big]).collect()
}

/// A vertex and a face (true), or two edges, by index.
pub type Key = (bool, usize, usize);

/// The true contacts of a table.
fn truths(path: PathBuf) -> HashSet<Key> {
    let rows = table(path);
    rows.iter().skip(1).map(|r| (&r[0] == "vf", r[1].parse().unwrap(), r[2].parse().unwrap())).collect()
}

/// Visits all pairs without a common vertex whose swept boxes meet: vertex/face (true), then edge/edge; both indices
/// and the four points.
fn candidates_of(m: &Mesh, n: &Mesh, mut visit: impl FnMut(bool, usize, usize, [Moving<f32>; 4])) {
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

/// A scene's candidates, its true contacts and its mean edge.
pub fn scene(scene: &str, before: &str, after: &str) -> (Vec<(Key, [Moving<f32>; 4])>, HashSet<Key>, f64) {
    let frame = |name| Mesh::read(data(&format!("{scene}/{name}.ply")));
    let (m, n) = (frame(before), frame(after));
    let truth = truths(data(&format!("{scene}/true_contacts.csv.gz")));
    let mut all = Vec::new();
    candidates_of(&m, &n, |face, a, b, points| all.push(((face, a, b), points)));
    let e = edges(&m);
    let length = |e: &[u32; 2]| {
        let d = m.x[e[0] as usize].wide() - m.x[e[1] as usize].wide();
        d.dot(d).sqrt()
    };
    let mean = e.iter().map(length).sum::<f64>() / e.len() as f64;
    (all, truth, mean)
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn true_contacts_of_cloth() {
    true_contacts("cloth-ball", "cloth_ball92", "cloth_ball93");
}

/// 31 million candidates: by hand.
#[test]
#[ignore = "half a minute"]
fn true_contacts_of_balls() {
    true_contacts("n-body", "n-body_t0", "n-body_t1");
}

/// The double cubic finds the true contacts of a real scene, no more and no less; the single one is counted.
fn true_contacts(scene: &str, before: &str, after: &str) {
    let frame = |name| Mesh::read(data(&format!("{scene}/{name}.ply")));
    let (m, n) = (frame(before), frame(after));
    let truth = truths(data(&format!("{scene}/true_contacts.csv.gz")));
    let mut found: [HashSet<(bool, usize, usize)>; 2] = Default::default();
    let mut times: HashMap<(bool, usize, usize), (f64, f32)> = HashMap::new();
    let mut candidates = [0; 2];
    let mut note = |key, a: Option<f64>, b: Option<f32>| {
        candidates[key_kind(&key)] += 1;
        if a.is_some() {
            found[0].insert(key);
        }
        if b.is_some() {
            found[1].insert(key);
        }
        if let (Some(a), Some(b)) = (a, b) {
            times.insert(key, (a, b));
        }
    };
    candidates_of(&m, &n, |face, a, b, [p, q, r, s]| {
        if face {
            let t = [q, r, s];
            note((true, a, b), vf_toi::<f32, f64>(p, t), vf_toi::<f32, f32>(p, t));
        } else {
            let (x, y) = ([p, q], [r, s]);
            note((false, a, b), ee_toi::<f32, f64>(x, y), ee_toi::<f32, f32>(x, y));
        }
    });
    let late = times.values().filter(|(a, b)| b.wide() > a + 1e-4).count();
    println!("candidates edge/edge, vertex/face: {candidates:?}; f32 late by over 1e-4: {late}");
    for (name, set) in ["f64", "f32"].iter().zip(&found) {
        let (missed, extra) = (truth.difference(set).count(), set.difference(&truth).count());
        println!("{name} cubic: {} contacts, {missed} missed, {extra} false", set.len());
    }
    for key in truth.difference(&found[0]).chain(found[0].difference(&truth)).take(5) {
        println!("f64 differs on {key:?}");
    }
    assert!(found[0] == truth, "the double cubic must get real cloth right");
    assert!(truth.difference(&found[1]).count() < 200);
}

fn key_kind(key: &(bool, usize, usize)) -> usize {
    key.0 as usize
}
