//! A tree that is refitted ten thousand times must still hold its mesh, and find the pairs of a new
//! tree.

use super::report::Report;
use crate::OneQuery;
use nearmiss::contacts::Contacts;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::{Continuous, Query};
use nearmiss::research::pipeline::enclose::Enclosed;
use nearmiss::research::{BoundingVolume, Certified, QueryExt, Refit, WithSolver, WithVolume};
use nearmiss_kernels::entry::Kernels;
use nearmiss_kernels::math::Vec3;

/// Triangles of the mesh. They are few, since each frame checks each corner in each node above it,
/// in exact arithmetic.
const TRIANGLES: u32 = 24;
/// Frames from one comparison with a new tree to the next.
const APART: u32 = 500;
/// The refits, in turn for each volume.
const WAYS: [Refit; 2] = [Refit::Levels, Refit::Treelets];

/// Returns the vertices at frame `k` of a ribbon that turns, waves and drifts, by sums and products
/// alone.
fn ribbon(k: u32) -> Vec<[f32; 3]> {
    let vertices = TRIANGLES + 2;
    // A rotation by an angle that is no rational part of a turn: (3 + 4 i) / 5 to the k-th power.
    // Only the last 64 steps count, so that each frame costs the same.
    let (mut c, mut s) = (1.0f64, 0.0f64);
    for _ in 0..k % 64 {
        (c, s) = (0.6 * c - 0.8 * s, 0.8 * c + 0.6 * s);
    }
    let drift = f64::from(k) * 0.01;
    let vertex = |i: u32| {
        let noise =
            (i.wrapping_mul(2_654_435_761) ^ k.wrapping_mul(40_503)).wrapping_mul(2_246_822_519) >> 20;
        let (x, y) = (f64::from(i / 2), f64::from(i % 2) + f64::from(noise) / 4096.0);
        // Folded: the second half covers the first.
        let x = if i < vertices / 2 { x } else { f64::from(vertices / 2) - x };
        let z = f64::from(noise % 64) / 32.0;
        [c * x - s * y + drift, s * x + c * y, z - drift].map(|x| x as f32)
    };
    (0..vertices).map(vertex).collect()
}

fn faces() -> Vec<[u32; 3]> {
    (0..TRIANGLES).map(|i| [i, i + 1, i + 2]).collect()
}

fn body(k: u32) -> Result<Body, Error> {
    let mesh = |k| Mesh::new("ribbon", Positions::F32(ribbon(k)), faces());
    Body::moving(mesh(k)?, mesh(k + 1)?)
}

/// Counts corners outside of nodes over all frames.
struct Holds<'a> {
    device: &'a Device,
    frames: u32,
    refit: Refit,
    report: &'a mut Report,
    name: &'a str,
}

impl WithVolume for Holds<'_> {
    type Out = Result<(), Error>;

    fn with<V: Kernels>(self) -> Self::Out {
        let way = (self.refit, 0.0);
        holds::<V>(self.device, self.frames, way, (self.report, self.name))
    }
}

fn holds<V: Kernels>(
    device: &Device,
    frames: u32,
    way: (Refit, f32),
    (report, name): (&mut Report, &str),
) -> Result<(), Error> {
    let at = |k| ribbon(k).into_iter().map(Vec3).collect::<Vec<_>>();
    let (mut t0, mut t1) = (at(0), at(1));
    let mut tree = Enclosed::<f32, V>::new(device, &faces(), [&t0, &t1], way)?;
    for k in 1..=frames {
        t0 = t1;
        t1 = at(k + 1);
        tree.move_to(&t0, &t1)?;
        let outside = tree.outside(0.0, |_| ())?;
        report.asked += 1;
        if outside > 0 {
            report.missed += outside as u64;
            report.fail(|| {
                format!("X57 {name}, frame {k}: {outside} corners are outside of a node above them")
            });
        }
    }
    Ok(())
}

/// Refits a small moving mesh so often, in each volume. It checks in exact arithmetic that every
/// node holds every corner below it. It also moves a detector the same way, whose contacts must
/// equal those of a new one at intervals.
///
/// # Errors
/// Device errors.
pub fn ask_refits(device: &Device, frames: u32) -> Result<Report, Error> {
    let mut report = Report::new("refits");
    let all = &mut report;
    for (volume, refit) in BoundingVolume::ALL.into_iter().zip(WAYS.into_iter().cycle()) {
        volume.with(Holds { device, frames, refit, report: all, name: volume.name() })?;
    }
    for (volume, refit) in BoundingVolume::ALL.into_iter().zip(WAYS.into_iter().cycle()) {
        // The default tolerance depends on the detector's first positions.
        let continuous = Continuous::by(Certified { tolerance: Some(1e-5), ..Certified::default() });
        for query in [Query::discrete(), continuous.into()] {
            let query = query.with_volume(volume).with_refit(refit);
            let mut detector = OneQuery::new(device.clone(), vec![body(0)?], query)?;
            for k in (APART..=frames).step_by(APART as usize) {
                // `holds` refits the frames in between; this tree jumps.
                detector.move_to(0, body(k)?)?;
                let found: Contacts = detector.detect()?;
                let fresh = OneQuery::new(device.clone(), vec![body(k)?], query)?.detect()?;
                report.asked += 1;
                report.undecided += found.undecided;
                if found.rows != fresh.rows {
                    report.fail(|| {
                        let (was, is) = (found.len(), fresh.len());
                        format!(
                            "X57 {}, {}, frame {k}: got {was} contacts, {is} by a new tree",
                            volume.name(),
                            query.kind()
                        )
                    });
                }
            }
        }
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::device::emulator::{Emulator, Mode};
    use nearmiss_kernels::bv::Obb;

    /// The ribbon meets itself, and a tree of one frame does not hold another.
    #[test]
    fn the_ribbon_asks_something() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        for query in [Query::discrete(), Query::continuous()] {
            let found = OneQuery::new(device.clone(), vec![body(500).expect("a body")], query);
            let found = found.expect("a detector").detect().expect("an answer");
            assert!(found.len() > 3, "{query:?}: {}", found.len());
        }
        let at = |k| ribbon(k).into_iter().map(Vec3).collect::<Vec<_>>();
        let way = (Refit::Levels, 0.0);
        let mut tree = Enclosed::<f32, Obb>::new(&device, &faces(), [&at(0), &at(1)], way).expect("a tree");
        tree.move_to(&at(7), &at(8)).expect("a frame");
        assert_eq!(tree.outside(0.0, |_| ()).expect("nodes"), 0);
        let half = |nodes: &mut [nearmiss_kernels::abi::Node<Obb>]| {
            nodes.iter_mut().for_each(|node| node.volume.h = node.volume.h.map(|h| h * 0.999));
        };
        assert!(tree.outside(0.0, half).expect("nodes") > 10);
    }
}
