//! Public data, found through NEARMISS_DATA: exact pairs of triangles, true contacts of moving meshes, queries.

use nearmiss_kernels::math::Real;
use nearmiss_kernels::prim::adjacent::Shared;
use nearmiss_kernels::prim::cubic::{ee_toi, vf_toi};
use nearmiss_kernels::prim::tri_tri::{Filter, Wide, meets, meets_exactly};
use std::collections::{HashMap, HashSet};
use support::candidates::{Mesh, bounds, candidates_of, is_tested, overlaps, table, truths};
use support::data;

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
            "{name}: {candidates} candidates, {} meet; uncertain by f32 {unsure}, by f64 {wide}",
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
        if !is_tested(&(face, a, b), &truth) {
            return;
        }
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
