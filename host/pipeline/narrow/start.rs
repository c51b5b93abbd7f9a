//! The triangle pairs that share a point at the start of a step: counted, by the kernels of a
//! discrete query.

use super::discrete::lanes;
use super::exclude::exclude_triangles;
use super::{NarrowContext, growable};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Counter, DiscreteArgs, DiscreteFlags, Output, Pair, Span, counter};

/// The lists between the filters, and the count.
pub struct StartCheck {
    /// Pairs that each filter left to the next, the last one to exact signs.
    uncertain: Vec<List<Pair>>,
    /// Pairs that share a point. They are not listed.
    crossing: Counter,
    /// The same with those that are excluded, in a scene that excludes some.
    all: Option<List<Pair>>,
}

impl StartCheck {
    /// Allocates the lists for positions of this precision, with room for `few` uncertain pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<R: Precision>(device: &Device, few: usize) -> Result<Self, Error> {
        let list = |name, at, room| List::new(device, name, at, room);
        let mut uncertain = vec![list("pairs uncertain at the start", counter::UNCERTAIN, few)?];
        if R::WIDENS {
            let name = "pairs uncertain at the start in f64";
            uncertain.push(list(name, counter::UNCERTAIN_WIDE, few / 4)?);
        }
        Ok(StartCheck { uncertain, crossing: counter::STARTS_CROSSING, all: None })
    }

    /// Does not count pairs that are excluded; with room for `few` pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn exclude(&mut self, device: &Device, few: usize) -> Result<(), Error> {
        let name = "crossing pairs, with those excluded";
        self.all = Some(List::new(device, name, counter::ALL_CROSSING, few)?);
        Ok(())
    }

    /// Returns the lists that the step fills.
    pub fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let crossing = std::iter::once(&mut self.crossing as &mut dyn GrowableOutput);
        crossing.chain(growable(&mut self.all)).chain(growable(&mut self.uncertain)).collect()
    }

    /// Returns the pairs that each filter left to the next, with names.
    pub fn uncertain(&self) -> impl Iterator<Item = Named<'_>> {
        ["narrow: uncertain at the start", "narrow: uncertain at the start in f64"]
            .into_iter()
            .zip(&self.uncertain)
            .map(|(name, list)| named(name, list))
    }

    /// Launches the step over all candidates: filters with an error bound in f32 and in f64, and
    /// exact signs for the uncertain pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn run<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let crossing = given.counters.output(Span::EMPTY, self.crossing);
        let found = self.all.as_ref().map_or(crossing, |all| all.output(given.counters));
        let args = |pairs: Output<Pair>, uncertain: Option<&List<Pair>>| DiscreteArgs {
            frames: given.frames,
            faces: given.faces,
            pairs,
            contacts: found,
            uncertain: uncertain.map_or(Output::EMPTY, |list| list.output(given.counters)),
            flags: DiscreteFlags::NONE,
            pad: 0,
        };
        let (device, mut left) = (given.device, given.pairs);
        let mut room = left.room() as usize;
        for (at, list) in self.uncertain.iter().enumerate() {
            let args = args(left, Some(list));
            if at == 0 {
                launch::at_once::<R::StartFilter>(device, room, &args)
            } else {
                launch::at_once::<R::StartWide>(device, room, &args)
            }?;
            (left, room) = (list.output(given.counters), lanes(list));
        }
        launch::at_once::<R::StartExact>(device, room, &args(left, None))?;
        self.all.as_ref().map_or(Ok(()), |all| exclude_triangles(given, all, crossing))
    }
}
