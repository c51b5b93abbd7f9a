//! The order of the GPU's work: a stream, and events in it.

use super::context::{Bound, Context};
use super::driver::{Refusal, answer};
use super::types::{self, CUevent, CUstream};
use std::ptr::null_mut;
use std::sync::Arc;

/// Work that the GPU does in order. It waits for no other stream's work.
pub struct Stream {
    context: Arc<Context>,
    handle: CUstream,
    /// Whether it is the caller's, who destroys it.
    is_borrowed: bool,
}

// SAFETY: the handle is the driver's. Any thread may call the driver's functions, also at the same
// time.
unsafe impl Send for Stream {}
// SAFETY: as above.
unsafe impl Sync for Stream {}

impl Stream {
    /// Makes a stream that does not wait for the default stream.
    pub fn new(context: &Arc<Context>) -> Result<Stream, Refusal> {
        let gpu = context.bind()?;
        let mut handle = null_mut();
        // SAFETY: the driver writes one handle, which is destroyed once.
        answer(unsafe { (gpu.cuStreamCreate)(&mut handle, types::CU_STREAM_NON_BLOCKING) })?;
        Ok(Stream { context: context.clone(), handle, is_borrowed: false })
    }

    /// A stream of the caller.
    ///
    /// # Safety
    /// It is a stream of the context, or null, and outlives this.
    pub unsafe fn borrow(context: &Arc<Context>, handle: CUstream) -> Stream {
        Stream { context: context.clone(), handle, is_borrowed: true }
    }

    /// Its handle.
    pub fn handle(&self) -> CUstream {
        self.handle
    }

    /// Whether it is the default stream, which cannot be captured.
    pub fn is_default(&self) -> bool {
        self.handle.is_null()
    }

    /// Whether our work can be captured here: it is not the default stream, and no capture is
    /// running.
    pub fn can_capture(&self, gpu: &Bound) -> Result<bool, Refusal> {
        if self.is_default() {
            return Ok(false);
        }
        let mut status = types::CU_STREAM_CAPTURE_STATUS_NONE;
        // SAFETY: the stream lives, and the driver writes one number.
        answer(unsafe { (gpu.cuStreamIsCapturing)(self.handle, &mut status) })?;
        Ok(status == types::CU_STREAM_CAPTURE_STATUS_NONE)
    }

    /// Waits for all work before.
    pub fn wait(&self, gpu: &Bound) -> Result<(), Refusal> {
        // SAFETY: the stream lives.
        answer(unsafe { (gpu.cuStreamSynchronize)(self.handle) })
    }

    /// Puts what follows here after an event of another stream; in a capture, too.
    pub fn follow(&self, gpu: &Bound, event: &Event) -> Result<(), Refusal> {
        // SAFETY: both live.
        answer(unsafe { (gpu.cuStreamWaitEvent)(self.handle, event.handle, types::CU_EVENT_WAIT_DEFAULT) })
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        if self.is_borrowed {
            return;
        }
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: made once, destroyed once. A refusal cannot be reported.
            let _ = unsafe { (gpu.cuStreamDestroy_v2)(self.handle) };
        }
    }
}

/// An event: a point in a stream.
pub struct Event {
    context: Arc<Context>,
    handle: CUevent,
}

// SAFETY: the handle is the driver's. Any thread may call the driver's functions, also at the same
// time.
unsafe impl Send for Event {}
// SAFETY: as above.
unsafe impl Sync for Event {}

impl Event {
    /// Makes an event that is not yet in a stream.
    pub fn new(context: &Arc<Context>, gpu: &Bound) -> Result<Event, Refusal> {
        let mut handle = null_mut();
        // SAFETY: the driver writes one handle, which is destroyed once.
        answer(unsafe { (gpu.cuEventCreate)(&mut handle, types::CU_EVENT_DEFAULT) })?;
        Ok(Event { context: context.clone(), handle })
    }

    /// Puts it after all work before.
    pub fn record(&self, gpu: &Bound, stream: &Stream) -> Result<(), Refusal> {
        self.record_as(gpu, stream, types::CU_EVENT_RECORD_DEFAULT)
    }

    /// The same in a stream that is being captured: the event is recorded at every launch of the
    /// graph.
    pub fn record_in_graph(&self, gpu: &Bound, stream: &Stream) -> Result<(), Refusal> {
        self.record_as(gpu, stream, types::CU_EVENT_RECORD_EXTERNAL)
    }

    fn record_as(&self, gpu: &Bound, stream: &Stream, flags: u32) -> Result<(), Refusal> {
        // SAFETY: both live.
        answer(unsafe { (gpu.cuEventRecordWithFlags)(self.handle, stream.handle, flags) })
    }

    /// Waits for it.
    pub fn wait(&self) -> Result<(), Refusal> {
        let gpu = self.context.bind()?;
        // SAFETY: the event lives.
        answer(unsafe { (gpu.cuEventSynchronize)(self.handle) })
    }

    /// Milliseconds to a later event that was waited for.
    pub fn to(&self, later: &Event) -> Result<f32, Refusal> {
        let gpu = self.context.bind()?;
        let mut ms = 0.0;
        // SAFETY: both live, and the driver writes one number.
        answer(unsafe { (gpu.cuEventElapsedTime)(&mut ms, self.handle, later.handle) })?;
        Ok(ms)
    }
}

impl Drop for Event {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: made once, destroyed once; the driver keeps it as long as the stream needs
            // it. A refusal cannot be reported.
            let _ = unsafe { (gpu.cuEventDestroy_v2)(self.handle) };
        }
    }
}

/// A second stream, for work at the same time as that of another.
pub struct Side {
    stream: Stream,
    /// The point at which the two part, or meet.
    event: Event,
    /// Whether the other stream has not met it since.
    is_away: bool,
    /// A point of the work here.
    flag: Event,
    /// Whether the other stream has not met that point.
    is_flagged: bool,
}

impl Side {
    /// Makes one.
    pub fn new(context: &Arc<Context>, gpu: &Bound) -> Result<Side, Refusal> {
        let [event, flag] = [Event::new(context, gpu)?, Event::new(context, gpu)?];
        Ok(Side { stream: Stream::new(context)?, event, is_away: false, flag, is_flagged: false })
    }

    /// The stream.
    pub fn stream(&self) -> &Stream {
        &self.stream
    }

    /// Puts what follows here after the work so far of the other.
    pub fn part(&mut self, gpu: &Bound, other: &Stream) -> Result<(), Refusal> {
        self.event.record(gpu, other)?;
        self.stream.follow(gpu, &self.event)?;
        self.is_away = true;
        Ok(())
    }

    /// Puts what follows in the other stream after all work here.
    pub fn meet(&mut self, gpu: &Bound, other: &Stream) -> Result<(), Refusal> {
        if self.is_away {
            self.event.record(gpu, &self.stream)?;
            other.follow(gpu, &self.event)?;
            (self.is_away, self.is_flagged) = (false, false);
        }
        Ok(())
    }

    /// Notes the end of the work so far here, unless the other stream has met it.
    pub fn flag(&mut self, gpu: &Bound) -> Result<(), Refusal> {
        if self.is_away {
            self.flag.record(gpu, &self.stream)?;
            self.is_flagged = true;
        }
        Ok(())
    }

    /// Puts what follows in the other stream after the work here before the last flag.
    pub fn meet_flag(&mut self, gpu: &Bound, other: &Stream) -> Result<(), Refusal> {
        if self.is_flagged {
            other.follow(gpu, &self.flag)?;
            self.is_flagged = false;
        }
        Ok(())
    }
}
