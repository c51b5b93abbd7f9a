//! # Touching: pairs of tiles → pairs of bodies that share a point, and undecided candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation and its word; otherwise as [`super::triangles`]; placed vertices.
//! Writes   words of relations; candidates that signs in f64 do not decide.
//! Before   relations and pairs of tiles are listed. Words are 0, and so is the first pair.
//! After    a word is not 0 ⇒ the bodies of its relation share a point.
//!          Bodies that share a point, with a word that is 0, have a candidate that shares a point.
//!          With `only_first` both hold of the first such bodies: a pair behind a known one is
//!          skipped, the first never.
//!          Which candidates are listed depends on the schedule.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     an atomic load a pair of tiles. It ends there if its bodies are known to share a point.

use super::triangles::{LANES, Take, triangles};
use crate::abi::{Candidate, InstancesArgs, NodePair, TouchingArgs, counter};
use crate::bvh::placing::{APART, MEET, Signs, key, triangles_of};
use crate::exec::{Block, Lane, OPEN, Shared, Slot};

/// Shared memory of a block: that of `triangles`, and a word.
pub const SHARED: u32 = super::triangles::SHARED + 16;

/// Decides triangles at once, until two share a point.
struct Decide<'a, B: Block> {
    args: &'a TouchingArgs,
    word: Shared<u32>,
    meets: B::Slot<bool>,
    left: B::Slot<Option<u32>>,
    places: B::Slot<u32>,
}

impl<B: Block> Take<B> for Decide<'_, B> {
    fn is_over(&mut self, block: &mut B, relation: u32, bodies: [u32; 2]) -> bool {
        let args = self.args;
        block.phase(|lane| {
            if lane.lane() == 0 {
                let known = lane.fetch_load(args.words.touching, relation) != 0;
                let behind = (args.only_first != 0)
                    && args.of.counters.look(lane, counter::FIRST_BODIES) > key(bodies[0], bodies[1]);
                lane.put(self.word, 0, (known | behind) as u32);
            }
            lane.meet();
        });
        block.peek(self.word, 0) != 0
    }

    fn take(
        &mut self,
        block: &mut B,
        args: &InstancesArgs,
        (number, bodies, tiles): (u32, [u32; 2], NodePair),
        found: Shared<u32>,
        fits: u32,
    ) {
        let (tables, first, words) = (&args.tables, self.args.only_first != 0, self.args.words);
        let mut at = 0;
        while at < fits {
            block.map_rows(
                &Signs,
                |lane| (at + lane.lane() < fits).then(|| lane.get(found, at + lane.lane())),
                |lane, word| {
                    let [p, q] = triangles_of(bodies, &tiles, Candidate::of_word(word));
                    Some([p.corners(lane, tables), q.corners(lane, tables)])
                },
                |lane, result| {
                    let verdict = result.map_or(APART, |(_, verdict)| verdict);
                    *self.meets.of(lane) = verdict == MEET;
                    let left = result.and_then(|(word, _)| (verdict == OPEN).then_some(word));
                    *self.places.of(lane) = left.is_some() as u32;
                    *self.left.of(lane) = left;
                    lane.meet();
                },
            );
            if block.any(&mut self.meets) {
                block.phase(|lane| {
                    if lane.lane() == 0 {
                        lane.fetch_max(words.touching, tiles.relation, 1);
                        if first {
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

/// Bodies that share a point, and candidates that signs do not decide.
pub fn touching<B: Block>(block: &mut B, args: &TouchingArgs) {
    let word = block.shared::<u32>(4);
    let mut decide =
        Decide { args, word, meets: block.slot(false), left: block.slot(None), places: block.slot(0) };
    triangles(block, &args.of, args.of.relations, &mut decide);
}
