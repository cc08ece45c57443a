// SPDX-License-Identifier: MIT
//! Between the types of C and those of Rust.

use crate::{Error, Result, Status};
use mien_sys as sys;
use std::borrow::Cow;
use std::ffi::CString;
use std::os::raw::c_char;
use std::path::Path;
use std::slice::from_raw_parts;

/// Names of the numbers of an enum, for Debug.
macro_rules! numbers {
    ($type:ident, $number:ty, [$(($value:expr, $name:expr)),*]) => {
        impl std::fmt::Debug for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self.0 {
                    $($value => f.write_str(concat!(stringify!($type), "::", $name)),)*
                    other => write!(f, concat!(stringify!($type), "({})"), other),
                }
            }
        }
    };
}

/// The same for numbers that are combined, which can be done with `|`.
macro_rules! flags {
    ($type:ident, $number:ty, [$(($value:expr, $name:expr)),*]) => {
        impl $type {
            /// Whether all of `other` is in `self`.
            pub const fn contains(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }
        }

        impl std::ops::BitOr for $type {
            type Output = Self;
            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }

        impl std::ops::BitOrAssign for $type {
            fn bitor_assign(&mut self, other: Self) {
                self.0 |= other.0;
            }
        }

        impl std::fmt::Debug for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let names: Vec<&str> = [$(($value, $name)),*]
                    .iter()
                    .filter(|(value, _): &&($number, &str)| {
                        value.count_ones() == 1 && self.0 & value != 0
                    })
                    .map(|(_, name)| *name)
                    .collect();
                write!(f, concat!(stringify!($type), "({:#x}: {})"), self.0, names.join(" | "))
            }
        }
    };
}

pub(crate) use {flags, numbers};

pub(crate) fn offset(offset: u64) -> Option<u64> {
    (offset != sys::MIEN_NO_OFFSET).then_some(offset)
}

/// Text in an array of C, up to its terminator.
pub(crate) fn text(chars: &[c_char]) -> String {
    let bytes: Vec<u8> = chars.iter().take_while(|c| **c != 0).map(|c| *c as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// An index as C takes it. One that does not fit is past the end of everything.
pub(crate) fn index(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

pub(crate) fn path_string(path: &Path) -> Result<CString> {
    let text = path.to_str().ok_or_else(|| {
        Error::new(Status::INVALID_ARGUMENT, "the path is not UTF-8, which Mien takes")
    })?;
    terminated(text)
}

pub(crate) fn terminated(text: &str) -> Result<CString> {
    CString::new(text)
        .map_err(|_| Error::new(Status::INVALID_ARGUMENT, "there is a zero byte in the text"))
}

/// `count` values at `data`, which may be null if there are none.
///
/// # Safety
///
/// If `count` is not 0, the values have to be readable, initialized and unchanged for `'a`.
pub(crate) unsafe fn slice<'a, T>(data: *const T, count: usize) -> &'a [T] {
    if count == 0 {
        &[]
    } else {
        // SAFETY: promised by the caller.
        unsafe { from_raw_parts(data, count) }
    }
}

/// Rows of `N` values each.
///
/// # Safety
///
/// As for [`slice`].
pub(crate) unsafe fn rows<'a, T, const N: usize>(data: *const T, count: usize) -> &'a [[T; N]] {
    debug_assert_eq!(count % N, 0);
    // SAFETY: promised by the caller; an array has the layout of its elements.
    unsafe { slice(data.cast(), count / N) }
}

/// # Safety
///
/// As for [`slice`].
pub(crate) unsafe fn bytes<'a>(view: sys::MienStringView) -> &'a [u8] {
    // SAFETY: promised by the caller.
    unsafe { slice(view.data.cast(), view.count) }
}

/// Names are UTF-8 by convention, not by check.
pub(crate) fn utf8(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

pub(crate) fn empty_string() -> sys::MienStringView {
    sys::MienStringView::default()
}
