//! Places of triangles in a message: positions at both ends of a step, or a step of a rigid body.

use crate::bytes::{Reader, Writer};
use nearmiss::Body;
use nearmiss::mesh::{Points, Positions};
use nearmiss::scene::{BodyKind, Pose, PosePath, PoseStep};

/// Place of some vertices of a body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// Positions at the start, and at the end if they move; of a rigid body those of its mesh.
    pub ends: Vec<Positions>,
    /// Step of a rigid body.
    pub step: Option<PoseStep>,
}

/// Numbers of a step in a message.
type Packed = [f64; 22];

impl Place {
    /// Place of these vertices of a body.
    pub fn of(body: &Body, vertices: &[u32]) -> Place {
        let ends = std::iter::once(body.positions_t0()).chain(body.positions_t1());
        let ends = ends.map(|positions| chosen(positions.into(), vertices)).collect();
        Place { ends, step: (body.kind() == BodyKind::Rigid).then(|| body.pose_step()) }
    }

    /// Writes it. Positions that never move are written only with `whole`.
    pub fn write(&self, kind: BodyKind, whole: bool, message: &mut Writer) {
        message.put(&self.step.iter().map(pack).collect::<Vec<Packed>>());
        let ends: &[Positions] = if whole || kind == BodyKind::Deformable { &self.ends } else { &[] };
        message.put(&ends.iter().map(|positions| positions.is_f64().into()).collect::<Vec<u8>>());
        for positions in ends {
            match positions {
                Positions::F32(points) => message.put(points),
                Positions::F64(points) => message.put(points),
            }
        }
    }

    /// Reads what [`Place::write`] wrote; positions that are not in the message stay.
    pub fn read(&mut self, reader: &mut Reader) {
        self.step = reader.take::<Packed>().first().map(unpack);
        let are_f64: Vec<u8> = reader.take();
        let one = |is_f64| match is_f64 {
            0 => Positions::F32(reader.take()),
            _ => Positions::F64(reader.take()),
        };
        let ends: Vec<Positions> = are_f64.into_iter().map(one).collect();
        if !ends.is_empty() {
            self.ends = ends;
        }
    }
}

/// Returns the positions of these vertices.
pub(crate) fn chosen(positions: Points, vertices: &[u32]) -> Positions {
    match positions {
        Points::F32(all) => Positions::F32(vertices.iter().map(|&v| all[v as usize]).collect()),
        Points::F64(all) => Positions::F64(vertices.iter().map(|&v| all[v as usize]).collect()),
    }
}

fn pack(step: &PoseStep) -> Packed {
    let ([start, end], path) = ([step.start(), step.end()], step.path());
    let of = |pose: Pose| pose.rotation.into_iter().chain(pose.translation);
    let (pivot, by, kind) = match path {
        PosePath::Straight => ([0.0; 3], [0.0; 3], 0.0),
        PosePath::Turn { pivot, by: None } => (pivot, [0.0; 3], 1.0),
        PosePath::Turn { pivot, by: Some(by) } => (pivot, by, 2.0),
    };
    let numbers = of(start).chain(of(end)).chain(pivot).chain(by).chain([kind]);
    let mut packed = [0.0; 22];
    packed.iter_mut().zip(numbers).for_each(|(to, from)| *to = from);
    packed
}

fn unpack(packed: &Packed) -> PoseStep {
    let three = |at: usize| [packed[at], packed[at + 1], packed[at + 2]];
    let pose = |at: usize| Pose {
        rotation: [packed[at], packed[at + 1], packed[at + 2], packed[at + 3]],
        translation: three(at + 4),
    };
    let path = match packed[20] {
        0.0 => PosePath::Straight,
        1.0 => PosePath::Turn { pivot: three(14), by: None },
        _ => PosePath::Turn { pivot: three(14), by: Some(three(17)) },
    };
    PoseStep::along([pose(0), pose(7)], path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_positions_come_back_to_the_bit() {
        let [a, b] = [[0.1, 0.2, 0.3], [1e-300, -0.0, 7.0]].map(Pose::at);
        let turn = PoseStep::turning(a, [0.1, 0.0, 3.0], [0.0, 1.0, 0.0]).about([0.5, 0.25, 0.1]);
        for step in
            [PoseStep::new(a, b), PoseStep::new(a, b).about([1.0; 3]), PoseStep::new(a, b).straight(), turn]
        {
            let ends = vec![Positions::F32(vec![[0.1; 3]]), Positions::F32(vec![[0.2; 3]])];
            let place = Place { ends, step: Some(step) };
            let mut message = Writer::default();
            place.write(BodyKind::Rigid, true, &mut message);
            let mut read = Place { ends: Vec::new(), step: None };
            read.read(&mut Reader(&message.0));
            assert_eq!(
                pack(read.step.as_ref().expect("a step")).map(f64::to_bits),
                pack(&step).map(f64::to_bits)
            );
            assert_eq!(read.ends, place.ends);
            let mut moved = Writer::default();
            place.write(BodyKind::Rigid, false, &mut moved);
            assert!(moved.0.len() < message.0.len());
            read.read(&mut Reader(&moved.0));
            assert_eq!(read.ends, place.ends, "positions of the mesh stay");
        }
    }
}
