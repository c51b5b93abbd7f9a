//! Poses of many bodies in two arrays.

use super::{BodyId, BodyKind, DeviceMotion, DevicePose, DeviceRows, Motion, Pose, PoseStep, Scene};
use crate::error::Error;

/// Poses of many rigid bodies, a row a body: translations, and rotations as unit quaternions
/// x, y, z, w. See [`Pose`].
///
/// ```
/// use nearmiss::scene::{Poses, Scene};
/// use nearmiss::{Body, Detector, Device, Discrete, Mesh, device::Backend, mesh::Positions};
///
/// let corners = Positions::F32(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
/// let mesh = Mesh::new("a triangle", corners, vec![[0, 1, 2]])?;
/// let mut scene = Scene::new();
/// let bodies = [(); 100].map(|()| scene.add(Body::rigid(mesh.clone())));
/// let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
/// let positions: Vec<[f64; 3]> = (0..100).map(|k| [2.0 * f64::from(k), 0.0, 0.0]).collect();
/// let quaternions = [[0.0, 0.0, 0.0, 1.0]; 100];
/// detector.update_poses(&bodies, Poses::new(&positions, &quaternions))?;
/// assert!(detector.query(&Discrete::default())?.is_empty());
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Poses<'a>(Rows<'a>);

#[derive(Clone, Copy, Debug)]
enum Rows<'a> {
    Here(&'a [[f64; 3]], &'a [[f64; 4]]),
    OnDevice(DeviceRows, DeviceRows),
}

/// One row.
enum Row {
    Here(Pose),
    OnDevice(DevicePose),
}

impl<'a> Poses<'a> {
    /// Poses in memory of the host: translations and quaternions.
    pub fn new(positions: &'a [[f64; 3]], quaternions: &'a [[f64; 4]]) -> Poses<'a> {
        Poses(Rows::Here(positions, quaternions))
    }

    /// Poses in device memory: translations and quaternions.
    pub fn on_device(positions: DeviceRows, quaternions: DeviceRows) -> Poses<'static> {
        Poses(Rows::OnDevice(positions, quaternions))
    }

    /// Checks that there is a row a body in both arrays; `which` names them.
    fn check(&self, bodies: usize, which: &str) -> Result<(), Error> {
        let (positions, quaternions) = match self.0 {
            Rows::Here(positions, quaternions) => (positions.len(), quaternions.len()),
            Rows::OnDevice(positions, quaternions) => (positions.len(), quaternions.len()),
        };
        if positions == bodies && quaternions == bodies {
            return Ok(());
        }
        Err(Error::InvalidArgument {
            what: format!(
                "{which}positions have {positions} rows and {which}quaternions {quaternions}, for {bodies} bodies"
            ),
            advice: "give one row of each for each body".into(),
        })
    }

    /// A row; [`Poses::check`] has passed.
    fn row(&self, row: usize) -> Row {
        match self.0 {
            Rows::Here(positions, quaternions) => {
                Row::Here(Pose { rotation: quaternions[row], translation: positions[row] })
            }
            Rows::OnDevice(positions, quaternions) => {
                Row::OnDevice(DevicePose { translation: positions.row(row), rotation: quaternions.row(row) })
            }
        }
    }
}

/// Motions of bodies by rows of poses, at rest or at both ends of a step.
///
/// # Errors
/// [`Error::InvalidArgument`] for arrays of other lengths, for ends in different memories, and for a
/// body that is missing, named twice or not rigid. [`Error::Input`] for an invalid pose. They name
/// the row and the body.
pub(crate) fn motions(
    scene: &Scene,
    bodies: &[BodyId],
    start: Poses,
    end: Option<Poses>,
) -> Result<Vec<(BodyId, Motion<'static>)>, Error> {
    start.check(bodies.len(), "")?;
    end.map_or(Ok(()), |end| end.check(bodies.len(), "end "))?;
    let mut named = vec![false; scene.bodies().len()];
    let mut motions = Vec::with_capacity(bodies.len());
    for (row, &id) in bodies.iter().enumerate() {
        let refused =
            |what: String, advice: &str| Err(Error::InvalidArgument { what, advice: advice.to_owned() });
        let Some(body) = scene.get(id) else {
            let advice = "name bodies by the numbers that adding them returned, until they are removed";
            return refused(format!("row {row} names body {id}, which is not in the scene"), advice);
        };
        let name = body.name();
        if body.kind() != BodyKind::Rigid {
            let what = format!("row {row} names body {id}, {name}, which is {}", body.kind().name());
            return refused(what, "give poses to rigid bodies alone");
        }
        if std::mem::replace(&mut named[id.index()], true) {
            return refused(
                format!("row {row} names body {id}, {name}, a second time"),
                "give one row for each body",
            );
        }
        let motion = match (start.row(row), end.map(|end| end.row(row))) {
            (Row::Here(pose), None) => Motion::Pose(pose),
            (Row::Here(start), Some(Row::Here(end))) => Motion::PoseStep(PoseStep::new(start, end)),
            (Row::OnDevice(pose), None) => Motion::OnDevice(DeviceMotion::Pose(pose)),
            (Row::OnDevice(start), Some(Row::OnDevice(end))) => {
                Motion::OnDevice(DeviceMotion::PoseStep([start, end]))
            }
            _ => {
                return refused(
                    "start and end of the poses are in different memories".into(),
                    "give both on the device, or both on the host",
                );
            }
        };
        body.check(&motion).map_err(|error| in_row(error, row, id))?;
        motions.push((id, motion));
    }
    Ok(motions)
}

/// The error, with the row and the number of its body.
#[allow(clippy::wildcard_enum_match_arm, reason = "other errors name no body")]
fn in_row(error: Error, row: usize, id: BodyId) -> Error {
    match error {
        Error::Input { file, problem } => {
            Error::Input { file: format!("row {row}, body {id}, {file}"), problem }
        }
        other => other,
    }
}
