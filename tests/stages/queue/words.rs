//! The words by which blocks that steal find each other.

use nearmiss_kernels::abi::control::{Counts, MOST_BLOCKS, MOST_OFFERS, MOST_PLACES, OFFER, TICKET, WORK};
use nearmiss_kernels::abi::pool;

fn counts(tickets: u32, offers: u32, work: u32) -> Counts {
    Counts { tickets, offers, work }
}

#[test]
fn the_first_ticket_is_for_the_roots() {
    assert_eq!(Counts::of(0), counts(0, 0, 1));
    // Block 0 has the roots, two others wait; it serves one, and runs dry.
    let waiting = 3 * TICKET;
    assert_eq!((Counts::of(waiting), Counts::of(waiting).waiting()), (counts(3, 0, 1), 2));
    let served = waiting + OFFER + WORK;
    assert_eq!((Counts::of(served), Counts::of(served).waiting()), (counts(3, 1, 2), 1));
    let dry = served.wrapping_add(TICKET.wrapping_sub(WORK));
    assert_eq!(Counts::of(dry), counts(4, 1, 1));
    let over = dry.wrapping_add(TICKET.wrapping_sub(WORK));
    assert_eq!((Counts::of(over), Counts::of(over).all_drawn()), (counts(5, 1, 0), true));
    // Chunks that no block requested: the places have no tickets yet.
    let eager = TICKET + 2 * (OFFER + WORK);
    assert_eq!((Counts::of(eager), Counts::of(eager).waiting()), (counts(1, 2, 3), 0));
    assert!(!Counts::of(eager).all_drawn() && Counts::of(eager + 2 * TICKET).all_drawn());
}

#[test]
fn no_count_leaves_its_bits() {
    let (tickets, offers) = (1 + MOST_PLACES + MOST_BLOCKS, MOST_PLACES + MOST_BLOCKS * MOST_OFFERS);
    let work = MOST_BLOCKS + offers;
    // Counted from one, so one less is in the word.
    let word = tickets as u64 * TICKET + offers as u64 * OFFER + (work - 1) as u64 * WORK;
    assert_eq!(Counts::of(word), counts(tickets, offers, work));
    let without = word.wrapping_sub(work as u64 * WORK);
    assert_eq!(Counts::of(without), counts(tickets, offers, 0));
    assert!((pool::CHUNK as u64) < pool::GONE && pool::GONE <= pool::STATE);
}
