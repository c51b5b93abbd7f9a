//! The tables of a page.

use super::table::Tables;

const BEGIN: &str = "<!-- figures: ";
const END: &str = "<!-- end -->";

/// Names of the tables that a page marks.
pub fn names(text: &str) -> Vec<&str> {
    text.lines().filter_map(|line| line.strip_prefix(BEGIN)?.strip_suffix(" -->")).collect()
}

/// A page with every marked table made again. `page` is its path from the root, with `/`.
///
/// # Errors
/// A sentence if a table is unknown, or its mark has no end.
pub fn refill(page: &str, text: &str, tables: &mut Tables) -> Result<String, String> {
    let up = "../".repeat(page.matches('/').count());
    let mut made = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        made.push_str(line);
        made.push('\n');
        let Some(name) = line.strip_prefix(BEGIN).and_then(|rest| rest.strip_suffix(" -->")) else {
            continue;
        };
        if !lines.by_ref().any(|line| line == END) {
            return Err(format!("{page}: table {name} has no line {END}"));
        }
        let table = tables.markdown(name, &up).map_err(|e| format!("{page}: {e}"))?;
        made.push('\n');
        made.push_str(&table);
        made.push('\n');
        made.push_str(END);
        made.push('\n');
    }
    Ok(made)
}
