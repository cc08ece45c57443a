// SPDX-License-Identifier: MIT

use crate::convert::{bytes, empty_string, utf8};
use crate::error::check;
use crate::{CoordinateSystem, Error, Result, Status};
use mien_sys as sys;

/// ```
/// use mien::{CoordinateSystem, Dna, OpenOptions, Preset, TranslationUnit};
/// let file = Dna::generate(Preset::TINY)?.to_bytes()?;
/// let unity = CoordinateSystem::named("unity")?;
/// let dna = OpenOptions::new().system(&unity).open_bytes(&file)?;
/// assert_eq!(dna.info().axes, unity.axes);
/// assert_eq!(dna.info().translation_unit, TranslationUnit::METERS);
/// # Ok::<(), mien::Error>(())
/// ```
impl CoordinateSystem {
    /// The system of an engine or tool, as one of [`names`](Self::names). Its fields may be changed
    /// afterwards; angles turn by its own order once `rotation_rule` says so.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_coordinate_system_find_n)]
    pub fn named(name: &str) -> Result<Self> {
        let mut out = sys::MienCoordinateSystem::default();
        // SAFETY: as many bytes as are told, and a sized struct.
        let status = unsafe {
            sys::mien_coordinate_system_find_n(name.as_ptr().cast(), name.len(), &mut out)
        };
        if status == sys::MIEN_ERROR_NAME {
            let message = format!("no coordinate system is named \"{name}\"");
            return Err(Error::new(Status::NAME, message));
        }
        check(status)?;
        Ok(out.into())
    }

    /// The names that the library knows: maya, unreal, unity, godot, blender, gltf, ...
    pub fn names() -> impl Iterator<Item = String> {
        (0..).map_while(|i| {
            let mut out = empty_string();
            // SAFETY: any index may be asked for; the name is copied at once.
            unsafe {
                check(sys::mien_coordinate_system_name(i, &mut out)).ok()?;
                Some(utf8(bytes(out)).into_owned())
            }
        })
    }
}
