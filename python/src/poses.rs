//! Poses of many bodies in arrays.

use crate::asked::Does;
use crate::borrowed::{BorrowedRows, Held, is_on_gpu, on_gpu};
use crate::detector::Detector;
use crate::errors::{choice, raised};
use crate::host::doubles;
use crate::key::{self, Key};
use nearmiss::Device;
use nearmiss::scene::Poses;
use pyo3::prelude::*;

/// Columns of poses: positions, then quaternions.
pub enum Columns {
    Here(Vec<[f64; 3]>, Vec<[f64; 4]>),
    Borrowed(BorrowedRows, BorrowedRows),
}

impl Columns {
    /// Two arrays; `which` is the beginning of their names.
    fn of(
        positions: &Bound<'_, PyAny>,
        quaternions: &Bound<'_, PyAny>,
        (which, device): (&str, &Device),
    ) -> PyResult<Columns> {
        let (p, q) = (format!("{which}positions"), format!("{which}quaternions"));
        match (is_on_gpu(positions), is_on_gpu(quaternions)) {
            (true, true) => Ok(Columns::Borrowed(
                on_gpu(positions, &[device], (3, &p))?,
                on_gpu(quaternions, &[device], (4, &q))?,
            )),
            (false, false) => Ok(Columns::Here(doubles(positions, &p)?, doubles(quaternions, &q)?)),
            _ => Err(choice(
                format!("{p} and {q} are in different memories"),
                "give both on the GPU, or both on the host",
            )),
        }
    }

    fn poses(&self) -> Poses<'_> {
        match self {
            Columns::Here(positions, quaternions) => Poses::new(positions, quaternions),
            Columns::Borrowed(positions, quaternions) => Poses::on_device(positions.rows, quaternions.rows),
        }
    }

    fn held(self) -> Vec<Held> {
        match self {
            Columns::Here(..) => Vec::new(),
            Columns::Borrowed(positions, quaternions) => vec![positions.held, quaternions.held],
        }
    }
}

/// Arrays of both ends: positions and quaternions of each.
pub type Ends<'a, 'py> = [[Option<&'a Bound<'py, PyAny>>; 2]; 2];

impl Detector {
    /// Moves many bodies by arrays.
    pub fn move_by_arrays(&self, py: Python<'_>, ids: &Bound<'_, PyAny>, ends: Ends<'_, '_>) -> PyResult<()> {
        let keys = ids.try_iter().map_err(|_| {
            choice(
                format!("ids must be a list of bodies, got {}", ids.get_type()),
                "use [0] for a single one",
            )
        })?;
        let keys = keys.map(|key| Key::of(&key?, "ids")).collect::<PyResult<Vec<_>>>()?;
        let device = &self.device.get().device;
        let columns = |[positions, quaternions]: [Option<&Bound<'_, PyAny>>; 2], which: &str| match (
            positions,
            quaternions,
        ) {
            (Some(positions), Some(quaternions)) => {
                Columns::of(positions, quaternions, (which, device)).map(Some)
            }
            (None, None) => Ok(None),
            (given, _) => {
                let [there, lacking] =
                    if given.is_some() { ["positions", "quaternions"] } else { ["quaternions", "positions"] };
                let what = format!("{which}{there} without {which}{lacking}");
                Err(choice(what, "give both, or neither for bodies that rest"))
            }
        };
        let [start, end] = [columns(ends[0], "")?, columns(ends[1], "end_")?];
        let Some(start) = start else {
            return Err(choice("poses are missing", "give positions and quaternions"));
        };
        let (done, unread) = self.work(py, |one| {
            one.count(Does::Moves);
            let detector = &mut one.detector;
            let done = key::bodies(detector.scene(), &keys).and_then(|ids| match &end {
                None => detector.update_poses(&ids, start.poses()),
                Some(end) => detector.update_pose_steps(&ids, start.poses(), end.poses()),
            });
            let held = [Some(start), end].into_iter().flatten().flat_map(Columns::held).collect();
            let unread = one.read(held, false);
            (done, unread)
        })?;
        drop(unread);
        done.map_err(raised)
    }
}
