// SPDX-License-Identifier: MIT

use mien_sys as sys;
use std::alloc::{GlobalAlloc, Layout};
use std::os::raw::c_void;
use std::ptr::{null, null_mut, NonNull};
use std::sync::Arc;

/// Memory for what the library keeps, from anything that could be Rust's global allocator.
///
/// An object keeps a clone of the allocator that it was made with, so the allocator lives as long
/// as its last object. Alignments are powers of two, 64 at most. Memory that is refused is
/// [`Status::MEMORY`](crate::Status::MEMORY), never an abort.
///
/// ```
/// use std::alloc::System;
/// let memory = mien::Allocator::new(System);
/// let dna = mien::GenerateOptions::new().allocator(&memory).generate()?;
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone)]
pub struct Allocator {
    // Boxed once more, for C has room for one plain pointer. Raw, as C holds a copy of it while
    // clones come and go.
    source: Arc<Source>,
}

type Source = Box<dyn GlobalAlloc + Send + Sync>;

impl Allocator {
    /// Takes memory from `source`, on any thread. An `Arc` of your own, in a type that passes the
    /// calls on, lets you keep an eye on it.
    pub fn new(source: impl GlobalAlloc + Send + Sync + 'static) -> Self {
        Self { source: Arc::new(Box::new(source)) }
    }

    /// For C, as long as `self` or a clone of it lives.
    fn raw(&self) -> sys::MienAllocator {
        sys::MienAllocator {
            user: Arc::as_ptr(&self.source) as *mut c_void,
            allocate: Some(allocate),
            release: Some(release),
        }
    }

    /// Calls `call` with the allocator as C takes it; null stands for the heap of the C library.
    pub(crate) fn with<R>(
        allocator: Option<&Self>,
        call: impl FnOnce(*const sys::MienAllocator) -> R,
    ) -> R {
        match allocator {
            Some(allocator) => call(&allocator.raw()),
            None => call(null()),
        }
    }
}

impl std::fmt::Debug for Allocator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Allocator({:p})", Arc::as_ptr(&self.source))
    }
}

/// No allocator of Rust may be asked for nothing.
fn layout(size: usize, alignment: usize) -> Option<Layout> {
    Layout::from_size_align(size.max(1), alignment).ok()
}

unsafe extern "C" fn allocate(user: *mut c_void, size: usize, alignment: usize) -> *mut c_void {
    // SAFETY: `user` is from `raw()`, and objects keep the allocator that they were made with.
    let source = unsafe { &*(user as *const Source) };
    match layout(size, alignment) {
        // SAFETY: the layout is not of size 0.
        Some(layout) => unsafe { source.alloc(layout).cast() },
        None => null_mut(),
    }
}

unsafe extern "C" fn release(user: *mut c_void, block: *mut c_void, size: usize, alignment: usize) {
    // SAFETY: as above.
    let source = unsafe { &*(user as *const Source) };
    if let (Some(block), Some(layout)) = (NonNull::new(block), layout(size, alignment)) {
        // SAFETY: the library gives back size and alignment that the block was asked for with.
        unsafe { source.dealloc(block.as_ptr().cast(), layout) };
    }
}
