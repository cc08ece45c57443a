// SPDX-License-Identifier: MIT
// What was done: a line of JSON for each task, in the folder JOB.farm beside JOB.json. Each run appends to a file of its
// own, so that workers on many machines never write to the same one.
#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "integrations/program/commands/farm_outputs.h"

namespace mien::cli {

/// Fingerprints of what a result depends on.
struct TaskInputs {
  std::string settings, rig, take;

  bool operator==(const TaskInputs& other) const {
    return settings == other.settings && rig == other.rig && take == other.take;
  }
};

struct DoneTask {
  TaskInputs inputs;
  std::vector<DoneFile> files;
};

/// JOB.farm
std::string record_folder(const FarmJob& job);

/// All runs so far. Lines that a killed worker did not finish are left out.
class DoneTasks {
 public:
  explicit DoneTasks(const FarmJob& job);

  /// Whether the task was done from these inputs and its files still have the content that it wrote.
  bool is_done(const FarmJob& job, const FarmTask& task, const TaskInputs& inputs) const;

 private:
  // Each time that a task was done. Records are read in no order, so the files tell which time was the last.
  std::map<std::string, std::vector<DoneTask>> done_;
};

/// The file of this run.
class TaskRecord {
 public:
  TaskRecord(const FarmJob& job, const std::string& piece);

  void add_done(const FarmTask& task, const DoneTask& done, double cpu_seconds);
  void add_failed(const FarmTask& task, const std::string& message, int exit_code);

  const std::string& path() const { return path_; }

 private:
  void add_line(const std::string& line);

  const FarmJob& job_;
  std::string path_;
  std::unique_ptr<FILE, int (*)(FILE*)> file_{nullptr, std::fclose};
};

}  // namespace mien::cli
