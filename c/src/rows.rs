//! Arrays of the caller, in memory of the host or of the device.

use crate::error::refused;
use nearmiss::Error;
use nearmiss::mesh::{Points, Positions};
use nearmiss::scene::{DeviceRows, Number};
use std::ffi::{CStr, c_char, c_void};

/// Types of numbers.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissNumber {
    /// Single precision.
    NEARMISS_F32 = 0,
    /// Double precision, never rounded to single.
    NEARMISS_F64 = 1,
}

/// Rows of numbers, such as positions of three numbers a row. Gaps between rows are not read.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissRows {
    /// The first number, aligned; of memory of a device its address there. NULL for no rows.
    pub data: *const c_void,
    /// Number of rows.
    pub count: usize,
    /// Bytes from one row to the next: a multiple of the number's size, at least a row. 0 for rows
    /// without gaps.
    pub stride: usize,
    /// `NEARMISS_F32` or `NEARMISS_F64`.
    pub number: u32,
}

/// `count` rows of floats without gaps: points of three, or quaternions of four.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_floats(points: *const f32, count: usize) -> NearmissRows {
    NearmissRows { data: points.cast(), count, stride: 0, number: NearmissNumber::NEARMISS_F32 as u32 }
}

/// `count` rows of doubles without gaps: points of three, or quaternions of four.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_doubles(points: *const f64, count: usize) -> NearmissRows {
    NearmissRows { data: points.cast(), count, stride: 0, number: NearmissNumber::NEARMISS_F64 as u32 }
}

/// Points in memory of the host: the caller's own if they have no gaps, else a copy.
pub(crate) enum HostPoints<'a> {
    Borrowed(Points<'a>),
    Copied(Positions),
}

impl HostPoints<'_> {
    pub(crate) fn points(&self) -> Points<'_> {
        match self {
            HostPoints::Borrowed(points) => *points,
            HostPoints::Copied(positions) => positions.into(),
        }
    }

    /// A copy that needs the caller's memory no longer.
    pub(crate) fn positions(self) -> Result<Positions, Error> {
        let require = |bytes: usize| nearmiss::memory::require("positions", bytes as u64);
        Ok(match self {
            HostPoints::Borrowed(Points::F32(points)) => {
                require(size_of_val(points))?;
                Positions::F32(points.to_vec())
            }
            HostPoints::Borrowed(Points::F64(points)) => {
                require(size_of_val(points))?;
                Positions::F64(points.to_vec())
            }
            HostPoints::Copied(positions) => positions,
        })
    }
}

impl NearmissRows {
    fn number(&self, name: &str) -> Result<Number, Error> {
        match self.number {
            0 => Ok(Number::F32),
            1 => Ok(Number::F64),
            other => Err(refused(
                format!("type of the numbers of {name} is unknown, got {other}"),
                "choose NEARMISS_F32 or NEARMISS_F64",
            )),
        }
    }

    /// Points in memory of the host.
    ///
    /// # Safety
    /// Behind a `data` that is not NULL are `count` rows of three numbers that are not written
    /// while the points live.
    pub(crate) unsafe fn points<'a>(&self, name: &str) -> Result<HostPoints<'a>, Error> {
        let number = self.number(name)?;
        let size = number.bytes();
        let stride = if self.stride == 0 { 3 * size } else { self.stride };
        if stride < 3 * size || !stride.is_multiple_of(size) {
            return Err(refused(
                format!("stride of {name} is no multiple of {size} from {}, got {stride}", 3 * size),
                "set stride to 0 for rows without gaps",
            ));
        }
        if self.count > 0 {
            self.check_host(name, size, stride)?;
        }
        let has_gaps = stride > 3 * size;
        if has_gaps {
            nearmiss::memory::require("positions", (self.count * 3 * size) as u64)?;
        }
        let (data, count, stride) = (self.data, self.count, stride / size);
        // SAFETY: the caller's promise; not NULL, aligned, and no row is beyond an object's size.
        Ok(unsafe {
            match (number, has_gaps) {
                (Number::F32, false) => HostPoints::Borrowed(Points::F32(items(data.cast(), count, name)?)),
                (Number::F64, false) => HostPoints::Borrowed(Points::F64(items(data.cast(), count, name)?)),
                (Number::F32, true) => HostPoints::Copied(Positions::F32(spaced(data.cast(), count, stride))),
                (Number::F64, true) => HostPoints::Copied(Positions::F64(spaced(data.cast(), count, stride))),
            }
        })
    }

    /// Quaternions in memory of the host, copied to doubles.
    ///
    /// # Safety
    /// Behind a `data` that is not NULL are `count` rows of four numbers.
    pub(crate) unsafe fn quaternions(&self, name: &str) -> Result<Vec<[f64; 4]>, Error> {
        let number = self.number(name)?;
        let size = number.bytes();
        let stride = if self.stride == 0 { 4 * size } else { self.stride };
        if stride < 4 * size || !stride.is_multiple_of(size) {
            return Err(refused(
                format!("stride of {name} is no multiple of {size} from {}, got {stride}", 4 * size),
                "set stride to 0 for rows without gaps",
            ));
        }
        if self.count == 0 {
            return Ok(Vec::new());
        }
        self.check_host(name, size, stride)?;
        nearmiss::memory::require("quaternions", (self.count as u64).saturating_mul(32))?;
        let (data, count, stride) = (self.data, self.count, stride / size);
        // SAFETY: the caller's promise; not NULL, aligned, and no row is beyond an object's size.
        Ok(unsafe {
            match number {
                Number::F32 => spaced(data.cast(), count, stride).into_iter().map(wide).collect(),
                Number::F64 => spaced(data.cast(), count, stride),
            }
        })
    }

    /// Whether an object of the host may have so many rows there.
    fn check_host(&self, name: &str, size: usize, stride: usize) -> Result<(), Error> {
        let bytes = stride.checked_mul(self.count).filter(|bytes| *bytes <= isize::MAX as usize);
        if bytes.is_none() {
            let what = format!("count of {name} exceeds the memory, got {}", self.count);
            return Err(refused(what, "set count to the number of rows"));
        }
        if self.data.is_null() {
            return Err(refused(format!("data of {name} is NULL"), "pass a pointer to the first number"));
        }
        if !self.data.addr().is_multiple_of(size) {
            let what = format!("data of {name} is not aligned to {size} bytes");
            return Err(refused(what, "pass a pointer to the first number"));
        }
        Ok(())
    }

    /// Rows in memory of the device, of `width` numbers each.
    ///
    /// # Safety
    /// As of [`DeviceRows::new`].
    pub(crate) unsafe fn on_device(&self, name: &str, width: usize) -> Result<DeviceRows, Error> {
        let number = self.number(name)?;
        if self.data.is_null() && self.count > 0 {
            return Err(refused(format!("data of {name} is NULL"), "pass the address of the first number"));
        }
        let row = width * number.bytes();
        let stride = if self.stride == 0 { row } else { self.stride };
        if stride < row {
            return Err(refused(
                format!("stride of {name} is less than {row}, got {stride}"),
                "set stride to 0 for rows without gaps",
            ));
        }
        // SAFETY: the caller's promise.
        unsafe { DeviceRows::new(self.data.addr() as u64, self.count, stride, number) }
    }
}

fn wide(quaternion: [f32; 4]) -> [f64; 4] {
    quaternion.map(f64::from)
}

/// Rows of `N`, `stride` numbers apart.
///
/// # Safety
/// All of them are there, aligned.
unsafe fn spaced<T: Copy, const N: usize>(from: *const T, count: usize, stride: usize) -> Vec<[T; N]> {
    // SAFETY: the caller's promise. An array has the alignment of its elements.
    (0..count).map(|row| unsafe { from.add(row * stride).cast::<[T; N]>().read() }).collect()
}

/// Items of the caller.
///
/// # Safety
/// `count` of them are behind a pointer that is not NULL, and they are not written while the slice
/// lives.
pub(crate) unsafe fn items<'a, T>(from: *const T, count: usize, name: &str) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]);
    }
    if from.is_null() {
        return Err(refused(
            format!("{name} is NULL, and its count is {count}"),
            "pass a pointer to the first",
        ));
    }
    if !from.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) {
        let what = format!("{name} is not aligned or exceeds the memory, got a count of {count}");
        return Err(refused(what, "pass a pointer to the first, and their number"));
    }
    // SAFETY: the caller's promise; not NULL, aligned, of a possible size.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// A text of the caller, if there is one; invalid UTF-8 is replaced.
///
/// # Safety
/// A pointer that is not NULL points to a text that ends with a zero.
pub(crate) unsafe fn text(from: *const c_char) -> Option<String> {
    // SAFETY: the caller's promise.
    (!from.is_null()).then(|| unsafe { CStr::from_ptr(from) }.to_string_lossy().into_owned())
}
