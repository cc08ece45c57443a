// SPDX-License-Identifier: MIT
#include "integrations/program/commands/bench_frame.h"

#include <random>

#include "integrations/program/commands/bench_clock.h"

namespace mien::cli {

namespace {

constexpr double kFrameActivity = 0.25;
constexpr const char* kCannotMeasure = "cannot measure frames";

/// A rig for one instruction set, its deformer, and the characters of both.
struct FramePacket {
  Rig rig;
  Deformer deformer;
  Batch batch;
  std::vector<Instance> instances;
  std::vector<DeformerInstance> poses;
  std::vector<MienInstance*> instance_handles;
  std::vector<MienDeformerInstance*> pose_handles;
  std::vector<uint32_t> lods, meshes;
};

void draw_controls(MienInstance* instance, std::mt19937& random) {
  MienMutableFloatView raw{};
  check(mien_instance_raw_controls(instance, &raw), nullptr, kCannotMeasure, "");
  for (size_t i = 0; i < raw.count; ++i) {
    const bool active = random() % 1000 < 1000 * kFrameActivity;
    raw.data[i] = active ? static_cast<float>((random() >> 8) + 1) / 16777216.0f : 0.0f;
  }
}

FramePacket make_packet(const RigFile& file, MienRigDesc desc) {
  FramePacket packet;
  desc.reuse = MIEN_REUSE_NOTHING;  // samples repeat the same controls
  packet.rig = create_rig(file, desc);
  auto error = sized<MienError>();
  MienDeformer* deformer = nullptr;
  check(mien_deformer_create(file.dna.get(), packet.rig.get(), nullptr, &deformer, &error), &error,
        "cannot compile geometry", file.shown);
  packet.deformer.reset(deformer);
  MienBatchDesc batch_desc = mien_batch_desc_default();
  batch_desc.capacity = kInstances;
  MienBatch* batch = nullptr;
  check(mien_batch_create(packet.rig.get(), &batch_desc, &batch, &error), &error, kCannotMeasure,
        file.shown);
  packet.batch.reset(batch);
  auto pose_desc = sized<MienDeformerInstanceDesc>();
  pose_desc.lods = 1;
  std::mt19937 random(20240229);
  for (uint32_t i = 0; i < kInstances; ++i) {
    MienInstance* instance = nullptr;
    check(mien_instance_create(packet.rig.get(), nullptr, &instance, &error), &error,
          kCannotMeasure, file.shown);
    packet.instances.emplace_back(instance);
    packet.instance_handles.push_back(instance);
    draw_controls(instance, random);
    MienDeformerInstance* pose = nullptr;
    check(mien_deformer_instance_create(packet.deformer.get(), &pose_desc, &pose, &error), &error,
          kCannotMeasure, file.shown);
    packet.poses.emplace_back(pose);
    packet.pose_handles.push_back(pose);
  }
  packet.lods.assign(kInstances, 0);
  MienIndex16View meshes{};
  check(mien_rig_lod_indices(packet.rig.get(), MIEN_KIND_MESH, 0, &meshes), nullptr, kCannotMeasure,
        file.shown);
  packet.meshes.assign(meshes.data, meshes.data + meshes.count);
  return packet;
}

/// The stages of a frame, in their order.
struct FrameSamples {
  std::vector<double> evaluate, pose, deform;
};

void sample_frame(const FramePacket& packet, uint32_t characters, FrameSamples& samples) {
  MienStatus failed = MIEN_OK;
  const auto evaluate = [&] {
    failed |= characters == 1
                  ? mien_rig_evaluate(packet.rig.get(), packet.instance_handles[0], 0)
                  : mien_rig_evaluate_batch(packet.rig.get(), packet.batch.get(),
                                            packet.instance_handles.data(), packet.lods.data(),
                                            characters, MIEN_STAGE_ALL, nullptr);
  };
  const auto update = [&] {
    for (uint32_t i = 0; i < characters; ++i) {
      failed |= mien_deformer_instance_update(packet.pose_handles[i], packet.instance_handles[i]);
    }
  };
  const auto deform = [&] {
    for (const uint32_t mesh : packet.meshes) {
      failed |= mien_deformer_instance_deform_batch(packet.pose_handles.data(), characters, mesh,
                                                    MIEN_NORMALS_SKINNED, nullptr);
    }
  };
  // The first pass fetches what the frames of other rows have displaced from the caches.
  const auto time = [&](const auto& pass) {
    pass();
    return time_per_pass(pass) / characters;
  };
  samples.evaluate.push_back(time(evaluate));
  samples.pose.push_back(time(update));
  samples.deform.push_back(time(deform));
  if (failed != MIEN_OK) check(failed, nullptr, kCannotMeasure, "");
}

}  // namespace

std::vector<FrameRow> measure_frames(const RigFile& file, const std::vector<MienRigDesc>& descs,
                                     const BenchPlan& plan, const Session& session) {
  if (!has_geometry(file)) return {};
  std::vector<FramePacket> packets;
  for (const MienRigDesc& desc : descs) packets.push_back(make_packet(file, desc));
  std::vector<FrameSamples> samples(packets.size() * std::size(kCharacters));
  Progress progress(session, "measuring frames", 1);
  const double start = work_ns();
  for (size_t round = 0; round < plan.max_rounds; ++round) {
    const double share = (work_ns() - start) / (plan.seconds * 1e9);
    if (round >= plan.min_rounds && share > 1) break;
    progress.at_share(std::min(share, 1.0));
    FrameSamples* at = samples.data();
    for (const FramePacket& packet : packets) {
      for (const uint32_t characters : kCharacters) sample_frame(packet, characters, *at++);
    }
  }
  std::vector<FrameRow> rows;
  FrameSamples* at = samples.data();
  for (const FramePacket& packet : packets) {
    for (const uint32_t characters : kCharacters) {
      rows.push_back({rig_info(packet.rig.get()), characters, median(at->evaluate),
                      median(at->pose), median(at->deform)});
      ++at;
    }
  }
  return rows;
}

}  // namespace mien::cli
