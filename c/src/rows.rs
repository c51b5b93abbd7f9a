//! Numbers of the caller, in memory of the host or of the device.

use crate::error::refused;
use nearmiss::Error;
use nearmiss::mesh::Positions;
use nearmiss::scene::{DeviceRows, Number};
use std::ffi::{CStr, c_char, c_void};

/// The kind of numbers that lie in a memory.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissNumber {
    /// Single precision.
    NEARMISS_F32 = 0,
    /// Double precision. Never rounded to singles.
    NEARMISS_F64 = 1,
}

/// Rows of numbers, one behind the other: positions, three numbers a row. What lies between the rows is not read.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissRows {
    /// The first number; of memory of a device its address there. NULL where there are no rows.
    pub data: *const c_void,
    /// How many rows.
    pub count: usize,
    /// Bytes from a row to the next, a multiple of the number's size and no less than a row has. 0 for rows without a gap.
    pub stride: usize,
    /// `NEARMISS_F32` or `NEARMISS_F64`.
    pub number: u32,
}

/// `count` points of three floats, without gaps.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_floats(points: *const f32, count: usize) -> NearmissRows {
    NearmissRows { data: points.cast(), count, stride: 0, number: NearmissNumber::NEARMISS_F32 as u32 }
}

/// `count` points of three doubles, without gaps.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_doubles(points: *const f64, count: usize) -> NearmissRows {
    NearmissRows { data: points.cast(), count, stride: 0, number: NearmissNumber::NEARMISS_F64 as u32 }
}

impl NearmissRows {
    fn number(&self, what: &str) -> Result<Number, Error> {
        match self.number {
            0 => Ok(Number::F32),
            1 => Ok(Number::F64),
            other => Err(refused(
                format!("numbers of kind {other} for {what}"),
                "give NEARMISS_F32 or NEARMISS_F64",
            )),
        }
    }

    /// Positions, copied from the host's memory.
    ///
    /// # Safety
    /// Behind a `data` that is not NULL lie three numbers a row for `count` rows.
    pub(crate) unsafe fn positions(&self, what: &str) -> Result<Positions, Error> {
        let number = self.number(what)?;
        let size = number.bytes();
        let stride = if self.stride == 0 { 3 * size } else { self.stride };
        if stride < 3 * size || !stride.is_multiple_of(size) {
            return Err(refused(
                format!("{what} {stride} bytes apart"),
                format!("give a multiple of {size} bytes, at least {}, or 0 for no gaps", 3 * size),
            ));
        }
        if self.count == 0 {
            return Ok(if number == Number::F32 {
                Positions::F32(Vec::new())
            } else {
                Positions::F64(Vec::new())
            });
        }
        let bytes = stride.checked_mul(self.count).filter(|bytes| *bytes <= isize::MAX as usize);
        if bytes.is_none() {
            return Err(refused(format!("{} rows for {what}", self.count), "give as many as there are"));
        }
        if self.data.is_null() || !self.data.addr().is_multiple_of(size) {
            let told = if self.data.is_null() { "NULL" } else { "a pointer between two numbers" };
            return Err(refused(format!("{told} for {what}"), "give a pointer to the first number"));
        }
        nearmiss::memory::require("positions", (self.count * 3 * size) as u64)?;
        // SAFETY: the caller's promise; not NULL, aligned, and no row is beyond what may be reached.
        Ok(unsafe {
            match number {
                Number::F32 => Positions::F32(read(self.data.cast(), self.count, stride / size)),
                Number::F64 => Positions::F64(read(self.data.cast(), self.count, stride / size)),
            }
        })
    }

    /// Rows in the device's memory, of that many numbers each.
    ///
    /// # Safety
    /// As of [`DeviceRows::new`].
    pub(crate) unsafe fn on_device(&self, what: &str, width: usize) -> Result<DeviceRows, Error> {
        let number = self.number(what)?;
        if self.data.is_null() && self.count > 0 {
            return Err(refused(format!("NULL for {what}"), "give the address of the first number"));
        }
        let row = width * number.bytes();
        let stride = if self.stride == 0 { row } else { self.stride };
        if stride < row {
            return Err(refused(
                format!("{what} {stride} bytes apart"),
                format!("give at least {row}, or 0 for no gaps"),
            ));
        }
        // SAFETY: the caller's promise.
        unsafe { DeviceRows::new(self.data.addr() as u64, self.count, stride, number) }
    }
}

/// Rows of three, `stride` numbers apart.
///
/// # Safety
/// All that lies there, aligned.
unsafe fn read<T: Copy>(from: *const T, count: usize, stride: usize) -> Vec<[T; 3]> {
    // SAFETY: the caller's promise. An array has the alignment of its elements.
    (0..count).map(|row| unsafe { from.add(row * stride).cast::<[T; 3]>().read() }).collect()
}

/// So many items of the caller.
///
/// # Safety
/// They lie behind a pointer that is not NULL, and nobody writes them while the slice lives.
pub(crate) unsafe fn items<'a, T>(from: *const T, count: usize, what: &str) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]);
    }
    if from.is_null() || !from.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) {
        let told = if from.is_null() { "NULL" } else { "a pointer or a count that cannot be" };
        return Err(refused(format!("{told} for {count} {what}"), "give a pointer to the first of them"));
    }
    // SAFETY: the caller's promise; not NULL, aligned, of a possible size.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// A text of the caller, if there is one; what is not UTF-8 is replaced.
///
/// # Safety
/// A pointer that is not NULL points to a text that ends with a zero.
pub(crate) unsafe fn text(from: *const c_char) -> Option<String> {
    // SAFETY: the caller's promise.
    (!from.is_null()).then(|| unsafe { CStr::from_ptr(from) }.to_string_lossy().into_owned())
}
