//! Poses of many bodies in arrays.

use crate::asked::Does;
use crate::borrowed::{BorrowedRows, Held, is_on_gpu, on_cpu, on_gpu};
use crate::detector::Detector;
use crate::errors::{choice, raised};
use crate::host::doubles;
use crate::key::{self, Key};
use nearmiss::Device;
use nearmiss::contacts::DeviceExtras;
use nearmiss::scene::Poses;
use pyo3::prelude::*;

/// Columns of poses: positions, then quaternions.
pub enum Columns {
    Here(Vec<[f64; 3]>, Vec<[f64; 4]>),
    Borrowed(BorrowedRows, BorrowedRows),
}

impl Columns {
    /// Two arrays; `which` is the beginning of their names. With `stays` they are read in place, also
    /// those of the host.
    fn of(
        positions: &Bound<'_, PyAny>,
        quaternions: &Bound<'_, PyAny>,
        (which, device): (&str, &Device),
        stays: bool,
    ) -> PyResult<Columns> {
        let (p, q) = (format!("{which}positions"), format!("{which}quaternions"));
        match (is_on_gpu(positions), is_on_gpu(quaternions)) {
            (true, true) => Ok(Columns::Borrowed(
                on_gpu(positions, &[device], (3, &p))?,
                on_gpu(quaternions, &[device], (4, &q))?,
            )),
            (false, false) if stays => {
                let in_place = |array, width, name: &str| {
                    let rows = if device.is_gpu() { None } else { on_cpu(array, (width, name))? };
                    rows.ok_or_else(|| {
                        choice(
                            format!("{name} cannot be read in place"),
                            "give packed rows of single or double precision in the detector's memory: of its \
                             GPU, or numpy arrays for a CPU",
                        )
                    })
                };
                Ok(Columns::Borrowed(in_place(positions, 3, &p)?, in_place(quaternions, 4, &q)?))
            }
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

/// Bodies, their poses, and those at the end of a step.
struct Many {
    keys: Vec<Key>,
    start: Columns,
    end: Option<Columns>,
}

impl Many {
    fn of(device: &Device, ids: &Bound<'_, PyAny>, ends: Ends<'_, '_>, stays: bool) -> PyResult<Many> {
        let keys = ids.try_iter().map_err(|_| {
            choice(
                format!("ids must be a list of bodies, got {}", ids.get_type()),
                "use [0] for a single one",
            )
        })?;
        let keys = keys.map(|key| Key::of(&key?, "ids")).collect::<PyResult<Vec<_>>>()?;
        let columns = |[positions, quaternions]: [Option<&Bound<'_, PyAny>>; 2], which: &str| match (
            positions,
            quaternions,
        ) {
            (Some(positions), Some(quaternions)) => {
                Columns::of(positions, quaternions, (which, device), stays).map(Some)
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
        Ok(Many { keys, start, end })
    }

    fn held(self) -> Vec<Held> {
        [Some(self.start), self.end].into_iter().flatten().flat_map(Columns::held).collect()
    }
}

impl Detector {
    /// Moves many bodies by arrays.
    pub fn move_by_arrays(&self, py: Python<'_>, ids: &Bound<'_, PyAny>, ends: Ends<'_, '_>) -> PyResult<()> {
        let many = Many::of(&self.device.get().device, ids, ends, false)?;
        let (done, unread) = self.work(py, |one| {
            one.count(Does::Moves);
            let detector = &mut one.detector;
            let done = key::bodies(detector.scene(), &many.keys).and_then(|ids| match &many.end {
                None => detector.update_poses(&ids, many.start.poses()),
                Some(end) => detector.update_pose_steps(&ids, many.start.poses(), end.poses()),
            });
            let unread = one.read(many.held(), false);
            (done, unread)
        })?;
        drop(unread);
        done.map_err(raised)
    }

    /// Prepares submissions of queries, with bodies that move by arrays.
    pub fn prepared_by_arrays(
        &self,
        py: Python<'_>,
        (ids, ends): (&Bound<'_, PyAny>, Ends<'_, '_>),
        queries: &[nearmiss::Query],
        extras: &DeviceExtras,
    ) -> PyResult<()> {
        let many = Many::of(&self.device.get().device, ids, ends, true)?;
        let (start, end) = (many.start.poses(), many.end.as_ref().map(Columns::poses));
        let given = self.look(py, |detector| {
            let ids = key::bodies(detector.scene(), &many.keys)?;
            detector.device_motions(&ids, start, end)
        })?;
        let given = given.map_err(raised)?;
        let held = many.held();
        let (done, unread) = self
            .work(py, |one| one.prepare(held, |detector| detector.prepare_with(&given, queries, extras)))?;
        drop(unread);
        done.map_err(raised)
    }
}
