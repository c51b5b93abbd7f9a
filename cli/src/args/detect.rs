//! What `detect` and `plan` take.

use super::number::{some, whole};
use super::{MachineArgs, choice};
use clap::{Args, ValueEnum};
use nearmiss::Stage;
use nearmiss::query::{
    Broad, Bv, FrontShape, Order, QueueShape, Rebuild, Refit, Solver, StealShape, Traversal,
};
use std::path::PathBuf;

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
    /// Whether it goes by work queues.
    pub fn has_queues(self) -> bool {
        !matches!(self, TraversalArg::PerLeaf | TraversalArg::PerLeafSpill)
    }

    pub(super) fn choice(self, DetectArgs { budget, cores, queue, .. }: &DetectArgs) -> Traversal {
        let queues = |shape: QueueShape| {
            let (cores, local) = (cores.or(shape.cores), queue.unwrap_or(shape.local));
            QueueShape { cores, local, ..shape }
        };
        match self {
            TraversalArg::PerLeaf => Traversal::PerLeaf { budget: None },
            TraversalArg::PerLeafSpill => {
                Traversal::PerLeaf { budget: Some(budget.unwrap_or(Traversal::GPU_BUDGET)) }
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

#[derive(Args)]
pub struct DetectArgs {
    /// The mesh (.ply, .obj); with a second file, its positions at the end of the step; with more, frame after frame. Or a scene
    /// of bodies (.toml).
    #[arg(required_unless_present = "scene", num_args = 1.., value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// A generated scene instead of files.
    #[arg(long, conflicts_with_all = ["meshes", "with"], value_name = "NAME",
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::NAMES))]
    pub scene: Option<String>,
    /// Triangles of the generated scene, about [default: the thesis's number for its scenes, else 92,230].
    #[arg(long, requires = "scene", value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Seed of the generated scene.
    #[arg(long, default_value_t = 1, requires = "scene", allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    /// Another mesh to test against; given twice, or with a second file right behind it and the mesh before it, also its
    /// positions at the end of the step: --with B0 --with B1 A0 A1, or A0 A1 --with B0 B1.
    #[arg(long, value_name = "MESH")]
    pub with: Vec<PathBuf>,
    /// Test the two meshes against each other only, not against themselves.
    #[arg(long)]
    pub no_self_contact: bool,
    /// Triangle pairs that share a point at t = 0 (the default for one frame).
    #[arg(long, conflicts_with_all = ["continuous", "earliest"])]
    pub discrete: bool,
    /// Vertex/face and edge/edge pairs that meet during the step (the default for two frames).
    #[arg(long, conflicts_with = "earliest")]
    pub continuous: bool,
    /// Only the smallest time of contact: the step that a simulator may take.
    #[arg(long)]
    pub earliest: bool,
    /// Vertex/face and edge/edge pairs that are within this distance of each other at t = 0, a length: with their distance, and
    /// where they are nearest.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, conflicts_with_all = ["discrete", "continuous", "earliest"])]
    pub near: Option<f64>,
    /// How far apart the two bodies are that are nearest at t = 0, with their triangles and points: 0 only if they share a point. Of
    /// two meshes or more.
    #[arg(long, conflicts_with_all = ["discrete", "continuous", "earliest", "near"])]
    pub distance: bool,
    /// What finds candidates [default: the machine's fastest; trees where a refit or a traversal is chosen].
    #[arg(long, value_parser = choice::<Broad>())]
    pub broad: Option<Broad>,
    /// In which order triangles make tiles [default: runs]. Finer cuts cost more to build, and fewer tiles meet.
    #[arg(long, value_parser = choice::<Order>())]
    pub order: Option<Order>,
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
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub budget: Option<u32>,
    /// Work queues (queue, queue-gtx285, steal, front) [default: what the machine runs at once, or the released program's 128].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 65_536))]
    pub cores: Option<u32>,
    /// Units that a work queue holds on chip (queue, queue-gtx285, steal, front) [default: 1024, or the paper's 600].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 1024))]
    pub queue: Option<u32>,
    /// The test of a pair [default: exact for discrete, certified for continuous, bounded for near and distance].
    #[arg(long, value_parser = choice::<Solver>())]
    pub solver: Option<Solver>,
    /// Certified: how near to contact may count as one, a length; 0 for all that the precision gives [default: 1e-4 of the
    /// mean edge, rounded down to a power of two; of two bodies the smaller].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// Certified: boxes that are looked at for a pair before it is left undecided [default: 4096].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub boxes: Option<u32>,
    /// Certified: features that come this near are in contact, a length [default: 0, touching].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub separation: Option<f64>,
    /// Leave out the count of triangle pairs that cross at the start of the step.
    #[arg(long, conflicts_with_all = ["discrete", "near", "distance"])]
    pub assume_free: bool,
    #[command(flatten)]
    pub machine: MachineArgs,
    /// Discrete: also triangles that share a vertex, where they meet beyond it.
    #[arg(long)]
    pub adjacent: bool,
    /// Merge vertices that coincide in all frames of a mesh: seams that are vertices twice then meet themselves no more.
    #[arg(long)]
    pub weld: bool,
    /// Refuse a mesh of which a part is skipped, left out or cut as it crosses itself, instead of a
    /// note that counts such parts.
    #[arg(long, conflicts_with = "scene")]
    pub strict: bool,
    /// With --out: triangles are told as the faces of the file that they were cut from, counted from 0.
    #[arg(long, requires = "out", conflicts_with_all = ["scene", "earliest"])]
    pub file_faces: bool,
    /// Where to write the contacts: .csv, .json, or .vtp for ParaView; each also with .gz behind it. A .vtp has two points a contact, where
    /// both features are nearest, and of each contact `kind` (0 vf, 1 fv, 2 ee, 3 two triangles), `status` (0 contact, 1 certified,
    /// 2 undecided), `row` (of a .csv, from 0), `bodies`, `a`, `b`, `toi`, `toi_upper` and `distance`.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// With --out, .csv or .json: also the vertices of both features, their weights, nearest points, distance and normal, behind the
    /// other columns. Of vertex/face and edge/edge pairs.
    #[arg(long, requires = "out", conflicts_with_all = ["file_faces", "earliest", "discrete", "distance"])]
    pub geometry: bool,
    /// Where to write all bodies as one mesh (.ply, .ply.gz), as they are at t = 0: triangles that meet, or have a vertex or an edge that
    /// does, are red, those of undecided contacts alone orange, all others grey.
    #[arg(long, value_name = "FILE", conflicts_with = "earliest")]
    pub out_mesh: Option<PathBuf>,
    /// Print the summary as one JSON object.
    #[arg(long)]
    pub json: bool,
    /// Ask the same frame this often (after one run to warm up) and report each stage's median.
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 100_000))]
    pub repeat: u32,
    /// When tiles or trees are built again: auto (by itself, decided by counted tests) or never
    /// [default: auto].
    #[arg(long, value_parser = choice::<Rebuild>(), conflicts_with = "rebuild_every")]
    pub rebuild: Option<Rebuild>,
    /// Of several steps: build the tree anew every so many, where the mesh comes far [default: never, it is refitted].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub rebuild_every: Option<u32>,
    /// With --repeat: run the frame once, then only this stage so often, and report its median. For profilers.
    #[arg(long, value_parser = choice::<Stage>(), requires = "repeat", value_name = "STAGE")]
    pub only: Option<Stage>,
}

#[derive(Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub detect: DetectArgs,
    /// Ask no frame: what was chosen, and times by what moves alone.
    #[arg(long)]
    pub no_run: bool,
}
