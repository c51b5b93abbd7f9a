//! Triangles that share corners by index: whether they meet beyond their shared vertices.

use super::flat::{boxes_meet, projection};
use super::signs::Signs;
use super::tri_tri::meets;
use crate::math::{Real, Vec3};

/// Whether two triangles share a vertex index.
#[inline]
pub fn share_a_vertex(p: [u32; 3], q: [u32; 3]) -> bool {
    let has = |v: u32| (v == q[0]) | (v == q[1]) | (v == q[2]);
    has(p[0]) | has(p[1]) | has(p[2])
}

/// The vertices that two triangles share by index: corners numbered 0 to 2, first of `p`, then of
/// `q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shared {
    /// No corner.
    Nothing,
    /// These corners are one vertex.
    Corner(usize, usize),
    /// All but these corners (the apexes) are shared.
    Edge(usize, usize),
    /// All three corners: a duplicate.
    All,
}

impl Shared {
    /// The shared vertices of the triangles with these vertex indices. A triangle may name a vertex
    /// twice: then it is a segment (or a point), and a vertex counts once.
    pub fn by_index(p: [u32; 3], q: [u32; 3]) -> Self {
        let again = |t: [u32; 3]| (0..3).position(|k| t[..k].contains(&t[k]));
        let foreign = |t: [u32; 3], o: [u32; 3]| t.iter().position(|v| !o.contains(v));
        let mut common = None;
        let mut count = 0;
        for (i, v) in p.iter().enumerate() {
            if let (false, Some(j)) = (p[..i].contains(v), q.iter().position(|w| v == w)) {
                common = common.or(Some((i, j)));
                count += 1;
            }
        }
        match common {
            None => Shared::Nothing,
            Some((i, j)) if count == 1 => Shared::Corner(i, j),
            // The apex is the corner that is not shared. For a segment that is the shared edge, it
            // is the corner named twice.
            Some(_) if count == 2 => {
                let apex = |t, o| foreign(t, o).or(again(t)).unwrap_or(0);
                Shared::Edge(apex(p, q), apex(q, p))
            }
            Some(_) => Shared::All,
        }
    }
}

/// Whether the closed triangles share a point beyond the shared corner, or beyond the segment of
/// the shared edge. Duplicates always do. Triangles without area are segments or points here, too.
/// `None` only if a sign is `None`.
pub fn meets_beyond_shared<R: Real, S: Signs<R>>(
    p: &[Vec3<R>; 3],
    q: &[Vec3<R>; 3],
    shared: Shared,
) -> Option<bool> {
    let turn = |t: &[Vec3<R>; 3], k: usize| [t[k % 3], t[(k + 1) % 3], t[(k + 2) % 3]];
    match shared {
        Shared::Nothing => meets::<R, S>(p, q),
        Shared::Corner(i, j) => beyond_corner::<R, S>(&turn(p, i), &turn(q, j)),
        Shared::Edge(i, j) => {
            let [a, v, w] = turn(p, i);
            beyond_edge::<R, S>(v, w, a, q[j % 3])
        }
        Shared::All => Some(true),
    }
}

/// Corner 0 of both is one point v. Suppose x is another common point. The ray from v through x
/// leaves `p` at a point on the edge opposite to v, and `q` likewise. The nearer of the two is in
/// both. So the opposite edges decide, unless one passes through v (no area). Such an edge is cut
/// there: then `p` is two segments from v.
fn beyond_corner<R: Real, S: Signs<R>>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> Option<bool> {
    // q touches the plane of p at v alone, or the other way round: the common case.
    let apart = |s: [Option<i32>; 3]| s[1].is_some_and(|x| x != 0) && s[1] == s[2];
    if apart(S::sides(p, q)) || apart(S::sides(q, p)) {
        return Some(false);
    }
    let mut unsure = false;
    for e in rays::<R, S>(p)?.into_iter().flatten() {
        for f in rays::<R, S>(q)?.into_iter().flatten() {
            let (whole_p, whole_q) = ([p[0], e[0], e[1]], [q[0], f[0], f[1]]);
            for answer in
                [meets::<R, S>(&[e[0], e[1], e[1]], &whole_q), meets::<R, S>(&[f[0], f[1], f[1]], &whole_p)]
            {
                match answer {
                    Some(true) => return Some(true),
                    Some(false) => {}
                    None => unsure = true,
                }
            }
        }
    }
    if unsure { None } else { Some(false) }
}

/// The ends of `t` as seen from its corner 0: segments that miss corner 0 and with it span `t`.
fn rays<R: Real, S: Signs<R>>(t: &[Vec3<R>; 3]) -> Option<[Option<[Vec3<R>; 2]>; 2]> {
    let [v, a, b] = *t;
    if boxes_meet(&[v], &[a, b]) && projection::<R, S>(t)?.is_none() {
        let end = |x: Vec3<R>| (x != v).then_some([x, x]);
        return Some([end(a), end(b)]);
    }
    Some([Some([a, b]), None])
}

/// `v`, `w` are shared, `a` and `b` the apexes. With area: in one plane, and the apexes strictly on
/// one side of the edge. An edge of no length gives only zeros, an apex on the edge's line one
/// zero: false, unless all four are on one line, in which case both apexes must be beyond the same
/// end.
fn beyond_edge<R: Real, S: Signs<R>>(v: Vec3<R>, w: Vec3<R>, a: Vec3<R>, b: Vec3<R>) -> Option<bool> {
    if S::orient3d(v, w, a, b)? != 0 {
        return Some(false);
    }
    for axis in 0..3 {
        let side = [S::orient2d(v, w, a, axis)?, S::orient2d(v, w, b, axis)?];
        if side[0] * side[1] != 0 {
            return Some(side[0] == side[1]);
        }
        if side != [0; 2] || S::orient2d(a, b, v, axis)? != 0 || S::orient2d(a, b, w, axis)? != 0 {
            return Some(false);
        }
    }
    Some((0..3).any(|k| {
        let (low, high) = (v[k].min(w[k]), v[k].max(w[k]));
        (a[k] > high && b[k] > high) || (a[k] < low && b[k] < low)
    }))
}

#[cfg(test)]
mod tests {
    use super::Shared::{All, Corner, Edge, Nothing};
    use super::*;

    #[test]
    fn what_is_shared_counts_each_vertex_once() {
        assert_eq!(Shared::by_index([0, 1, 2], [3, 4, 5]), Nothing);
        assert_eq!(Shared::by_index([0, 1, 2], [3, 1, 5]), Corner(1, 1));
        assert_eq!(Shared::by_index([0, 1, 2], [2, 1, 5]), Edge(0, 2));
        assert_eq!(Shared::by_index([0, 1, 2], [2, 0, 1]), All);
        // A segment from a shared vertex is not two shared vertices.
        assert_eq!(Shared::by_index([7, 7, 8], [7, 1, 2]), Corner(0, 0));
        assert_eq!(Shared::by_index([1, 2, 7], [7, 8, 7]), Corner(2, 0));
        // A segment that is an edge of the other triangle: its apex is the corner named twice.
        assert_eq!(Shared::by_index([7, 7, 8], [7, 8, 2]), Edge(1, 2));
        assert_eq!(Shared::by_index([7, 8, 2], [8, 7, 7]), Edge(2, 2));
        assert_eq!(Shared::by_index([7, 7, 8], [8, 8, 7]), Edge(1, 1));
        assert_eq!(Shared::by_index([7, 7, 7], [7, 7, 7]), Corner(0, 0));
    }
}
