//! Arrays of other libraries.

use crate::element::Element;
use nearmiss::{Device, Error};

pub(crate) mod sealed {
    #[cfg(doc)]
    use super::DeviceArray;
    use super::{Device, Error};

    /// An array that work of a device reads in order.
    ///
    /// # Safety
    /// At the address of `order` are as many elements as [`DeviceArray::elements`] reports, in
    /// memory that this device can read. They stay there until the array is dropped.
    pub unsafe trait Ordered {
        /// Lives from before the work that reads the array until that work has been submitted.
        type Order<'a>
        where
            Self: 'a;

        /// Puts work of the device after earlier writes of the array. Returns the array's address.
        ///
        /// # Errors
        /// [`Error::InvalidArgument`] for an array or a device of another context or library.
        fn order<'a>(&'a self, device: &'a Device) -> Result<(u64, Self::Order<'a>), Error>;
    }
}

/// An array of positions in the memory of a GPU: a `CudaSlice` or `CudaView` of cudarc, a
/// `DeviceBuffer` of cust.
pub trait DeviceArray: sealed::Ordered {
    /// Type of the elements.
    type Element: Element;
    /// Number of elements.
    fn elements(&self) -> usize;
}

/// An array that owns its memory: all of [`DeviceArray`] except `CudaView`.
pub trait OwnedArray: DeviceArray {
    /// A borrow that kernels write through, and that cannot free or replace the array.
    type View<'a>
    where
        Self: 'a;
    /// Borrows the array.
    fn view(&mut self) -> Self::View<'_>;
}
