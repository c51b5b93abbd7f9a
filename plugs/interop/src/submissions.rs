//! Frames for which the host does not wait.

use crate::array::OwnedArray;
use crate::input::{Place, motion};
use nearmiss::contacts::Answer;
use nearmiss::query::TypedQuery;
use nearmiss::scene::{BodyId, DeviceMotion};
use nearmiss::{Detector, Device, Error, Query};

/// Arrays of deformable bodies.
pub type Places<A> = Vec<(BodyId, Place<A>)>;

/// A detector, and the arrays that its submitted frames read.
///
/// A frame reads the arrays after the call that submits it. So this value owns detector and arrays.
/// Kernels write new positions through [`views`](Submissions::views), and
/// [`into_parts`](Submissions::into_parts) gives both back. A value that is leaked leaks both.
///
/// 1. [`prepare`](Submissions::prepare) runs frames until all buffers are large enough.
/// 2. Kernels write positions, and [`submit`](Submissions::submit) launches the queries behind them.
/// 3. [`collect`](Submissions::collect) copies an answer to the host. If a buffer was too short, the
///    answer is complete, and the next frame needs step 1 again.
pub struct Submissions<A: OwnedArray> {
    /// Dropped before the arrays.
    detector: Detector,
    arrays: Arrays<A>,
}

/// Arrays, dropped when the device has read them.
struct Arrays<A: OwnedArray> {
    device: Device,
    places: Places<A>,
}

impl<A: OwnedArray> Drop for Arrays<A> {
    fn drop(&mut self) {
        if self.device.wait().is_err() {
            // Work may still read them, as while the stream is captured: they are leaked.
            std::mem::take(&mut self.places).into_iter().for_each(std::mem::forget);
        }
    }
}

impl<A: OwnedArray> Arrays<A> {
    /// Calls `submit` with the motions of all bodies, between the orders of all arrays.
    fn ordered<T>(
        &self,
        submit: impl FnOnce(&[(BodyId, DeviceMotion)]) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let mut orders = Vec::new();
        let motions = self.places.iter();
        let motions =
            motions.map(|(id, place)| Ok((*id, motion(place.as_ref(), &self.device, &mut orders)?)));
        let motions = motions.collect::<Result<Vec<_>, Error>>()?;
        submit(&motions)
    }
}

impl<A: OwnedArray> Submissions<A> {
    /// Takes a detector and the arrays of its deformable bodies. Bodies without arrays rest. Arrays
    /// are checked by [`prepare`](Submissions::prepare).
    pub fn new(detector: Detector, arrays: Places<A>) -> Self {
        let device = detector.device().clone();
        Submissions { detector, arrays: Arrays { device, places: arrays } }
    }

    /// Prepares submissions of these queries, at the positions that the arrays have now: see
    /// [`Detector::prepare`].
    ///
    /// # Errors
    /// As of [`Detector::prepare`], and for arrays as of [`update`](crate::update).
    pub fn prepare(&mut self, queries: &[Query]) -> Result<(), Error> {
        let detector = &mut self.detector;
        self.arrays.ordered(|motions| detector.prepare(motions, queries))
    }

    /// Submits the prepared queries: see [`Detector::submit`]. They read the arrays after the
    /// earlier work of the stream. The host does not wait.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if nothing is prepared, and while the stream is captured; those of
    /// the device.
    pub fn submit(&mut self) -> Result<(), Error> {
        let detector = &mut self.detector;
        self.arrays.ordered(|_| detector.submit())
    }

    /// Waits for the last submission, and returns the answer to one of its queries: see
    /// [`Detector::collect`].
    ///
    /// # Errors
    /// As of [`Detector::collect`].
    pub fn collect<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        self.detector.collect(query)
    }

    /// Borrows the arrays for kernels, by body.
    pub fn views(&mut self) -> Places<A::View<'_>> {
        self.arrays.places.iter_mut().map(|(id, place)| (*id, place.as_mut().map(A::view))).collect()
    }

    /// The detector, for [`Detector::is_prepared`] and [`Detector::on_device`].
    pub fn detector(&self) -> &Detector {
        &self.detector
    }

    /// Ends the preparation, waits for the submitted frames, and gives back the detector and the
    /// arrays.
    ///
    /// # Errors
    /// Those of the device. The arrays are leaked then: work may still read them.
    pub fn into_parts(self) -> Result<(Detector, Places<A>), Error> {
        let Submissions { mut detector, mut arrays } = self;
        detector.unprepare();
        arrays.device.wait()?;
        Ok((detector, std::mem::take(&mut arrays.places)))
    }
}
