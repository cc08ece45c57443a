// SPDX-License-Identifier: MIT
//! The C interface of Mien as it is: every function, struct and constant of `mien.h`,
//! `mien_author.h` and `mien_solve.h`, under the same names. The crate `mien` is the safe way to use it.
//!
//! Structs that begin with `struct_size` have it set by `Default`, and zero elsewhere, which is
//! the default of each field. Enums are constants, for a newer library may know more numbers.
//!
//! The libraries, libmien, libmien-author and libmien-solve, are looked for in `MIEN_LIB_DIR`, else by
//! pkg-config. The feature `static`, or `MIEN_STATIC=1`, takes `libmien.a` and the others.
use std::marker::{PhantomData, PhantomPinned};
use std::mem::{size_of, zeroed};
use std::os::raw::{c_char, c_void};

/// What a handle points to is known to the library only: it is not moved, sent or shared as such.
type Opaque = PhantomData<(*mut u8, PhantomPinned)>;

#[rustfmt::skip]
mod bindings;
pub use bindings::*;
