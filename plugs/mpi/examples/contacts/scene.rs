//! Scenes of files: a TOML file of the program `nearmiss`, read by the same source, or meshes.

use crate::meshes::Reader;
use crate::sequence::exclusions::exclude;
use crate::sequence::file::{self, Described, wrong};
use crate::sequence::poses::Poses;
use crate::sequence::{folder_of, parts};
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, BodyKind, Motion, Scene};
use nearmiss::{Body, Error};
use nearmiss_io::MeshFile;
use std::path::{Path, PathBuf};

/// Places of a body, frame by frame; one of a body at rest.
enum Track {
    Positions(Vec<Positions>),
    Poses(Poses),
}

impl Track {
    /// Motion for a step or frame; none of a body at rest.
    fn motion(&self, at: usize, at_rest: bool) -> Option<Motion<'_>> {
        match self {
            Track::Positions(all) if all.len() < 2 => None,
            Track::Poses(all) if all.frames.len() < 2 => None,
            Track::Positions(all) if at_rest => Some(Motion::positions(&all[at])),
            Track::Positions(all) => Some(Motion::step(&all[at], &all[at + 1])),
            Track::Poses(all) if at_rest => Some(Motion::pose(all.frames[at])),
            Track::Poses(all) => Some(Motion::PoseStep(all.steps[at])),
        }
    }
}

/// A scene and its frames.
pub struct Film {
    /// The bodies at the first frame.
    pub scene: Scene,
    tracks: Vec<Track>,
    /// Number of frames.
    pub frames: usize,
}

impl Film {
    /// Reads a scene file, or the frames of a mesh.
    ///
    /// # Errors
    /// Those of reading.
    pub fn read(files: &[PathBuf]) -> Result<Film, Error> {
        let mut reader = Reader::default();
        let is_scene = |path: &PathBuf| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        if let [path] = files
            && is_scene(path)
        {
            return of_scene(path, &mut reader);
        }
        let (mesh, frames) = frames(files, &mut reader)?;
        let scene = Body::deformable(mesh.into_mesh()).into();
        Ok(Film { scene, frames: frames.len(), tracks: vec![Track::Positions(frames)] })
    }

    /// Number of steps, or of frames at rest.
    pub fn steps(&self, at_rest: bool) -> usize {
        if at_rest { self.frames } else { self.frames.saturating_sub(1).max(1) }
    }

    /// Motions of bodies for a step or frame; none of bodies at rest.
    pub fn motions(&self, at: usize, at_rest: bool) -> Vec<(usize, Motion<'_>)> {
        let motions = self.tracks.iter().map(|track| track.motion(at, at_rest)).enumerate();
        motions.filter_map(|(body, motion)| motion.map(|motion| (body, motion))).collect()
    }
}

/// Reads the frames of a mesh: in doubles, if one of them is.
fn frames(files: &[PathBuf], reader: &mut Reader) -> Result<(MeshFile, Vec<Positions>), Error> {
    let Some(first) = files.first() else {
        return Err(Error::InvalidArgument {
            what: "no file was given".into(),
            advice: "give a scene (.toml), a mesh, or the frames of a mesh".into(),
        });
    };
    let mesh = reader.mesh(first)?;
    let mut all = vec![mesh.mesh().positions().clone()];
    for file in &files[1..] {
        all.push(reader.frame(&mesh, file)?.mesh().positions().clone());
    }
    if all.iter().any(Positions::is_f64) {
        all = all.iter().map(|frame| Positions::F64(frame.to_f64())).collect();
    }
    Ok((mesh, all))
}

fn of_scene(path: &Path, reader: &mut Reader) -> Result<Film, Error> {
    let described = file::read(path)?;
    let folder = folder_of(path);
    let (mut scene, mut tracks) = (Scene::new(), Vec::new());
    let mut exclusions = Vec::new();
    for (at, table) in described.bodies.iter().enumerate() {
        let (body, track) = of_table((path, folder), table, reader)?;
        if let Some(table) = &table.exclude {
            exclusions.push((at, table.read(folder, &body, reader)?));
        }
        scene.add(body);
        tracks.push(track);
    }
    let ids: Vec<BodyId> = scene.ids().collect();
    scene.leave_out(&described.left_out.iter().map(|pair| pair.map(|at| ids[at])).collect::<Vec<_>>())?;
    let called: Vec<String> = described.bodies.iter().map(|body| body.called.clone()).collect();
    exclude(&mut scene, &exclusions, &described.pairs, (path, &called))?;
    let count = |track: &Track| match track {
        Track::Positions(all) => all.len(),
        Track::Poses(all) => all.frames.len(),
    };
    let frames = tracks.iter().map(count).max().unwrap_or(1);
    if let Some(at) = tracks.iter().position(|track| ![1, frames].contains(&count(track))) {
        let what = format!("{} has {} frames, and others have {frames}", called[at], count(&tracks[at]));
        return Err(wrong(path, what, "give one for a body at rest, or as many as the others"));
    }
    Ok(Film { scene, tracks, frames })
}

fn of_table(
    (path, folder): (&Path, &Path),
    table: &Described,
    reader: &mut Reader,
) -> Result<(Body, Track), Error> {
    let files: Vec<PathBuf> = table.meshes.iter().map(|mesh| folder.join(mesh)).collect();
    let (mesh, positions) = frames(&files, reader)?;
    let mesh = mesh.into_mesh();
    let (body, track) = match table.kind {
        BodyKind::Fixed => (Body::fixed(mesh), Track::Positions(positions)),
        BodyKind::Rigid => {
            let body = Body::rigid(mesh);
            let poses =
                || (0..table.poses.frames.len()).try_for_each(|at| body.check(&table.poses.up_to(at)));
            poses().map_err(|error| {
                let (what, advice) = parts(&error);
                wrong(path, format!("{}: `poses`: {what}", table.called), advice)
            })?;
            (body.at(table.poses.frames[0])?, Track::Poses(table.poses.clone()))
        }
        _ => (Body::deformable(mesh), Track::Positions(positions)),
    };
    let body = body.with_filter(table.filter).with_thickness(table.thickness.clone());
    body.validate()?;
    Ok((body, track))
}
