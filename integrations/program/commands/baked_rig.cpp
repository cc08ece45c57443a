// SPDX-License-Identifier: MIT
#include "integrations/program/commands/baked_rig.h"

#include <utility>

#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

[[noreturn]] void fail_baked(const std::string& option) {
  fail_usage(option, "this was decided when the file was baked",
             "bake again with this option, or give the DNA file");
}

}  // namespace

BakedFile open_baked_rig(const std::string& path, const LoadOptions& load,
                         const RigOptions& evaluation, uint32_t reuse) {
  for (const auto& [option, value] :
       {std::pair<const char*, const std::string&>{"--layers", load.layers},
        {"--max-lod", load.max_lod},
        {"--min-lod", load.min_lod},
        {"--lods", load.lods},
        {"--system", load.system},
        {"--rotation-order", load.rotation_order}}) {
    if (!value.empty()) fail_baked(option);
  }
  const MienRigDesc wanted = parse_rig_options(evaluation);
  auto desc = sized<MienBakedRigDesc>();
  desc.isa = wanted.isa;
  desc.reuse = reuse;
  BakedFile file = open_baked_file(path, desc);

  const MienRigInfo info = rig_info(file.rig.get());
  if (wanted.rotation_output != MIEN_ROTATION_OUTPUT_EULER &&
      wanted.rotation_output != info.rotation_output) {
    fail_baked("--rotation " + evaluation.rotation);
  }
  if (wanted.storage != MIEN_STORAGE_32_BIT && wanted.storage != info.storage) {
    fail_baked("--storage " + evaluation.storage);
  }
  if (wanted.arithmetic != MIEN_ARITHMETIC_FAST && wanted.arithmetic != info.arithmetic) {
    fail_baked("--arithmetic " + evaluation.arithmetic);
  }
  if (wanted.ml_masks != MIEN_ML_MASKS_SWITCH) fail_baked("--ml-masks " + evaluation.ml_masks);
  return file;
}

}  // namespace mien::cli
