//! Choices are values: one configuration, the same for the library, the command line, the benches and the tests.

mod named;
mod queues;

pub use named::Named;
pub(crate) use named::named;
pub use queues::{Balance, FrontShape, QueueShape, StealShape};

use crate::error::Error;
use nearmiss_kernels::prim::inclusion::Params;

/// What is asked of two triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Motion {
    /// Which triangle pairs share a point at t = 0?
    #[default]
    Discrete,
    /// Which vertex/face and edge/edge pairs meet at some t in [0, 1], and when first?
    Continuous,
    /// When does the first of them meet?
    Earliest,
    /// Which vertex/face and edge/edge pairs are within a distance of each other at t = 0, and where are they nearest?
    Near,
}

impl Motion {
    /// Whether it asks about t = 0 alone: then the end of a step is not looked at.
    pub fn is_at_rest(self) -> bool {
        matches!(self, Motion::Discrete | Motion::Near)
    }
    /// The solvers that answer it, the default first.
    fn solvers(self) -> &'static [Solver] {
        match self {
            Motion::Discrete => &[Solver::Exact, Solver::Moller],
            Motion::Near => &[Solver::Bounded],
            Motion::Continuous | Motion::Earliest => &[
                Solver::Certified,
                Solver::CertifiedF32,
                Solver::CertifiedF64,
                Solver::CubicF64,
                Solver::CubicF32,
            ],
        }
    }
}

named! {
    /// The bounding volume of each node.
    pub enum Bv {
        /// Axis-aligned boxes; in a continuous query around both ends of the step.
        Aabb = "aabb",
        /// Boxes that move: axis-aligned at both ends of the step, in between on straight lines.
        Linear = "linear",
        /// Oriented boxes along the principal axes of what they hold; the seed's.
        Obb = "obb",
        /// Oriented boxes that keep the axes of a child: the older rule.
        ObbChild = "obb-child",
    }
}

impl Bv {
    /// The fastest volume that the real scenes have (measured, `docs/performance.md`): what stands still needs no more
    /// than a box; of what moves, boxes that move with it let a third to a tenth of the pairs through.
    pub fn default_for(motion: Motion) -> Bv {
        if motion.is_at_rest() { Bv::Aabb } else { Bv::Linear }
    }
}

/// How the tree is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Traversal {
    /// A walk a leaf. A walk of more steps than `budget` gives the rest of its stack to the next round.
    PerLeaf {
        /// Steps before a walk spills; `None` never spills.
        budget: Option<u32>,
    },
    /// Pairs of nodes from work queues, one a core, evened between launches: the paper's.
    Queue(QueueShape),
    /// Pairs of nodes from work queues that help each other out within one launch.
    Steal(StealShape),
    /// From where the last frame's descent ended: temporal coherence.
    Front(FrontShape),
}

impl Traversal {
    /// Steps of a walk on a GPU before the rest of it is shared out: about the mean length of a walk on cloth, so
    /// that half of the walks never spill and none makes its warp wait for long (measured, `benches/NOTES.md`).
    pub const GPU_BUDGET: u32 = 64;

    /// The fastest walk of a machine (measured, `docs/performance.md`). A CPU's threads balance by themselves. A GPU must
    /// not wait for its longest walk: plain boxes are walked leaf by leaf, with their rest shared out; of volumes whose
    /// tests cost more, fewer tests by pairs of nodes pay for the queues.
    pub fn default_for(is_gpu: bool, bv: Bv) -> Traversal {
        match (is_gpu, bv) {
            (false, _) => Traversal::PerLeaf { budget: None },
            (true, Bv::Aabb) => Traversal::PerLeaf { budget: Some(Traversal::GPU_BUDGET) },
            (true, _) => Traversal::Queue(QueueShape::native()),
        }
    }
}

named! {
    /// How the volumes of a tree follow its triangles. All ways give the same bits.
    pub enum Refit {
        /// A launch a level, the seed's way.
        Levels = "levels",
        /// One launch for all volumes: a block a subtree, the rest by the block that is done last.
        Treelets = "treelets",
        /// One launch without barriers: of two siblings, who comes second goes on to their parent.
        BottomUp = "bottom-up",
    }
}

impl Refit {
    /// The fastest way of a machine.
    pub fn default_for(is_gpu: bool) -> Refit {
        if is_gpu { Refit::Treelets } else { Refit::Levels }
    }
}

named! {
    /// The test of a pair of triangles.
    pub enum Solver {
        /// Discrete: exact signs by filter, then integers. Never wrong. The default.
        Exact = "exact",
        /// Discrete: the seed's float test. Can miss, can err.
        Moller = "moller",
        /// Continuous: isolated roots, in f32 and, where that is not enough, in f64 and beyond. Never misses, is never late.
        Certified = "certified",
        /// The same in f32 alone: leaves more unresolved.
        CertifiedF32 = "certified-f32",
        /// The same in f64 alone: costs more.
        CertifiedF64 = "certified-f64",
        /// Continuous: the seed's cubic in f64. Can miss degenerate motion.
        CubicF64 = "cubic-f64",
        /// Continuous: the seed's cubic in f32. Can miss, can be late.
        CubicF32 = "cubic-f32",
        /// Near: distances in f64, each within a proven bound. Never misses.
        Bounded = "bounded",
    }
}

#[allow(clippy::derivable_impls, reason = "`named!` makes the enum, and takes no attribute of a variant")]
impl Default for Solver {
    fn default() -> Self {
        Solver::Exact
    }
}

impl Solver {
    /// The solver of a motion when none is named.
    pub fn default_for(motion: Motion) -> Solver {
        motion.solvers()[0]
    }
    /// Whether the solver answers that kind of question.
    pub fn answers(self, motion: Motion) -> bool {
        motion.solvers().contains(&self)
    }
    /// Whether its answers are proven: no contact is missed or late.
    pub fn is_certain(self) -> bool {
        matches!(self, Solver::Exact | Solver::Bounded) || self.is_certified()
    }
    /// Whether it is one of those that take a tolerance and a budget.
    pub fn is_certified(self) -> bool {
        matches!(self, Solver::Certified | Solver::CertifiedF32 | Solver::CertifiedF64)
    }
    /// The promise, in a sentence for the user.
    pub fn promise(self) -> &'static str {
        match self {
            Solver::Exact => "exact: no contact is missed, none is invented",
            Solver::Moller => {
                "moller: a float test that can miss contacts and invent some; use exact for certainty"
            }
            Solver::Certified => {
                "certified: no contact is missed, none is late; what is nearer than the tolerance may be listed as unresolved"
            }
            Solver::CertifiedF32 => {
                "certified-f32: no contact is missed, none is late; what f32 cannot tell is listed as unresolved"
            }
            Solver::CertifiedF64 => "certified-f64: as certified, in f64 throughout",
            Solver::Bounded => {
                "bounded: no pair within the distance is missed; what rounding cannot tell from it is listed"
            }
            Solver::CubicF32 => {
                "cubic-f32: a float solver that can miss contacts and report them late; docs/accuracy.md has figures"
            }
            Solver::CubicF64 => {
                "cubic-f64: can miss contacts of degenerate motion (coplanar, parallel, slivers); docs/accuracy.md has \
                 figures"
            }
        }
    }
}

/// Everything that trades speed for accuracy, or one machine for another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Query {
    /// What is asked.
    pub motion: Motion,
    /// The test; `None` for the motion's default.
    pub solver: Option<Solver>,
    /// The volume; `None` for what is fastest.
    pub bv: Option<Bv>,
    /// The refit; `None` for what is fastest on the machine.
    pub refit: Option<Refit>,
    /// The walk; `None` for what is fastest on the machine.
    pub traversal: Option<Traversal>,
    /// Discrete: also triangles that share a vertex, where they meet beyond it.
    pub adjacent: bool,
    /// Certified: how near to contact may count as one, a length; every time is early by what it takes to move that far,
    /// or less. 0 asks for all that the precision gives. `None` for [`Query::TOLERANCE`] of the bodies' mean edge.
    pub tolerance: Option<f64>,
    /// Certified: the most boxes that are looked at for a pair before it is left unresolved; `None` for
    /// [`Query::BOXES`].
    pub boxes: Option<u32>,
    /// Certified: features that come this near are in contact, a length; times are then of coming so near. `None`, or 0,
    /// for touching.
    pub separation: Option<f64>,
    /// Near, which needs one: how far apart two features may be to be listed, a length above 0.
    pub distance: Option<f64>,
}

impl Query {
    /// The tolerance when none is named, in mean edges; rounded down to a power of two, so that it does not hang on the
    /// order in which edges are summed. Smaller costs more; larger takes more near misses for contacts.
    pub const TOLERANCE: f64 = 1e-4;
    /// The distance that [`Query::every`] asks a near query with.
    pub const DISTANCE: f64 = 1.0 / 64.0;
    /// The budget when none is named: ten times what the hardest pairs of public scenes take.
    pub const BOXES: u32 = Params::BUDGET;

    /// Every question with every solver that answers it, all other choices at their defaults: what tests and `selftest`
    /// run over.
    pub fn every() -> impl Iterator<Item = Query> {
        [Motion::Discrete, Motion::Continuous, Motion::Earliest, Motion::Near].into_iter().flat_map(
            |motion| {
                let solvers = Solver::ALL.into_iter().filter(move |solver| solver.answers(motion));
                let distance = (motion == Motion::Near).then_some(Query::DISTANCE);
                solvers.map(move |solver| Query { solver: Some(solver), distance, ..Query::of(motion) })
            },
        )
    }

    /// Which features are within a distance of each other now, with every other choice at its default.
    pub fn near(distance: f64) -> Query {
        Query { distance: Some(distance), ..Query::of(Motion::Near) }
    }

    /// The query that asks this, with every other choice at its default.
    pub fn of(motion: Motion) -> Query {
        Query { motion, ..Query::default() }
    }

    /// The test that will be used.
    pub fn solver(&self) -> Solver {
        self.solver.unwrap_or(Solver::default_for(self.motion))
    }

    /// The volume that will be used.
    pub fn bv(&self) -> Bv {
        self.bv.unwrap_or(Bv::default_for(self.motion))
    }

    /// The refit that will be used on a GPU, or on a CPU.
    pub fn refit_on(&self, is_gpu: bool) -> Refit {
        self.refit.unwrap_or(Refit::default_for(is_gpu))
    }

    /// The walk that will be used on a GPU, or on a CPU.
    pub fn traversal_on(&self, is_gpu: bool) -> Traversal {
        self.traversal.unwrap_or(Traversal::default_for(is_gpu, self.bv()))
    }

    /// Whether the choices go together.
    ///
    /// # Errors
    /// [`Error::Choice`] with what would.
    pub fn check(&self) -> Result<(), Error> {
        let solver = self.solver();
        if !solver.answers(self.motion) {
            let known: Vec<_> = self.motion.solvers().iter().map(|solver| solver.name()).collect();
            return Err(Error::Choice {
                what: format!("the solver {solver:?} does not answer a {:?} query", self.motion),
                advice: format!("choose one of: {}", known.join(", ")),
            });
        }
        self.check_limits()?;
        self.check_distance()?;
        match self.traversal {
            Some(Traversal::Queue(shape)) => shape.check()?,
            Some(Traversal::Steal(shape)) => shape.check()?,
            Some(Traversal::Front(shape)) => shape.queue.check()?,
            Some(Traversal::PerLeaf { .. }) | None => {}
        }
        if self.adjacent && (self.motion != Motion::Discrete || solver != Solver::Exact) {
            return Err(Error::Choice {
                what: "adjacent triangles are decided by exact signs only".into(),
                advice: "ask for adjacent triangles in a discrete query with the solver exact".into(),
            });
        }
        Ok(())
    }

    /// Whether tolerance and budget mean something.
    fn check_limits(&self) -> Result<(), Error> {
        let limits = self.tolerance.is_some() || self.boxes.is_some() || self.separation.is_some();
        if limits && !self.solver().is_certified() {
            return Err(Error::Choice {
                what: format!(
                    "the solver {:?} takes no tolerance, no budget and no separation",
                    self.solver()
                ),
                advice: "give these to a certified solver".into(),
            });
        }
        let is_length = |x: f64| (0.0..f64::INFINITY).contains(&x);
        if self.separation.is_some_and(|s| !is_length(s)) {
            return Err(Error::Choice {
                what: "a separation that is no length".into(),
                advice: "give a length from 0".into(),
            });
        }
        if self.tolerance.is_some_and(|t| !is_length(t)) || self.boxes == Some(0) {
            return Err(Error::Choice {
                what: "a tolerance that is no length, or a budget of no boxes".into(),
                advice: "give a tolerance from 0, and at least 1 box".into(),
            });
        }
        Ok(())
    }

    /// Whether a near query has its distance, and no other has one.
    fn check_distance(&self) -> Result<(), Error> {
        let (what, advice) = match (self.motion, self.distance) {
            (Motion::Near, Some(d)) if d > 0.0 && d < f64::INFINITY => return Ok(()),
            (Motion::Near, None) => ("a near query without a distance".into(), "give one, a length above 0"),
            (Motion::Near, Some(d)) => (format!("a distance of {d}"), "give a length above 0"),
            (_, None) => return Ok(()),
            (motion, Some(_)) => {
                (format!("a {motion:?} query takes no distance"), "give one to a near query, or leave it out")
            }
        };
        Err(Error::Choice { what, advice: advice.into() })
    }

    /// Whether a separation above 0 is asked for.
    #[doc(hidden)]
    pub fn is_apart(&self) -> bool {
        self.separation.is_some_and(|separation| separation > 0.0)
    }

    /// How near two features must come for a pair of them to be a candidate, a length: 0 for touching; with a separation
    /// that, and the tolerance, within which a pair may be listed as unresolved; of a near query its distance.
    #[doc(hidden)]
    pub fn gap(&self) -> f64 {
        if self.is_apart() || self.motion == Motion::Near { self.listed_within() } else { 0.0 }
    }

    /// Within what distance of each other a certified solver may list two features: the separation and the tolerance. The
    /// volumes bring it all of these, whatever their shape; of a near query its distance, of another solver that is not
    /// certified 0.
    #[doc(hidden)]
    pub fn listed_within(&self) -> f64 {
        if let (Motion::Near, Some(distance)) = (self.motion, self.distance) {
            return distance;
        }
        let p = self.params();
        // Above 0 also where nothing was asked for: what precision cannot tell has its own part of the growth.
        if self.solver().is_certified() { (p.separation + p.tolerance).max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// What a certified test is asked; `tolerance` must have been chosen.
    #[doc(hidden)]
    pub fn params(&self) -> Params {
        let budget = self.boxes.unwrap_or(Query::BOXES);
        // Adding zero turns -0.0 into 0.0.
        let separation = self.separation.unwrap_or(0.0) + 0.0;
        Params { budget, separation, ..Params::new(self.tolerance.unwrap_or(0.0)) }
    }
}
