// SPDX-License-Identifier: MIT

use crate::convert::{bytes, index, offset, path_string, utf8};
use crate::error::{check, checked};
use crate::{Allocator, Result, Severity, Status};
use mien_sys as sys;
use std::borrow::Cow;
use std::path::Path;
use std::ptr::{null_mut, NonNull};

/// Everything that is wrong with a file, or odd about it.
///
/// ```
/// let file = mien::Dna::generate(mien::Preset::TINY)?.to_bytes()?;
/// let report = mien::Report::of_bytes(&file[..file.len() / 2])?;
/// for finding in report.findings() {
///     println!("{}: {}", finding.field, finding.message);
/// }
/// assert!(report.errors() > 0);
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Report {
    handle: NonNull<sys::MienReport>,
    errors: u32,
    warnings: u32,
    _allocator: Option<Allocator>,
}

// SAFETY: the handle is only used as const, which any number of threads may do at a time.
unsafe impl Send for Report {}
unsafe impl Sync for Report {}

/// One thing that a [`Report`] tells.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Finding<'report> {
    /// Whether the file is refused for it.
    pub severity: Severity,
    /// What opening would fail with; [`Status::OK`] for a warning.
    pub status: Status,
    /// Where in the file, if there is such a place.
    pub byte_offset: Option<u64>,
    /// A path as for [`Dna::field`](crate::Dna::field), or a layer's code.
    pub field: Cow<'report, str>,
    /// What is wrong.
    pub message: Cow<'report, str>,
}

impl Report {
    /// Reads a whole file and examines it. Lists at most 32 findings for one field, and 1000 in
    /// all.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_validate_file)]
    pub fn of_file(path: impl AsRef<Path>) -> Result<Self> {
        Self::read(path.as_ref(), None)
    }

    /// The same, with memory of your own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_validate_file)]
    pub fn of_file_in(path: impl AsRef<Path>, allocator: &Allocator) -> Result<Self> {
        Self::read(path.as_ref(), Some(allocator))
    }

    /// Examines a file that is in memory.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_validate_memory)]
    pub fn of_bytes(file: &[u8]) -> Result<Self> {
        Self::examine(file, None)
    }

    /// The same, with memory of your own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_validate_memory)]
    pub fn of_bytes_in(file: &[u8], allocator: &Allocator) -> Result<Self> {
        Self::examine(file, Some(allocator))
    }

    fn read(path: &Path, allocator: Option<&Allocator>) -> Result<Self> {
        let path = path_string(path)?;
        // SAFETY: a terminated path. The file is copied, so the checked bytes cannot change.
        Self::create(allocator, |desc, out, error| unsafe {
            sys::mien_dna_validate_file(path.as_ptr(), desc, out, error)
        })
    }

    fn examine(file: &[u8], allocator: Option<&Allocator>) -> Result<Self> {
        let (data, size) = (file.as_ptr().cast(), file.len());
        // SAFETY: readable bytes, which the report does not keep.
        Self::create(allocator, |desc, out, error| unsafe {
            sys::mien_dna_validate_memory(data, size, desc, out, error)
        })
    }

    pub(crate) fn create(
        allocator: Option<&Allocator>,
        call: impl FnOnce(
            *const sys::MienValidateDesc,
            *mut *mut sys::MienReport,
            *mut sys::MienError,
        ) -> sys::MienStatus,
    ) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(allocator, |allocator| {
            let desc = sys::MienValidateDesc { allocator, ..Default::default() };
            checked(|error| call(&desc, &mut handle, error))
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut report = Self { handle, errors: 0, warnings: 0, _allocator: allocator.cloned() };
        let Self { errors, warnings, .. } = &mut report;
        // SAFETY: a live handle.
        check(unsafe { sys::mien_report_counts(handle.as_ptr(), errors, warnings) })?;
        Ok(report)
    }

    /// Findings for which the file is refused.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.errors as usize
    }

    /// Findings that are allowed, but probably not meant.
    #[must_use]
    pub fn warnings(&self) -> usize {
        self.warnings as usize
    }

    /// All findings, in the order of the checks.
    #[must_use]
    pub fn findings(&self) -> impl Iterator<Item = Finding<'_>> + '_ {
        (0..self.errors() + self.warnings()).filter_map(|i| self.finding(i).ok())
    }

    /// Finding `finding` of `errors() + warnings()`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_report_finding)]
    pub fn finding(&self, finding: usize) -> Result<Finding<'_>> {
        let mut out = sys::MienFinding::default();
        // SAFETY: a live handle and a sized struct; views live as long as the report.
        unsafe {
            check(sys::mien_report_finding(self.handle.as_ptr(), index(finding), &mut out))?;
            Ok(Finding {
                severity: Severity(out.severity),
                status: Status(out.status),
                byte_offset: offset(out.byte_offset),
                field: utf8(bytes(out.field)),
                message: utf8(bytes(out.message)),
            })
        }
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        // SAFETY: destroyed once; nothing that points into it outlives `self`.
        unsafe { sys::mien_report_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.findings()).finish()
    }
}
