//! Tokens of files in messages.

/// A token as a message shows it: text with replacement characters, at most a line's worth.
pub(crate) fn shown(token: &[u8]) -> String {
    const MOST: usize = 40;
    let cut = &token[..token.len().min(MOST)];
    let dots = if token.len() > MOST { "…" } else { "" };
    format!("{}{dots}", String::from_utf8_lossy(cut).escape_debug())
}
