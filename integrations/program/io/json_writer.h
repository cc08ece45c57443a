// SPDX-License-Identifier: MIT
// JSON, written to an output while it is made.
#pragma once

#include <string>
#include <string_view>

#include "author/text/json_writer.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

/// Text on its way to an output, in blocks.
class OutputText {
 public:
  explicit OutputText(Output& output) : output_(output) {}

  void append(std::string_view text) {
    text_ += text;
    if (text_.size() >= kBlockBytes) flush();
  }

  void flush() {
    output_.write(text_);
    text_.clear();
  }

 private:
  static constexpr size_t kBlockBytes = 64 * 1024;
  Output& output_;
  std::string text_;
};

/// See mien::JsonWriter. Nothing is complete before finish().
class JsonWriter : private OutputText, public mien::JsonWriter<OutputText> {
 public:
  explicit JsonWriter(Output& output)
      : OutputText(output), mien::JsonWriter<OutputText>(static_cast<OutputText&>(*this)) {}

  /// Ends the text and hands it to the output.
  void finish() {
    append("\n");
    flush();
  }
};

}  // namespace mien::cli
