//! Contacts of a scene over the ranks of MPI, step by step:
//!
//! ```sh
//! mpirun -n 4 contacts [QUERY] [OPTIONS] SCENE.toml | MESH [MESH...]
//! ```
//!
//! Several meshes are frames of one body. Every rank reads the files and keeps its part.

mod scene;
#[allow(dead_code, reason = "the program uses more of it")]
mod sequence;

/// The program's reader of meshes.
#[allow(dead_code, reason = "the program uses more of it")]
#[path = "../../../../cli/src/meshes.rs"]
mod meshes;

/// Parts of the program that its readers use.
mod output {
    use std::path::{Path, PathBuf};

    pub fn say(text: &str) {
        eprintln!("nearmiss: {text}");
    }

    /// A file's name without `.gz`.
    pub fn unpacked(path: &Path) -> PathBuf {
        match path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz")) {
            true => path.with_extension(""),
            false => path.to_owned(),
        }
    }
}

/// A mesh's name: its file's, without folder and extension.
fn stem(file: &std::path::Path) -> String {
    output::unpacked(file).file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned())
}

use nearmiss::contacts::Rows;
use nearmiss::device::Backend;
use nearmiss::scene::BodyId;
use nearmiss::{Continuous, Detector, Device, Discrete, Earliest, Error, Near, Query};
use nearmiss_mpi::{Bytes, Division, RankAnswer, RankDetector, RankError, Ranks, left_out, pieces, program};
use scene::Film;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

const HELP: &str = "\
mpirun -n 4 contacts [OPTIONS] SCENE.toml | MESH [MESH...]

Query [at rest --discrete, of several frames --continuous]:
  --discrete --continuous --earliest --near D
Options:
  --bodies         leave every body on one rank [cut bodies into equal shares]
  --threads N      use N threads of a CPU on each rank [1]
  --gpu            use a GPU on each rank
  --rows           print all rows
  --check          compare with one machine";

/// The command line.
struct Args {
    query: Option<Query>,
    division: Division,
    device: (Backend, Option<usize>),
    rows: bool,
    check: bool,
    files: Vec<PathBuf>,
}

fn parsed() -> Result<Args, Error> {
    let wrong = |what: String| Error::InvalidArgument { what, advice: "see --help".into() };
    let mut args = Args {
        query: None,
        division: Division::Stretches,
        device: (Backend::Cpu, Some(1)),
        rows: false,
        check: false,
        files: Vec::new(),
    };
    let mut all = std::env::args().skip(1);
    while let Some(arg) = all.next() {
        let mut number = || {
            let text = all.next().unwrap_or_default();
            text.parse::<f64>().map_err(|_| wrong(format!("{arg} must be a number, got {text:?}")))
        };
        match arg.as_str() {
            "--discrete" => args.query = Some(Discrete::default().into()),
            "--continuous" => args.query = Some(Continuous::default().into()),
            "--earliest" => args.query = Some(Earliest::default().into()),
            "--near" => args.query = Some(Near::within(number()?).into()),
            "--bodies" => args.division = Division::Bodies,
            "--threads" => args.device = (Backend::Cpu, Some(number()? as usize)),
            "--gpu" => args.device = (Backend::Cuda, None),
            "--rows" => args.rows = true,
            "--check" => args.check = true,
            other if other.starts_with("--") => return Err(wrong(format!("option {other} is unknown"))),
            file => args.files.push(file.into()),
        }
    }
    Ok(args)
}

fn main() -> ExitCode {
    if std::env::args().any(|arg| arg == "--help") {
        println!("{HELP}");
        return ExitCode::SUCCESS;
    }
    program(run).into()
}

fn run(ranks: &Ranks) -> Result<(), RankError> {
    let (args, film, device) = ranks.run(|| {
        let args = parsed()?;
        let film = Film::read(&args.files)?;
        let device = Device::open(args.device.0, args.device.1)?;
        Ok((args, film, device))
    })?;
    let query = args.query.unwrap_or(match film.frames {
        1 => Query::discrete(),
        _ => Query::continuous(),
    });
    let at_rest = !matches!(query, Query::Continuous(_) | Query::Earliest(_));
    let own = ranks.run(|| pieces(&film.scene, args.division, ranks.rank(), ranks.count()))?;
    let mut one = ranks.run(|| match args.check && ranks.rank() == 0 {
        true => Detector::new(device.clone(), film.scene.clone()).map(Some),
        false => Ok(None),
    })?;
    let mut detector = RankDetector::new(ranks, device, own, &left_out(&film.scene))?;
    print(ranks, &format!("{} ranks, setup {} bytes", ranks.count(), ranks.sent_by_all().setup));
    for step in 0..film.steps(at_rest) {
        let motions = film.motions(step, at_rest);
        let (start, before) = (Instant::now(), ranks.sent_by_all());
        detector.update_whole(&motions)?;
        let found = detector.query(query)?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let all = detector.gather(&found)?;
        let sent = difference(ranks.sent_by_all(), before);
        let ghosts = detector.ghost_count();
        ranks.run(|| {
            let Some(all) = &all else { return Ok(()) };
            println!("step {step}: {}, hash {:016x}; {ms:.1} ms", summary(all), all.hash());
            let Bytes { boxes, ghosts: triangles, answers, .. } = sent;
            println!("  bytes: boxes {boxes}, triangles {triangles}, answers {answers}; {ghosts} triangles on rank 0");
            if args.rows {
                print_rows(&all.rows);
            }
            if let Some(one) = &mut one {
                let ids: Vec<BodyId> = one.scene().ids().collect();
                one.update(&motions.iter().map(|(body, motion)| (ids[*body], *motion)).collect::<Vec<_>>())?;
                let start = Instant::now();
                let wanted = one.query(&query)?;
                let ms = start.elapsed().as_secs_f64() * 1e3;
                let own = (all.hash(), all.count as usize, all.starts_crossing);
                let expected = (wanted.hash(), wanted.len(), wanted.starts_crossing);
                if own != expected {
                    let what = format!("ranks found {own:?} and one machine {expected:?}, in step {step}");
                    return Err(Error::Bug { what });
                }
                println!("  equal to one machine; {ms:.1} ms");
            }
            Ok(())
        })?;
    }
    Ok(())
}

fn summary(all: &RankAnswer) -> String {
    let rows = match &all.rows {
        Rows::Earliest(None) => "no contact".into(),
        Rows::Earliest(Some(toi)) => format!("first contact at t = {toi}"),
        _ => format!("{} rows", all.count),
    };
    match all.starts_crossing {
        None | Some(0) => rows,
        Some(pairs) => format!("{rows}, {pairs} pairs cross at the start"),
    }
}

fn print_rows(rows: &Rows) {
    match rows {
        Rows::Pairs(rows) => rows.iter().for_each(|row| println!("{row:?}")),
        Rows::Contacts(rows) => rows.iter().for_each(|row| println!("{row:?}")),
        Rows::Near(rows) => rows.iter().for_each(|row| println!("{row:?}")),
        _ => {}
    }
}

fn print(ranks: &Ranks, text: &str) {
    if ranks.rank() == 0 {
        println!("{text}");
    }
}

fn difference(after: Bytes, before: Bytes) -> Bytes {
    Bytes {
        setup: after.setup - before.setup,
        boxes: after.boxes - before.boxes,
        ghosts: after.ghosts - before.ghosts,
        answers: after.answers - before.answers,
    }
}
