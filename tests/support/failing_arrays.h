// SPDX-License-Identifier: MIT
// Each array of an Arena is a request of its own, and each of them fails in turn.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "runtime/base/arena.h"
#include "runtime/base/status.h"
#include "tests/support/counting_allocator.h"

namespace mien {

/// `call(allocator, error)` gives back what it took. Number of requests.
template <class Call>
size_t fail_every_array(Call&& call) {
  const auto arrays_of = [](CountingAllocator& counter) {
    const MienAllocator given = counter.get();
    return Allocator{given.user, given.allocate, given.release, 0};
  };
  CountingAllocator all;
  Error error;
  EXPECT_EQ(call(arrays_of(all), error), Status::kOk) << error.message;
  EXPECT_TRUE(all.clean()) << all.first_wrong;
  for (size_t k = 1; k <= all.requests; ++k) {
    CountingAllocator counter;
    counter.fail_at = k;
    error = {};
    EXPECT_EQ(call(arrays_of(counter), error), Status::kMemory) << k << " of " << all.requests;
    EXPECT_NE(error.message[0], 0) << k;
    EXPECT_TRUE(counter.clean()) << k << ": " << counter.first_wrong;
    if (testing::Test::HasFailure()) break;
  }
  return all.requests;
}

}  // namespace mien
