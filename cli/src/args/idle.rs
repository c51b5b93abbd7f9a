//! Options that would do nothing: refused, with why and what to do instead.

use super::detect::TraversalArg;
use super::{Command, DetectArgs, MachineArgs, SceneArgs, Table, TablesArgs, TradeArgs};
use crate::explain::ExplainArgs;
use clap::ArgMatches;
use clap::parser::ValueSource;
use nearmiss::device::Backend;
use nearmiss::error::Error;
use nearmiss_lab::scene::{ANIMATIONS, SEEDED};

/// Looks through a command's options.
///
/// # Errors
/// [`Error::InvalidArgument`] with the first that would do nothing.
pub fn check(command: &Command, own: &ArgMatches) -> Result<(), Error> {
    let given = CommandLine(own);
    match command {
        Command::Detect(args) => detect(args, given),
        Command::Plan(args) => plan(&args.detect, given),
        Command::Picture(args) => picture(&args.detect, given),
        Command::Explain(args) => explain(args, given),
        Command::Scene(args) => scene(args, given),
        Command::Tables(args) => tables(args, given),
        Command::Trade(args) => trade(args, given),
        Command::Bench(args) => machine(&args.machine, given),
        Command::Selftest(_) | Command::Completions(_) | Command::Man(_) => Ok(()),
    }
}

/// What stands on the command line, not by default.
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
                what: format!("--{} would do nothing: {why}", option.replace('_', "-")),
                advice: advice.into(),
            }),
        }
    }
}

fn machine(args: &MachineArgs, given: CommandLine) -> Result<(), Error> {
    if args.backend == Backend::Cuda {
        given.none_of(&["threads"], "a GPU takes no CPU threads", "leave it out, or give --backend cpu")?;
    }
    Ok(())
}

fn detect(args: &DetectArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    if args.traversal != Some(TraversalArg::PerLeafSpill) {
        let why = "only the walk per-leaf-spill gives its rest away";
        given.none_of(&["budget"], why, "add --traversal per-leaf-spill, or leave it out")?;
    }
    if !args.traversal.is_some_and(TraversalArg::has_queues) {
        let why = "the walk has no queues";
        let advice = "add --traversal queue, queue-gtx285, steal or front, or leave it out";
        given.none_of(&["cores", "queue"], why, advice)?;
    }
    if args.distance {
        let why = "of what stands still there is one distance, and it has no time";
        let advice = "leave it out, or ask with --continuous or --earliest";
        given.none_of(&["tolerance", "boxes", "separation"], why, advice)?;
        let why = "triangles of one body are not asked about each other";
        given.none_of(&["adjacent", "no_self_contact"], why, "leave it out, or ask with --discrete")?;
        let why = "a distance has a walk of its own";
        given.none_of(&["traversal"], why, "leave it out")?;
        let why = "where two triangles are nearest is told by the weights of their corners";
        given.none_of(&["file_faces"], why, "leave it out")?;
    }
    if args.near.is_some() {
        let why = "of what stands still there is one answer within the distance, and it has no time";
        let advice = "leave it out, or ask with --continuous or --earliest";
        given.none_of(&["tolerance", "boxes", "separation"], why, advice)?;
        let why =
            "pairs of features without a common vertex are listed, those of adjacent triangles among them";
        given.none_of(&["adjacent"], why, "leave it out, or ask with --discrete")?;
        let why = "where two features are nearest is told by the weights of a triangle's corners";
        given.none_of(&["file_faces"], why, "leave it out")?;
    }
    if args.with.is_empty() {
        let why = "there is no second mesh";
        let advice = "add --with MESH, or leave it out; in a scene file say self_collision = false";
        given.none_of(&["no_self_contact"], why, advice)?;
    }
    if args.scene.is_none() {
        let why = "the bodies come from files";
        given.none_of(&["triangles", "seed"], why, "leave it out, or give --scene NAME in place of files")?;
    }
    args.scene.as_deref().map_or(Ok(()), |scene| of_generated(scene, given))
}

/// Options of a generated scene.
fn of_generated(scene: &str, given: CommandLine) -> Result<(), Error> {
    if scene == "single" {
        given.none_of(&["triangles"], "the scene single has one triangle", "leave it out, or choose soup")?;
    }
    if !SEEDED.contains(&scene) {
        let why = format!("the scene {scene} is the same with every seed");
        let advice = format!("leave it out, or choose one of: {}", SEEDED.join(", "));
        given.none_of(&["seed"], &why, &advice)?;
    }
    Ok(())
}

fn plan(args: &DetectArgs, given: CommandLine) -> Result<(), Error> {
    let why = "a plan asks a frame for its costs alone";
    given.none_of(
        &["repeat", "only", "out", "geometry", "out_mesh", "rebuild", "rebuild_every"],
        why,
        "leave it out, or ask detect",
    )?;
    detect(args, given)
}

fn picture(args: &DetectArgs, given: CommandLine) -> Result<(), Error> {
    let why = "a picture shows one frame and what meets in it";
    given.none_of(&super::picture::IDLE, why, "leave it out, or ask detect")?;
    detect(args, given)
}

fn explain(args: &ExplainArgs, given: CommandLine) -> Result<(), Error> {
    if args.tt.is_some() {
        let why = "triangles that stand still are decided exactly";
        given.none_of(&["tolerance", "boxes"], why, "leave it out, or ask with --vf, --fv or --ee")?;
    }
    Ok(())
}

fn scene(args: &SceneArgs, given: CommandLine) -> Result<(), Error> {
    if !ANIMATIONS.contains(&args.name.as_str()) {
        let why = format!("{} is made by formula", args.name);
        let advice = format!("leave it out, or choose one of: {}", ANIMATIONS.join(", "));
        given.none_of(&["skip", "contact"], &why, &advice)?;
    }
    if args.name == "n-body" {
        let advice = "leave it out, or choose cloth-ball, flamenco or princess";
        given.none_of(&["contact"], "n-body has no cloth", advice)?;
    }
    of_generated(&args.name, given)
}

fn tables(args: &TablesArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    if !args.mesh.is_empty() {
        let why = "the frames come from the files of --mesh";
        given.none_of(&["triangles", "frames", "seed"], why, "leave it out, or leave --mesh out")?;
    }
    let is_of = |figure: fn(&Table) -> bool| args.table.iter().any(figure);
    let is_scaled = is_of(|table| matches!(table, Table::Scale));
    if !is_scaled {
        let why = "the figure scale alone divides frames among devices";
        given.none_of(&["devices"], why, "add --table scale, or leave it out")?;
    }
    let is_of_scenes = |table: &Table| !matches!(table, Table::Bodies | Table::Scale);
    if !args.table.is_empty() && !is_of(is_of_scenes) {
        let why = "no figure of a single scene is measured";
        let advice = "add --table 6.12, 6.13, 6.14 or front, or leave it out";
        given.none_of(&["scene", "mesh", "seed", "bv", "profile"], why, advice)?;
        if !is_scaled {
            let why = "the figure bodies has scenes of one size";
            given.none_of(&["triangles"], why, "add --table scale, or leave it out")?;
        }
    }
    let frames = |table: &Table| matches!(table, Table::Frame | Table::Shares);
    if !args.table.is_empty() && !args.table.iter().any(frames) {
        let why = "no frame is measured";
        given.none_of(&["rebuild_every"], why, "add --table 6.13 or 6.14, or leave it out")?;
    }
    Ok(())
}

fn trade(args: &TradeArgs, given: CommandLine) -> Result<(), Error> {
    machine(&args.machine, given)?;
    if !args.full && (!args.mesh.is_empty() || args.queries.is_some()) {
        let why = "with --mesh or --queries nothing is made here";
        let made = ["scene", "triangles", "frames", "cases", "seed"];
        given.none_of(&made, why, "add --full, or leave it out")?;
    }
    Ok(())
}
