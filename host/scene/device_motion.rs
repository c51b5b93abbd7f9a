//! Positions and poses in device memory.

use super::Pose;
use crate::error::Error;
use crate::mesh::Positions;
use nearmiss_kernels::abi::Lent;

/// Precision of numbers in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Number {
    /// Bytes of one number.
    pub const fn bytes(self) -> usize {
        match self {
            Number::F32 => 4,
            Number::F64 => 8,
        }
    }
}

/// Rows of numbers in device memory that the caller owns. Positions have three numbers a row; a
/// pose has one row each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceRows {
    address: u64,
    rows: usize,
    stride: usize,
    number: Number,
}

impl DeviceRows {
    /// Describes rows: the first one at `address`, each `stride` bytes after the one before. On a
    /// CPU the address is the host's.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for an address or a stride that is no multiple of the number's
    /// size. Also for rows that end beyond 2^32 numbers.
    ///
    /// # Safety
    /// At `address` and after each stride there are three numbers of that kind (four for a
    /// rotation). The detector's device can read that memory. It stays there, and is not written
    /// while work of the detector may read it. A call may read it until its work is done. A
    /// prepared frame may read it in every submission, until another input or the end of the
    /// detector.
    pub unsafe fn new(address: u64, rows: usize, stride: usize, number: Number) -> Result<DeviceRows, Error> {
        let size = number.bytes();
        let refused =
            |what: String, advice: &str| Err(Error::InvalidArgument { what, advice: advice.to_owned() });
        if !address.is_multiple_of(size as u64) || !stride.is_multiple_of(size) {
            let what =
                format!("rows of {size} byte numbers at {address:#x}, {stride} bytes apart, are not aligned");
            return refused(what, "give an address and a stride that are multiples of the number's size");
        }
        let last = rows.saturating_sub(1).checked_mul(stride / size).and_then(|at| at.checked_add(4));
        if last.is_none_or(|end| end > u32::MAX as usize) {
            let what = format!("{rows} rows, {stride} bytes apart, span more than 2^32 numbers");
            return refused(what, "pack the rows closer");
        }
        Ok(DeviceRows { address, rows, stride, number })
    }

    /// Address of the first row.
    pub(crate) fn address(&self) -> u64 {
        self.address
    }

    /// Bytes from the first number to the last, of rows of `width` numbers; 0 without rows.
    pub(crate) fn span(&self, width: usize) -> usize {
        self.rows.checked_sub(1).map_or(0, |last| last * self.stride + width * self.number.bytes())
    }

    /// The same rows, copied to another address.
    pub(crate) fn copied_to(self, address: u64) -> DeviceRows {
        DeviceRows { address, ..self }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// One of the rows; it exists, or the address is never read.
    pub(crate) fn row(&self, row: usize) -> DeviceRows {
        DeviceRows { address: self.address + (row * self.stride) as u64, rows: 1, ..*self }
    }

    /// Precision of its numbers.
    pub fn number(&self) -> Number {
        self.number
    }

    /// Reads rows of `N` numbers.
    ///
    /// # Safety
    /// As of [`DeviceRows::new`], for memory that the host can read.
    unsafe fn read<const N: usize, T: bytemuck::Pod>(&self) -> Vec<[T; N]> {
        let row = |row: usize| {
            let start = (self.address as usize + row * self.stride) as *const T;
            // SAFETY: the caller's promise: there are N numbers, at a multiple of their size.
            std::array::from_fn(|k| unsafe { start.add(k).read() })
        };
        (0..self.rows).map(row).collect()
    }

    /// Reads three numbers a row.
    ///
    /// # Safety
    /// As of [`DeviceRows::read`].
    unsafe fn positions(&self) -> Positions {
        // SAFETY: the caller's promise.
        unsafe {
            match self.number {
                Number::F32 => Positions::F32(self.read()),
                Number::F64 => Positions::F64(self.read()),
            }
        }
    }

    /// Reads `N` numbers of the first row; zeros if there is none.
    ///
    /// # Safety
    /// As of [`DeviceRows::read`].
    unsafe fn first<const N: usize>(&self) -> [f64; N] {
        let first = DeviceRows { rows: self.rows.min(1), ..*self };
        // SAFETY: the caller's promise.
        let doubles: Vec<[f64; N]> = unsafe {
            match self.number {
                Number::F32 => first.read::<N, f32>().into_iter().map(|row| row.map(f64::from)).collect(),
                Number::F64 => first.read(),
            }
        };
        doubles.first().copied().unwrap_or([0.0; N])
    }

    /// Record for kernels, with `width` numbers a row.
    pub(crate) fn record(&self, width: u32) -> Lent {
        // Checked by `DeviceRows::new`.
        let stride = (self.stride / self.number.bytes()) as u32;
        Lent {
            address: self.address,
            numbers: self.rows.saturating_sub(1) as u32 * stride + width,
            stride,
            is_f64: u32::from(self.number == Number::F64),
            pad: 0,
        }
    }
}

/// A pose in device memory: see [`Pose`](super::Pose).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DevicePose {
    /// One row: the translation.
    pub translation: DeviceRows,
    /// One row: a unit quaternion x, y, z, w. It may be off unit length by at most 1.19e-4 and is
    /// normalised, as [`Pose::rotation`](super::Pose::rotation).
    pub rotation: DeviceRows,
}

impl DevicePose {
    fn rows_mut(&mut self) -> [(&mut DeviceRows, usize); 2] {
        [(&mut self.translation, 3), (&mut self.rotation, 4)]
    }
}

/// Motion of a body in device memory. It does not pass through the host. The device's stream reads
/// it, after all work that was put there before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceMotion {
    /// A deformable body stands at these positions.
    Positions(DeviceRows),
    /// A deformable body moves from the first positions to the second, each vertex in a straight
    /// line.
    Step([DeviceRows; 2]),
    /// A rigid body stands in this pose.
    Pose(DevicePose),
    /// A rigid body moves from the first pose to the second. It turns by the shorter arc, about the
    /// origin of its mesh.
    PoseStep([DevicePose; 2]),
}

impl DeviceMotion {
    /// Whether it has two ends.
    pub(crate) fn is_moving(&self) -> bool {
        matches!(self, DeviceMotion::Step(_) | DeviceMotion::PoseStep(_))
    }

    /// All of its rows, with the numbers a row.
    pub(crate) fn rows_mut(&mut self) -> Vec<(&mut DeviceRows, usize)> {
        match self {
            DeviceMotion::Positions(rows) => vec![(rows, 3)],
            DeviceMotion::Step(both) => both.iter_mut().map(|rows| (rows, 3)).collect(),
            DeviceMotion::Pose(one) => one.rows_mut().into(),
            DeviceMotion::PoseStep(both) => both.iter_mut().flat_map(DevicePose::rows_mut).collect(),
        }
    }

    /// Whether any of its positions are in f64.
    pub(crate) fn has_f64(&self) -> bool {
        match self {
            DeviceMotion::Positions(rows) => rows.number == Number::F64,
            DeviceMotion::Step(ends) => ends.iter().any(|rows| rows.number == Number::F64),
            DeviceMotion::Pose(_) | DeviceMotion::PoseStep(_) => false,
        }
    }

    /// Reads positions of a deformable body, or poses of a rigid one, on the host: both ends or
    /// one.
    ///
    /// # Safety
    /// As of [`DeviceRows::new`], for memory that the host can read: a CPU's.
    pub(crate) unsafe fn read(&self) -> (Vec<Positions>, Vec<Pose>) {
        // SAFETY: the caller's promise.
        let ends = |rows: &[DeviceRows]| rows.iter().map(|rows| unsafe { rows.positions() }).collect();
        // SAFETY: the caller's promise.
        let pose = |pose: &DevicePose| unsafe {
            Pose { rotation: pose.rotation.first(), translation: pose.translation.first() }
        };
        match self {
            DeviceMotion::Positions(rows) => (ends(std::slice::from_ref(rows)), Vec::new()),
            DeviceMotion::Step(both) => (ends(both), Vec::new()),
            DeviceMotion::Pose(one) => (Vec::new(), vec![pose(one)]),
            DeviceMotion::PoseStep(both) => (Vec::new(), both.iter().map(pose).collect()),
        }
    }

    /// Records for kernels, at both ends or at the only one: one an end for positions, two for
    /// poses.
    pub(crate) fn records(&self, ends: usize) -> Vec<Lent> {
        let pose = |pose: &DevicePose| [pose.translation.record(3), pose.rotation.record(4)];
        match self {
            DeviceMotion::Positions(rows) => vec![rows.record(3); ends],
            DeviceMotion::Step(both) => both[..ends].iter().map(|rows| rows.record(3)).collect(),
            DeviceMotion::Pose(one) => [pose(one)].repeat(ends).concat(),
            DeviceMotion::PoseStep(both) => both[..ends].iter().flat_map(pose).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(address: u64, rows: usize, stride: usize, number: Number) -> Result<DeviceRows, Error> {
        // SAFETY: nothing reads them.
        unsafe { DeviceRows::new(address, rows, stride, number) }
    }

    #[test]
    fn rows_that_no_kernel_can_read_are_refused() {
        assert!(rows(64, 10, 12, Number::F32).is_ok_and(|rows| rows.len() == 10 && !rows.is_empty()));
        for wrong in [
            rows(62, 10, 12, Number::F32),
            rows(64, 10, 10, Number::F32),
            rows(68, 10, 24, Number::F64),
            rows(64, 10, 28, Number::F64),
            rows(64, 1 << 30, 16, Number::F32),
            rows(64, usize::MAX, 16, Number::F32),
        ] {
            let error = wrong.expect_err("refused");
            assert!(matches!(error, Error::InvalidArgument { .. }), "{error}");
        }
    }

    #[test]
    fn records_say_where_and_how_far() {
        let at = rows(64, 5, 32, Number::F64).expect("rows");
        let record = Lent { address: 64, numbers: 19, stride: 4, is_f64: 1, pad: 0 };
        assert_eq!(DeviceMotion::Positions(at).records(2), [record, record]);
        assert!(DeviceMotion::Positions(at).has_f64() && !DeviceMotion::Positions(at).is_moving());
        assert_eq!((at.span(3), at.span(4), at.address()), (4 * 32 + 24, 4 * 32 + 32, 64));
        let none = rows(64, 0, 32, Number::F32).expect("no rows");
        assert_eq!(none.span(3), 0);
        assert_eq!(none.record(3).numbers, 3);
        let [translation, rotation] = [1024, 2048].map(|at| rows(at, 1, 0, Number::F32).expect("a row"));
        let pose = DeviceMotion::PoseStep([DevicePose { translation, rotation }; 2]);
        let mut other = pose;
        for (rows, width) in other.rows_mut() {
            *rows = rows.copied_to(rows.address() + width as u64);
        }
        let addresses =
            |motion: &DeviceMotion| motion.records(2).iter().map(|r| r.address).collect::<Vec<_>>();
        assert_eq!(addresses(&other), [1027, 2052, 1027, 2052]);
        assert_eq!(
            pose.records(2).iter().map(|r| (r.address, r.numbers)).collect::<Vec<_>>(),
            [(1024, 3), (2048, 4), (1024, 3), (2048, 4)]
        );
    }
}
