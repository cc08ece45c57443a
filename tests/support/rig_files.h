// SPDX-License-Identifier: MIT
// Rigs of every origin: generated, authored and golden ones.
#pragma once

#include "tests/support/authored_head.h"
#include "tests/support/golden.h"

namespace mien {

struct NamedRig {
  std::string name;
  std::vector<uint8_t> bytes;  // of a golden rig, whose DNA points into them
  DnaHandle dna;
};

/// Says so if the golden head is not there.
inline std::vector<NamedRig> rigs_of_every_origin() {
  std::vector<NamedRig> all;
  for (const uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL, MIEN_PRESET_MEDIUM,
                                MIEN_PRESET_BODY, MIEN_PRESET_LARGE, MIEN_PRESET_HEAD}) {
    all.push_back({"preset " + std::to_string(preset), {}, generate_dna(preset, 3)});
  }
  all.push_back({"authored", {}, author_head(5, 40)});
  if (!golden::has_head()) printf("%s\n", golden::no_head().c_str());
  for (const std::string& name : golden::present_names()) {
    NamedRig rig = {name, golden::read_rig(name), {}};
    rig.dna = open_dna(rig.bytes);
    all.push_back(std::move(rig));
  }
  return all;
}

}  // namespace mien
