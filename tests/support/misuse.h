// SPDX-License-Identifier: MIT
// For tests that call the C interface wrongly: one live handle of each kind, and a caller that
// hands over dirty outputs and looks what becomes of them.
#pragma once

#include <cstring>
#include <list>
#include <string>
#include <vector>

#include "tests/support/bytes.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {

/// Counts what is live, and never uses a block again.
struct KeepingAllocator {
  std::list<std::vector<uint8_t>> blocks;
  size_t live_bytes = 0;
  MienAllocator interface = {this, allocate, release};

  static void* allocate(void* user, size_t size, size_t alignment) {
    KeepingAllocator& self = *static_cast<KeepingAllocator*>(user);
    self.live_bytes += size;
    self.blocks.emplace_back(size + alignment);
    uintptr_t at = reinterpret_cast<uintptr_t>(self.blocks.back().data());
    at = (at + alignment - 1) / alignment * alignment;
    return reinterpret_cast<void*>(at);
  }
  static void release(void* user, void*, size_t size, size_t) {
    static_cast<KeepingAllocator*>(user)->live_bytes -= size;
  }
};

/// A struct with more behind it, as a program built with a later header would hand it over.
template <class T>
struct Longer {
  static constexpr size_t kTail = 24;
  T known = sized<T>();
  uint8_t tail[kTail] = {};

  Longer() { known.struct_size = sizeof(Longer); }
  bool tail_is(uint8_t value) const {
    for (uint8_t byte : tail) {
      if (byte != value) return false;
    }
    return true;
  }
};

template <class T>
void dirty(T& value) {
  memset(static_cast<void*>(&value), 0xA5, sizeof(value));
}
template <class T>
T dirty_struct() {
  T value;
  dirty(value);
  value.struct_size = sizeof(T);
  return value;
}

/// All bytes zero, but for the size in front.
template <class T>
bool is_cleared(const T& value, bool has_size) {
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(&value);
  for (size_t i = has_size ? sizeof(size_t) : 0; i < sizeof(T); ++i) {
    if (bytes[i] != 0) return false;
  }
  return true;
}

class Misuse : public testing::Test {
 protected:
  void SetUp() override {
    Arena arena(default_allocator());
    bytes = write_view(dna::tiny_rig(arena));
    MienDnaDesc open = sized<MienDnaDesc>();
    open.allocator = &kept.interface;
    ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &open, &dna, nullptr), MIEN_OK);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.allocator = &kept.interface;
    ASSERT_EQ(mien_rig_create(dna, &desc, &rig, nullptr), MIEN_OK);
    const auto plain = desc_with<MienInstanceDesc>(&kept.interface);
    ASSERT_EQ(mien_instance_create(rig, &plain, &instance, nullptr), MIEN_OK);
    const auto validate = desc_with<MienValidateDesc>(&kept.interface);
    ASSERT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), &validate, &report, nullptr),
              MIEN_OK);
  }
  void TearDown() override {
    mien_report_destroy(report);
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
    EXPECT_EQ(kept.live_bytes, 0u);
  }

  KeepingAllocator kept;
  Bytes bytes;  // the file: a rig that has some of everything
  MienDna* dna = nullptr;
  MienReport* report = nullptr;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
};

struct Outcome {
  const char* call;
  MienStatus status;
  bool cleared;  // all outputs, if it failed
  bool told;     // the error, if it takes one
};

/// Runs calls with dirty outputs and notes what became of them.
struct Caller {
  std::vector<Outcome> outcomes;

  template <class Out, class Call>
  void plain(const char* name, Call&& call) {
    Out out;
    dirty(out);
    const MienStatus status = call(&out);
    outcomes.push_back({name, status, is_cleared(out, false), true});
  }
  template <class Out, class Call>
  void into_struct(const char* name, Call&& call) {
    Out out = dirty_struct<Out>();
    const MienStatus status = call(&out);
    outcomes.push_back({name, status, is_cleared(out, true), true});
  }
  template <class Out, class Call>
  void with_error(const char* name, Call&& call) {
    MienError error = dirty_struct<MienError>();
    Out out;
    dirty(out);
    const MienStatus status = call(&out, &error);
    outcomes.push_back({name, status, is_cleared(out, false), tells(error, status)});
  }
  template <class Call>
  void only_error(const char* name, Call&& call) {
    MienError error = dirty_struct<MienError>();
    const MienStatus status = call(&error);
    outcomes.push_back({name, status, true, tells(error, status)});
  }
  template <class Call>
  void nothing(const char* name, Call&& call) {
    outcomes.push_back({name, call(), true, true});
  }

  static bool tells(const MienError& error, MienStatus status) {
    if (error.status != status) return false;
    if (status == MIEN_OK) return true;
    const size_t length = strnlen(error.message, sizeof(error.message));
    return length > 0 && length < sizeof(error.message) && error.byte_offset == MIEN_NO_OFFSET;
  }
};

inline void expect_all(const std::vector<Outcome>& outcomes, MienStatus status) {
  for (const Outcome& o : outcomes) {
    EXPECT_EQ(o.status, status) << o.call;
    EXPECT_TRUE(status == MIEN_OK || o.cleared) << o.call << " left its output dirty";
    EXPECT_TRUE(o.told) << o.call << " does not say what is wrong";
  }
}

}  // namespace mien
