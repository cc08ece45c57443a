// SPDX-License-Identifier: MIT
#include "integrations/program/commands/farm_record.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "integrations/program/io/fingerprint.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

using RecordJson = nlohmann::ordered_json;

/// Names the task, whatever the number of pieces.
std::string task_key(const FarmJob& job, const FarmTask& task) {
  return job.rigs[task.rig] + '\n' + job.takes[task.take] + '\n' + std::to_string(task.first) +
         '\n' + std::to_string(task.count);
}

RecordJson task_json(const FarmJob& job, const FarmTask& task) {
  return {{"rig", job.rigs[task.rig]},
          {"take", job.takes[task.take]},
          {"first", task.first},
          {"count", task.count}};
}

/// Names may have bytes that are not UTF-8.
std::string line_of(const RecordJson& json) {
  return json.dump(-1, ' ', false, RecordJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::string record_folder(const FarmJob& job) {
  return (fs::path(job.folder) / (job.name + ".farm")).string();
}

DoneTasks::DoneTasks(const FarmJob& job) {
  std::error_code reason;
  std::vector<fs::path> records;
  for (fs::directory_iterator it(record_folder(job), reason), end; !reason && it != end;
       it.increment(reason)) {
    if (it->path().extension() == ".jsonl") records.push_back(it->path());
  }
  for (const fs::path& path : records) {
    std::ifstream lines(path, std::ios::binary);
    for (std::string line; std::getline(lines, line);) {
      try {
        const RecordJson json = RecordJson::parse(line);
        if (!json.contains("files")) continue;
        DoneTask done;
        done.inputs = {json.at("settings"), json.at("rig_content"), json.at("take_content")};
        for (const RecordJson& file : json.at("files")) {
          done.files.push_back({file.at("path"), file.at("bytes"), file.at("content")});
        }
        done_[json.at("rig").get<std::string>() + '\n' + json.at("take").get<std::string>() + '\n' +
              std::to_string(json.at("first").get<uint64_t>()) + '\n' +
              std::to_string(json.at("count").get<uint64_t>())]
            .push_back(std::move(done));
      } catch (const RecordJson::exception&) {
        // The end of a file whose worker was killed.
      }
    }
  }
}

bool DoneTasks::is_done(const FarmJob& job, const FarmTask& task, const TaskInputs& inputs) const {
  const auto found = done_.find(task_key(job, task));
  if (found == done_.end()) return false;
  const auto is_kept = [](const DoneFile& file) {
    std::error_code reason;
    const uint64_t bytes = fs::file_size(file.path, reason);
    return !reason && bytes == file.bytes && file_fingerprint(file.path) == file.fingerprint;
  };
  return std::any_of(found->second.begin(), found->second.end(), [&](const DoneTask& done) {
    return done.inputs == inputs && std::all_of(done.files.begin(), done.files.end(), is_kept);
  });
}

TaskRecord::TaskRecord(const FarmJob& job, const std::string& piece) : job_(job) {
  const fs::path folder = record_folder(job);
  std::error_code reason;
  fs::create_directories(folder, reason);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  path_ = (folder / (piece + "-" + std::to_string(now.count()) + ".jsonl")).string();
  if (!reason) file_.reset(std::fopen(path_.c_str(), "ab"));
  if (!file_) {
    fail(kFile, "cannot write", path_, reason ? reason.message() : std::strerror(errno),
         "check the path and its permissions");
  }
}

void TaskRecord::add_line(const std::string& line) {
  const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
  if (written && std::fflush(file_.get()) == 0) return;
  // The task itself may have been done: without its line, --resume does it again.
  std::clearerr(file_.get());
}

void TaskRecord::add_done(const FarmTask& task, const DoneTask& done, double cpu_seconds) {
  RecordJson json = task_json(job_, task);
  json["settings"] = done.inputs.settings;
  json["rig_content"] = done.inputs.rig;
  json["take_content"] = done.inputs.take;
  json["cpu_seconds"] = cpu_seconds;
  json["files"] = RecordJson::array();
  for (const DoneFile& file : done.files) {
    json["files"].push_back(
        {{"path", file.path}, {"bytes", file.bytes}, {"content", file.fingerprint}});
  }
  add_line(line_of(json));
}

void TaskRecord::add_failed(const FarmTask& task, const std::string& message, int exit_code) {
  RecordJson json = task_json(job_, task);
  json["error"] = message;
  json["exit_code"] = exit_code;
  add_line(line_of(json));
}

}  // namespace mien::cli
