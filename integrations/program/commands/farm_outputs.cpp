// SPDX-License-Identifier: MIT
#include "integrations/program/commands/farm_outputs.h"

#include <algorithm>
#include <filesystem>

#include "integrations/program/commands/eval_output.h"
#include "integrations/program/io/fingerprint.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/npy_writer.h"
#include "integrations/program/io/text.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/render.h"
#include "integrations/program/scene/camera_target.h"

namespace mien::cli {

namespace {

constexpr const char* kCannotRunTask = "cannot run task";
constexpr uint32_t kFramesAtOnce = 16;

void make_folder_of(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code reason;
  if (!folder.empty()) std::filesystem::create_directories(folder, reason);
  if (reason) {
    fail(kFile, "cannot write", path, reason.message(), "check the path and its permissions");
  }
}

uint32_t mesh_index(const PosedScene& scene, const std::string& name) {
  MienIndex16View indices{};
  check(mien_rig_lod_indices(scene.rig.get(), MIEN_KIND_MESH, scene.rig_lod, &indices), nullptr,
        kCannotRunTask, scene.shown);
  NearestName nearest(name);
  for (size_t i = 0; i < indices.count; ++i) {
    const std::string own = rig_name(scene.rig.get(), MIEN_KIND_MESH, indices.data[i]);
    nearest.offer(own);
    if (name.empty() || own == name) return indices.data[i];
  }
  fail(kInvalid, kCannotRunTask, scene.shown,
       name.empty() ? "the LOD has no mesh" : "the LOD has no mesh \"" + one_line(name) + "\"",
       nearest.question("'mien info RIG --names meshes' lists the names"));
}

/// A file that grows with the frames.
struct ArrayFile {
  ArrayFile(const FarmOutput& what, const std::string& file)
      : output(what), path(file), bytes(file, &content) {}

  DoneFile commit() {
    bytes.commit();
    return {path, bytes.size(), content.text()};
  }

  const FarmOutput& output;
  std::string path;
  Fingerprint content;
  Output bytes;
  std::unique_ptr<EvalWriter> joints;  // or vertices:
  uint32_t mesh = 0;
  size_t position_count = 0;
};

std::unique_ptr<ArrayFile> begin_array(const FarmOutput& output, const std::string& path,
                                       const PosedScene& scene, uint64_t frames) {
  make_folder_of(path);
  auto file = std::make_unique<ArrayFile>(output, path);
  if (output.kind == FarmKind::kJoints) {
    file->joints = make_eval_writer(EvalFormat::kNpy, file->bytes);
    file->joints->begin(scene.rig.get(), {scene.shown, "", "", false}, frames);
    return file;
  }
  file->mesh = mesh_index(scene, output.mesh);
  auto mesh = sized<MienMesh>();
  check(mien_deformer_mesh(scene.deformer.get(), file->mesh, &mesh), nullptr, kCannotRunTask,
        scene.shown);
  file->position_count = mesh.position_count;
  write_npy_header({frames, mesh.position_count, 3}, file->bytes);
  return file;
}

/// The instance is evaluated, and the scene in its pose.
void add_frame(PosedScene& scene, const MienInstance* instance, uint64_t frame, ArrayFile& file) {
  if (file.joints) {
    file.joints->write(frame, scene.rig_lod, instance);
    return;
  }
  const bool is_drawn = std::any_of(scene.meshes.begin(), scene.meshes.end(),
                                    [&](const SceneMesh& mesh) { return mesh.mesh == file.mesh; });
  if (!is_drawn) {
    check(mien_deformer_instance_deform(scene.pose.get(), file.mesh, MIEN_NORMALS_NONE, nullptr),
          nullptr, kCannotRunTask, scene.shown);
  }
  MienFloatView view{};
  check(mien_deformer_instance_positions(scene.pose.get(), file.mesh, &view), nullptr,
        kCannotRunTask, scene.shown);
  const size_t count = 3 * file.position_count;
  const size_t written = write_npy_floats(view.data, count, file.bytes);
  if (written == count) return;
  fail(kInvalid, kCannotRunTask,
       scene.shown + ", frame " + std::to_string(frame) + ", position " +
           std::to_string(written / 3),
       "the result is not a finite number", "give smaller controls; they are usually in 0..1");
}

DoneFile write_whole(const std::string& path, const std::string& bytes) {
  make_folder_of(path);
  Fingerprint content;
  Output output(path, &content);
  output.write(bytes);
  output.commit();
  return {path, output.size(), content.text()};
}

}  // namespace

Frame BoundTake::frame(uint64_t number) const {
  Frame frame;
  const float* values = take.values.data() + number * take.names.size();
  for (size_t c = 0; c < controls.size(); ++c) {
    for (const MienControlShare& share : controls[c]) {
      frame.raw.push_back({share.control, share.weight * values[c]});
    }
  }
  return frame;
}

void BoundTake::set(uint64_t number, float* raw) const {
  const float* values = take.values.data() + number * take.names.size();
  for (size_t c = 0; c < controls.size(); ++c) {
    for (const MienControlShare& share : controls[c]) raw[share.control] = share.weight * values[c];
  }
}

FrameBlock::FrameBlock(const MienRig* rig, uint32_t lod) : lods(kFramesAtOnce, lod) {
  auto error = sized<MienError>();
  auto desc = sized<MienBatchDesc>();
  desc.capacity = kFramesAtOnce;
  MienBatch* made = nullptr;
  check(mien_batch_create(rig, &desc, &made, &error), &error, kCannotRunTask, "");
  batch.reset(made);
  for (uint32_t i = 0; i < kFramesAtOnce; ++i) {
    MienInstance* instance = nullptr;
    check(mien_instance_create(rig, nullptr, &instance, &error), &error, kCannotRunTask, "");
    owners.emplace_back(instance);
    instances.push_back(instance);
    MienMutableFloatView view{};
    check(mien_instance_raw_controls(instance, &view), nullptr, kCannotRunTask, "");
    raw.push_back(view.data);
  }
}

void FarmWorker::open_rig(uint32_t rig) {
  if (rig_ == rig || job_.solves()) return;
  rig_.reset();
  take_.reset();
  block_.reset();
  scene_.reset();
  exported_.reset();
  neutral_.clear();
  const std::string& path = job_.rigs[rig];
  const bool draws = job_.has(FarmKind::kPng);
  if (draws || job_.has(FarmKind::kJoints) || job_.has(FarmKind::kVertices)) {
    PosedSceneOptions options;
    options.rig = path;
    options.lod = job_.lod;
    options.isa = job_.isa;
    options.whole_rig = true;
    options.no_geometry = !draws && !job_.has(FarmKind::kVertices);
    options.meshes = draws ? "" : "*";
    for (const FarmOutput& output : job_.outputs) {
      if (!output.meshes.empty()) options.meshes = output.meshes;
    }
    scene_ = open_scene(options, session_);
    if (!draws) scene_->meshes.clear();  // deform_scene() deforms them
    block_.emplace(scene_->rig.get(), scene_->rig_lod);
  }
  if (job_.has(FarmKind::kGlb)) {
    exported_ = std::make_unique<ExportedRig>(path, std::to_string(job_.lod), session_);
    for (const FarmOutput& output : job_.outputs) {
      if (output.kind != FarmKind::kGlb) continue;
      neutral_.push_back(neutral_rig_scene(*exported_, output.glb, session_));
    }
  }
  rig_ = rig;
}

void FarmWorker::open_take(uint32_t take) {
  if (take_ == take || job_.solves()) return;
  take_.reset();
  bound_ = {};
  bound_.take = load_farm_take(job_, take);
  if (bound_.take.row_count == 0) {
    fail(kInvalid, kCannotRunTask, bound_.take.shown, "the take has no frames", "leave it out");
  }
  const MienRig* rig = scene_ ? scene_->rig.get() : exported_->rig.get();
  std::string missing;
  for (const std::string& name : bound_.take.names) {
    bound_.controls.push_back(match_name(rig, name).shares);
    if (bound_.controls.back().empty()) missing += (missing.empty() ? "" : ", ") + one_line(name);
  }
  if (!missing.empty()) {
    note(session_, bound_.take.shown +
                       ": the rig lacks the controls of these channels, which are "
                       "left out: " +
                       missing);
  }
  if (block_) {
    for (MienInstance* instance : block_->instances) {
      check(mien_instance_reset(instance), nullptr, kCannotRunTask, bound_.take.shown);
    }
  }
  take_ = take;
}

DoneFile FarmWorker::write_glb(const FarmOutput& output, const FarmTask& task,
                               const std::string& path) {
  std::vector<Frame> frames(task.count);
  for (uint64_t f = 0; f < task.count; ++f) frames[f] = bound_.frame(task.first + f);
  size_t index = 0;
  for (const FarmOutput& other : job_.outputs) {
    if (&other == &output) break;
    index += other.kind == FarmKind::kGlb;
  }
  gltf::RigScene scene = neutral_[index];
  Session quiet = session_;
  quiet.quiet = true;
  animate_scene(*exported_, Frame(), frames, bound_.take.rate.hertz(), quiet, scene);
  add_materials(*exported_, "", {}, scene.scene, quiet);
  return write_whole(path, glb_bytes(scene.scene, output.glb));
}

std::string FarmWorker::draw(const FarmOutput& output) {
  const render::Size size = parse_size(output.image.size, {});
  render::RenderOptions options = parse_render_options(output.image, size);
  options.scale = length(scene_->neutral_box().size());
  const render::Camera camera =
      aim_camera(*scene_, output.image.target, parse_camera(output.image.camera), size);
  return render::to_png(render_image(scene_->surfaces(), camera, options));
}

void FarmWorker::write_frames(const FarmTask& task, const Name& name,
                              std::vector<DoneFile>& files) {
  // Files of the whole task are open all the time, and get their names together at the end.
  std::vector<std::unique_ptr<ArrayFile>> whole;
  for (const FarmOutput& output : job_.outputs) {
    const bool is_array = output.kind == FarmKind::kJoints || output.kind == FarmKind::kVertices;
    if (!is_array || output.per_frame) continue;
    whole.push_back(begin_array(output, name(output, task.first), *scene_, task.count));
  }
  const uint64_t end = task.first + task.count;
  for (uint64_t f = task.first; f < end; ++f) {
    const auto i = static_cast<uint32_t>((f - task.first) % kFramesAtOnce);
    if (i == 0) evaluate(f, static_cast<uint32_t>(std::min<uint64_t>(end - f, kFramesAtOnce)));
    const MienInstance* instance = block_->instances[i];
    deform_scene(*scene_, instance);
    for (const auto& file : whole) add_frame(*scene_, instance, f, *file);
    for (const FarmOutput& output : job_.outputs) {
      if (!output.per_frame) continue;
      const std::string path = name(output, f);
      if (output.kind == FarmKind::kPng) {
        files.push_back(write_whole(path, draw(output)));
      } else {
        const std::unique_ptr<ArrayFile> file = begin_array(output, path, *scene_, 1);
        add_frame(*scene_, instance, f, *file);
        files.push_back(file->commit());
      }
    }
  }
  for (const auto& file : whole) files.push_back(file->commit());
}

/// Frames of the take, on the first instances of the block.
void FarmWorker::evaluate(uint64_t first, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) bound_.set(first + i, block_->raw[i]);
  check(mien_rig_evaluate_batch(scene_->rig.get(), block_->batch.get(), block_->instances.data(),
                                block_->lods.data(), count, MIEN_STAGE_ALL, nullptr),
        nullptr, kCannotRunTask, bound_.take.shown);
}

DoneFile FarmWorker::solve(const FarmOutput& output, const FarmTask& task,
                           const std::string& path) {
  SolveCommand command = output.solve;
  command.rig = job_.rigs[task.rig];
  command.target.path = job_.takes[task.take];
  if (job_.rate.known()) command.rate = rate_text(job_.rate);
  command.output.path = path;
  make_folder_of(path);
  solve_file(command, session_);
  std::error_code reason;
  const uint64_t bytes = std::filesystem::file_size(path, reason);
  if (reason) {
    fail(kFile, "cannot read what was written", path, reason.message(), "see who removes it");
  }
  return {path, bytes, file_fingerprint(path)};
}

std::vector<DoneFile> FarmWorker::run(const FarmTask& task, const Name& name) {
  std::vector<DoneFile> files;
  if (job_.solves()) {
    for (const FarmOutput& output : job_.outputs) {
      files.push_back(solve(output, task, name(output, 0)));
    }
    return files;
  }
  open_rig(task.rig);
  open_take(task.take);
  FarmTask known = task;
  if (known.count == 0)
    known.count = bound_.take.row_count - std::min<uint64_t>(bound_.take.row_count, task.first);
  if (known.first + known.count > bound_.take.row_count) {
    fail(kInvalid, kCannotRunTask, bound_.take.shown, "the take was changed", "plan again");
  }
  if (scene_) write_frames(known, name, files);
  for (const FarmOutput& output : job_.outputs) {
    if (output.kind != FarmKind::kGlb) continue;
    files.push_back(write_glb(output, known, name(output, known.first)));
  }
  return files;
}

}  // namespace mien::cli
