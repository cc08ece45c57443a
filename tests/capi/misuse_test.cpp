// SPDX-License-Identifier: MIT
// Every call of mien.h with handles, pointers and structs that are wrong: each returns the status
// that the header names, clears its outputs, and says what is wrong.
#include "tests/support/misuse.h"

#include <functional>

#include "tests/support/temporary_path.h"

namespace mien {
namespace {

// Handles -----------------------------------------------------------------------------------------

std::vector<Outcome> calls_on(MienDna* dna) {
  Caller c;
  float number;
  int64_t integer;
  c.into_struct<MienDnaInfo>("info", [&](auto* o) { return mien_dna_info(dna, o); });
  c.into_struct<MienDnaLayer>("layer", [&](auto* o) { return mien_dna_layer(dna, 0, o); });
  c.into_struct<MienDnaField>(
      "field", [&](auto* o) { return mien_dna_field(dna, "desc.name", o, nullptr); });
  c.with_error<MienStringView>(
      "field_name", [&](auto* o, auto* e) { return mien_dna_child_name(dna, "desc", 0, o, e); });
  c.only_error("read_floats", [&](auto* e) {
    return mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", 0, 1, &number, e);
  });
  c.only_error("read_integers", [&](auto* e) {
    return mien_dna_read_integers(dna, "desc.lodCount", 0, 1, &integer, e);
  });
  c.with_error<MienStringView>("read_string", [&](auto* o, auto* e) {
    return mien_dna_read_string(dna, "desc.name", o, e);
  });
  c.only_error("write_file",
               [&](auto* e) { return mien_dna_write_file(dna, "/dev/null", nullptr, e); });
  c.with_error<size_t>("write_memory", [&](auto* o, auto* e) {
    return mien_dna_write_memory(dna, nullptr, nullptr, 0, o, e);
  });
  c.with_error<MienRig*>("rig_create", [&](auto* o, auto* e) {
    const MienStatus status = mien_rig_create(dna, nullptr, o, e);
    mien_rig_destroy(*o);
    return status;
  });
  return c.outcomes;
}

std::vector<Outcome> calls_on(MienReport* report) {
  struct Counts {
    uint32_t errors, warnings;
  };
  Caller c;
  c.plain<Counts>("counts",
                  [&](auto* o) { return mien_report_counts(report, &o->errors, &o->warnings); });
  return c.outcomes;
}

std::vector<Outcome> calls_on(MienRig* rig, MienInstance* instance) {
  Caller c;
  c.into_struct<MienRigInfo>("info", [&](auto* o) { return mien_rig_info(rig, o); });
  c.plain<uint32_t>("count", [&](auto* o) { return mien_rig_count(rig, MIEN_KIND_JOINT, o); });
  c.plain<MienStringView>("name",
                          [&](auto* o) { return mien_rig_name(rig, MIEN_KIND_PSD_CONTROL, 0, o); });
  c.plain<uint32_t>("find",
                    [&](auto* o) { return mien_rig_find(rig, MIEN_KIND_PSD_CONTROL, "psd0", o); });
  c.plain<MienIndex16View>(
      "lod_indices", [&](auto* o) { return mien_rig_lod_indices(rig, MIEN_KIND_JOINT, 0, o); });
  c.plain<MienIndex16View>("variable_joint_values",
                           [&](auto* o) { return mien_rig_variable_joint_values(rig, 0, o); });
  c.plain<MienIndex16View>("joint_parents",
                           [&](auto* o) { return mien_rig_joint_parents(rig, o); });
  c.plain<MienFloatView>("neutral", [&](auto* o) { return mien_rig_neutral_joint_values(rig, o); });
  c.plain<MienIndex16View>("psd_inputs", [&](auto* o) { return mien_rig_psd_inputs(rig, 0, o); });
  c.plain<MienFloatView>("initial", [&](auto* o) { return mien_rig_initial_raw_controls(rig, o); });
  c.into_struct<MienRigStatistics>("statistics",
                                   [&](auto* o) { return mien_rig_statistics(rig, 0, o); });
  c.with_error<MienInstance*>("instance_create", [&](auto* o, auto* e) {
    const MienStatus status = mien_instance_create(rig, nullptr, o, e);
    mien_instance_destroy(*o);
    return status;
  });
  c.nothing("map_gui_to_raw", [&] { return mien_rig_map_gui_to_raw(rig, instance); });
  c.nothing("map_raw_to_gui", [&] { return mien_rig_map_raw_to_gui(rig, instance); });
  c.nothing("evaluate", [&] { return mien_rig_evaluate(rig, instance, 0); });
  c.nothing("stages", [&] { return mien_rig_evaluate_stages(rig, instance, 0, MIEN_STAGE_ALL); });
  c.nothing("joint_group", [&] { return mien_rig_evaluate_joint_group(rig, instance, 0, 0); });
  c.nothing("rbf_solver", [&] { return mien_rig_evaluate_rbf_solver(rig, instance, 0, 0); });
  c.nothing("twist_swing", [&] { return mien_rig_evaluate_twist_swing(rig, instance, 0, 0); });
  return c.outcomes;
}

std::vector<Outcome> calls_on(MienInstance* instance, const MienRig* rig) {
  using Floats = MienFloatView;
  using Mutable = MienMutableFloatView;
  Caller c;
  c.nothing("reset", [&] { return mien_instance_reset(instance); });
  c.plain<Mutable>("gui", [&](auto* o) { return mien_instance_gui_controls(instance, o); });
  c.plain<Mutable>("raw", [&](auto* o) { return mien_instance_raw_controls(instance, o); });
  c.plain<Mutable>("masks", [&](auto* o) { return mien_instance_ml_masks(instance, o); });
  c.plain<Floats>("controls", [&](auto* o) { return mien_instance_controls(instance, o); });
  c.plain<Floats>("psd", [&](auto* o) { return mien_instance_psd_controls(instance, o); });
  c.plain<Floats>("ml", [&](auto* o) { return mien_instance_ml_controls(instance, o); });
  c.plain<Floats>("rbf", [&](auto* o) { return mien_instance_rbf_controls(instance, o); });
  c.plain<Floats>("joints", [&](auto* o) { return mien_instance_joints(instance, o); });
  c.plain<Floats>("shapes", [&](auto* o) { return mien_instance_blend_shapes(instance, o); });
  c.plain<Floats>("maps", [&](auto* o) { return mien_instance_animated_maps(instance, o); });
  c.nothing("map_gui_to_raw", [&] { return mien_rig_map_gui_to_raw(rig, instance); });
  c.nothing("map_raw_to_gui", [&] { return mien_rig_map_raw_to_gui(rig, instance); });
  c.nothing("evaluate", [&] { return mien_rig_evaluate(rig, instance, 0); });
  c.nothing("stages", [&] { return mien_rig_evaluate_stages(rig, instance, 0, MIEN_STAGE_ALL); });
  c.nothing("joint_group", [&] { return mien_rig_evaluate_joint_group(rig, instance, 0, 0); });
  c.nothing("rbf_solver", [&] { return mien_rig_evaluate_rbf_solver(rig, instance, 0, 0); });
  c.nothing("twist_swing", [&] { return mien_rig_evaluate_twist_swing(rig, instance, 0, 0); });
  return c.outcomes;
}

TEST_F(Misuse, LiveHandlesAreAccepted) {
  expect_all(calls_on(dna), MIEN_OK);
  expect_all(calls_on(report), MIEN_OK);
  expect_all(calls_on(rig, instance), MIEN_OK);
  expect_all(calls_on(instance, rig), MIEN_OK);
}

TEST_F(Misuse, NullIsNoHandle) {
  expect_all(calls_on(static_cast<MienDna*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienReport*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienRig*>(nullptr), instance), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienInstance*>(nullptr), rig), MIEN_ERROR_NULL_ARGUMENT);
}

TEST_F(Misuse, HandlesOfAnotherKindAreRefused) {
  alignas(8) uint8_t zeros[64] = {};
  void* const odd = reinterpret_cast<uint8_t*>(rig) + 1;
  for (void* wrong : {static_cast<void*>(dna), static_cast<void*>(report), static_cast<void*>(rig),
                      static_cast<void*>(instance), static_cast<void*>(zeros), odd}) {
    if (wrong != dna) expect_all(calls_on(static_cast<MienDna*>(wrong)), MIEN_ERROR_HANDLE);
    if (wrong != report) expect_all(calls_on(static_cast<MienReport*>(wrong)), MIEN_ERROR_HANDLE);
    if (wrong != rig) {
      expect_all(calls_on(static_cast<MienRig*>(wrong), instance), MIEN_ERROR_HANDLE);
    }
    if (wrong != instance) {
      expect_all(calls_on(static_cast<MienInstance*>(wrong), rig), MIEN_ERROR_HANDLE);
    }
    // Destroying them as what they are not does nothing: TearDown counts the bytes.
    if (wrong != dna) mien_dna_close(static_cast<MienDna*>(wrong));
    if (wrong != report) mien_report_destroy(static_cast<MienReport*>(wrong));
    if (wrong != rig) mien_rig_destroy(static_cast<MienRig*>(wrong));
    if (wrong != instance) mien_instance_destroy(static_cast<MienInstance*>(wrong));
  }
}

// An instance keeps what it needs of its rig.
TEST_F(Misuse, InstancesOutliveTheirRig) {
  mien_rig_destroy(rig);
  rig = nullptr;
  EXPECT_GT(kept.live_bytes, 0u);
  MienFloatView joints;
  EXPECT_EQ(mien_instance_joints(instance, &joints), MIEN_OK);
  EXPECT_EQ(mien_instance_reset(instance), MIEN_OK);
}

TEST_F(Misuse, InstanceOfAnotherRigIsRefused) {
  MienRig* other = nullptr;
  ASSERT_EQ(mien_rig_create(dna, nullptr, &other, nullptr), MIEN_OK);
  MienMutableFloatView raw;
  MienFloatView joints;
  ASSERT_EQ(mien_instance_raw_controls(instance, &raw), MIEN_OK);
  ASSERT_EQ(mien_instance_joints(instance, &joints), MIEN_OK);
  for (size_t i = 0; i < raw.count; ++i) raw.data[i] = 1.0f;
  EXPECT_EQ(mien_rig_map_gui_to_raw(other, instance), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_map_raw_to_gui(other, instance), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate(other, instance, 0), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate_stages(other, instance, 0, MIEN_STAGE_ALL), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate_joint_group(other, instance, 0, 0), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate_rbf_solver(other, instance, 0, 0), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate_twist_swing(other, instance, 0, 0), MIEN_ERROR_MISMATCH);
  for (size_t i = 0; i < raw.count; ++i) EXPECT_EQ(raw.data[i], 1.0f);
  for (size_t i = 0; i < joints.count; ++i) EXPECT_EQ(joints.data[i], 0.0f);
  mien_rig_destroy(other);
}

// Null outputs ------------------------------------------------------------------------------------

TEST_F(Misuse, NullOutputs) {
  const MienStatus null = MIEN_ERROR_NULL_ARGUMENT;
  EXPECT_EQ(mien_dna_info(dna, nullptr), null);
  EXPECT_EQ(mien_dna_layer(dna, 0, nullptr), null);
  EXPECT_EQ(mien_rig_info(rig, nullptr), null);
  EXPECT_EQ(mien_rig_count(rig, MIEN_KIND_JOINT, nullptr), null);
  EXPECT_EQ(mien_rig_name(rig, MIEN_KIND_JOINT, 0, nullptr), null);
  EXPECT_EQ(mien_rig_find(rig, MIEN_KIND_JOINT, "a", nullptr), null);
  EXPECT_EQ(mien_rig_lod_indices(rig, MIEN_KIND_JOINT, 0, nullptr), null);
  EXPECT_EQ(mien_rig_variable_joint_values(rig, 0, nullptr), null);
  EXPECT_EQ(mien_rig_joint_parents(rig, nullptr), null);
  EXPECT_EQ(mien_rig_neutral_joint_values(rig, nullptr), null);
  EXPECT_EQ(mien_rig_psd_inputs(rig, 0, nullptr), null);
  EXPECT_EQ(mien_rig_initial_raw_controls(rig, nullptr), null);
  EXPECT_EQ(mien_rig_statistics(rig, 0, nullptr), null);
  EXPECT_EQ(mien_instance_gui_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_raw_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_ml_masks(instance, nullptr), null);
  EXPECT_EQ(mien_instance_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_statistics(instance, nullptr), null);
  EXPECT_EQ(mien_instance_psd_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_ml_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_rbf_controls(instance, nullptr), null);
  EXPECT_EQ(mien_instance_joints(instance, nullptr), null);
  EXPECT_EQ(mien_instance_blend_shapes(instance, nullptr), null);
  EXPECT_EQ(mien_instance_animated_maps(instance, nullptr), null);
  EXPECT_EQ(mien_report_finding(report, 0, nullptr), null);

  uint32_t errors = 7, warnings = 7;
  EXPECT_EQ(mien_report_counts(report, nullptr, &warnings), null);
  EXPECT_EQ(warnings, 0u);
  EXPECT_EQ(mien_report_counts(report, &errors, nullptr), null);
  EXPECT_EQ(errors, 0u);
}

TEST_F(Misuse, NullOutputsAreToldInTheError) {
  Caller c;
  c.only_error("open_file", [&](auto* e) { return mien_dna_open_file("x", nullptr, nullptr, e); });
  c.only_error("open_memory", [&](auto* e) {
    return mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, nullptr, e);
  });
  c.only_error("generate", [&](auto* e) { return mien_dna_generate(nullptr, nullptr, e); });
  c.only_error("field", [&](auto* e) { return mien_dna_field(dna, "desc", nullptr, e); });
  c.only_error("field_name",
               [&](auto* e) { return mien_dna_child_name(dna, "desc", 0, nullptr, e); });
  c.only_error("read_floats", [&](auto* e) {
    return mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", 0, 1, nullptr, e);
  });
  c.only_error("read_integers", [&](auto* e) {
    return mien_dna_read_integers(dna, "desc.lodCount", 0, 1, nullptr, e);
  });
  c.only_error("read_string",
               [&](auto* e) { return mien_dna_read_string(dna, "desc.name", nullptr, e); });
  c.only_error("write_memory", [&](auto* e) {
    return mien_dna_write_memory(dna, nullptr, nullptr, 0, nullptr, e);
  });
  c.only_error("report_file",
               [&](auto* e) { return mien_dna_validate_file("x", nullptr, nullptr, e); });
  c.only_error("report_memory", [&](auto* e) {
    return mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, nullptr, e);
  });
  c.only_error("rig", [&](auto* e) { return mien_rig_create(dna, nullptr, nullptr, e); });
  c.only_error("instance", [&](auto* e) { return mien_instance_create(rig, nullptr, nullptr, e); });
  expect_all(c.outcomes, MIEN_ERROR_NULL_ARGUMENT);
}

TEST_F(Misuse, NullInputs) {
  Caller c;
  c.with_error<MienDna*>(
      "open_file", [&](auto* o, auto* e) { return mien_dna_open_file(nullptr, nullptr, o, e); });
  c.with_error<MienDna*>("open_memory", [&](auto* o, auto* e) {
    return mien_dna_open_memory(nullptr, 100, nullptr, o, e);
  });
  c.with_error<MienReport*>("report_file", [&](auto* o, auto* e) {
    return mien_dna_validate_file(nullptr, nullptr, o, e);
  });
  c.with_error<MienReport*>("report_memory", [&](auto* o, auto* e) {
    return mien_dna_validate_memory(nullptr, 100, nullptr, o, e);
  });
  c.with_error<MienStringView>(
      "field_name", [&](auto* o, auto* e) { return mien_dna_child_name(dna, nullptr, 0, o, e); });
  c.into_struct<MienDnaField>("field",
                              [&](auto* o) { return mien_dna_field(dna, nullptr, o, nullptr); });
  c.with_error<MienStringView>(
      "read_string", [&](auto* o, auto* e) { return mien_dna_read_string(dna, nullptr, o, e); });
  c.only_error("read_floats",
               [&](auto* e) { return mien_dna_read_floats(dna, nullptr, 0, 0, nullptr, e); });
  c.only_error("read_integers",
               [&](auto* e) { return mien_dna_read_integers(dna, nullptr, 0, 0, nullptr, e); });
  c.only_error("write_file",
               [&](auto* e) { return mien_dna_write_file(dna, nullptr, nullptr, e); });
  c.with_error<size_t>("write_memory", [&](auto* o, auto* e) {
    return mien_dna_write_memory(dna, nullptr, nullptr, 100, o, e);
  });
  c.plain<uint32_t>("find",
                    [&](auto* o) { return mien_rig_find_n(rig, MIEN_KIND_JOINT, nullptr, 1, o); });
  expect_all(c.outcomes, MIEN_ERROR_NULL_ARGUMENT);

  // Nothing is asked for, so nothing has to be given.
  uint32_t index = 7;
  MienDna* none = nullptr;
  EXPECT_EQ(mien_rig_find_n(rig, MIEN_KIND_JOINT, nullptr, 0, &index), MIEN_ERROR_NAME);
  EXPECT_EQ(mien_dna_open_memory(nullptr, 0, nullptr, &none, nullptr), MIEN_ERROR_DNA_SIGNATURE);
  EXPECT_EQ(mien_dna_read_integers(dna, "desc.lodCount", 1, 0, nullptr, nullptr), MIEN_OK);
}

// Structs that only grow --------------------------------------------------------------------------

/// Every size but the right one; `call` takes the struct and an error.
/// What is found in a struct whose size was never set: no call may take it for one.
constexpr size_t kNeverSet[] = {4097, 65536, 0xCCCCCCCC, SIZE_MAX / 2, SIZE_MAX};

template <class Desc, class Call>
void check_input_struct(Call&& call) {
  Longer<Desc> longer;
  EXPECT_EQ(call(&longer.known, nullptr), MIEN_OK) << "zeros behind what is known";
  for (uint8_t& byte : longer.tail) {
    byte = 1;
    MienError error = sized<MienError>();
    EXPECT_EQ(call(&longer.known, &error), MIEN_ERROR_STRUCT_SIZE) << "an unknown field";
    EXPECT_EQ(error.status, MIEN_ERROR_STRUCT_SIZE);
    EXPECT_NE(std::string(error.message).find("struct_size"), std::string::npos);
    byte = 0;
  }
  for (uint32_t size = 0; size < sizeof(Desc); ++size) {
    Desc shorter = sized<Desc>();
    shorter.struct_size = size;
    EXPECT_EQ(call(&shorter, nullptr), MIEN_ERROR_STRUCT_SIZE) << size;
  }
  for (const size_t size : kNeverSet) {
    // Zeros behind it, as far as a call could be led to look.
    alignas(Desc) uint8_t memory[8192] = {};
    Desc* never_set = reinterpret_cast<Desc*>(memory);
    never_set->struct_size = size;
    EXPECT_EQ(call(never_set, nullptr), MIEN_ERROR_STRUCT_SIZE) << size;
  }
  EXPECT_EQ(call(static_cast<const Desc*>(nullptr), nullptr), MIEN_OK);
}

TEST_F(Misuse, InputStructs) {
  check_input_struct<MienDnaDesc>([&](const MienDnaDesc* desc, MienError* error) {
    MienDna* opened = dna;
    const MienStatus status =
        mien_dna_open_memory(bytes.data(), bytes.size(), desc, &opened, error);
    EXPECT_EQ(opened == nullptr, status != MIEN_OK);
    mien_dna_close(opened);
    return status;
  });
  const std::string path = temporary_path("structs.dna");
  check_input_struct<MienWriteDesc>([&](const MienWriteDesc* desc, MienError* error) {
    size_t size = 1;
    const MienStatus status = mien_dna_write_memory(dna, desc, nullptr, 0, &size, error);
    EXPECT_EQ(size == 0, status != MIEN_OK);
    EXPECT_EQ(mien_dna_write_file(dna, path.c_str(), desc, error), status);
    return status;
  });
  check_input_struct<MienDnaDesc>([&](const MienDnaDesc* desc, MienError* error) {
    MienDna* opened = dna;
    const MienStatus status = mien_dna_open_file(path.c_str(), desc, &opened, error);
    EXPECT_EQ(opened == nullptr, status != MIEN_OK);
    mien_dna_close(opened);
    return status;
  });
  remove(path.c_str());
  check_input_struct<MienGenerateDesc>([&](const MienGenerateDesc* desc, MienError* error) {
    MienDna* made = dna;
    const MienStatus status = mien_dna_generate(desc, &made, error);
    EXPECT_EQ(made == nullptr, status != MIEN_OK);
    mien_dna_close(made);
    return status;
  });
  check_input_struct<MienRigDesc>([&](const MienRigDesc* desc, MienError* error) {
    MienRig* made = rig;
    const MienStatus status = mien_rig_create(dna, desc, &made, error);
    EXPECT_EQ(made == nullptr, status != MIEN_OK);
    mien_rig_destroy(made);
    return status;
  });
}

template <class Out, class Call>
void check_output_struct(Call&& call) {
  Out exact = dirty_struct<Out>();
  ASSERT_EQ(call(&exact), MIEN_OK);
  EXPECT_EQ(exact.struct_size, sizeof(Out));

  Longer<Out> longer;
  dirty(longer);
  longer.known.struct_size = sizeof(longer);
  EXPECT_EQ(call(&longer.known), MIEN_OK);
  EXPECT_TRUE(longer.tail_is(0)) << "what is not known is zero";
  EXPECT_EQ(longer.known.struct_size, sizeof(longer));
  longer.known.struct_size = exact.struct_size;
  EXPECT_EQ(memcmp(&longer.known, &exact, sizeof(Out)), 0);

  for (uint32_t size = 0; size < sizeof(Out); ++size) {
    Out shorter = dirty_struct<Out>();
    shorter.struct_size = size;
    const Out before = shorter;
    EXPECT_EQ(call(&shorter), MIEN_ERROR_STRUCT_SIZE) << size;
    EXPECT_EQ(memcmp(&shorter, &before, sizeof(Out)), 0) << "its size is not to be trusted";
  }
  for (const size_t size : kNeverSet) {
    Bytes memory(8192, 0xCC);
    memcpy(memory.data(), &exact, sizeof(Out));
    reinterpret_cast<Out*>(memory.data())->struct_size = size;
    const Bytes before = memory;
    EXPECT_EQ(call(reinterpret_cast<Out*>(memory.data())), MIEN_ERROR_STRUCT_SIZE) << size;
    EXPECT_EQ(memory, before) << size;
  }
}

TEST_F(Misuse, OutputStructs) {
  check_output_struct<MienDnaInfo>([&](auto* out) { return mien_dna_info(dna, out); });
  check_output_struct<MienDnaLayer>([&](auto* out) { return mien_dna_layer(dna, 1, out); });
  check_output_struct<MienDnaField>(
      [&](auto* out) { return mien_dna_field(dna, "desc.name", out, nullptr); });
  check_output_struct<MienRigInfo>([&](auto* out) { return mien_rig_info(rig, out); });
  check_output_struct<MienRigStatistics>(
      [&](auto* out) { return mien_rig_statistics(rig, 0, out); });
  check_output_struct<MienInstanceStatistics>(
      [&](auto* out) { return mien_instance_statistics(instance, out); });
  MienReport* findings = nullptr;
  ASSERT_EQ(mien_dna_validate_memory("nothing", 7, nullptr, &findings, nullptr), MIEN_OK);
  check_output_struct<MienFinding>(
      [&](auto* out) { return mien_report_finding(findings, 0, out); });
  mien_report_destroy(findings);
}

// MienError ---------------------------------------------------------------------------------------

using Failing = std::function<MienStatus(MienError*)>;

TEST_F(Misuse, ErrorsOfTheWrongSizeEndTheCall) {
  MienDna* opened = dna;
  MienReport* made_report = report;
  MienRig* made_rig = rig;
  MienInstance* made = instance;
  MienStringView text = {"x", 1};
  MienDnaField field = dirty_struct<MienDnaField>();
  size_t size = 7;
  float number = 7;
  int64_t integer = 7;
  const std::string path = temporary_path("error.dna");
  const std::vector<Failing> calls = {
      [&](MienError* e) { return mien_dna_open_file("/dev/null", nullptr, &opened, e); },
      [&](MienError* e) { return mien_dna_field(dna, "desc.name", &field, e); },
      [&](MienError* e) { return mien_dna_child_name(dna, "desc", 0, &text, e); },
      [&](MienError* e) {
        return mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", 0, 1, &number, e);
      },
      [&](MienError* e) { return mien_dna_read_integers(dna, "desc.lodCount", 0, 1, &integer, e); },
      [&](MienError* e) { return mien_dna_write_file(dna, path.c_str(), nullptr, e); },
      [&](MienError* e) { return mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, e); },
      [&](MienError* e) { return mien_dna_validate_file("/dev/null", nullptr, &made_report, e); },
      [&](MienError* e) { return mien_rig_create(dna, nullptr, &made_rig, e); },
      [&](MienError* e) { return mien_instance_create(rig, nullptr, &made, e); },
  };
  for (const Failing& call : calls) {
    for (size_t short_by : {sizeof(MienError), size_t{1}}) {
      MienError error = dirty_struct<MienError>();
      error.struct_size = static_cast<uint32_t>(sizeof(MienError) - short_by);
      const MienError before = error;
      EXPECT_EQ(call(&error), MIEN_ERROR_STRUCT_SIZE);
      EXPECT_EQ(memcmp(&error, &before, sizeof(error)), 0);
    }
    for (const size_t never_set : kNeverSet) {
      Bytes memory(8192, 0xCC);
      MienError* error = reinterpret_cast<MienError*>(memory.data());
      error->struct_size = never_set;
      const Bytes before = memory;
      EXPECT_EQ(call(error), MIEN_ERROR_STRUCT_SIZE);
      EXPECT_EQ(memory, before) << never_set;
    }
  }
  EXPECT_EQ(opened, nullptr);
  EXPECT_TRUE(is_cleared(field, true));
  EXPECT_EQ(text.data, nullptr);
  EXPECT_EQ(size, 0u);
  EXPECT_EQ(made_report, nullptr);
  EXPECT_EQ(made_rig, nullptr);
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(number, 7);
  EXPECT_EQ(integer, 7);
  EXPECT_NE(remove(path.c_str()), 0) << "nothing was written";

  MienError error = {};
  opened = dna;
  EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error),
            MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(opened, nullptr);
  opened = dna;
  EXPECT_EQ(mien_dna_generate(nullptr, &opened, &error), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(opened, nullptr);
  text = {"x", 1};
  EXPECT_EQ(mien_dna_read_string(dna, "desc.name", &text, &error), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(text.data, nullptr);
  made_report = report;
  EXPECT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &made_report, &error),
            MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(made_report, nullptr);
}

TEST_F(Misuse, SuccessLeavesTheErrorAlone) {
  MienError error = dirty_struct<MienError>();
  const MienError before = error;
  MienDna* opened = nullptr;
  ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error), MIEN_OK);
  mien_dna_close(opened);
  EXPECT_EQ(error.status, MIEN_OK);
  error.status = before.status;
  EXPECT_EQ(memcmp(&error, &before, sizeof(error)), 0);
}

TEST_F(Misuse, LongerErrorsAreZeroBehindWhatIsKnown) {
  Longer<MienError> error;
  dirty(error);
  error.known.struct_size = sizeof(error);
  MienDna* opened = nullptr;
  // From the reader, and from the checks of arguments.
  EXPECT_EQ(mien_dna_open_memory("DNA", 3, nullptr, &opened, &error.known),
            MIEN_ERROR_DNA_TRUNCATED);
  EXPECT_TRUE(error.tail_is(0));
  dirty(error.tail);
  EXPECT_EQ(mien_dna_open_memory(nullptr, 3, nullptr, &opened, &error.known),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_TRUE(error.tail_is(0));
  EXPECT_EQ(error.known.struct_size, sizeof(error));
}

// The parameter or field, the value that it has, and those that it may have.
TEST_F(Misuse, MessagesNameTheArgument) {
  MienError error = sized<MienError>();
  const auto expect_said = [&](MienStatus status, const char* message) {
    EXPECT_NE(status, MIEN_OK);
    EXPECT_EQ(status, error.status);
    EXPECT_STREQ(error.message, message);
  };
  MienRig* made = nullptr;
  expect_said(mien_rig_create(nullptr, nullptr, &made, &error), "dna is NULL");
  expect_said(mien_rig_create(reinterpret_cast<MienDna*>(rig), nullptr, &made, &error),
              "dna is a handle of another kind, or none");
  MienRigDesc desc = mien_rig_desc_default();
  desc.storage = 9;
  expect_said(mien_rig_create(dna, &desc, &made, &error),
              "MienRigDesc.storage is 9; valid values are 0 to 1");
  MienCoordinateSystem system = mien_coordinate_system_default();
  system.axes[0] = MIEN_DIRECTION_LEFT;
  system.axes[1] = MIEN_DIRECTION_UP;
  system.axes[2] = MIEN_DIRECTION_FRONT;
  MienDnaDesc open = mien_dna_desc_default();
  open.system = &system;
  const auto opening = [&] {
    MienDna* opened = nullptr;
    return mien_dna_open_memory(bytes.data(), bytes.size(), &open, &opened, &error);
  };
  system.rotation_signs[2] = -2;
  expect_said(opening(), "MienCoordinateSystem.rotation_signs[2] is -2; valid values are -1 to 1");
  system.rotation_signs[2] = 0;
  system.reserved = 1;
  expect_said(opening(), "MienCoordinateSystem.reserved is 1; it must be 0");
  float value;
  expect_said(mien_dna_read_floats(dna, "desc.name", 0, 1, &value, &error),
              "desc.name holds a string, not floats: read it with mien_dna_read_string()");
  expect_said(mien_dna_read_floats(dna, "defn.jointNames", 0, 1, &value, &error),
              "defn.jointNames holds a list, not floats: read it with the paths of its elements");
}

TEST_F(Misuse, ErrorsTellTheirPlaceInTheFile) {
  MienError error = sized<MienError>();
  MienDna* opened = dna;
  bytes[3] = 7;  // generation
  EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error),
            MIEN_ERROR_DNA_VERSION);
  EXPECT_EQ(opened, nullptr);
  EXPECT_EQ(error.status, MIEN_ERROR_DNA_VERSION);
  EXPECT_EQ(error.byte_offset, 3u);
  EXPECT_NE(std::string(error.message).find("1794"), std::string::npos) << error.message;
  bytes[0] = 'd';
  EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error),
            MIEN_ERROR_DNA_SIGNATURE);
  EXPECT_EQ(error.byte_offset, 0u);
}

}  // namespace
}  // namespace mien
