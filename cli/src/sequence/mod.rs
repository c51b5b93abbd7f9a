//! Several frames of several bodies: from a file of a scene, or from the frames of a mesh.

mod exclusions;
mod file;
mod film;
mod frames;
mod globs;
mod lines;
mod poses;
pub mod steps;
mod walk;

pub use file::text as read_text;
pub use film::{Moment, check as check_name, named};
pub use lines::untested;
pub use steps::PARTIAL;
pub use walk::Walk;

use crate::args::DetectArgs;
use crate::meshes::Reader;
use crate::output::say;
use crate::rows::numbered;
use exclusions::{ExcludedPairs, exclude};
use file::{Described, SceneFile, wrong};
use film::Film;
use frames::Frames;
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::{Body, Positions};
use nearmiss::scene::{BodyId, BodyKind, Exclusions, Motion, Scene};
use nearmiss::words::counted;
use nearmiss_io::{MeshFile, Polygons};
use poses::Poses;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The places of a body, frame by frame. A body with one entry rests.
enum Track {
    /// A deformable body, or a fixed one.
    Positions(Vec<Positions>),
    /// A rigid body.
    Poses(Poses),
}

impl Track {
    fn frames(&self) -> usize {
        match self {
            Track::Positions(all) => all.len(),
            Track::Poses(all) => all.frames.len(),
        }
    }

    /// The place of a vertex at a frame; a body at rest has one.
    fn point(&self, body: &Body, frame: usize, vertex: u32) -> [f64; 3] {
        match self {
            Track::Positions(all) => all[frame].get_f64(vertex as usize).unwrap_or_default(),
            Track::Poses(all) => {
                let own = body.positions_t0().get_f64(vertex as usize).unwrap_or_default();
                all.frames[frame].apply(own)
            }
        }
    }

    /// At a frame, or in the step from it to the next; of what rests there is nothing to say.
    fn input(&self, at: usize, at_rest: bool) -> Option<Motion<'_>> {
        match self {
            _ if self.frames() < 2 => None,
            Track::Positions(all) if at_rest => Some(Motion::positions(&all[at])),
            Track::Positions(all) => Some(Motion::step(&all[at], &all[at + 1])),
            Track::Poses(all) if at_rest => Some(Motion::pose(all.frames[at])),
            Track::Poses(all) => Some(Motion::PoseStep(all.steps[at])),
        }
    }
}

/// A body as its files describe it.
struct Told {
    body: Body,
    track: Track,
    polygons: Polygons,
    /// Its files if there is one a frame, and why some cannot be used.
    files: Vec<PathBuf>,
    reasons: Vec<Option<String>>,
}

/// Bodies and their frames.
pub struct Sequence {
    /// Each as it is at the first frame.
    bodies: Vec<Body>,
    tracks: Vec<Track>,
    /// The faces of each file behind its triangles.
    pub polygons: Vec<Polygons>,
    /// Pairs of bodies that are left out, by their places.
    left_out: Vec<[usize; 2]>,
    excluded: Excluded,
    /// How many frames there are: at least one.
    pub frames: usize,
    /// Their files.
    pub film: Film,
    /// The names of the bodies in rows: those of a scene file, or numbers of several.
    pub names: Option<Vec<String>>,
}

/// Features that a scene file excludes.
#[derive(Default)]
struct Excluded {
    /// Exclusions of bodies, by their places.
    own: Vec<(usize, Exclusions)>,
    pairs: Vec<ExcludedPairs>,
    /// The file, and how messages call its bodies.
    path: PathBuf,
    called: Vec<String>,
}

/// Whether a file is one of a scene.
pub fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

/// All files that the arguments name, and those that a scene names. A scene that cannot be read is an
/// error later, when it is read.
pub fn files(args: &DetectArgs) -> HashSet<PathBuf> {
    let named: Vec<&PathBuf> = args.meshes.iter().chain(&args.query.with).collect();
    let scenes = named.iter().filter(|path| is_scene(path));
    let meshes = scenes.flat_map(|path| {
        let scene = file::read(path).unwrap_or_default();
        scene.bodies.into_iter().flat_map(Described::files).map(|mesh| folder_of(path).join(mesh))
    });
    meshes.chain(named.iter().map(|path| path.to_path_buf())).collect()
}

/// The folder from which a scene names its meshes.
fn folder_of(scene: &Path) -> &Path {
    scene.parent().unwrap_or(Path::new(""))
}

impl Sequence {
    /// A scene file, or frames of a mesh, if the arguments name one. Two frames are one step of a
    /// query in motion, which is no sequence.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for files that do not go together; those of reading.
    pub fn of(args: &DetectArgs, reader: &mut Reader) -> Result<Option<Sequence>, Error> {
        let own = [&args.meshes, &args.query.with];
        let least = if args.kind(true).is_at_rest() { 2 } else { 3 };
        let scenes = own.iter().flat_map(|files| files.iter()).filter(|path| is_scene(path)).count();
        let mut all = match &own {
            [files, with] if scenes > 0 => match (&files[..], &with[..]) {
                ([file], []) if args.query.thickness.is_none() => Sequence::read(file, reader)?,
                ([_], []) => {
                    return Err(Error::InvalidArgument {
                        what: "--thickness cannot be used with a scene (.toml)".into(),
                        advice: "write `thickness = R` in the tables of its bodies".into(),
                    });
                }
                _ => {
                    return Err(Error::InvalidArgument {
                        what: "a scene (.toml) cannot be combined with other files".into(),
                        advice: "give it alone: it names all meshes".into(),
                    });
                }
            },
            _ if own.iter().all(|files| files.len() < least) => return Ok(None),
            _ => {
                let told = own.iter().filter(|files| !files.is_empty()).map(|files| of_mesh(files, reader));
                let mut told = told.collect::<Result<Vec<_>, _>>()?;
                for Told { body, .. } in &mut told {
                    *body = args.body(body.clone());
                }
                let names = numbered(told.len());
                Sequence::new(told, names)
            }
        };
        if args.query.weld {
            all.weld();
        }
        reader.notes.extend(all.film.notes());
        Ok(Some(all))
    }

    fn new(told: Vec<Told>, names: Option<Vec<String>>) -> Sequence {
        let frames = told.iter().map(|one| one.track.frames()).max().unwrap_or(1);
        let files = told.iter().map(|one| &one.files).find(|files| !files.is_empty());
        let film = Film::new(files.cloned().unwrap_or_default());
        let (bodies, tracks, polygons, left_out, excluded) = Default::default();
        let all = Sequence { bodies, tracks, polygons, left_out, excluded, frames, film, names };
        told.into_iter().fold(all, |mut all, Told { body, track, polygons, reasons, .. }| {
            all.film.mark(reasons);
            all.bodies.push(body);
            all.tracks.push(track);
            all.polygons.push(polygons);
            all
        })
    }

    /// Reads a scene and all of its meshes.
    fn read(path: &Path, reader: &mut Reader) -> Result<Sequence, Error> {
        let SceneFile { bodies: described, left_out, pairs } = file::read(path)?;
        let counts = |body: &Described| body.meshes.len().max(body.poses.frames.len());
        let longest =
            described.iter().max_by_key(|body| counts(body)).map(|body| (counts(body), &body.called));
        for body in &described {
            if let Some((most, other)) = longest.filter(|(most, _)| ![1, *most].contains(&counts(body))) {
                let what = format!("{} has {} frames, and {other} has {most}", body.called, counts(body));
                return Err(wrong(path, what, "give one for a body at rest, or as many as the others"));
            }
        }
        let folder = folder_of(path);
        let mut read = HashMap::new();
        let mut told = Vec::with_capacity(described.len());
        for body in &described {
            told.push(of_table((path, folder), body, &mut read, reader)?);
        }
        let mut excluded = Excluded { pairs, path: path.into(), ..Excluded::default() };
        for (at, (table, told)) in described.iter().zip(&told).enumerate() {
            excluded.called.push(table.called.clone());
            if let Some(table) = &table.exclude {
                excluded.own.push((at, table.read(folder, &told.body, reader)?));
            }
        }
        let names = described.into_iter().map(|body| body.name).collect();
        let all = Sequence { left_out, excluded, ..Sequence::new(told, Some(names)) };
        if !(all.excluded.own.is_empty() && all.excluded.pairs.is_empty()) {
            all.scene(true)?;
        }
        Ok(all)
    }

    /// How many questions there are: of what stands still one a frame, else one a step.
    pub fn steps(&self, at_rest: bool) -> usize {
        Sequence::steps_of(self.frames, at_rest)
    }

    /// The same of so many frames.
    pub fn steps_of(frames: usize, at_rest: bool) -> usize {
        if at_rest { frames } else { frames.saturating_sub(1).max(1) }
    }

    /// The scene as the first question has it.
    ///
    /// # Errors
    /// None: every frame and every pair has been looked at.
    pub fn scene(&self, at_rest: bool) -> Result<Scene, Error> {
        let mut bodies = Vec::with_capacity(self.bodies.len());
        for (body, track) in self.bodies.iter().zip(&self.tracks) {
            let body = body.clone();
            bodies.push(match track.input(0, at_rest) {
                Some(input) => body.at(input)?,
                None => body,
            });
        }
        let mut scene = Scene::from(bodies);
        let ids: Vec<BodyId> = scene.ids().collect();
        let pairs: Vec<_> = self.left_out.iter().map(|pair| pair.map(|body| ids[body])).collect();
        scene.leave_out(&pairs)?;
        let Excluded { own, pairs, path, called } = &self.excluded;
        exclude(&mut scene, own, pairs, (path, called))?;
        Ok(scene)
    }

    /// The motions of the bodies for a step or frame.
    pub fn inputs<'a>(&'a self, scene: &Scene, step: usize, at_rest: bool) -> Vec<(BodyId, Motion<'a>)> {
        let inputs = self.tracks.iter().map(|track| track.input(step, at_rest));
        scene.ids().zip(inputs).filter_map(|(id, input)| input.map(|input| (id, input))).collect()
    }

    /// The corners of all elements in all frames.
    pub fn corners(&self) -> impl Iterator<Item = [f64; 3]> + Clone {
        self.bodies.iter().zip(&self.tracks).flat_map(|(body, track)| {
            (0..track.frames()).flat_map(move |frame| {
                body.elements().iter().flatten().map(move |&vertex| track.point(body, frame, vertex))
            })
        })
    }

    fn weld(&mut self) {
        for (body, track) in self.bodies.iter_mut().zip(&self.tracks) {
            let frames: &[Positions] = if let Track::Positions(all) = track { all } else { &[] };
            let (welded, merged) = body.weld_through(frames);
            let vertices = counted(merged as u64, "vertex", "vertices");
            say(&format!("{}: {vertices} merged", body.name()));
            *body = welded;
        }
    }
}

/// A deformable body and its frames.
fn of_mesh(files: &[PathBuf], reader: &mut Reader) -> Result<Told, Error> {
    let Frames { mesh, positions, reasons } = Frames::read(files, reader)?;
    let (polygons, track) = (mesh.polygons().clone(), Track::Positions(positions));
    let files = if files.len() > 1 { files.to_vec() } else { Vec::new() };
    Ok(Told { body: Body::deformable(mesh.into_mesh()), track, polygons, files, reasons })
}

/// Fewest bytes that a copy of a mesh takes for each of its triangles.
const OF_A_TRIANGLE: u64 = 20;

/// A body of a scene; files that several bodies name are read once.
fn of_table(
    (path, folder): (&Path, &Path),
    table: &Described,
    read: &mut HashMap<PathBuf, MeshFile>,
    reader: &mut Reader,
) -> Result<Told, Error> {
    let files: Vec<PathBuf> = table.meshes.iter().map(|mesh| folder.join(mesh)).collect();
    if files.len() > 1 && table.kind != BodyKind::Rigid {
        let told = of_mesh(&files, reader)?;
        let mut body = told.body.with_filter(table.filter).with_thickness(table.thickness.clone());
        validated(&mut body, path, table)?;
        return Ok(Told { body, ..told });
    }
    if !read.contains_key(&files[0]) {
        read.insert(files[0].clone(), reader.mesh(&files[0])?);
    }
    let mesh = read[&files[0]].clone();
    memory::require("the scene's bodies", mesh.mesh().face_count() as u64 * OF_A_TRIANGLE)?;
    let track = match table.kind {
        BodyKind::Rigid => Track::Poses(table.poses.clone()),
        _ => Track::Positions(vec![mesh.mesh().positions().clone()]),
    };
    let polygons = mesh.polygons().clone();
    let mesh = mesh.into_mesh();
    let body = match table.kind {
        BodyKind::Fixed => Body::fixed(mesh),
        BodyKind::Rigid => Body::rigid(mesh),
        _ => Body::deformable(mesh),
    };
    let mut body = body.with_filter(table.filter).with_thickness(table.thickness.clone());
    validated(&mut body, path, table)?;
    if let Track::Poses(poses) = &track {
        for at in 0..poses.frames.len() {
            body.check(&poses.up_to(at)).map_err(|e| {
                let (what, advice) = parts(&e);
                wrong(path, format!("{}: `poses`, the one of frame {at}: {what}", table.called), advice)
            })?;
        }
        body = body.at(poses.frames[0])?;
    }
    Ok(Told { body, track, polygons, files: Vec::new(), reasons: Vec::new() })
}

/// Checks a body of a scene; an error names its table.
fn validated(body: &mut Body, path: &Path, table: &Described) -> Result<(), Error> {
    body.validate().map_err(|e| {
        let (what, advice) = parts(&e);
        wrong(path, format!("{}: {what}", table.called), advice)
    })
}

/// The fault of an error, and its remedy.
pub(super) fn parts(error: &Error) -> (String, String) {
    let text = error.to_string();
    let (what, advice) = text.split_once("; ").unwrap_or((&text, "correct it"));
    (what.into(), advice.into())
}
