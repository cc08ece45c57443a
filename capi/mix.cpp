// SPDX-License-Identifier: MIT
// The section "Mix" of mien/mix.h; mix_file.cpp and mix_probe.cpp have its files and measurements.
#include "capi/handles.h"
#include "runtime/mix/mix_fields.h"
#include "runtime/probe/probe_guards.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_LAYER_GROUP_LIFE == int(LayerGroup::kLife) &&
                  MIEN_BLEND_MODE_SCALE == int(BlendMode::kScale) &&
                  MIEN_LAYER_SOURCE_GENERATOR == int(LayerSource::kGenerator) &&
                  MIEN_GENERATOR_GAZE == int(Generator::kGaze) &&
                  MIEN_RETRIGGER_IGNORE == int(Retrigger::kIgnore),
              "mix.h and mien.h number the same choices");

namespace {

/// Takes the numbers of a caller's struct. Choices that do not exist become one past the last, which
/// create_mix() refuses.
struct TakeFields : SkipsLists {
  template <class T, class From>
  void value(Field, const Limits& limits, T& to, From from) {
    const bool left_out = limits.default_value != 0 && from == 0;
    to = left_out ? static_cast<T>(limits.default_value) : static_cast<T>(from);
  }
  template <class T, size_t N>
  void choice(Field, const char* const (&)[N], T& to, uint32_t from) {
    to = static_cast<T>(from < N ? from : N);
  }
};

/// Gives numbers back.
struct GiveFields : SkipsLists {
  template <class T, class To>
  void value(Field, const Limits&, T from, To& to) {
    to = static_cast<To>(from);
  }
  template <class T, class Names>
  void choice(Field, const Names&, T from, uint32_t& to) {
    to = static_cast<uint32_t>(from);
  }
};

/// The caller's lists in the form of the mix, in memory that lasts for the call.
struct MixLists {
  Span<LayerDesc> layers;
  Span<PoseDesc> poses;
  Span<ReactionDesc> reactions;
  Span<Stroke> strokes;
  Span<AntagonistPair> antagonists;

  bool allocate(Arena& arena, const MienMixDesc& desc) {
    size_t stroke_count = 0;
    for (size_t i = 0; i < desc.reaction_count; ++i) stroke_count += desc.reactions[i].stroke_count;
    layers = arena.array<LayerDesc>(desc.layer_count);
    poses = arena.array<PoseDesc>(desc.pose_count);
    reactions = arena.array<ReactionDesc>(desc.reaction_count);
    strokes = arena.array<Stroke>(stroke_count);
    antagonists = arena.array<AntagonistPair>(desc.antagonist_count);
    return layers.count == desc.layer_count && poses.count == desc.pose_count &&
           reactions.count == desc.reaction_count && strokes.count == stroke_count &&
           antagonists.count == desc.antagonist_count;
  }

  void fill(const MienMixDesc& desc) {
    TakeFields take;
    for (size_t i = 0; i < desc.layer_count; ++i) {
      const MienMixLayer& from = desc.layers[i];
      visit_fields(take, layers[i], from);
      layers[i].after_guards = from.after_guards != 0;
      layers[i].mask = {from.mask, from.mask ? from.mask_count : 0};
      layers[i].curves = {from.curves, from.curve_count};
      layers[i].amounts = {from.amounts, from.amounts ? from.curve_count : 0};
    }
    for (size_t i = 0; i < desc.pose_count; ++i) {
      const MienMixPose& from = desc.poses[i];
      poses[i] = {{from.curves, from.count}, {from.values, from.count}};
    }
    size_t first = 0;
    for (size_t i = 0; i < desc.reaction_count; ++i) {
      const MienMixReaction& from = desc.reactions[i];
      visit_fields(take, reactions[i], from);
      const Span<Stroke> list = strokes.slice(first, from.stroke_count);
      for (size_t s = 0; s < list.count; ++s) visit_fields(take, list[s], from.strokes[s]);
      reactions[i].strokes = list;
      first += list.count;
    }
    for (size_t i = 0; i < desc.antagonist_count; ++i) {
      visit_fields(take, antagonists[i], desc.antagonists[i]);
    }
  }
};

constexpr uint32_t kMaxLandmarkPoints = 65536;

/// What create_mix() cannot check: arrays that are NULL, counts before memory for them, reserved fields.
MienStatus check_mix_desc(const MienMixDesc& desc, MienError* error) {
  if ((!desc.layers && desc.layer_count != 0) || (!desc.poses && desc.pose_count != 0) ||
      (!desc.reactions && desc.reaction_count != 0) ||
      (!desc.antagonists && desc.antagonist_count != 0) || (!desc.lower != !desc.upper) ||
      (!desc.custom_guards && desc.custom_guard_count != 0) ||
      (!desc.deformer && ((desc.guards & MIEN_GUARD_ALL) != 0 || desc.custom_guard_count != 0))) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienMixDesc: an array is NULL, but its count is not 0; one of the limits is "
                      "NULL; or guards are not 0 without a deformer");
  }
  if (desc.layer_count > kMaxLayers || desc.pose_count > kMaxPoses ||
      desc.reaction_count > kMaxReactions || desc.antagonist_count > kMaxCurves ||
      desc.guards > MIEN_GUARD_ALL || desc.custom_guard_count > kMaxGuards || desc.reserved != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienMixDesc: too many layers, poses, reactions or antagonists, unknown "
                      "guards, or .reserved is not 0");
  }
  for (size_t i = 0; i < desc.layer_count; ++i) {
    const MienMixLayer& layer = desc.layers[i];
    if (!layer.curves && layer.curve_count != 0) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "layer %zu: curves is NULL", i);
    }
    if (layer.reserved != 0) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "layer %zu: reserved is not 0", i);
    }
  }
  for (size_t i = 0; i < desc.custom_guard_count; ++i) {
    const MienMixGuard& guard = desc.custom_guards[i];
    if (guard.upper.point_count <= kMaxLandmarkPoints &&
        guard.lower.point_count <= kMaxLandmarkPoints && guard.closed_by <= MIEN_NO_CONTROL) {
      continue;
    }
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "custom guard %zu: too many points, or closed_by is out of range", i);
  }
  for (size_t i = 0; i < desc.pose_count; ++i) {
    const MienMixPose& pose = desc.poses[i];
    if ((pose.curves && pose.values) || pose.count == 0) continue;
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "pose %zu: curves or values is NULL", i);
  }
  for (size_t i = 0; i < desc.reaction_count; ++i) {
    const MienMixReaction& reaction = desc.reactions[i];
    if (!reaction.strokes && reaction.stroke_count != 0) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "reaction %zu: strokes is NULL", i);
    }
    bool known = reaction.stroke_count <= kMaxStrokes && reaction.reserved == 0;
    for (size_t s = 0; known && s < reaction.stroke_count; ++s) {
      known = reaction.strokes[s].reserved == 0;
    }
    if (!known) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "reaction %zu: too many strokes, or reserved is not 0", i);
    }
  }
  return MIEN_OK;
}

static_assert(sizeof(kOfJoints) == 4 && kOfJoints == MIEN_NO_MESH &&
                  kNoControl == MIEN_NO_CONTROL && kStandardGuardCount < kMaxGuards &&
                  MIEN_GUARD_LIPS == int(kGuardsOfLips) && MIEN_GUARD_LIDS == int(kGuardsOfLids) &&
                  MIEN_GUARD_TEETH == int(kGuardsOfTeeth),
              "guards of the caller are those of the runtime");

Landmark landmark_of(const MienLandmark& from) {
  return {from.mesh, {from.points, from.points ? from.point_count : 0}};
}

GuardDesc guard_of(const MienMixGuard& from) {
  GuardDesc to;
  to.upper = landmark_of(from.upper);
  to.lower = landmark_of(from.lower);
  to.closed_by = from.closed_by < kNoControl ? static_cast<uint16_t>(from.closed_by) : kNoControl;
  to.tolerance = from.tolerance;
  to.f_on = from.f_on;
  to.needs_speech = from.needs_speech != 0;
  return to;
}

}  // namespace

MienStatus mien_mix_create(const MienRig* rig, const MienMixDesc* desc, MienMix** out_mix,
                           MienError* error) {
  if (MienStatus status = clear_output(out_mix, error)) return status;
  if (MienStatus status = check(rig)) return give_error(error, status, "not a rig");
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienMixDesc known;
  if (MienStatus status = read_desc(desc, known, "MienMixDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (MienStatus status = check_mix_desc(known, error)) return status;
  if (known.deformer) {
    if (MienStatus status = check(known.deformer)) {
      return give_error(error, status, "MienMixDesc.deformer is not a deformer");
    }
    if (object(known.deformer)->rig != object(rig)) {
      return give_error(error, MIEN_ERROR_MISMATCH, "MienMixDesc.deformer is of another rig");
    }
  }
  if (known.gaze) {
    if (MienStatus status = check(known.gaze)) {
      return give_error(error, status, "MienMixDesc.gaze is not a gaze");
    }
    if (object(known.gaze)->raw_count != object(rig)->raw_count) {
      return give_error(error, MIEN_ERROR_MISMATCH, "MienMixDesc.gaze is of another rig");
    }
  }

  Arena arena(allocator);
  MixLists lists;
  if (!lists.allocate(arena, known))
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a mix");
  lists.fill(known);
  const Rig& of = *object(rig);
  MixDesc mix;
  mix.kernels = of.kernels;
  mix.raw_count = of.raw_count;
  mix.names = of.names[static_cast<size_t>(Kind::kRawControl)];
  TakeFields take;
  visit_fields(take, mix, known);
  const size_t curves = size_t{of.raw_count} + known.variable_count;
  mix.layers = lists.layers;
  mix.poses = lists.poses;
  mix.reactions = lists.reactions;
  mix.antagonists = lists.antagonists;
  if (known.mirror) mix.mirror = {known.mirror, curves};
  if (known.lower) mix.lower = {known.lower, curves};
  if (known.upper) mix.upper = {known.upper, curves};
  mix.max_bound_gui = bound_gui_limit(of.gui_count);
  set_default_sizes(mix);
  Error detail;
  Guard guards[kMaxGuards];
  uint32_t guard_count = 0;
  if (known.guards != 0 || known.custom_guard_count != 0) {
    GuardDesc own[kMaxGuards];
    for (size_t g = 0; g < known.custom_guard_count; ++g) own[g] = guard_of(known.custom_guards[g]);
    const Status planned =
        plan_guards(*object(known.deformer), guard_kinds(known.guards),
                    {own, known.custom_guard_count}, allocator, guards, guard_count, detail);
    if (planned != Status::kOk) return give_error(detail, error);
  }
  mix.guards = {guards, guard_count};
  if (known.gaze) mix.gaze = &object(known.gaze)->table;
  Mix* made = nullptr;
  const Status status = create_mix(mix, allocator, made, detail);
  return give_object(status, made, detail, out_mix, error);
}

void mien_mix_destroy(MienMix* mix) { destroy(mix); }

MienStatus mien_mix_info(const MienMix* mix, MienMixInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(mix)) return status;
  const Mix& of = *object(mix);
  MienMixInfo info = {};
  info.raw_control_count = of.raw_count;
  info.variable_count = of.variable_count;
  info.curve_count = of.used_curves();
  info.layer_count = static_cast<uint32_t>(of.layers.count);
  info.stage_count = stage_count(of);
  info.guard_count = static_cast<uint32_t>(of.guards.count);
  info.mixer_bytes = mixer_size(of, false);
  info.snapshot_bytes = snapshot_size(of);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_mix_guard(const MienMix* mix, uint32_t guard_index, MienMixGuardInfo* out_guard) {
  if (MienStatus status = clear_struct(out_guard)) return status;
  if (MienStatus status = check(mix)) return status;
  const Span<const Guard> guards = object(mix)->guards;
  if (guard_index >= guards.count) return MIEN_ERROR_INDEX;
  const Guard& of = guards[guard_index];
  MienMixGuardInfo info = {};
  info.curves = {of.curves, of.count};
  info.gains = {of.gains, of.count};
  info.needs_speech = of.needs_speech;
  info.pair_count = of.pair_count;
  info.rest = of.rest;
  info.tolerance = of.tolerance;
  info.f_on = of.f_on;
  info.fit_error = of.fit_error;
  write_struct(out_guard, info);
  return MIEN_OK;
}

MienStatus mien_mix_glare(uint32_t first_pose, MienMixStroke* out_strokes, size_t stroke_count,
                          MienMixReaction* out_reaction) {
  if (out_reaction) *out_reaction = {};
  if (!out_strokes || !out_reaction) return MIEN_ERROR_NULL_ARGUMENT;
  if (stroke_count < kGlareStrokes) return MIEN_ERROR_INVALID_ARGUMENT;
  Stroke strokes[kGlareStrokes];
  glare_strokes(first_pose, strokes);
  ReactionDesc reaction = glare_reaction(strokes);
  GiveFields give;
  for (uint32_t i = 0; i < kGlareStrokes; ++i) {
    out_strokes[i] = {};
    visit_fields(give, strokes[i], out_strokes[i]);
  }
  visit_fields(give, reaction, *out_reaction);
  out_reaction->strokes = out_strokes;
  out_reaction->stroke_count = kGlareStrokes;
  return MIEN_OK;
}
