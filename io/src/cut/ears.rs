//! Ear cutting: ears are corners that can be cut off, one after the other.

use super::cross::{Line, crossing};
use super::{Point, ahead, turn};

/// Number of times that all corners are tested again if no neighbour of the last ears is an ear. A
/// polygon that does not touch itself never needs it.
const LOOKS: usize = 16;
/// In place of the next corner, for a corner that was cut off.
const GONE: u32 = u32::MAX;

/// The triangles of a polygon that turns by `sign`, in its corners: n - 2. Each turns as the
/// polygon, or has no area. `None` if the polygon crosses itself or no ear is found.
///
/// Corners may touch other corners or edges if ears can be cut (a hole joined by an edge walked
/// twice).
pub fn cut(at: &[Point], sign: i32) -> Option<Vec<[u32; 3]>> {
    let n = at.len() as u32;
    let mut ears = Ears {
        at,
        sign,
        next: (1..n).chain([0]).collect(),
        prev: [n - 1].into_iter().chain(0..n - 1).collect(),
        left: at.len(),
        line: Line::across(at, &[0]),
        bent: Vec::new(),
        triangles: Vec::with_capacity(at.len() - 2),
    };
    let start = ears.unfold();
    let corners = ears.corners(start);
    if crossing(at, &corners).is_some() {
        return None;
    }
    ears.line = Line::across(at, &corners);
    let mut bent: Vec<_> = corners.iter().filter(|&&b| !ears.is_convex(b)).copied().collect();
    bent.sort_by(|&a, &b| ears.place(a).total_cmp(&ears.place(b)));
    ears.bent = bent;
    let last = ears.clip(corners)?;
    let [a, c] = [ears.prev[last as usize], ears.next[last as usize]];
    let turns = ears.turn(a, last, c);
    ears.triangles.push([a, last, c]);
    (turns >= 0).then_some(ears.triangles)
}

struct Ears<'a> {
    at: &'a [Point],
    sign: i32,
    prev: Vec<u32>,
    next: Vec<u32>,
    left: usize,
    line: Line,
    /// Corners that were not convex before the first ear, in their order along the line. A convex
    /// corner stays convex. If any corner is in an ear, one of these is.
    bent: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl Ears<'_> {
    /// Cuts off the corners at which the polygon turns back on itself. Returns a corner that is
    /// left.
    fn unfold(&mut self) -> u32 {
        let (mut b, mut ahead) = (0, self.left);
        while ahead > 0 && self.left > 3 {
            if self.is_fold(b) {
                let before = self.prev[b as usize];
                self.remove(b);
                (b, ahead) = (before, ahead.max(2));
            } else {
                (b, ahead) = (self.next[b as usize], ahead - 1);
            }
        }
        b
    }

    /// Cuts ears until three corners are left, and returns one of these; `None` if no ear is found.
    fn clip(&mut self, mut round: Vec<u32>) -> Option<u32> {
        let mut touched = vec![false; self.at.len()];
        let (mut again, mut looks) = (Vec::new(), 0);
        let (mut alive, mut all) = (round[0], true);
        let mut kept = self.left;
        while self.left > 3 {
            if self.left < kept / 2 {
                kept = self.left;
                self.bent.retain(|&b| self.next[b as usize] != GONE);
            }
            for &b in &round {
                // Neighbours of an ear are tested in the next round, so that ears are spread.
                if self.left == 3 || self.next[b as usize] == GONE || touched[b as usize] || !self.is_ear(b) {
                    continue;
                }
                let neighbours = [self.prev[b as usize], self.next[b as usize]];
                self.remove(b);
                alive = neighbours[0];
                for x in neighbours {
                    if !std::mem::replace(&mut touched[x as usize], true) {
                        again.push(x);
                    }
                }
            }
            if again.is_empty() {
                looks += 1;
                if all || looks > LOOKS {
                    return None;
                }
                again = self.corners(alive);
                all = true;
            } else {
                all = false;
            }
            again.iter().for_each(|&x| touched[x as usize] = false);
            std::mem::swap(&mut round, &mut again);
            again.clear();
        }
        Some(alive)
    }

    fn is_ear(&self, b: u32) -> bool {
        let (a, c) = (self.prev[b as usize], self.next[b as usize]);
        if self.is_fold(b) {
            return true;
        }
        if self.turn(a, b, c) <= 0 {
            return false;
        }
        let corners = [a, b, c];
        let ends = |x: [f64; 3]| (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        let box_of = [0, 1].map(|k| ends(corners.map(|x| self.at[x as usize][k])));
        let outside = |p: Point| (0..2).any(|k| p[k] < box_of[k].0 || p[k] > box_of[k].1);
        let (low, high) = ends(corners.map(|x| self.place(x)));
        let (low, high) = (low - self.line.slack, high + self.line.slack);
        let from = self.bent.partition_point(|&p| self.place(p) < low);
        let near = self.bent[from..].iter().take_while(|&&p| self.place(p) <= high);
        !near.copied().any(|p| !outside(self.at[p as usize]) && self.is_within(p, corners))
    }

    /// Whether corner `p` keeps the triangle from being an ear. It does if it is in or on the
    /// triangle, or coincides with a corner and has an edge that goes into it.
    fn is_within(&self, p: u32, corners: [u32; 3]) -> bool {
        if self.next[p as usize] == GONE || corners.contains(&p) {
            return false;
        }
        let at = |x: u32| self.at[x as usize];
        let [a, b, c] = corners;
        for [from, left, right] in [[a, b, c], [b, c, a], [c, a, b]] {
            if at(from) == at(p) {
                return [self.prev[p as usize], self.next[p as usize]]
                    .into_iter()
                    .any(|q| self.turn(from, left, q) > 0 && self.turn(from, right, q) < 0);
            }
        }
        // Most corners are beyond the third edge.
        self.turn(c, a, p) >= 0 && self.turn(a, b, p) >= 0 && self.turn(b, c, p) >= 0
    }

    /// Whether the polygon turns back or stays at a corner, so that cutting it off removes no area.
    fn is_fold(&self, b: u32) -> bool {
        let [a, b, c] = [self.prev[b as usize], b, self.next[b as usize]].map(|x| self.at[x as usize]);
        a == b || b == c || a == c || (ahead(b, a, c) && turn(a, b, c) == 0)
    }

    fn is_convex(&self, b: u32) -> bool {
        self.turn(self.prev[b as usize], b, self.next[b as usize]) > 0
    }

    /// 1 if three corners turn as the polygon.
    fn turn(&self, a: u32, b: u32, c: u32) -> i32 {
        self.sign * turn(self.at[a as usize], self.at[b as usize], self.at[c as usize])
    }

    fn place(&self, corner: u32) -> f64 {
        self.line.place(self.at[corner as usize])
    }

    fn remove(&mut self, b: u32) {
        let (a, c) = (self.prev[b as usize], self.next[b as usize]);
        self.triangles.push([a, b, c]);
        self.next[a as usize] = c;
        self.prev[c as usize] = a;
        self.next[b as usize] = GONE;
        self.left -= 1;
    }

    /// The corners that are left, in turn.
    fn corners(&self, start: u32) -> Vec<u32> {
        let follow = |&b: &u32| Some(self.next[b as usize]).filter(|&next| next != start);
        std::iter::successors(Some(start), follow).collect()
    }
}
