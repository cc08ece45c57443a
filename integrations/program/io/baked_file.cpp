// SPDX-License-Identifier: MIT
#include "integrations/program/io/baked_file.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "integrations/program/io/input.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

constexpr char kMagic[] = "MIENBAKE";
constexpr size_t kMagicSize = sizeof(kMagic) - 1;

}  // namespace

bool is_baked_file(const std::string& path) {
  if (path == "-") {
    // One byte can be put back, and one is enough: a DNA file begins with D.
    const int first = std::getc(stdin);
    if (first != EOF) std::ungetc(first, stdin);
    return first == kMagic[0];
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  char start[kMagicSize] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof(start));
  return std::memcmp(start, kMagic, kMagicSize) == 0;
}

bool is_baked_bytes(const std::string& bytes) { return bytes.compare(0, kMagicSize, kMagic) == 0; }

BakedFile open_baked_file(const std::string& path, const MienBakedRigDesc& desc) {
  constexpr const char* kCannot = "cannot open baked file";
  BakedFile file;
  file.shown = shown_name(path);
  MienBaked* baked = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (path == "-") {
    const std::string bytes = read_rig_stream(path);
    auto copy = sized<MienBakedDesc>();
    copy.file_access = MIEN_FILE_READ;
    status = mien_baked_open_memory(bytes.data(), bytes.size(), &copy, &baked, &error);
  } else {
    status = mien_baked_open_file(path.c_str(), nullptr, &baked, &error);
  }
  check(status, &error, kCannot, file.shown);
  file.baked.reset(baked);
  MienRig* rig = nullptr;
  check(mien_rig_from_baked(baked, &desc, &rig, &error), &error, kCannot, file.shown);
  file.rig.reset(rig);
  auto info = sized<MienBakedInfo>();
  check(mien_baked_info(baked, &info), nullptr, kCannot, file.shown);
  if (info.deformer_bytes != 0) {
    MienDeformer* deformer = nullptr;
    check(mien_deformer_from_baked(baked, rig, nullptr, &deformer, &error), &error, kCannot,
          file.shown);
    file.deformer.reset(deformer);
  }
  return file;
}

}  // namespace mien::cli
