// SPDX-License-Identifier: MIT
#include "integrations/program/commands/farm_job.h"

#if !defined(_WIN32)
#include <glob.h>
#endif

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/fingerprint.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

using FarmJson = nlohmann::ordered_json;

constexpr const char* kCannotFarm = "cannot read job";
constexpr const char* kFarmExample =
    R"(write {"rigs": ["head.dna"], "takes": ["*.clip"], "outputs": [...]})";
constexpr uint64_t kUsualBlock = 250;
constexpr int kFrameDigits = 6;

/// The faster of the two that give the same bits and of which every machine has one. See docs/numbers.md.
uint32_t portable_isa() {
  return mien_isa_available(MIEN_ISA_SSE2) ? MIEN_ISA_SSE2 : MIEN_ISA_SCALAR;
}

uint32_t parse_isa(const std::string& word) {
  if (word == "best") return MIEN_ISA_BEST;
  RigOptions options;
  options.isa = word;
  return parse_rig_options(options).isa;
}

const Words kFarmKinds = {"joints", "vertices", "glb", "png", "clip"};
const Words kJobKeys = {"rigs", "takes", "outputs", "lod", "rate", "block", "isa"};
// Of each kind, after "kind" and "path".
const Words kOutputKeys[] = {
    {},
    {"mesh"},
    {"influences"},
    {"camera", "target", "size", "background", "samples", "meshes"},
    {"solve", "mesh", "landmarks", "from", "controls"},
};

/// A value and where it is.
struct JobValue {
  const FarmJson& value;
  std::string where;

  [[noreturn]] void wrong(const std::string& why, const std::string& what_to_do) const {
    fail(kInvalid, kCannotFarm, where, why, what_to_do);
  }
  void require_keys(const Words& keys) const {
    if (!value.is_object()) wrong("expected an object", "see 'mien help farm'");
    for (const auto& [key, ignored] : value.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      wrong("there is no \"" + one_line(key) + "\" here",
            nearest_question(key, keys, "its members are " + list_of(keys, "and")));
    }
  }
  JobValue at(const std::string& key) const {
    if (!value.contains(key)) wrong("there is no \"" + key + "\"", "add it");
    return {value[key], where + "." + key};
  }
  JobValue at(size_t index) const {
    return {value[index], where + "[" + std::to_string(index) + "]"};
  }
  size_t list_size() const {
    if (!value.is_array() || value.empty()) wrong("expected a list", "give one thing at least");
    return value.size();
  }
  std::string text() const {
    if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
      wrong("expected text", "write it in quotes");
    }
    return value.get<std::string>();
  }
  /// `otherwise` if the object does not have it.
  std::string text_or(const char* key, const std::string& otherwise) const {
    return value.contains(key) ? at(key).text() : otherwise;
  }
  /// A whole number; it may be in quotes, as an option.
  uint64_t number(uint64_t least, uint64_t most) const {
    if (value.is_number_unsigned() && value.get<uint64_t>() >= least &&
        value.get<uint64_t>() <= most) {
      return value.get<uint64_t>();
    }
    wrong("expected a whole number from " + std::to_string(least) + " to " + std::to_string(most),
          "give one");
  }
};

std::string beside(const std::string& folder, const std::string& path) {
  return (fs::path(folder) / path).lexically_normal().string();
}

/// Sorted by bytes. A name without wildcards stays, whether there is such a file or not: what is missing fails when it
/// is its turn.
void add_matching(const JobValue& pattern, const std::string& folder,
                  std::vector<std::string>& files) {
  const std::string path = beside(folder, pattern.text());
  if (path.find_first_of("*?[") == std::string::npos) {
    files.push_back(path);
    return;
  }
#if defined(_WIN32)
  pattern.wrong("wildcards are not expanded on this system", "name the files");
#else
  glob_t found{};
  const int status = glob(path.c_str(), 0, nullptr, &found);
  for (size_t i = 0; status == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  if (status == GLOB_NOSPACE) throw std::bad_alloc();
  if (status != 0) pattern.wrong("no file matches " + one_line(path), "check the path");
#endif
}

std::vector<std::string> read_files(const JobValue& list, const std::string& folder) {
  std::vector<std::string> files;
  for (size_t i = 0; i < list.list_size(); ++i) add_matching(list.at(i), folder, files);
  return files;
}

/// The place of "{frame}", say, in a pattern.
bool has_place(const std::string& pattern, const std::string& name) {
  return pattern.find("{" + name + "}") != std::string::npos;
}

void check_pattern(const JobValue& where, const FarmJob& job, const FarmOutput& output) {
  for (size_t open = output.pattern.find('{'); open != std::string::npos;
       open = output.pattern.find('{', open + 1)) {
    const std::string name =
        output.pattern.substr(open + 1, output.pattern.find('}', open) - open - 1);
    if (name == "rig" || name == "take" || name == "frame") continue;
    where.wrong("{" + one_line(name) + "} has no meaning", "use {rig}, {take} and {frame}");
  }
  if (job.rigs.size() > 1 && !has_place(output.pattern, "rig")) {
    where.wrong("all rigs would write the same files", "put {rig} into it");
  }
  if (job.takes.size() > 1 && !has_place(output.pattern, "take")) {
    where.wrong("all takes would write the same files", "put {take} into it");
  }
  if (output.kind == FarmKind::kPng && !output.per_frame) {
    where.wrong("all frames would write the same file", "put {frame} into it");
  }
  if ((output.kind == FarmKind::kGlb || output.kind == FarmKind::kClip) && output.per_frame) {
    where.wrong("such a file holds all frames", "leave out {frame}");
  }
}

FarmOutput read_output(const JobValue& node, const FarmJob& job) {
  FarmOutput output;
  if (!node.value.is_object()) node.wrong("expected an object", "see 'mien help farm'");
  const std::string kind = node.at("kind").text();
  const auto found = std::find(kFarmKinds.begin(), kFarmKinds.end(), kind);
  if (found == kFarmKinds.end()) {
    node.at("kind").wrong("\"" + one_line(kind) + "\" is no kind",
                          nearest_question(kind, kFarmKinds, "use " + list_of(kFarmKinds, "or")));
  }
  output.kind = static_cast<FarmKind>(found - kFarmKinds.begin());
  Words keys = {"kind", "path"};
  const Words& own = kOutputKeys[found - kFarmKinds.begin()];
  keys.insert(keys.end(), own.begin(), own.end());
  node.require_keys(keys);

  output.pattern = beside(job.folder, node.at("path").text());
  output.per_frame = has_place(output.pattern, "frame");
  check_pattern(node.at("path"), job, output);
  output.mesh = output.solve.target.mesh = node.text_or("mesh", "");
  output.meshes = node.text_or("meshes", "");
  output.glb.influences = node.text_or("influences", "");
  check_glb_options(output.glb);
  output.image.camera = node.text_or("camera", output.image.camera);
  output.image.target = node.text_or("target", "");
  output.image.size = node.text_or("size", "256");
  output.image.background = node.text_or("background", output.image.background);
  output.image.samples = node.text_or("samples", output.image.samples);
  if (output.kind == FarmKind::kPng) {
    parse_camera(output.image.camera);
    parse_render_options(output.image, parse_size(output.image.size, {}));
  }
  output.solve.target.kind = node.text_or("solve", "");
  if (!output.solve.target.kind.empty()) parse_word("solve --kind", output.solve.target.kind);
  output.solve.controls = node.text_or("controls", "");
  const std::string landmarks = node.text_or("landmarks", ""), from = node.text_or("from", "");
  if (!landmarks.empty()) output.solve.target.landmarks = beside(job.folder, landmarks);
  if (!from.empty()) output.solve.target.from = beside(job.folder, from);
  return output;
}

/// Two of the same name would write the same files.
void check_stems(const JobValue& list, const std::vector<std::string>& files) {
  std::set<std::string> stems;
  for (const std::string& file : files) {
    if (stems.insert(stem_of(file)).second) continue;
    list.wrong("two files are named " + one_line(stem_of(file)),
               "rename one: outputs are named by them");
  }
}

}  // namespace

bool FarmJob::has(FarmKind kind) const {
  return std::any_of(outputs.begin(), outputs.end(),
                     [&](const FarmOutput& output) { return output.kind == kind; });
}

bool FarmJob::cuts_takes() const {
  return std::all_of(outputs.begin(), outputs.end(),
                     [](const FarmOutput& output) { return output.per_frame; });
}

FarmJob read_farm_job(const std::string& path) {
  FarmJob job;
  job.path = path;
  job.folder = fs::path(path).parent_path().string();
  job.name = stem_of(path);
  const auto json =
      parse_json<FarmJson>(read_json(path, kCannotFarm), kCannotFarm, path, kFarmExample);
  const JobValue root{json, path};
  root.require_keys(kJobKeys);
  job.rigs = read_files(root.at("rigs"), job.folder);
  job.takes = read_files(root.at("takes"), job.folder);
  check_stems(root.at("rigs"), job.rigs);
  check_stems(root.at("takes"), job.takes);
  const JobValue outputs = root.at("outputs");
  std::set<std::string> patterns;
  for (size_t i = 0; i < outputs.list_size(); ++i) {
    job.outputs.push_back(read_output(outputs.at(i), job));
    if (patterns.insert(job.outputs.back().pattern).second) continue;
    outputs.at(i).wrong("another output has the same path", "give each its own");
  }
  const bool all_solve =
      std::all_of(job.outputs.begin(), job.outputs.end(),
                  [](const FarmOutput& output) { return output.kind == FarmKind::kClip; });
  if (job.solves() && !all_solve) {
    outputs.wrong("clips are made of captured data, the other outputs of curves",
                  "make two jobs, of which the second takes the clips of the first");
  }
  if (json.contains("lod")) job.lod = static_cast<uint32_t>(root.at("lod").number(0, kMaxLods - 1));
  if (json.contains("rate")) {
    const JobValue rate = root.at("rate");
    job.rate = parse_rate(rate.value.is_number() ? rate.value.dump() : rate.text());
    if (!job.rate.known()) rate.wrong("not a number of frames per second", "give 60, say");
  }
  job.block = json.contains("block") ? root.at("block").number(1, 1000000) : kUsualBlock;
  const std::string isa = json.contains("isa") ? root.at("isa").text() : "portable";
  job.isa = isa == "portable" ? portable_isa() : parse_isa(isa);
  FarmJson settings = json;
  settings.erase("rigs");
  settings.erase("takes");
  settings["version"] = mien_version();
  job.settings = settings.dump();
  for (const FarmOutput& output : job.outputs) {
    for (const std::string& file : {output.solve.target.landmarks, output.solve.target.from}) {
      if (!file.empty()) job.settings += file_fingerprint(file);
    }
  }
  return job;
}

std::string stem_of(const std::string& path) { return fs::path(path).stem().string(); }

std::string farm_path(const FarmJob& job, const FarmOutput& output, const FarmTask& task,
                      uint64_t frame) {
  std::string number = std::to_string(frame);
  if (number.size() < kFrameDigits) number.insert(0, kFrameDigits - number.size(), '0');
  std::string path;
  for (size_t at = 0; at < output.pattern.size();) {
    const auto put = [&](const std::string& place, const std::string& text) {
      if (output.pattern.compare(at, place.size(), place) != 0) return false;
      path += text;
      at += place.size();
      return true;
    };
    if (put("{rig}", stem_of(job.rigs[task.rig])) || put("{take}", stem_of(job.takes[task.take])) ||
        put("{frame}", number)) {
      continue;
    }
    path += output.pattern[at++];
  }
  return path;
}

Take load_farm_take(const FarmJob& job, uint32_t index) {
  const std::string& path = job.takes[index];
  Take take;
  if (ends_with(path, ".clip")) {
    const ClipFile clip = open_clip_file(path);
    take.shown = clip.shown;
    take.names = channel_names(clip);
    take.row_count = clip.info.frame_count;
    take.rate = {clip.info.rate_numerator, clip.info.rate_denominator};
    take.values.reserve(take.row_count * take.names.size());
    for_each_frame(clip, [&](uint32_t, const float* values) {
      take.values.insert(take.values.end(), values, values + take.names.size());
    });
  } else {
    take = parse_take(read_text(path, "cannot read take"), path);
    if (!take.rate.known()) {
      take.rate = take.times.seconds.empty() ? Rate{60, 1} : find_rate(take.times);
    }
  }
  const bool same = job.rate.known() && job.rate.numerator == take.rate.numerator &&
                    job.rate.denominator == take.rate.denominator;
  if (!job.rate.known() || same || take.row_count == 0) return take;
  if (take.times.seconds.empty()) {
    for (size_t row = 0; row < take.row_count; ++row) {
      take.times.seconds.push_back(static_cast<double>(row) / take.rate.hertz());
    }
  }
  resample(take, job.rate);
  take.rate = job.rate;
  return take;
}

uint64_t count_frames(const FarmJob& job, uint32_t take) {
  if (!ends_with(job.takes[take], ".clip")) return load_farm_take(job, take).row_count;
  const MienClipInfo info = open_clip_file(job.takes[take]).info;
  if (!job.rate.known() || info.frame_count == 0) return info.frame_count;
  // As resample() counts.
  const double span =
      (info.frame_count - 1) * (double(info.rate_denominator) / info.rate_numerator);
  return static_cast<uint64_t>(std::floor(span * job.rate.hertz() + 1e-6)) + 1;
}

std::vector<FarmTask> farm_tasks(const FarmJob& job) {
  std::vector<uint64_t> frames(job.takes.size());
  for (uint32_t take = 0; job.cuts_takes() && take < job.takes.size(); ++take) {
    try {
      frames[take] = count_frames(job, take);
    } catch (const Failure&) {
      // Told when the task is run.
    }
  }
  std::vector<FarmTask> tasks;
  for (uint32_t rig = 0; rig < job.rigs.size(); ++rig) {
    for (uint32_t take = 0; take < job.takes.size(); ++take) {
      if (frames[take] == 0) tasks.push_back({rig, take, 0, 0});
      for (uint64_t first = 0; first < frames[take]; first += job.block) {
        tasks.push_back({rig, take, first, std::min(job.block, frames[take] - first)});
      }
    }
  }
  return tasks;
}

}  // namespace mien::cli
