//! Positions in the memory of one device, which all devices of a scene read.

use super::{MultiDetector, refused};
use crate::device::Buffer;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::purpose;
use crate::scene::{BodyId, DeviceRows, Motion};
use std::collections::BTreeSet;

/// Copies of other GPUs' memory on one device. Later updates use their buffers again.
#[derive(Default)]
pub(super) struct Copies {
    buffers: Vec<Option<Buffer<u64>>>,
    /// Copies of the last update, one for each of the first buffers.
    transfers: Vec<Transfer>,
    /// Indices of devices on the same GPU, with streams of their own, whose memory it reads in place.
    in_place: BTreeSet<usize>,
}

/// A copy of another GPU's memory.
struct Transfer {
    /// Index of the device that has the memory.
    owner: usize,
    address: u64,
    bytes: usize,
}

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
        // Submissions read the same buffers.
        self.unprepare();
        let devices: Vec<Device> = self.parts.iter().map(|part| part.device().clone()).collect();
        // One of them has the rows; the others copy when it has written them.
        devices.iter().try_for_each(Device::wait)?;
        self.copies.resize_with(devices.len(), Copies::default);
        let each = devices.iter().zip(&mut self.copies);
        let read = |(device, copies): (&Device, &mut Copies)| {
            let lent = copies.motions(device, &devices, motions)?;
            copies.copy(device, &devices)?;
            Ok(lent)
        };
        each.map(read).collect()
    }

    /// Copies the memory of the last update again: after what its GPUs' streams did so far, and
    /// before what they do next. Devices that read in place come after that too. The host does not
    /// wait.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn copy_again(&mut self) -> Result<(), Error> {
        let devices: Vec<Device> = self.parts.iter().map(|part| part.device().clone()).collect();
        for (device, copies) in devices.iter().zip(&mut self.copies) {
            let owners: BTreeSet<usize> = copies.transfers.iter().map(|transfer| transfer.owner).collect();
            let all = owners.union(&copies.in_place);
            all.into_iter().try_for_each(|&owner| device.follow(&devices[owner]))?;
            copies.copy(device, &devices)?;
            owners.iter().try_for_each(|&owner| devices[owner].follow(device))?;
        }
        Ok(())
    }

    /// Puts what follows on the stream of each device whose memory another one reads in place after
    /// the submission of that one.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn wait_for_readers(&self) -> Result<(), Error> {
        for (part, copies) in self.parts.iter().zip(&self.copies) {
            let follow = |&owner: &usize| self.parts[owner].device().follow(part.device());
            copies.in_place.iter().try_for_each(follow)?;
        }
        Ok(())
    }
}

impl Copies {
    /// Forgets the memory of the last update: nothing copies it again.
    pub(super) fn forget(&mut self) {
        self.transfers.clear();
        self.in_place.clear();
    }

    /// Returns the motions as `device` reads them.
    fn motions<'a>(
        &mut self,
        device: &Device,
        devices: &[Device],
        motions: &[(BodyId, Motion<'a>)],
    ) -> Result<Motions<'a>, Error> {
        let mut lent = motions.to_vec();
        for (id, input) in &mut lent {
            if let Motion::OnDevice(motion) = input {
                for (rows, width) in motion.rows_mut() {
                    *rows = self.rows(*id, device, devices, (*rows, width))?;
                }
            }
        }
        Ok(lent)
    }

    /// Returns rows as `device` reads them: where they are, or in a buffer that gets a copy.
    fn rows(
        &mut self,
        id: BodyId,
        device: &Device,
        devices: &[Device],
        (rows, width): (DeviceRows, usize),
    ) -> Result<DeviceRows, Error> {
        let bytes = rows.span(width);
        let owner = if bytes == 0 { None } else { device.gpu_of(rows.address())? };
        let Some(gpu) = owner else { return Ok(rows) };
        let Some(at) = devices.iter().position(|other| other.ordinal() == owner) else {
            let what = format!("positions of body {id} are in memory of GPU {gpu}");
            return Err(refused(&what, "put them on a device of the detector"));
        };
        if owner == device.ordinal() {
            if !devices[at].is(device) {
                self.in_place.insert(at);
            }
            return Ok(rows);
        }
        let (words, place) = (bytes.div_ceil(size_of::<u64>()), self.transfers.len());
        self.transfers.push(Transfer { owner: at, address: rows.address(), bytes });
        self.buffers.resize_with(self.buffers.len().max(place + 1), || None);
        // One that is too short is freed before another is made.
        let buffer = match self.buffers[place].take().filter(|buffer| buffer.len() >= words) {
            Some(buffer) => buffer,
            None => device.of(purpose::COPIES).buffer(words)?,
        };
        Ok(rows.copied_to(self.buffers[place].insert(buffer).span().addr()))
    }

    /// Copies other GPUs' memory, on the stream of `device`. The owners have written it before.
    fn copy(&mut self, device: &Device, devices: &[Device]) -> Result<(), Error> {
        for (transfer, buffer) in self.transfers.iter().zip(self.buffers.iter_mut().flatten()) {
            let owner = &devices[transfer.owner];
            // SAFETY: the maker of the rows promised that a device of the detector has them while
            // work may read them: the owner, as its driver says. All work that wrote them was
            // waited for, by the host or by the stream of the copy.
            unsafe { device.copy_of_other(owner, transfer.address, transfer.bytes, buffer) }?;
        }
        Ok(())
    }
}
