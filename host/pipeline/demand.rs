//! The size of an answer, counted before the answer is made. An answer without room is refused
//! early.

use super::counts::Counts;
use super::layout::Layout;
use crate::device::Device;
use crate::error::Error;
use crate::memory;
use crate::query::{ListedRows, Query, QueryKind};
use nearmiss_kernels::abi::{Counter, counter};

/// Least size in bytes of an answer that is compared with free memory.
const LITTLE: u64 = 16 << 20;
/// Rows of an answer of features per candidate pair of triangles, if all of its features meet. A
/// closed mesh has 1 / 2 + 9 / 4, a soup has more. It only decides when rows are counted on the
/// host.
const ROWS_A_PAIR: u64 = 4;
/// Triangles of the smallest group.
const GROUP: usize = 16;
/// Most pairs of groups that are compared.
const COMPARED: u64 = 1 << 24;
/// Factor that reduces a distance, so that rounding of boxes and kernels cannot list less.
const CERTAIN: f64 = 1.0 - 1e-6;

/// Bounds of the answer's size.
#[derive(Default)]
pub struct Demand {
    /// Bytes of a row; 0 for queries that list no rows.
    row: u64,
    counters: &'static [Counter],
    /// Distance within which, at the start of the step, every pair of features is listed.
    within: Option<f64>,
    advice: &'static str,
    /// Rows that earlier slices have found.
    pub before: u64,
}

impl Demand {
    /// Returns the demand of a query whose tolerance was chosen.
    pub fn new(query: &Query) -> Demand {
        let Some(ListedRows { bytes, within, advice }) = query.rows() else { return Demand::default() };
        let kind = query.kind();
        let counters: &[Counter] = if kind.is_of_features() {
            &[counter::VF_HITS, counter::EE_HITS]
        } else if kind == QueryKind::BodyPairs {
            &[counter::MEETING_BODIES]
        } else if kind == QueryKind::BodyDistances {
            &[counter::NEAR_BODIES]
        } else {
            &[counter::CONTACTS]
        };
        Demand { row: bytes as u64, counters, within, advice, before: 0 }
    }

    /// Returns the bytes available for rows of all slices: those of earlier slices, free memory, and
    /// memory of earlier answers.
    fn room(&self, rows: u64, device: &Device) -> u64 {
        let held = self.before.saturating_mul(self.row);
        let more = rows.saturating_sub(self.before).saturating_mul(self.row);
        let free = (more >= LITTLE).then(memory::free).flatten();
        let free = free.map_or(u64::MAX, |free| free.saturating_add(device.spare_rows()));
        held.saturating_add(free).min(device.answers())
    }

    /// Refuses an answer of at least `rows` rows, earlier slices included, if there is no room for
    /// it.
    fn fits(&self, rows: u64, device: &Device) -> Result<(), Error> {
        let (asked, given) = (rows.saturating_mul(self.row), self.room(rows, device));
        if asked <= given {
            return Ok(());
        }
        Err(Error::AnswerTooLarge { pairs: rows, asked, given, advice: self.advice })
    }

    /// Refuses the rows counted so far, if there is no room for them.
    ///
    /// # Errors
    /// [`Error::AnswerTooLarge`].
    pub fn counted(&self, counts: &Counts, device: &Device) -> Result<(), Error> {
        let rows = self.counters.iter().fold(self.before, |rows, &which| rows.saturating_add(counts[which]));
        self.fits(rows, device)
    }

    /// Refuses an answer by a lower bound of its rows, if so many candidate pairs of triangles may
    /// make it too large.
    ///
    /// # Errors
    /// [`Error::AnswerTooLarge`]; those of `positions`.
    pub fn foreseen(
        &self,
        pairs: u64,
        (layout, device): (&Layout, &Device),
        positions: impl FnOnce() -> Result<Vec<[f64; 3]>, Error>,
    ) -> Result<(), Error> {
        let rows = pairs.saturating_mul(ROWS_A_PAIR);
        match self.within {
            Some(within) if self.fits(rows, device).is_err() => {
                self.fits(least(layout, &positions()?, within), device)
            }
            _ => Ok(()),
        }
    }
}

/// Triangles that are neighbours: a box around them, and the features that they own.
struct Group {
    low: [f64; 3],
    high: [f64; 3],
    vertices: u64,
    edges: u64,
    faces: u64,
    /// Index of its first half, if it is divided.
    parts: Option<usize>,
}

impl Group {
    fn of(triangles: &[u32], layout: &Layout, positions: &[[f64; 3]]) -> Group {
        let empty = Group {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            vertices: 0,
            edges: 0,
            faces: triangles.len() as u64,
            parts: None,
        };
        triangles.iter().fold(empty, |mut group, &triangle| {
            for vertex in layout.faces[triangle as usize] {
                for (axis, at) in positions[vertex as usize].into_iter().enumerate() {
                    group.low[axis] = group.low[axis].min(at);
                    group.high[axis] = group.high[axis].max(at);
                }
            }
            let owned = layout.features.owners[triangle as usize];
            group.vertices += u64::from((owned & 0b111).count_ones());
            group.edges += u64::from((owned >> 3 & 0b111).count_ones());
            group
        })
    }

    /// Returns the squares of the least and the greatest distance of two points, one of each group.
    fn apart(&self, other: &Group) -> [f64; 2] {
        let square = |axis: usize, of: fn(f64, f64) -> f64| {
            let [one, two] = [self.high[axis] - other.low[axis], other.high[axis] - self.low[axis]];
            of(one, two)
        };
        let least: fn(f64, f64) -> f64 = |one, two| (-one).max(-two).max(0.0).powi(2);
        let most: fn(f64, f64) -> f64 = |one, two| one.max(two).powi(2);
        [least, most].map(|of| (0..3).map(|axis| square(axis, of)).sum())
    }
}

/// Divides a body's triangles into groups, by halves of halves. Returns the index of the first
/// group.
fn groups(triangles: &mut [u32], all: &mut Vec<Group>, (layout, positions): (&Layout, &[[f64; 3]])) -> usize {
    // Halves are added in pairs, so the index of the first gives both.
    let own = all.len();
    all.push(Group::of(triangles, layout, positions));
    let mut waiting = vec![(own, triangles)];
    while let Some((at, triangles)) = waiting.pop() {
        if triangles.len() <= GROUP {
            continue;
        }
        let extent = |axis: &usize| all[at].high[*axis] - all[at].low[*axis];
        let axis = [0, 1, 2].into_iter().max_by(|a, b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
        let corner = |&triangle: &u32| positions[layout.faces[triangle as usize][0] as usize][axis];
        let middle = triangles.len() / 2;
        triangles.select_nth_unstable_by(middle, |a, b| corner(a).total_cmp(&corner(b)));
        let (one, two) = triangles.split_at_mut(middle);
        all[at].parts = Some(all.len());
        for part in [one, two] {
            all.push(Group::of(part, layout, positions));
            waiting.push((all.len() - 1, part));
        }
    }
    own
}

/// Returns a number of pairs of features that are certainly within a distance, and have no common
/// vertex.
fn least(layout: &Layout, positions: &[[f64; 3]], within: f64) -> u64 {
    let mut all = Vec::new();
    let roots: Vec<(usize, usize)> = (0..layout.bodies())
        .filter(|&body| layout.triangles(body).1 > 0)
        .map(|body| {
            let (first, count) = layout.triangles(body);
            let mut triangles: Vec<u32> = (first..first + count).collect();
            (body, groups(&mut triangles, &mut all, (layout, positions)))
        })
        .collect();
    let mut waiting = Vec::new();
    for (at, &(a, one)) in roots.iter().enumerate() {
        let others = roots[at..].iter().filter(|&&(b, _)| layout.tests(a, b));
        waiting.extend(others.map(|&(_, two)| (one, two)));
    }
    let square = (CERTAIN * within).powi(2);
    let (mut rows, mut compared) = (0u64, 0);
    while let Some((a, b)) = waiting.pop() {
        compared += 1;
        if compared > COMPARED {
            break;
        }
        let [p, q] = [&all[a], &all[b]];
        let [nearest, farthest] = p.apart(q);
        if farthest <= square {
            let own = p.vertices * p.faces + p.edges * p.edges.saturating_sub(1) / 2;
            let both = p.vertices * q.faces + q.vertices * p.faces + p.edges * q.edges;
            rows = rows.saturating_add(if a == b { own } else { both });
        } else if nearest <= square {
            match (p.parts, q.parts) {
                (Some(one), _) if a == b => {
                    waiting.extend([(one, one), (one + 1, one + 1), (one, one + 1)]);
                }
                (Some(one), None) => waiting.extend([(one, b), (one + 1, b)]),
                (Some(one), Some(_)) if p.faces >= q.faces => waiting.extend([(one, b), (one + 1, b)]),
                (_, Some(two)) => waiting.extend([(a, two), (a, two + 1)]),
                (None, None) => {}
            }
        }
    }
    let tested = (0..layout.bodies()).filter(|&body| layout.tests(body, body));
    rows.saturating_sub(tested.map(|body| adjacent(layout, body)).sum())
}

/// Returns an upper bound of a body's pairs of features with a common vertex.
fn adjacent(layout: &Layout, body: usize) -> u64 {
    let [start, end] = [layout.starts[body], layout.starts[body + 1]];
    let mut edges_at = vec![0u64; (end.vertex - start.vertex) as usize];
    let edges = &layout.features.edges[start.edge as usize..end.edge as usize];
    edges.iter().flatten().for_each(|&vertex| edges_at[(vertex - start.vertex) as usize] += 1);
    let of_edges: u64 = edges_at.iter().map(|count| count * count.saturating_sub(1) / 2).sum();
    3 * u64::from(end.triangle - start.triangle) + of_edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Backend;
    use crate::samples::soup;
    use crate::scene::{BodyId, CollisionFilter, Scene};
    use crate::{Body, Detector};

    fn points(bodies: &[Body]) -> Vec<[f64; 3]> {
        bodies.iter().flat_map(|body| body.positions_t0().to_f64()).collect()
    }

    /// Returns the number of certain rows, and that of all rows.
    fn rows(bodies: Vec<Body>, distance: f64) -> (u64, u64) {
        let query = Query::near(distance);
        let layout = Layout::new(&bodies, query.kind());
        let certain = least(&layout, &points(&bodies), distance);
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let found = Detector::new(device, Scene::from(bodies)).and_then(|mut own| own.query(&query));
        (certain, found.expect("an answer").len() as u64)
    }

    #[test]
    fn what_is_certain_is_there() {
        let bodies = |meets: fn() -> CollisionFilter| {
            vec![soup(90, 1, false).with_filter(meets()), soup(70, 2, false)]
        };
        for meets in
            [CollisionFilter::default as fn() -> CollisionFilter, CollisionFilter::with_self_collision]
        {
            let mut some = 0;
            for distance in [0.01, 0.1, 0.3, 0.6, 1.0] {
                let (certain, found) = rows(bodies(meets), distance);
                assert!(certain <= found, "{certain} of {found} within {distance}");
                some += u64::from(certain > 0);
            }
            assert!(some > 0, "some are certain before all are");
            // Soups share no vertex between triangles, so every adjacent pair is counted.
            let (certain, found) = rows(bodies(meets), 1e3);
            assert_eq!(certain, found);
        }
    }

    #[test]
    fn bodies_that_do_not_meet_have_no_rows() {
        let fixed = || Body::fixed(soup(30, 1, false).frames().swap_remove(0));
        let bodies = [fixed(), fixed(), soup(40, 2, false).with_filter(CollisionFilter::default())];
        let layout = Layout::new(&bodies, Query::near(1.0).kind());
        let tested = |a, b| layout.tests(a, b);
        assert!(!tested(0, 0) && !tested(0, 1) && tested(0, 2) && tested(1, 2));
        let listed = layout.clone().without(&[[BodyId(0), BodyId(2)]]);
        assert!(!listed.tests(0, 2) && !listed.tests(2, 0) && listed.tests(1, 2));
        let whole = least(&layout, &points(&bodies), 1e3);
        // Each fixed body has 90 vertices, 30 faces and 90 edges; the other has 120, 40 and 120.
        let of_two = 90 * 40 + 120 * 30 + 90 * 120;
        let own = if tested(2, 2) { 120 * 40 + 120 * 119 / 2 } else { 0 };
        let common = if tested(2, 2) { adjacent(&layout, 2) } else { 0 };
        assert_eq!(whole, 2 * of_two + own - common);
        assert_eq!(least(&listed, &points(&bodies), 1e3), of_two + own - common);
    }
}
