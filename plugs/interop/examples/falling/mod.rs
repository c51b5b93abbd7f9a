//! A cloth that falls onto a wavy floor, and the same simulation on the CPU to compare with.

use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Motion, Scene};
use nearmiss::{Body, Continuous, Detector, Device, Error, Mesh, Query};

/// The kernel that moves vertices, as text: the driver compiles it.
pub const STEP: &str = include_str!("step.ptx");
/// Frames of each half of the program.
pub const FRAMES: usize = 20;

/// Vertices of a side of a sheet.
const SIDE: usize = 40;

fn sheet(name: &str, height: impl Fn(f32, f32) -> f32) -> Result<Mesh, Error> {
    let at = |k: usize| k as f32 / (SIDE - 1) as f32;
    let vertices = (0..SIDE * SIDE).map(|k| (at(k / SIDE), at(k % SIDE))).map(|(x, y)| [x, y, height(x, y)]);
    let corners = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| (row * SIDE + column) as u32));
    let side = SIDE as u32;
    let faces = corners.flat_map(|k| [[k, k + side, k + side + 1], [k, k + side + 1, k + 1]]).collect();
    Mesh::new(name, Positions::F32(vertices.collect()), faces)
}

/// A detector of a cloth and a floor, and the number of the cloth.
pub fn detector(device: Device) -> Result<(Detector, BodyId), Error> {
    let mut scene = Scene::new();
    let cloth = scene.add(Body::deformable(sheet("cloth", |x, y| 0.2 + 0.1 * x * y)?));
    scene.add(Body::fixed(sheet("floor", |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos())?));
    Ok((Detector::new(device, scene)?, cloth))
}

/// The simulation on the CPU.
pub struct Host {
    detector: Detector,
    cloth: BodyId,
    /// x, y and z of each vertex.
    pub positions: Vec<f32>,
    /// The change of each number in a frame.
    pub velocity: Vec<f32>,
    contacts: usize,
}

impl Host {
    /// The simulation before the first frame.
    pub fn new() -> Result<Host, Error> {
        let (detector, cloth) = detector(Device::open(Backend::Cpu, None)?)?;
        let Some(Positions::F32(rows)) = detector.scene().get(cloth).map(Body::positions_t0) else {
            return Err(Error::Bug { what: "the cloth is in f32".into() });
        };
        let positions: Vec<f32> = rows.as_flattened().to_vec();
        let speed = |k: usize| if k % 3 == 2 { -0.012 - 0.002 * (k as f32 / 50.0).sin() } else { 0.0 };
        let velocity = (0..positions.len()).map(speed).collect();
        Ok(Host { detector, cloth, positions, velocity, contacts: 0 })
    }

    /// The next frame; an error if its contacts are not these.
    pub fn compare(&mut self, frame: usize, found: usize, hash: u64) -> Result<(), Error> {
        let rows = |numbers: &[f32]| numbers.as_chunks::<3>().0.to_vec();
        let start = rows(&self.positions);
        self.positions.iter_mut().zip(&self.velocity).for_each(|(x, v)| *x += v);
        self.detector.update(&[(self.cloth, Motion::step(&start, &rows(&self.positions)))])?;
        let wanted = self.detector.query(&Query::from(Continuous::default()))?;
        if (wanted.len(), wanted.hash()) != (found, hash) {
            let what = format!("frame {frame}: {found} contacts, and {} on the CPU", wanted.len());
            return Err(Error::Bug { what });
        }
        println!("frame {frame}: {found} contacts");
        self.contacts += found;
        Ok(())
    }

    /// Prints `same`, if there was anything to compare.
    pub fn done(self) -> Result<(), Error> {
        if self.contacts == 0 {
            return Err(Error::Bug { what: "the cloth never met the floor".into() });
        }
        println!("same");
        Ok(())
    }
}
