//! Encodings of text, detected by the first bytes of a file.

use nearmiss::mesh::Problem;

/// The bytes without the byte order mark of UTF-8.
///
/// # Errors
/// [`Problem::Encoding`] for UTF-16 and UTF-32, with a byte order mark or without one.
pub(crate) fn utf8(bytes: &[u8]) -> Result<&[u8], Problem> {
    let found = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => return Ok(rest),
        [0xff, 0xfe, 0, 0, ..] | [1..=255, 0, 0, 0, ..] => "UTF-32, little-endian",
        [0, 0, 0xfe, 0xff, ..] | [0, 0, 0, 1..=255, ..] => "UTF-32, big-endian",
        // A NUL next to another byte: an ASCII character.
        [0xff, 0xfe, ..] | [1..=255, 0, ..] => "UTF-16, little-endian",
        [0xfe, 0xff, ..] | [0, 1..=255, ..] => "UTF-16, big-endian",
        _ => return Ok(bytes),
    };
    Err(Problem::Encoding { found })
}

/// The text; lines that end in CR alone end in LF.
///
/// # Errors
/// Errors of [`utf8`], and [`Problem::Unreadable`] for bytes that are not UTF-8.
pub(crate) fn text(mut bytes: Vec<u8>) -> Result<String, Problem> {
    let mark = bytes.len() - utf8(&bytes)?.len();
    bytes.drain(..mark);
    if !bytes.contains(&b'\n') {
        bytes.iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
    }
    String::from_utf8(bytes).map_err(|_| Problem::Unreadable { reason: "it is not UTF-8".into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_named_and_marks_are_no_text() {
        let wide =
            |text: &str, order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<_>>();
        for mark in ["", "\u{feff}"] {
            let file = format!("{mark}v 0 0 0\n");
            assert_eq!(text(file.clone().into_bytes()), Ok("v 0 0 0\n".into()));
            let named = |bytes: &[u8]| utf8(bytes).expect_err("refused").to_string();
            assert!(named(&wide(&file, u16::to_le_bytes)).contains("UTF-16, little-endian"));
            assert!(named(&wide(&file, u16::to_be_bytes)).contains("UTF-16, big-endian"));
            let all = file.chars().map(u32::from);
            assert!(
                named(&all.clone().flat_map(u32::to_le_bytes).collect::<Vec<_>>()).contains("UTF-32, little")
            );
            assert!(named(&all.flat_map(u32::to_be_bytes).collect::<Vec<_>>()).contains("UTF-32, big"));
        }
        for plain in [&b""[..], b"v", b"\0", b"\0\0", "\u{fc}".as_bytes()] {
            assert_eq!(utf8(plain), Ok(plain));
        }
    }

    #[test]
    fn lines_end_in_any_way() {
        assert_eq!(text(b"a\rb\r".to_vec()), Ok("a\nb\n".into()));
        assert_eq!(text(b"a\r\nb\r".to_vec()), Ok("a\r\nb\r".into()));
        assert!(text(b"a\xff".to_vec()).expect_err("refused").to_string().contains("not UTF-8"));
    }
}
