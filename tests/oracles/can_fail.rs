//! Every judge is shown to condemn: the checker of trees one planted fault a clause, the sanitizer one kernel a
//! fault, the hash of an answer one bit. Kernels that break no rule pass.

mod filters;
mod tree;

use nearmiss::contacts::{Contacts, Rows, TrianglePair};
use nearmiss::scene::{BodyId, Scene};
use nearmiss::{Device, Error, Query};
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::entry::Entry;
use nearmiss_kernels::exec::{Block, Lane};
use nearmiss_lab::scene;
use support::{ORDERS, ask, engine, kernels, sanitizer};

// The sanitizer.

/// Memory that the kernels of this test touch.
#[derive(Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct Words {
    words: Span<u32>,
    long: Span<u64>,
}
kernels! { [Words], 32, 1024;
    neighbours_in_one_phase |b, a| {
        let (lanes, base) = (b.lanes(), b.block() * b.lanes());
        b.phase(|l| l.write(a.words, l.global(), 1));
        b.phase(|l| {
            l.write(a.words, l.global(), 2);
            l.read(a.words, base + (l.lane() + 1) % lanes);
        });
    }
    neighbours_in_two_phases |b, a| {
        let (lanes, base) = (b.lanes(), b.block() * b.lanes());
        b.phase(|l| l.write(a.words, l.global(), 1));
        b.phase(|l| { l.read(a.words, base + (l.lane() + 1) % lanes); });
    }
    all_write_one_word |b, a| { b.phase(|l| l.write(a.words, 0, 7)); }
    blocks_write_one_word |b, a| { b.phase(|l| if l.lane() == 0 { l.write(a.words, 0, 7) }); }
    blocks_write_their_word |b, a| { b.phase(|l| l.write(a.words, l.global(), 7)); }
    read_before_written |b, a| { b.phase(|l| { l.read(a.words, l.lane()); }); }
    written_then_read |b, a| {
        b.phase(|l| l.write(a.words, l.lane(), 1));
        b.phase(|l| { l.read(a.words, l.lane()); });
    }
    read_past_the_end |b, a| { b.phase(|l| if l.lane() == 9 { l.read(a.words, a.words.len() as u32); }); }
    write_past_the_end |b, a| { b.phase(|l| if l.lane() == 9 { l.write(a.words, a.words.len() as u32, 0) }); }
    count_past_the_end |b, a| { b.phase(|l| if l.lane() == 9 { l.fetch_add(a.long, a.long.len() as u32, 1); }); }
    load_past_the_end |b, a| { b.load(a.words, a.words.len() as u32); }
    atomic_and_plain |b, a| {
        b.phase(|l| if l.lane() == 3 { l.write(a.long, 0, 1) } else { l.fetch_add(a.long, 0, 1); });
    }
    atomic_and_read |b, a| {
        b.phase(|l| if l.lane() == 3 { l.read(a.long, 0); } else { l.fetch_max(a.long, 0, 1) });
    }
    atomics_then_a_plain_write |b, a| {
        b.phase(|l| {
            l.fetch_add(a.long, 0, 1);
            if l.lane() == 31 || l.lane() == 0 {
                l.write(a.long, 0, 1);
            }
        });
    }
    atomics_then_a_plain_read |b, a| {
        b.phase(|l| {
            l.fetch_add(a.long, 0, 1);
            if l.lane() == 31 {
                l.read(a.long, 0);
            }
        });
    }
    atomics_only |b, a| {
        b.phase(|l| { l.fetch_add(a.long, 0, 1); l.fetch_max(a.long, 0, 9); l.fetch_min(a.long, 0, 1) });
    }
    readers_and_a_writer |b, a| {
        b.phase(|l| if l.lane() == 5 { l.write(a.long, 0, 1) } else { l.read(a.long, 0); });
    }
    readers_only |b, a| { b.phase(|l| { l.read(a.long, 0); }); }
    shared_before_written |b, _a| {
        let words = b.shared::<u32>(8);
        b.phase(|l| { l.get(words, l.lane() % 8); });
    }
    shared_of_the_block_before |b, _a| {
        let words = b.shared::<u32>(8);
        let block = b.block();
        b.phase(|l| if block == 0 && l.lane() < 8 { l.put(words, l.lane(), 1) });
        b.phase(|l| if block == 1 && l.lane() < 8 { l.get(words, l.lane()); });
    }
    shared_in_one_phase |b, _a| {
        let words = b.shared::<u32>(32);
        b.phase(|l| l.put(words, l.lane(), 1));
        b.phase(|l| { l.put(words, l.lane(), 2); l.get(words, 31 - l.lane()); });
    }
    shared_in_two_phases |b, _a| {
        let words = b.shared::<u32>(32);
        b.phase(|l| l.put(words, l.lane(), 1));
        b.phase(|l| { l.get(words, 31 - l.lane()); });
    }
    shared_past_the_end |b, _a| {
        let words = b.shared::<u32>(31);
        let _others = b.shared::<u32>(31);
        b.phase(|l| l.put(words, l.lane(), 1));
    }
    shared_atomic_and_plain |b, _a| {
        let words = b.shared::<u32>(1);
        b.phase(|l| if l.lane() == 0 { l.put(words, 0, 0) });
        b.phase(|l| if l.lane() == 7 { l.put(words, 0, 3) } else { l.shared_add(words, 0, 1); });
    }
    shared_atomics_only |b, _a| {
        let words = b.shared::<u32>(1);
        b.phase(|l| if l.lane() == 0 { l.put(words, 0, 0) });
        b.phase(|l| { l.shared_add(words, 0, 1); });
    }
    peek_before_written |b, _a| { let words = b.shared::<u32>(1); b.peek(words, 0); }
}

const OUTSIDE: &str = "an access outside its memory";
const UNWRITTEN: &str = "a read of unwritten memory";
const RACE: &str = "a race between";

/// Launches a kernel of three blocks on 96 fresh words and two counters that the host wrote.
fn launched<E: Entry<Args = Words>>(device: &Device) -> Result<(), Error> {
    let words = device.buffer::<u32>(96).expect("memory");
    let long = device.upload(&[5u64, 6]).expect("memory");
    // SAFETY: a sanitizer lets no kernel touch what is not memory.
    unsafe { device.launch::<E>(3, &Words { words: words.span(), long: long.span() }) }
}

fn condemned<E: Entry<Args = Words>>(fault: &str) {
    for order in ORDERS {
        let device = sanitizer(order);
        let Err(Error::Bug { what }) = launched::<E>(&device) else {
            panic!("{}, {order:?}: no fault", E::NAME)
        };
        assert!(what.starts_with(&format!("kernel {}: {fault}", E::NAME)), "{order:?}: {what}");
        assert!(what.contains(" lane ") && what.contains("block ") && what.contains("phase "), "{what}");
        launched::<blocks_write_their_word>(&device).expect("the next launch is judged by itself");
    }
}

fn acquitted<E: Entry<Args = Words>>() {
    for order in ORDERS {
        launched::<E>(&sanitizer(order)).unwrap_or_else(|e| panic!("{}, {order:?}: {e}", E::NAME));
    }
}

#[test]
fn a_race_is_seen() {
    condemned::<neighbours_in_one_phase>(RACE);
    condemned::<all_write_one_word>(RACE);
    condemned::<blocks_write_one_word>(RACE);
    condemned::<readers_and_a_writer>(RACE);
    condemned::<atomic_and_plain>(RACE);
    condemned::<atomic_and_read>(RACE);
    condemned::<atomics_then_a_plain_write>(RACE);
    condemned::<atomics_then_a_plain_read>(RACE);
    condemned::<shared_in_one_phase>(RACE);
    condemned::<shared_atomic_and_plain>(RACE);
    acquitted::<neighbours_in_two_phases>();
    acquitted::<blocks_write_their_word>();
    acquitted::<atomics_only>();
    acquitted::<readers_only>();
    acquitted::<shared_in_two_phases>();
    acquitted::<shared_atomics_only>();
}

#[test]
fn blocks_of_one_launch_are_not_ordered_by_phases() {
    // In each block the two phases are ordered, but its words are the other blocks' too.
    condemned::<written_then_read>(RACE);
    for order in ORDERS {
        let device = sanitizer(order);
        let words = device.buffer::<u32>(32).expect("memory");
        let args = Words { words: words.span(), long: Span::EMPTY };
        // SAFETY: the words outlive both.
        unsafe { device.launch::<written_then_read>(1, &args) }.expect("one block");
        // SAFETY: as above.
        unsafe { device.launch::<read_before_written>(5, &args) }.expect("an earlier launch wrote it");
    }
}

#[test]
fn a_read_of_unwritten_memory_is_seen() {
    condemned::<read_before_written>(UNWRITTEN);
    condemned::<shared_before_written>(UNWRITTEN);
    condemned::<shared_of_the_block_before>(UNWRITTEN);
    condemned::<peek_before_written>(UNWRITTEN);
}

#[test]
fn an_access_outside_is_seen() {
    condemned::<read_past_the_end>(OUTSIDE);
    condemned::<write_past_the_end>(OUTSIDE);
    condemned::<count_past_the_end>(OUTSIDE);
    condemned::<load_past_the_end>(OUTSIDE);
    condemned::<shared_past_the_end>(OUTSIDE);
}

#[test]
fn a_span_that_lies_about_its_memory_is_seen() {
    let device = sanitizer(ORDERS[0]);
    let words = device.upload(&[0u32; 16]).expect("memory");
    let stale = words.span();
    // SAFETY: a sanitizer, which is all that is given it, lets no kernel touch what is not memory.
    let long = unsafe { Span::new(stale.addr(), 64) };
    // SAFETY: as above.
    let launch =
        |words| unsafe { device.launch::<read_before_written>(1, &Words { words, long: Span::EMPTY }) };
    let fault = |words| match launch(words) {
        Err(Error::Bug { what }) => what,
        other => panic!("{other:?}"),
    };
    assert!(fault(long).contains(OUTSIDE), "longer than its memory");
    drop(words);
    assert!(fault(stale).contains(OUTSIDE), "memory that is freed");
    assert!(fault(Span::EMPTY).contains(OUTSIDE), "no memory at all");
}

// The hash of an answer.

fn hashes_differ(contacts: &Contacts, what: &str, fault: impl Fn(&mut Rows)) {
    let mut other = contacts.clone();
    fault(&mut other.rows);
    assert_ne!(other.hash(), contacts.hash(), "{what}");
}

#[test]
fn the_hash_notices_every_fault_of_a_list_of_pairs() {
    let contacts = ask(engine(), vec![scene::grid(2).expect("a scene")], Query::discrete());
    assert_eq!(contacts.len() as u64, scene::grid_pairs(2));
    assert_eq!(contacts.clone().hash(), contacts.hash());
    type Fault = fn(&mut Vec<TrianglePair>);
    fn second() -> BodyId {
        let mut scene = Scene::new();
        [0; 2].map(|_| scene.add(support::still(&[[0.0; 3]], &[])))[1]
    }
    let faults: [(&str, Fault); 7] = [
        ("an index", |pairs| pairs[3].triangles[1] ^= 1),
        ("a body", |pairs| pairs[3].bodies[1] = second()),
        ("all bodies", |pairs| pairs.iter_mut().for_each(|pair| pair.bodies = [second(); 2])),
        ("dropped", |pairs| pairs.truncate(13)),
        ("twice", |pairs| pairs.insert(1, pairs[1])),
        ("out of order", |pairs| pairs.swap(0, 1)),
        ("exchanged", |pairs| pairs[0].triangles.reverse()),
    ];
    for (what, fault) in faults {
        hashes_differ(&contacts, what, |answer| match answer {
            Rows::Pairs(pairs) => fault(pairs.to_mut()),
            other => panic!("{other:?}"),
        });
    }
}

#[test]
fn the_hash_notices_every_fault_of_a_list_of_contacts() {
    use nearmiss::contacts::{Contact, Kind};
    let scene = scene::soup(60, 5, true).expect("a scene");
    let contacts = ask(engine(), vec![scene], Query::continuous());
    assert!(contacts.len() > 10, "{}", contacts.len());
    type Fault = fn(&mut Vec<Contact>);
    let faults: [(&str, Fault); 8] = [
        ("a bit of a time", |all| all[2].toi = f64::from_bits(all[2].toi.to_bits() ^ 1)),
        ("a bit of a bound", |all| all[2].toi_upper = f64::from_bits(all[2].toi_upper.to_bits() ^ 1)),
        ("a first index", |all| all[4].feature_a ^= 1),
        ("a second index", |all| all[4].feature_b ^= 1),
        ("a kind", |all| all[0].kind = if all[0].kind == Kind::Vf { Kind::Ee } else { Kind::Vf }),
        ("dropped", |all| all.truncate(all.len() - 1)),
        ("twice", |all| all.insert(1, all[1])),
        ("out of order", |all| all.swap(0, 1)),
    ];
    for (what, fault) in faults {
        hashes_differ(&contacts, what, |answer| match answer {
            Rows::Contacts(all) => fault(all.to_mut()),
            other => panic!("{other:?}"),
        });
    }
}
