//! Memory of blocks, which a thread keeps from one block to the next.

use crate::columns::Columns;
use std::cell::RefCell;
use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};

/// Unit of a piece: its alignment is that of a piece.
type Unit = MaybeUninit<u128>;

/// Memory that a thread keeps.
#[allow(clippy::vec_box, reason = "a move of the memory itself would copy its columns")]
#[derive(Default)]
struct Kept {
    pieces: Vec<Vec<Unit>>,
    on_chip: Vec<Box<Memory>>,
}

thread_local! {
    static KEPT: RefCell<Kept> = const { RefCell::new(Kept { pieces: Vec::new(), on_chip: Vec::new() }) };
}

/// Most pieces that a thread keeps. More than the slots of any kernel.
const MOST: usize = 64;

/// Memory with any content, aligned to 16 bytes.
pub struct Piece(Vec<Unit>);

impl Piece {
    /// Alignment of a piece.
    pub const ALIGN: usize = align_of::<Unit>();

    /// A piece of at least so many bytes.
    pub fn new(bytes: usize) -> Piece {
        // A thread that ends keeps nothing.
        let kept = KEPT.try_with(|kept| kept.borrow_mut().pieces.pop()).ok().flatten();
        let (mut memory, units) = (kept.unwrap_or_default(), bytes.div_ceil(size_of::<Unit>()));
        if memory.len() < units {
            memory.resize(units, Unit::uninit());
        }
        Piece(memory)
    }

    /// The first byte.
    #[inline(always)]
    pub fn start(&mut self) -> *mut u8 {
        self.0.as_mut_ptr().cast()
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        let memory = std::mem::take(&mut self.0);
        let keep = |kept: &RefCell<Kept>| {
            let pieces = &mut kept.borrow_mut().pieces;
            if pieces.len() < MOST {
                pieces.push(memory);
            }
        };
        let _ = KEPT.try_with(keep);
    }
}

/// The memory of a block that is no slot.
#[derive(Default)]
pub struct Memory {
    /// Shared memory: words that no lane of the block has written have any value, as on a GPU.
    pub words: Vec<u64>,
    /// Memory for rows.
    pub rows: Vec<u64>,
    /// Memory for columns.
    pub columns: Columns,
}

/// Words of a block that begins, in debug builds.
pub const NONSENSE: u64 = 0xbadb_adba_dbad_badb;

/// The memory of a block, in use.
pub struct OnChip(Option<Box<Memory>>);

impl OnChip {
    /// Memory with any content; in debug builds with words that are no sensible ones.
    pub fn new() -> OnChip {
        let kept = KEPT.try_with(|kept| kept.borrow_mut().on_chip.pop()).ok().flatten();
        let mut memory = kept.unwrap_or_default();
        if cfg!(debug_assertions) {
            memory.words.fill(NONSENSE);
        }
        OnChip(Some(memory))
    }
}

impl Deref for OnChip {
    type Target = Memory;
    #[inline(always)]
    fn deref(&self) -> &Memory {
        self.0.as_ref().expect("there until it is dropped")
    }
}

impl DerefMut for OnChip {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Memory {
        self.0.as_mut().expect("there until it is dropped")
    }
}

impl Drop for OnChip {
    fn drop(&mut self) {
        let memory = self.0.take();
        let _ = KEPT.try_with(|kept| kept.borrow_mut().on_chip.extend(memory));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_used_again_and_is_large_enough() {
        let mut first = Piece::new(40);
        let at = first.start() as usize;
        drop(first);
        let (mut again, mut other) = (Piece::new(48), Piece::new(1));
        assert_eq!(again.start() as usize, at, "the same memory");
        assert_ne!(other.start() as usize, at, "which is in use");
        for bytes in [0, 1, 16, 17, 100_000] {
            let mut piece = Piece::new(bytes);
            assert!(piece.0.len() * size_of::<Unit>() >= bytes);
            assert!((piece.start() as usize).is_multiple_of(Piece::ALIGN));
        }
    }

    #[test]
    fn a_block_begins_with_words_that_are_no_sensible_ones() {
        let mut first = OnChip::new();
        first.words.resize(10, 7);
        drop(first);
        let next = OnChip::new();
        let is_kept = if cfg!(debug_assertions) { NONSENSE } else { 7 };
        assert_eq!(next.words[..10], [is_kept; 10]);
    }
}
