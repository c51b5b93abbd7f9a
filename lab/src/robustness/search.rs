//! Runs the catalogue's scenes on a machine.

use super::report::Report;
use super::scenes::{Numbers, Refused, Scene};
use crate::OneQuery;
use nearmiss::contacts::{Contacts, Status, triangle_contacts};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::{BoundingVolume, QueryExt};

fn found(device: &Device, bodies: Vec<Body>, query: Query) -> Result<Contacts, Error> {
    let mut detector = OneQuery::new(device.clone(), bodies, query)?;
    let found = detector.detect()?;
    detector.check_volumes()?;
    Ok(found)
}

/// Runs each scene, with every bounding volume, and judges the answers. A continuous query of a
/// still scene must find a part of its pairs at time 0.
///
/// # Errors
/// Device errors.
pub fn ask_scenes(device: &Device, scenes: &[Scene]) -> Result<Report, Error> {
    let mut report = Report::new("scenes");
    for scene in scenes {
        let bodies = match scene.bodies() {
            Ok(bodies) => bodies,
            Err(error) => {
                report.fail(|| format!("{} {}: refused: {error}", scene.id, scene.what));
                continue;
            }
        };
        for volume in BoundingVolume::ALL {
            let found = found(device, bodies.clone(), scene.query().with_volume(volume))?;
            report.asked += 1;
            report.undecided += found.undecided;
            if let Some(wrong) = scene.judge(&found) {
                report.missed += u64::from(wrong.starts_with("missed"));
                report.late += u64::from(wrong.starts_with("late"));
                report.fail(|| format!("{} {}, {}: {wrong}", scene.id, scene.what, volume.name()));
            }
        }
        if scene.query().kind() == QueryKind::Discrete {
            let found = found(device, bodies.clone(), Query::continuous())?;
            report.asked += 1;
            let pairs = if scene.adjacent { None } else { Some(scene.pairs()) };
            if let Some(wrong) = at_once(&bodies, &found, pairs.as_deref()) {
                report.fail(|| format!("X23 {} {}: {wrong}", scene.id, scene.what));
            }
        }
    }
    Ok(report)
}

/// Checks that features of a still scene only meet at time 0, and that their triangles meet.
fn at_once(bodies: &[Body], found: &Contacts, pairs: Option<&[[u32; 2]]>) -> Option<String> {
    if let Some(late) = found.contacts().iter().find(|c| c.toi != 0.0) {
        return Some(format!("at rest, but not at time 0: {late:?}"));
    }
    let sure: Vec<_> = found.contacts().iter().filter(|c| c.status == Status::Certified).copied().collect();
    let triangles = triangle_contacts(&sure, bodies);
    let pairs = pairs?;
    let more = triangles.iter().find(|t| !pairs.contains(&t.pair.triangles));
    more.map(|t| {
        let [a, b] = t.pair.triangles;
        format!("features of {a} and {b} certainly meet, the triangles do not")
    })
}

/// Runs each still scene again with other orders of its triangles, their corners, the axes and the
/// bodies. Each order uses one of the volumes.
///
/// # Errors
/// Device errors.
pub fn ask_turned_scenes(device: &Device, scenes: &[Scene]) -> Result<Report, Error> {
    const CORNERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let mut report = Report::new("scenes turned");
    for scene in scenes.iter().filter(|s| s.query().kind() == QueryKind::Discrete) {
        let truth = scene.pairs();
        // Six orders for one body; for two, all thirty-six combinations.
        let second = scene.bodies.len() == 2;
        for turn in 0..if second { 36 } else { 6 } {
            let turned = |body: &Numbers, order: usize| {
                let (corners, axes) = (CORNERS[order], CORNERS[turn % 6]);
                let point = |p: &[f64; 3]| {
                    [0, 1, 2].map(|k| if turn >> k & 1 == 1 { -p[axes[k]] } else { p[axes[k]] })
                };
                Numbers {
                    t0: body.t0.iter().map(point).collect(),
                    // Triangles in reverse order.
                    faces: body.faces.iter().rev().map(|f| corners.map(|k| f[k])).collect(),
                    ..body.clone()
                }
            };
            let mut bodies: Vec<Numbers> =
                scene.bodies.iter().zip([turn % 6, turn / 6]).map(|(b, order)| turned(b, order)).collect();
            let counts: Vec<u32> = bodies.iter().map(|b| b.faces.len() as u32).collect();
            let exchanged = second && turn % 2 == 1;
            if exchanged {
                bodies.reverse();
            }
            let bodies = bodies.iter().map(Numbers::body).collect::<Result<_, _>>()?;
            let volume = BoundingVolume::ALL[(turn + turn / 6) % BoundingVolume::ALL.len()];
            let all = found(device, bodies, scene.query().with_volume(volume))?;
            let back = |[a, b]: [u32; 2]| {
                let [a, b] = if exchanged { [b, a] } else { [a, b] };
                let (a, b) = (counts[0] - 1 - a, counts[counts.len() - 1] - 1 - b);
                if second { [a, b] } else { [a.min(b), a.max(b)] }
            };
            let mut pairs: Vec<[u32; 2]> = all.triangles().into_iter().map(back).collect();
            pairs.sort_unstable();
            report.asked += 1;
            if pairs != truth {
                report.fail(|| {
                    format!(
                        "X53 {} {}, turn {turn}: got {} pairs, expected {}",
                        scene.id,
                        scene.what,
                        pairs.len(),
                        truth.len()
                    )
                });
            }
        }
    }
    Ok(report)
}

/// Builds each body, and checks the words of its refusal; an accepted one is tested against itself.
///
/// # Errors
/// Device errors.
pub fn ask_refused(device: &Device, all: &[Refused]) -> Result<Report, Error> {
    let mut report = Report::new("refusals");
    for row in all {
        report.asked += 1;
        match row.body.body() {
            Ok(body) if row.words.is_empty() => {
                for query in [Query::discrete(), Query::continuous()] {
                    let pairs = found(device, vec![body.clone()], query)?;
                    if !pairs.is_empty() {
                        report.fail(|| {
                            format!("{} {}: {} contacts of one triangle", row.id, row.what, pairs.len())
                        });
                    }
                }
            }
            Ok(_) => report.fail(|| format!("{} {}: accepted", row.id, row.what)),
            Err(error @ Error::Input { .. }) => {
                let text = error.to_string();
                let lacks = row.words.iter().find(|word| !text.contains(**word));
                if lacks.is_some() || row.words.is_empty() {
                    report.fail(|| format!("{} {}: lacks {lacks:?}: {text}", row.id, row.what));
                }
            }
            Err(error) => report.fail(|| format!("{} {}: {error}", row.id, row.what)),
        }
    }
    Ok(report)
}
