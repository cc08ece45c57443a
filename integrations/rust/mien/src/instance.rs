// SPDX-License-Identifier: MIT

use crate::convert::{index, slice};
use crate::error::{check, checked};
use crate::{Allocator, InstanceStatistics, Result, Rig, Stages};
use mien_sys as sys;
use std::ptr::{null_mut, NonNull};
use std::slice::from_raw_parts_mut;

/// One character: its controls, and the outputs of its last evaluation.
///
/// Slices are the instance's own memory, without copies. What changes them takes `&mut self`, so
/// an instance is for one thread at a time; any number of threads may read its outputs. It holds
/// its [`Rig`].
///
/// ```
/// use mien::{Dna, Kind, Preset, Rig};
/// let rig = Rig::new(&Dna::generate(Preset::SMALL)?)?;
/// let jaw = rig.find(Kind::RAW_CONTROL, "CTRL_expressions.jawOpen")?;
///
/// let mut face = rig.instance()?;
/// face.raw_controls_mut()[jaw] = 1.0;
/// face.evaluate(0)?;
/// for joint in face.joints().chunks_exact(9) {
///     let (translation, angles, scale) = (&joint[0..3], &joint[3..6], &joint[6..9]);
/// #   let _ = (translation, angles, scale);
/// }
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Instance {
    handle: NonNull<sys::MienInstance>,
    gui_controls: Inputs,
    raw_controls: Inputs,
    ml_masks: Inputs,
    controls: Outputs,
    psd_controls: Outputs,
    ml_controls: Outputs,
    rbf_controls: Outputs,
    joints: Outputs,
    blend_shapes: Outputs,
    animated_maps: Outputs,
    // Dropped after the handle is destroyed.
    rig: Rig,
    _allocator: Option<Allocator>,
}

// Where values are. The same until the instance is destroyed, so they are asked for once.
type Inputs = sys::MienMutableFloatView;
type Outputs = sys::MienFloatView;

// SAFETY: an instance may be used by any thread, by one at a time if it is changed, which takes
// `&mut self` here. All that `&self` does is to read values, and so does what the library does for it.
unsafe impl Send for Instance {}
unsafe impl Sync for Instance {}

macro_rules! inputs {
    ($($(#[$doc:meta])* $field:ident, $field_mut:ident;)*) => {
        $(
            $(#[$doc])*
            #[inline]
            pub fn $field(&self) -> &[f32] {
                // SAFETY: valid as long as `self`; what writes to it takes `&mut self`.
                unsafe { slice(self.$field.data, self.$field.count) }
            }

            $(#[$doc])*
            #[inline]
            pub fn $field_mut(&mut self) -> &mut [f32] {
                let Inputs { data, count } = self.$field;
                if count == 0 {
                    return &mut [];
                }
                // SAFETY: as above, and `&mut self` makes it the only view of the instance.
                unsafe { from_raw_parts_mut(data, count) }
            }
        )*
    };
}

macro_rules! outputs {
    ($($(#[$doc:meta])* $field:ident;)*) => {
        $(
            $(#[$doc])*
            #[inline]
            pub fn $field(&self) -> &[f32] {
                // SAFETY: valid as long as `self`; what writes to it takes `&mut self`.
                unsafe { slice(self.$field.data, self.$field.count) }
            }
        )*
    };
}

/// Inputs, to be written in place.
impl Instance {
    inputs! {
        /// GUI controls, which only matter to [`map_gui_to_raw`](Self::map_gui_to_raw).
        gui_controls, gui_controls_mut;
        /// Raw controls, usually in 0..1 but not clamped. Finite values are expected.
        raw_controls, raw_controls_mut;
        /// One per region of a mesh, 0..1, initially 1: switches or blends machine-learned behavior.
        ml_masks, ml_masks_mut;
    }
}

/// Outputs of the last evaluation.
impl Instance {
    outputs! {
        /// The whole control vector: raw, PSD, ML, RBF.
        controls;
        /// Values of the correctives.
        psd_controls;
        /// What neural networks put out.
        ml_controls;
        /// Weights of the poses of RBF solvers.
        rbf_controls;
        /// 9 values per joint (tx ty tz rx ry rz sx sy sz), or 10 with quaternions (tx ty tz qx qy
        /// qz qw sx sy sz): deltas from the neutral pose, in the units of the file. Translation,
        /// angles and scale are added to it; with quaternions the rotation is the product
        /// neutral * delta (the delta turns first).
        joints;
        /// One weight per channel.
        blend_shapes;
        /// One weight per map, 0..1.
        animated_maps;
    }
}

impl Instance {
    /// One character of `rig` in its initial state, in memory of the heap.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_instance_create)]
    pub fn new(rig: &Rig) -> Result<Self> {
        Self::create(rig, None)
    }

    /// The same in memory of your own: one block of `RigInfo::instance_bytes`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_instance_create)]
    pub fn new_in(rig: &Rig, allocator: &Allocator) -> Result<Self> {
        Self::create(rig, Some(allocator))
    }

    fn create(rig: &Rig, allocator: Option<&Allocator>) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(allocator, |allocator| {
            let desc = sys::MienInstanceDesc { allocator, ..Default::default() };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe {
                sys::mien_instance_create(rig.raw(), &desc, &mut handle, error)
            })
        })?;
        let mut instance = Self {
            handle: NonNull::new(handle).expect("a handle after success"),
            gui_controls: Inputs::default(),
            raw_controls: Inputs::default(),
            ml_masks: Inputs::default(),
            controls: Outputs::default(),
            psd_controls: Outputs::default(),
            ml_controls: Outputs::default(),
            rbf_controls: Outputs::default(),
            joints: Outputs::default(),
            blend_shapes: Outputs::default(),
            animated_maps: Outputs::default(),
            rig: rig.clone(),
            _allocator: allocator.cloned(),
        };
        // SAFETY: a live handle, and places for views, which start empty.
        unsafe {
            check(sys::mien_instance_gui_controls(handle, &mut instance.gui_controls))?;
            check(sys::mien_instance_raw_controls(handle, &mut instance.raw_controls))?;
            check(sys::mien_instance_ml_masks(handle, &mut instance.ml_masks))?;
            check(sys::mien_instance_controls(handle, &mut instance.controls))?;
            check(sys::mien_instance_psd_controls(handle, &mut instance.psd_controls))?;
            check(sys::mien_instance_ml_controls(handle, &mut instance.ml_controls))?;
            check(sys::mien_instance_rbf_controls(handle, &mut instance.rbf_controls))?;
            check(sys::mien_instance_joints(handle, &mut instance.joints))?;
            check(sys::mien_instance_blend_shapes(handle, &mut instance.blend_shapes))?;
            check(sys::mien_instance_animated_maps(handle, &mut instance.animated_maps))?;
        }
        Ok(instance)
    }

    /// The rig that it is an instance of.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Evaluates all stages at a LOD. Outputs that the LOD does not reach are 0. Allocates
    /// nothing, locks nothing; the only failure is [`Status::LOD`](crate::Status::LOD).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate)]
    #[inline]
    pub fn evaluate(&mut self, lod: usize) -> Result<()> {
        // SAFETY: live handles, and `&mut self` for the one that changes; the same below.
        check(unsafe { sys::mien_rig_evaluate(self.rig.raw(), self.raw(), index(lod)) })
    }

    /// Evaluates some stages; the others keep the results of the last evaluation at the same LOD
    /// (after a change of LOD: 0).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_stages)]
    #[inline]
    pub fn evaluate_stages(&mut self, lod: usize, stages: Stages) -> Result<()> {
        check(unsafe {
            sys::mien_rig_evaluate_stages(self.rig.raw(), self.raw(), index(lod), stages.0)
        })
    }

    /// Only the joint values of one joint group
    /// ([`Kind::JOINT_GROUP`](crate::Kind::JOINT_GROUP)).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_joint_group)]
    pub fn evaluate_joint_group(&mut self, lod: usize, group: usize) -> Result<()> {
        let (lod, group) = (index(lod), index(group));
        check(unsafe { sys::mien_rig_evaluate_joint_group(self.rig.raw(), self.raw(), lod, group) })
    }

    /// Only the pose controls of one RBF solver
    /// ([`Kind::RBF_SOLVER`](crate::Kind::RBF_SOLVER)), whether the LOD lists it or not.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_rbf_solver)]
    pub fn evaluate_rbf_solver(&mut self, lod: usize, solver: usize) -> Result<()> {
        let (lod, solver) = (index(lod), index(solver));
        check(unsafe { sys::mien_rig_evaluate_rbf_solver(self.rig.raw(), self.raw(), lod, solver) })
    }

    /// Only the joints of one twist and swing set-up
    /// ([`Kind::TWIST_SWING`](crate::Kind::TWIST_SWING)).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_twist_swing)]
    pub fn evaluate_twist_swing(&mut self, lod: usize, setup: usize) -> Result<()> {
        let (lod, setup) = (index(lod), index(setup));
        check(unsafe { sys::mien_rig_evaluate_twist_swing(self.rig.raw(), self.raw(), lod, setup) })
    }

    /// Raw controls from GUI controls. Writes only raw controls that some row of the table
    /// drives, and clamps them to 0..1; others keep what they hold.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_map_gui_to_raw)]
    pub fn map_gui_to_raw(&mut self) -> Result<()> {
        check(unsafe { sys::mien_rig_map_gui_to_raw(self.rig.raw(), self.raw()) })
    }

    /// GUI controls from raw controls: of each the value whose forward mapping gives the raw
    /// controls, 0 where there is none.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_map_raw_to_gui)]
    pub fn map_raw_to_gui(&mut self) -> Result<()> {
        check(unsafe { sys::mien_rig_map_raw_to_gui(self.rig.raw(), self.raw()) })
    }

    /// What the joint stage fetches for the controls as they are.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_instance_statistics)]
    pub fn statistics(&self) -> Result<InstanceStatistics> {
        let mut out = sys::MienInstanceStatistics::default();
        // SAFETY: a live handle, which is only read, and a sized struct.
        check(unsafe { sys::mien_instance_statistics(self.raw_const(), &mut out) })?;
        Ok(out.into())
    }

    /// Everything as after creation.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_instance_reset)]
    pub fn reset(&mut self) -> Result<()> {
        check(unsafe { sys::mien_instance_reset(self.raw()) })
    }

    pub(crate) fn raw_const(&self) -> *const sys::MienInstance {
        self.handle.as_ptr()
    }

    pub(crate) fn raw(&mut self) -> *mut sys::MienInstance {
        self.handle.as_ptr()
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: destroyed once; nothing that points into it outlives `self`.
        unsafe { sys::mien_instance_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Instance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Instance").field("rig", &self.rig).finish_non_exhaustive()
    }
}
