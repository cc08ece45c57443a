// SPDX-License-Identifier: MIT
// The section "DNA: validating" of mien/dna.h.
#include "capi/dna_handle.h"

using namespace mien;
using namespace mien::capi;

namespace {

MienStatus read_validate_desc(const MienValidateDesc* desc, Allocator& allocator,
                              MienError* error) {
  MienValidateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienValidateDesc", error)) return status;
  return read_allocator(known.allocator, allocator, error);
}

MienStringView view_of(const dna::String& string) { return {string.chars(), string.count}; }

}  // namespace

MienStatus mien_dna_validate_file(const char* path, const MienValidateDesc* desc,
                                  MienReport** out_report, MienError* error) {
  if (MienStatus status = clear_output(out_report, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  Allocator allocator;
  if (MienStatus status = read_validate_desc(desc, allocator, error)) return status;
  Report* report = nullptr;
  Error detail;
  const Status status = validate_dna_file(path, allocator, report, detail);
  return give_object(status, report, detail, out_report, error);
}

MienStatus mien_dna_validate_memory(const void* bytes, size_t size, const MienValidateDesc* desc,
                                    MienReport** out_report, MienError* error) {
  if (MienStatus status = clear_output(out_report, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  Allocator allocator;
  if (MienStatus status = read_validate_desc(desc, allocator, error)) return status;
  Report* report = nullptr;
  Error detail;
  const Status status =
      validate_dna({static_cast<const uint8_t*>(bytes), size}, allocator, report, detail);
  return give_object(status, report, detail, out_report, error);
}

MienStatus mien_report_counts(const MienReport* report, uint32_t* out_errors,
                              uint32_t* out_warnings) {
  if (out_errors) *out_errors = 0;
  if (out_warnings) *out_warnings = 0;
  if (!out_errors || !out_warnings) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(report)) return status;
  *out_errors = object(report)->errors;
  *out_warnings = object(report)->count - object(report)->errors;
  return MIEN_OK;
}

MienStatus mien_report_finding(const MienReport* report, uint32_t index, MienFinding* out_finding) {
  if (MienStatus status = clear_struct(out_finding)) return status;
  if (MienStatus status = check(report)) return status;
  if (index >= object(report)->count) return MIEN_ERROR_INDEX;
  const StoredFinding& stored = object(report)->findings[index];
  MienFinding finding = {};
  finding.severity = stored.status == Status::kOk ? MIEN_SEVERITY_WARNING : MIEN_SEVERITY_ERROR;
  finding.status = static_cast<MienStatus>(stored.status);
  finding.byte_offset = stored.byte_offset;
  finding.field = view_of(stored.field);
  finding.message = view_of(stored.message);
  write_struct(out_finding, finding);
  return MIEN_OK;
}

void mien_report_destroy(MienReport* report) { destroy(report); }
