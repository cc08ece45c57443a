// SPDX-License-Identifier: MIT
// Replacements for the functions of DNA files and compilers with MIEN_BUILD_COMPILER=OFF: the same names,
// which fail. No MienDna or MienReport exists in such a build, so handles are not checked.
#include "capi/arguments/arguments.h"

using namespace mien::capi;

namespace {

MienStatus unsupported(MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  return give_error(error, MIEN_ERROR_UNSUPPORTED,
                    "this build of libmien opens baked files only (MIEN_BUILD_COMPILER=OFF): bake "
                    "the DNA file with 'mien bake' of a full build, or use a full libmien");
}

template <class T>
MienStatus unsupported(T* out, MienError* error) {
  if (MienStatus status = clear_output(out, error)) return status;
  return unsupported(error);
}

template <class T>
MienStatus unsupported_struct(T* out, MienError* error = nullptr) {
  if (MienStatus status = clear_struct(out)) return status;
  return unsupported(error);
}

}  // namespace

// Opening -----------------------------------------------------------------------------------------

MienStatus mien_dna_open_file(const char*, const MienDnaDesc*, MienDna** out_dna,
                              MienError* error) {
  return unsupported(out_dna, error);
}
MienStatus mien_dna_open_memory(const void*, size_t, const MienDnaDesc*, MienDna** out_dna,
                                MienError* error) {
  return unsupported(out_dna, error);
}
MienStatus mien_dna_open_stream(const MienStream*, const MienDnaDesc*, MienDna** out_dna,
                                MienError* error) {
  return unsupported(out_dna, error);
}
void mien_dna_close(MienDna*) {}

// Looking into it ---------------------------------------------------------------------------------

MienStatus mien_dna_info(const MienDna*, MienDnaInfo* out_info) {
  return unsupported_struct(out_info);
}
MienStatus mien_dna_layer(const MienDna*, uint32_t, MienDnaLayer* out_layer) {
  return unsupported_struct(out_layer);
}
MienStatus mien_dna_field(const MienDna*, const char*, MienDnaField* out_field, MienError* error) {
  return unsupported_struct(out_field, error);
}
MienStatus mien_dna_field_n(const MienDna*, const char*, size_t, MienDnaField* out_field,
                            MienError* error) {
  return unsupported_struct(out_field, error);
}
MienStatus mien_dna_child_name(const MienDna*, const char*, uint32_t, MienStringView* out_name,
                               MienError* error) {
  return unsupported(out_name, error);
}
MienStatus mien_dna_child_name_n(const MienDna*, const char*, size_t, uint32_t,
                                 MienStringView* out_name, MienError* error) {
  return unsupported(out_name, error);
}
MienStatus mien_dna_read_floats(const MienDna*, const char*, uint64_t, uint64_t, float*,
                                MienError* error) {
  return unsupported(error);
}
MienStatus mien_dna_read_floats_n(const MienDna*, const char*, size_t, uint64_t, uint64_t, float*,
                                  MienError* error) {
  return unsupported(error);
}
MienStatus mien_dna_read_integers(const MienDna*, const char*, uint64_t, uint64_t, int64_t*,
                                  MienError* error) {
  return unsupported(error);
}
MienStatus mien_dna_read_integers_n(const MienDna*, const char*, size_t, uint64_t, uint64_t,
                                    int64_t*, MienError* error) {
  return unsupported(error);
}
MienStatus mien_dna_read_string(const MienDna*, const char*, MienStringView* out_string,
                                MienError* error) {
  return unsupported(out_string, error);
}
MienStatus mien_dna_read_string_n(const MienDna*, const char*, size_t, MienStringView* out_string,
                                  MienError* error) {
  return unsupported(out_string, error);
}

// Writing and validating --------------------------------------------------------------------------

MienStatus mien_dna_write_file(const MienDna*, const char*, const MienWriteDesc*,
                               MienError* error) {
  return unsupported(error);
}
MienStatus mien_dna_write_memory(const MienDna*, const MienWriteDesc*, void*, size_t,
                                 size_t* out_size, MienError* error) {
  return unsupported(out_size, error);
}
MienStatus mien_dna_validate_file(const char*, const MienValidateDesc*, MienReport** out_report,
                                  MienError* error) {
  return unsupported(out_report, error);
}
MienStatus mien_dna_validate_memory(const void*, size_t, const MienValidateDesc*,
                                    MienReport** out_report, MienError* error) {
  return unsupported(out_report, error);
}
MienStatus mien_report_counts(const MienReport*, uint32_t* out_errors, uint32_t* out_warnings) {
  if (out_errors) *out_errors = 0;
  if (out_warnings) *out_warnings = 0;
  return MIEN_ERROR_UNSUPPORTED;
}
MienStatus mien_report_finding(const MienReport*, uint32_t, MienFinding* out_finding) {
  return unsupported_struct(out_finding);
}
void mien_report_destroy(MienReport*) {}

// Compiling ---------------------------------------------------------------------------------------

MienStatus mien_rig_create(const MienDna*, const MienRigDesc*, MienRig** out_rig,
                           MienError* error) {
  return unsupported(out_rig, error);
}
MienStatus mien_deformer_create(const MienDna*, const MienRig*, const MienDeformerDesc*,
                                MienDeformer** out_deformer, MienError* error) {
  return unsupported(out_deformer, error);
}
