//! Graphs: work that the driver records once and launches often.

use super::context::{Bound, Context};
use super::driver::{Refusal, answer};
use super::stream::Stream;
use super::types::{self, CUgraphExec};
use std::ptr::null_mut;
use std::sync::Arc;

/// A graph of the driver, ready to be launched.
pub struct Graph {
    context: Arc<Context>,
    handle: CUgraphExec,
}

// SAFETY: the handle is the driver's. The holder of its detector launches the graph through
// `&self`, one launch at a time.
unsafe impl Send for Graph {}
// SAFETY: as above; the driver orders launches of one graph.
unsafe impl Sync for Graph {}

impl Graph {
    /// Records `work` from a stream of its own, which nothing else uses meanwhile.
    ///
    /// # Safety
    /// `work` only puts launches, fills and marks in the stream. Their memory and events live
    /// whenever the graph is launched.
    pub unsafe fn new(
        context: &Arc<Context>,
        gpu: &Bound,
        stream: &Stream,
        work: impl FnOnce() -> Result<(), Refusal>,
    ) -> Result<Graph, Refusal> {
        // SAFETY: the stream lives. In this mode, calls of other threads that a capture forbids are
        // not refused.
        answer(unsafe {
            (gpu.cuStreamBeginCapture_v2)(stream.handle(), types::CU_STREAM_CAPTURE_MODE_THREAD_LOCAL)
        })?;
        let done = work();
        let mut graph = null_mut();
        // SAFETY: the stream is being captured. The driver writes one handle, null if it refuses,
        // which is destroyed once.
        let ended = answer(unsafe { (gpu.cuStreamEndCapture)(stream.handle(), &mut graph) });
        let mut handle = null_mut();
        let made = done.and(ended).and_then(|()| {
            // SAFETY: the graph was just made; the driver writes one handle, which is destroyed once.
            answer(unsafe { (gpu.cuGraphInstantiateWithFlags)(&mut handle, graph, 0) })
        });
        if !graph.is_null() {
            // SAFETY: made once, destroyed once; its instance stays. A refusal cannot be reported.
            let _ = unsafe { (gpu.cuGraphDestroy)(graph) };
        }
        made.map(|()| Graph { context: context.clone(), handle })
    }

    /// Launches it, after all work before.
    pub fn launch(&self, gpu: &Bound, stream: &Stream) -> Result<(), Refusal> {
        // SAFETY: both live; the caller of `new` promised that the graph's memory does.
        answer(unsafe { (gpu.cuGraphLaunch)(self.handle, stream.handle()) })
    }
}

impl Drop for Graph {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: made once, destroyed once; the driver keeps it during a launch. A refusal
            // cannot be reported.
            let _ = unsafe { (gpu.cuGraphExecDestroy)(self.handle) };
        }
    }
}
