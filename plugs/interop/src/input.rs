//! Bodies move to positions in arrays.

use crate::array::DeviceArray;
use crate::element::{Element, Shape, shape};
use nearmiss::scene::{BodyId, DeviceMotion, DeviceRows, Motion};
use nearmiss::{Detector, Device, Error};

/// Positions of a deformable body: an array, or one for each end of a step.
#[derive(Clone, Copy, Debug)]
pub enum Place<A> {
    /// The body stands at these positions.
    Positions(A),
    /// The body moves from the first positions to the second, each vertex in a straight line.
    Step([A; 2]),
}

impl<A> Place<A> {
    /// The same places, borrowed.
    pub fn as_ref(&self) -> Place<&A> {
        match self {
            Place::Positions(at) => Place::Positions(at),
            Place::Step([start, end]) => Place::Step([start, end]),
        }
    }

    /// The same places, borrowed to be written.
    pub fn as_mut(&mut self) -> Place<&mut A> {
        match self {
            Place::Positions(at) => Place::Positions(at),
            Place::Step([start, end]) => Place::Step([start, end]),
        }
    }

    /// The same places, with other arrays.
    pub fn map<B>(self, mut f: impl FnMut(A) -> B) -> Place<B> {
        match self {
            Place::Positions(at) => Place::Positions(f(at)),
            Place::Step(ends) => Place::Step(ends.map(f)),
        }
    }
}

/// Motion of a body in a frame: positions in arrays, or a [`Motion`] of nearmiss.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a, A> {
    /// A deformable body has its positions in arrays.
    Arrays(Place<&'a A>),
    /// Positions or poses of the host.
    Motion(Motion<'a>),
}

impl<'a, A> Input<'a, A> {
    /// A deformable body stands at these positions.
    pub fn positions(at: &'a A) -> Self {
        Input::Arrays(Place::Positions(at))
    }

    /// A deformable body moves from the first positions to the second, each vertex in a straight
    /// line.
    pub fn step(start: &'a A, end: &'a A) -> Self {
        Input::Arrays(Place::Step([start, end]))
    }
}

impl<'a, A> From<Motion<'a>> for Input<'a, A> {
    fn from(motion: Motion<'a>) -> Self {
        Input::Motion(motion)
    }
}

/// Moves bodies for the next queries, as [`Detector::update`] does. Positions in arrays do not pass
/// through the host. The call returns when the GPU has read the arrays.
///
/// All arrays of a call have one type.
///
/// # Errors
/// As of [`Detector::update`]. [`Error::InvalidArgument`]:
///
/// - for an array of single numbers that are not three for each vertex;
/// - for an array with another number of vertices than the body;
/// - if the detector's device was not made from the library's stream, or has another context than
///   the array;
/// - while the stream is captured.
pub fn update<A: DeviceArray>(
    detector: &mut Detector,
    inputs: &[(BodyId, Input<'_, A>)],
) -> Result<(), Error> {
    let device = detector.device().clone();
    let mut orders = Vec::new();
    let mut motions = Vec::with_capacity(inputs.len());
    for (id, input) in inputs {
        motions.push(match *input {
            Input::Arrays(place) => (*id, Motion::OnDevice(motion(place, &device, &mut orders)?)),
            Input::Motion(motion) => (*id, motion),
        });
    }
    let _settled = Settled(&device);
    detector.update(&motions)
}

/// Waits for the submitted work when it is dropped, also after a panic. Then no work reads arrays.
struct Settled<'a>(&'a Device);

impl Drop for Settled<'_> {
    fn drop(&mut self) {
        // A GPU that fails has ended its work; the next call reports the error.
        let _ = self.0.wait();
    }
}

/// The motion of a body for work of the device, which is submitted while the orders live.
pub(crate) fn motion<'a, A: DeviceArray>(
    place: Place<&'a A>,
    device: &'a Device,
    orders: &mut Vec<A::Order<'a>>,
) -> Result<DeviceMotion, Error> {
    let mut rows = |array: &'a A| {
        let Shape { rows, stride } = shape::<A::Element>(array.elements())?;
        let (address, order) = array.order(device)?;
        orders.push(order);
        // SAFETY: the array has these elements there (`Ordered`), of three numbers or more a row.
        // `update` borrows it until the work has settled. `Submissions` own it until then, and end
        // the preparation before they give it back.
        unsafe { DeviceRows::new(address, rows, stride, A::Element::NUMBER) }
    };
    Ok(match place {
        Place::Positions(at) => DeviceMotion::Positions(rows(at)?),
        Place::Step([start, end]) => DeviceMotion::Step([rows(start)?, rows(end)?]),
    })
}
