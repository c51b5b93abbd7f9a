//! The contacts at the earliest time of a step.

use super::Detector;
use crate::contacts::{Answer, Contact, First, RowList};
use crate::error::Error;

impl Detector {
    /// Returns the contacts at the time of an earliest answer: the rows of the continuous query with
    /// the same options whose `toi` is that time, undecided ones included. Bodies must be in the
    /// answer's positions.
    ///
    /// Cost: a frame that leaves out pairs that begin later. With a minimum separation it tests
    /// all pairs, as a continuous query does.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Earliest, Mesh, device::Backend, mesh::Positions};
    ///
    /// // The second triangle falls through the first.
    /// let mesh = |z: f32| {
    ///     let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, z], [2.0, 1.0, z + 2.0], [1.0, 2.0, z + 2.0]];
    ///     Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])
    /// };
    /// let body = Body::moving(mesh(1.0)?, mesh(-1.0)?)?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, body)?;
    /// let first = detector.query(&Earliest::default())?;
    /// let contacts = detector.first_contacts(&first)?;
    /// assert_eq!((contacts[0].feature_a, contacts[0].feature_b), (3, 0));
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for an answer to another query, and if nothing begins at that time
    /// where the bodies are now. Others as of [`Detector::query`].
    pub fn first_contacts<T: First>(&mut self, first: &Answer<T>) -> Result<Answer<RowList<Contact>>, Error> {
        first.first_contacts(|query| self.query(query))
    }
}
