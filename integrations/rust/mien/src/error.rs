// SPDX-License-Identifier: MIT

use crate::convert::{offset, text};
use crate::generated::describe;
use crate::Status;
use mien_sys as sys;
use std::borrow::Cow;
use std::ffi::CStr;
use std::fmt;

/// What went wrong, and where in the file.
///
/// ```
/// let error = mien::Dna::from_bytes(b"not a rig").unwrap_err();
/// assert_eq!(error.status(), mien::Status::DNA_SIGNATURE);
/// assert_eq!(error.byte_offset(), Some(0));
/// println!("{error}"); // DNA_SIGNATURE: ... (at byte 0)
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    status: Status,
    byte_offset: Option<u64>,
    message: Cow<'static, str>,
}

/// What calls return that can fail.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn new(status: Status, message: impl Into<Cow<'static, str>>) -> Self {
        Self { status, byte_offset: None, message: message.into() }
    }

    /// What a reader said that failed.
    pub(crate) fn from_io(error: std::io::Error) -> Self {
        Self::new(Status::FILE_READ, error.to_string())
    }

    /// Which kind of failure this is, for programs to act on.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }

    /// Where in the file the cause is, if there is such a place.
    #[must_use]
    pub fn byte_offset(&self) -> Option<u64> {
        self.byte_offset
    }

    /// What, where and what to do about it, for people.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.status.name())?;
        if !self.message.is_empty() {
            write!(f, ": {}", self.message)?;
        }
        match self.byte_offset {
            Some(offset) => write!(f, " (at byte {offset})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Error {}

/// For functions that return [`std::io::Result`]: damaged files are
/// [`InvalidData`](std::io::ErrorKind::InvalidData), wrong arguments
/// [`InvalidInput`](std::io::ErrorKind::InvalidInput). The error stays available by
/// [`get_ref`](std::io::Error::get_ref).
impl From<Error> for std::io::Error {
    fn from(error: Error) -> Self {
        use std::io::ErrorKind;
        let kind = match error.status().0 {
            1..=9 => ErrorKind::InvalidInput,
            10..=19 => ErrorKind::OutOfMemory,
            30..=81 => ErrorKind::InvalidData,
            _ => ErrorKind::Other,
        };
        std::io::Error::new(kind, error)
    }
}

impl Status {
    /// The name without `MIEN_ERROR_`: `"DNA_TRUNCATED"`; `"UNKNOWN"` for other numbers.
    #[must_use]
    pub fn name(self) -> &'static str {
        // SAFETY: any number may be given; the result is static and terminated.
        let name = unsafe { CStr::from_ptr(sys::mien_status_name(self.0)) };
        name.to_str().unwrap_or("UNKNOWN")
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// For calls without detail: what the status says by itself.
#[inline]
pub(crate) fn check(status: sys::MienStatus) -> Result<()> {
    if status == sys::MIEN_OK {
        Ok(())
    } else {
        Err(undetailed(Status(status)))
    }
}

#[cold]
fn undetailed(status: Status) -> Error {
    Error::new(status, describe(status))
}

/// Calls `call` with a place for the detail.
pub(crate) fn checked(call: impl FnOnce(*mut sys::MienError) -> sys::MienStatus) -> Result<()> {
    let mut detail = sys::MienError { byte_offset: sys::MIEN_NO_OFFSET, ..Default::default() };
    let status = call(&mut detail);
    if status == sys::MIEN_OK {
        return Ok(());
    }
    let mut error = undetailed(Status(status));
    let message = text(&detail.message);
    if !message.is_empty() {
        error.message = message.into();
        error.byte_offset = offset(detail.byte_offset);
    }
    Err(error)
}
