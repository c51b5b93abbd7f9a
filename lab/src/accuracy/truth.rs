//! Lists of the true contacts of a scene.

use crate::case::file::text;
use nearmiss::contacts::Kind;
use nearmiss::error::Error;
use nearmiss::mesh::Problem;
use std::path::Path;

/// A pair of features, as in a contact.
pub type Key = (Kind, u32, u32);

/// The rows of a file, ascending.
#[derive(Debug, PartialEq)]
pub enum List {
    /// `kind,a,b`: all vertex/face and edge/edge pairs that meet during the step.
    Contacts(Vec<Key>),
    /// `tri_a,tri_b`: all triangle pairs that share a point.
    Triangles(Vec<[u32; 2]>),
}

/// Reads `kind,a,b` (`vf` or `ee`) or `tri_a,tri_b`, CSV or CSV.gz, with or without a header.
///
/// # Errors
/// [`Error::Input`] for a file that cannot be read, or a row of neither kind.
pub fn list(file: &Path) -> Result<List, Error> {
    parse(&text(file)?).map_err(|what| Error::Input {
        file: file.display().to_string(),
        problem: Problem::Scene { what, advice: "give --truth a list of kind,a,b or of tri_a,tri_b".into() },
    })
}

fn parse(text: &str) -> Result<List, String> {
    let (mut contacts, mut triangles) = (Vec::new(), Vec::new());
    for (at, line) in text.lines().enumerate() {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let index = |text: &str| {
            text.parse::<u32>().map_err(|_| format!("row {}: index {text} is no whole number", at + 1))
        };
        match fields[..] {
            [""] => {}
            [kind @ ("vf" | "ee"), a, b] => {
                let kind = if kind == "vf" { Kind::Vf } else { Kind::Ee };
                contacts.push((kind, index(a)?, index(b)?));
            }
            _ if at == 0 && fields.iter().all(|field| field.parse::<u32>().is_err()) => {}
            [a, b] => triangles.push([index(a)?, index(b)?]),
            _ => return Err(format!("row {}: {line}", at + 1)),
        }
    }
    if !contacts.is_empty() && !triangles.is_empty() {
        return Err("rows have both kinds".into());
    }
    contacts.sort_unstable();
    triangles.sort_unstable();
    Ok(if contacts.is_empty() { List::Triangles(triangles) } else { List::Contacts(contacts) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_are_read() {
        let contacts = parse("kind,a,b\nee,3,1\nvf,2,7\n").expect("a list");
        assert_eq!(contacts, List::Contacts(vec![(Kind::Vf, 2, 7), (Kind::Ee, 3, 1)]));
        assert_eq!(parse("tri_a,tri_b\n4,5\n1,2\n"), Ok(List::Triangles(vec![[1, 2], [4, 5]])));
        assert_eq!(parse("4,5\n"), Ok(List::Triangles(vec![[4, 5]])));
        for bad in ["vf,1,2\n3,4\n", "vf,1\n1,2,3\n", "1,2\nx,y\n", "vf,1,x\n"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
