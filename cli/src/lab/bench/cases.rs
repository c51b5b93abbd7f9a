//! The scenes: a fixed list, and meshes from files.

use crate::args::{BenchArgs, Question};
use crate::detect::body;
use crate::stem;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::{BodyId, BodyKind, CollisionFilter, Motion, Scene};
use nearmiss_lab::scene::{Bodies, scene};
use std::path::PathBuf;

/// Triangles of the scenes of one mesh, about: a frame takes milliseconds on a CPU.
const TRIANGLES: usize = 20_000;
/// The same of the one that is simulated until the cloth has fallen.
const SIMULATED: usize = 10_000;
/// Seed of the random ones.
const SEED: u64 = 1;

/// A scene that is made here.
pub struct Generated {
    /// How it is named.
    pub name: &'static str,
    /// Its description.
    pub about: &'static str,
    make: fn() -> Result<Scene, Error>,
}

/// The list. A name keeps its scene and size, so that files of figures can be compared: another
/// scene or size gets another name.
pub const GENERATED: [Generated; 7] = [
    Generated {
        name: "draped",
        about: "a cloth with pleats that sinks on a ball, made by formula; one mesh of about 20,000 triangles",
        make: || Ok(scene("draped", TRIANGLES, SEED)?.into()),
    },
    Generated {
        name: "cloth-ball",
        about: "a cloth that fell on a turning ball, simulated; one mesh of about 10,000 triangles",
        make: || Ok(scene("cloth-ball", SIMULATED, SEED)?.into()),
    },
    Generated {
        name: "soup",
        about: "20,000 random triangles, each corner moving on its own",
        make: || Ok(scene("soup-moving", TRIANGLES, SEED)?.into()),
    },
    Generated {
        name: "balls",
        about: "balls that fly through each other; one mesh of about 20,000 triangles",
        make: || Ok(scene("balls", TRIANGLES, SEED)?.into()),
    },
    Generated {
        name: "pile",
        about: "200 rigid balls under a cloth, on fixed ground",
        make: || at_first_step(&Bodies::pile(200, 60, 40)?),
    },
    Generated {
        name: "worlds",
        about: "100 environments of eight rigid balls each, in one place",
        make: || at_first_step(&Bodies::worlds(100, 8)?),
    },
    Generated {
        name: "apart",
        about: "the cloth of draped twice, side by side: two bodies without a contact",
        make: || apart(scene("draped", TRIANGLES, SEED)?),
    },
];

/// Many bodies in their first step.
fn at_first_step(all: &Bodies) -> Result<Scene, Error> {
    let moves = all.step(0);
    let mut scene = Scene::new();
    for id in all.scene.ids() {
        // Numbers are given in order: each body keeps its own.
        let Some(body) = all.scene.get(id).cloned() else { continue };
        let to = moves.iter().find(|(moved, _)| *moved == id);
        scene.add(match to {
            Some((_, to)) => body.at(to.input())?,
            None => body,
        });
    }
    Ok(scene)
}

/// A body and its copy, moved along x by a twentieth more than its extent.
fn apart(body: Body) -> Result<Scene, Error> {
    let all: Vec<[f64; 3]> = body.ends().iter().flat_map(|end| end.to_f64()).collect();
    let low = all.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
    let high = all.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
    let by = 1.05 * (high - low);
    let beside = |end: &Positions| {
        let points = end.to_f64().into_iter().map(|[x, y, z]| [x + by, y, z].map(|x| x as f32)).collect();
        Mesh::new("beside", Positions::F32(points), body.faces().to_vec())
    };
    let [t0, t1] = body.ends().map(beside);
    let other = Body::moving(t0?, t1?)?;
    Ok([body, other].map(|body| body.with_filter(CollisionFilter::without_self_collision())).to_vec().into())
}

/// The source of a case.
enum Source {
    Generated(fn() -> Result<Scene, Error>),
    Files(Vec<PathBuf>),
}

/// A case that was chosen: nothing is made or read yet.
pub struct Chosen {
    /// Its name: in the list, or of its first file.
    pub name: String,
    source: Source,
}

impl Chosen {
    /// Makes the scene, or reads the files.
    ///
    /// # Errors
    /// Those of reading; memory.
    pub fn make(&self) -> Result<Scene, Error> {
        match &self.source {
            Source::Generated(make) => make(),
            Source::Files(files) => Ok(body(files)?.into()),
        }
    }
}

/// The cases that the arguments name, in the order of the list, meshes last; of no names all.
///
/// # Errors
/// [`Error::InvalidArgument`] for a name that no case has, and for one that two have.
pub fn chosen(args: &BenchArgs) -> Result<Vec<Chosen>, Error> {
    let made =
        GENERATED.iter().map(|of| Chosen { name: of.name.to_owned(), source: Source::Generated(of.make) });
    let read = args.meshes.iter().filter_map(|files| {
        let name = stem(files.first()?);
        Some(Chosen { name, source: Source::Files(files.clone()) })
    });
    let mut all: Vec<Chosen> = made.chain(read).collect();
    let names: Vec<String> = all.iter().map(|case| case.name.clone()).collect();
    if let Some((_, twice)) = names.iter().enumerate().find(|(at, name)| names[..*at].contains(name)) {
        return Err(Error::InvalidArgument {
            what: format!("--mesh names a case twice, got {twice}"),
            advice: "rename the file".into(),
        });
    }
    if let Some(unknown) = args.case.iter().find(|name| !names.contains(name)) {
        return Err(Error::InvalidArgument {
            what: format!("--case is unknown, got {unknown}"),
            advice: format!("use one of: {}", names.join(", ")),
        });
    }
    let read = &names[GENERATED.len()..];
    if let Some(left_out) = read.iter().find(|name| !args.has_case(name)) {
        return Err(Error::InvalidArgument {
            what: format!("--mesh {left_out} has no effect: --case names other cases"),
            advice: format!("add {left_out} to --case, or remove it"),
        });
    }
    all.retain(|case| args.has_case(&case.name));
    Ok(all)
}

/// The questions that were chosen, of no names all, each once.
pub fn questions(args: &BenchArgs) -> impl Iterator<Item = Question> {
    use clap::ValueEnum;
    let all = Question::value_variants().iter().copied();
    all.filter(|question| args.has_question(question.name()))
}

/// The motions of all bodies that can move, for the step of the scene.
pub fn inputs(scene: &Scene) -> Vec<(BodyId, Motion<'_>)> {
    let input = |id| {
        let body = scene.get(id)?;
        let to = match body.kind() {
            BodyKind::Rigid => Motion::PoseStep(body.pose_step()),
            BodyKind::Deformable if body.is_moving() => Motion::Step(body.ends().map(Into::into)),
            BodyKind::Deformable => Motion::positions(body.positions_t0()),
            // Other kinds do not move.
            _ => return None,
        };
        Some((id, to))
    };
    scene.ids().filter_map(input).collect()
}
