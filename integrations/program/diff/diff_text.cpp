// SPDX-License-Identifier: MIT
// A difference as text and as JSON.
#include <charconv>

#include "integrations/program/diff/dna_diff.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

std::string short_number(double number) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof(digits), number, std::chars_format::general, 3);
  return std::string(digits, end.ptr);
}

std::string quoted(const std::string& name) { return "\"" + one_line(name) + "\""; }

std::string names_text(const NameChanges& names) {
  std::string text;
  for (const auto& [from, to] : names.renamed) {
    text += names.kind + ": renamed " + quoted(from) + " to " + quoted(to) + "\n";
  }
  for (const std::string& name : names.removed) {
    text += names.kind + ": removed " + quoted(name) + "\n";
  }
  for (const std::string& name : names.added) {
    text += names.kind + ": added " + quoted(name) + "\n";
  }
  if (names.reordered) text += names.kind + ": in another order\n";
  return text;
}

std::string field_text(const FieldChange& field) {
  std::string text = field.path + ": ";
  switch (field.kind) {
    case FieldChange::kAdded: return text + "added\n";
    case FieldChange::kRemoved: return text + "removed\n";
    case FieldChange::kNumbers:
      text += grouped(field.changed) + (field.changed == 1 ? " number" : " numbers");
      return text + " by at most " + short_number(field.largest) + "\n";
    case FieldChange::kText:
      if (field.changed > 1) return text + grouped(field.changed) + " texts\n";
      return text + quoted(field.from) + " to " + quoted(field.to) + "\n";
    case FieldChange::kCount:
      if (field.changed > 1) {
        return text + "other numbers of elements in " + grouped(field.changed) + " lists\n";
      }
      return text + field.from + " to " + field.to + " elements\n";
  }
  return text;
}

std::string control_text(const ControlChange& control) {
  std::string text = "control " + quoted(control.control) + ": ";
  std::string parts;
  const auto add = [&parts](const char* what, double largest) {
    if (largest == 0) return;
    parts += (parts.empty() ? "" : ", ") + std::string(what) + " " + short_number(largest);
  };
  add("translation", control.translation);
  add("rotation", control.rotation);
  add("scale", control.scale);
  add("blend shape", control.blend_shape);
  add("animated map", control.animated_map);
  if (!control.joint.empty()) parts += "; most at joint " + quoted(control.joint);
  return text + parts + "\n";
}

void write_names(JsonWriter& json, const char* key, const std::vector<std::string>& names) {
  json.key(key);
  json.begin_array();
  for (const std::string& name : names) json.value(name);
  json.end_array();
}

void write_field(JsonWriter& json, const FieldChange& field) {
  static const char* const kWords[] = {"numbers", "text", "count", "added", "removed"};
  json.begin_object();
  json.member("path", field.path);
  json.member("change", kWords[field.kind]);
  if (field.kind == FieldChange::kNumbers) {
    json.member("changed", field.changed);
    json.key("largest");
    json.shortest(field.largest);
  } else if (field.kind == FieldChange::kText || field.kind == FieldChange::kCount) {
    json.member("changed", field.changed);
    json.member("from", field.from);
    json.member("to", field.to);
  }
  json.end_object();
}

void write_control(JsonWriter& json, const ControlChange& control) {
  json.begin_object();
  json.member("control", control.control);
  const auto number = [&json](const char* key, double value) {
    json.key(key);
    json.shortest(value);
  };
  number("translation", control.translation);
  number("rotation", control.rotation);
  number("scale", control.scale);
  number("blend_shape", control.blend_shape);
  number("animated_map", control.animated_map);
  json.member("joint", control.joint);
  json.end_object();
}

}  // namespace

std::string diff_text(const DnaDiff& diff) {
  std::string text;
  for (const NameChanges& names : diff.names) text += names_text(names);
  for (const FieldChange& field : diff.fields) text += field_text(field);
  for (const ControlChange& control : diff.controls) text += control_text(control);
  if (!text.empty() && diff.evaluated) {
    text += grouped(diff.controls.size()) + " of " + grouped(diff.compared_controls) +
            " raw controls evaluate differently\n";
  }
  return text;
}

void write_diff(const DnaDiff& diff, JsonWriter& json) {
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("same", !diff.any());
  json.key("names");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const NameChanges& names : diff.names) {
    json.begin_object();
    json.member("kind", names.kind);
    write_names(json, "added", names.added);
    write_names(json, "removed", names.removed);
    json.key("renamed");
    json.begin_array();
    for (const auto& [from, to] : names.renamed) {
      json.begin_array();
      json.value(from);
      json.value(to);
      json.end_array();
    }
    json.end_array();
    json.member("reordered", names.reordered);
    json.end_object();
  }
  json.end_array();
  json.key("fields");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const FieldChange& field : diff.fields) write_field(json, field);
  json.end_array();
  json.member("evaluated", diff.evaluated);
  json.member("compared_controls", diff.compared_controls);
  json.key("controls");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const ControlChange& control : diff.controls) write_control(json, control);
  json.end_array();
  json.end_object();
}

}  // namespace mien::cli
