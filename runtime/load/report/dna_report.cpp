// SPDX-License-Identifier: MIT
#include "runtime/load/report/dna_report.h"

#include "runtime/base/mapped_file.h"
#include "runtime/load/compile/compile_rig.h"

namespace mien {
namespace {

bool copy(Arena& arena, const char* text, dna::String& out) {
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
bool add(Report& report, const dna::Finding& finding) {
  const bool full = report.count == Report::kMaxFindings;
  const bool error = finding.status != Status::kOk;
  if (full && (report.errors != 0 || !error)) return report.errors == 0;

  dna::Finding kept = finding;
  if (report.count + 1 == Report::kMaxFindings) {
    kept.field = "";
    kept.message = "there may be more findings: mend these and validate again";
  }
  StoredFinding& stored = report.findings[full ? report.count - 1 : report.count];
  stored.status = kept.status;
  stored.byte_offset = kept.byte_offset;
  if (!copy(report.arena, kept.field, stored.field) ||
      !copy(report.arena, kept.message, stored.message)) {
    report.out_of_memory = true;
    return false;
  }
  report.errors += error;
  report.count += !full;
  return report.count < Report::kMaxFindings || report.errors == 0;
}

bool keep_finding(void* user, const dna::Finding& finding) {
  return add(*static_cast<Report*>(user), finding);
}

// Findings that only compilation can make: correctives that depend on each other in a cycle, or too much
// work. Their messages begin with the field.
void try_to_compile(const dna::DnaView& view, Report& report) {
  if (report.errors != 0 || report.out_of_memory) return;
  Rig* rig = nullptr;
  Error detail;
  const Status status =
      compile_rig(view, {kernels_for(Isa::kScalar)}, report.allocator, rig, detail);
  if (status == Status::kOk) {
    release(rig);
  } else if (status == Status::kMemory) {
    report.out_of_memory = true;
  } else {
    char* const colon = strstr(detail.message, ": ");
    if (colon) *colon = 0;
    add(report, {status, detail.byte_offset, colon ? detail.message : "bhvr",
                 colon ? colon + 2 : detail.message});
  }
}

}  // namespace

Status validate_dna(Span<const uint8_t> bytes, const Allocator& allocator, Report*& out,
                    Error& error) {
  out = create_object<Report>(allocator);
  if (!out) return fail(error, Status::kMemory, kNoOffset, "no memory for a report");
  Report& report = *out;
  report.findings = report.arena.array<StoredFinding>(Report::kMaxFindings);
  report.out_of_memory = !report.findings.data;
  if (!report.out_of_memory) {
    Arena arena(allocator);
    dna::DnaView view;
    dna::examine_dna(bytes.data, bytes.count, arena, view, {&report, keep_finding, true});
    try_to_compile(view, report);
  }
  for (uint32_t i = 0; i < report.count; ++i) {
    report.out_of_memory |= report.findings[i].status == Status::kMemory;
  }
  if (!report.out_of_memory) return Status::kOk;
  release(out);
  out = nullptr;
  return fail(error, Status::kMemory, kNoOffset, "no memory to examine %zu bytes", bytes.count);
}

Status validate_dna_file(const char* path, const Allocator& allocator, Report*& out, Error& error) {
  out = nullptr;
  MappedFile file;
  Status status = open_file(path, FileAccess::kRead, {"DNA", 3}, allocator, file, error);
  if (status != Status::kOk) return status;
  status = validate_dna({file.bytes, file.size}, allocator, out, error);
  close_file(file);
  return status;
}

}  // namespace mien
