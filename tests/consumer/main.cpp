// SPDX-License-Identifier: MIT
// The same as main.c, with what is installed for C++.
#include <cstdio>
#include <mien.hpp>

int main() {
  auto dna = mien::Dna::generate();
  if (!dna) {
    std::fprintf(stderr, "mien: %s\n", dna.error().message());
    return 1;
  }
  auto rig = mien::Rig::create(*dna);
  auto face = rig ? rig->instance() : mien::Result<mien::Instance>(rig.error());
  if (!face) {
    std::fprintf(stderr, "mien: %s\n", face.error().message());
    return 1;
  }
  std::printf("%zu joint values\n", size_t(face->joints().size()));
  return rig->evaluate(*face, 0) && face->joints().size() > 0 ? 0 : 1;
}
