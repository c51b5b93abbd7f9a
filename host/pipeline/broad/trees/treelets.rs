//! Plan of treelets that a refit uses together with the tree.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::launch;
use crate::query::Refit;
use nearmiss_kernels::abi::{LeafPlace, Merge, PlanArgs, Span, TreeArgs, Treelet};
use nearmiss_kernels::bvh::{MAX_LEVELS, TREELET};
use nearmiss_kernels::entry;

/// How a tree is refitted, with the memory for it.
pub enum RefitPlan {
    /// One launch per level.
    Levels,
    /// One block per treelet.
    Treelets(Box<Plan>),
}

impl RefitPlan {
    /// Allocates the plan for a tree of `count` leaves (at least one).
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, refit: Refit, count: u32) -> Result<RefitPlan, Error> {
        Ok(match refit {
            Refit::Levels => RefitPlan::Levels,
            Refit::Treelets => RefitPlan::Treelets(Box::new(Plan::new(device, count)?)),
        })
    }

    /// Returns how many zeroed words its construction needs.
    pub fn zeroed(&self) -> usize {
        match self {
            RefitPlan::Treelets(plan) => plan.treelets.len() + TOPS,
            RefitPlan::Levels => 0,
        }
    }

    /// Splits those words: the treelets' starts, and the number of nodes of the top.
    pub fn parts(&self, zeroed: Span<u64>) -> [Span<u64>; 2] {
        match self {
            RefitPlan::Treelets(plan) => {
                let begins = plan.treelets.len() as u64;
                [zeroed.part(0, begins), zeroed.part(begins, TOPS as u64)]
            }
            RefitPlan::Levels => [Span::EMPTY; 2],
        }
    }

    /// Returns the leaves' places, or an empty span if they are not needed.
    pub fn leaf_places(&self) -> Span<LeafPlace> {
        match self {
            RefitPlan::Treelets(plan) => plan.leaf_places.span(),
            RefitPlan::Levels => Span::EMPTY,
        }
    }

    /// Prepares for a tree that was just built.
    ///
    /// # Errors
    /// Device errors.
    pub fn prepare(&mut self, device: &Device, tree: &TreeArgs) -> Result<(), Error> {
        match self {
            RefitPlan::Levels => Ok(()),
            RefitPlan::Treelets(plan) => plan.make(device, tree),
        }
    }
}

/// The treelets of a tree, about 30 bytes a leaf; see
/// `nearmiss_kernels::stage::construct::treelet`.
pub struct Plan {
    /// The treelets, one per chunk of leaves.
    pub treelets: Buffer<Treelet>,
    /// The leaves' places.
    pub leaf_places: Buffer<LeafPlace>,
    /// Merges of the treelets.
    pub merges: Buffer<Merge>,
    /// Merges of the nodes that span treelets.
    pub top: Buffer<Merge>,
    /// The number of depths of these nodes, and the start of each.
    pub top_starts: Buffer<u32>,
    /// Number of tickets that blocks of refits have drawn so far.
    pub ticket: Buffer<u64>,
}

/// Two words per depth: the number of nodes that span treelets, and a cursor.
const TOPS: usize = 2 * MAX_LEVELS as usize;

impl Plan {
    fn new(device: &Device, count: u32) -> Result<Plan, Error> {
        let (leaves, treelets) = (count as usize, count.div_ceil(TREELET) as usize);
        // Nodes of one depth have different leaves. Each node of the top has more than TREELET of
        // them.
        let a_depth = leaves / (TREELET as usize + 1);
        Ok(Plan {
            treelets: device.buffer(treelets)?,
            leaf_places: device.buffer(leaves)?,
            merges: device.buffer(leaves)?,
            top: device.buffer((a_depth * MAX_LEVELS as usize).min(leaves))?,
            top_starts: device.buffer(MAX_LEVELS as usize + 1)?,
            ticket: device.upload(&[0])?,
        })
    }

    fn make(&self, device: &Device, tree: &TreeArgs) -> Result<(), Error> {
        let args = PlanArgs {
            inner: tree.inner,
            parents: tree.parents,
            depths: tree.depths,
            places: tree.places,
            pair_parents: tree.pair_parents,
            begins: tree.begins,
            tops: tree.tops,
            treelets: self.treelets.span(),
            merges: self.merges.span(),
            top: self.top.span(),
            top_starts: self.top_starts.span(),
            leaves: tree.leaves,
            root: tree.root,
        };
        launch::blocks::<entry::construct_treelets>(device, self.blocks(), &args)
    }

    /// Returns the number of blocks of a refit: one per treelet.
    pub fn blocks(&self) -> u32 {
        // There are fewer treelets than leaves, which fit 32 bits.
        self.treelets.len() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Device;
    use crate::device::emulator::{Emulator, Mode};
    use crate::pipeline::Layout;
    use crate::pipeline::broad::trees::{Tree, TreeSpec, Volumes};
    use crate::samples::soup;
    use nearmiss_kernels::abi::{Growth, Point, Positions};
    use nearmiss_kernels::bv::{Aabb, Obb};
    use nearmiss_kernels::entry::Kernels;
    use nearmiss_kernels::math::Vec3;

    /// Returns the verdict on a tree that was refitted, moved, and refitted again after `fault`. It
    /// has one thread, so that blocks run in their order.
    fn checked<V: Kernels>(refit: Refit, fault: impl Fn(&mut Tree)) -> Result<(), Error> {
        let device = Device::emulator(Emulator::new(Mode::Engine, Some(1))?);
        let body = soup(2_000, 5, false);
        let at = |scale: f64| -> Vec<Vec3<f32>> {
            let points = body.positions_t0().to_f64().into_iter();
            points.map(|p| Vec3(p.map(|x| (x * scale) as f32))).collect()
        };
        let padded = |points: &[Vec3<f32>]| points.iter().map(|&p| p.into()).collect::<Vec<Point<f32>>>();
        let mut points = device.upload(&padded(&at(1.0)))?;
        let faces = device.upload(body.elements())?;
        let frames = Positions { still: points.span(), moving: Span::EMPTY, turns: Span::EMPTY };
        let layout = Layout::single(2_000);
        let mut tree = Tree::new(&device, &TreeSpec::alone(&layout, refit, V::GROUP > 0))?;
        tree.construct::<f32>(&device, frames, (faces.span(), Span::EMPTY))?;
        tree.learn_levels()?;
        let volumes = Volumes::<V>::new(&device, &tree, Growth::default())?;
        let refit = |tree: &Tree| {
            volumes.fit(&device, tree, frames, faces.span())?;
            volumes.refit(&device, tree, frames, faces.span())
        };
        refit(&tree)?;
        volumes.check(
            &tree,
            body.elements(),
            &crate::pipeline::broad::Checked::new(vec![at(1.0)], Vec::new()),
        )?;
        points.write(&padded(&at(3.0)))?;
        fault(&mut tree);
        refit(&tree)?;
        volumes.check(
            &tree,
            body.elements(),
            &crate::pipeline::broad::Checked::new(vec![at(3.0)], Vec::new()),
        )
    }

    fn plan(tree: &mut Tree) -> &mut Plan {
        match &mut tree.way {
            RefitPlan::Treelets(plan) => plan,
            RefitPlan::Levels => panic!("a refit by levels has no plan"),
        }
    }

    /// Removes one merge and puts its neighbour in its place.
    fn lose(list: &mut Buffer<Merge>, at: usize) {
        let mut merges = list.read(list.len()).expect("read");
        merges[at] = merges[at + 1];
        list.write(&merges).expect("written");
    }

    #[test]
    fn all_ways_pass_without_a_fault() {
        for refit in [Refit::Levels, Refit::Treelets] {
            checked::<Aabb>(refit, |_| ()).expect("sound volumes");
            checked::<Obb>(refit, |_| ()).expect("sound volumes");
        }
    }

    #[test]
    fn a_volume_that_stayed_behind_is_noticed() {
        let faults: [fn(&mut Tree); 4] = [
            // A lost merge, in a treelet and in the top.
            |tree| lose(&mut plan(tree).merges, 3),
            |tree| lose(&mut plan(tree).top, 1),
            // Skipped rounds or depths.
            |tree| {
                let mut treelets = plan(tree).treelets.read(2).expect("read");
                treelets[1].rounds -= 1;
                plan(tree).treelets.write(&treelets).expect("written");
            },
            |tree| {
                let starts = plan(tree).top_starts.read(1).expect("read");
                plan(tree).top_starts.write(&[starts[0] - 1]).expect("written");
            },
        ];
        for (i, fault) in faults.into_iter().enumerate() {
            let error = checked::<Aabb>(Refit::Treelets, fault).expect_err("noticed").to_string();
            assert!(error.contains("Merge"), "fault {i}: {error}");
        }
    }

    /// The first leaf of a pair is wrong: a node is fitted to too many points, too few, or none.
    #[test]
    fn a_fit_to_other_points_is_noticed() {
        for refit in [Refit::Levels, Refit::Treelets] {
            let error = checked::<Obb>(refit, |tree| {
                let mut firsts = tree.firsts.read(tree.firsts.len()).expect("read");
                *firsts.last_mut().expect("a pair") -= 1;
                tree.firsts.write(&firsts).expect("written");
            });
            assert!(error.expect_err("noticed").to_string().contains("Fit"), "{refit:?}");
        }
    }

    #[test]
    fn a_ticket_too_early_is_noticed() {
        // The second block merges the top before its volumes exist.
        let error = checked::<Aabb>(Refit::Treelets, |tree| {
            let plan = plan(tree);
            plan.ticket.write(&[u64::from(plan.blocks()) - 2]).expect("written");
        });
        assert!(error.expect_err("noticed").to_string().contains("Merge"));
    }
}
