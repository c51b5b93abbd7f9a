//! # Abreast: pairs that may come within a separation, in f32 → proven contacts; the rest, for f64
//! Paper    not in the paper.
//! Launch   as many blocks as are resident, both kinds of pairs in one launch. Advancements differ
//!          in length. So a block keeps more pairs under way than it has lanes. Each turn takes
//!          one a lane, those that have waited longest, and all lanes do the same.
//!          A block's pairs are eight together, then a grid of such groups apart.
//!          Pairs of vertices with different radii have a kernel of their own, [`part`]. It only parts
//!          pairs, by the separation and the largest radius of each pair.
//!          A query of what approaches has two launches at the same time, over the two lists that
//!          [`super::approach`] leaves. The larger one has a block less on each processor.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies,
//!          if they differ; radii, with such vertices.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest. The rest, in its own
//!          list, each with the time before which it is certainly farther apart. [`part`] only
//!          the rest.
//! Before   pairs are complete.
//! After    {pairs that come within the separation} ⊆ listed ∪ begun; no time is late. See
//!          [`crate::prim::isolate::advance`].
//!          With radii: {pairs that come within the separation and both radii} ⊆ begun. No point of
//!          a pair has more than its largest radius, so pairs and times that are proven for it are
//!          proven.
//! Room     hits, begun: counted past the end, grown, run again. Pairs under way: new ones are taken
//!          up only as there is room.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered). 200 B on chip for a pair under way.
//!          600 operations to take up a pair, 600 a turn. Half of the pairs end in the first, most
//!          others in two to fifteen.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, radii_of_edges, radii_of_face, vertex_face};
use crate::abi::{Begun, Pair, RungArgs, ThickRungArgs};
use crate::exec::{Block, Lane, Shared};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::Params;
use crate::prim::isolate::advance::{Advanced, Distance, Progress};
use crate::prim::isolate::hull::Hull;
use crate::prim::isolate::normal::{NUMBERS, Normal};
use crate::prim::isolate::separation::{NO_TIME, Single, proven, verdict};
use crate::prim::isolate::{Edges, Face};

/// Words of eight bytes of a pair under way.
const WORDS: u32 = 25;
/// The first word of each part: control vectors, 12 words; what a step needs; the normal.
const LIMITS: u32 = 12;
const NORMAL: u32 = 17;
/// The pair's indices.
const INDICES: u32 = 24;
/// Neighbours in the list that one block takes: near each other, so that they share vertices.
const GROUP: u64 = 8;
/// Pairs are taken up in whole warps.
const WARP: u32 = 32;

/// Pairs of a block that may be under way, for each two lanes.
const ROOM: u32 = 3;

/// Turns of a block that the order of places has entries for: pairs that wait, and those that a
/// turn appends while it reads.
const TURNS: u32 = 4;

const fn room(lanes: u32) -> u32 {
    ROOM * lanes / 2
}

/// Bytes of shared memory of a block: pairs under way, their order, and free places.
pub const fn shared_bytes(lanes: u32) -> u32 {
    room(lanes) * (8 * WORDS + 4) + 4 * TURNS * lanes + 8
}

/// The arguments of a kernel, and what it does with a pair.
trait Abreast<R: Real, L: Lane> {
    /// Whether it only parts pairs, and leaves all others.
    const PARTS: bool;
    /// Arguments of every rung.
    fn rung(&self) -> &RungArgs<R>;
    /// Parameters of a vertex and a face.
    fn of_face(&self, lane: &L, pair: Pair) -> Params;
    /// Parameters of two edges.
    fn of_edges(&self, lane: &L, pair: Pair) -> Params;
}

impl<R: Real, L: Lane> Abreast<R, L> for RungArgs<R> {
    const PARTS: bool = false;
    #[inline(always)]
    fn rung(&self) -> &RungArgs<R> {
        self
    }
    #[inline(always)]
    fn of_face(&self, lane: &L, pair: Pair) -> Params {
        of_vertex_face(lane, self, pair)
    }
    #[inline(always)]
    fn of_edges(&self, lane: &L, pair: Pair) -> Params {
        of_edge_edge(lane, self, pair)
    }
}

impl<R: Real, L: Lane> Abreast<R, L> for ThickRungArgs<R> {
    const PARTS: bool = true;
    #[inline(always)]
    fn rung(&self) -> &RungArgs<R> {
        &self.rung
    }
    #[inline(always)]
    fn of_face(&self, lane: &L, pair: Pair) -> Params {
        let radii = radii_of_face(lane, self.radii, self.rung.faces, pair);
        of_largest(of_vertex_face(lane, &self.rung, pair), &self.rung.params, radii)
    }
    #[inline(always)]
    fn of_edges(&self, lane: &L, pair: Pair) -> Params {
        let radii = radii_of_edges(lane, self.radii, self.rung.edges, pair);
        of_largest(of_edge_edge(lane, &self.rung, pair), &self.rung.params, radii)
    }
}

/// Parameters of a pair whose separation is that of the query, and the largest radius of a control
/// vector.
#[inline(always)]
fn of_largest(of_bodies: Params, query: &Params, [a, b, c, d]: [f64; 4]) -> Params {
    let largest = a.greater(b).greater(c.greater(d));
    Params { min_separation: query.min_separation + largest, ..of_bodies }
}

/// All pairs of both lists.
#[inline(always)]
pub fn abreast<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    each::<R, B, RungArgs<R>>(block, args);
}

/// All pairs of both lists, of vertices with different radii: only parts them.
#[inline(always)]
pub fn part<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    each::<R, B, ThickRungArgs<R>>(block, args);
}

#[inline(always)]
fn each<R: Real, B: Block, A: Abreast<R, B::Lane>>(block: &mut B, of_kernel: &A) {
    let args = of_kernel.rung();
    let (lanes, blocks, number) = (block.lanes(), block.blocks() as u64, block.block() as u64);
    let count_vf = args.vf.pairs.listed(block);
    let count = count_vf as u64 + args.ee.pairs.listed(block) as u64;
    let mut line = Line::new(block);
    // The pairs of this block, and how many of them were taken up.
    let (groups, rest) = (count / GROUP, count % GROUP);
    let own_groups = (groups + blocks - 1 - number) / blocks;
    let own = own_groups * GROUP + if groups % blocks == number { rest } else { 0 };
    let mut begun = 0;
    loop {
        let left = own - begun;
        if left > 0 && line.waiting() < lanes {
            // Some, if none waits: then all places are free, and there are more than lanes.
            let unit = WARP.min(lanes);
            let some = (line.free / unit * unit).min(lanes).min(left.min(lanes as u64) as u32);
            block.phase(|lane| {
                if lane.lane() < some {
                    let of_block = begun + lane.lane() as u64;
                    let i = (of_block / GROUP * blocks + number) * GROUP + of_block % GROUP;
                    let place = line.begin(lane, some);
                    if i < count_vf as u64 {
                        let pair = args.vf.pairs.get(lane, i as u32);
                        let p = of_kernel.of_face(lane, pair);
                        let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
                        let face = Face::new(v, f, &p).of_four();
                        line.put(lane, place, &Single::begin(&face, &p), &face.normal(), pair);
                    } else {
                        let pair = args.ee.pairs.get(lane, (i - count_vf as u64) as u32);
                        let p = of_kernel.of_edges(lane, pair);
                        let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
                        let edges = Edges::new(x, y, &p);
                        line.put(lane, place, &Single::begin(&edges, &p), &edges.normal(), pair);
                    }
                }
                lane.meet();
            });
            line.begun(some);
            begun += some as u64;
        }
        let some = line.waiting().min(lanes);
        if some == 0 {
            break;
        }
        block.phase(|lane| {
            let (mut under_way, mut told, mut ahead) = (None, None, None);
            if lane.lane() < some {
                let place = line.first(lane);
                let mut single = line.get(lane, place);
                match single.fixed(&args.params) {
                    Ok(end) => told = Some(end),
                    Err(rest) => ahead = Some(rest),
                }
                under_way = Some((place, single));
            }
            // Lanes come together for the second part.
            if lane.any(ahead.is_some())
                && let (Some((place, single)), Some(ahead)) = (&mut under_way, ahead)
            {
                told = single.ahead(ahead, &args.params, || line.normal(lane, *place));
            }
            if let Some((place, single)) = under_way {
                if let Some(told) = told {
                    let pair = line.pair(lane, place);
                    let known = if A::PARTS { NO_TIME } else { single.known };
                    match (verdict(told, known, &args.params), single.hull.is_face) {
                        (Some(verdict), true) => emit(lane, args, &args.vf, pair, verdict),
                        (Some(verdict), false) => emit(lane, args, &args.ee, pair, verdict),
                        (None, true) => args.vf.begun.push(lane, for_double(pair, told)),
                        (None, false) => args.ee.begun.push(lane, for_double(pair, told)),
                    }
                    line.end(lane, place);
                } else {
                    line.put_progress(lane, place, &single);
                    line.put_back(lane, place);
                }
            }
            lane.meet();
        });
        line.turned(block, some);
    }
}

/// A pair for f64, with the time that is proven.
#[inline(always)]
fn for_double(pair: Pair, told: Advanced<f32>) -> Begun {
    Begun { pair, from: proven(told).to_bits() }
}

/// The pairs under way, in shared memory: each in a place of its own, and the places in line.
struct Line {
    words: Shared<[u32; 2]>,
    places: u32,
    /// Places in the order in which pairs wait: entries from `head` to `tail`, around.
    order: Shared<u32>,
    head: u32,
    tail: u32,
    /// Places without a pair.
    spare: Shared<u32>,
    free: u32,
    /// How many places were put in line, and how many were given back, since the begin.
    counts: Shared<u32>,
    given: u32,
}

impl Line {
    fn new<B: Block>(block: &mut B) -> Self {
        let lanes = block.lanes();
        let places = room(lanes);
        let (words, order) = (block.shared(WORDS * places), block.shared(TURNS * lanes));
        let (spare, counts) = (block.shared(places), block.shared(2));
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < places {
                lane.put(spare, i, i);
                i += lanes;
            }
            if lane.lane() == 0 {
                lane.put(counts, 0, 0);
                lane.put(counts, 1, 0);
            }
            lane.meet();
        });
        Line { words, places, order, head: 0, tail: 0, spare, free: places, counts, given: 0 }
    }

    /// The number of a word of a place: those of one word are neighbours.
    #[inline(always)]
    fn word(&self, k: u32, place: u32) -> u32 {
        k * self.places + place
    }
    /// How many pairs wait.
    #[inline(always)]
    fn waiting(&self) -> u32 {
        self.tail.wrapping_sub(self.head)
    }

    /// A free place for the pair of this lane, one of `some`: at the end of the line.
    #[inline(always)]
    fn begin<L: Lane>(&self, lane: &L, some: u32) -> u32 {
        let place = lane.get(self.spare, self.free - 1 - lane.lane());
        lane.put(self.order, self.tail.wrapping_add(lane.lane()) % self.order.len, place);
        if lane.lane() == 0 {
            lane.put(self.counts, 0, self.tail.wrapping_add(some));
        }
        place
    }
    /// After so many lanes began.
    #[inline(always)]
    fn begun(&mut self, some: u32) {
        self.free -= some;
        self.tail = self.tail.wrapping_add(some);
    }
    /// The place of this lane's pair, of those that have waited longest.
    #[inline(always)]
    fn first<L: Lane>(&self, lane: &L) -> u32 {
        lane.get(self.order, self.head.wrapping_add(lane.lane()) % self.order.len)
    }
    /// Puts a place back in line.
    #[inline(always)]
    fn put_back<L: Lane>(&self, lane: &L, place: u32) {
        lane.put(self.order, lane.shared_add(self.counts, 0, 1) % self.order.len, place);
    }
    /// Gives a place back.
    #[inline(always)]
    fn end<L: Lane>(&self, lane: &L, place: u32) {
        let before = lane.shared_add(self.counts, 1, 1).wrapping_sub(self.given);
        lane.put(self.spare, self.free + before, place);
    }
    /// After so many lanes took a turn.
    #[inline(always)]
    fn turned<B: Block>(&mut self, block: &mut B, some: u32) {
        let tail = block.peek(self.counts, 0);
        let ended = some - tail.wrapping_sub(self.tail);
        (self.head, self.tail) = (self.head.wrapping_add(some), tail);
        self.free += ended;
        self.given = self.given.wrapping_add(ended);
    }

    /// Keeps a pair.
    #[inline(always)]
    fn put<L: Lane>(&self, lane: &L, place: u32, single: &Single, normal: &Normal<f32>, pair: Pair) {
        let put = |k: u32, x: [f32; 2]| lane.put(self.words, self.word(k, place), x.map(f32::to_bits));
        for k in 0..4 {
            let [a, b] = single.hull.w[k];
            put(3 * k as u32, [a[0], a[1]]);
            put(3 * k as u32 + 1, [a[2], b[0]]);
            put(3 * k as u32 + 2, [b[1], b[2]]);
        }
        let numbers = normal.numbers();
        for k in 0..NUMBERS / 2 {
            put(NORMAL + k as u32, [numbers[2 * k], numbers[2 * k + 1]]);
        }
        let Distance { over, under, slack, time_tolerance } = single.distance;
        put(LIMITS, [over, under]);
        put(LIMITS + 1, [slack, time_tolerance]);
        put(LIMITS + 2, [single.known, numbers[NUMBERS - 1]]);
        lane.put(self.words, self.word(INDICES, place), [pair.a, pair.b]);
        self.put_progress(lane, place, single);
    }
    /// Keeps how far a pair is.
    #[inline(always)]
    fn put_progress<L: Lane>(&self, lane: &L, place: u32, single: &Single) {
        let Progress { at, stride, steps, next } = single.progress;
        let state = steps << 8 | next << 1 | single.hull.is_face as u32;
        lane.put(self.words, self.word(LIMITS + 3, place), [at.to_bits(), stride.to_bits()]);
        lane.put(self.words, self.word(LIMITS + 4, place), [single.hull.reach.to_bits(), state]);
    }
    /// A pair that was kept.
    #[inline(always)]
    fn get<L: Lane>(&self, lane: &L, place: u32) -> Single {
        let get = |k: u32| lane.get(self.words, self.word(k, place)).map(f32::from_bits);
        let mut w = [[Vec3([0.0; 3]); 2]; 4];
        for (k, ends) in w.iter_mut().enumerate() {
            let ([x, y], [z, s]) = (get(3 * k as u32), get(3 * k as u32 + 1));
            let [t, u] = get(3 * k as u32 + 2);
            *ends = [Vec3([x, y, z]), Vec3([s, t, u])];
        }
        let ([over, under], [slack, time_tolerance]) = (get(LIMITS), get(LIMITS + 1));
        let ([known, _], [at, stride]) = (get(LIMITS + 2), get(LIMITS + 3));
        let [reach, state] = lane.get(self.words, self.word(LIMITS + 4, place));
        let progress = Progress { at, stride, steps: state >> 8, next: state >> 1 & 127 };
        Single {
            hull: Hull { w, reach: f32::from_bits(reach), is_face: state & 1 == 1 },
            distance: Distance { over, under, slack, time_tolerance },
            known,
            progress,
        }
    }
    /// The normal of a pair that was kept.
    #[inline(always)]
    fn normal<L: Lane>(&self, lane: &L, place: u32) -> Normal<f32> {
        let mut numbers = [0.0; NUMBERS];
        for k in 0..NUMBERS / 2 {
            let word = lane.get(self.words, self.word(NORMAL + k as u32, place)).map(f32::from_bits);
            [numbers[2 * k], numbers[2 * k + 1]] = word;
        }
        numbers[NUMBERS - 1] = f32::from_bits(lane.get(self.words, self.word(LIMITS + 2, place))[1]);
        Normal::of_numbers(numbers)
    }
    /// The indices of a pair that was kept.
    #[inline(always)]
    fn pair<L: Lane>(&self, lane: &L, place: u32) -> Pair {
        let [a, b] = lane.get(self.words, self.word(INDICES, place));
        Pair { a, b }
    }
}
