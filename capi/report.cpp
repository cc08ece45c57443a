// SPDX-License-Identifier: MIT
// Validation: every finding about a file, kept for the caller. mien.h is the manual.
#include "capi/dna_handle.h"
#include "runtime/load/compile/compile_rig.h"
#include "runtime/load/dna/dna_reader.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr uint32_t kMaxFindings = 1000;

struct StoredFinding {
  Status status;
  uint64_t byte_offset;
  dna::String field, message;
};

}  // namespace

struct MienReport {
  uint32_t tag;
  uint32_t count;
  uint32_t errors;
  bool out_of_memory;
  Allocator allocator;
  Arena arena;
  Span<StoredFinding> findings;  // room for kMaxFindings

  bool copy(const char* text, dna::String& out) {
    const size_t length = strlen(text);
    uint8_t* bytes = static_cast<uint8_t*>(arena.allocate(length + 1, 1));
    if (!bytes) return false;
    memcpy(bytes, text, length + 1);
    make_printable(reinterpret_cast<char*>(bytes));
    out = {bytes, static_cast<uint32_t>(length)};
    return true;
  }

  // The last place is for the remark that there may be more findings. If there is no error until then, the
  // check continues: the first error takes that place, because warnings must not hide it.
  bool add(const dna::Finding& finding) {
    const bool full = count == kMaxFindings;
    const bool error = finding.status != Status::kOk;
    if (full && (errors != 0 || !error)) return errors == 0;

    dna::Finding kept = finding;
    if (count + 1 == kMaxFindings) {
      kept.field = "";
      kept.message = "there may be more findings: mend these and validate again";
    }
    StoredFinding& stored = findings[full ? count - 1 : count];
    stored.status = kept.status;
    stored.byte_offset = kept.byte_offset;
    if (!copy(kept.field, stored.field) || !copy(kept.message, stored.message)) {
      out_of_memory = true;
      return false;
    }
    errors += error;
    count += !full;
    return count < kMaxFindings || errors == 0;
  }
};

namespace {

bool keep_finding(void* user, const dna::Finding& finding) {
  return static_cast<MienReport*>(user)->add(finding);
}

// Findings that only compilation makes: correctives that depend on each other in a circle, too much work.
// Their messages begin with the field.
void try_to_compile(const dna::DnaView& view, MienReport* report) {
  if (report->errors != 0 || report->out_of_memory) return;
  Rig* rig = nullptr;
  Error detail;
  const Status status =
      compile_rig(view, {kernels_for(Isa::kScalar)}, report->allocator, rig, detail);
  if (status == Status::kOk) {
    release_rig(rig);
  } else if (status == Status::kMemory) {
    report->out_of_memory = true;
  } else {
    char* const colon = strstr(detail.message, ": ");
    if (colon) *colon = 0;
    report->add({status, detail.byte_offset, colon ? detail.message : "bhvr",
                 colon ? colon + 2 : detail.message});
  }
}

MienStatus read_validate_desc(const MienValidateDesc* desc, Allocator& allocator,
                              MienError* error) {
  MienValidateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienValidateDesc", error)) return status;
  return read_allocator(known.allocator, allocator, error);
}

MienStatus examine(const uint8_t* bytes, size_t size, const Allocator& allocator,
                   MienReport** out_report, MienError* error) {
  void* memory = allocator.get(sizeof(MienReport), alignof(MienReport));
  if (!memory) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a report");
  MienReport* report =
      new (memory) MienReport{kReportTag, 0, 0, false, allocator, Arena(allocator), {}};
  report->findings = report->arena.array<StoredFinding>(kMaxFindings);
  report->out_of_memory = !report->findings.data;
  if (!report->out_of_memory) {
    Arena arena(allocator);
    dna::DnaView view;
    dna::examine_dna(bytes, size, arena, view, {report, keep_finding, true});
    try_to_compile(view, report);
  }
  for (uint32_t i = 0; i < report->count; ++i) {
    report->out_of_memory |= report->findings[i].status == Status::kMemory;
  }
  if (report->out_of_memory) {
    mien_report_destroy(report);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory to examine %zu bytes", size);
  }
  *out_report = report;
  return succeed(error);
}

MienStringView view_of(const dna::String& string) { return {string.chars(), string.count}; }

}  // namespace

MienStatus mien_dna_validate_file(const char* path, const MienValidateDesc* desc,
                                  MienReport** out_report, MienError* error) {
  if (MienStatus status = clear_output(out_report, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  Allocator allocator;
  if (MienStatus status = read_validate_desc(desc, allocator, error)) return status;
  // All data is checked anyway, and a file in memory cannot change during the checks.
  MappedFile file;
  Error detail;
  if (open_file(path, FileAccess::kRead, {"DNA", 3}, allocator, file, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  const MienStatus status = examine(file.bytes, file.size, allocator, out_report, error);
  close_file(file);
  return status;
}

MienStatus mien_dna_validate_memory(const void* bytes, size_t size, const MienValidateDesc* desc,
                                    MienReport** out_report, MienError* error) {
  if (MienStatus status = clear_output(out_report, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  Allocator allocator;
  if (MienStatus status = read_validate_desc(desc, allocator, error)) return status;
  return examine(static_cast<const uint8_t*>(bytes), size, allocator, out_report, error);
}

MienStatus mien_report_counts(const MienReport* report, uint32_t* out_errors,
                              uint32_t* out_warnings) {
  if (out_errors) *out_errors = 0;
  if (out_warnings) *out_warnings = 0;
  if (!out_errors || !out_warnings) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(report)) return status;
  *out_errors = report->errors;
  *out_warnings = report->count - report->errors;
  return MIEN_OK;
}

MienStatus mien_report_finding(const MienReport* report, uint32_t index, MienFinding* out_finding) {
  if (MienStatus status = clear_struct(out_finding)) return status;
  if (MienStatus status = check(report)) return status;
  if (index >= report->count) return MIEN_ERROR_INDEX;
  const StoredFinding& stored = report->findings[index];
  MienFinding finding = {};
  finding.severity = stored.status == Status::kOk ? MIEN_SEVERITY_WARNING : MIEN_SEVERITY_ERROR;
  finding.status = static_cast<MienStatus>(stored.status);
  finding.byte_offset = stored.byte_offset;
  finding.field = view_of(stored.field);
  finding.message = view_of(stored.message);
  write_struct(out_finding, finding);
  return MIEN_OK;
}

void mien_report_destroy(MienReport* report) {
  if (check(report) != MIEN_OK) return;
  const Allocator allocator = report->allocator;
  report->tag = 0;
  report->~MienReport();
  allocator.put(report, sizeof(MienReport), alignof(MienReport));
}
