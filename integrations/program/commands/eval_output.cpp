// SPDX-License-Identifier: MIT
#include "integrations/program/commands/eval_output.h"

#include <charconv>
#include <cmath>
#include <vector>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/npy_writer.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct OutputArray {
  const char* key;
  MienStatus (*view)(const MienInstance*, MienFloatView*);
};

// Behind the raw controls.
constexpr OutputArray kAllArrays[] = {
    {"psd", mien_instance_psd_controls},          {"ml", mien_instance_ml_controls},
    {"rbf", mien_instance_rbf_controls},          {"joints", mien_instance_joints},
    {"blend_shapes", mien_instance_blend_shapes}, {"animated_maps", mien_instance_animated_maps},
};

constexpr OutputArray kResults[] = {
    {"joints", mien_instance_joints},
    {"blend_shapes", mien_instance_blend_shapes},
    {"animated_maps", mien_instance_animated_maps},
};
constexpr uint32_t kResultKinds[] = {MIEN_KIND_JOINT, MIEN_KIND_BLEND_SHAPE_CHANNEL,
                                     MIEN_KIND_ANIMATED_MAP};

constexpr const char* kEulerValues[] = {"tx", "ty", "tz", "rx", "ry", "rz", "sx", "sy", "sz"};
constexpr const char* kQuaternionValues[] = {"tx", "ty", "tz", "qx", "qy",
                                             "qz", "qw", "sx", "sy", "sz"};

MienFloatView view_of(const OutputArray& array, const MienInstance* instance) {
  MienFloatView view{};
  check(array.view(instance, &view), nullptr, "cannot read outputs", "");
  return view;
}

bool has_quaternions(const MienRigInfo& info) {
  return info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION;
}

size_t values_per_joint(const MienRigInfo& info) { return has_quaternions(info) ? 10 : 9; }

/// Common to all formats: the rig, and failures that name their place.
class BaseWriter : public EvalWriter {
 public:
  explicit BaseWriter(Output& output) : output_(output) {}

  void begin(const MienRig* rig, const EvalHeading& heading, size_t rows) override {
    rig_ = rig;
    shown_ = heading.shown;
    info_ = rig_info(rig);
    begin_file(heading, rows);
  }

 protected:
  virtual void begin_file(const EvalHeading& heading, size_t rows) = 0;

  [[noreturn]] void fail_value(size_t frame, uint32_t lod, const char* key, size_t index) const {
    fail(kInvalid, "cannot evaluate",
         shown_ + ", frame " + std::to_string(frame) + ", LOD " + std::to_string(lod) + ", " + key +
             "[" + std::to_string(index) + "]",
         "the result is not a finite number", "give smaller controls; they are usually in 0..1");
  }

  void write_array(JsonWriter& json, size_t frame, uint32_t lod, const char* key,
                   MienFloatView view) const {
    json.key(key);
    const size_t written = json.floats(view.data, view.count);
    if (written != view.count) fail_value(frame, lod, key, written);
  }

  /// rig, version, lod_count, rotation, arithmetic.
  void write_heading(JsonWriter& json, const EvalHeading& heading) const {
    for (const auto& [key, text] : {std::pair<const char*, const std::string&>{"rig", heading.name},
                                    {"version", heading.version}}) {
      json.key(key);
      if (heading.baked) {
        json.null();
      } else {
        json.value(text);
      }
    }
    json.member("lod_count", info_.lod_count);
    json.member("rotation", has_quaternions(info_) ? "quaternion" : "euler");
    json.member("arithmetic", arithmetic_word(info_));
  }

  Output& output_;
  const MienRig* rig_ = nullptr;
  MienRigInfo info_{};
  std::string shown_;
};

class JsonOutput : public BaseWriter {
 public:
  explicit JsonOutput(Output& output) : BaseWriter(output), json_(output) {}

  void begin_file(const EvalHeading& heading, size_t) override {
    json_.begin_object(JsonWriter::Layout::kLines);
    write_heading(json_, heading);
    json_.key("frames");
    json_.begin_array(JsonWriter::Layout::kLines);
  }

  void write(size_t frame, uint32_t lod, const MienInstance* instance) override {
    if (!in_frame_ || frame != frame_) {
      end_frame();
      json_.begin_object(JsonWriter::Layout::kLines);
      json_.key("lods");
      json_.begin_array(JsonWriter::Layout::kLines);
      in_frame_ = true;
      frame_ = frame;
    }
    json_.begin_object();
    json_.member("lod", lod);
    MienFloatView controls{};
    check(mien_instance_controls(instance, &controls), nullptr, "cannot read outputs", "");
    controls.count = rig_count(rig_, MIEN_KIND_RAW_CONTROL);  // they come first
    write_array(json_, frame, lod, "raw", controls);
    for (const OutputArray& array : kAllArrays) {
      write_array(json_, frame, lod, array.key, view_of(array, instance));
    }
    json_.end_object();
  }

  void end() override {
    end_frame();
    json_.end_array();
    json_.end_object();
    json_.finish();
  }

 private:
  void end_frame() {
    if (!in_frame_) return;
    json_.end_array();
    json_.end_object();
  }

  JsonWriter json_;
  bool in_frame_ = false;
  size_t frame_ = 0;
};

/// A line with the names, then a line for each frame and LOD.
class JsonLinesOutput : public BaseWriter {
 public:
  using BaseWriter::BaseWriter;

  void begin_file(const EvalHeading& heading, size_t) override {
    JsonWriter json(output_);
    json.begin_object();
    write_heading(json, heading);
    for (size_t i = 0; i < std::size(kResults); ++i) {
      json.key(kResults[i].key);
      json.begin_array();
      for (uint32_t n = 0; n < rig_count(rig_, kResultKinds[i]); ++n) {
        json.value(rig_name(rig_, kResultKinds[i], n));
      }
      json.end_array();
    }
    json.end_object();
    json.finish();
  }

  void write(size_t frame, uint32_t lod, const MienInstance* instance) override {
    JsonWriter json(output_);
    json.begin_object();
    json.member("frame", uint64_t{frame});
    json.member("lod", lod);
    for (const OutputArray& array : kResults) {
      write_array(json, frame, lod, array.key, view_of(array, instance));
    }
    json.end_object();
    json.finish();
  }

  void end() override {}
};

class CsvOutput : public BaseWriter {
 public:
  using BaseWriter::BaseWriter;

  void begin_file(const EvalHeading&, size_t) override {
    std::string line = "frame,lod";
    for (uint32_t joint = 0; joint < rig_count(rig_, MIEN_KIND_JOINT); ++joint) {
      const std::string name = rig_name(rig_, MIEN_KIND_JOINT, joint);
      for (size_t v = 0; v < values_per_joint(info_); ++v) {
        const char* value = has_quaternions(info_) ? kQuaternionValues[v] : kEulerValues[v];
        line += "," + csv_field(name + "." + value);
      }
    }
    for (const uint32_t kind : {MIEN_KIND_BLEND_SHAPE_CHANNEL, MIEN_KIND_ANIMATED_MAP}) {
      for (uint32_t n = 0; n < rig_count(rig_, kind); ++n) {
        line += "," + csv_field(rig_name(rig_, kind, n));
      }
    }
    output_.write(line + "\n");
  }

  void write(size_t frame, uint32_t lod, const MienInstance* instance) override {
    std::string line = std::to_string(frame) + "," + std::to_string(lod);
    for (const OutputArray& array : kResults) {
      const MienFloatView view = view_of(array, instance);
      for (size_t i = 0; i < view.count; ++i) {
        if (!std::isfinite(view.data[i])) fail_value(frame, lod, array.key, i);
        char digits[32];
        // As a double, so that readers who keep doubles see the very number, too.
        const auto end =
            std::to_chars(digits, digits + sizeof(digits), static_cast<double>(view.data[i])).ptr;
        line += ',';
        line.append(digits, end);
      }
    }
    output_.write(line + "\n");
  }

  void end() override {}
};

/// Joints as an array of NumPy: [frame and LOD][joint][value], 32-bit floats.
class NpyOutput : public BaseWriter {
 public:
  using BaseWriter::BaseWriter;

  void begin_file(const EvalHeading&, size_t rows) override {
    write_npy_header({rows, rig_count(rig_, MIEN_KIND_JOINT), values_per_joint(info_)}, output_);
  }

  void write(size_t frame, uint32_t lod, const MienInstance* instance) override {
    const MienFloatView view = view_of(kResults[0], instance);
    const size_t written = write_npy_floats(view.data, view.count, output_);
    if (written != view.count) fail_value(frame, lod, kResults[0].key, written);
  }

  void end() override {}
};

}  // namespace

std::unique_ptr<EvalWriter> make_eval_writer(EvalFormat format, Output& output) {
  switch (format) {
    case EvalFormat::kJsonLines: return std::make_unique<JsonLinesOutput>(output);
    case EvalFormat::kCsv: return std::make_unique<CsvOutput>(output);
    case EvalFormat::kNpy: return std::make_unique<NpyOutput>(output);
    case EvalFormat::kJson: break;
  }
  return std::make_unique<JsonOutput>(output);
}

}  // namespace mien::cli
