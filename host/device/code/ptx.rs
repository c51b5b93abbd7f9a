//! The kernels' PTX, split by kernel: the driver compiles a kernel at its first use, not all of
//! them at the start.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;

/// Decompresses what is packed by zstd: PTX or machine code.
///
/// # Errors
/// The reason why it is not packed so, or not whole.
pub fn unpacked(mut packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut decoder =
        ruzstd::decoding::StreamingDecoder::new(&mut packed).map_err(|error| error.to_string())?;
    decoder.read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// PTX in parts: the common head, functions, kernels.
pub struct Parts {
    shared: String,
    declarations: BTreeMap<String, String>,
    /// In the text's order: a function is declared or defined before its first call.
    functions: Vec<(String, String)>,
    entries: BTreeMap<String, String>,
}

/// The name that a line defines, if it opens a function or a kernel.
fn opens(line: &str) -> Option<(bool, &str)> {
    let (is_entry, rest) = match line.strip_prefix(".visible .entry ") {
        Some(rest) => (true, rest),
        // `.func name(…` or `.func (.param …) name(…`.
        None => (false, line.strip_prefix(".func")?.trim_start()),
    };
    let rest = if is_entry || !rest.starts_with('(') { rest } else { rest.split_once(") ")?.1 };
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '$')).unwrap_or(rest.len());
    Some((is_entry, &rest[..end]))
}

impl Parts {
    /// Splits a text of rustc: at a line's start, a function ends with a brace, a declaration with
    /// a semicolon.
    pub fn new(ptx: &str) -> Parts {
        let mut parts = Parts {
            shared: String::new(),
            declarations: BTreeMap::new(),
            functions: Vec::new(),
            entries: BTreeMap::new(),
        };
        let mut lines = ptx.lines();
        while let Some(line) = lines.next() {
            let Some((is_entry, name)) = opens(line) else {
                parts.shared += line;
                parts.shared.push('\n');
                continue;
            };
            let mut text = String::from(line) + "\n";
            let mut has_body = false;
            for line in lines.by_ref() {
                text += line;
                text.push('\n');
                has_body |= line.starts_with('{');
                if line.starts_with('}') || (!has_body && line.trim_end().ends_with(';')) {
                    break;
                }
            }
            match (has_body, is_entry) {
                (false, _) => drop(parts.declarations.insert(name.to_owned(), text)),
                (true, true) => drop(parts.entries.insert(name.to_owned(), text)),
                (true, false) => parts.functions.push((name.to_owned(), text)),
            }
        }
        parts
    }

    /// Names of the kernels.
    #[cfg(test)]
    fn kernels(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
    }

    /// A module of the parts that all kernels share, without a kernel.
    pub fn common(&self) -> &str {
        &self.shared
    }

    /// A module of one kernel and all functions that it calls; `None` if there is no such kernel.
    pub fn module(&self, kernel: &str) -> Option<String> {
        let entry = self.entries.get(kernel)?;
        let mut needed = BTreeSet::new();
        let mut texts = vec![entry.as_str()];
        while let Some(text) = texts.pop() {
            for (name, body) in &self.functions {
                if text.contains(name.as_str()) && needed.insert(name.as_str()) {
                    texts.push(body);
                }
            }
        }
        let mut module = self.shared.clone();
        // A function that is only declared (the driver provides it) is declared in every module.
        for (name, text) in &self.declarations {
            if needed.contains(name.as_str()) || self.functions.iter().all(|(defined, _)| defined != name) {
                module += text;
            }
        }
        let called = self.functions.iter().filter(|(name, _)| needed.contains(name.as_str()));
        called.for_each(|(_, text)| module += text);
        module += entry;
        Some(module)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// head\n.version 7.5\n.func  (.param .b32 r) deep(\n\t.param .b32 p\n)\n;\n.func far()\n{\n\tret;\n}\n\
        .func  (.param .b32 r) deep(\n\t.param .b32 p\n)\n{\n\tcall far;\n}\n.visible .entry one(\n)\n{\n\tcall deep;\n}\n\
        .visible .entry two(\n)\n{\n\tret;\n}\n.file 1 \"a\"\n";

    #[test]
    fn a_kernel_brings_what_it_calls_and_no_more() {
        let parts = Parts::new(TEXT);
        assert_eq!(parts.kernels().collect::<Vec<_>>(), ["one", "two"]);
        let one = parts.module("one").expect("a kernel");
        for piece in [".version 7.5", "call far", "call deep", ".file 1", ".entry one", "p\n)\n;"] {
            assert!(one.contains(piece), "{piece} in {one}");
        }
        assert!(!one.contains(".entry two"));
        let two = parts.module("two").expect("a kernel");
        assert!(!two.contains("far") && !two.contains("deep"));
        assert!(parts.module("three").is_none());
        assert!(!parts.common().contains(".entry") && !parts.common().contains(".func"));
    }

    /// A function that a module calls before it is declared or defined, which no assembler accepts.
    fn called_too_early<'a>(parts: &'a Parts, module: &str) -> Option<&'a str> {
        let opened = |name: &str| module.lines().position(|line| opens(line).is_some_and(|(_, n)| n == name));
        let named = |name: &str| module.lines().position(|line| line.contains(name));
        parts.functions.iter().map(|(name, _)| name.as_str()).find(|name| named(name) < opened(name))
    }

    #[test]
    fn a_function_that_is_called_too_early_is_noticed() {
        let parts = Parts::new(TEXT);
        let one = parts.module("one").expect("a kernel");
        assert_eq!(called_too_early(&parts, &one), None);
        let (call, other) = ("call far;", ".func far()\n{\n\tret;\n}\n");
        let swapped = one.replace(other, "") + other;
        assert!(one.contains(call) && called_too_early(&parts, &swapped) == Some("far"), "{swapped}");
    }

    #[test]
    fn a_damaged_text_is_an_error() {
        let whole = include_bytes!("../../../kernels/nearmiss.ptx.zst");
        for damaged in [&whole[..0], &whole[1..], &whole[..whole.len() / 2]] {
            assert!(unpacked(damaged).is_err());
        }
    }

    #[test]
    fn the_committed_text_has_every_kernel_of_the_table() {
        let text = unpacked(include_bytes!("../../../kernels/nearmiss.ptx.zst")).expect("packed");
        let parts = Parts::new(std::str::from_utf8(&text).expect("a text"));
        for (name, _) in nearmiss_kernels::entry::TABLE {
            let module = parts.module(name).unwrap_or_else(|| panic!("{name} is missing"));
            assert_eq!(module.matches("\n.visible .entry ").count(), 1, "{name}");
            assert_eq!(called_too_early(&parts, &module), None, "{name}");
        }
        assert_eq!(parts.kernels().count(), nearmiss_kernels::entry::TABLE.len());
    }
}
