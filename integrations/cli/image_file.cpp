// SPDX-License-Identifier: MIT
#include "integrations/cli/image_file.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "integrations/cli/output.h"
#include "integrations/cli/rig_file.h"

namespace mien::cli {

namespace {

constexpr char kMagic[] = "MIENBAKE";
constexpr size_t kMagicSize = sizeof(kMagic) - 1;

[[noreturn]] void fail_settled(const std::string& option) {
  fail_usage(option, "it was settled when the rig was baked", "bake it anew, or give the DNA file");
}

}  // namespace

bool is_image(const std::string& path) {
  if (path == "-") {
    const int first = std::getc(stdin);  // a DNA file begins with D
    if (first != EOF) std::ungetc(first, stdin);
    return first == kMagic[0];
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  char start[kMagicSize] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof(start));
  return std::memcmp(start, kMagic, kMagicSize) == 0;
}

bool is_image_bytes(const std::string& bytes) { return bytes.compare(0, kMagicSize, kMagic) == 0; }

ImageFile open_image(const std::string& path, const LoadOptions& load, const RigOptions& evaluation,
                     uint32_t reuse) {
  for (const auto& [option, value] :
       {std::pair<const char*, const std::string&>{"--layers", load.layers},
        {"--max-lod", load.max_lod},
        {"--min-lod", load.min_lod},
        {"--lods", load.lods},
        {"--system", load.system},
        {"--rotation-order", load.rotation_order}}) {
    if (!value.empty()) fail_settled(option);
  }
  const MienRigDesc wanted = parse_rig_options(evaluation);
  auto desc = sized<MienBakedDesc>();
  desc.isa = wanted.isa;
  desc.reuse = reuse;

  ImageFile file;
  file.shown = shown_name(path);
  MienRig* rig = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (path == "-") {
    file.bytes = read_standard_input();
    status = mien_rig_open_memory(file.bytes.data(), file.bytes.size(), &desc, &rig, &error);
  } else {
    status = mien_rig_open_file(path.c_str(), &desc, &rig, &error);
  }
  check(status, &error, "cannot open baked rig", file.shown);
  file.rig.reset(rig);
  const MienRigInfo info = rig_info(rig);
  if (wanted.rotation != MIEN_OUTPUT_EULER && wanted.rotation != info.rotation) {
    fail_settled("--rotation " + evaluation.rotation);
  }
  if (wanted.storage != MIEN_STORAGE_F32 && wanted.storage != info.storage) {
    fail_settled("--storage " + evaluation.storage);
  }
  if (wanted.ml_masks != MIEN_ML_MASKS_SWITCH) fail_settled("--ml-masks " + evaluation.ml_masks);
  return file;
}

}  // namespace mien::cli
