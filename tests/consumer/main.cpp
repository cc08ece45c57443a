// SPDX-License-Identifier: MIT
// The same as main.c, with owners that C++ has for such handles.
#include <mien.h>

#include <cstdio>
#include <memory>

template <auto destroy>
struct Destroy {
  template <class Handle>
  void operator()(Handle* handle) const {
    destroy(handle);
  }
};

int main() {
  MienError error = {};
  error.struct_size = sizeof error;

  MienDna* dna_handle = nullptr;
  mien_dna_generate(nullptr, &dna_handle, &error);
  std::unique_ptr<MienDna, Destroy<mien_dna_close>> dna(dna_handle);

  MienRig* rig_handle = nullptr;
  if (dna) mien_rig_create(dna.get(), nullptr, &rig_handle, &error);
  std::unique_ptr<MienRig, Destroy<mien_rig_destroy>> rig(rig_handle);

  MienRigInfo info = {};
  info.struct_size = sizeof info;
  if (!rig || mien_rig_info(rig.get(), &info) != MIEN_OK) {
    std::fprintf(stderr, "mien: %s\n", error.message);
    return 1;
  }
  std::printf("%u LODs on %s\n", info.lod_count, mien_isa_name(info.isa));
  return info.lod_count > 0 ? 0 : 1;
}
