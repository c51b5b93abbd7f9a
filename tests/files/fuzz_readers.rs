//! Damaged files never make a reader panic, nor allocate out of proportion to what the file holds.
//!
//! Runs on stable, a few seconds; proptest prints the input that fails, and `PROPTEST_CASES` raises the number.
#![allow(clippy::unwrap_used, reason = "tests")]

use nearmiss::mesh::Mesh;
use nearmiss_io::{Format, MeshFile, Note, Treated, encode_ply};
use proptest::prelude::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static NOW: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

/// The system's allocator, counting for each thread the bytes it holds and the most it has held.
struct Counting;

fn add(bytes: isize) {
    // During the end of a thread its counters may be gone, and are not needed.
    let _ = NOW.try_with(|now| {
        now.set(now.get() + bytes);
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(now.get())));
    });
}

// SAFETY: every request goes to the system's allocator unchanged; counting neither allocates nor unwinds.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size() as isize);
        // SAFETY: the caller's promise is System's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        add(-(layout.size() as isize));
        // SAFETY: the pointer came from `alloc`, that is, from System.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The most bytes that `work` held beyond what was held before.
fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = NOW.get();
    PEAK.set(before);
    let result = work();
    (result, (PEAK.get() - before) as usize)
}

/// Most memory of a reader for a file: the mesh, its growth, its messages. A face of many one-byte
/// corners needs most: 12 bytes a byte, three times while a vector grows.
fn bound(file: usize) -> usize {
    64 * 1024 + 64 * file
}

/// Most memory of the reader of glTF: an empty node of its JSON takes hundreds of bytes.
fn bound_of(format: Format, file: usize) -> usize {
    if format == Format::Gltf { 64 * 1024 + 2048 * file } else { bound(file) }
}

/// Reads a file. The result must be a mesh that validation accepts again, or a message.
fn survive(format: Format, bytes: &[u8]) -> Result<(), TestCaseError> {
    let (read, held) = peak(|| MeshFile::parse("fuzz", format, bytes));
    prop_assert!(held <= bound_of(format, bytes.len()), "{held} bytes held for a file of {}", bytes.len());
    match read {
        Ok(file) => {
            let mesh = file.mesh();
            prop_assert!(mesh.face_count() + mesh.edges().len() + mesh.points().len() > 0);
            let again = Mesh::new("again", mesh.positions().clone(), mesh.faces().to_vec());
            let again = again.and_then(|again| again.with_edges(mesh.edges().to_vec()));
            let again = again.and_then(|again| again.with_points(mesh.points().to_vec()));
            prop_assert!(again.is_ok(), "the door refuses what it let in");
            for note in file.notes() {
                prop_assert!(note.count > 0 && note.to_string().starts_with("fuzz: "), "{note}");
            }
            let is_welded = |note: &Note| matches!(note.treated, Treated::Welded { .. });
            prop_assert_eq!(file.notes().iter().all(is_welded), file.strict().is_ok());
        }
        Err(error) => prop_assert!(error.to_string().starts_with("fuzz: ")),
    }
    // All problems are found as the first is, and there are some if there is a first.
    for most in [1, 5] {
        let first = MeshFile::parse("fuzz", format, bytes).err().map(|error| error.to_string());
        let all = MeshFile::parse_problems("fuzz", format, bytes, most);
        let all = all.map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert!(all.len() <= most && all.is_empty() == first.is_none(), "{first:?} and {all:?}");
        let one = all.first().map(|problem| format!("fuzz: {problem}"));
        prop_assert!(most > 1 || one == first, "{first:?} and {one:?}");
    }
    Ok(())
}

fn valid_files() -> Vec<(Format, Vec<u8>)> {
    let ascii = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\n\
                 property short z\nproperty list uchar int tags\nelement face 2\nproperty uchar red\n\
                 property list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n\
                 0 0 0 0\n1 0 0 2 7 8\n0 1e0 0 0\n0 .5 1 0\n255 3 0 1 2\n0 4 0 1 2 3\n5\n";
    let obj = "# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0.1 # c\nv 0 0 1e3\nvt 0 0\nf 1/1 2//2 3/1/1\nl 1 2/1 -1 \\\n 2\np 3 1\nf -1 \\\n -2 -3 1\n";
    let mut binary = Vec::new();
    let mesh = MeshFile::parse("ascii", Format::Ply, ascii.as_bytes()).unwrap();
    encode_ply(mesh.mesh(), &mut binary).unwrap();
    let mut big =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n\
                    property uchar z\nelement face 2\nproperty list ushort uchar vertex_index\nend_header\n"
            .to_vec();
    big.extend([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 3, 0, 1, 2, 0, 4, 2, 1, 0, 0]);
    let strips = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n\
                  7 0 1 2 -1 3 2 1\n";
    let wires = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                 element edge 3\nproperty int vertex1\nproperty uchar red\nproperty int vertex2\nend_header\n\
                 0 0 0\n1 0 0\n0 1 0\n0 9 1\n2 9 2\n1 9 2\n";
    let off =
        "# by hand\nCOFF 4 3 0\n0 0 0 1 0 0\n1 0 0\n0 1 0.1 # c\n0 0 1e3\n3 0 1 2 0.5\n4 0 1 2 3\n2 0 1\n";
    let stl = "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 .1\nendloop\nendfacet\n\
               endsolid\n";
    vec![
        (Format::Ply, ascii.into()),
        (Format::Obj, obj.into()),
        (Format::Ply, binary),
        (Format::Ply, big),
        (Format::Ply, strips.into()),
        (Format::Ply, wires.into()),
        (Format::Off, off.into()),
        (Format::Stl, stl.into()),
        (Format::Stl, super::formats::binary_stl(&[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]; 2])),
        (Format::Gltf, super::formats::gltf(4).into_bytes()),
        (Format::Gltf, super::formats::glb(5)),
    ]
}

/// One damage to a file; places are fractions of its length.
#[derive(Debug, Clone)]
enum Damage {
    Set(f64, u8),
    Cut(f64),
    Copy(f64, f64, usize),
    Insert(f64, Vec<u8>),
    Remove(f64, usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = || 0.0..1.0;
    let words = [
        "4294967295",
        "-1",
        "nan",
        "1e999",
        " ",
        "\n",
        "list uchar int ",
        "property float x\n",
        "f 1 2 3\n",
        "\\\n",
        "\u{feff}",
        "\r",
        "\0",
        "\nV",
        "\nf 1 2\n",
        "\nl 1 2\n",
        "\n2 0 1\n",
        "vertex 1 2 3\n",
        "endsolid\n",
        "\"byteOffset\":4,",
        "\"count\":4294967295,",
        "\"children\":[0],",
    ];
    prop_oneof![
        8 => (at(), any::<u8>()).prop_map(|(i, byte)| Damage::Set(i, byte)),
        1 => at().prop_map(Damage::Cut),
        2 => (at(), at(), 0usize..200).prop_map(|(from, to, n)| Damage::Copy(from, to, n)),
        2 => (at(), proptest::collection::vec(any::<u8>(), 0..20)).prop_map(|(i, b)| Damage::Insert(i, b)),
        4 => (at(), proptest::sample::select(words.to_vec())).prop_map(|(i, w)| Damage::Insert(i, w.into())),
        2 => (at(), 1usize..20).prop_map(|(i, n)| Damage::Remove(i, n)),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    let place = |fraction: f64| (fraction * bytes.len() as f64) as usize;
    match damage {
        Damage::Set(i, byte) => {
            let i = place(*i);
            if let Some(b) = bytes.get_mut(i) {
                *b = *byte;
            }
        }
        Damage::Cut(i) => bytes.truncate(place(*i)),
        Damage::Copy(from, to, n) => {
            let (from, to) = (place(*from), place(*to));
            let piece = bytes[from..(from + n).min(bytes.len())].to_vec();
            bytes.splice(to..to, piece);
        }
        Damage::Insert(i, piece) => {
            let i = place(*i);
            bytes.splice(i..i, piece.iter().copied());
        }
        Damage::Remove(i, n) => {
            let i = place(*i);
            bytes.drain(i..(i + n).min(bytes.len()));
        }
    }
}

/// 3,000 cases, a second or two, unless `PROPTEST_CASES` says otherwise.
fn config() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    ProptestConfig { cases: asked.unwrap_or(3000), failure_persistence: None, ..ProptestConfig::default() }
}

/// A count in a header: fitting, lying, or absurd.
fn count() -> impl Strategy<Value = u64> {
    prop_oneof![8 => 0u64..40, 1 => 0u64..5_000_000, 1 => any::<u64>()]
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn damaged_files_are_survived(which in 0usize..11, damages in proptest::collection::vec(damage(), 1..6)) {
        let (format, mut bytes) = valid_files().swap_remove(which);
        damages.iter().for_each(|damage| apply(&mut bytes, damage));
        survive(format, &bytes)?;
    }

    /// A mark before a file changes nothing of what is read.
    #[test]
    fn a_byte_order_mark_changes_nothing(which in 0usize..4, damages in proptest::collection::vec(damage(), 0..3)) {
        let (format, mut bytes) = valid_files().swap_remove(which);
        damages.iter().for_each(|damage| apply(&mut bytes, damage));
        let marked = [b"\xef\xbb\xbf", &bytes[..]].concat();
        prop_assume!(!bytes.starts_with(b"\xef\xbb\xbf") && bytes.get(..2).is_none_or(|two| !two.contains(&0)));
        // NaN is not equal to itself, and is written alike.
        let read = |bytes: &[u8]| format!("{:?}", MeshFile::parse("fuzz", format, bytes));
        prop_assert_eq!(read(&bytes), read(&marked));
    }

    /// A line whose first word is no keyword never goes in silence.
    #[test]
    fn unknown_words_are_noted_or_refused(word in "[vVfFtln:.\u{a0}1_#]{1,3}", at in 0usize..7, rest in "[ 0-9]{0,6}") {
        const KNOWN: [&str; 7] = ["v", "f", "vt", "vn", "l", "p", "#"];
        let lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 3", "f 3 2 1", "# end"];
        let first = word.split('#').next().unwrap_or_default();
        prop_assume!(!first.is_empty() && !KNOWN.contains(&first));
        let mut file = lines.to_vec();
        let line = format!("{word} {rest}");
        file.insert(at.min(lines.len()), &line);
        let read = MeshFile::parse("fuzz", Format::Obj, file.join("\n").as_bytes());
        prop_assert!(read.is_err() || read.is_ok_and(|file| file.notes().len() == 1), "{line}");
    }

    #[test]
    fn raw_bytes_are_survived(bytes in proptest::collection::vec(any::<u8>(), 0..300), which in 0usize..5) {
        survive([Format::Ply, Format::Obj, Format::Stl, Format::Off, Format::Gltf][which], &bytes)?;
        survive(Format::of_bytes(&bytes), &bytes)?;
    }

    #[test]
    fn raw_bodies_are_survived(
        body in proptest::collection::vec(0u8..6, 0..400),
        vertices in count(),
        faces in count(),
        big in any::<bool>(),
        list in proptest::sample::select(vec!["uchar uchar", "char int", "uint short", "int char"]),
    ) {
        let order = if big { "big" } else { "little" };
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex {vertices}\nproperty uchar x\nproperty uchar y\n\
             property uchar z\nelement face {faces}\nproperty list {list} vertex_indices\nend_header\n"
        ).into_bytes();
        bytes.extend(body);
        survive(Format::Ply, &bytes)?;
    }
}

#[test]
fn the_valid_files_are_valid() {
    for (format, bytes) in valid_files() {
        MeshFile::parse("valid", format, &bytes).unwrap();
    }
}

/// The greediest files we know stay below the bound, not far below: the bound is not idle.
#[test]
fn the_worst_file_stays_below_the_bound() {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n\
                      property uchar z\nelement face 1\nproperty list uint uchar vertex_indices\nend_header\n\0\0\0"
        .to_vec();
    let corners = (1u32 << 20) + 5;
    bytes.extend(corners.to_le_bytes());
    bytes.extend(std::iter::repeat_n(0, corners as usize));
    let (file, held) = peak(|| MeshFile::parse("fan", Format::Ply, &bytes).unwrap());
    assert_eq!(file.mesh().face_count(), corners as usize - 2);
    assert!(
        held <= bound(bytes.len()) && held > 8 * bytes.len(),
        "{held} bytes for a file of {}",
        bytes.len()
    );
}

/// The counter of bytes fails where a reader would allocate by the counts in a header.
#[test]
fn the_bound_notices_an_allocation_by_a_count() {
    let ((), held) = peak(|| drop(std::hint::black_box(Vec::<[f32; 3]>::with_capacity(1_000_000))));
    assert!(held > bound(100));
}
