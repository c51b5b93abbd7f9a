//! The layout of a header: sizes and offsets of its structs by the rules of C on a 64-bit machine,
//! enums and functions.

use std::collections::BTreeMap;

/// A struct's size and alignment, in bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    pub size: usize,
    pub align: usize,
}

/// The binary interface that a header declares.
#[derive(Default)]
pub struct Layout {
    /// The value of `NEARMISS_ABI`.
    pub abi: u32,
    /// Every struct by its name.
    pub shapes: BTreeMap<String, Shape>,
    /// One line a struct, field, value of an enum, and function.
    pub lines: Vec<String>,
}

impl Layout {
    /// The layout in a header's text.
    ///
    /// # Panics
    /// For a declaration of another form than cbindgen's.
    pub fn of(header: &str) -> Layout {
        let mut made = Layout::default();
        let mut constants = BTreeMap::new();
        let mut lines = header.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
        while let Some(line) = lines.next() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["#define", name, value] => {
                    constants.insert(name.to_owned(), value.parse().expect("a whole number"));
                }
                ["enum", name] => made.values(name, &mut lines),
                ["typedef", "struct", "{"] => made.fields(&mut lines, &constants),
                _ if line.contains('(') && !line.starts_with('#') => {
                    let mut whole = line.to_owned();
                    while !whole.ends_with(';') {
                        whole.push_str(lines.next().expect("the end of a declaration"));
                        whole.push(' ');
                        whole.truncate(whole.trim_end().len());
                    }
                    let parts: Vec<&str> = whole.split_whitespace().collect();
                    made.lines.push(format!(
                        "function {}",
                        parts.join(" ").replace(",", ", ").replace(",  ", ", ")
                    ));
                }
                _ => {}
            }
        }
        made.abi = constants["NEARMISS_ABI"] as u32;
        made
    }

    fn values<'a>(&mut self, name: &str, lines: &mut impl Iterator<Item = &'a str>) {
        for line in lines.take_while(|line| *line != "};") {
            if let Some((value, number)) = line.split_once(" = ") {
                self.lines.push(format!("value {name} {value} {}", number.trim_end_matches(',')));
            }
        }
        // Values are passed as `uint32_t`.
        self.shapes.insert(name.to_owned(), Shape { size: 4, align: 4 });
    }

    fn fields<'a>(&mut self, lines: &mut impl Iterator<Item = &'a str>, constants: &BTreeMap<String, usize>) {
        let mut whole = Shape { size: 0, align: 1 };
        let mut fields = Vec::new();
        for line in lines.filter(|line| !line.is_empty()) {
            if let Some(name) = line.strip_prefix('}') {
                let name = name.trim().trim_end_matches(';');
                let size = whole.size.next_multiple_of(whole.align);
                self.lines.push(format!("struct {name} size {size} align {}", whole.align));
                self.lines.extend(fields.iter().map(|field| format!("field {name}.{field}")));
                self.shapes.insert(name.to_owned(), Shape { size, ..whole });
                return;
            }
            let declared = line.strip_suffix(';').expect("a field");
            // A pointer to arrays: `const uint32_t (*starts)[3]`.
            let to_arrays = declared.replace("(*", "*").replace(')', "");
            let is_to_arrays = declared.contains("(*");
            let declared =
                if is_to_arrays { to_arrays.split('[').next().unwrap_or_default() } else { declared };
            let (scalar, dimensions) = declared.split_once('[').unwrap_or((declared, ""));
            let at = scalar.rfind([' ', '*']).expect("a type before the name") + 1;
            let (of, name) = (scalar[..at].trim(), &scalar[at..]);
            let own = self.shape(of);
            let count: usize = dimensions
                .split(['[', ']'])
                .filter(|part| !part.is_empty())
                .map(|part| part.parse().unwrap_or_else(|_| constants[part]))
                .product();
            let offset = whole.size.next_multiple_of(own.align);
            fields.push(format!("{name} offset {offset} size {} {of}", own.size * count));
            whole = Shape { size: offset + own.size * count, align: whole.align.max(own.align) };
        }
    }

    fn shape(&self, of: &str) -> Shape {
        let size = match of {
            _ if of.ends_with('*') => 8,
            "bool" | "char" | "uint8_t" => 1,
            "uint32_t" | "float" => 4,
            "uint64_t" | "size_t" | "double" => 8,
            _ => return *self.shapes.get(of).unwrap_or_else(|| panic!("{of} is declared before it is used")),
        };
        Shape { size, align: size }
    }

    /// The committed list: the number, then the lines.
    pub fn list(&self) -> String {
        format!("NEARMISS_ABI {}\n{}\n", self.abi, self.lines.join("\n"))
    }
}

/// Whether a header agrees with a committed list: the same list, or another number.
///
/// # Errors
/// The first line that changed without a new number.
pub fn compared(header: &Layout, committed: &str) -> Result<(), String> {
    let made = header.list();
    let (new, old): (Vec<&str>, Vec<&str>) = (made.lines().collect(), committed.lines().collect());
    if new.first() != old.first() {
        return Ok(());
    }
    let lost = old.iter().find(|line| !new.contains(line)).map(|line| format!("`{line}` is gone"));
    let come = new.iter().find(|line| !old.contains(line)).map(|line| format!("`{line}` is new"));
    match (lost, come) {
        (None, None) => Ok(()),
        (lost, come) => {
            let both: Vec<String> = [lost, come].into_iter().flatten().collect();
            Err(format!("{}; raise NEARMISS_ABI in c/src/lib.rs from {}", both.join(", "), header.abi))
        }
    }
}
