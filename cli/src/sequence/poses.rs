//! Poses of a rigid body in a file of a scene, and the steps between them.

use super::parts;
use nearmiss::scene::{Motion, Pose, PoseStep};
use serde::Deserialize;
use toml::Value;

/// A pose as a file gives it.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseTable {
    rotation: Option<[f64; 4]>,
    translation: Option<[f64; 3]>,
    /// 16 numbers row by row, or four rows.
    matrix: Option<Value>,
    /// The rotation vector of the step that ends here.
    turn: Option<[f64; 3]>,
}

/// Path of every step of a body.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum PathName {
    Turn,
    Straight,
}

/// Poses of a rigid body.
#[derive(Clone)]
pub struct Poses {
    /// One a frame, or one: at least one.
    pub frames: Vec<Pose>,
    /// From each to the next.
    pub steps: Vec<PoseStep>,
}

/// A fault, and its remedy.
type Fault = (String, String);

fn fault<T>(what: impl Into<String>, advice: &str) -> Result<T, Fault> {
    Err((what.into(), advice.into()))
}

impl Poses {
    /// Poses as a file gives them, with the pivot and the path of all steps. Without poses the body
    /// is where its mesh is. Numbers are checked later.
    ///
    /// # Errors
    /// The fault and its remedy, for keys that exclude each other or have no effect.
    pub fn of(
        tables: Vec<PoseTable>,
        (pivot, path): (Option<[f64; 3]>, Option<PathName>),
    ) -> Result<Poses, Fault> {
        let is_straight = path == Some(PathName::Straight);
        if tables.len() < 2 && (pivot.is_some() || path.is_some()) {
            let key = if pivot.is_some() { "pivot" } else { "path" };
            return fault(
                format!("`{key}` has no effect: the body makes no step"),
                "remove it, or give two poses",
            );
        }
        if is_straight && pivot.is_some() {
            return fault("`pivot` has no effect on a straight `path`", "remove one of them");
        }
        let pivot = pivot.unwrap_or_default();
        let tables = if tables.is_empty() { vec![PoseTable::default()] } else { tables };
        let mut all =
            Poses { frames: Vec::with_capacity(tables.len()), steps: Vec::with_capacity(tables.len()) };
        for (at, table) in tables.into_iter().enumerate() {
            let in_frame = |(what, advice)| (format!("`poses`, the one of frame {at}: {what}"), advice);
            let turn = table.turn;
            let pose = table.pose().map_err(in_frame)?;
            let pose = match (all.frames.last(), turn) {
                (None, None) => pose,
                (None, Some(_)) => {
                    return fault(
                        "`turn` in the first pose, at which no step ends",
                        "give it in a later one",
                    )
                    .map_err(in_frame);
                }
                (Some(_), Some(_)) if is_straight => {
                    return fault("`turn` has no effect on a straight `path`", "remove one of them")
                        .map_err(in_frame);
                }
                (Some(start), given) => {
                    let step = match given {
                        Some(turn) => turning(*start, turn, pose.translation, pivot),
                        None if is_straight => PoseStep::new(*start, pose).straight(),
                        None => PoseStep::new(*start, pose).about(pivot),
                    };
                    all.steps.push(step);
                    step.end()
                }
            };
            all.frames.push(pose);
        }
        Ok(all)
    }

    /// The motion that ends at a frame: the step to it, or the first pose.
    pub fn up_to(&self, frame: usize) -> Motion<'static> {
        match frame.checked_sub(1) {
            Some(step) => Motion::PoseStep(self.steps[step]),
            None => Motion::pose(self.frames[0]),
        }
    }
}

/// The step by a rotation vector to a translation.
fn turning(start: Pose, turn: [f64; 3], translation: [f64; 3], pivot: [f64; 3]) -> PoseStep {
    let rotation = PoseStep::turning(start, turn, [0.0; 3]).end().rotation;
    let (from, to) = (start.apply(pivot), Pose { rotation, translation }.apply(pivot));
    PoseStep::turning(start, turn, [0, 1, 2].map(|k| to[k] - from[k])).about(pivot)
}

impl PoseTable {
    /// The pose; its rotation is of no use if there is a turn.
    fn pose(self) -> Result<Pose, Fault> {
        let Pose { rotation, translation } = Pose::default();
        let others = [
            ("rotation", self.rotation.is_some()),
            ("translation", self.translation.is_some()),
            ("turn", self.turn.is_some()),
        ];
        if let Some(matrix) = &self.matrix {
            if let Some((other, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
                return fault(format!("`matrix` and `{other}` exclude each other"), "remove one of them");
            }
            let Some(rows) = rows(matrix) else {
                return fault("`matrix` must be 16 numbers, or 4 rows of 4", "give them row by row");
            };
            return Pose::from_matrix(rows).map_err(|error| parts(&error));
        }
        if self.turn.is_some() && self.rotation.is_some() {
            let advice = "remove one of them: the rotation follows from the turn";
            return fault("`turn` and `rotation` exclude each other", advice);
        }
        Ok(Pose {
            rotation: self.rotation.unwrap_or(rotation),
            translation: self.translation.unwrap_or(translation),
        })
    }
}

/// The rows of 16 numbers, or of four rows.
fn rows(matrix: &Value) -> Option<[[f64; 4]; 4]> {
    let number = |value: &Value| match value {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    };
    let items = matrix.as_array()?;
    let flat: Vec<f64> = if items.len() == 4 {
        let rows: Option<Vec<&Vec<Value>>> = items.iter().map(Value::as_array).collect();
        let rows = rows.filter(|rows| rows.iter().all(|row| row.len() == 4))?;
        rows.into_iter().flatten().map(number).collect::<Option<_>>()?
    } else {
        items.iter().map(number).collect::<Option<_>>()?
    };
    let rows: [[f64; 4]; 4] = flat.as_chunks::<4>().0.try_into().ok()?;
    (flat.len() == 16).then_some(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The poses of a body, as its table has them.
    #[derive(Deserialize)]
    struct Table {
        poses: Vec<PoseTable>,
        pivot: Option<[f64; 3]>,
        path: Option<PathName>,
    }

    fn read(text: &str) -> Poses {
        let Table { poses, pivot, path } = toml::from_str(text).expect("a table");
        Poses::of(poses, (pivot, path)).unwrap_or_else(|(what, _)| panic!("{what}"))
    }

    #[test]
    fn steps_have_the_pivot_and_the_path_of_their_body() {
        let poses = "poses = [{}, { rotation = [0, 0, 1, 0] }, { translation = [1, 2, 3] }]";
        let [a, b, c] = [
            Pose::default(),
            Pose { rotation: [0.0, 0.0, 1.0, 0.0], ..Pose::default() },
            Pose::at([1.0, 2.0, 3.0]),
        ];
        let all = [PoseStep::new(a, b), PoseStep::new(b, c)];
        let pivot = [0.5, -1.0, 2.0];
        for (more, steps) in [
            ("", all),
            ("path = \"turn\"", all),
            ("pivot = [0.5, -1, 2]", all.map(|step| step.about(pivot))),
            ("path = \"straight\"", all.map(|step| step.straight())),
        ] {
            let read = read(&format!("{more}\n{poses}"));
            assert_eq!((read.frames, read.steps), (vec![a, b, c], steps.to_vec()), "{more}");
        }
    }

    #[test]
    fn a_turn_about_a_pivot_ends_at_the_translation_of_its_pose() {
        let turn = [0.0, 3.0, -4.0];
        let pivot = [0.5, -1.0, 2.0];
        let text = "pivot = [0.5, -1, 2]\n\
            poses = [{ rotation = [0.6, 0, 0, 0.8] }, { turn = [0, 3, -4], translation = [1, 2, 3] }, {}]";
        let Poses { frames, steps } = read(text);
        let start = Pose { rotation: [0.6, 0.0, 0.0, 0.8], ..Pose::default() };
        assert_eq!(steps[0].path(), PoseStep::turning(start, turn, [0.0; 3]).about(pivot).path());
        assert_eq!(frames[1].rotation, PoseStep::turning(start, turn, [0.0; 3]).end().rotation);
        assert!((0..3).all(|k| (frames[1].translation[k] - [1.0, 2.0, 3.0][k]).abs() < 1e-15), "{frames:?}");
        // The next step begins where this one ends.
        assert_eq!((steps[0].end(), steps[1].start(), frames[2]), (frames[1], frames[1], Pose::default()));
    }
}
