//! Exclusions of a scene file: of a body, and pairs of vertices of two.

use super::file::wrong;
use super::parts;
use crate::meshes::Reader;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::scene::{Exclusions, RestShape, Scene};
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// `exclude` of a body.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExcludeTable {
    ring: Option<u32>,
    within: Option<f64>,
    rest: Option<PathBuf>,
    #[serde(default)]
    faces: Vec<u32>,
}

impl ExcludeTable {
    /// The fault of a table whose keys do not go together, and its remedy.
    pub fn fault(&self) -> Option<[&'static str; 2]> {
        let lacks = self.rest.is_some() && self.within.is_none();
        lacks.then_some([
            "`exclude` has `rest` without `within`",
            "add the distance `within`, or remove `rest`",
        ])
    }

    /// The file of the rest shape, as the scene names it.
    pub fn rest(&self) -> Option<&Path> {
        self.rest.as_deref()
    }

    /// The exclusions of a body. Without a file its first frame is the rest shape.
    ///
    /// # Errors
    /// Those of reading.
    pub fn read(&self, folder: &Path, body: &Body, reader: &mut Reader) -> Result<Exclusions, Error> {
        let rest = match (self.within, &self.rest) {
            (Some(within), None) => Some(RestShape { within, positions: body.positions_t0().clone() }),
            (Some(within), Some(file)) => {
                let positions = reader.mesh(&folder.join(file))?.mesh().positions().clone();
                Some(RestShape { within, positions })
            }
            _ => None,
        };
        Ok(Exclusions { ring: self.ring, rest, faces: self.faces.clone() })
    }
}

/// A table of `exclude_pairs`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairsTable {
    bodies: [String; 2],
    vertices: Vec<[u32; 2]>,
}

/// Pairs of vertices of two bodies, by their places.
pub struct ExcludedPairs {
    /// The bodies.
    pub bodies: [usize; 2],
    /// The pairs.
    pub vertices: Vec<[u32; 2]>,
    line: usize,
}

/// The pairs of vertices of a file's tables; `line` is the line of a place in the file.
///
/// # Errors
/// [`Error::Input`] for a name that no body has, and for two tables of the same bodies.
pub fn pairs(
    path: &Path,
    tables: Vec<Spanned<PairsTable>>,
    line: impl Fn(usize) -> usize,
    names: &HashMap<String, usize>,
) -> Result<Vec<ExcludedPairs>, Error> {
    let mut seen: HashMap<[usize; 2], usize> = HashMap::new();
    let mut all = Vec::with_capacity(tables.len());
    for table in tables {
        let line = line(table.span().start);
        let PairsTable { bodies: [a, b], vertices } = table.into_inner();
        let bad =
            |what: String, advice: &str| wrong(path, format!("line {line}: `exclude_pairs` {what}"), advice);
        let of = |name: &String| {
            let place = names.get(name).copied();
            place.ok_or_else(|| bad(format!("names {name:?}, which no body is"), "use the `name` of a body"))
        };
        let bodies = [of(&a)?, of(&b)?];
        let key = [bodies[0].min(bodies[1]), bodies[0].max(bodies[1])];
        if let Some(other) = seen.insert(key, line) {
            let what = format!("has {a:?} and {b:?}, as that of line {other} has");
            return Err(bad(what, "write the pairs of two bodies into one table"));
        }
        all.push(ExcludedPairs { bodies, vertices, line });
    }
    Ok(all)
}

/// Excludes pairs of features of a scene, whose bodies have the numbers of their places.
///
/// # Errors
/// Those of the scene, with the place in the file: the body as messages call it, or a line.
pub fn exclude(
    scene: &mut Scene,
    own: &[(usize, Exclusions)],
    pairs: &[ExcludedPairs],
    (path, called): (&Path, &[String]),
) -> Result<(), Error> {
    let ids: Vec<_> = scene.ids().collect();
    for (body, exclusions) in own {
        scene.exclude(ids[*body], exclusions.clone()).map_err(|error| {
            let (what, advice) = parts(&error);
            wrong(path, format!("{}: `exclude`: {what}", called[*body]), advice)
        })?;
    }
    for ExcludedPairs { bodies, vertices, line } in pairs {
        scene.exclude_pairs(bodies.map(|body| ids[body]), vertices).map_err(|error| {
            let (what, advice) = parts(&error);
            wrong(path, format!("line {line}: `exclude_pairs`: {what}"), advice)
        })?;
    }
    Ok(())
}
