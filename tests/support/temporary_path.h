// SPDX-License-Identifier: MIT
// Where tests write files. Runs of a test at the same time, such as those of builds for several
// platforms, do not share them.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace mien {

inline std::string temporary_path(const std::string& name) {
  static const std::string run = std::to_string(std::random_device()());
  return testing::TempDir() + "mien_" + run + "_" + name;
}

}  // namespace mien
