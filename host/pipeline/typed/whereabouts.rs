//! Positions of all vertices: placed in the scene, or by the poses of instances.

use super::query::QueryMemory;
use super::scene::SceneMemory;
use crate::error::Error;
use crate::mesh;
use crate::pipeline::instances::Instances;
use crate::pipeline::placing::{DeviceArrays, Seen, Whereabouts};
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::math::Vec3;

impl<R: Precision> SceneMemory<R> {
    /// Returns all positions at an end of the step, as a query reads them.
    ///
    /// # Errors
    /// Device errors.
    pub fn all_positions(&self, query: &QueryMemory<R>, end: usize) -> Result<Vec<Vec3<R>>, Error> {
        let placed = || Ok(self.vertices.positions(query.is_at_rest())?.swap_remove(end));
        let Some(own) = self.instances.as_ref().filter(|_| query.is_of_instances) else { return placed() };
        let of_instances = own.positions(&query.layout, end)?;
        let mut all: Vec<Vec3<R>> = of_instances.into_iter().map(|point| point.map(|x| R::of(x))).collect();
        if !self.deforming.is_empty() {
            self.put_placed(&mut all, &placed()?);
        }
        Ok(all)
    }

    /// Puts vertices that are placed among all those of the scene.
    fn put_placed<T: Copy>(&self, all: &mut [T], placed: &[T]) {
        for (ends, first) in self.vertices.starts().windows(2).zip(&self.layout.starts) {
            let own = &placed[ends[0] as usize..ends[1] as usize];
            let first = first.vertex as usize;
            all[first..first + own.len()].copy_from_slice(own);
        }
    }

    /// Returns the positions of all bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn whereabouts(&self) -> Result<Whereabouts, Error> {
        if self.has_vertices && !self.places_deforming {
            return self.vertices.whereabouts();
        }
        let Some(own) = &self.instances else { return self.of_placed_alone() };
        let end = |end: usize| -> Result<Vec<[f64; 3]>, Error> {
            Ok(own.positions(&self.layout, end)?.into_iter().map(|p| p.0).collect())
        };
        let mut ends = [end(0)?, end(1)?];
        if self.places_deforming {
            self.put_whereabouts(&mut ends)?;
        }
        let ends: Vec<mesh::Positions> = ends.into_iter().map(mesh::Positions::F64).collect();
        Ok(Whereabouts { looked_at: ends.len(), ends, poses: own.arrays().poses()?, seen: self.seen()? })
    }

    /// Returns those of bodies that are placed; others, of which none is on the device, are at the
    /// origin.
    fn of_placed_alone(&self) -> Result<Whereabouts, Error> {
        if !self.places_deforming {
            return self.vertices.whereabouts();
        }
        let count = self.layout.starts[self.layout.bodies()].vertex as usize;
        let mut ends = [vec![[0.0; 3]; count], vec![[0.0; 3]; count]];
        self.put_whereabouts(&mut ends)?;
        let ends: Vec<mesh::Positions> = ends.into_iter().map(mesh::Positions::F64).collect();
        Ok(Whereabouts { looked_at: ends.len(), ends, poses: Vec::new(), seen: self.seen()? })
    }

    /// Puts both ends of bodies that deform among those of all vertices.
    fn put_whereabouts(&self, ends: &mut [Vec<[f64; 3]>; 2]) -> Result<(), Error> {
        let placed = self.vertices.whereabouts()?.ends;
        for (end, all) in ends.iter_mut().enumerate() {
            if let Some(placed) = placed.get(end.min(placed.len() - 1)) {
                self.put_placed(all, &placed.to_f64());
            }
        }
        Ok(())
    }

    /// Returns the instances, if their poses are not those of placed vertices.
    fn posed(&self) -> Option<&Instances> {
        self.instances.as_ref().filter(|_| !self.has_vertices || self.places_deforming)
    }

    /// Returns what was read from the caller's memory, and its checks: vertices, then poses of
    /// instances. One of them if all that is read is there.
    pub fn arrays(&self) -> impl Iterator<Item = &DeviceArrays> {
        let placed = Some(self.vertices.arrays()).filter(|_| self.has_vertices || self.instances.is_none());
        placed.into_iter().chain(self.posed().map(Instances::arrays))
    }

    /// Returns the checks of the caller's numbers; `None` if none were read.
    ///
    /// # Errors
    /// Device errors.
    pub fn seen(&self) -> Result<Option<Seen>, Error> {
        let all = self.arrays().map(DeviceArrays::seen).collect::<Result<Vec<_>, _>>()?;
        let both =
            |a: Seen, b: Seen| Seen { invalid: a.invalid | b.invalid, largest: a.largest.max(b.largest) };
        Ok(all.into_iter().flatten().reduce(both))
    }

    /// Returns the words of the last frame's checks, for kernels: of the first arrays, and of the
    /// others.
    pub fn seen_words(&self) -> [Span<u64>; 2] {
        let mut words = self.arrays().filter(|arrays| arrays.any).map(|arrays| arrays.seen.span());
        [words.next(), words.next()].map(|words| words.unwrap_or(Span::EMPTY))
    }
}
