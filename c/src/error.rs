//! Codes and messages. No panic leaves the library.

use nearmiss::Error;
use std::any::Any;
use std::ffi::c_char;
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Codes of a call's end, one for each kind of error.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissCode {
    /// Success.
    NEARMISS_OK = 0,
    /// An argument that no data could make valid: an option, a name, a kind, the number of a
    /// body, a pointer. Correct the call.
    NEARMISS_INVALID_ARGUMENT = 1,
    /// Data that cannot be used: numbers of a mesh, of positions or of a pose. Correct the data.
    NEARMISS_INPUT = 2,
    /// A result could not be written.
    NEARMISS_OUTPUT = 3,
    /// The machine or its driver failed. The message quotes it.
    NEARMISS_DEVICE = 4,
    /// A measurement is worse than an earlier one.
    NEARMISS_REGRESSION = 5,
    /// Not enough memory. There is no answer.
    NEARMISS_OUT_OF_MEMORY = 6,
    /// The GPU's kernels were made from other sources than the library. Build it again.
    NEARMISS_KERNEL_MISMATCH = 7,
    /// A fault of nearmiss itself. Please report it.
    NEARMISS_BUG = 8,
    /// A `NearmissInterrupt` ended the call. There is no answer; the detector can be used again.
    NEARMISS_INTERRUPTED = 9,
}

/// Bytes of an error's text.
pub const NEARMISS_TEXT: usize = 1016;

/// The error of a call, in memory of the caller. It need not be initialised; a call that succeeds
/// clears it.
#[repr(C)]
pub struct NearmissError {
    /// The code that the call returned.
    pub code: NearmissCode,
    /// Bytes of the whole text without the final zero, also if it was cut.
    pub length: u32,
    /// One sentence with the problem and the remedy, in UTF-8, with a zero at its end. It is cut if
    /// it is too long.
    pub text: [c_char; NEARMISS_TEXT],
}

impl NearmissError {
    fn new(code: NearmissCode, sentence: &str) -> NearmissError {
        let mut error = NearmissError { code, length: sentence.len() as u32, text: [0; NEARMISS_TEXT] };
        let cut = &sentence[..sentence.floor_char_boundary(NEARMISS_TEXT - 1)];
        for (to, from) in error.text.iter_mut().zip(cut.bytes()) {
            *to = from as c_char;
        }
        error
    }
}

/// The exit status of the command line for a code: 0 success, 2 invalid argument, 3 invalid input,
/// 130 interrupted, 4 all others.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_exit_code(code: u32) -> u32 {
    match code {
        0 => 0,
        1 => 2,
        2 => 3,
        9 => 130,
        _ => 4,
    }
}

fn code(error: &Error) -> NearmissCode {
    match error {
        Error::InvalidArgument { .. } => NearmissCode::NEARMISS_INVALID_ARGUMENT,
        Error::Input { .. } => NearmissCode::NEARMISS_INPUT,
        Error::Output { .. } => NearmissCode::NEARMISS_OUTPUT,
        Error::Device { .. } => NearmissCode::NEARMISS_DEVICE,
        Error::Regression { .. } => NearmissCode::NEARMISS_REGRESSION,
        Error::OutOfMemory { .. } | Error::AnswerTooLarge { .. } => NearmissCode::NEARMISS_OUT_OF_MEMORY,
        Error::KernelMismatch { .. } => NearmissCode::NEARMISS_KERNEL_MISMATCH,
        Error::Interrupted => NearmissCode::NEARMISS_INTERRUPTED,
        // A new kind of error needs a code of its own.
        _ => NearmissCode::NEARMISS_BUG,
    }
}

/// An argument without a meaning.
pub(crate) fn refused(what: impl Into<String>, advice: impl Into<String>) -> Error {
    Error::InvalidArgument { what: what.into(), advice: advice.into() }
}

/// A pointer of the caller, by the name of its argument.
pub(crate) fn given<T>(pointer: Option<T>, name: &str) -> Result<T, Error> {
    pointer.ok_or_else(|| refused(format!("{name} is NULL"), "pass a valid pointer"))
}

/// The work of a call: errors and panics become codes.
pub(crate) fn call(
    error: Option<&mut MaybeUninit<NearmissError>>,
    work: impl FnOnce() -> Result<(), Error>,
) -> NearmissCode {
    // A detector is not used again after a panic: see `NearmissDetector::work`. Other handles change
    // by one assignment.
    let done = catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|panic| Err(Error::Bug { what: sentence(&*panic) }));
    let (code, text) = match &done {
        Ok(()) => (NearmissCode::NEARMISS_OK, String::new()),
        Err(error) => (code(error), error.to_string()),
    };
    if let Some(to) = error {
        to.write(NearmissError::new(code, &text));
    }
    code
}

/// The work of a call that makes a handle: NULL if it fails.
pub(crate) fn make<T>(
    to: Option<&mut MaybeUninit<*mut T>>,
    name: &str,
    error: Option<&mut MaybeUninit<NearmissError>>,
    work: impl FnOnce() -> Result<T, Error>,
) -> NearmissCode {
    call(error, || {
        let to = given(to, name)?;
        to.write(std::ptr::null_mut());
        to.write(Box::into_raw(Box::new(work()?)));
        Ok(())
    })
}

/// Frees a handle. Errors of its end are dropped.
pub(crate) fn free<T>(handle: Option<Box<T>>) {
    let _ = catch_unwind(AssertUnwindSafe(|| drop(handle)));
}

fn sentence(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("a panic: {}", text.unwrap_or("without words"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(work: impl FnOnce() -> Result<(), Error>) -> (NearmissError, String) {
        let mut error = MaybeUninit::uninit();
        let code = call(Some(&mut error), work);
        // SAFETY: a call writes it.
        let error = unsafe { error.assume_init() };
        assert_eq!(error.code, code);
        let bytes: Vec<u8> = error.text.iter().take_while(|c| **c != 0).map(|c| *c as u8).collect();
        (error, String::from_utf8(bytes).expect("UTF-8"))
    }

    #[test]
    fn a_panic_is_a_code() {
        let (error, text) = told(|| panic!("index {}", 7));
        assert_eq!(error.code, NearmissCode::NEARMISS_BUG);
        assert!(text.starts_with("a fault of nearmiss itself: a panic: index 7; please report"), "{text}");
        assert_eq!(call(None, || std::panic::panic_any(3)), NearmissCode::NEARMISS_BUG);
    }

    #[test]
    fn a_long_text_is_cut_between_characters() {
        let (error, text) = told(|| Err(refused("ü".repeat(600), "cut")));
        assert_eq!((error.length, text.len(), text), (1205, 1014, "ü".repeat(507)));
        let (error, text) = told(|| Ok(()));
        assert_eq!((error.code, error.length, text.as_str()), (NearmissCode::NEARMISS_OK, 0, ""));
    }

    #[test]
    fn every_kind_has_its_code() {
        let s = String::new;
        let (file, text, what) = (s(), s(), s());
        let device = Error::Device { what: s(), text: s(), advice: "" };
        let all = [
            (1, refused("", "")),
            (3, Error::Output { file, text }),
            (4, device),
            (5, Error::Regression { what: s(), text: s(), advice: "" }),
            (6, Error::OutOfMemory { what: s(), asked: 1, given: 0 }),
            (6, Error::AnswerTooLarge { pairs: 1, asked: 1, given: 0, advice: "" }),
            (7, Error::KernelMismatch { found: s(), wanted: s() }),
            (8, Error::Bug { what }),
            (9, Error::Interrupted),
        ];
        for (number, error) in all {
            assert_eq!(code(&error) as u32, number, "{error}");
            assert_eq!(nearmiss_exit_code(number), u32::from(error.exit_code()));
        }
    }

    #[test]
    fn a_handle_that_is_not_made_is_null() {
        let mut handle = MaybeUninit::<*mut u8>::uninit();
        let code = make(Some(&mut handle), "a handle", None, || Err(refused("no", "none")));
        // SAFETY: written before the work.
        assert!(code == NearmissCode::NEARMISS_INVALID_ARGUMENT && unsafe { handle.assume_init() }.is_null());
        assert_eq!(make::<u8>(None, "a handle", None, || Ok(1)), NearmissCode::NEARMISS_INVALID_ARGUMENT);
        free::<u8>(None);
    }
}
