// SPDX-License-Identifier: MIT
#define MIEN_EXCEPTIONS  // value() throws; without, test each result
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mien_author.hpp>

/* evaluate [FILE.dna [CONTROL]]: raises a control and prints the joint that moves or turns most. */
int main(int argc, char** argv) try {
  const char* control = argc > 2 ? argv[2] : "CTRL_expressions.jawOpen";
  mien::GenerateDesc large;
  large.preset = MIEN_PRESET_LARGE;
  const auto dna = (argc > 1 ? mien::Dna::open(argv[1]) : mien::generate(large)).value();
  const mien::Rig rig = mien::Rig::create(dna).value();
  mien::Instance face = rig.instance().value();
  auto index = rig.find(MIEN_KIND_RAW_CONTROL, control);
  if (!index && std::strchr(control, '.')) {  // some rigs leave the prefix out
    control = std::strrchr(control, '.') + 1;
    index = rig.find(MIEN_KIND_RAW_CONTROL, control);
  }
  face.raw_controls()[index.value()] = 1;  // written in place
  rig.evaluate(face, 0).value();
  const auto moves = face.joints();  // per joint tx ty tz rx ry rz sx sy sz, from neutral
  uint32_t most = 0;
  for (uint32_t i = 0; i < moves.size(); ++i)
    if (i % 9 < 6 && std::abs(moves[i]) > std::abs(moves[most])) most = i;
  const auto name = rig.name(MIEN_KIND_JOINT, most / 9).value();
  const float* d = &moves[most / 9 * 9];
  std::printf("%s moves %.*s most: by %.3f %.3f %.3f, turning it by %.3f %.3f %.3f\n", control,
              int(name.size()), name.data(), d[0], d[1], d[2], d[3], d[4], d[5]);
} catch (const mien::Exception& e) {
  std::fprintf(stderr, "%s: %s\n", e.error().name(), e.what());
  return 1;
}
