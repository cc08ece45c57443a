// SPDX-License-Identifier: MIT
// The same as main.c, with what is installed for C++.
#include <cstdio>
#ifdef MAKES_FILES
#include <mien_author.hpp>
#else
#include <mien.hpp>
#endif

int main(int argc, char** argv) {
  if (argc != 2) return 1;
#ifdef MAKES_FILES
  auto dna = mien::generate();
#else
  auto dna = mien::Dna::open(argv[1]);
#endif
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
