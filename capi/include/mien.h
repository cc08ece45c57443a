/* SPDX-License-Identifier: MIT
 *
 * Mien: reads DNA files, and evaluates and deforms the facial rigs in them.
 *
 *     DNA file -> MienDna -> MienRig -> MienInstance -> joint values, channel and map weights
 *                    \______ MienDeformer -> MienDeformerInstance -> matrices and vertices
 *
 *   MienDna               a checked, read-only view of a file
 *   MienRig               the behavior of a file, packed for evaluation; immutable
 *   MienInstance          one character: its controls, and the results of its last evaluation
 *   MienBatch             scratch memory for evaluating many instances in one call
 *   MienDeformer          the geometry of a file, packed for deformation; immutable
 *   MienDeformerInstance  one character: its joint matrices and deformed meshes
 *   MienDerivatives       derivatives of a rig by its controls, and the memory to compute them
 *   MienBaked             an open file that holds a packed rig and its deformer
 *   MienClip              compressed curves of named channels; immutable
 *   MienClipPlayer        plays a clip for one character
 *   MienClipBinding       maps the channels of a clip to the raw controls of a rig; immutable
 *   MienMix               layers, reactions, guards and limits that produce the raw controls of a rig;
 *                         immutable
 *   MienMixer             one character in a mix: its running clips, fades and reactions
 *   MienGaze              which raw controls turn the eyes of a rig, and by how much; immutable
 *   MienSolverStack       solvers that move joints after the rig has posed them; immutable
 *   MienSolverState       one character: the state that springs and other solvers keep between steps
 *
 * One rig and one deformer serve any number of characters and threads. Both copy what they need
 * from the DNA, which may be closed afterwards.
 *
 * These rules hold unless a function says otherwise:
 *
 *   Status     Functions that can fail return a MienStatus; MIEN_OK is 0. On failure, `out_...`
 *              parameters are set to NULL or zero; the caller's arrays are left unchanged. Functions
 *              that can fail because of their data also take a MienError, which may be NULL.
 *              Wrong arguments give MIEN_ERROR_NULL_ARGUMENT, MIEN_ERROR_INVALID_ARGUMENT,
 *              MIEN_ERROR_STRUCT_SIZE or MIEN_ERROR_HANDLE; functions that create or open an
 *              object give MIEN_ERROR_MEMORY if the allocator returns NULL. In a library
 *              built with MIEN_BUILD_COMPILER=OFF, functions that create or take a MienDna or
 *              a MienReport give MIEN_ERROR_UNSUPPORTED. "Fails with" lists the other
 *              statuses of a function.
 *   Threads    A const handle may be used by any number of threads at the same time. A handle that
 *              is not const may be used by one thread at a time. There is no global state.
 *   Ownership  Objects that a create, open or generate function returns are released by the
 *              matching destroy or close function, which accepts NULL. Memory that you pass in is
 *              used only during the call.
 *   Views      A view (pointer and count) points into the memory of the handle it was requested
 *              from and is valid until that handle is destroyed or closed. Views of immutable
 *              objects never change.
 *   Strings    UTF-8, not validated. Names and paths that you pass in are null-terminated; functions
 *              whose names end in _n take a length in bytes instead. Strings in a MienStringView
 *              are not null-terminated.
 *   Structs    Later releases may append fields to structs that begin with struct_size.
 *              Initialize such a struct with its default function, or zero it and set struct_size
 *              to its sizeof: zero is the default of every field. A desc or allocator may be NULL,
 *              which means all defaults. MIEN_ERROR_STRUCT_SIZE means that a struct is smaller than
 *              in the release that introduced it, or larger than 4096 bytes, or that an input has
 *              nonzero fields that the library does not know. Unknown fields of outputs are set to
 *              zero.
 *   Enums      Parameters and fields that hold an enum value are fixed-width integers, because the
 *              size of a C enum is not fixed.
 *   Misuse     A NULL handle, an index out of range or a handle of the wrong kind gives an error
 *              status. Using a destroyed handle is undefined behavior, like using freed memory. The
 *              library never aborts or prints.
 *   Units      Those of the file: mien_rig_info() returns the units of translations and rotations
 *              and the directions of the axes. Joint values are deltas from the neutral pose.
 *   Numbers    32-bit floats. docs/numbers.md states which results are bit-identical on which machines.
 */
#ifndef MIEN_H
#define MIEN_H

#include "mien/base.h"
#include "mien/dna.h"
#include "mien/rig.h"
#include "mien/deform.h"
#include "mien/derivatives.h"
#include "mien/baked.h"
#include "mien/clip.h"
#include "mien/mix.h"
#include "mien/solve.h"
#include "mien/names.h"

#endif /* MIEN_H */
