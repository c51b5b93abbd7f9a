//! Checker of meshes of bodies that deform: compares their boxes with positions, after download.

use super::Instances;
use crate::error::Error;
use nearmiss_kernels::abi::{MeshLeaf, MeshNode, MeshRecord, NONE};
use nearmiss_kernels::bv::FrameBox;
use nearmiss_kernels::bvh::tiles::TILE;
use nearmiss_kernels::math::Vec3;

/// The boxes of a mesh on the host.
struct Boxes {
    nodes: Vec<MeshNode>,
    leaves: Vec<MeshLeaf>,
    columns: Vec<u32>,
}

impl Instances {
    /// Checks that boxes of bodies that deform hold them at all ends of the step: those of triangles, in
    /// rows and in columns, of tiles and of the nodes above.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub fn check_deforming(&self, faces: &[[u32; 3]], ends: &[Vec<Vec3<f64>>]) -> Result<(), Error> {
        let boxes = Boxes {
            nodes: self.nodes.read(self.nodes.len())?,
            leaves: self.leaves.read(self.leaves.len())?,
            columns: self.columns.read(self.columns.len())?,
        };
        let records = self.records.read(self.records.len())?;
        for mesh in self.meshes.read(self.meshes.len())?.iter().filter(|mesh| mesh.deforms != 0) {
            let first = records[mesh.body as usize].triangle;
            let corners = |number: u32| -> Vec<[f32; 3]> {
                let face = faces[(first + number) as usize];
                let about = |at: Vec3<f64>| (at - Vec3(mesh.centre)).map(|x| x as f32).0;
                ends.iter().flat_map(|end| face.map(|v| about(end[v as usize]))).collect()
            };
            boxes.check(mesh, corners).map_err(|what| Error::Bug {
                what: format!("the mesh of body {} that deforms is broken: {what}", mesh.body),
            })?;
        }
        Ok(())
    }
}

impl Boxes {
    /// Checks a mesh whose triangles have these corners.
    fn check(&self, mesh: &MeshRecord, corners: impl Fn(u32) -> Vec<[f32; 3]>) -> Result<(), String> {
        let (lo, hi) = (mesh.lo.map(|x| x as f32), mesh.hi.map(|x| x as f32));
        let mut waiting = vec![(mesh.root, vec![FrameBox { lo, hi }])];
        while let Some((at, mut above)) = waiting.pop() {
            let node = &self.nodes[at as usize];
            above.push(node.volume);
            if node.count > 0 {
                waiting.extend((0..node.count).map(|i| (node.first + i, above.clone())));
                continue;
            }
            let places = at * TILE..(at + 1) * TILE;
            for place in places.filter(|&place| self.leaves[place as usize].number != NONE) {
                let leaf = &self.leaves[place as usize];
                let of_tile = (place / TILE * MeshLeaf::COLUMNS * TILE + place % TILE) as usize;
                let column = |k: usize| self.columns[of_tile + k * TILE as usize];
                if leaf.columns() != [0, 1, 2, 3, 4, 5].map(column) {
                    return Err(format!("the columns of place {place} differ from its box"));
                }
                let volumes = above.iter().rev().chain([&leaf.volume]);
                let own = corners(leaf.number);
                let holds =
                    |of: &FrameBox| own.iter().all(|p| (0..3).all(|k| of.lo[k] <= p[k] && p[k] <= of.hi[k]));
                if let Some(level) = volumes.into_iter().position(|volume| !holds(volume)) {
                    return Err(format!("volume {level} around place {place} does not hold it"));
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Device;
    use crate::device::emulator::{Emulator, Mode};
    use crate::pipeline::Layout;
    use crate::query::Query;
    use crate::samples::soup;
    use crate::scene::Body;
    use nearmiss_kernels::abi::{Point, Positions, Span, VertexMotion};

    /// Returns the checker's verdict on a body that deforms next to a rigid one, after a fault.
    fn checked(fault: impl Fn(&mut Instances)) -> Result<(), Error> {
        let device = Device::emulator(Emulator::new(Mode::Engine, None)?);
        let rigid = Body::rigid(soup(20, 1, false).frames().swap_remove(0));
        let bodies = [rigid, soup(1_100, 5, false)];
        let layout = Layout::new(&bodies, Query::continuous().kind());
        let vertices = bodies[1].vertex_count();
        let mut instances = Instances::new(&device, (&bodies, &[0, 0, vertices as u32]), &layout, &[])?;
        instances.ready_motion(&device, (&bodies, &layout), false)?;
        let [t0, t1] = [0.5, -0.3].map(|by| {
            let at = |v: usize| bodies[1].positions_t0().get_f64(v).unwrap_or_default();
            (0..vertices).map(|v| Vec3(at(v)) + Vec3([by, by * at(v)[0], 2.0 * by])).collect::<Vec<_>>()
        });
        let motion = |v: usize| VertexMotion { t0: Point::from(t0[v]), t1: Point::from(t1[v]) };
        let placed = device.upload(&(0..vertices).map(motion).collect::<Vec<_>>())?;
        let from = Positions { still: Span::EMPTY, moving: placed.span(), turns: Span::EMPTY };
        instances.spread(&device, from, false)?;
        instances.sweep(&device, false)?;
        fault(&mut instances);
        let of_rigid = vec![Vec3([0.0; 3]); bodies[0].vertex_count()];
        let ends = [t0, t1].map(|end| of_rigid.iter().copied().chain(end).collect());
        instances.check_deforming(&layout.faces, &ends)
    }

    /// The first tile of the body that deforms, and its root.
    fn tile_and_root(instances: &Instances) -> (usize, usize) {
        let mesh = instances.meshes.read(2).expect("read")[1];
        assert!(mesh.deforms == 1 && mesh.body == 1);
        let nodes = instances.nodes.read(instances.nodes.len()).expect("read");
        let mut at = mesh.root as usize;
        while nodes[at].count > 0 {
            at = nodes[at].first as usize;
        }
        (at, mesh.root as usize)
    }

    #[test]
    fn boxes_of_bodies_that_deform_hold_the_step_and_others_are_named() {
        type Fault<'a> = Box<dyn Fn(&mut Instances) + 'a>;
        checked(|_| ()).expect("boxes hold the step");
        let shrink = |instances: &mut Instances, at: usize| {
            let mut nodes = instances.nodes.read(instances.nodes.len()).expect("read");
            nodes[at].volume.hi = nodes[at].volume.lo;
            instances.nodes.write(&nodes).expect("written");
        };
        let faults: [(&str, Fault); 4] = [
            ("volume 0", Box::new(|own| shrink(own, tile_and_root(own).0))),
            ("volume 2", Box::new(|own| shrink(own, tile_and_root(own).1))),
            (
                "columns",
                Box::new(|own| {
                    let at = tile_and_root(own).0 * (TILE * MeshLeaf::COLUMNS) as usize;
                    let mut columns = own.columns.read(own.columns.len()).expect("read");
                    columns[at] = 0;
                    own.columns.write(&columns).expect("written");
                }),
            ),
            (
                "does not hold",
                Box::new(|own| {
                    // Boxes around the start alone.
                    let mut leaves = own.leaves.read(own.leaves.len()).expect("read");
                    let triangles = own.triangles.read(own.triangles.len()).expect("read");
                    for (leaf, triangle) in leaves.iter_mut().zip(&triangles) {
                        leaf.volume = nearmiss_kernels::bvh::relation::corners_box(&triangle.corners);
                    }
                    let of = |tile: &[MeshLeaf]| {
                        (0..MeshLeaf::COLUMNS as usize)
                            .flat_map(|k| tile.iter().map(move |leaf| leaf.columns()[k]))
                            .collect::<Vec<_>>()
                    };
                    own.leaves.write(&leaves).expect("written");
                    let columns: Vec<u32> = leaves.chunks(TILE as usize).flat_map(of).collect();
                    own.columns.write(&columns).expect("written");
                }),
            ),
        ];
        for (name, fault) in faults {
            let error = checked(fault).expect_err("a fault").to_string();
            assert!(error.contains("body 1") && error.contains(name), "{name}: {error}");
        }
    }
}
