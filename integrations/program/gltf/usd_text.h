// SPDX-License-Identifier: MIT
// Pieces of USD text.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "integrations/program/gltf/scene.h"

namespace mien::gltf {

/// Text with the indentation of the prim that is being written.
class UsdText {
 public:
  /// `what` is for messages about numbers that are not finite.
  void about(const std::string& what) { what_ = what; }

  void line(const std::string& text, const std::vector<std::string>& metadata = {});
  /// "def Mesh "head" (", metadata, ") {"; the metadata are lines of their own, or none.
  void begin_prim(const std::string& type, const std::string& name,
                  const std::vector<std::string>& metadata = {});
  void end_prim();

  /// "NAME = [(0, 1, 2), ...]" or, with time codes, one entry of a list of samples.
  template <class Values, class Write>
  void array(const std::string& name, const Values& values, const Write& write,
             const std::vector<std::string>& metadata = {}) {
    indent();
    text_ += name + " = ";
    list(values, write);
    end_line(metadata);
  }

  template <class Values, class Write>
  void sample(size_t time, const Values& values, const Write& write) {
    indent();
    text_ += std::to_string(time) + ": ";
    list(values, write);
    text_ += ",\n";
  }

  void begin_samples(const std::string& name) {
    line(name + ".timeSamples = {");
    ++depth_;
  }
  void end_samples() {
    --depth_;
    line("}");
  }

  /// The shortest digits that give the number back. Throws ExportError if it is not finite.
  void number(double value);
  void number(float value);
  void number(uint32_t value) { text_ += std::to_string(value); }
  template <class Vector>
  void tuple(const Vector& values) {
    text_ += "(";
    for (size_t i = 0; i < values.size(); ++i) {
      if (i != 0) text_ += ", ";
      number(values[i]);
    }
    text_ += ")";
  }
  void token(const std::string& text);
  void raw(const std::string& text) { text_ += text; }

  /// "NAME = VALUE" of a number or of an array of numbers, which becomes a tuple.
  void value(const std::string& name, double value) {
    indent();
    text_ += name + " = ";
    number(value);
    text_ += "\n";
  }
  template <size_t n>
  void value(const std::string& name, const std::array<double, n>& values) {
    indent();
    text_ += name + " = ";
    tuple(values);
    text_ += "\n";
  }

  std::string take() { return std::move(text_); }

 private:
  template <class Values, class Write>
  void list(const Values& values, const Write& write) {
    text_ += "[";
    bool first = true;
    for (const auto& value : values) {
      if (!first) text_ += ", ";
      first = false;
      write(*this, value);
    }
    text_ += "]";
  }
  void indent() { text_.append(depth_ * 4, ' '); }
  /// Metadata each on a line of its own, as other programs write it.
  void end_line(const std::vector<std::string>& metadata);

  std::string text_, what_;
  size_t depth_ = 0;
};

/// In double quotes, with escapes; bytes that are not UTF-8 are replaced.
std::string usd_string(const std::string& text);

/// Names of prims with one parent: valid, and each once.
class PrimNames {
 public:
  std::string take(const std::string& name);

 private:
  std::set<std::string> taken_;
};

}  // namespace mien::gltf
