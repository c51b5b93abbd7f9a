//! Options that would have no effect: refused, with the reason and a remedy.

use super::research::TraversalArg;
use super::{Command, DetectArgs, ExplainArgs, Lab, MachineArgs, SceneArgs, Table, TablesArgs, TradeArgs};
use crate::output::is_stdout;
use clap::ArgMatches;
use clap::parser::ValueSource;
use nearmiss::device::Backend;
use nearmiss::error::Error;
use nearmiss_lab::scene::{ANIMATIONS, SEEDED};
use std::path::PathBuf;

/// Checks the options of a command.
///
/// # Errors
/// [`Error::InvalidArgument`] with the first that would have no effect.
pub fn check(command: &Command, own: &ArgMatches) -> Result<(), Error> {
    let given = CommandLine(own);
    match command {
        Command::Detect(args) => {
            if args.out.out_mesh.is_none() {
                given.none_of(&["heat"], "no mesh is coloured", "remove it, or add --out-mesh FILE")?;
            }
            detect(args, given)
        }
        Command::Picture(args) => drawn(&args.detect, "a picture shows a frame", given),
        Command::View(args) => drawn(&args.detect, "a page shows frames and rows", given),
        Command::Explain(args) => explain(args, given),
        Command::Lab(lab) => match &lab.command {
            Lab::Plan(args) => plan(&args.detect, given),
            Lab::Scene(args) => scene(args, given),
            Lab::Tables(args) => tables(args, given),
            Lab::Trade(args) => trade(args, given),
            Lab::Bench(args) => machine(&args.machine, given),
            Lab::Turns(_) => Ok(()),
        },
        Command::Check(args) => {
            if args.meshes.len() == 1 {
                given.none_of(&["each"], "there is one mesh", "remove it")?;
            }
            one_output(args.json, [&args.out_mesh, &args.picture])?;
            machine(&args.machine, given)
        }
        Command::Selftest(_) | Command::Completions(_) | Command::Man(_) => Ok(()),
    }
}

/// The options that are on the command line, without defaults.
#[derive(Clone, Copy)]
struct CommandLine<'a>(&'a ArgMatches);

impl CommandLine<'_> {
    fn has(self, option: &str) -> bool {
        self.0.value_source(option) == Some(ValueSource::CommandLine)
    }

    /// Refuses the first of these options that is there.
    fn none_of(self, options: &[&str], why: &str, advice: &str) -> Result<(), Error> {
        match options.iter().find(|option| self.has(option)) {
            None => Ok(()),
            Some(option) => Err(Error::InvalidArgument {
                what: format!("--{} has no effect: {why}", option.replace('_', "-")),
                advice: advice.into(),
            }),
        }
    }
}

fn machine(args: &MachineArgs, given: CommandLine) -> Result<(), Error> {
    if args.backend == Backend::Cuda {
        given.none_of(&["threads"], "a GPU has no CPU threads", "remove it, or use --backend cpu")?;
    }
    Ok(())
}

/// Refuses to print JSON where a file is written.
fn one_output(json: bool, files: [&Option<PathBuf>; 2]) -> Result<(), Error> {
    match json && files.into_iter().flatten().any(|file| is_stdout(file)) {
        true => Err(Error::InvalidArgument {
            what: "--json cannot be used with a file on standard output (-)".into(),
            advice: "name a file".into(),
        }),
        false => Ok(()),
    }
}

/// Options of continuous queries alone.
const OF_STEPS: [&str; 4] = ["tolerance", "max_iterations", "min_separation", "approaching"];

fn detect(args: &DetectArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    one_output(args.out.json, [&args.out.out, &args.out.out_mesh])?;
    let (query, research) = (&args.query, &args.research);
    if research.traversal != Some(TraversalArg::PerLeafSpill) {
        let why = "only the walk per-leaf-spill spills";
        given.none_of(&["budget"], why, "remove it, or add --traversal per-leaf-spill")?;
    }
    if !research.traversal.is_some_and(TraversalArg::has_queues) {
        let why = "the walk has no queues";
        let advice = "remove it, or add --traversal queue, queue-gtx285, steal or front";
        given.none_of(&["cores", "queue"], why, advice)?;
    }
    let of_steps = "remove it, or use --continuous or --earliest";
    if query.distance {
        given.none_of(&OF_STEPS, "the distance at t = 0 has no such limit", of_steps)?;
        let why = "a distance is between bodies, never within one";
        given.none_of(
            &["adjacent", "only_crossing", "no_self_collision"],
            why,
            "remove it, or use --discrete",
        )?;
        given.none_of(&["traversal"], "a distance has its own walk", "remove it")?;
        given.none_of(&["file_faces"], "the nearest points are weights of a triangle", "remove it")?;
    }
    if query.body_pairs || query.body_distances.is_some() {
        given.none_of(&OF_STEPS, "bodies at t = 0 have no such limit", of_steps)?;
        let why = "pairs of bodies are tested, never one body";
        let own = ["adjacent", "only_crossing", "no_self_collision"];
        given.none_of(&own, why, "remove it, or use --discrete")?;
        given.none_of(&["file_faces"], "rows name bodies, or triangles with weights", "remove it")?;
    }
    if query.near.is_some() {
        given.none_of(&OF_STEPS, "the distances at t = 0 have no such limit", of_steps)?;
        let why = "features of adjacent triangles are always tested";
        given.none_of(&["adjacent"], why, "remove it, or use --discrete")?;
        given.none_of(&["only_crossing"], "near features do not show it", "remove it, or use --discrete")?;
        given.none_of(&["file_faces"], "the nearest points are weights of a triangle", "remove it")?;
    }
    if query.with.is_empty() {
        let advice = "remove it, or add --with MESH; in a scene file write self_collision = false";
        given.none_of(&["no_self_collision"], "there is no second mesh", advice)?;
    }
    if query.scene.is_none() {
        let why = "the bodies are read from files";
        given.none_of(&["triangles", "seed"], why, "remove it, or give --scene NAME instead of files")?;
    }
    query.scene.as_deref().map_or(Ok(()), |scene| of_generated(scene, given))
}

/// Options of a generated scene.
fn of_generated(scene: &str, given: CommandLine) -> Result<(), Error> {
    if scene == "single" {
        given.none_of(&["triangles"], "the scene single has one triangle", "remove it, or use soup")?;
    }
    if !SEEDED.contains(&scene) {
        let why = format!("the scene {scene} has no random numbers");
        let advice = format!("remove it, or use one of: {}", SEEDED.join(", "));
        given.none_of(&["seed"], &why, &advice)?;
    }
    Ok(())
}

fn plan(args: &DetectArgs, given: CommandLine) -> Result<(), Error> {
    let idle = [
        "repeat",
        "only",
        "out",
        "verbose",
        "geometry",
        "out_mesh",
        "rebuild",
        "rebuild_every",
        "heat",
        "fail_on",
        "keep_going",
    ];
    given.none_of(&idle, "a plan shows the costs of one frame", "remove it, or use detect")?;
    detect(args, given)
}

/// Options of a picture and of a page.
fn drawn(args: &DetectArgs, why: &str, given: CommandLine) -> Result<(), Error> {
    given.none_of(&super::picture::IDLE, why, "remove it, or use detect")?;
    detect(args, given)
}

fn explain(args: &ExplainArgs, given: CommandLine) -> Result<(), Error> {
    if args.tt.is_some() {
        let why = "triangles at t = 0 are decided exactly";
        given.none_of(&["tolerance", "max_iterations"], why, "remove it, or use --vf or --ee")?;
    }
    Ok(())
}

fn scene(args: &SceneArgs, given: CommandLine) -> Result<(), Error> {
    if !ANIMATIONS.contains(&args.name.as_str()) {
        let why = format!("{} is not simulated", args.name);
        let advice = format!("remove it, or use one of: {}", ANIMATIONS.join(", "));
        given.none_of(&["skip", "contact"], &why, &advice)?;
    }
    if args.name == "n-body" {
        let advice = "remove it, or use cloth-ball, flamenco or princess";
        given.none_of(&["contact"], "n-body has no cloth", advice)?;
    }
    of_generated(&args.name, given)
}

fn tables(args: &TablesArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    if !args.mesh.is_empty() {
        let why = "the frames are read from --mesh";
        given.none_of(&["triangles", "frames", "seed"], why, "remove it, or remove --mesh")?;
    }
    let is_of = |figure: fn(&Table) -> bool| args.table.iter().any(figure);
    let is_scaled = is_of(|table| matches!(table, Table::Scale));
    if !is_scaled {
        let why = "only the table scale divides frames among devices";
        given.none_of(&["devices"], why, "remove it, or add --table scale")?;
    }
    let is_of_scenes = |table: &Table| !matches!(table, Table::Bodies | Table::Scale);
    if !args.table.is_empty() && !is_of(is_of_scenes) {
        let why = "no table of a single scene is measured";
        let advice = "remove it, or add --table 6.12, 6.13, 6.14 or front";
        given.none_of(&["scene", "mesh", "seed", "bounding_volume", "profile"], why, advice)?;
        if !is_scaled {
            let why = "the scenes of the table bodies have one size";
            given.none_of(&["triangles"], why, "remove it, or add --table scale")?;
        }
    }
    let frames = |table: &Table| matches!(table, Table::Frame | Table::Shares);
    if !args.table.is_empty() && !args.table.iter().any(frames) {
        let why = "no frame is measured";
        given.none_of(&["rebuild_every"], why, "remove it, or add --table 6.13 or 6.14")?;
    }
    Ok(())
}

fn trade(args: &TradeArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    if !args.full && (!args.mesh.is_empty() || args.queries.is_some()) {
        let why = "--mesh and --queries generate no scenes and cases";
        let made = ["scene", "triangles", "frames", "cases", "seed"];
        given.none_of(&made, why, "remove it, or add --full")?;
    }
    Ok(())
}
