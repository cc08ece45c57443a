// SPDX-License-Identifier: MIT
// Conversion between handles and objects, and the checks that every entry point begins with.
#pragma once

#include <cstring>
#include <type_traits>

#include "capi/arguments/arguments.h"
#include "runtime/anim/binding.h"
#include "runtime/anim/clip_player.h"
#include "runtime/baked/baked_file.h"
#include "runtime/deform/deformer_instance.h"
#include "runtime/derive/derivatives.h"
#include "runtime/eval/batch.h"
#include "runtime/eval/instance.h"
#include "runtime/mix/gaze.h"
#include "runtime/mix/mixer.h"
#include "runtime/solve/solver_stack.h"
#include "simd/isa.h"

// Objects begin with a tag that identifies their kind. Destroyed handles are not detected: a table of ids
// with generations takes 0.2 to 0.6 ns more per handle than a tag (1.8 ns), but the object may be destroyed
// right after the look-up. Pinning it for the call takes 13 to 21 ns and needs a lock to create handles.

namespace mien::capi {

template <class T>
struct TypeOf {
  using type = T;
};

/// The object behind a handle. dna_handle.h has those of the full library.
template <class Handle>
struct ObjectOf;
template <>
struct ObjectOf<MienRig> : TypeOf<Rig> {};
template <>
struct ObjectOf<MienInstance> : TypeOf<Instance> {};
template <>
struct ObjectOf<MienBatch> : TypeOf<Batch> {};
template <>
struct ObjectOf<MienDeformer> : TypeOf<Deformer> {};
template <>
struct ObjectOf<MienDeformerInstance> : TypeOf<DeformerInstance> {};
template <>
struct ObjectOf<MienDerivatives> : TypeOf<Derivatives> {};
template <>
struct ObjectOf<MienBaked> : TypeOf<Baked> {};
template <>
struct ObjectOf<MienClip> : TypeOf<SharedClip> {};
template <>
struct ObjectOf<MienClipPlayer> : TypeOf<ClipPlayer> {};
template <>
struct ObjectOf<MienClipBinding> : TypeOf<Binding> {};
template <>
struct ObjectOf<MienGaze> : TypeOf<Gaze> {};
template <>
struct ObjectOf<MienMix> : TypeOf<Mix> {};
template <>
struct ObjectOf<MienMixer> : TypeOf<Mixer> {};
template <>
struct ObjectOf<MienSolverStack> : TypeOf<Stack> {};
template <>
struct ObjectOf<MienSolverState> : TypeOf<StackState> {};

template <class Handle>
auto* object(Handle* handle) {
  using Kind = typename ObjectOf<std::remove_const_t<Handle>>::type;
  return reinterpret_cast<std::conditional_t<std::is_const_v<Handle>, const Kind, Kind>*>(handle);
}

template <class Handle>
MienStatus check(const Handle* handle) {
  return check_tag(handle, ObjectOf<Handle>::type::kTag);
}

/// The same for calls that report errors; `name` is that of the parameter.
template <class Handle>
MienStatus check(const Handle* handle, const char* name, MienError* error) {
  const MienStatus status = check(handle);
  if (status == MIEN_OK) return MIEN_OK;
  if (!handle) return give_error(error, status, "%s is NULL", name);
  return give_error(error, status, "%s is a handle of another kind, or none", name);
}

inline Span<const char> span_of(const MienStringView& view) { return {view.data, view.count}; }

inline MienStringView view_of(Span<const char> name) { return {name.data, name.count}; }
inline MienIndex16View view_of(Span<const uint16_t> list) { return {list.data, list.count}; }
inline MienIndex32View view_of(Span<const uint32_t> list) { return {list.data, list.count}; }
inline MienFloatView view_of(Span<const float> list) { return {list.data, list.count}; }

inline MienClipEvent view_of(const ClipEvent& event) {
  return {event.tick, view_of(event.name), event.value, 0};
}

/// The kernels of a MIEN_ISA_...; null with an error if there are none.
MienStatus find_kernels(uint32_t isa, const KernelTable*& out, MienError* error);

/// What MIEN_REUSE_... adds to a new rig. On failure releases it and sets it to null.
Status set_reuse(uint32_t reuse, Rig*& rig, Error& error);

/// Ends a call that creates an object: passes it to the caller, or the error.
template <class Handle>
MienStatus give_object(Status status, typename ObjectOf<Handle>::type* made, const Error& detail,
                       Handle** out, MienError* error) {
  if (status != Status::kOk) return give_error(detail, error);
  *out = reinterpret_cast<Handle*>(made);
  return succeed(error);
}

/// The handle ends; its object stays as long as others own it. Null and handles of other kinds are ignored.
template <class Handle>
void destroy(Handle* handle) {
  if (check(handle) != MIEN_OK) return;
  object(handle)->tag = 0;
  release(object(handle));
}

/// Ends a call that reports an error of the runtime, if there is one.
inline MienStatus give_status(Status status, const Error& detail, MienError* error) {
  return status == Status::kOk ? succeed(error) : give_error(detail, error);
}

}  // namespace mien::capi
