//! Pose of a rigid body: a rotation and a translation.

use crate::error::Error;
use crate::mesh::Problem;
use nearmiss_kernels::abi::PoseRecord;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::tolerance::POSE_UNIT;
use nearmiss_kernels::math::turn::between;
use nearmiss_kernels::stage::place::moved;

/// Rigid motion of a body's points: a rotation, then a translation.
///
/// A placed vertex is `R v + t`, computed in f64 ([`Pose::apply`]), also for meshes in f32. Every
/// answer is about these vertices, so a scene with a rigid body has positions in f64.
///
/// ```
/// use nearmiss::scene::Pose;
///
/// // A quarter turn about z, and 2 up.
/// let half = 0.5_f64.sqrt();
/// let pose = Pose { rotation: [0.0, 0.0, half, half], translation: [0.0, 0.0, 2.0] };
/// // The same by a matrix, in rows.
/// let matrix = [[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, 1.0]];
/// assert_eq!(Pose::from_matrix(matrix)?.translation, pose.translation);
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Unit quaternion: x, y, z, w. It may be off unit length by up to 1.19e-4, and is then
    /// normalised. A quaternion rounded to f32 is off by 1e-7. One that is farther off is refused.
    pub rotation: [f64; 4],
    /// Translation, in scene units.
    pub translation: [f64; 3],
}

impl Default for Pose {
    /// No motion.
    fn default() -> Pose {
        Pose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] }
    }
}

#[cfg(feature = "nalgebra")]
impl From<nalgebra::Isometry3<f64>> for Pose {
    fn from(motion: nalgebra::Isometry3<f64>) -> Pose {
        Pose { rotation: motion.rotation.coords.into(), translation: motion.translation.vector.into() }
    }
}

impl Pose {
    /// A translation without rotation.
    pub fn at(translation: [f64; 3]) -> Pose {
        Pose { translation, ..Pose::default() }
    }

    /// Returns the placed point `R v + t`, computed in f64 with the operations of every machine.
    /// Its bits are those of the vertices that a [`Detector`](crate::Detector) places and that its
    /// answers are about. The quaternion is normalised first.
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        moved(&self.record(), Vec3(point)).0
    }

    /// Checks the pose.
    ///
    /// # Errors
    /// [`Error::Input`], naming `body`, for a rotation that is no unit quaternion and for numbers
    /// that are not finite.
    pub(crate) fn check(&self, body: &str) -> Result<(), Error> {
        // False for NaN.
        let unit = (self.length() - 1.0).abs() <= POSE_UNIT;
        if unit && self.translation.iter().all(|t| t.is_finite()) {
            return Ok(());
        }
        let problem = Problem::NoPose { rotation: self.rotation, translation: self.translation };
        Err(Error::Input { file: body.into(), problem })
    }

    /// Returns the turn from this pose to another: its angle in [0, pi] and its axis. The axis is
    /// in the frame of the body's points, not of length 1. Quaternions of opposite sign are the
    /// same rotation.
    pub(crate) fn turn_to(&self, other: &Pose) -> (f64, Vec3<f64>) {
        // From one to the other in the frame of the points: between the inverse rotations, back.
        let inverse = |pose: &Pose| {
            let [x, y, z, w] = pose.record().rotation;
            [-x, -y, -z, w]
        };
        let turn = between(inverse(other), inverse(self));
        (turn.dot(turn).sqrt(), turn)
    }

    fn length(&self) -> f64 {
        let [x, y, z, w] = self.rotation;
        (x * x + y * y + z * z + w * w).sqrt()
    }

    /// Record for kernels.
    pub(crate) fn record(&self) -> PoseRecord {
        let length = self.length();
        PoseRecord { rotation: self.rotation.map(|q| q / length), translation: self.translation, pad: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_a_quaternion_of_length_1() {
        let pose = Pose { rotation: [0.0, 0.0, 0.6, 0.80001], translation: [1.0, 2.0, 3.0] };
        assert!(pose.check("a body").is_ok());
        let [x, y, z, w] = pose.record().rotation;
        assert!((x * x + y * y + z * z + w * w - 1.0).abs() < 1e-15);
        // No rotation is no change, to the bit.
        assert_eq!(Pose::default().record().rotation, [0.0, 0.0, 0.0, 1.0]);
        // A quarter turn about z, and 2 up: x goes to y.
        let half = 0.5_f64.sqrt();
        let quarter = Pose { rotation: [0.0, 0.0, half, half], translation: [0.0, 0.0, 2.0] };
        let there = quarter.apply([1.0, 0.0, 0.0]);
        assert!(there.iter().zip([0.0, 1.0, 2.0]).all(|(x, y)| (x - y).abs() < 1e-15), "{there:?}");
    }

    #[cfg(feature = "nalgebra")]
    #[test]
    fn an_isometry_is_a_pose() {
        use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(1.0, 0.0, 0.0, 0.0));
        let motion = Isometry3 { rotation, translation: Translation3::new(1.0, 2.0, 3.0) };
        assert_eq!(Pose::from(motion), Pose::at([1.0, 2.0, 3.0]));
    }

    #[test]
    fn what_is_no_pose_is_named() {
        let bad = [
            Pose { rotation: [0.0; 4], ..Pose::default() },
            Pose { rotation: [0.0, 0.0, 0.0, 1.1], ..Pose::default() },
            Pose { rotation: [f64::NAN, 0.0, 0.0, 1.0], ..Pose::default() },
            Pose::at([0.0, f64::INFINITY, 0.0]),
        ];
        for pose in bad {
            let error = pose.check("the crate").expect_err("refused").to_string();
            assert!(error.contains("the crate") && error.contains("unit quaternion"), "{error}");
        }
    }
}
