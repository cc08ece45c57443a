// SPDX-License-Identifier: MIT
// Every kernel of the list is tested on every instruction set that this CPU has. Tests take their tables
// from present_kernels(), whose entries note that they were called; when all tests have run, an entry
// that none of them called is a failure.
#include "simd/kernel_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

enum KernelNumber {
#define MIEN_KERNEL_NUMBER(name, Type) kNumberOf_##name,
  MIEN_KERNELS(MIEN_KERNEL_NUMBER)
#undef MIEN_KERNEL_NUMBER
      kKernelCount
};

constexpr const char* kKernelNames[] = {
#define MIEN_KERNEL_NAME(name, Type) #name,
    MIEN_KERNELS(MIEN_KERNEL_NAME)
#undef MIEN_KERNEL_NAME
};

bool called[kIsaCount][kKernelCount] = {};

/// Notes the call of a kernel, and calls it.
template <uint32_t kIsaNumber, KernelNumber kNumber, class Kernel, Kernel* KernelTable::*kKernel>
struct Noted;
template <uint32_t kIsaNumber, KernelNumber kNumber, class Result, class... Args,
          Result (*KernelTable::*kKernel)(Args...)>
struct Noted<kIsaNumber, kNumber, Result(Args...), kKernel> {
  static Result call(Args... args) {
    called[kIsaNumber][kNumber] = true;
    return (kernels_for(static_cast<Isa>(kIsaNumber))->*kKernel)(args...);
  }
};

template <uint32_t kIsaNumber>
void add_table(std::vector<const KernelTable*>& tables) {
  const KernelTable* const table = kernels_for(static_cast<Isa>(kIsaNumber));
  if (!table) return;
#define MIEN_NOTED_KERNEL(name, Type) \
  Noted<kIsaNumber, kNumberOf_##name, Type, &KernelTable::name>::call,
  static const KernelTable noted = {table->isa, table->batch_step, table->name,
                                    MIEN_KERNELS(MIEN_NOTED_KERNEL)};
#undef MIEN_NOTED_KERNEL
  tables.push_back(&noted);
}

std::string uncalled_kernels(Isa isa) {
  std::string names;
  const bool* const calls = called[static_cast<uint32_t>(isa)];
  for (int i = 0; i < kKernelCount; ++i) {
    if (!calls[i]) names += std::string(names.empty() ? "" : ", ") + kKernelNames[i];
  }
  return names;
}

class EveryKernelIsCalled : public testing::Environment {
  void TearDown() override {
    const testing::UnitTest& program = *testing::UnitTest::GetInstance();
    if (program.test_to_run_count() != program.total_test_count()) return;  // only some were wanted
    for (const KernelTable* kernels : present_kernels()) {
      EXPECT_EQ(uncalled_kernels(kernels->isa), "") << "no test calls these on " << kernels->name;
    }
  }
};
[[maybe_unused]] const testing::Environment* const kEveryKernelIsCalled =
    testing::AddGlobalTestEnvironment(new EveryKernelIsCalled);

TEST(KernelList, HasNoNameTwice) {
  std::vector<std::string> names(std::begin(kKernelNames), std::end(kKernelNames));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(KernelList, EachTableHasAFunctionOfItsOwnForEachName) {
  for (const KernelTable* noted : present_kernels()) {
    const KernelTable& kernels = *kernels_for(noted->isa);
    const void* functions[] = {
#define MIEN_KERNEL_ADDRESS(name, Type) reinterpret_cast<const void*>(kernels.name),
        MIEN_KERNELS(MIEN_KERNEL_ADDRESS)
#undef MIEN_KERNEL_ADDRESS
    };
    std::sort(std::begin(functions), std::end(functions));
    EXPECT_NE(functions[0], nullptr) << kernels.name;
    EXPECT_EQ(std::adjacent_find(std::begin(functions), std::end(functions)), std::end(functions))
        << kernels.name << ": one function under two names";
  }
}

}  // namespace

const std::vector<const KernelTable*>& present_kernels() {
  static const std::vector<const KernelTable*> tables = [] {
    std::vector<const KernelTable*> present;
    add_table<uint32_t(Isa::kScalar)>(present);
    add_table<uint32_t(Isa::kSse2)>(present);
    add_table<uint32_t(Isa::kAvx2)>(present);
    add_table<uint32_t(Isa::kAvx512)>(present);
    add_table<uint32_t(Isa::kNeon)>(present);
    return present;
  }();
  return tables;
}

}  // namespace mien
