//! # Approach: vertex/face and edge/edge pairs → those that may meet; contacts of those that part
//! Paper    not in the paper.
//! Launch   four, both kinds in each, before the first rung of the solver. Only for a query of what
//!          approaches. [`approach()`] over all pairs, a lane each: distances in f32. [`signs`] over
//!          those that may be near at the start: bounds of errors. [`exact`] over those that it
//!          leaves: integers. [`advance`] over those whose distance may fall later.
//!          So lanes of a warp do the same, and few registers read many pairs.
//!          The solver tests the pairs that [`approach()`] leaves at the same time as the other three
//!          launches: neither reads a list that the other writes. Those that [`signs`] and [`exact`]
//!          leave are in a list of their own, for the solver behind them.
//!          The last three have blocks of one warp. A short list is spread over all blocks: lanes of
//!          a warp wait for each other.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies and
//!          radii of vertices, if they differ. [`approach()`] reads positions of the first frame.
//! Writes   [`approach()`]: pairs for the solver, and pairs for [`signs`]. [`signs`] and [`exact`]:
//!          pairs for the solver, in one list; pairs for the next launch, and with a time for the
//!          last. Contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete.
//! After    Let d be the distance of a pair at the start, and within = {pairs : d <= separation}.
//!          beyond = {pairs certainly farther apart by f32}, near = pairs less beyond.
//!          within ⊆ near; beyond ∩ within = {}. [`approach()`] puts each pair in one of two lists.
//!          {pairs not in within that come within the separation} ⊆ beyond ∪ left.
//!          {pairs in within that come nearer than d} ⊆ left ∪ listed, those that do so at once ⊆ left.
//!          No time is late. Pairs in within that never come nearer are in neither, if the test
//!          decides it. See [`crate::prim::approach`]: the course of a pair is a function of the pair,
//!          so no answer depends on the launch that finds it.
//! Room     beyond, near, left, the lists between the launches, hits: counted past the end, grown, run
//!          again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered), in each launch that has it.
//!          [`approach()`] 220 operations of f32, [`signs`] 500 to 2,000. [`exact`] 1,000 a sign that
//!          bounds leave open if the pair's coordinates span 60 bits, 20 times as many if they span
//!          more. [`advance`] 300 to 600 a step; mostly 1 to 4 steps, of cloth up to 30.

use super::climb::{FEWEST, Tiles, dealt, emit};
use super::{edge_edge, of_edge_edge, of_vertex_face, radii_of_edges, radii_of_face, vertex_face};
use crate::abi::{Begun, Listed, Output, Pair, ThickRungArgs};
use crate::exec::{ALONE, Block, Lane, RowMap, Share, Slot};
use crate::math::{Real, Vec3};
use crate::prim::approach::integers::Vertices;
use crate::prim::approach::{Begin, Course, Decided, Motion, largest};
use crate::prim::inclusion::Params;
use crate::prim::isolate::{Edges, Face};
use crate::prim::near::Filter;

/// Distances: pairs that are certainly beyond the separation at the start are left for the solver. f32
/// leaves few others, and [`signs`] measures those in f64.
pub fn approach<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    let (rung, lanes) = (&args.rung, block.lanes());
    let goes = |may_be_near: u32| if may_be_near == 0 { Goes::ToSolver } else { Goes::On };
    let share = block.share(rung.vf.pairs.listed(block), lanes);
    sort(block, (&rung.vf, rung.vf_asked), (share, lanes), |lane, pair| {
        let radii = differ(args).then(|| radii_of_face(lane, args.radii, rung.faces, pair));
        let filter = Filter::<R, true>::new(within(args, of_vertex_face(lane, rung, pair), radii));
        let (v, [x, y, z]) = vertex_face(lane, &rung.frames, rung.faces, pair);
        goes(filter.at_once([v.t0, x.t0, y.t0, z.t0]))
    });
    let share = block.share(rung.ee.pairs.listed(block), lanes);
    sort(block, (&rung.ee, rung.ee_asked), (share, lanes), |lane, pair| {
        let radii = differ(args).then(|| radii_of_edges(lane, args.radii, rung.edges, pair));
        let filter = Filter::<R, false>::new(within(args, of_edge_edge(lane, rung, pair), radii));
        let [x, y] = edge_edge(lane, &rung.frames, rung.edges, pair);
        goes(filter.at_once([x[0].t0, x[1].t0, y[0].t0, y[1].t0]))
    });
}

/// Features that are farther apart than this are beyond the separation, whichever points are nearest.
#[inline(always)]
fn within<R: Real>(args: &ThickRungArgs<R>, of_bodies: Params, radii: Option<[f64; 4]>) -> f64 {
    of_query(args, of_bodies).min_separation + largest(radii.unwrap_or_default())
}

/// Signs by bounds: of pairs that may be near at the start. Those that are not are left for the solver.
pub fn signs<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    spread(block, args, FEWEST, |of| {
        let Begin::Within(near) = of.motion().begin(of.radii, &of.params) else {
            return Some(Decided::Course(Course::Solver));
        };
        let vertices = of.in_f64();
        Motion { vertices: &vertices, pair: &of.vectors }.by_bounds(&near, &of.params)
    });
}

/// Integers: of pairs that bounds leave.
pub fn exact<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    spread(block, args, 1, |of| {
        let Begin::Within(near) = of.motion().begin(of.radii, &of.params) else {
            return Some(Decided::Course(Course::Solver));
        };
        let vertices = of.in_f64();
        Some(Motion { vertices: &vertices, pair: &of.vectors }.by_integers(&near, &of.params))
    });
}

/// Least pairs of a warp that advance: steps are long, and differ in number.
const ADVANCING: u32 = 8;

/// Advancement: of pairs whose distance is not below that at the start before a time.
pub fn advance<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    let rung = &args.rung;
    let course = |moved: &Moved<R>, from| match moved.motion().begin(moved.radii, &moved.params) {
        Begin::Beyond => Course::Never,
        Begin::Within(near) => {
            let vertices = moved.in_f64();
            let motion = Motion { vertices: &vertices, pair: &moved.vectors };
            motion.advance(f64::from_bits(from), &near, &moved.params)
        }
    };
    let counts = [rung.vf.begun, rung.ee.begun].map(|of| of.listed(block));
    let [vf, ee] = shares(block, counts, ADVANCING);
    each(block, vf, |lane, i| {
        let Begun { pair, from } = rung.vf.begun.get(lane, i);
        if let Course::Known(verdict) = course(&face(lane, args, pair), from) {
            emit(lane, rung, &rung.vf, pair, verdict);
        }
    });
    each(block, ee, |lane, i| {
        let Begun { pair, from } = rung.ee.begun.get(lane, i);
        if let Course::Known(verdict) = course(&edges(lane, args, pair), from) {
            emit(lane, rung, &rung.ee, pair, verdict);
        }
    });
}

/// A lane for each item of a share, so many a turn.
#[inline(always)]
fn each<B: Block>(block: &mut B, (share, width): (Share, u32), body: impl Fn(&B::Lane, u32)) {
    let mut base = share.first;
    while base < share.end {
        block.phase(|lane| {
            let i = base + lane.lane();
            if lane.lane() < width && i < share.end {
                body(lane, i);
            }
            lane.meet();
        });
        base += share.step;
    }
}

/// A pair, as read.
struct Moved<R> {
    vertices: Vertices<R>,
    vectors: Edges<f64>,
    /// Those of control vectors; 0 if they are part of the separation.
    radii: [f64; 4],
    params: Params,
}

impl<R: Real> Moved<R> {
    #[inline(always)]
    fn motion(&self) -> Motion<'_, R> {
        Motion { vertices: &self.vertices, pair: &self.vectors }
    }

    #[inline(always)]
    fn in_f64(&self) -> Vertices<f64> {
        self.vertices.map(|ends| ends.map(Vec3::wide))
    }
}

/// A vertex and a face.
#[inline(always)]
fn face<R: Real, L: Lane>(lane: &L, args: &ThickRungArgs<R>, pair: Pair) -> Moved<R> {
    let rung = &args.rung;
    let params = of_query(args, of_vertex_face(lane, rung, pair));
    let (v, [x, y, z]) = vertex_face(lane, &rung.frames, rung.faces, pair);
    let radii = differ(args).then(|| radii_of_face(lane, args.radii, rung.faces, pair));
    let vectors = Face::new(v, [x, y, z], &params).of_four();
    let vertices = [v, x, y, z].map(|vertex| [vertex.t0, vertex.t1]);
    Moved { vertices, vectors, radii: radii.unwrap_or_default(), params }
}

/// Two edges.
#[inline(always)]
fn edges<R: Real, L: Lane>(lane: &L, args: &ThickRungArgs<R>, pair: Pair) -> Moved<R> {
    let rung = &args.rung;
    let params = of_query(args, of_edge_edge(lane, rung, pair));
    let [x, y] = edge_edge(lane, &rung.frames, rung.edges, pair);
    let radii = differ(args).then(|| radii_of_edges(lane, args.radii, rung.edges, pair));
    let vectors = Edges::new(x, y, &params);
    let vertices = [x[0], x[1], y[0], y[1]].map(|vertex| [vertex.t0, vertex.t1]);
    Moved { vertices, vectors, radii: radii.unwrap_or_default(), params }
}

/// Whether radii differ between vertices. Else they are part of the separation.
#[inline(always)]
fn differ<R: Real>(args: &ThickRungArgs<R>) -> bool {
    !args.radii.is_empty()
}

/// Parameters of a pair. With radii of vertices the separation is that of the query.
#[inline(always)]
fn of_query<R: Real>(args: &ThickRungArgs<R>, of_bodies: Params) -> Params {
    let Params { min_separation, .. } = if differ(args) { args.rung.params } else { of_bodies };
    Params { min_separation, ..of_bodies }
}

/// The fate of a pair.
#[derive(Clone, Copy, PartialEq)]
enum Goes {
    /// It is in no contact, or listed.
    Nowhere,
    ToSolver,
    /// To the next launch.
    On,
    /// To the last launch, with the bits of a time.
    Advances(u64),
}

/// The shares of a block of short lists of both kinds, and how many pairs it takes a turn: those are
/// spread over the grid, so many at least. Lanes that run one after another do not wait for others.
#[inline(always)]
fn shares<B: Block>(block: &B, counts: [u32; 2], fewest: u32) -> [(Share, u32); 2] {
    dealt(block, counts, if ALONE { block.lanes() } else { fewest }).map(|Tiles { count, first, width }| {
        (Share { first: first * width, step: block.blocks() * width, end: count }, width)
    })
}

/// The courses of pairs of both kinds, spread over the grid, so many a warp at least. A known contact
/// is listed, and a pair without a course goes on.
#[inline(always)]
fn spread<R: Real, B: Block>(
    block: &mut B,
    args: &ThickRungArgs<R>,
    fewest: u32,
    decided: impl Fn(&Moved<R>) -> Option<Decided>,
) {
    let rung = &args.rung;
    let goes = |lane: &B::Lane, (of, pair): (&Listed, Pair), moved: &Moved<R>| match decided(moved) {
        None => Goes::On,
        Some(Decided::From(from)) => Goes::Advances(from.to_bits()),
        Some(Decided::Course(Course::Solver)) => Goes::ToSolver,
        Some(Decided::Course(Course::Never)) => Goes::Nowhere,
        Some(Decided::Course(Course::Known(verdict))) => {
            emit(lane, rung, of, pair, verdict);
            Goes::Nowhere
        }
    };
    let counts = [rung.vf.pairs, rung.ee.pairs].map(|of| of.listed(block));
    let [vf, ee] = shares(block, counts, fewest);
    sort(block, (&rung.vf, rung.vf_asked), vf, |lane, pair| {
        goes(lane, (&rung.vf, pair), &face(lane, args, pair))
    });
    sort(block, (&rung.ee, rung.ee_asked), ee, |lane, pair| {
        goes(lane, (&rung.ee, pair), &edges(lane, args, pair))
    });
}

/// Bits of the count of a list: a block has fewer lanes.
const FIELD: u32 = 10;
const MASK: u32 = (1 << FIELD) - 1;
/// A wish for a place in the list of the solver, of the next launch and of the last one. All are
/// counted in one word.
const SOLVER: u32 = 1;
const ON: u32 = 1 << FIELD;
const ADVANCES: u32 = 1 << (2 * FIELD);

/// Puts the pairs of a share, so many a turn, where they go.
#[inline(always)]
fn sort<B: Block>(
    block: &mut B,
    (of, on): (&Listed, Output<Pair>),
    (share, width): (Share, u32),
    test: impl Fn(&B::Lane, Pair) -> Goes,
) {
    if ALONE && share.is_empty() {
        return;
    }
    let mut found = block.slot(Begun::default());
    let (mut wishes, mut places) = (block.slot(0u32), block.slot(0u32));
    let mut base = share.first;
    while base < share.end {
        block.phase(|lane| {
            let (i, mut wish) = (base + lane.lane(), 0);
            if lane.lane() < width && i < share.end {
                let pair = of.pairs.get(lane, i);
                let goes = test(lane, pair);
                let from = if let Goes::Advances(from) = goes { from } else { 0 };
                *found.of(lane) = Begun { pair, from };
                wish = match goes {
                    Goes::Nowhere => 0,
                    Goes::ToSolver => SOLVER,
                    Goes::On => ON,
                    Goes::Advances(_) => ADVANCES,
                };
            }
            *wishes.of(lane) = wish;
            *places.of(lane) = wish;
            lane.meet();
        });
        let total = block.scan(&mut places);
        let [to_solver, to_next, to_last] = [0, 1, 2].map(|at| (total >> (at * FIELD) & MASK) as u64);
        let [start, start_on] = block.reserve_both([of.left.count(), on.count()], [to_solver, to_next]);
        let start_last = of.begun.reserve(block, to_last);
        block.phase(|lane| {
            let (wish, before, begun) = (*wishes.of(lane), *places.of(lane), *found.of(lane));
            let place = |at: u32| (before >> (at * FIELD) & MASK) as u64;
            if wish == SOLVER {
                of.left.put(lane, start + place(0), begun.pair);
            }
            if wish == ON {
                on.put(lane, start_on + place(1), begun.pair);
            }
            if wish == ADVANCES {
                of.begun.put(lane, start_last + place(2), begun);
            }
            lane.meet();
        });
        base += share.step;
    }
}
