//! `lab trade`.

use crate::args::TradeArgs;
use crate::detect::body;
use crate::output;
use crate::progress::during;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::Body;
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::{BoundingVolume, Certified, QueryExt};
use nearmiss_lab::accuracy::{
    Choice, Extent, Input, Scene, Trade, built_in, degeneracies, funnel, list, offsets, query_files, refit,
    scales, triangles,
};
use nearmiss_lab::case::Case;
use nearmiss_lab::pairs::Stored;
use nearmiss_lab::tables;
use std::process::ExitCode;

/// Tolerances in mean edges.
const TOLERANCES: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// The tolerance at which solvers are compared on query files, a length.
const OF_QUERIES: f64 = 1e-6;

/// Most bytes of all questions of a number of cases, each: kinds, sizes, answers.
const OF_A_CASE: u64 = 64_000;

/// Measures, prints, and writes to `--out`.
pub fn trade(args: &TradeArgs) -> Result<ExitCode, Error> {
    args.report.out.as_deref().map_or(Ok(()), output::folder)?;
    let device = args.machine.open()?;
    let mut all = Trade::new(device.name());
    let only_files = !args.mesh.is_empty() || args.queries.is_some();
    if !only_files || args.full {
        questions(args, &device, &mut all)?;
    }
    if let Some(root) = &args.queries {
        let inputs = during("deciding the queries exactly", || query_files(root))?;
        for input in inputs {
            asked(args, &device, &input, &[OF_QUERIES / input.edge], &mut all)?;
        }
    }
    if !args.mesh.is_empty() {
        files(args, &device, &mut all)?;
    }
    if !only_files || args.full {
        generated(args, &device, &mut all)?;
    }
    all.sum_up();
    super::report(&args.report, &all, Trade::text, Trade::files)
}

/// How many cases of a kind.
fn cases(args: &TradeArgs) -> usize {
    args.cases.unwrap_or(if args.full { 1_000 } else { 100 })
}

/// Single questions: the built-in ones, and sweeps.
fn questions(args: &TradeArgs, device: &Device, all: &mut Trade) -> Result<(), Error> {
    let n = cases(args);
    memory::require("the built-in questions", n as u64 * OF_A_CASE)?;
    let grid = during("triangles on grids", || triangles(device, 40 * n, args.seed))?;
    all.choices.extend(grid);
    let inputs = during("deciding the built-in contacts exactly", || built_in(n, args.seed))?;
    for input in inputs {
        asked(args, device, &input, &[], all)?;
    }
    let step = if args.full { 1 } else { 2 };
    let extent = Extent { cases: n.div_ceil(4), step, seed: args.seed };
    all.sweeps.extend(during("offsets from the origin", || offsets(device, extent))?);
    all.sweeps.extend(during("scales", || scales(device, extent))?);
    all.sweeps.extend(during("degeneracies", || degeneracies(device, extent))?);
    Ok(())
}

/// Every solver at every tolerance, and at some more.
fn asked(
    args: &TradeArgs,
    device: &Device,
    input: &Input,
    more: &[f64],
    all: &mut Trade,
) -> Result<(), Error> {
    let tolerances: Vec<f64> = TOLERANCES.iter().chain(more).copied().collect();
    for choice in Choice::every(QueryKind::Continuous, &tolerances) {
        let row = during(format!("{}: {choice}", input.name), || {
            input.row(device, choice, Stored::F64, args.repeat)
        })?;
        all.choices.push(row);
    }
    if input.cases.iter().all(Case::fits_f32) {
        for choice in Choice::every(QueryKind::Continuous, &[Certified::TOLERANCE]) {
            all.choices.push(input.row(device, choice, Stored::F32, args.repeat)?);
        }
    }
    Ok(())
}

/// Scenes that are made here.
fn generated(args: &TradeArgs, device: &Device, all: &mut Trade) -> Result<(), Error> {
    for name in &args.scene {
        let triangles = match args.triangles {
            Some(triangles) => triangles,
            None if args.full => nearmiss_lab::scene::usual(name),
            None => 10_000,
        };
        let count = args.frames as usize;
        let frames = during(format!("making {name}"), || tables::frames(name, triangles, args.seed, count))?;
        let step = frames.bodies(true)?.swap_remove(0);
        let mesh = frames.meshes[0].clone();
        let still = known(device, &format!("{name}, still"), Body::deformable(mesh), None)?;
        scene(args, device, &still, all)?;
        scene(args, device, &known(device, name, step, None)?, all)?;
        for volume in [BoundingVolume::Aabb, Query::continuous().volume()] {
            let name = format!("{name}, {} triangles", frames.triangles());
            let rows = during(format!("{name}: refitting {}", volume.name()), || {
                refit(device, &name, &frames, volume)
            })?;
            all.refit.extend(rows);
        }
    }
    Ok(())
}

/// One frame or two from files.
fn files(args: &TradeArgs, device: &Device, all: &mut Trade) -> Result<(), Error> {
    let body = body(&args.mesh)?;
    let truth = args.truth.as_deref().map(list).transpose()?;
    scene(args, device, &known(device, &crate::stem(&args.mesh[0]), body, truth)?, all)
}

fn known(
    device: &Device,
    name: &str,
    body: Body,
    truth: Option<nearmiss_lab::accuracy::List>,
) -> Result<Scene, Error> {
    during(format!("{name}: the truth"), || Scene::new(device, name, body, truth))
}

/// Every solver at every tolerance with the default volume, the default solver with every volume; and the funnel.
fn scene(args: &TradeArgs, device: &Device, scene: &Scene, all: &mut Trade) -> Result<(), Error> {
    let asked = if scene.body.is_moving() { Query::continuous() } else { Query::discrete() };
    let kind = asked.kind();
    let few = [1e-1, 1e-2, 1e-4, 1e-6, 1e-9];
    let tolerances: &[f64] = if args.full { &TOLERANCES } else { &few };
    for choice in Choice::every(kind, tolerances) {
        let row = || scene.row(device, choice, None, args.repeat);
        all.choices.push(during(format!("{}: {choice}", scene.name), row)?);
    }
    let tolerance = asked.certified().map(|_| Certified::TOLERANCE);
    let choice = Choice { asked, tolerance };
    for volume in BoundingVolume::ALL.into_iter().filter(|volume| *volume != asked.volume()) {
        let row = || scene.row(device, choice, Some(volume), args.repeat);
        all.choices.push(during(format!("{}: {}", scene.name, volume.name()), row)?);
    }
    if kind == QueryKind::Continuous {
        let rows =
            during(format!("{}: the funnel", scene.name), || funnel(device, &scene.name, &scene.body))?;
        all.funnel.extend(rows);
    }
    Ok(())
}
