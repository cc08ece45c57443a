// SPDX-License-Identifier: MIT
// Submissions of `mien farm`: files for schedulers, each of which starts `mien farm JOB --piece K/N`.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/commands/farm_job.h"

namespace mien::cli {

struct SubmissionFile {
  std::string name, text;
};

/// In the order of the words of --engine, without "local".
enum class FarmEngine { kDask, kMpi, kSlurm, kOpenCue, kDeadline, kOpenJd, kFlamenco };

/// `program` and the job have absolute paths, which must be the same on all machines.
std::vector<SubmissionFile> submission_files(FarmEngine engine, const FarmJob& job,
                                             const std::string& program, uint64_t pieces);

/// How to hand them in.
std::string submission_command(FarmEngine engine, const std::string& folder);

}  // namespace mien::cli
