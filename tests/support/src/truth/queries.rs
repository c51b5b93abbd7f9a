//! The public Sample-Queries: handcrafted motions, most of them degenerate, with exact answers.

use crate::data;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::{Rungs, ee_certified, vf_certified};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::io::Read;
use std::path::{Path, PathBuf};

/// One motion: a vertex, then a face; or two edges. Four points at 0, then at 1.
pub struct Motion {
    pub points: [[f64; 3]; 8],
    pub meets: bool,
}

/// The queries of one folder and kind.
pub struct Folder {
    pub name: String,
    pub face: bool,
    pub motions: Vec<Motion>,
}

impl Motion {
    /// Rows of numerators and denominators, three of each, then the truth.
    fn read(rows: &[Vec<String>]) -> Motion {
        let whole = |text: &String| text.trim().parse::<BigInt>().expect("an integer");
        let number = |row: &[String], k: usize| {
            let exact = BigRational::new(whole(&row[2 * k]), whole(&row[2 * k + 1]));
            let double = exact.to_f64().expect("a number");
            assert_eq!(BigRational::from_float(double).as_ref(), Some(&exact), "exact in f64");
            double
        };
        let points = std::array::from_fn(|i| std::array::from_fn(|k| number(&rows[i], k)));
        Motion { points, meets: rows[0][6].trim() == "1" }
    }

    /// Whether f32 holds all coordinates, so that rounding does not change the motion.
    pub fn fits_f32(&self) -> bool {
        self.points.iter().flatten().all(|x| f64::from(*x as f32) == *x)
    }

    /// Whether the cubic in `S` finds a contact of positions in `R`.
    pub fn found<R: Real, S: Real>(&self, face: bool) -> bool {
        let x = |i: usize| Vec3(self.points[i].map(R::of));
        let p = |i: usize| Moving { t0: x(i), t1: x(i + 4) };
        if face {
            vf_toi::<R, S>(p(0), [p(1), p(2), p(3)]).is_some()
        } else {
            ee_toi::<R, S>([p(0), p(1)], [p(2), p(3)]).is_some()
        }
    }
}

impl Motion {
    /// Whether the certified solver lists it: as a contact or as undecided.
    pub fn certified(&self, face: bool, params: &Params) -> bool {
        let p = |i: usize| Moving { t0: Vec3(self.points[i]), t1: Vec3(self.points[i + 4]) };
        let verdict = if face {
            vf_certified(p(0), [p(1), p(2), p(3)], Rungs::All, params)
        } else {
            ee_certified([p(0), p(1)], [p(2), p(3)], Rungs::All, params)
        };
        !verdict.is_separated()
    }
}

/// The motions of one file: eight rows each, no header.
fn read(path: &Path) -> Vec<Motion> {
    let mut text = String::new();
    let file = std::fs::File::open(path).expect("readable");
    flate2::read::GzDecoder::new(file).read_to_string(&mut text).expect("gzip text");
    let rows: Vec<Vec<String>> =
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
    assert_eq!(rows.len() % 8, 0, "{}", path.display());
    rows.chunks_exact(8).map(Motion::read).collect()
}

/// All folders, by name, vertex/face first.
pub fn folders() -> Vec<Folder> {
    let root = data("queries");
    let list = |path: PathBuf| {
        let mut names: Vec<String> = std::fs::read_dir(path)
            .into_iter()
            .flatten()
            .map(|entry| entry.expect("readable").file_name().into_string().expect("a plain name"))
            .collect();
        names.sort();
        names
    };
    let mut all = Vec::new();
    for (kind, face) in [("vertex-face", true), ("edge-edge", false)] {
        for name in list(root.clone()) {
            let mut motions = Vec::new();
            for file in list(root.join(&name).join(kind)) {
                motions.extend(read(&root.join(&name).join(kind).join(file)));
            }
            if !motions.is_empty() {
                all.push(Folder { name: name.clone(), face, motions });
            }
        }
    }
    all
}
