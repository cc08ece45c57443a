// SPDX-License-Identifier: MIT
// Every call of mien.h with numbers, names and choices that are wrong.
#include <cstdlib>

#include "tests/support/misuse.h"

namespace mien {
namespace {

// Values ------------------------------------------------------------------------------------------

template <class Change>
MienStatus open_with(const Bytes& bytes, MienError* error, Change&& change) {
  MienDnaDesc desc = sized<MienDnaDesc>();
  change(desc);
  MienDna* opened = reinterpret_cast<MienDna*>(&desc);
  const MienStatus status = mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &opened, error);
  EXPECT_EQ(opened == nullptr, status != MIEN_OK);
  mien_dna_close(opened);
  return status;
}

TEST_F(Misuse, ValuesOutsideTheirRange) {
  const MienAllocator no_allocate = {nullptr, nullptr, KeepingAllocator::release};
  const MienAllocator no_release = {nullptr, KeepingAllocator::allocate, nullptr};
  Caller c;
  auto open = [&](const char* name, auto change) {
    c.only_error(name, [&](MienError* e) { return open_with(bytes, e, change); });
  };
  open("layers", [](auto& d) { d.layers = 256; });
  open("skip targets", [](auto& d) { d.skip_blend_shape_targets = 2; });
  open("all bits", [](auto& d) { d.layers = ~0u; });
  open("unknown layers", [](auto& d) { d.unknown_layers = 2; });
  open("file access", [](auto& d) { d.file_access = 2; });
  open("no allocate", [&](auto& d) { d.allocator = &no_allocate; });
  open("no release", [&](auto& d) { d.allocator = &no_release; });

  auto write = [&](const char* name, auto change) {
    c.with_error<size_t>(name, [&](auto* o, auto* e) {
      MienWriteDesc desc = sized<MienWriteDesc>();
      change(desc);
      return mien_dna_write_memory(dna, &desc, nullptr, 0, o, e);
    });
  };
  write("version", [](auto& d) { d.version = 9; });
  write("version 65537", [](auto& d) { d.version = 65537; });
  write("unknown layers", [](auto& d) { d.unknown_layers = 2; });

  c.with_error<MienDna*>("preset", [&](auto* o, auto* e) {
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.preset = MIEN_PRESET_ARCHETYPE + 1;
    return mien_dna_generate(&desc, o, e);
  });
  c.with_error<MienDna*>("generate flags", [&](auto* o, auto* e) {
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.flags = 2;
    return mien_dna_generate(&desc, o, e);
  });
  c.with_error<MienDna*>("generate without release", [&](auto* o, auto* e) {
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.allocator = &no_release;
    return mien_dna_generate(&desc, o, e);
  });
  c.with_error<MienRig*>("isa", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = MIEN_ISA_NEON + 1;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienRig*>("rotation", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.rotation_output = MIEN_ROTATION_OUTPUT_QUATERNION + 1;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienRig*>("masks", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.ml_masks = MIEN_ML_MASKS_BLEND + 1;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienRig*>("storage", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.storage = MIEN_STORAGE_16_BIT + 1;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienRig*>("reuse", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.reuse = MIEN_REUSE_SUMS + 1;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienRig*>("rig without allocate", [&](auto* o, auto* e) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.allocator = &no_allocate;
    return mien_rig_create(dna, &desc, o, e);
  });
  c.with_error<MienInstance*>("instance without allocate", [&](auto* o, auto* e) {
    const auto desc = desc_with<MienInstanceDesc>(&no_allocate);
    return mien_instance_create(rig, &desc, o, e);
  });
  c.with_error<MienReport*>("report without release", [&](auto* o, auto* e) {
    const auto desc = desc_with<MienValidateDesc>(&no_release);
    return mien_dna_validate_memory(bytes.data(), bytes.size(), &desc, o, e);
  });
  c.with_error<MienReport*>("report of a file without release", [&](auto* o, auto* e) {
    const auto desc = desc_with<MienValidateDesc>(&no_release);
    return mien_dna_validate_file("/dev/null", &desc, o, e);
  });

  c.plain<uint32_t>("count", [&](auto* o) { return mien_rig_count(rig, 13, o); });
  c.plain<MienStringView>("name", [&](auto* o) { return mien_rig_name(rig, 13, 0, o); });
  c.plain<uint32_t>("find", [&](auto* o) { return mien_rig_find(rig, 13, "a", o); });
  for (uint32_t kind = MIEN_KIND_JOINT_GROUP; kind <= MIEN_KIND_TWIST_SWING; ++kind) {
    c.plain<uint32_t>("find nameless", [&](auto* o) { return mien_rig_find(rig, kind, "", o); });
  }
  for (uint32_t kind : std::initializer_list<uint32_t>{
           MIEN_KIND_GUI_CONTROL, MIEN_KIND_RAW_CONTROL, MIEN_KIND_PSD_CONTROL,
           MIEN_KIND_ML_CONTROL, MIEN_KIND_RBF_CONTROL, MIEN_KIND_ML_MASK, MIEN_KIND_JOINT_GROUP,
           MIEN_KIND_TWIST_SWING, MIEN_KIND_TWIST_SWING + 1}) {
    c.plain<MienIndex16View>("lod_indices",
                             [&](auto* o) { return mien_rig_lod_indices(rig, kind, 0, o); });
  }
  c.nothing("stages", [&] { return mien_rig_evaluate_stages(rig, instance, 0, 64); });
  c.nothing("stages", [&] { return mien_rig_evaluate_stages(rig, instance, 0, ~0u); });
  expect_all(c.outcomes, MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_stages(rig, instance, 0, 0), MIEN_OK) << "no stages are few stages";
}

TEST_F(Misuse, LodsThatAreNotThere) {
  MienRigInfo info = sized<MienRigInfo>();
  ASSERT_EQ(mien_rig_info(rig, &info), MIEN_OK);
  for (uint32_t lod : {info.lod_count, info.lod_count + 1, 33u, 64u, UINT32_MAX}) {
    Caller c;
    c.plain<MienIndex16View>(
        "lod_indices", [&](auto* o) { return mien_rig_lod_indices(rig, MIEN_KIND_MESH, lod, o); });
    c.plain<MienIndex16View>("variable_joint_values",
                             [&](auto* o) { return mien_rig_variable_joint_values(rig, lod, o); });
    c.into_struct<MienRigStatistics>("statistics",
                                     [&](auto* o) { return mien_rig_statistics(rig, lod, o); });
    c.nothing("evaluate", [&] { return mien_rig_evaluate(rig, instance, lod); });
    c.nothing("stages", [&] { return mien_rig_evaluate_stages(rig, instance, lod, 1); });
    c.nothing("group", [&] { return mien_rig_evaluate_joint_group(rig, instance, lod, 0); });
    c.nothing("solver", [&] { return mien_rig_evaluate_rbf_solver(rig, instance, lod, 0); });
    c.nothing("setup", [&] { return mien_rig_evaluate_twist_swing(rig, instance, lod, 0); });
    if (lod < 64) {
      c.only_error("open", [&](MienError* e) {
        return open_with(bytes, e, [&](MienDnaDesc& d) { d.lods = ~uint64_t{0} << lod; });
      });
    }
    expect_all(c.outcomes, MIEN_ERROR_LOD);
  }
  // Some that are there are enough.
  EXPECT_EQ(open_with(bytes, nullptr, [](auto& d) { d.lods = ~uint64_t{0}; }), MIEN_OK);
  EXPECT_EQ(open_with(bytes, nullptr, [](auto& d) { d.lods = uint64_t{1} << 63 | 1; }), MIEN_OK);
}

TEST_F(Misuse, IndicesPastTheEnd) {
  MienDnaInfo dna_info = sized<MienDnaInfo>();
  ASSERT_EQ(mien_dna_info(dna, &dna_info), MIEN_OK);
  Caller c;
  for (uint32_t past : {dna_info.layer_count, UINT32_MAX}) {
    c.into_struct<MienDnaLayer>("layer", [&](auto* o) { return mien_dna_layer(dna, past, o); });
  }
  for (uint32_t past : {0u, UINT32_MAX}) {  // a clean file
    c.into_struct<MienFinding>("finding",
                               [&](auto* o) { return mien_report_finding(report, past, o); });
  }
  for (uint32_t kind = MIEN_KIND_GUI_CONTROL; kind <= MIEN_KIND_TWIST_SWING; ++kind) {
    uint32_t count = 0;
    ASSERT_EQ(mien_rig_count(rig, kind, &count), MIEN_OK);
    for (uint32_t past : {count, UINT32_MAX}) {
      c.plain<MienStringView>("name", [&](auto* o) { return mien_rig_name(rig, kind, past, o); });
    }
  }
  uint32_t groups = 0, solvers = 0, setups = 0;
  ASSERT_EQ(mien_rig_count(rig, MIEN_KIND_JOINT_GROUP, &groups), MIEN_OK);
  ASSERT_EQ(mien_rig_count(rig, MIEN_KIND_RBF_SOLVER, &solvers), MIEN_OK);
  ASSERT_EQ(mien_rig_count(rig, MIEN_KIND_TWIST_SWING, &setups), MIEN_OK);
  for (uint32_t more : {0u, 1u, UINT32_MAX / 2}) {
    c.nothing("group",
              [&] { return mien_rig_evaluate_joint_group(rig, instance, 0, groups + more); });
    c.nothing("solver",
              [&] { return mien_rig_evaluate_rbf_solver(rig, instance, 0, solvers + more); });
    c.nothing("setup",
              [&] { return mien_rig_evaluate_twist_swing(rig, instance, 0, setups + more); });
  }
  for (uint32_t past : {dna_info.psd_control_count, UINT32_MAX}) {
    c.plain<MienIndex16View>("psd", [&](auto* o) { return mien_rig_psd_inputs(rig, past, o); });
  }

  float number = 7;
  int64_t integer = 7;
  const uint64_t joints = dna_info.joint_count;
  const struct {
    uint64_t first, count;
  } ranges[] = {{0, joints + 1}, {joints, 1},        {joints + 1, 0}, {UINT64_MAX, 0},
                {1, joints},     {UINT64_MAX, 1},    {1, UINT64_MAX}, {0, UINT64_MAX},
                {joints, ~0ull}, {~0ull, UINT64_MAX}};
  for (const auto& range : ranges) {
    c.only_error("floats", [&](auto* e) {
      return mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", range.first, range.count,
                                  &number, e);
    });
    c.only_error("integers", [&](auto* e) {
      return mien_dna_read_integers(dna, "defn.jointHierarchy", range.first, range.count, &integer,
                                    e);
    });
  }
  c.only_error("one", [&](auto* e) {
    return mien_dna_read_integers(dna, "desc.lodCount", 0, 2, &integer, e);
  });
  c.with_error<MienStringView>(
      "field name", [&](auto* o, auto* e) { return mien_dna_child_name(dna, "desc", 12, o, e); });
  c.with_error<MienStringView>("layer name", [&](auto* o, auto* e) {
    return mien_dna_child_name(dna, "", UINT32_MAX, o, e);
  });
  expect_all(c.outcomes, MIEN_ERROR_INDEX);
  EXPECT_EQ(number, 7);
  EXPECT_EQ(integer, 7);
}

TEST_F(Misuse, PathsThatLeadNowhere) {
  const char* const names[] = {"x",
                               "Desc",
                               "desc ",
                               " desc",
                               "desc.",
                               ".desc",
                               "desc..name",
                               "desc.nam",
                               "desc.names",
                               "desc.name.x",
                               "desc.name[0]",
                               "desc[0]",
                               "[0]",
                               "[",
                               "]",
                               ".",
                               "desc.lodCount[0]",
                               "desc.metadata[0]key",
                               "desc.metadata.key",
                               "defn.jointNames[",
                               "defn.jointNames[]",
                               "defn.jointNames[0",
                               "defn.jointNames[-1]",
                               "defn.jointNames[+1]",
                               "defn.jointNames[ 0]",
                               "defn.jointNames[0x0]",
                               "defn.jointNames[0 ]",
                               "defn.jointNames[0][0]",
                               "defn.jointNames]0[",
                               "defn.jointNames[0].",
                               "defn.jointHierarchy[0][0]",
                               "defn.jointHierarchy[0].x",
                               "defn.jointNames.0",
                               "desc.name\n",
                               "bhvr.joints.jointGroups[0]values"};
  const char* const indices[] = {"defn.jointNames[100000]",
                                 "defn.jointNames[4294967295]",
                                 "defn.jointNames[4294967296]",
                                 "defn.jointNames[18446744073709551616]",
                                 "defn.jointNames[99999999999999999999999999999999999999999999]",
                                 "defn.jointHierarchy[4294967296]",
                                 "geom.meshes[77].positions.xs",
                                 "desc.metadata[4294967297].key"};
  auto check = [&](const std::string& path, MienStatus expected) {
    MienError error = sized<MienError>();
    MienDnaField field = dirty_struct<MienDnaField>();
    EXPECT_EQ(mien_dna_field(dna, path.c_str(), &field, &error), expected) << path;
    EXPECT_TRUE(is_cleared(field, true)) << path;
    EXPECT_EQ(error.status, expected) << path;
    EXPECT_GT(strlen(error.message), 0u) << path;
    float number;
    int64_t integer;
    MienStringView text = {"x", 1};
    EXPECT_EQ(mien_dna_read_floats(dna, path.c_str(), 0, 1, &number, nullptr), expected);
    EXPECT_EQ(mien_dna_read_integers(dna, path.c_str(), 0, 1, &integer, nullptr), expected);
    EXPECT_EQ(mien_dna_read_string(dna, path.c_str(), &text, nullptr), expected);
    EXPECT_EQ(text.data, nullptr);
    text = {"x", 1};
    EXPECT_EQ(mien_dna_child_name(dna, path.c_str(), 0, &text, nullptr), expected) << path;
    EXPECT_EQ(text.data, nullptr);
  };
  for (const char* path : names) check(path, MIEN_ERROR_NAME);
  for (const char* path : indices) check(path, MIEN_ERROR_INDEX);
  check(std::string(100000, 'x'), MIEN_ERROR_NAME);
  check("desc." + std::string(100000, 'x'), MIEN_ERROR_NAME);

  MienError error = sized<MienError>();
  MienDnaField field = sized<MienDnaField>();
  (void)mien_dna_field(dna, "bhvr.joints.jointGroup[7].values", &field, &error);
  EXPECT_NE(std::string(error.message).find("jointGroup[7].values\" is not a field"),
            std::string::npos)
      << error.message;
}

TEST_F(Misuse, FieldsOfAnotherType) {
  Caller c;
  float number;
  int64_t integer;
  for (const char* path : {"", "desc", "defn.jointNames", "desc.name", "desc.lodCount",
                           "defn.jointHierarchy", "dsce.rotationSign.x", "dsce.faceWindingOrder"}) {
    c.only_error(path, [&](auto* e) { return mien_dna_read_floats(dna, path, 0, 0, &number, e); });
  }
  for (const char* path : {"", "desc", "defn.jointNames", "desc.name",
                           "defn.neutralJointTranslations.xs", "bhvr.controls.psds.values[0]"}) {
    c.only_error(path,
                 [&](auto* e) { return mien_dna_read_integers(dna, path, 0, 0, &integer, e); });
  }
  for (const char* path : {"", "desc", "defn.jointNames", "desc.lodCount", "defn.jointHierarchy"}) {
    c.with_error<MienStringView>(
        path, [&](auto* o, auto* e) { return mien_dna_read_string(dna, path, o, e); });
  }
  for (const char* path : {"desc.name", "desc.lodCount", "defn.jointNames"}) {
    c.with_error<MienStringView>(
        path, [&](auto* o, auto* e) { return mien_dna_child_name(dna, path, 0, o, e); });
  }
  expect_all(c.outcomes, MIEN_ERROR_INVALID_ARGUMENT);
}

TEST_F(Misuse, RigsNeedTheirLayers) {
  for (uint32_t layers : {MIEN_LAYER_DESCRIPTOR, MIEN_LAYER_DEFINITION, MIEN_LAYER_GEOMETRY,
                          MIEN_LAYER_JOINT_BEHAVIOR_METADATA}) {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.layers = layers;
    MienDna* part = nullptr;
    ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &part, nullptr), MIEN_OK);
    Caller c;
    c.with_error<MienRig*>("rig",
                           [&](auto* o, auto* e) { return mien_rig_create(part, nullptr, o, e); });
    expect_all(c.outcomes, MIEN_ERROR_DNA_LAYER);
    mien_dna_close(part);
  }
}

TEST_F(Misuse, BufferTooSmall) {
  MienError error = sized<MienError>();
  for (size_t capacity : {size_t{1}, bytes.size() - 1}) {
    Bytes buffer(bytes.size(), 0xA5);
    size_t size = 0;
    EXPECT_EQ(mien_dna_write_memory(dna, nullptr, buffer.data(), capacity, &size, &error),
              MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(size, bytes.size()) << "the size that it takes";
    EXPECT_EQ(error.status, MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(buffer, Bytes(bytes.size(), 0xA5));
  }
  Bytes roomy(bytes.size() + 9, 0xA5);
  size_t size = 0;
  EXPECT_EQ(mien_dna_write_memory(dna, nullptr, roomy.data(), roomy.size(), &size, &error),
            MIEN_OK);
  EXPECT_EQ(size, bytes.size());
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), roomy.begin()));
  EXPECT_EQ(Bytes(roomy.end() - 9, roomy.end()), Bytes(9, 0xA5));
}

// Instruction sets --------------------------------------------------------------------------------

class IsaChoice : public Misuse {
 protected:
  IsaChoice() {
    if (const char* value = getenv("MIEN_ISA")) before = value;
  }
  ~IsaChoice() override {
    if (before.empty()) {
      unsetenv("MIEN_ISA");
    } else {
      setenv("MIEN_ISA", before.c_str(), 1);
    }
  }
  void SetUp() override {
    unsetenv("MIEN_ISA");
    Misuse::SetUp();
  }

  /// The instruction set of a new rig, or the status if there is none.
  MienStatus create(uint32_t isa, uint32_t* out_isa) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = isa;
    MienError error = sized<MienError>();
    MienRig* made = rig;
    const MienStatus status = mien_rig_create(dna, &desc, &made, &error);
    EXPECT_EQ(made == nullptr, status != MIEN_OK);
    EXPECT_EQ(error.status, status);
    if (status == MIEN_OK) {
      MienRigInfo info = sized<MienRigInfo>();
      EXPECT_EQ(mien_rig_info(made, &info), MIEN_OK);
      *out_isa = info.isa;
    }
    mien_rig_destroy(made);
    return status;
  }

  std::string before;
};

TEST_F(IsaChoice, NeverReplacedSilently) {
  uint32_t best = 0, isa = 0;
  ASSERT_EQ(create(MIEN_ISA_BEST, &best), MIEN_OK);
  EXPECT_NE(best, uint32_t{MIEN_ISA_BEST});
  int absent = 0;
  for (uint32_t wanted = MIEN_ISA_SCALAR; wanted <= MIEN_ISA_NEON; ++wanted) {
    const char* name = mien_isa_name(wanted);
    const MienStatus expected = mien_isa_available(wanted) ? MIEN_OK : MIEN_ERROR_ISA;
    absent += expected != MIEN_OK;
    EXPECT_EQ(create(wanted, &isa), expected) << name;
    EXPECT_TRUE(expected != MIEN_OK || isa == wanted) << name;

    // The environment counts for those who ask for it, and for nobody else.
    setenv("MIEN_ISA", name, 1);
    EXPECT_EQ(create(MIEN_ISA_ENVIRONMENT, &isa), expected) << name;
    EXPECT_TRUE(expected != MIEN_OK || isa == wanted) << name;
    EXPECT_EQ(mien_isa_available(MIEN_ISA_ENVIRONMENT), mien_isa_available(wanted));
    EXPECT_EQ(create(MIEN_ISA_BEST, &isa), MIEN_OK);
    EXPECT_EQ(isa, best);
    EXPECT_EQ(create(MIEN_ISA_SCALAR, &isa), MIEN_OK);
    EXPECT_EQ(isa, uint32_t{MIEN_ISA_SCALAR});
    EXPECT_EQ(mien_isa_available(MIEN_ISA_BEST), 1u);
    unsetenv("MIEN_ISA");
  }
  EXPECT_GT(absent, 0) << "no CPU has both AVX and NEON";
}

TEST_F(IsaChoice, EnvironmentThatNamesNothing) {
  uint32_t best = 0, isa = 0;
  ASSERT_EQ(create(MIEN_ISA_BEST, &best), MIEN_OK);
  for (const char* wrong : {"AVX2", "avx3", "1", " scalar", "scalar ", "unknown"}) {
    setenv("MIEN_ISA", wrong, 1);
    EXPECT_EQ(create(MIEN_ISA_ENVIRONMENT, &isa), MIEN_ERROR_ISA) << wrong;
    EXPECT_EQ(mien_isa_available(MIEN_ISA_ENVIRONMENT), 0u) << wrong;
    EXPECT_EQ(create(MIEN_ISA_BEST, &isa), MIEN_OK) << wrong;
  }
  setenv("MIEN_ISA", "", 1);
  EXPECT_EQ(create(MIEN_ISA_ENVIRONMENT, &isa), MIEN_OK);
  EXPECT_EQ(isa, best);
}

}  // namespace
}  // namespace mien
