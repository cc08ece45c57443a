// SPDX-License-Identifier: MIT
//! Readers of Rust as streams of the library.

use crate::{Error, Result};
use mien_sys as sys;
use std::any::Any;
use std::io::{self, Read, Seek, SeekFrom};
use std::os::raw::c_void;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};

struct Source<'a, R> {
    reader: &'a mut R,
    failed: Option<io::Error>,
    panicked: Option<Box<dyn Any + Send>>,
}

/// Calls `open` with a stream over all of `reader`. If reading failed, that is the error; if it
/// panicked, so does this, once the library is done.
pub(crate) fn with_stream<R: Read + Seek, T>(
    reader: &mut R,
    open: impl FnOnce(*const sys::MienStream) -> Result<T>,
) -> Result<T> {
    let size = reader.seek(SeekFrom::End(0)).map_err(Error::from_io)?;
    let mut source = Source { reader, failed: None, panicked: None };
    let user = (&mut source as *mut Source<'_, R>).cast();
    let opened = open(&sys::MienStream { user, size, read: Some(read::<R>) });
    if let Some(panic) = source.panicked {
        resume_unwind(panic);
    }
    match source.failed {
        Some(error) => Err(Error::from_io(error)),
        None => opened,
    }
}

/// # Safety
///
/// `user` is a `Source<R>` that nothing else uses, `buffer` has room for `size` bytes.
unsafe extern "C" fn read<R: Read + Seek>(
    user: *mut c_void,
    offset: u64,
    buffer: *mut c_void,
    size: usize,
) -> usize {
    // SAFETY: as above; the library hands back what with_stream() gave it.
    let source = unsafe { &mut *user.cast::<Source<'_, R>>() };
    let fill = AssertUnwindSafe(|| {
        // SAFETY: as above. A reader must not look at what it is given, but zeros are at hand.
        unsafe { buffer.cast::<u8>().write_bytes(0, size) };
        // SAFETY: initialized just now.
        let buffer = unsafe { std::slice::from_raw_parts_mut(buffer.cast::<u8>(), size) };
        source.reader.seek(SeekFrom::Start(offset))?;
        source.reader.read_exact(buffer)
    });
    match catch_unwind(fill) {
        Ok(Ok(())) => size,
        Ok(Err(error)) => {
            source.failed = Some(error);
            0
        }
        Err(panic) => {
            source.panicked = Some(panic);
            0
        }
    }
}
