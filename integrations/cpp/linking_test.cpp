// SPDX-License-Identifier: MIT
// Compiled twice into one program, with and without MIEN_EXCEPTIONS, in different C++ standards: each
// file keeps its own value().
#include <mien.hpp>

#ifdef MIEN_EXCEPTIONS

bool throws_from_value() {
  try {
    (void)mien::Dna::open("").value();
  } catch (const mien::Exception& exception) {
    return exception.error().status() != MIEN_OK;
  }
  return false;
}

#else

#include <csignal>
#include <cstdlib>

bool throws_from_value();

int main() {
  if (!throws_from_value()) return 1;
  // Without exceptions value() aborts: success is to end in this handler.
  std::signal(SIGABRT, [](int) { std::_Exit(0); });
  (void)mien::Dna::open("").value();
  return 1;
}

#endif
