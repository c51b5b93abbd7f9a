//! Packing by gzip. A stream that fails is not completed.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::{BufWriter, Error, Write};

/// Packs what is put.
///
/// # Errors
/// Those of `put` and `out`; then what `out` has is no gzip file.
pub fn pack(
    out: &mut dyn Write,
    put: impl FnOnce(&mut dyn Write) -> Result<(), String>,
) -> Result<(), String> {
    let mut packer = GzEncoder::new(Gate { out, shut: false }, Compression::default());
    let mut buffer = BufWriter::new(&mut packer);
    let written = put(&mut buffer);
    // A buffer that is dropped would write what it holds.
    let (into, held) = buffer.into_parts();
    let written = written.and_then(|()| {
        let ended = into.write_all(&held.unwrap_or_default()).and_then(|()| into.try_finish());
        ended.map_err(|e| e.to_string())
    });
    packer.get_mut().shut = written.is_err();
    written
}

/// The target of a packer. A packer that is dropped ends its stream as if all had been put: of a failed one nothing more gets out.
struct Gate<'a> {
    out: &'a mut dyn Write,
    shut: bool,
}

impl Write for Gate<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.shut { Err(Error::other("it failed before")) } else { self.out.write(bytes) }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::pack;
    use flate2::read::GzDecoder;
    use std::io::Read;

    fn unpacked(packed: &[u8]) -> std::io::Result<Vec<u8>> {
        let mut all = Vec::new();
        GzDecoder::new(packed).read_to_end(&mut all).map(|_| all)
    }

    #[test]
    fn what_fails_is_not_whole() {
        // More than buffers hold, and less.
        for length in [0, 10, 3_000_000u32] {
            let bytes: Vec<u8> = (0..length).map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
            let mut whole = Vec::new();
            pack(&mut whole, |out| out.write_all(&bytes).map_err(|e| e.to_string())).expect("packed");
            assert!(unpacked(&whole).expect("a gzip file") == bytes);
            let mut half = Vec::new();
            let failed = pack(&mut half, |out| out.write_all(&bytes).map_or(Ok(()), |()| Err("no".into())));
            assert_eq!(failed, Err("no".into()));
            assert!(half.len() < whole.len() && unpacked(&half).is_err(), "{length}");
        }
    }
}
