//! The ranks of a communicator: agreement about errors, and exchanges whose bytes are counted.

use crate::error::RankError;
use mpi::collective::SystemOperation;
use mpi::datatype::{Partition, PartitionMut};
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;
use mpi::{Count, Threading};
use nearmiss::Error;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Most bytes that a rank sends, or receives, in one call of MPI, whose counts have 31 bits.
const MOST: usize = 1 << 30;

/// Purpose of bytes that cross between ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Numbers of edges, and owners of vertices and edges: once.
    Setup = 0,
    /// Bounding boxes of ranks and of chunks.
    Boxes = 1,
    /// Triangles of other ranks.
    Ghosts = 2,
    /// Rows of answers that are gathered.
    Answers = 3,
}

/// Bytes that a rank has sent to others, by purpose. Reductions of single numbers, by which ranks
/// agree, are not counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bytes {
    /// Numbers of edges, and owners of vertices and edges: once.
    pub setup: u64,
    /// Bounding boxes of ranks and of chunks.
    pub boxes: u64,
    /// Triangles of other ranks.
    pub ghosts: u64,
    /// Rows of answers that are gathered.
    pub answers: u64,
}

/// The ranks of a communicator, each a process. All calls are collective: every rank makes them in
/// the same order.
///
/// Drop it before MPI is finalised.
pub struct Ranks {
    world: SimpleCommunicator,
    sent: Cell<[u64; 4]>,
    /// Most bytes that a rank sends, or receives, in one call.
    most: usize,
}

impl Ranks {
    /// The ranks of a communicator, which is duplicated: messages of the program do not mix with
    /// those of nearmiss.
    pub fn new(world: &impl Communicator) -> Ranks {
        Ranks { world: world.duplicate(), sent: Cell::default(), most: MOST }
    }

    /// The same ranks, with another limit of bytes in one call of MPI, for tests.
    #[doc(hidden)]
    pub fn with_most(&self, most: usize) -> Ranks {
        Ranks { most, ..Ranks::new(&self.world) }
    }

    /// Number of this rank.
    pub fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    /// Number of ranks.
    pub fn count(&self) -> usize {
        self.world.size() as usize
    }

    /// Bytes that this rank has sent so far.
    pub fn sent(&self) -> Bytes {
        let [setup, boxes, ghosts, answers] = self.sent.get();
        Bytes { setup, boxes, ghosts, answers }
    }

    /// Bytes that all ranks have sent so far.
    pub fn sent_by_all(&self) -> Bytes {
        let [setup, boxes, ghosts, answers] = self.reduced(self.sent.get(), SystemOperation::sum());
        Bytes { setup, boxes, ghosts, answers }
    }

    /// Returns the results of all ranks if none failed, each on its own rank.
    ///
    /// # Errors
    /// The error of the first rank that failed, on every rank.
    pub fn agree<T>(&self, own: Result<T, Error>) -> Result<T, RankError> {
        self.agreed(own.map_err(told))
    }

    /// Runs work of this rank and agrees about it: an error and a panic end the call on every rank.
    ///
    /// # Errors
    /// As of [`Ranks::agree`].
    pub fn run<T>(&self, work: impl FnOnce() -> Result<T, Error>) -> Result<T, RankError> {
        let own = match catch_unwind(AssertUnwindSafe(work)) {
            Ok(done) => done.map_err(told),
            Err(panic) => {
                let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
                let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
                Err((format!("panicked: {text}"), PANIC))
            }
        };
        self.agreed(own)
    }

    fn agreed<T>(&self, own: Result<T, (String, u8)>) -> Result<T, RankError> {
        let failed = if own.is_err() { self.rank() as u64 } else { u64::MAX };
        let [first] = self.reduced([failed], SystemOperation::min());
        if first == u64::MAX {
            return own.map_err(|(text, exit_code)| RankError { rank: self.rank(), text, exit_code });
        }
        let own = own.err().unwrap_or_default();
        let mut head = [own.0.len() as u64, own.1.into()];
        let process = self.world.process_at_rank(first as i32);
        process.broadcast_into(&mut head[..]);
        let mut text = if first as usize == self.rank() { own.0.into_bytes() } else { Vec::new() };
        text.resize(head[0] as usize, 0);
        process.broadcast_into(&mut text[..]);
        let text = String::from_utf8_lossy(&text).into_owned();
        Err(RankError { rank: first as usize, text, exit_code: head[1] as u8 })
    }

    /// Returns a reduction of each number over all ranks.
    pub(crate) fn reduced<const N: usize>(&self, own: [u64; N], by: SystemOperation) -> [u64; N] {
        let mut all = [0; N];
        self.world.all_reduce_into(&own[..], &mut all[..], by);
        all
    }

    /// Returns the numbers of every rank, in the order of the ranks. Each rank has as many.
    pub(crate) fn gathered<T: Equivalence + Copy + Default>(&self, own: &[T], why: Purpose) -> Vec<T> {
        let mut all = vec![T::default(); own.len() * self.count()];
        self.world.all_gather_into(own, &mut all[..]);
        self.add(why, size_of_val(own) * (self.count() - 1));
        all
    }

    /// Sends a message to each rank, and returns that of each rank.
    ///
    /// # Errors
    /// If the messages do not fit into the memory of a rank.
    pub(crate) fn exchange(&self, to: &[Vec<u8>], why: Purpose) -> Result<Vec<Vec<u8>>, RankError> {
        let lengths: Vec<u64> = to.iter().map(|message| message.len() as u64).collect();
        let mut coming = vec![0u64; self.count()];
        self.world.all_to_all_into(&lengths[..], &mut coming[..]);
        let mut from: Vec<Vec<u8>> = vec![Vec::new(); self.count()];
        let reserved = from.iter_mut().zip(&coming).try_for_each(|(message, &length)| {
            let memory =
                |_| Error::OutOfMemory { what: "messages of other ranks".into(), asked: length, given: 0 };
            message.try_reserve_exact(length as usize).map_err(memory)
        });
        self.agree(reserved)?;
        let own = self.rank();
        self.add(
            why,
            lengths.iter().enumerate().filter(|(to, _)| *to != own).map(|(_, n)| *n as usize).sum(),
        );
        let piece = (self.most / self.count()).max(1);
        let longest = lengths.iter().chain(&coming).copied().max().unwrap_or(0);
        let [longest] = self.reduced([longest], SystemOperation::max());
        for first in (0..longest as usize).step_by(piece) {
            let part = |length: usize| first.min(length)..(first + piece).min(length);
            let out: Vec<&[u8]> = to.iter().map(|message| &message[part(message.len())]).collect();
            let (counts, starts) = layout(out.iter().map(|piece| piece.len()));
            // A byte more: the address of an empty list of bytes is 1, which OpenMPI reads as
            // MPI_IN_PLACE.
            let mut out = out.concat();
            out.push(0);
            let (coming, places) = layout(coming.iter().map(|&length| part(length as usize).len()));
            let mut all = vec![0u8; coming.iter().map(|&n| n as usize).sum::<usize>() + 1];
            let mut into = PartitionMut::new(&mut all[..], &coming[..], &places[..]);
            self.world.all_to_all_varcount_into(&Partition::new(&out[..], counts, starts), &mut into);
            for (message, (&count, &at)) in from.iter_mut().zip(coming.iter().zip(&places)) {
                message.extend_from_slice(&all[at as usize..(at + count) as usize]);
            }
        }
        Ok(from)
    }

    fn add(&self, why: Purpose, bytes: usize) {
        let mut sent = self.sent.get();
        sent[why as usize] += bytes as u64;
        self.sent.set(sent);
    }
}

/// The text of an error, and its exit status.
fn told(error: Error) -> (String, u8) {
    (error.to_string(), error.exit_code())
}

/// Exit status of a program after a panic, as of [`Error::Bug`].
const PANIC: u8 = 4;

/// Counts of parts, and where each begins.
fn layout(lengths: impl Iterator<Item = usize>) -> (Vec<Count>, Vec<Count>) {
    let counts: Vec<Count> = lengths.map(|n| n as Count).collect();
    let mut next = 0;
    let start = |count: &Count| {
        next += count;
        next - count
    };
    let starts = counts.iter().map(start).collect();
    (counts, starts)
}

/// Runs a program on all ranks of MPI and returns its exit status. MPI is initialised, and
/// finalised at the end.
///
/// An error that all ranks return is printed once, by rank 0. A panic of a rank outside of
/// [`Ranks::run`] ends all ranks by `MPI_Abort`: the others could be within a call that needs it.
pub fn program(main: impl FnOnce(&Ranks) -> Result<(), RankError>) -> u8 {
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        eprintln!("MPI is initialised already; call the program once");
        return 2;
    };
    let ranks = Ranks::new(&universe.world());
    match catch_unwind(AssertUnwindSafe(|| main(&ranks))) {
        Ok(Ok(())) => 0,
        Ok(Err(error)) => {
            if ranks.rank() == 0 {
                eprintln!("{error}");
            }
            error.exit_code
        }
        Err(_) => {
            eprintln!("rank {}: panicked outside of the library; all ranks end", ranks.rank());
            ranks.world.abort(PANIC.into())
        }
    }
}
