// SPDX-License-Identifier: MIT
#include "integrations/program/io/mesh_appearance.h"

#include <cctype>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"

namespace mien::cli {

namespace {

struct Word {
  const char* word;
  MeshClass mesh_class;
};

// The first word that a name contains decides: an eyelash is not an eye.
constexpr Word kWords[] = {
    {"eyeshell", MeshClass::kFilm}, {"eyeedge", MeshClass::kFilm},
    {"cornea", MeshClass::kFilm},   {"occlusion", MeshClass::kFilm},
    {"shell", MeshClass::kFilm},    {"saliva", MeshClass::kFilm},
    {"tear", MeshClass::kFilm},     {"cartilage", MeshClass::kCartilage},
    {"lash", MeshClass::kLash},     {"teeth", MeshClass::kTeeth},
    {"tooth", MeshClass::kTeeth},   {"gum", MeshClass::kGums},
    {"tongue", MeshClass::kTongue}, {"brow", MeshClass::kBrow},
    {"hair", MeshClass::kHair},     {"beard", MeshClass::kHair},
    {"eyelid", MeshClass::kSkin},   {"eye", MeshClass::kEye},
    {"iris", MeshClass::kEye},      {"pupil", MeshClass::kEye},
    {"mouth", MeshClass::kMouth},
};

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// False if `text` is not padded base64.
bool decode_base64(MienStringView text, std::vector<uint8_t>& bytes) {
  size_t digits = text.count;
  while (digits > 0 && text.count - digits < 2 && text.data[digits - 1] == '=') --digits;
  if (text.count % 4 != 0 || digits % 4 == 1) return false;
  bytes.reserve(digits / 4 * 3 + 2);
  uint32_t bits = 0;
  for (size_t i = 0; i < digits; ++i) {
    const int digit = base64_digit(text.data[i]);
    if (digit < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    // Each digit after the first of four completes a byte.
    if (i % 4 != 0) bytes.push_back(static_cast<uint8_t>(bits >> (6 - 2 * (i % 4))));
  }
  return true;
}

MienStringView read_text(const MienDna* dna, const std::string& path) {
  MienStringView text{};
  auto error = sized<MienError>();
  check(mien_dna_read_string(dna, path.c_str(), &text, &error), &error, "cannot read " + path, "");
  return text;
}

}  // namespace

MeshClass mesh_class(const std::string& name) {
  std::string lower;
  for (const char c : name) {
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const Word& entry : kWords) {
    if (lower.find(entry.word) != std::string::npos) return entry.mesh_class;
  }
  return MeshClass::kSkin;
}

bool needs_textures(MeshClass mesh_class) {
  return mesh_class == MeshClass::kFilm || mesh_class == MeshClass::kLash ||
         mesh_class == MeshClass::kCartilage;
}

VertexColors read_vertex_colors(const MienDna* dna, const std::string& mesh,
                                size_t position_count) {
  const std::string wanted = "mien.colors." + mesh;
  auto info = sized<MienDnaInfo>();
  check(mien_dna_info(dna, &info), nullptr, "cannot read metadata", "");
  for (uint32_t i = 0; i < info.metadata_count; ++i) {
    const std::string entry = "desc.metadata[" + std::to_string(i) + "]";
    if (to_string(read_text(dna, entry + ".key")) != wanted) continue;
    VertexColors colors;
    if (!decode_base64(read_text(dna, entry + ".value"), colors.rgb)) {
      return {{}, "metadata " + wanted + " is not base64"};
    }
    if (colors.rgb.size() != 3 * position_count) {
      return {{},
              "metadata " + wanted + " has " + std::to_string(colors.rgb.size()) + " bytes; " +
                  std::to_string(position_count) + " positions need " +
                  std::to_string(3 * position_count)};
    }
    return colors;
  }
  return {};
}

}  // namespace mien::cli
