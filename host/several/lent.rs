//! Positions in the memory of one device, which all devices of a scene read.

use super::{MultiDetector, refused};
use crate::device::Buffer;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::purpose;
use crate::scene::{BodyId, DeviceRows, Motion};

/// Copies of other GPUs' memory on one, by their place in an update. Later updates use them again.
#[derive(Default)]
pub(super) struct Copies(Vec<Option<Buffer<u64>>>);

/// Motions as one device reads them.
type Motions<'a> = Vec<(BodyId, Motion<'a>)>;

impl MultiDetector {
    /// Returns the motions as each device reads them. Rows in the memory of another GPU are copied,
    /// after all work of that GPU's stream.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for rows in memory of no device of the detector, and if some
    /// devices are CPUs and some are GPUs; [`Error::Device`]; [`Error::OutOfMemory`].
    pub(super) fn lent<'a>(&mut self, motions: &[(BodyId, Motion<'a>)]) -> Result<Vec<Motions<'a>>, Error> {
        let is_lent = motions.iter().find(|(_, input)| matches!(input, Motion::OnDevice(_)));
        let gpus = self.parts.iter().filter(|part| part.device().is_gpu()).count();
        let (Some((first, _)), true) = (is_lent, gpus > 0) else {
            return Ok(vec![motions.to_vec(); self.parts.len()]);
        };
        if gpus < self.parts.len() {
            let what = format!("positions of body {first} in device memory, for a GPU and a CPU");
            return Err(refused(&what, "give positions in host memory, or leave the CPU out"));
        }
        let devices: Vec<Device> = self.parts.iter().map(|part| part.device().clone()).collect();
        // One of them has the rows; the others copy when it has written them.
        devices.iter().try_for_each(Device::wait)?;
        self.copies.resize_with(devices.len(), Copies::default);
        let each = devices.iter().zip(&mut self.copies);
        each.map(|(device, copies)| copies.motions(device, &devices, motions)).collect()
    }
}

impl Copies {
    /// Returns the motions as `device` reads them.
    fn motions<'a>(
        &mut self,
        device: &Device,
        devices: &[Device],
        motions: &[(BodyId, Motion<'a>)],
    ) -> Result<Motions<'a>, Error> {
        let mut at = 0;
        let mut lent = motions.to_vec();
        for (id, input) in &mut lent {
            if let Motion::OnDevice(motion) = input {
                for (rows, width) in motion.rows_mut() {
                    *rows = self.rows(at, *id, device, devices, (*rows, width))?;
                    at += 1;
                }
            }
        }
        Ok(lent)
    }

    /// Returns rows as `device` reads them: where they are, or in the copy with that index.
    fn rows(
        &mut self,
        at: usize,
        id: BodyId,
        device: &Device,
        devices: &[Device],
        (rows, width): (DeviceRows, usize),
    ) -> Result<DeviceRows, Error> {
        let bytes = rows.span(width);
        let owner = if bytes == 0 { None } else { device.gpu_of(rows.address())? };
        if owner.is_none() || owner == device.ordinal() {
            return Ok(rows);
        }
        let Some(owner) = devices.iter().find(|other| other.ordinal() == owner) else {
            let what = format!("positions of body {id} are in memory of GPU {}", owner.unwrap_or_default());
            return Err(refused(&what, "put them on a device of the detector"));
        };
        let words = bytes.div_ceil(size_of::<u64>());
        self.0.resize_with(self.0.len().max(at + 1), || None);
        // One that is too short is freed before another is made.
        let copy = match self.0[at].take().filter(|copy| copy.len() >= words) {
            Some(copy) => copy,
            None => device.of(purpose::COPIES).buffer(words)?,
        };
        let copy = self.0[at].insert(copy);
        // SAFETY: the maker of the rows promised that a device of the detector has them while work
        // may read them: the owner, as its driver says. All of its work was waited for.
        unsafe { device.copy_of_other(owner, rows.address(), bytes, copy) }?;
        Ok(rows.copied_to(copy.span().addr()))
    }
}
