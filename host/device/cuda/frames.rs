//! Frames: lists of launches, in a stream or as a graph.

use super::context::Bound;
use super::driver::{Refusal, refused};
use super::graph::Graph;
use super::stream::Stream;
use super::{Cuda, Event, locked, memory, types};
use crate::device::replay::{Act, Listing};
use crate::error::Error;

impl Cuda {
    /// Whether our work can be recorded as a graph.
    pub fn can_record(&self) -> Result<bool, Error> {
        self.stream.can_capture(&self.bind()?).map_err(refused("querying a stream"))
    }

    /// Executes a list.
    ///
    /// # Safety
    /// The listed launches are of our kernels, which are loaded, with their arguments. The memory
    /// that these name lives until the launches end.
    pub unsafe fn perform(&self, list: &Listing, marks: &[&Event]) -> Result<(), Error> {
        self.changes();
        let gpu = self.bind()?;
        let pass = |which: usize| marks[which].0.record(&gpu, &self.stream);
        // SAFETY: the caller's promise.
        unsafe { self.put((&gpu, &self.stream), list, pass) }.map_err(refused("launching a frame"))
    }

    /// Records a list as a graph.
    ///
    /// # Safety
    /// As for [`Cuda::perform`], whenever the graph is launched. The marks live as long as the
    /// graph.
    pub unsafe fn record(&self, list: &Listing, marks: &[&Event]) -> Result<Graph, Error> {
        let gpu = self.bind()?;
        let stream = locked(&self.recorder);
        let pass = |which: usize| marks[which].0.record_in_graph(&gpu, &stream);
        // SAFETY: the caller's promise; the stream is locked.
        let graph =
            unsafe { Graph::new(&self.context, &gpu, &stream, || self.put((&gpu, &stream), list, pass)) };
        graph.map_err(refused("making a graph of a frame"))
    }

    /// Launches a graph.
    pub fn replay(&self, graph: &Graph) -> Result<(), Error> {
        self.changes();
        graph.launch(&self.bind()?, &self.stream).map_err(refused("launching a frame"))
    }

    /// Puts a list in a stream.
    ///
    /// # Safety
    /// As for [`Cuda::perform`].
    unsafe fn put(
        &self,
        (gpu, stream): (&Bound, &Stream),
        list: &Listing,
        mut pass: impl FnMut(usize) -> Result<(), Refusal>,
    ) -> Result<(), Refusal> {
        let (functions, mut side) = (locked(&self.functions), locked(&self.side));
        let mut is_aside = false;
        let done = list.acts().try_for_each(|(act, args)| {
            let own = if is_aside { side.stream() } else { stream };
            match act {
                Act::Launch { kernel, grid, .. } => {
                    let function = functions.get(kernel).ok_or(Refusal(types::CUDA_ERROR_NOT_FOUND))?;
                    // SAFETY: the caller's promise.
                    unsafe { function.launch(gpu, own, grid, args) }
                }
                Act::Fill { bytes: 0, .. } => Ok(()),
                Act::Fill { addr, bytes, byte } => {
                    // SAFETY: the caller's promise.
                    unsafe { memory::fill(gpu, own, addr, bytes, byte) }
                }
                Act::Mark(which) => pass(which),
                Act::Aside => {
                    is_aside = true;
                    side.part(gpu, stream)
                }
                Act::Back => {
                    is_aside = false;
                    Ok(())
                }
                Act::Join => side.meet(gpu, stream),
                Act::Flag => side.flag(gpu),
                Act::JoinFlag => side.meet_flag(gpu, stream),
            }
        });
        // Also after a refusal: nothing is freed before what was launched has ended.
        let met = side.meet(gpu, stream);
        done.and(met)
    }
}
