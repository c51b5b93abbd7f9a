//! Unpacking of gzip files.

use flate2::bufread::MultiGzDecoder;
use nearmiss::mesh::Problem;
use nearmiss::{Error, memory};
use std::io::Read;

/// Bytes of the first piece; each later piece is as long as all before it.
const PIECE: u64 = 1 << 20;

/// The bytes of a packed file. A file of a megabyte may unpack to a gigabyte. So memory is checked
/// before each piece: `multiple` bytes for each byte unpacked by then.
///
/// # Errors
/// [`Error::Input`] with [`Problem::Packed`] for damaged data; [`Error::OutOfMemory`].
pub(super) fn unpack(file: &str, packed: &[u8], multiple: u64) -> Result<Vec<u8>, Error> {
    unpack_within(file, packed, |bytes| {
        memory::require(&format!("unpacking {file}"), bytes.saturating_mul(multiple))
    })
}

fn unpack_within(
    file: &str,
    packed: &[u8],
    require: impl Fn(u64) -> Result<(), Error>,
) -> Result<Vec<u8>, Error> {
    let mut source = MultiGzDecoder::new(packed);
    let mut bytes = Vec::new();
    loop {
        let piece = PIECE.max(bytes.len() as u64);
        require(bytes.len() as u64 + piece)?;
        let read = source.by_ref().take(piece).read_to_end(&mut bytes).map_err(|e| Error::Input {
            file: file.into(),
            problem: Problem::Packed { reason: e.to_string() },
        })?;
        if (read as u64) < piece {
            return Ok(bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut gz = GzEncoder::new(Vec::new(), Compression::default());
        gz.write_all(text).expect("memory takes all");
        gz.finish().expect("memory takes all")
    }

    #[test]
    fn what_was_packed_comes_back() {
        let text: Vec<u8> = (0..3 * PIECE + 5).map(|i| (i * i) as u8).collect();
        for text in [&text[..], &text[..PIECE as usize], b"v", b""] {
            assert_eq!(unpack("a.gz", &packed(text), 8).expect("good data"), text);
        }
        let two = [packed(b"v 0 0 0\n"), packed(b"v 1 0 0\n")].concat();
        assert_eq!(unpack("a.gz", &two, 8).expect("two members"), b"v 0 0 0\nv 1 0 0\n");
    }

    #[test]
    fn damaged_data_is_refused() {
        let good = packed(b"v 0 0 0\nv 1 0 0\n");
        for cut in 0..good.len() {
            assert!(unpack("a.gz", &good[..cut], 8).is_err(), "the first {cut} bytes");
        }
        for at in [0, 1, 2, 12, good.len() - 1, good.len() - 6] {
            let mut bad = good.clone();
            bad[at] ^= 0x55;
            let error = unpack("a.gz", &bad, 8).expect_err("a changed byte");
            assert!(error.to_string().starts_with("a.gz: its gz data cannot be unpacked: "), "{error}");
        }
        assert!(unpack("a.gz", &[&good[..], b"more"].concat(), 8).is_err());
    }

    /// A bomb is refused when memory ends, with little of it unpacked.
    #[test]
    fn a_bomb_is_refused() {
        let bomb = packed(&vec![0; 64 << 20]);
        assert!(bomb.len() < 1 << 20, "{} bytes", bomb.len());
        let asked = std::cell::Cell::new(0);
        let error = unpack_within("a.gz", &bomb, |bytes| {
            asked.set(bytes);
            let given = 8 << 20;
            let what = String::from("unpacking a.gz");
            if bytes > given { Err(Error::OutOfMemory { what, asked: bytes, given }) } else { Ok(()) }
        });
        assert!(matches!(error, Err(Error::OutOfMemory { .. })), "{error:?}");
        assert_eq!(asked.get(), 16 << 20);
    }
}
