// SPDX-License-Identifier: MIT
#include "integrations/gltf/look.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mien::gltf {

namespace {

struct Look {
  const char* part;  // of the mesh's name, in lower case
  Material material;
};

// The first that is in the name holds: an eyelash is no eye.
const Look kLooks[] = {
    {"teeth", {"teeth", {0.80, 0.74, 0.62, 1}, 0.30, false}},
    {"gum", {"gums", {0.55, 0.20, 0.19, 1}, 0.35, false}},
    {"tongue", {"tongue", {0.55, 0.18, 0.18, 1}, 0.40, false}},
    {"mouth", {"mouth", {0.32, 0.09, 0.09, 1}, 0.50, true}},
    {"lash", {"lashes", {0.02, 0.015, 0.01, 1}, 0.70, true}},
    {"brow", {"brows", {0.06, 0.035, 0.02, 1}, 0.80, true}},
    {"hair", {"hair", {0.06, 0.035, 0.02, 1}, 0.60, true}},
    {"saliva", {"film", {1, 1, 1, 0.1}, 0.05, false}},
    {"tear", {"film", {1, 1, 1, 0.1}, 0.05, false}},
    {"eyeshell", {"film", {1, 1, 1, 0.1}, 0.05, false}},
    {"eyeedge", {"film", {1, 1, 1, 0.1}, 0.05, false}},
    {"cartilage", {"cartilage", {0.62, 0.28, 0.24, 1}, 0.40, true}},
    {"eye", {"eyes", {0.85, 0.84, 0.82, 1}, 0.08, false}},
};
const Material kSkin = {"skin", {0.74, 0.49, 0.39, 1}, 0.55, false};

constexpr const char* kColorKey = "mien.colors.";

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  }
  return text;
}

std::string read_string(const RigSource& source, const std::string& path) {
  MienStringView view{};
  check(mien_dna_read_string(source.dna(), path.c_str(), &view, nullptr), "cannot read metadata");
  return std::string(view.data, view.count);
}

/// -1 for what is no digit of base64.
int digit_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool decode_base64(const std::string& text, std::vector<uint8_t>& bytes) {
  size_t digits = text.size();
  while (digits > 0 && text.size() - digits < 2 && text[digits - 1] == '=') --digits;
  if (text.size() % 4 != 0 || digits % 4 == 1) return false;
  uint32_t bits = 0;
  for (size_t i = 0; i < digits; ++i) {
    const int value = digit_value(text[i]);
    if (value < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(value);
    // Each digit after the first of four completes a byte.
    if (i % 4 != 0) bytes.push_back(static_cast<uint8_t>(bits >> (6 - 2 * (i % 4))));
  }
  return true;
}

}  // namespace

Material material_for(const std::string& mesh_name, bool has_vertex_colors) {
  const std::string name = lower(mesh_name);
  const auto found = std::find_if(std::begin(kLooks), std::end(kLooks), [&](const Look& look) {
    return name.find(look.part) != std::string::npos;
  });
  Material material = found == std::end(kLooks) ? kSkin : found->material;
  if (has_vertex_colors) {
    material.name += " (vertex colors)";
    material.color = {1, 1, 1, material.color[3]};
  }
  return material;
}

std::vector<Color> position_colors(const RigSource& source, const std::string& mesh_name,
                                   size_t position_count) {
  const uint32_t pairs = source.info().metadata_count;
  for (uint32_t i = 0; i < pairs; ++i) {
    const std::string pair = "desc.metadata[" + std::to_string(i) + "]";
    if (read_string(source, pair + ".key") != kColorKey + mesh_name) continue;
    std::vector<uint8_t> bytes;
    if (!decode_base64(read_string(source, pair + ".value"), bytes) ||
        bytes.size() != 3 * position_count) {
      throw ExportError(MIEN_ERROR_DNA_VALUE, pair,
                        "the colors " + (kColorKey + mesh_name) +
                            " are not base64 of 3 bytes for each of " +
                            std::to_string(position_count) + " positions",
                        "correct or remove them");
    }
    std::vector<Color> colors(position_count);
    if (!bytes.empty()) std::memcpy(colors.data(), bytes.data(), bytes.size());
    return colors;
  }
  return {};
}

std::array<uint16_t, 4> linear_color(const Color& color) {
  std::array<uint16_t, 4> result{0, 0, 0, 65535};
  for (size_t i = 0; i < 3; ++i) {
    // The curve of sRGB, IEC 61966-2-1.
    const double c = color[i] / 255.0;
    const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    result[i] = static_cast<uint16_t>(std::lround(linear * 65535));
  }
  return result;
}

}  // namespace mien::gltf
