//! # Touching: pairs of tiles → pairs of bodies that share a point, and candidates left
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over runs of pairs of tiles.
//! Reads    a relation and its word; otherwise as [`super::triangles`]; placed vertices.
//! Writes   words of relations; candidates.
//! Before   relations and pairs of tiles are listed. Words are 0, and so is the first pair.
//! After    a word is not 0 ⇒ the bodies of its relation share a point.
//!          Bodies that share a point, with a word that is 0, have a candidate that shares a point.
//!          [`TouchingFlags::FIRST`]: both hold of the first such bodies. A pair behind a known one
//!          is skipped, the first never.
//!          [`TouchingFlags::KEYS`]: a word is the key of two triangles that share a point, and those
//!          are candidates. So is each pair before them that signs in f64 do not decide.
//!          Which other candidates are listed depends on the schedule.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     an atomic load a pair of tiles. It ends there if its bodies are known to share a point,
//!          or with keys, if no pair of its triangles comes before a known one: a tile knows its
//!          least number. Triangles behind the first of a known pair are no rows.

use super::triangles::{ALL, LANES, Take, triangles};
use crate::abi::{Candidate, InstanceTables, InstancesArgs, NodePair, TouchingArgs, TouchingFlags, counter};
use crate::bvh::placing::{APART, MEET, Signs, first_of, key, triangles_of};
use crate::exec::{Block, Lane, OPEN, Shared, Slot};

/// Shared memory of a block: that of `triangles`, and words.
pub const SHARED: u32 = super::triangles::SHARED + 16;
/// The key of all triangles if words are flags.
const FLAG: u64 = 1;

/// Decides triangles at once: words only until two share a point.
struct Decide<'a, B: Block> {
    args: &'a TouchingArgs,
    /// Whether a pair of tiles is over, and the largest number that matters.
    words: Shared<u32>,
    meets: B::Slot<bool>,
    left: B::Slot<Option<u32>>,
    places: B::Slot<u32>,
}

/// The key of two triangles by their numbers in the meshes.
#[inline(always)]
fn key_of<L: Lane>(lane: &L, tables: &InstanceTables, bodies: [u32; 2], numbers: [u32; 2]) -> u64 {
    let [p, q] = bodies.map(|body| lane.read(tables.bodies, body).triangle);
    key(p + numbers[0], q + numbers[1])
}

impl<B: Block> Take<B> for Decide<'_, B> {
    const RUN: u32 = 8;

    fn matters(&mut self, block: &mut B, bodies: [u32; 2], tiles: &NodePair) -> Option<u32> {
        let args = self.args;
        block.phase(|lane| {
            if lane.lane() == 0 {
                let known = lane.fetch_load(args.words.touching, tiles.relation);
                let (mut most, mut is_over) = (ALL, known != 0);
                if args.flags.has(TouchingFlags::KEYS) && known != 0 {
                    let least = [tiles.a, tiles.b].map(|tile| lane.read(args.of.tables.nodes, tile).first);
                    is_over = known > key_of(lane, &args.of.tables, bodies, least);
                    // A triangle behind that of the known pair begins no earlier pair.
                    most = first_of(known) - lane.read(args.of.tables.bodies, bodies[0]).triangle;
                }
                let behind = args.flags.has(TouchingFlags::FIRST)
                    && args.of.counters.look(lane, counter::FIRST_BODIES) > key(bodies[0], bodies[1]);
                lane.put(self.words, 0, (is_over | behind) as u32);
                lane.put(self.words, 1, most);
            }
            lane.meet();
        });
        (block.peek(self.words, 0) == 0).then(|| block.peek(self.words, 1))
    }

    fn take(
        &mut self,
        block: &mut B,
        args: &InstancesArgs,
        (number, bodies, tiles): (u32, [u32; 2], NodePair),
        found: Shared<u32>,
        fits: u32,
    ) {
        let (tables, words, has_keys) =
            (&args.tables, self.args.words, self.args.flags.has(TouchingFlags::KEYS));
        let mut at = 0;
        while at < fits {
            block.map_rows(
                &Signs,
                |lane| {
                    let word = (at + lane.lane() < fits).then(|| lane.get(found, at + lane.lane()))?;
                    if !has_keys {
                        return Some((word, FLAG));
                    }
                    let triangles = triangles_of(bodies, &tiles, Candidate::of_word(word));
                    let numbers = triangles.map(|triangle| lane.read(tables.leaves, triangle.place).number);
                    let own = key_of(lane, tables, bodies, numbers);
                    (lane.fetch_load(words.touching, tiles.relation) <= own).then_some((word, own))
                },
                |lane, (word, _)| {
                    let [p, q] = triangles_of(bodies, &tiles, Candidate::of_word(word));
                    Some([p.corners(lane, tables), q.corners(lane, tables)])
                },
                |lane, result| {
                    let ((word, own), verdict) = result.unwrap_or(((0, 0), APART));
                    let meets = verdict == MEET;
                    if has_keys & meets {
                        lane.fetch_max(words.touching, tiles.relation, own);
                    }
                    let is_left = (verdict == OPEN) | (has_keys & meets);
                    *self.meets.of(lane) = !has_keys & meets;
                    *self.places.of(lane) = is_left as u32;
                    *self.left.of(lane) = is_left.then_some(word);
                    lane.meet();
                },
            );
            if block.any(&mut self.meets) {
                block.phase(|lane| {
                    if lane.lane() == 0 {
                        lane.fetch_max(words.touching, tiles.relation, FLAG);
                        if self.args.flags.has(TouchingFlags::FIRST) {
                            args.counters.raise(lane, counter::FIRST_BODIES, key(bodies[0], bodies[1]));
                        }
                    }
                    lane.meet();
                });
                return;
            }
            let base = args.pairs.append(block, &mut self.places);
            block.phase(|lane| {
                if let Some(word) = *self.left.of(lane) {
                    let candidate = Candidate { tile_pair: number, places: Candidate::of_word(word) };
                    args.pairs.put(lane, base + *self.places.of(lane) as u64, candidate.pair());
                }
                lane.meet();
            });
            at += LANES;
        }
    }
}

/// Bodies that share a point, and candidates that are left.
pub fn touching<B: Block>(block: &mut B, args: &TouchingArgs) {
    let words = block.shared::<u32>(4);
    let mut decide =
        Decide { args, words, meets: block.slot(false), left: block.slot(None), places: block.slot(0) };
    triangles(block, &args.of, args.of.relations, &mut decide);
}
