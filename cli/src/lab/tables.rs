//! `lab tables`.

use crate::args::{Profile, Table, TablesArgs};
use crate::output;
use crate::progress::during;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::research::{BoundingVolume, QueryExt};
use nearmiss_lab::scene::Bodies;
use nearmiss_lab::tables::{self, Figures, Frames, Paper, Way};
use std::process::ExitCode;

/// Measures, prints, and writes to `--out`.
pub fn tables(args: &TablesArgs) -> Result<ExitCode, Error> {
    args.report.out.as_deref().map_or(Ok(()), output::folder)?;
    let device = args.machine.open()?;
    let continuous = Query::continuous().solver();
    output::say(&format!("the solver of continuous columns is {}", continuous.promise()));
    let mut figures = Figures::new(device.name(), profile(args));
    if args.table.contains(&Table::Bodies) {
        bodies(args, &device, &mut figures)?;
    }
    if args.table.contains(&Table::Scale) {
        scale(args, &device, &mut figures)?;
    }
    // If it is the only table, nothing else is needed.
    let of_animations = |table: &Table| !matches!(table, Table::Bodies | Table::Scale);
    let all = args.table.is_empty() || args.table.iter().any(of_animations);
    for (name, triangles) in if all { scenes(args)? } else { Vec::new() } {
        let frames = during(format!("making {name}"), || match args.mesh.is_empty() {
            true => tables::frames(&name, triangles, args.seed, args.frames as usize),
            false => tables::read(&name, &args.mesh),
        })?;
        scene(args, &device, &frames, &mut figures)?;
    }
    super::report(&args.report, &figures, Figures::text, Figures::files)
}

/// Measures scenes of many bodies.
fn bodies(args: &TablesArgs, device: &Device, figures: &mut Figures) -> Result<(), Error> {
    let scenes = [("pile", Bodies::pile(500, 120, 100)?), ("worlds", Bodies::worlds(1_000, 8)?)];
    for (name, scene) in &scenes {
        for query in [Query::discrete(), Query::continuous()] {
            let row = || tables::bodies(device, name, scene, query, args.frames);
            figures.bodies.push(during(format!("{name}, {:?}", query.kind()), row)?);
        }
    }
    Ok(())
}

/// The smallest size, and the default of the largest on a GPU and on a CPU.
const SMALLEST: usize = 10_000;
const LARGEST: [usize; 2] = [1_000_000, 100_000];

/// Measures sizes, each about three times the one before.
fn scale(args: &TablesArgs, device: &Device, figures: &mut Figures) -> Result<(), Error> {
    let largest = args.triangles.unwrap_or(LARGEST[usize::from(!device.is_gpu())]);
    let usual = (0..).map(|k| SMALLEST * 10usize.pow(k / 2) * if k % 2 == 1 { 3 } else { 1 });
    let mut sizes: Vec<usize> = usual.take_while(|&size| size < largest).collect();
    sizes.push(largest);
    let gpus: Vec<Device> = (0..args.devices as u32).map_while(|k| Device::gpu(k).ok()).collect();
    let in_turn = !device.is_gpu() || gpus.len() < args.devices;
    let devices = if in_turn { vec![device.clone(); args.devices] } else { gpus };
    let rows = &mut figures.scale;
    during("sizes", || tables::scale(&devices, in_turn, &sizes, args.frames, |row| rows.push(row)))
}

/// Names and triangles.
fn scenes(args: &TablesArgs) -> Result<Vec<(String, usize)>, Error> {
    if let Some(file) = args.mesh.first() {
        return match args.scene.as_slice() {
            [] => Ok(vec![(crate::stem(file), 0)]),
            [name] => Ok(vec![(name.clone(), 0)]),
            several => Err(Error::InvalidArgument {
                what: format!("--scene takes one name with --mesh, got {}", several.len()),
                advice: "name the scene of the paper that the frames show, or none".into(),
            }),
        };
    }
    let wanted = |name: &str| args.scene.is_empty() || args.scene.iter().any(|of| of == name);
    let all = tables::SCENES.iter().filter(|(name, _)| wanted(name));
    Ok(all.map(|&(name, triangles)| (name.to_owned(), args.triangles.unwrap_or(triangles))).collect())
}

/// The profile's name.
fn profile(args: &TablesArgs) -> &'static str {
    args.profile.map_or("fastest", Profile::name)
}

/// The chosen volumes, each once.
fn volumes(args: &TablesArgs) -> Vec<BoundingVolume> {
    BoundingVolume::ALL.into_iter().filter(|volume| args.bounding_volume.contains(volume)).collect()
}

/// Measures one scene.
fn scene(args: &TablesArgs, device: &Device, frames: &Frames, figures: &mut Figures) -> Result<(), Error> {
    let wanted = |table| args.table.is_empty() || args.table.contains(&table);
    let name = &frames.scene;
    let walk = args.profile.map(Profile::walk);
    let paper = Paper::new(name, frames.triangles(), device.name(), profile(args));
    if wanted(Table::Build) {
        // Every construction is by way of axis-aligned boxes.
        let mut built = Vec::new();
        for volume in BoundingVolume::ALL
            .into_iter()
            .filter(|volume| *volume == BoundingVolume::Aabb || args.bounding_volume.contains(volume))
        {
            let trees = || tables::build(device, frames, volume, walk);
            built.push(during(format!("{name}: trees in {}", volume.name()), trees)?);
        }
        figures.figure_6_12.extend(tables::figure_612(&paper, frames.meshes.len(), &built));
    }
    if args.table.contains(&Table::Front) {
        let ways = Way::every(&volumes(args));
        let rows = during(format!("{name}: parts of a step"), || {
            tables::front(&paper, device, frames, &ways, walk)
        })?;
        figures.front.extend(rows);
    }
    if !wanted(Table::Frame) && !wanted(Table::Shares) {
        return Ok(());
    }
    let mut cells = Vec::new();
    for way in Way::every(&volumes(args)) {
        let every = args.rebuild_every.map(|n| n as usize);
        let cell = || tables::measure(device, frames, way, way.query(walk), every);
        cells.push(during(format!("{name}: {way}"), cell)?);
    }
    let differing = tables::agree(name, &cells)?;
    if wanted(Table::Frame) {
        figures.figure_6_13.extend(tables::figure_613(&paper, &cells, &differing));
    }
    if wanted(Table::Shares) {
        figures.figure_6_14.extend(tables::figure_614(&paper, &cells));
    }
    Ok(())
}
