// SPDX-License-Identifier: MIT
// A fuzzer without libFuzzer: runs its kept inputs once. `corpus.py replay` calls it.
//
//     replay_fuzz_NAME FOLDER
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

// What mutators call; they are linked, and do not run.
extern "C" size_t LLVMFuzzerMutate(uint8_t*, size_t, size_t);
extern "C" size_t LLVMFuzzerMutate(uint8_t*, size_t size, size_t) { return size; }

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  int count = 0;
  LLVMFuzzerInitialize(&argc, &argv);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    // To be read when an input ends the program.
    std::fprintf(stderr, "%s\n", entry.path().filename().string().c_str());
    LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    ++count;
  }
  std::printf("%d inputs\n", count);
  return count == 0;
}
