//! Single pairs of features in motion.

use super::lay::{AT_ONCE, check, mean_edge, topology, vertices};
use super::{Answers, Options, Outcome, Stored};
use crate::case::Case;
use nearmiss::contacts::Status;
use nearmiss::device::{Buffer, Device};
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::research::pipeline::Layout;
use nearmiss::research::pipeline::counts::{Counts, FrameCounters};
use nearmiss::research::pipeline::narrow::{Capacities, ContinuousNarrow, Features, Narrow, NarrowContext};
use nearmiss::research::pipeline::precision::Precision;
use nearmiss::research::{Certified, ContinuousSolver, WithSolver};
use nearmiss_kernels::abi::{ExclusionTables, Hit, Output, Positions, Span, counter};

/// Tests whether the features of every case meet, and when first. It uses the query's solver,
/// tolerance and iterations, with the kernels of a frame. The default tolerance is
/// [`Certified::TOLERANCE`] of the cases' mean edge. A million cases run at a time, so that half a
/// gigabyte of device memory suffices.
///
/// # Errors
/// [`Error::Input`] for coordinates that are not finite or too large. [`Error::InvalidArgument`]
/// for a query other than [`Query::Continuous`], and for coordinates that f32 does not hold if they
/// are stored in f32. Device errors.
pub fn ask(device: &Device, cases: &[Case], query: &Query, how: Options) -> Result<Answers, Error> {
    query.check()?;
    let Query::Continuous(continuous) = query else {
        return Err(Error::InvalidArgument {
            what: format!("single features need a continuous query, got {}", query.kind().name()),
            advice: "use a continuous query, or `ask_triangles` for triangles at one time".into(),
        });
    };
    let mut solver = continuous.chosen();
    check(cases, how.stored)?;
    if let ContinuousSolver::Certified(certified) = &mut solver {
        certified.tolerance.get_or_insert_with(|| Certified::TOLERANCE * mean_edge(cases));
    }
    let mut all = Answers::default();
    for cases in cases.chunks(AT_ONCE) {
        let some = match how.stored {
            Stored::F64 => some::<f64>(device, cases, solver, how)?,
            Stored::F32 => some::<f32>(device, cases, solver, how)?,
        };
        all.verdicts.extend(some.verdicts);
        for kind in 0..2 {
            all.rejected[kind] += some.rejected[kind];
            all.escalated[kind] += some.escalated[kind];
        }
        all.filter_ms += some.filter_ms;
        all.solve_ms += some.solve_ms;
        all.bytes = all.bytes.max(some.bytes);
    }
    Ok(all)
}

/// Tests one batch.
fn some<R: Precision>(
    device: &Device,
    cases: &[Case],
    solver: ContinuousSolver,
    how: Options,
) -> Result<Answers, Error> {
    let before = device.bytes().0;
    let (layout, [vf, ee]) = topology(cases);
    let all = [vf.len(), ee.len()];
    // A case is listed once at most, so no list outgrows this.
    let candidates =
        if how.filters || solver.certified().is_some_and(Certified::is_apart) { all } else { [0, 0] };
    let mut features = Features::new(device, &layout, candidates)?;
    let capacities = Capacities { survivors: all, hits: all, left: all, near: all, asked: all };
    let mut narrow = ContinuousNarrow::new(device, solver, capacities)?;
    let mut counts = Counts::default();
    let given = [&vf[..], &ee];
    if how.filters {
        features.put_candidates(given, &mut counts)?;
    } else {
        narrow.put_survivors(&mut features, given, &mut counts)?;
    }
    let mut run = Run::<R> {
        device,
        solver,
        vertices: vertices(device, cases)?,
        faces: device.upload(&layout.faces)?,
        layout,
        counters: FrameCounters::new(device)?,
        counts,
        filters: how.filters,
        features,
        narrow,
    };
    let bytes = device.bytes().0 - before;
    let mut ms = vec![run.run()?];
    if how.repeats > 0 {
        ms = (0..how.repeats).map(|_| run.run()).collect::<Result<_, Error>>()?;
        ms.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
    }
    let [filter_ms, solve_ms] = ms[ms.len() / 2];
    Ok(Answers { filter_ms, solve_ms, bytes, ..run.answers(cases.len())? })
}

/// The memory of a run.
struct Run<'a, R: Precision> {
    device: &'a Device,
    solver: ContinuousSolver,
    vertices: Buffer<nearmiss_kernels::abi::VertexMotion<R>>,
    faces: Buffer<[u32; 3]>,
    layout: Layout,
    counters: FrameCounters,
    /// The counters at the start of a run.
    counts: Counts,
    /// Whether the filters run first.
    filters: bool,
    features: Features,
    narrow: ContinuousNarrow,
}

impl<R: Precision> Run<'_, R> {
    /// Runs the filters, if enabled, and the solver. Returns the milliseconds of each.
    fn run(&mut self) -> Result<[f64; 2], Error> {
        self.counters.write(&self.counts)?;
        let given = NarrowContext {
            device: self.device,
            frames: Positions { still: Span::EMPTY, moving: self.vertices.span(), turns: Span::EMPTY },
            rest: Span::EMPTY,
            may_grow: true,
            faces: self.faces.span(),
            pairs: Output::EMPTY,
            bodies: Span::EMPTY,
            counters: self.counters.counters(),
            features: &self.features,
            excluded: ExclusionTables::NONE,
            placeable: None,
            is_sample: false,
        };
        let start = self.device.event()?;
        if self.filters {
            self.narrow.cull(&given)?;
        }
        let filtered = self.device.event()?;
        self.narrow.solve(&given)?;
        let end = self.device.event()?;
        Ok([start.to(&filtered)?, filtered.to(&end)?])
    }

    /// Returns the verdicts in the cases' order, and the counts. No list runs again here, so a short
    /// one would lose cases: that is an error.
    fn answers(&mut self, cases: usize) -> Result<Answers, Error> {
        let counters = self.counters.read()?;
        for step in 0..Narrow::<R>::steps(&self.narrow).len() {
            for list in Narrow::<R>::lists(&mut self.narrow, step, &mut self.features) {
                if list.grow(self.device, &counters)? {
                    return Err(Error::Bug { what: "a list of single pairs was too short".into() });
                }
            }
        }
        let certified = self.solver.certified().is_some();
        let mut verdicts = vec![None; cases];
        let met = |hit: &Hit| Outcome {
            status: Status::of(certified, &hit.verdict),
            toi: hit.verdict.toi,
            toi_upper: hit.verdict.toi_upper,
            exhausted: hit.verdict.exhausted(),
            boxes: hit.verdict.boxes,
        };
        for hit in self.narrow.vf_hits.read(&counters)? {
            verdicts[hit.a as usize / 4] = Some(met(&hit));
        }
        for hit in self.narrow.ee_hits.read(&counters)? {
            let [vertex, _] = self.layout.features.edges[hit.a as usize];
            verdicts[vertex as usize / 4] = Some(met(&hit));
        }
        let of = |which| counters[which];
        let tested = [of(counter::VF), of(counter::EE)];
        let left = [of(counter::VF_SURVIVORS), of(counter::EE_SURVIVORS)];
        Ok(Answers {
            verdicts,
            rejected: [0, 1].map(|kind| tested[kind].saturating_sub(left[kind])),
            escalated: [of(counter::VF_ESCALATED), of(counter::EE_ESCALATED)],
            ..Answers::default()
        })
    }
}
