//! Files of scenes: TOML, a table a body, pairs of bodies that are left out, and pairs of vertices.

use super::exclusions::{ExcludeTable, ExcludedPairs, PairsTable, pairs};
use super::globs;
use super::poses::{PathName, PoseTable, Poses};
use nearmiss::Thickness;
use nearmiss::error::Error;
use nearmiss::mesh::Problem;
use nearmiss::scene::{BodyKind, CollisionFilter};
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use toml::{Spanned, Table, Value};

/// A body as a file describes it.
pub struct Described {
    /// Its own, or its first mesh's.
    pub name: String,
    /// A mesh a frame, or one.
    pub meshes: Vec<PathBuf>,
    /// Its kind.
    pub kind: BodyKind,
    /// A pose a frame, or one, or none; and the steps between them.
    pub poses: Poses,
    /// Its filter.
    pub filter: CollisionFilter,
    /// Its thickness.
    pub thickness: Thickness,
    /// Features that it excludes.
    pub exclude: Option<ExcludeTable>,
    /// How messages call it: its name, and the line at which it begins.
    pub called: String,
}

impl Described {
    /// All files that it names.
    pub fn files(self) -> Vec<PathBuf> {
        let rest = self.exclude.as_ref().and_then(ExcludeTable::rest).map(Path::to_path_buf);
        self.meshes.into_iter().chain(rest).collect()
    }
}

/// A scene as a file describes it.
#[derive(Default)]
pub struct SceneFile {
    /// Bodies.
    pub bodies: Vec<Described>,
    /// Pairs of them that are left out, by their places.
    pub left_out: Vec<[usize; 2]>,
    /// Pairs of vertices that are excluded.
    pub pairs: Vec<ExcludedPairs>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Whole {
    #[serde(default)]
    body: Vec<Spanned<Table>>,
    #[serde(default)]
    leave_out: Vec<Spanned<[String; 2]>>,
    #[serde(default)]
    exclude_pairs: Vec<Spanned<PairsTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyTable {
    name: Option<String>,
    mesh: Option<PathBuf>,
    meshes: Option<Names>,
    #[serde(default)]
    kind: Kind,
    poses: Option<Vec<PoseTable>>,
    pivot: Option<[f64; 3]>,
    path: Option<PathName>,
    environment: Option<Value>,
    group: Option<u32>,
    mask: Option<u32>,
    self_collision: Option<bool>,
    #[serde(default)]
    thickness: Radii,
    exclude: Option<ExcludeTable>,
}

/// A pattern, or files and patterns.
#[derive(Deserialize)]
#[serde(untagged, expecting = "`meshes` must be a pattern such as \"cloth.*.ply\", or a list of files")]
enum Names {
    One(PathBuf),
    All(Vec<PathBuf>),
}

/// A radius, or one for each vertex.
#[derive(Deserialize)]
#[serde(untagged, expecting = "`thickness` must be a number, or a list of numbers")]
enum Radii {
    Same(f64),
    Each(Vec<f64>),
}

impl Default for Radii {
    fn default() -> Radii {
        Radii::Same(0.0)
    }
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Fixed,
    Rigid,
    #[default]
    Deformable,
}

/// Most bytes of memory that a byte of a file takes: arrays of short numbers take most.
const MULTIPLE: u64 = 64;

/// A fault of a scene, as an error that names its file.
pub fn wrong(file: &Path, what: impl Into<String>, advice: impl Into<String>) -> Error {
    let problem = Problem::Scene { what: what.into(), advice: advice.into() };
    Error::Input { file: file.display().to_string(), problem }
}

/// Reads a file of a scene; meshes are named, and not looked at.
///
/// # Errors
/// [`Error::Input`], naming the file, the body, the key and the value.
pub fn read(path: &Path) -> Result<SceneFile, Error> {
    let text = text(path)?;
    let ends: Vec<usize> = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(at, _)| at).collect();
    let line = |at: usize| 1 + ends.partition_point(|end| *end < at);
    let whole: Whole = toml::from_str(&text).map_err(|e| {
        let place = e.span().map_or(String::new(), |span| format!("line {}: ", line(span.start)));
        wrong(path, format!("{place}{}", e.message()), "a scene has one table [[body]] for each body")
    })?;
    if whole.body.is_empty() {
        return Err(wrong(path, "has no bodies", "add a table [[body]] for each"));
    }
    let count = whole.body.len();
    let mut all: Vec<Described> = Vec::with_capacity(count);
    let mut names: HashMap<String, usize> = HashMap::with_capacity(count);
    for table in whole.body {
        let body = described(path, line(table.span().start), table.into_inner())?;
        if let Some(other) = names.insert(body.name.clone(), all.len()) {
            let what = format!("{} has the name of {}", body.called, all[other].called);
            return Err(wrong(path, what, "give each body its own `name`"));
        }
        all.push(body);
    }
    let left_out = whole.leave_out.into_iter();
    let left_out = left_out.map(|pair| pair_of(path, line(pair.span().start), pair.get_ref(), &names));
    let left_out = left_out.collect::<Result<_, _>>()?;
    Ok(SceneFile { left_out, pairs: pairs(path, whole.exclude_pairs, line, &names)?, bodies: all })
}

/// A pair of `leave_out`, by places.
fn pair_of(
    path: &Path,
    line: usize,
    pair: &[String; 2],
    names: &HashMap<String, usize>,
) -> Result<[usize; 2], Error> {
    let [a, b] = pair;
    let bad = |what: String, advice: &str| {
        wrong(path, format!("line {line}: `leave_out` has the pair [{a:?}, {b:?}], and {what}"), advice)
    };
    let of = |name: &String| {
        let place = names.get(name).copied();
        place.ok_or_else(|| bad(format!("no body is named {name:?}"), "use the `name` of a body"))
    };
    let places = [of(a)?, of(b)?];
    if places[0] == places[1] {
        return Err(bad("that is one body".into(), "set its `self_collision` to false"));
    }
    Ok(places)
}

/// A regular file's text.
///
/// # Errors
/// [`Error::Input`] with the system's text; [`Error::OutOfMemory`].
pub fn text(path: &Path) -> Result<String, Error> {
    nearmiss_io::file::text(path, MULTIPLE)
}

fn described(path: &Path, line: usize, table: Table) -> Result<Described, Error> {
    let named = table.get("name").and_then(Value::as_str).map(str::to_owned);
    let called = match &named {
        Some(name) => format!("body {name:?} (line {line})"),
        None => format!("the body of line {line}"),
    };
    let bad = |what: &str, advice: &str| wrong(path, format!("{called}: {what}"), advice);
    let table: BodyTable = table.try_into().map_err(|e: toml::de::Error| {
        // The place in the table is on a line of its own.
        bad(e.to_string().trim().replace('\n', ", ").as_str(), "docs/cli.md lists the keys and their values")
    })?;
    let meshes = match (table.mesh, table.meshes) {
        (Some(mesh), None) => vec![mesh],
        (None, Some(Names::One(pattern))) => vec![pattern],
        (None, Some(Names::All(meshes))) if !meshes.is_empty() => meshes,
        (None, Some(_)) => return Err(bad("`meshes` is empty", "name one file per frame, or use `mesh`")),
        (Some(_), Some(_)) => {
            return Err(bad("`mesh` and `meshes` exclude each other", "remove one of them"));
        }
        (None, None) => {
            return Err(bad("`mesh` is missing", "name a file with `mesh`, or one per frame with `meshes`"));
        }
    };
    let meshes =
        globs::expanded(super::folder_of(path), meshes).map_err(|(what, advice)| bad(&what, advice))?;
    let kind = match table.kind {
        Kind::Fixed => BodyKind::Fixed,
        Kind::Rigid => BodyKind::Rigid,
        Kind::Deformable => BodyKind::Deformable,
    };
    if meshes.len() > 1 && kind != BodyKind::Deformable {
        let what =
            format!("`meshes` must name one file if the body is {}, got {}", name_of(kind), meshes.len());
        return Err(bad(&what, "use `mesh`, or make the body deformable"));
    }
    let path = (table.pivot, table.path);
    for (key, is_given) in [("pivot", path.0.is_some()), ("path", path.1.is_some())] {
        if is_given && kind != BodyKind::Rigid {
            let what = format!("`{key}` cannot be used if the body is {}", name_of(kind));
            return Err(bad(&what, "remove it, or make the body rigid"));
        }
    }
    let poses = match table.poses {
        Some(_) if kind != BodyKind::Rigid => {
            let what = format!("`poses` cannot be used if the body is {}", name_of(kind));
            return Err(bad(&what, "remove them, or make the body rigid"));
        }
        Some(poses) if poses.is_empty() => {
            return Err(bad("`poses` is empty", "give one, or one per frame, or remove it"));
        }
        poses => Poses::of(poses.unwrap_or_default(), path).map_err(|(what, advice)| bad(&what, &advice))?,
    };
    let environment = match &table.environment {
        None => Some(0),
        Some(Value::String(all)) if all == "all" => None,
        Some(Value::Integer(number)) if u32::try_from(*number).is_ok() => Some(*number as u32),
        Some(other) => {
            let what = format!(
                "`environment` must be a number from 0 to 4294967295 or \"all\", got {}",
                shown(other)
            );
            return Err(bad(&what, "correct it"));
        }
    };
    let (group, mask) = (table.group.unwrap_or(u32::MAX), table.mask.unwrap_or(u32::MAX));
    if group == 0 {
        return Err(bad(
            "`group` is 0: the body is in no group",
            "set `mask = 0` if it collides with no other",
        ));
    }
    if kind == BodyKind::Fixed && table.self_collision == Some(true) {
        let what = "`self_collision` is true, and a fixed body never collides with itself";
        return Err(bad(what, "remove it, or make the body rigid or deformable"));
    }
    if let Some([what, advice]) = table.exclude.as_ref().and_then(ExcludeTable::fault) {
        return Err(bad(what, advice));
    }
    let (self_collision, exclude) = (table.self_collision, table.exclude);
    let stem = || crate::stem(&meshes[0]);
    let name = table.name.unwrap_or_else(stem);
    let called = format!("body {name:?} (line {line})");
    let filter = CollisionFilter { environment, group, mask, self_collision };
    let thickness = match table.thickness {
        Radii::Same(radius) => radius.into(),
        Radii::Each(radii) => radii.into(),
    };
    Ok(Described { name, meshes, kind, poses, filter, thickness, exclude, called })
}

/// As a file names it.
fn name_of(kind: BodyKind) -> &'static str {
    match kind {
        BodyKind::Fixed => "fixed",
        BodyKind::Rigid => "rigid",
        _ => "deformable",
    }
}

/// A value of TOML, no more than a line's worth.
fn shown(value: &Value) -> String {
    let text = match value {
        Value::String(text) => format!("{text:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Boolean(yes) => yes.to_string(),
        other => format!("of type {}", other.type_str()),
    };
    text.chars().take(60).collect()
}
