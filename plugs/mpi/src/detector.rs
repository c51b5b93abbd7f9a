//! One scene over ranks, which answers queries step after step.

use crate::answer::RankAnswer;
use crate::boxes::{Bounds, Tree};
use crate::bytes::{Reader, Writer};
use crate::chunks::{self, Chunk};
use crate::error::{RankError, refused};
use crate::ghosts::{self, Ghosts, Outbox, may_meet};
use crate::local::{Local, Parts};
use crate::numbers::{self, Features};
use crate::piece::Piece;
use crate::plant::Fault;
use crate::question;
use crate::ranks::{Purpose, Ranks};
use crate::rows::{self, Keep, Row};
use crate::setup;
use mpi::collective::SystemOperation;
use nearmiss::contacts::{Rows, Status};
use nearmiss::scene::{Motion, Scene};
use nearmiss::{Device, Discrete, Error, Query};

/// One scene over the ranks of MPI. Each rank owns [pieces](Piece) of bodies and a device. Answers
/// are those of a [`nearmiss::Detector`] with the whole scene, to the bit.
///
/// All calls are collective: every rank makes them, in the same order and with the same query. An
/// error of one rank, or its panic, is returned by all.
pub struct RankDetector<'a> {
    ranks: &'a Ranks,
    device: Device,
    pieces: Vec<Piece>,
    features: Vec<Features>,
    chunks: Vec<Chunk>,
    /// Default tolerance of each whole body.
    tolerances: Vec<f64>,
    left_out: Vec<[usize; 2]>,
    /// To each rank.
    outboxes: Vec<Outbox>,
    /// Triangles of each rank.
    ghosts: Vec<Vec<Ghosts>>,
    local: Option<Local>,
    /// Distance for which triangles were exchanged since the last update.
    reach: Option<f64>,
    /// Whether the last update named bodies, but none with two ends.
    lacks_ends: bool,
    fault: Option<Fault>,
}

impl<'a> RankDetector<'a> {
    /// A detector of these pieces, one of every body. `left_out` are pairs of bodies that are not
    /// tested, as of [`Scene::leave_out`]; they are the same on all ranks.
    ///
    /// # Errors
    /// If ranks differ in bodies or pairs, if a triangle is owned by no rank or by two, and if ranks
    /// need a default tolerance that their sums do not determine.
    pub fn new(
        ranks: &'a Ranks,
        device: Device,
        pieces: Vec<Piece>,
        left_out: &[[usize; 2]],
    ) -> Result<RankDetector<'a>, RankError> {
        let mut left_out: Vec<[usize; 2]> = left_out.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        left_out.sort_unstable();
        left_out.dedup();
        setup::agree(ranks, &pieces, &left_out)?;
        let tolerances = setup::tolerances(ranks, &pieces)?;
        let features = numbers::features(ranks, &pieces)?;
        let chunks = || pieces.iter().enumerate().flat_map(|(at, piece)| chunks::of_piece(at, &piece.body));
        let chunks = ranks.run(|| Ok(chunks().collect()))?;
        Ok(RankDetector {
            ranks,
            device,
            pieces,
            features,
            chunks,
            tolerances,
            left_out,
            outboxes: (0..ranks.count()).map(|_| Outbox::default()).collect(),
            ghosts: (0..ranks.count()).map(|_| Vec::new()).collect(),
            local: None,
            reach: None,
            lacks_ends: false,
            fault: None,
        })
    }

    /// Plants a fault, for tests.
    #[doc(hidden)]
    pub fn plant(&mut self, fault: Option<Fault>) {
        self.fault = fault;
        self.forget();
    }

    /// The piece of each body that this rank owns, at its current positions.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Triangles of other ranks that this one has for the last query.
    pub fn ghost_count(&self) -> usize {
        self.ghosts.iter().flatten().map(|ghosts| ghosts.faces.len()).sum()
    }

    /// Moves bodies, by their numbers: the vertices of this rank's pieces. A body that no rank names
    /// rests where it is, or where its step ended. A rigid body has the same motion on each rank that
    /// has a part of it.
    ///
    /// # Errors
    /// As of [`nearmiss::Detector::update`], on any rank; then nothing has moved on any.
    pub fn update(&mut self, motions: &[(usize, Motion)]) -> Result<(), RankError> {
        let pieces = &self.pieces;
        self.ranks.run(|| setup::check_motions(pieces, motions))?;
        let has_ends =
            motions.iter().any(|(_, motion)| matches!(motion, Motion::Step(_) | Motion::PoseStep(_)));
        let [names, has_ends] =
            self.ranks.reduced([u64::from(!motions.is_empty()), has_ends.into()], SystemOperation::max());
        self.lacks_ends = names == 1 && has_ends == 0;
        self.reach = None;
        let moved = self.pieces.iter_mut().enumerate().try_for_each(|(body, piece)| {
            match motions.iter().find(|(named, _)| *named == body) {
                Some((_, motion)) => piece.put(*motion),
                None => piece.rest(),
            }
        });
        self.ranks.agree(moved)
    }

    /// Moves bodies by motions of the whole, of which this rank takes its part.
    ///
    /// # Errors
    /// As of [`RankDetector::update`].
    pub fn update_whole(&mut self, motions: &[(usize, Motion)]) -> Result<(), RankError> {
        let pieces = &self.pieces;
        let parts = self.ranks.run(|| {
            motions
                .iter()
                .map(|(body, motion)| setup::part_of(pieces, *body, motion))
                .collect::<Result<Vec<_>, _>>()
        })?;
        let parts: Vec<_> = parts.iter().map(|(body, part)| (*body, part.motion())).collect();
        self.update(&parts)
    }

    /// Queries the bodies at their current positions: discrete, continuous, earliest or near. Rows
    /// stay on the rank that found them.
    ///
    /// # Errors
    /// As of [`nearmiss::Detector::query`], on any rank. Also for other queries, for solvers that can
    /// be wrong or whose iterations are limited, and if ranks differ in the query or in the positions
    /// of a shared vertex.
    pub fn query(&mut self, query: impl Into<Query>) -> Result<RankAnswer, RankError> {
        let query = query.into();
        let answered = self.answer(&query);
        if answered.is_err() {
            self.forget();
        }
        answered
    }

    fn answer(&mut self, query: &Query) -> Result<RankAnswer, RankError> {
        question::same(self.ranks, query)?;
        let pieces = &self.pieces;
        self.ranks.run(|| question::check(query, pieces, self.lacks_ends))?;
        let reach = question::reach(query, &self.tolerances);
        if self.reach.is_none_or(|exchanged| exchanged < reach) {
            self.exchange(reach)?;
            self.reach = Some(reach);
        }
        let keep = if self.fault == Some(Fault::RowsKeptTwice) { Keep::All } else { Keep::Owned };
        let (local, fault) = (&mut self.local, self.fault);
        let (rows, starts, undecided) = self.ranks.run(|| {
            if fault == Some(Fault::Panic) {
                panic!("planted");
            }
            let local = local.as_mut().ok_or_else(|| refused("a rank without a scene", "report it"))?;
            let starts = match query.checks_start() {
                false => 0,
                true => {
                    let pairs = local.detector.query(&Discrete::default())?;
                    rows::kept(&pairs, &local.bodies, keep).len() as u64
                }
            };
            let found = local.detector.query(&question::without_start(query))?;
            let rows = match &found.rows {
                Rows::Pairs(rows) => Rows::Pairs(rows::kept(rows, &local.bodies, keep).into()),
                Rows::Contacts(rows) => Rows::Contacts(rows::kept(rows, &local.bodies, keep).into()),
                Rows::Near(rows) => Rows::Near(rows::kept(rows, &local.bodies, keep).into()),
                // Every contact of a part is one of the whole.
                other => other.clone(),
            };
            let is_undecided = |row: &&nearmiss::Contact| row.status == Status::Undecided;
            let undecided = match &rows {
                Rows::Contacts(rows) => rows.iter().filter(is_undecided).count() as u64,
                Rows::Earliest(_) => found.undecided,
                _ => 0,
            };
            Ok((rows, starts, undecided))
        })?;
        let (rows, count, undecided) = match rows {
            Rows::Earliest(toi) => self.earliest(toi, undecided),
            rows => {
                let sums = self.ranks.reduced([rows.len() as u64, undecided], SystemOperation::sum());
                (rows, sums[0], sums[1])
            }
        };
        let [starts] = self.ranks.reduced([starts], SystemOperation::sum());
        let starts_crossing = query.checks_start().then_some(starts);
        Ok(RankAnswer { rows, query: *query, count, starts_crossing, undecided })
    }

    /// Returns the earliest time of all ranks, and whether it is that of an undecided pair alone.
    fn earliest(&self, toi: Option<f64>, undecided: u64) -> (Rows, u64, u64) {
        // Bits of numbers from 0 on are in their order.
        let bits = toi.map_or(u64::MAX, f64::to_bits);
        let [least] = self.ranks.reduced([bits], SystemOperation::min());
        let own = if bits == least { undecided } else { 1 };
        let [undecided] = self.ranks.reduced([own], SystemOperation::min());
        let toi = (least != u64::MAX).then(|| f64::from_bits(least));
        (Rows::Earliest(toi), toi.iter().len() as u64, if toi.is_some() { undecided } else { 0 })
    }

    /// Gathers the rows of all ranks on rank 0, in canonical order; `None` on the others.
    ///
    /// # Errors
    /// If they do not fit into the memory of rank 0.
    pub fn gather(&self, answer: &RankAnswer) -> Result<Option<RankAnswer>, RankError> {
        let rows = match &answer.rows {
            Rows::Pairs(rows) => self.gathered(rows)?.map(|rows| Rows::Pairs(rows.into())),
            Rows::Contacts(rows) => self.gathered(rows)?.map(|rows| Rows::Contacts(rows.into())),
            Rows::Near(rows) => self.gathered(rows)?.map(|rows| Rows::Near(rows.into())),
            other => (self.ranks.rank() == 0).then(|| other.clone()),
        };
        Ok(rows.map(|rows| RankAnswer { rows, ..answer.clone() }))
    }

    fn gathered<T: Row>(&self, rows: &[T]) -> Result<Option<Vec<T>>, RankError> {
        let packed: Vec<T::Packed> = rows.iter().map(Row::pack).collect();
        let mut messages = vec![Vec::new(); self.ranks.count()];
        let mut message = Writer::default();
        message.put(&packed);
        messages[0] = message.0;
        let all = self.ranks.exchange(&messages, Purpose::Answers)?;
        let scene = self.local.as_ref().map(|local| local.detector.scene());
        self.ranks.run(|| {
            if self.ranks.rank() > 0 {
                return Ok(None);
            }
            let scene = scene.ok_or_else(|| refused("rows to gather are of no query", "query before"))?;
            let each = all.iter().flat_map(|message| Reader(message).take::<T::Packed>());
            let mut rows: Vec<T> = each.filter_map(|packed| T::unpack(&packed, scene)).collect();
            rows.sort_by_key(Row::key);
            Ok(Some(rows))
        })
    }

    /// Exchanges boxes, then triangles that may come within `reach` of those of others.
    fn exchange(&mut self, reach: f64) -> Result<(), RankError> {
        let (ranks, own) = (self.ranks, self.ranks.rank());
        let grown = if self.fault == Some(Fault::BoxesNotGrown) { 0.0 } else { reach };
        let bounds = ranks.run(|| Ok(chunks::bounds(|at| &self.pieces[at].body, &self.chunks, grown)))?;
        let whole = bounds.iter().copied().fold(Bounds::NOTHING, Bounds::union);
        let wholes: Vec<Bounds> = ranks
            .gathered(whole.0.as_flattened(), Purpose::Boxes)
            .chunks(6)
            .map(|x| Bounds([[x[0], x[1], x[2]], [x[3], x[4], x[5]]]))
            .collect();
        let meeting = |rank: usize| {
            let meets = wholes[rank].meets(&whole);
            (0..self.chunks.len()).filter(move |_| meets).filter({
                let (bounds, wholes) = (&bounds, &wholes);
                move |&chunk| bounds[chunk].meets(&wholes[rank])
            })
        };
        let boxes = |rank: usize| {
            let mut message = Writer::default();
            if rank != own && ghosts::tests(own, rank) {
                let chunks: Vec<usize> = meeting(rank).collect();
                message.put(&chunks.iter().map(|&chunk| self.chunks[chunk].body as u32).collect::<Vec<_>>());
                message.put(&chunks.iter().map(|&chunk| bounds[chunk]).collect::<Vec<_>>());
            }
            message.0
        };
        let boxes: Vec<Vec<u8>> = (0..ranks.count()).map(boxes).collect();
        let boxes = ranks.exchange(&boxes, Purpose::Boxes)?;
        let mut needed: Vec<Vec<u32>> = Vec::new();
        for (rank, message) in boxes.iter().enumerate() {
            let mut reader = Reader(message);
            let (bodies, tree) = (reader.take::<u32>(), Tree::new(reader.take()));
            let meets = |chunk: &usize| {
                let body = self.chunks[*chunk].body;
                let accepts = |at: usize| may_meet(&self.pieces, &self.left_out, body, bodies[at] as usize);
                tree.has(&bounds[*chunk], accepts)
            };
            needed.push(meeting(rank).filter(meets).map(|chunk| chunk as u32).collect());
        }
        if self.fault == Some(Fault::ChunkNotSent) {
            needed.iter_mut().find(|chunks| !chunks.is_empty()).map(Vec::pop);
        }
        let (pieces, features, chunks) = (&self.pieces, &self.features, &self.chunks);
        let messages = self.outboxes.iter_mut().zip(needed);
        let messages: Vec<Vec<u8>> =
            messages.map(|(outbox, needed)| outbox.message(needed, chunks, (pieces, features))).collect();
        let messages = ranks.exchange(&messages, Purpose::Ghosts)?;
        let mut is_new = false;
        for (message, ghosts) in messages.iter().zip(&mut self.ghosts) {
            is_new |= ghosts::receive(message, ghosts);
        }
        let parts = Parts {
            pieces: &self.pieces,
            features: &self.features,
            ghosts: &self.ghosts,
            tolerances: &self.tolerances,
            left_out: &self.left_out,
            moves: !self.lacks_ends,
        };
        let (local, device) = (&mut self.local, &self.device);
        ranks.run(|| match local {
            Some(local) if !is_new => local.update(&parts),
            _ => {
                // The old scene's memory goes first.
                *local = None;
                *local = Some(Local::new(device, &parts)?);
                Ok(())
            }
        })
    }

    /// Forgets what was exchanged, after an error; the next query exchanges all.
    fn forget(&mut self) {
        self.outboxes.iter_mut().for_each(|outbox| *outbox = Outbox::default());
        self.ghosts.iter_mut().for_each(Vec::clear);
        (self.local, self.reach) = (None, None);
    }
}

/// Refuses what ranks do not share, of a scene.
pub(crate) fn check_scene(scene: &Scene) -> Result<(), Error> {
    let ids: Vec<_> = scene.ids().collect();
    let excludes = ids.iter().any(|&id| scene.exclusions(id).is_some())
        || ids.iter().any(|&a| ids.iter().any(|&b| a <= b && !scene.excluded_pairs([a, b]).is_empty()));
    if excludes {
        return Err(refused("the scene excludes features, which ranks do not share", "use one machine"));
    }
    if ids.len() < scene.bodies().len() {
        return Err(refused("bodies were removed from the scene", "make a scene of the others"));
    }
    Ok(())
}
