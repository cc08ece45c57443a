// SPDX-License-Identifier: MIT
#include "integrations/program/io/bound_clip.h"

#include <set>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

/// As bindings compare names.
std::string folded_name(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '.') c = '_';
  }
  return name;
}

std::set<std::string> folded_names(const MatchedNames& matched) {
  std::set<std::string> names;
  for (const auto& [name, match] : matched.given()) names.insert(folded_name(name));
  return names;
}

/// Before the names of the file, in the clip that is bound: no control has such a name, so these channels drive what
/// the file says, and nothing else.
constexpr const char* kGiven = "(--names) ";

/// A clip for the binding, with the channels of `clip`; null if none has a name of the file.
Clip rename_given(const MienClip* clip, const MatchedNames& matched, const std::string& shown) {
  constexpr const char* kCannot = "cannot bind clip";
  const std::set<std::string> given = folded_names(matched);
  auto info = sized<MienClipInfo>();
  check(mien_clip_info(clip, &info), nullptr, kCannot, shown);
  std::vector<std::string> names;
  // Two frames, in which the same channels change as in the clip.
  std::vector<float> frames(2 * size_t{info.channel_count});
  bool has_given = false;
  for (uint32_t c = 0; c < info.channel_count; ++c) {
    auto channel = sized<MienClipChannel>();
    check(mien_clip_channel(clip, c, &channel), nullptr, kCannot, shown);
    names.push_back(to_string(channel.name));
    frames[info.channel_count + c] = channel.is_changing ? 1.f : 0.f;
    if (given.count(folded_name(names.back())) == 0) continue;
    names.back() = kGiven + names.back();
    has_given = true;
  }
  if (!has_given) return nullptr;
  std::vector<MienStringView> views;
  for (const std::string& name : names) views.push_back({name.data(), name.size()});
  auto desc = sized<MienClipDesc>();
  desc.frame_count = 2;
  desc.channel_count = info.channel_count;
  desc.names = views.data();
  desc.values = frames.data();
  auto error = sized<MienError>();
  MienClip* built = nullptr;
  check(mien_clip_build(&desc, &built, &error), &error, kCannot, shown);
  return Clip(built);
}

/// A channel and what it drives.
struct Entries {
  std::vector<std::string> channels;  // of the file
  std::vector<MienMatrixEntry> matrix;
};

/// Names of the file, with controls as the rig spells them, then those of ARKit that it does not have.
Entries entries_on_rig(const MienRig* rig, const NamesFile& names, const MatchedNames& matched) {
  Entries entries;
  for (const auto& [name, match] : matched.given()) entries.channels.push_back(kGiven + name);
  size_t n = 0;
  for (const auto& [name, match] : matched.given()) {
    const std::string& channel = entries.channels[n++];
    for (const MienControlShare& share : match.shares) {
      MienStringView control{};
      check(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, share.control, &control), nullptr,
            "cannot use names", names.shown());
      entries.matrix.push_back({{channel.data(), channel.size()}, control, share.weight, 0});
    }
  }
  const std::set<std::string> given = folded_names(matched);
  for (const MienMatrixEntry& entry : arkit_matrix()) {
    if (given.count(folded_name(to_string(entry.channel))) == 0) entries.matrix.push_back(entry);
  }
  return entries;
}

/// What each channel alone does to the raw controls, as the binding says.
void note_bound(const MienClip* clip, const MienRig* rig, const MienClipBinding* binding,
                MatchedNames& matched, const std::string& shown, const Session& session) {
  // Made to be slow, not to be read.
  constexpr size_t kMostLookedAt = size_t{1} << 24;
  const MienClipBindingInfo info = binding_info(binding);
  if (size_t{info.channel_count} * info.raw_control_count > kMostLookedAt) return;
  std::set<std::string> gui_names;
  for (uint32_t i = 0; i < rig_count(rig, MIEN_KIND_GUI_CONTROL); ++i) {
    gui_names.insert(folded_name(rig_name(rig, MIEN_KIND_GUI_CONTROL, i)));
  }
  std::vector<float> values(info.channel_count), rest(info.raw_control_count), raw(rest);
  const auto apply = [&](std::vector<float>& out) {
    check(mien_clip_binding_apply(binding, values.data(), values.size(), out.data(), out.size()),
          nullptr, "cannot bind clip", shown);
  };
  apply(rest);
  for (uint32_t c = 0; c < info.channel_count; ++c) {
    auto channel = sized<MienClipChannel>();
    check(mien_clip_channel(clip, c, &channel), nullptr, "cannot bind clip", shown);
    const std::string name = to_string(channel.name);
    if (gui_names.count(folded_name(name)) != 0 && !matched.is_given(name)) continue;
    values[c] = 1;
    apply(raw);
    values[c] = 0;
    MatchedName bound;
    for (size_t i = 0; i < info.controls.count; ++i) {
      const uint16_t control = info.controls.data[i];
      const float share = raw[control] - rest[control];
      if (share != 0) bound.shares.push_back({control, share});
    }
    matched.keep(name, bound);
  }
  matched.note_matched(shown, session);
}

}  // namespace

MienClipBindingInfo binding_info(const MienClipBinding* binding) {
  auto info = sized<MienClipBindingInfo>();
  check(mien_clip_binding_info(binding, &info), nullptr, "cannot bind clip", "");
  return info;
}

ClipBinding bind_clip(const MienClip* clip, const MienRig* rig, const NamesFile& names,
                      const char* what, const std::string& shown, const Session& session) {
  MatchedNames matched(rig, names, what);
  const Clip renamed = rename_given(clip, matched, shown);
  const Entries entries = entries_on_rig(rig, names, matched);
  auto desc = sized<MienClipBindingDesc>();
  desc.matrix = entries.matrix.data();
  desc.matrix_count = entries.matrix.size();
  auto error = sized<MienError>();
  MienClipBinding* bound = nullptr;
  check(mien_clip_binding_create(renamed ? renamed.get() : clip, rig, &desc, &bound, &error),
        &error, what, shown);
  ClipBinding binding(bound);
  note_bound(clip, rig, bound, matched, shown, session);
  return binding;
}

}  // namespace mien::cli
