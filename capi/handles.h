// SPDX-License-Identifier: MIT
// Conversion between handles and objects, and the checks that every entry point begins with.
#pragma once

#include <cstring>

#include "capi/arguments/arguments.h"
#include "runtime/anim/binding.h"
#include "runtime/anim/clip_builder.h"
#include "runtime/anim/clip_sampler.h"
#include "runtime/baked/baked_file.h"
#include "runtime/base/arena.h"
#include "runtime/deform/deformer_instance.h"
#include "runtime/eval/batch.h"
#include "runtime/eval/instance.h"
#include "runtime/mix/gaze.h"
#include "runtime/mix/mixer.h"
#include "simd/isa.h"

// Tags come first in every object and identify the kind. Destroyed handles are not detected: a table of ids
// with generations takes 0.2 to 0.6 ns more per handle than a tag (1.8 ns), but the object may be destroyed
// right after the look-up. Pinning it for the call takes 13 to 21 ns and needs a lock to create handles.
constexpr uint32_t kDnaTag = 0x6D44'4E41;
constexpr uint32_t kReportTag = 0x6D52'5054;
constexpr uint32_t kRigTag = 0x6D52'4947;
constexpr uint32_t kInstanceTag = 0x6D49'4E53;
constexpr uint32_t kBatchTag = 0x6D42'4154;
constexpr uint32_t kDeformerTag = 0x6D44'4652;
constexpr uint32_t kDeformerInstanceTag = 0x6D50'4F53;
constexpr uint32_t kBakedTag = 0x6D42'414B;
constexpr uint32_t kClipTag = 0x6D43'4C50;
constexpr uint32_t kClipPlayerTag = 0x6D43'504C;
constexpr uint32_t kClipBindingTag = 0x6D43'424E;
constexpr uint32_t kMixTag = 0x6D4D'4958;
constexpr uint32_t kGazeTag = 0x6D47'415A;
constexpr uint32_t kMixerTag = 0x6D4D'5852;
constexpr uint32_t kSolverStackTag = 0x6D53'4F4C;
constexpr uint32_t kSolverStateTag = 0x6D53'5354;

// One block, with the reports after it; the bytes are the caller's, mapped, or a separate block.
struct MienClip {
  uint32_t tag = 0;
  mien::Allocator allocator;
  size_t block_size = 0;
  mutable std::atomic<uint32_t> owners{1};  // the creator and every player
  mien::MappedFile file;
  mien::ClipBytes own;
  mien::Clip view;
  mien::Span<mien::ChannelReport> reports;  // of a clip that was built here, otherwise none
};

struct MienClipPlayer {
  uint32_t tag = 0;
  mien::Allocator allocator;
  size_t block_size = 0;
  const MienClip* clip = nullptr;
  mien::ClipSampler sampler;
  mien::EventRange events;  // passed by the last advance
};

struct MienClipBinding {
  uint32_t tag = 0;
  mien::Allocator allocator;
  mien::Binding* binding = nullptr;
};

struct MienGaze {
  uint32_t tag;
  mien::Allocator allocator;
  uint32_t raw_count;  // of the rig
  mien::GazeTable table;
};

namespace mien::capi {

inline Rig* object(MienRig* handle) { return reinterpret_cast<Rig*>(handle); }
inline const Rig* object(const MienRig* handle) { return reinterpret_cast<const Rig*>(handle); }
inline Instance* object(MienInstance* handle) { return reinterpret_cast<Instance*>(handle); }
inline const Instance* object(const MienInstance* handle) {
  return reinterpret_cast<const Instance*>(handle);
}
inline Batch* object(MienBatch* handle) { return reinterpret_cast<Batch*>(handle); }
inline Baked* object(MienBaked* handle) { return reinterpret_cast<Baked*>(handle); }
inline const Baked* object(const MienBaked* handle) {
  return reinterpret_cast<const Baked*>(handle);
}
inline Deformer* object(MienDeformer* handle) { return reinterpret_cast<Deformer*>(handle); }
inline const Deformer* object(const MienDeformer* handle) {
  return reinterpret_cast<const Deformer*>(handle);
}
inline Mix* object(MienMix* handle) { return reinterpret_cast<Mix*>(handle); }
inline const Mix* object(const MienMix* handle) { return reinterpret_cast<const Mix*>(handle); }
inline Mixer* object(MienMixer* handle) { return reinterpret_cast<Mixer*>(handle); }
inline const Mixer* object(const MienMixer* handle) {
  return reinterpret_cast<const Mixer*>(handle);
}
inline DeformerInstance* object(MienDeformerInstance* handle) {
  return reinterpret_cast<DeformerInstance*>(handle);
}
inline const DeformerInstance* object(const MienDeformerInstance* handle) {
  return reinterpret_cast<const DeformerInstance*>(handle);
}

inline MienStatus check_tag(const void* handle, uint32_t tag) {
  if (!handle) return MIEN_ERROR_NULL_ARGUMENT;
  if (reinterpret_cast<uintptr_t>(handle) % alignof(uint32_t) != 0) return MIEN_ERROR_HANDLE;
  uint32_t found;
  memcpy(&found, handle, sizeof(found));
  return found == tag ? MIEN_OK : MIEN_ERROR_HANDLE;
}
inline MienStatus check(const MienDna* dna) { return check_tag(dna, kDnaTag); }
inline MienStatus check(const MienReport* report) { return check_tag(report, kReportTag); }
inline MienStatus check(const MienRig* rig) { return check_tag(rig, kRigTag); }
inline MienStatus check(const MienInstance* instance) { return check_tag(instance, kInstanceTag); }
inline MienStatus check(const MienBatch* batch) { return check_tag(batch, kBatchTag); }
inline MienStatus check(const MienBaked* baked) { return check_tag(baked, kBakedTag); }
inline MienStatus check(const MienDeformer* deformer) { return check_tag(deformer, kDeformerTag); }
inline MienStatus check(const MienDeformerInstance* instance) {
  return check_tag(instance, kDeformerInstanceTag);
}
inline MienStatus check(const MienClip* clip) { return check_tag(clip, kClipTag); }
inline MienStatus check(const MienClipPlayer* player) { return check_tag(player, kClipPlayerTag); }
inline MienStatus check(const MienGaze* gaze) { return check_tag(gaze, kGazeTag); }
inline MienStatus check(const MienMix* mix) { return check_tag(mix, kMixTag); }
inline MienStatus check(const MienMixer* mixer) { return check_tag(mixer, kMixerTag); }
inline MienStatus check(const MienClipBinding* binding) {
  return check_tag(binding, kClipBindingTag);
}

/// The same for calls that report errors; `name` is that of the parameter.
template <class Handle>
MienStatus check(const Handle* handle, const char* name, MienError* error) {
  const MienStatus status = check(handle);
  if (status == MIEN_OK) return MIEN_OK;
  if (!handle) return give_error(error, status, "%s is NULL", name);
  return give_error(error, status, "%s is a handle of another kind, or none", name);
}

/// The kernels of a MIEN_ISA_...; null with an error if there are none.
MienStatus find_kernels(uint32_t isa, const KernelTable*& out, MienError* error);

/// Drops one owner of a clip; the last one releases it.
void release_clip_handle(const MienClip* clip);

}  // namespace mien::capi
