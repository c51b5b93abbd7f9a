//! What the command line takes.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use nearmiss::Stage;
use nearmiss::device::{Backend, Device};
use nearmiss::error::Error;
use nearmiss::query::{
    Bv, FrontShape, Motion, Named, Query, QueueShape, Refit, Solver, StealShape, Traversal,
};
use std::path::PathBuf;

/// Collision detection for deformable triangle meshes.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Find what touches: in one mesh, or (--with) between two.
    Detect(Box<DetectArgs>),
    /// Say what detect would run with the same arguments, on which machine and memory, and why.
    Plan(Box<DetectArgs>),
    /// Say what every solver answers about one pair, and what the exact answer is.
    Explain(Box<super::explain::ExplainArgs>),
    /// Write a benchmark scene as PLY frames.
    Scene(SceneArgs),
    /// The thesis's figures 6.12 to 6.14, ours beside theirs: a table, CSV files and pictures.
    Tables(TablesArgs),
    /// What each faster choice costs in misses, lateness and false alarms, measured here: a table, CSV files and pictures.
    Trade(TradeArgs),
    /// Check this machine: known answers, and the card and the CPU to the bit.
    Selftest(SelftestArgs),
}

/// Takes the name of one of the library's choices, and tells all of them in the help.
fn choice<T: Named>() -> impl TypedValueParser<Value = T> {
    let all = T::ALL.iter().map(|choice| PossibleValue::new(choice.name()).help(choice.about()));
    PossibleValuesParser::new(all).try_map(|name| T::of(&name).ok_or("no such choice"))
}

/// Walks that exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TraversalArg {
    /// A walk a leaf, to its end.
    PerLeaf,
    /// A walk a leaf; long walks give their rest to the next round.
    PerLeafSpill,
    /// Work queues of pairs of nodes, as many as the machine runs; evened between launches.
    Queue,
    /// The same with the paper's machine and constants: 128 queues, evened by copying.
    QueueGtx285,
    /// Work queues of pairs of nodes that help each other out within one launch.
    Steal,
    /// Work queues that go on from where the last frame's descent ended.
    Front,
}

impl TraversalArg {
    fn choice(self, DetectArgs { budget, cores, queue, .. }: &DetectArgs) -> Traversal {
        let queues = |shape: QueueShape| {
            let (cores, local) = (cores.or(shape.cores), queue.unwrap_or(shape.local));
            QueueShape { cores, local, ..shape }
        };
        match self {
            TraversalArg::PerLeaf => Traversal::PerLeaf { budget: None },
            TraversalArg::PerLeafSpill => {
                Traversal::PerLeaf { budget: Some(budget.unwrap_or(Traversal::CARD_BUDGET)) }
            }
            TraversalArg::Queue => Traversal::Queue(queues(QueueShape::native())),
            TraversalArg::QueueGtx285 => Traversal::Queue(queues(QueueShape::gtx285())),
            TraversalArg::Steal => {
                let shape = StealShape::native();
                Traversal::Steal(StealShape { cores: *cores, local: queue.unwrap_or(shape.local), ..shape })
            }
            TraversalArg::Front => {
                let shape = FrontShape::native();
                Traversal::Front(FrontShape { queue: queues(shape.queue), ..shape })
            }
        }
    }
}

/// Where to run.
#[derive(Args)]
pub struct MachineArgs {
    /// Which machine.
    #[arg(long, value_parser = choice::<Backend>(), default_value_t)]
    backend: Backend,
    /// CPU threads [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl MachineArgs {
    /// The machine that the arguments name.
    ///
    /// # Errors
    /// Those of [`Device::open`].
    pub fn open(&self) -> Result<Device, Error> {
        Device::open(self.backend, self.threads.map(usize::from))
    }
}

/// Where figures go.
#[derive(Args)]
pub struct ReportArgs {
    /// Folder for CSV files and SVG pictures.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print everything as one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct DetectArgs {
    /// The mesh (.ply, .obj); with a second file, its positions at the end of the step.
    #[arg(required_unless_present = "scene", num_args = 1..=2, value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// A generated scene instead of files.
    #[arg(long, conflicts_with_all = ["meshes", "with"], value_name = "NAME",
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::NAMES))]
    pub scene: Option<String>,
    /// Triangles of the generated scene, about [default: the thesis's number for its scenes, else 92,230].
    #[arg(long, requires = "scene", value_name = "N")]
    pub triangles: Option<usize>,
    /// Seed of the generated scene.
    #[arg(long, default_value_t = 1, requires = "scene")]
    pub seed: u64,
    /// Another mesh to test against, still or with its positions at the end of the step.
    #[arg(long, num_args = 1..=2, value_name = "MESH")]
    pub with: Vec<PathBuf>,
    /// Triangle pairs that share a point at t = 0 (the default for one frame).
    #[arg(long, conflicts_with_all = ["continuous", "earliest"])]
    pub discrete: bool,
    /// Vertex/face and edge/edge pairs that meet during the step (the default for two frames).
    #[arg(long, conflicts_with = "earliest")]
    pub continuous: bool,
    /// Only the smallest time of contact: the step that a simulator may take.
    #[arg(long)]
    pub earliest: bool,
    /// Bounding volume [default: the fastest].
    #[arg(long, value_parser = choice::<Bv>())]
    pub bv: Option<Bv>,
    /// How the volumes follow the triangles [default: the machine's fastest].
    #[arg(long, value_parser = choice::<Refit>())]
    pub refit: Option<Refit>,
    /// How the tree is walked [default: the machine's fastest].
    #[arg(long, value_enum)]
    pub traversal: Option<TraversalArg>,
    /// Steps of a walk before it gives its rest away (per-leaf-spill).
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(1..))]
    pub budget: Option<u32>,
    /// Work queues (queue, queue-gtx285, steal) [default: what the machine runs at once, or the released program's 128].
    #[arg(long, value_name = "N", requires = "traversal", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub cores: Option<u32>,
    /// Units that a work queue holds on chip [default: 1024, or the paper's 600].
    #[arg(long, value_name = "N", requires = "traversal", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub queue: Option<u32>,
    /// The test of a pair [default: exact for discrete, certified for continuous].
    #[arg(long, value_parser = choice::<Solver>())]
    pub solver: Option<Solver>,
    /// Certified: how near to contact may count as one, a length; 0 for all that the precision gives [default: 1e-4 of the
    /// mean edge, rounded down to a power of two].
    #[arg(long, value_name = "LENGTH")]
    pub tolerance: Option<f64>,
    /// Certified: boxes that are looked at for a pair before it is left unresolved [default: 4096].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub boxes: Option<u32>,
    /// Certified: features that come this near are in contact, a length [default: 0, touching].
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub separation: Option<f64>,
    #[command(flatten)]
    pub machine: MachineArgs,
    /// Discrete: also triangles that share a vertex, where they meet beyond it.
    #[arg(long)]
    pub adjacent: bool,
    /// Where to write the contacts: .csv or .json.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Print the summary as one JSON object.
    #[arg(long)]
    pub json: bool,
    /// Ask the same frame this often (after one run to warm up) and report each stage's median.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub repeat: u32,
    /// With --repeat: run the frame once, then only this stage so often, and report its median. For profilers.
    #[arg(long, value_parser = choice::<Stage>(), requires = "repeat", value_name = "STAGE")]
    pub only: Option<Stage>,
}

impl DetectArgs {
    /// The query for bodies that move, or do not.
    pub fn query(&self, moving: bool) -> Query {
        let motion = match (self.discrete, self.continuous, self.earliest) {
            (_, _, true) => Motion::Earliest,
            (_, true, _) => Motion::Continuous,
            (true, _, _) => Motion::Discrete,
            _ if moving => Motion::Continuous,
            _ => Motion::Discrete,
        };
        Query {
            motion,
            solver: self.solver,
            bv: self.bv,
            refit: self.refit,
            traversal: self.traversal.map(|walk| walk.choice(self)),
            adjacent: self.adjacent,
            tolerance: self.tolerance,
            boxes: self.boxes,
            separation: self.separation,
        }
    }
}

#[derive(Args)]
pub struct SceneArgs {
    /// Which scene.
    #[arg(value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::NAMES))]
    pub name: String,
    /// Triangles, about [default: the thesis's number for its scenes, else 92,230].
    #[arg(long, value_name = "N")]
    pub triangles: Option<usize>,
    /// Frames [default: 2, or what the scene has]. Only animations have more than two.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// Frames of an animation to pass over [default: until cloth has fallen and folded, or balls have met].
    #[arg(long, value_name = "K")]
    pub skip: Option<u64>,
    /// Keep cloth from passing through itself, by our own detection: for small meshes.
    #[arg(long)]
    pub contact: bool,
    /// Seed.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder for NAME_t0.ply and NAME_t1.ply, or of an animation NAME_0000.ply and so on.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Figures of the thesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Construction and refit.
    #[value(name = "6.12")]
    Build,
    /// A frame: discrete and continuous, by volume, without and with a front.
    #[value(name = "6.13")]
    Frame,
    /// Where a frame's time goes.
    #[value(name = "6.14")]
    Shares,
    /// What a front saves, by the part of a step that things move.
    Front,
}

/// Sizes of work queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Profile {
    /// The released program's: 128 queues, evened by copying.
    Gtx285,
    /// As many queues as the machine runs at once.
    Native,
}

impl Profile {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Profile::Gtx285 => "gtx285",
            Profile::Native => "native",
        }
    }

    /// The walk with those sizes.
    pub fn walk(self) -> Traversal {
        Traversal::Queue(match self {
            Profile::Gtx285 => QueueShape::gtx285(),
            Profile::Native => QueueShape::native(),
        })
    }
}

#[derive(Args)]
pub struct TablesArgs {
    /// Scenes [default: all]; with --mesh, the scene of the thesis that the frames are.
    #[arg(long, num_args = 1.., value_name = "NAME",
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::tables::SCENES.map(|scene| scene.0)))]
    pub scene: Vec<String>,
    /// Triangles of a scene, about [default: as many as the thesis has].
    #[arg(long, conflicts_with = "mesh")]
    pub triangles: Option<usize>,
    /// Frames of a scene, at least two.
    #[arg(long, default_value_t = 8, value_name = "K", value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub frames: u32,
    /// Seed of the scenes.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Frames of one mesh from files instead, in their order.
    #[arg(long, num_args = 2.., value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// Which figures [default: 6.12, 6.13, 6.14].
    #[arg(long, num_args = 1.., value_enum, value_name = "FIGURE")]
    pub table: Vec<Table>,
    /// Which volumes; the thesis has aabb and obb.
    #[arg(long, num_args = 1.., value_parser = choice::<Bv>(), default_values_t = [Bv::Aabb, Bv::Obb])]
    pub bv: Vec<Bv>,
    /// Walk by work queues, evened between launches, and refit a launch a level, as the thesis did: with its machine's sizes,
    /// or with this one's [default: the fastest walk and refit, without queues].
    #[arg(long, value_enum)]
    pub profile: Option<Profile>,
    /// Build the tree anew at every N-th frame; that time is not part of a frame's [default: only at the first].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub rebuild_every: Option<u32>,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

#[derive(Args)]
pub struct TradeArgs {
    /// Query files in the layout of Sample-Queries (.csv, .csv.gz), anywhere below this folder; alone, unless --full.
    #[arg(long, value_name = "DIR")]
    pub queries: Option<PathBuf>,
    /// One frame from a file, or the two ends of a step; alone, unless --full.
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// What truly meets in --mesh: rows of kind,a,b or of tri_a,tri_b (.csv, .csv.gz) [default: as the finest solver says].
    #[arg(long, requires = "mesh", value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Scenes that are made here.
    #[arg(long, num_args = 1.., value_name = "NAME", default_values_t = ["cloth-ball".to_owned(), "n-body".to_owned()],
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::ANIMATIONS))]
    pub scene: Vec<String>,
    /// Triangles of a scene, about [default: 10,000; with --full as many as the thesis has].
    #[arg(long, value_name = "N")]
    pub triangles: Option<usize>,
    /// Frames of a scene, for refitting; at least two.
    #[arg(long, default_value_t = 6, value_name = "K", value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub frames: u32,
    /// Built-in questions of a kind and size; there are 26 kinds and three sizes [default: 100; with --full 1,000].
    #[arg(long, value_name = "N")]
    pub cases: Option<usize>,
    /// Runs of which the median time counts, after one to warm up.
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub repeat: u32,
    /// Everything, at full size: minutes to hours.
    #[arg(long)]
    pub full: bool,
    /// Seed of scenes and questions.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

#[derive(Args)]
pub struct SelftestArgs {
    /// Which machine to compare with the CPU's microscope and engine.
    #[arg(long, value_parser = choice::<Backend>(), default_value_t)]
    pub backend: Backend,
    /// Triangles of the larger scenes, about.
    #[arg(long, default_value_t = 20_000)]
    pub triangles: usize,
    /// Contacts built in integers that are asked of each of twelve families, of each certified solver; 0 leaves out the whole
    /// catalogue of extremes.
    #[arg(long, default_value_t = 2_000)]
    pub cases: usize,
    /// More meshes to ask on both machines: one file, or two frames of one mesh.
    #[arg(long, num_args = 1..=2, value_name = "MESH")]
    pub mesh: Vec<PathBuf>,
}
