// SPDX-License-Identifier: MIT
#include "integrations/program/diff/dna_diff.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "integrations/program/diff/evaluation_diff.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct NameList {
  const char* kind;
  uint32_t rig_kind;
  const char* path;
};

constexpr NameList kNameLists[] = {
    {"GUI controls", MIEN_KIND_GUI_CONTROL, "defn.guiControlNames"},
    {"raw controls", MIEN_KIND_RAW_CONTROL, "defn.rawControlNames"},
    {"joints", MIEN_KIND_JOINT, "defn.jointNames"},
    {"blend shapes", MIEN_KIND_BLEND_SHAPE_CHANNEL, "defn.blendShapeChannelNames"},
    {"animated maps", MIEN_KIND_ANIMATED_MAP, "defn.animatedMapNames"},
    {"meshes", MIEN_KIND_MESH, "defn.meshNames"},
};

bool find_field(const MienDna* dna, const std::string& path, MienDnaField& field) {
  field = sized<MienDnaField>();
  return mien_dna_field(dna, path.c_str(), &field, nullptr) == MIEN_OK;
}

std::string string_at(const MienDna* dna, const std::string& path) {
  MienStringView view{};
  check(mien_dna_read_string(dna, path.c_str(), &view, nullptr), nullptr, "cannot read " + path,
        "");
  return to_string(view);
}

std::vector<std::string> read_names(const MienDna* dna, const std::string& path) {
  MienDnaField field;
  std::vector<std::string> names;
  if (!find_field(dna, path, field)) return names;
  for (uint64_t i = 0; i < field.count; ++i) names.push_back(string_at(dna, element(path, i)));
  return names;
}

using Indices = std::unordered_map<std::string, size_t>;

Indices indices_of(const std::vector<std::string>& names) {
  Indices indices;
  for (size_t i = 0; i < names.size(); ++i) indices.emplace(names[i], i);
  return indices;
}

NameChanges compare_names(const char* kind, const std::vector<std::string>& before,
                          const std::vector<std::string>& after) {
  NameChanges changes;
  changes.kind = kind;
  const Indices old_indices = indices_of(before), new_indices = indices_of(after);
  const auto gone = [&](size_t i) { return new_indices.find(before[i]) == new_indices.end(); };
  const auto fresh = [&](size_t i) { return old_indices.find(after[i]) == old_indices.end(); };
  // In lists of one length a name that went and one that came at its place are the same element.
  const bool same_count = before.size() == after.size();
  for (size_t i = 0; i < before.size(); ++i) {
    if (!gone(i)) continue;
    if (same_count && fresh(i))
      changes.renamed.emplace_back(before[i], after[i]);
    else
      changes.removed.push_back(before[i]);
  }
  size_t last = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    if (fresh(i)) {
      if (!same_count || !gone(i)) changes.added.push_back(after[i]);
      continue;
    }
    const size_t at = old_indices.at(after[i]);
    changes.reordered = changes.reordered || at < last;
    last = std::max(last, at);
  }
  return changes;
}

/// Compares field by field; numbers in deep lists add up.
class FieldComparison {
 public:
  FieldComparison(const MienDna* before, const MienDna* after) : before_(before), after_(after) {}

  void compare(const std::string& path, const std::string& shown);

  std::vector<FieldChange> take() { return std::move(changes_); }

 private:
  FieldChange& change(const std::string& shown, FieldChange::Kind kind);
  void compare_children(const std::string& path, const std::string& shown,
                        const MienDnaField& field);
  void compare_numbers(const std::string& path, const std::string& shown, bool floats,
                       uint64_t count);

  const MienDna* before_;
  const MienDna* after_;
  std::vector<FieldChange> changes_;
  std::map<std::pair<std::string, int>, size_t> places_;  // in changes_
  std::vector<float> old_floats_, new_floats_;
  std::vector<int64_t> old_integers_, new_integers_;
};

FieldChange& FieldComparison::change(const std::string& shown, FieldChange::Kind kind) {
  const auto [found, is_new] = places_.emplace(std::make_pair(shown, int{kind}), changes_.size());
  if (is_new) {
    changes_.emplace_back();
    changes_.back().path = shown;
    changes_.back().kind = kind;
  }
  return changes_[found->second];
}

void FieldComparison::compare(const std::string& path, const std::string& shown) {
  MienDnaField old_field, new_field;
  const bool in_before = find_field(before_, path, old_field);
  const bool in_after = find_field(after_, path, new_field);
  if (in_before != in_after) change(shown, in_after ? FieldChange::kAdded : FieldChange::kRemoved);
  if (!in_before || !in_after) return;
  if (old_field.type == MIEN_FIELD_STRING) {
    const std::string from = string_at(before_, path), to = string_at(after_, path);
    if (from == to) return;
    FieldChange& found = change(shown, FieldChange::kText);
    ++found.changed;
    found.from = from;
    found.to = to;
    return;
  }
  if (old_field.count != new_field.count) {
    FieldChange& found = change(shown, FieldChange::kCount);
    ++found.changed;
    found.from = grouped(old_field.count);
    found.to = grouped(new_field.count);
    return;
  }
  if (old_field.type == MIEN_FIELD_RECORD || old_field.type == MIEN_FIELD_LIST) {
    compare_children(path, shown, old_field);
  } else if (old_field.count != 0) {
    compare_numbers(path, shown, old_field.type == MIEN_FIELD_F32, old_field.count);
  }
}

void FieldComparison::compare_children(const std::string& path, const std::string& shown,
                                       const MienDnaField& field) {
  if (field.type == MIEN_FIELD_LIST) {
    // The first index stays, so that meshes and joint groups can be told apart.
    const bool deep = shown.find('[') != std::string::npos;
    for (uint64_t i = 0; i < field.count; ++i) {
      compare(element(path, i), deep ? shown + "[]" : element(shown, i));
    }
    return;
  }
  for (uint32_t i = 0; i < field.count; ++i) {
    MienStringView name{};
    check(mien_dna_child_name(before_, path.c_str(), i, &name, nullptr), nullptr,
          "cannot read " + path, "");
    const std::string rest = (path.empty() ? "" : ".") + to_string(name);
    compare(path + rest, shown + rest);
  }
}

void FieldComparison::compare_numbers(const std::string& path, const std::string& shown,
                                      bool floats, uint64_t count) {
  const auto compare_all = [&](auto& from, auto& to, auto read) {
    from.resize(count);
    to.resize(count);
    check(read(before_, path.c_str(), 0, count, from.data(), nullptr), nullptr,
          "cannot read " + path, "");
    check(read(after_, path.c_str(), 0, count, to.data(), nullptr), nullptr, "cannot read " + path,
          "");
    if (std::memcmp(from.data(), to.data(), count * sizeof(from[0])) == 0) return;
    FieldChange& found = change(shown, FieldChange::kNumbers);
    for (uint64_t i = 0; i < count; ++i) {
      if (std::memcmp(&from[i], &to[i], sizeof(from[i])) == 0) continue;
      ++found.changed;
      const double difference = std::abs(static_cast<double>(to[i]) - static_cast<double>(from[i]));
      found.largest = std::max(found.largest, difference);
    }
  };
  if (floats)
    compare_all(old_floats_, new_floats_, mien_dna_read_floats);
  else
    compare_all(old_integers_, new_integers_, mien_dna_read_integers);
}

}  // namespace

DnaDiff diff_dna(const MienDna* before, const MienDna* after) {
  DnaDiff diff;
  RenamedByKind renamed;
  for (const NameList& list : kNameLists) {
    NameChanges changes =
        compare_names(list.kind, read_names(before, list.path), read_names(after, list.path));
    renamed[list.rig_kind].insert(changes.renamed.begin(), changes.renamed.end());
    if (changes.any()) diff.names.push_back(std::move(changes));
  }
  FieldComparison fields(before, after);
  fields.compare("", "");
  diff.fields = fields.take();
  if (diff.any()) diff_evaluation(before, after, renamed, diff);
  return diff;
}

}  // namespace mien::cli
