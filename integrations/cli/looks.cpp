// SPDX-License-Identifier: MIT
#include "integrations/cli/looks.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace mien::cli {

namespace {

using picture::Color;
using picture::Material;
using picture::Vec3;

struct Word {
  const char* word;
  MeshKind kind;
};

// The first that a name contains decides.
constexpr Word kWords[] = {
    {"eyeshell", MeshKind::kCover},  {"eyeedge", MeshKind::kCover},
    {"cartilage", MeshKind::kCover}, {"lash", MeshKind::kCover},
    {"saliva", MeshKind::kCover},    {"cornea", MeshKind::kCover},
    {"tear", MeshKind::kCover},      {"occlusion", MeshKind::kCover},
    {"shell", MeshKind::kCover},     {"teeth", MeshKind::kTeeth},
    {"tooth", MeshKind::kTeeth},     {"tongue", MeshKind::kTongue},
    {"gum", MeshKind::kTongue},      {"brow", MeshKind::kHair},
    {"hair", MeshKind::kHair},       {"beard", MeshKind::kHair},
    {"eyelid", MeshKind::kSkin},     {"eye", MeshKind::kEye},
    {"iris", MeshKind::kEye},        {"pupil", MeshKind::kEye},
};

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// False if a character is none of base64.
bool decode_base64(MienStringView text, std::vector<uint8_t>& out) {
  uint32_t bits = 0;
  int count = 0;
  for (size_t i = 0; i < text.count && text.data[i] != '='; ++i) {
    const int value = base64_value(text.data[i]);
    if (value < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      out.push_back(static_cast<uint8_t>(bits >> count));
    }
  }
  return true;
}

MienStringView read_text_field(const RigFile& file, const std::string& path) {
  MienStringView text{};
  auto error = sized<MienError>();
  check(mien_dna_read_string(file.dna.get(), path.c_str(), &text, &error), &error,
        "cannot read " + path, file.shown);
  return text;
}

}  // namespace

MeshKind mesh_kind(const std::string& name) {
  std::string lower;
  for (const char c : name) {
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const Word& entry : kWords) {
    if (lower.find(entry.word) != std::string::npos) return entry.kind;
  }
  return MeshKind::kSkin;
}

Material mesh_material(MeshKind kind) {
  switch (kind) {
    case MeshKind::kEye: return {{232, 228, 222}, 0.20f, 0.12f, 0.040f};
    case MeshKind::kTeeth: return {{228, 219, 200}, 0.30f, 0.22f, 0.040f};
    case MeshKind::kTongue: return {{172, 92, 88}, 0.40f, 0.30f, 0.035f};
    case MeshKind::kHair: return {{62, 46, 38}, 0.05f, 0.55f, 0.030f};
    case MeshKind::kCover: return {{150, 140, 135}, 0.10f, 0.30f, 0.040f};
    case MeshKind::kSkin: break;
  }
  return {{205, 170, 150}, 0.35f, 0.50f, 0.028f};
}

std::vector<uint8_t> read_mesh_colours(const RigFile& file, const std::string& name,
                                       uint32_t position_count, const Session& session) {
  const std::string wanted = "mien.colors." + name;
  for (uint32_t i = 0; i < file.info.metadata_count; ++i) {
    const std::string entry = "desc.metadata[" + std::to_string(i) + "]";
    if (to_string(read_text_field(file, entry + ".key")) != wanted) continue;
    std::vector<uint8_t> colors;
    const bool good = decode_base64(read_text_field(file, entry + ".value"), colors);
    if (good && colors.size() == size_t{position_count} * 3) return colors;
    note(session, file.shown + ", metadata " + wanted + ": " +
                      (good ? std::to_string(colors.size()) + " bytes are not three for each of " +
                                  std::to_string(position_count) + " positions"
                            : "this is not base64") +
                      "; the mesh is drawn without them");
  }
  return {};
}

std::vector<uint8_t> paint_eye(const float* positions, uint32_t position_count, Vec3 front) {
  constexpr Color kWhite = {232, 228, 222}, kIris = {92, 112, 116}, kRim = {40, 50, 54},
                  kPupil = {14, 13, 14};
  picture::Box box;
  for (uint32_t i = 0; i < position_count; ++i) box.add(picture::load3(positions, i));
  std::vector<uint8_t> colors(size_t{position_count} * 3);
  for (uint32_t i = 0; i < position_count; ++i) {
    const Vec3 from_centre = picture::load3(positions, i) - box.center();
    const float cosine = dot(picture::normalized(from_centre, -front), front);
    // Angles of a human eye: the pupil is 4 mm of 24 wide, the iris 12.
    const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f)) * 57.29578f;
    Vec3 color = to_linear(kPupil);
    // Borders are soft, since between the positions of a coarse mesh they would be crooked.
    for (const auto& [border, outside] :
         {std::pair{10.0f, kIris}, std::pair{24.0f, kRim}, std::pair{28.0f, kWhite}}) {
      color = mix(color, to_linear(outside), picture::saturate((angle - border) / 3 + 0.5f));
    }
    const Color painted = picture::to_srgb(color);
    colors[size_t{i} * 3] = painted.r;
    colors[size_t{i} * 3 + 1] = painted.g;
    colors[size_t{i} * 3 + 2] = painted.b;
  }
  return colors;
}

}  // namespace mien::cli
