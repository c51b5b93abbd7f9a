//! Crowds: one triangle against a million, equal triangles, equal times, and more pairs than 32
//! bits count.

use super::report::Report;
use crate::OneQuery;
use crate::scene;
use nearmiss::contacts::Status;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::{Continuous, Earliest, Query};
use nearmiss::research::{BroadPhase, Certified, QueryExt, WithSolver};
use nearmiss::scene::CollisionFilter;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::tri_tri::meets_exactly;

/// Sizes of the crowds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crowds {
    /// Number of triangles against one.
    pub against_one: usize,
    /// Number of equal triangles: all pairs meet.
    pub equal: usize,
    /// Number of contacts at one time.
    pub ties: usize,
    /// Whether to run 92,683 equal triangles with 4,295,022,903 pairs, which no list of 32 bits
    /// holds. For a GPU: a CPU needs minutes.
    pub beyond_32_bits: bool,
}

impl Crowds {
    /// The sizes of the catalogue.
    pub const FULL: Crowds =
        Crowds { against_one: 1_000_000, equal: 5_000, ties: 100_000, beyond_32_bits: true };
    /// Sizes for a CPU: it runs for seconds.
    pub const SMALL: Crowds =
        Crowds { against_one: 1_000_000, equal: 1_500, ties: 50_000, beyond_32_bits: false };
}

/// Runs all crowds.
///
/// # Errors
/// Device errors.
pub fn ask_crowds(device: &Device, crowds: Crowds) -> Result<Report, Error> {
    let mut report = Report::new("crowds");
    against_one(device, crowds.against_one, &mut report)?;
    equal(device, crowds.equal, &mut report)?;
    ties(device, crowds.ties, &mut report)?;
    if crowds.beyond_32_bits {
        beyond_32_bits(device, &mut report)?;
    }
    Ok(report)
}

/// One large triangle against a soup: the pairs equal those of testing each pair.
fn against_one(device: &Device, n: usize, report: &mut Report) -> Result<(), Error> {
    let soup = scene::soup(n, 42, false)?;
    let points = soup.positions_t0().to_f64();
    let corner = |v: u32| Vec3(points[v as usize].map(|x| x as f32));
    let far = points.iter().flatten().fold(0f64, |most, x| most.max(x.abs())) as f32;
    // A slanted triangle through the middle of the soup.
    let one = [[-far, -far, -far * 0.5], [far, -far * 0.75, far * 0.25], [far * 0.125, far, far * 0.5]];
    let truth: Vec<[u32; 2]> = (0u32..)
        .zip(soup.faces())
        .filter(|(_, face)| meets_exactly(&one.map(Vec3), &face.map(corner)))
        .map(|(i, _)| [0, i])
        .collect();
    let one = Body::deformable(Mesh::new("one", Positions::F32(one.to_vec()), vec![[0, 1, 2]])?);
    let found = OneQuery::new(
        device.clone(),
        vec![one, soup.with_filter(CollisionFilter::without_self_collision())],
        Query::discrete(),
    )?
    .detect()?;
    report.asked += 1;
    report.missed += truth.len().saturating_sub(found.len()) as u64;
    if found.pairs() != truth || truth.is_empty() {
        report.fail(|| format!("X42 one against {n}: got {} pairs, expected {}", found.len(), truth.len()));
    }
    Ok(())
}

/// All pairs of equal triangles, by tiles and by a shallow tree.
fn equal(device: &Device, n: usize, report: &mut Report) -> Result<(), Error> {
    let all = n * (n - 1) / 2;
    let levels = n.next_power_of_two().trailing_zeros() as usize + 1;
    for broad in [BroadPhase::Tree, BroadPhase::Tiles] {
        let query = Query::discrete().with_broad_phase(broad);
        let mut detector = OneQuery::new(device.clone(), vec![scene::identical(n)?], query)?;
        let found = detector.detect()?;
        detector.check_volumes()?;
        report.asked += 1;
        report.missed += (all - found.len().min(all)) as u64;
        let depths = detector.depths();
        if found.len() != all || (broad == BroadPhase::Tree && depths != [levels]) {
            report.fail(|| {
                format!("X43 {n} equal: got {} pairs, expected {all}; depth {depths:?}", found.len())
            });
        }
    }
    Ok(())
}

/// `n` tips that fall on `n` triangles at once: all times have the same bits, in every run.
fn ties(device: &Device, n: usize, report: &mut Report) -> Result<(), Error> {
    let side = (n as f64).sqrt().ceil() as usize;
    let at = |i: usize| [(i % side * 4) as f32, (i / side * 4) as f32];
    let (mut floor, mut tips) = (Vec::new(), Vec::new());
    for [x, y] in (0..n).map(at) {
        floor.extend([[x, y, 0.0], [x + 2.0, y, 0.0], [x, y + 2.0, 0.0]]);
        tips.extend([[x + 0.5, y + 0.5, 1.0], [x + 0.5, y + 0.75, 9.0], [x + 0.75, y + 0.5, 9.0]]);
    }
    let faces: Vec<[u32; 3]> = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = |points: &[[f32; 3]]| Mesh::new("ties", Positions::F32(points.to_vec()), faces.clone());
    let fallen: Vec<[f32; 3]> = tips.iter().map(|p| [p[0], p[1], p[2] - 2.0]).collect();
    let bodies = vec![Body::deformable(mesh(&floor)?), Body::moving(mesh(&tips)?, mesh(&fallen)?)?];
    let certified = Certified { tolerance: Some(1e-5), ..Certified::default() };
    let mut detector = OneQuery::new(device.clone(), bodies.clone(), Continuous::by(certified))?;
    let (found, again) = (detector.detect()?, detector.detect()?);
    let earliest = OneQuery::new(device.clone(), bodies, Earliest::by(certified))?.detect()?.earliest_toi();
    report.asked += 2;
    let first = found.contacts().first().map(|c| c.toi);
    let alike = |c: &nearmiss::Contact| Some(c.toi) == first && c.status == Status::Certified && c.toi <= 0.5;
    let right = found.len() == n && found.contacts().iter().all(alike) && earliest == first;
    report.missed += n.saturating_sub(found.len()) as u64;
    if !right || again.rows != found.rows {
        report.fail(|| format!("X37 {n} at once: {} contacts, first {first:?}, {earliest:?}", found.len()));
    }
    Ok(())
}

/// More pairs than a list of 32 bits can hold. Trees must return an error with the needed room,
/// exact to the byte. Tiles must return the answer, in slices, if most pairs do not meet and the
/// answer fits.
fn beyond_32_bits(device: &Device, report: &mut Report) -> Result<(), Error> {
    const N: usize = 92_683;
    // Also beyond an index of a machine of 32 bits.
    let (n, row) = (N as u64, size_of::<nearmiss_kernels::abi::Pair>() as u64);
    let needed = n * (n - 1) / 2 * row;
    let by_trees = Query::discrete().with_broad_phase(BroadPhase::Tree);
    let mut detector = OneQuery::new(device.clone(), vec![scene::identical(N)?], by_trees)?;
    report.asked += 1;
    match detector.detect() {
        Err(Error::OutOfMemory { asked, .. }) if asked == needed => {}
        Err(error) => report.fail(|| format!("X45: {needed} bytes are needed, but: {error}")),
        Ok(found) => report.fail(|| format!("X45: {} pairs were found", found.len())),
    }
    drop(detector);
    let by_tiles = Query::discrete().with_broad_phase(BroadPhase::Tiles);
    let found = OneQuery::new(device.clone(), vec![slanted(N)?], by_tiles)?.detect()?;
    report.asked += 1;
    report.missed += N.saturating_sub(found.len()) as u64;
    let candidates = n * (n + 1) / 2;
    if found.len() != N || found.stats.slices < 2 || found.stats.triangle_pairs != candidates {
        report.fail(|| {
            let (pairs, slices) = (found.stats.triangle_pairs, found.stats.slices);
            format!(
                "X46: got {} contacts of {pairs} pairs in {slices} slices, expected {N} of {candidates}",
                found.len()
            )
        });
    }
    Ok(())
}

/// Returns `n` equal slanted triangles, each 2^-17 above the last, and one more that stands through
/// all of them. The boxes of the slanted ones all overlap, and they share no point.
fn slanted(n: usize) -> Result<Body, Error> {
    let above = |i: usize| i as f32 / 131_072.0;
    let corners = |i: usize| [[0.0, 0.0, above(i)], [1.0, 0.0, 1.0 + above(i)], [0.0, 1.0, 1.0 + above(i)]];
    let through = [[0.25, 0.25, -1.0], [0.25, 0.25, 3.0], [0.25, 0.75, -1.0]];
    let points: Vec<[f32; 3]> = (0..n).flat_map(corners).chain(through).collect();
    let faces = (0..=n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(Body::deformable(Mesh::new("slanted", Positions::F32(points), faces)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::device::Backend;

    #[test]
    fn slanted_triangles_have_boxes_that_overlap_and_meet_one_alone() {
        let device = Device::open(Backend::Cpu, None).expect("threads");
        let body = slanted(300).expect("a mesh");
        let found = OneQuery::new(device, vec![body], Query::discrete()).expect("a detector");
        let found = { found }.detect().expect("an answer");
        assert_eq!((found.len(), found.stats.triangle_pairs), (300, 300 * 301 / 2));
        assert!(found.pairs().iter().all(|pair| pair.triangles[1] == 300));
    }
}
