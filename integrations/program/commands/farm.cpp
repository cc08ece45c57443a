// SPDX-License-Identifier: MIT
// mien farm: rigs x takes x outputs, in pieces that any scheduler can start.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#if !defined(_WIN32)
#include <sys/resource.h>
#endif

#include "integrations/program/commands/bench_clock.h"
#include "integrations/program/commands/farm_outputs.h"
#include "integrations/program/commands/farm_record.h"
#include "integrations/program/commands/farm_submit.h"
#include "integrations/program/io/fingerprint.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t kMostPieces = 1000000;
constexpr uint64_t kUsualPieces = 100;
constexpr uint64_t kSampleFrames = 240;
constexpr auto kLogInterval = std::chrono::seconds(10);

struct FarmOptions {
  std::string job, piece, pieces, engine = "local", folder;
  bool plan = false, json = false, resume = false;
};

/// Number `index` of `count`, from 1.
struct FarmPiece {
  uint64_t index = 1, count = 1;

  size_t begin(size_t tasks) const { return static_cast<size_t>(tasks * (index - 1) / count); }
  size_t end(size_t tasks) const { return static_cast<size_t>(tasks * index / count); }
  std::string text() const { return std::to_string(index) + "/" + std::to_string(count); }
};

/// From the launcher of MPI: Open MPI, MPICH and others with PMI, Slurm.
FarmPiece piece_of_rank() {
  constexpr const char* kLaunchers[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                           {"PMI_RANK", "PMI_SIZE"},
                                           {"SLURM_PROCID", "SLURM_NTASKS"}};
  for (const auto& names : kLaunchers) {
    const char* const rank = std::getenv(names[0]);
    const char* const size = std::getenv(names[1]);
    if (!rank || !size) continue;
    FarmPiece piece;
    piece.index = parse_number(names[0], rank, kMostPieces - 1) + 1;
    piece.count = parse_number(names[1], size, kMostPieces);
    if (piece.index <= piece.count) return piece;
    fail_usage("--piece mpi", std::string(names[0]) + " is not below " + names[1],
               "start it with mpirun or srun");
  }
  fail_usage("--piece mpi",
             "no launcher has set a rank (OMPI_COMM_WORLD_RANK, PMI_RANK, SLURM_PROCID)",
             "start it with mpirun or srun");
}

FarmPiece parse_piece(const std::string& word) {
  FarmPiece piece;
  if (word.empty()) return piece;
  if (word == "mpi") return piece_of_rank();
  const size_t slash = word.find('/');
  if (slash == std::string::npos) fail_usage("--piece " + word, "not K/N", "write it as 3/8");
  piece.index = parse_number("--piece", word.substr(0, slash), kMostPieces);
  piece.count = parse_number("--piece", word.substr(slash + 1), kMostPieces);
  if (piece.index >= 1 && piece.index <= piece.count) return piece;
  fail_usage("--piece " + word, "K counts from 1 to N", "write it as 1/8 to 8/8");
}

/// Contents of rigs and takes, each read once in a row.
class InputContents {
 public:
  explicit InputContents(const FarmJob& job) : job_(job) {
    Fingerprint settings;
    settings.add(job.settings);
    inputs_.settings = settings.text();
  }

  const TaskInputs& of(const FarmTask& task) {
    if (rig_ != &job_.rigs[task.rig]) {
      inputs_.rig = file_fingerprint(job_.rigs[task.rig]);
      rig_ = &job_.rigs[task.rig];
    }
    if (take_ != &job_.takes[task.take]) {
      inputs_.take = file_fingerprint(job_.takes[task.take]);
      take_ = &job_.takes[task.take];
    }
    return inputs_;
  }

 private:
  const FarmJob& job_;
  const std::string* rig_ = nullptr;
  const std::string* take_ = nullptr;
  TaskInputs inputs_;
};

std::string task_text(const FarmJob& job, const FarmTask& task) {
  std::string text = stem_of(job.takes[task.take]) + " on " + stem_of(job.rigs[task.rig]);
  if (task.count != 0) {
    text += ", frames " + std::to_string(task.first) + " to " +
            std::to_string(task.first + task.count - 1);
  }
  return text;
}

/// A line now and then, for the logs of schedulers.
struct FarmLog {
  const Session& session;
  uint64_t total = 0, done = 0, kept = 0, failed = 0;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now(),
                                        next = start + kLogInterval;

  void tell() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next) return;
    next = now + kLogInterval;
    const double seconds = std::chrono::duration<double>(now - start).count();
    const uint64_t past = done + kept + failed;
    char rate[32];
    std::snprintf(rate, sizeof(rate), "%.3g", static_cast<double>(past) / seconds);
    note(session, grouped(past) + " of " + grouped(total) + " tasks, " + grouped(failed) +
                      " failed, " + rate + " per second, " +
                      duration_text(seconds / static_cast<double>(past) *
                                    static_cast<double>(total - past)) +
                      " left");
  }
};

void run_piece(const FarmJob& job, const FarmPiece& piece, bool resume, const Session& session) {
  const std::vector<FarmTask> tasks = farm_tasks(job);
  const DoneTasks before(job);
  TaskRecord record(job, std::to_string(piece.index) + "-of-" + std::to_string(piece.count));
  FarmWorker worker(job, session);
  InputContents contents(job);
  const size_t begin = piece.begin(tasks.size()), end = piece.end(tasks.size());
  FarmLog log{session, end - begin};
  int worst = kDone;
  for (size_t t = begin; t < end; ++t) {
    const FarmTask& task = tasks[t];
    const auto failed = [&](const std::string& message, int code) {
      print_failure(session, task_text(job, task) + ": " + message);
      record.add_failed(task, message, code);
      worst = std::max(worst, code);
      ++log.failed;
    };
    try {
      const double start = work_ns();
      const TaskInputs inputs = contents.of(task);
      if (resume && before.is_done(job, task, inputs)) {
        ++log.kept;
      } else {
        const std::vector<DoneFile> files =
            worker.run(task, [&](const FarmOutput& output, uint64_t frame) {
              return farm_path(job, output, task, frame);
            });
        record.add_done(task, {inputs, files}, (work_ns() - start) * 1e-9);
        ++log.done;
      }
    } catch (const Failure& failure) {
      failed(failure.what(), failure.exit_code);
    } catch (const gltf::ExportError& error) {
      failed(std::string("cannot export: ") + error.what() + "; " + error.what_to_do,
             exit_code_of(error.status));
    } catch (const std::bad_alloc&) {
      failed("out of memory; free some memory", kInternal);
    }
    log.tell();
  }
  if (!session.quiet) {
    std::printf("%s: %s tasks: %s done, %s already there, %s failed; see %s\n", job.path.c_str(),
                grouped(log.total).c_str(), grouped(log.done).c_str(), grouped(log.kept).c_str(),
                grouped(log.failed).c_str(), record.path().c_str());
  }
  if (log.failed == 0) return;
  fail(static_cast<ExitCode>(worst), "not everything is done", job.path,
       grouped(log.failed) + " of " + grouped(log.total) + " tasks failed",
       "correct what " + record.path() + " names, then --resume");
}

// The plan ----------------------------------------------------------------------------------------

/// A task that was run for its time.
struct FarmSample {
  FarmTask task;
  double open_seconds = 0, seconds = 0;  // of the processor
  uint64_t frames = 0, bytes = 0;
  uint64_t peak_bytes = 0;  // of the process; 0 where the system does not tell
};

uint64_t peak_memory() {
#if defined(_WIN32)
  return 0;
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#if defined(__APPLE__)
  return static_cast<uint64_t>(usage.ru_maxrss);
#else
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
#endif
#endif
}

/// A folder that goes with everything in it.
struct SampleFolder {
  fs::path path;
  SampleFolder() {
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    path = fs::temp_directory_path() / ("mien-farm-sample-" + std::to_string(now));
    fs::create_directories(path);
  }
  ~SampleFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  SampleFolder(const SampleFolder&) = delete;
  SampleFolder& operator=(const SampleFolder&) = delete;
};

FarmSample run_sample(const FarmJob& job, uint32_t take, uint64_t frames, const Session& session) {
  FarmSample sample;
  sample.task = {0, take, 0, job.solves() ? 0 : std::min(frames, kSampleFrames)};
  sample.frames = job.solves() ? 1 : sample.task.count;
  const SampleFolder folder;
  FarmWorker worker(job, session);
  const double start = work_ns();
  worker.open_rig(0);
  const double rig_open = work_ns();
  worker.open_take(take);  // with all its frames
  const double take_open = work_ns();
  size_t number = 0;
  const std::vector<DoneFile> files =
      worker.run(sample.task, [&](const FarmOutput& output, uint64_t) {
        const std::string ending = fs::path(output.pattern).extension().string();
        return (folder.path / (std::to_string(number++) + ending)).string();
      });
  const double share = static_cast<double>(sample.frames) / static_cast<double>(frames);
  sample.open_seconds = (rig_open - start) * 1e-9;
  sample.seconds = (work_ns() - take_open + share * (take_open - rig_open)) * 1e-9;
  for (const DoneFile& file : files) sample.bytes += file.bytes;
  sample.peak_bytes = peak_memory();
  return sample;
}

struct FarmCost {
  uint64_t tasks = 0, frames = 0;
  double seconds = 0, bytes = 0;
};

FarmCost cost_of(const std::vector<FarmTask>& tasks, const FarmPiece& piece,
                 const std::vector<uint64_t>& frames, const FarmSample& sample) {
  FarmCost cost;
  uint32_t rig = UINT32_MAX;
  for (size_t t = piece.begin(tasks.size()); t < piece.end(tasks.size()); ++t) {
    const FarmTask& task = tasks[t];
    ++cost.tasks;
    cost.frames += task.count != 0 ? task.count : frames[task.take];
    if (task.rig != rig) cost.seconds += sample.open_seconds;
    rig = task.rig;
  }
  const double share =
      static_cast<double>(cost.frames) / static_cast<double>(std::max<uint64_t>(sample.frames, 1));
  cost.seconds += share * sample.seconds;
  cost.bytes = share * static_cast<double>(sample.bytes);
  return cost;
}

void write_cost(JsonWriter& json, const FarmCost& cost) {
  json.member("tasks", cost.tasks);
  json.member("frames", cost.frames);
  json.key("cpu_seconds");
  json.fixed(cost.seconds, 3);
  json.member("bytes", static_cast<uint64_t>(cost.bytes));
}

void write_plan(const FarmJob& job, uint64_t pieces, bool as_json, const Session& session) {
  const std::vector<FarmTask> tasks = farm_tasks(job);
  std::vector<uint64_t> frames(job.takes.size());
  std::vector<std::string> bad;
  uint32_t sampled = UINT32_MAX;
  std::string first_failure;
  for (uint32_t take = 0; take < job.takes.size(); ++take) {
    try {
      // Of captured data, a take counts as one.
      frames[take] = job.solves() ? fs::exists(job.takes[take]) : count_frames(job, take);
      if (frames[take] == 0) throw Failure(kInvalid, job.takes[take] + ": there are no frames");
      if (sampled == UINT32_MAX) sampled = take;
    } catch (const Failure& failure) {
      bad.push_back(job.takes[take]);
      if (first_failure.empty()) first_failure = failure.what();
    }
  }
  if (sampled == UINT32_MAX) throw Failure(kInvalid, first_failure);
  const FarmSample sample = run_sample(job, sampled, frames[sampled], session);
  const FarmCost all = cost_of(tasks, {}, frames, sample);
  pieces = std::min<uint64_t>(pieces, tasks.size());
  if (!as_json) {
    std::printf("%s rigs x %s takes: %s tasks, %s %s\n", grouped(job.rigs.size()).c_str(),
                grouped(job.takes.size()).c_str(), grouped(all.tasks).c_str(),
                grouped(all.frames).c_str(), job.solves() ? "captures" : "frames");
    std::printf("sample: %s, %s of CPU time to open the rig, %.4g ms and %s per %s\n",
                task_text(job, sample.task).c_str(), duration_text(sample.open_seconds).c_str(),
                sample.seconds * 1e3 / static_cast<double>(sample.frames),
                size_text(sample.bytes / sample.frames).c_str(),
                job.solves() ? "capture" : "frame");
    std::printf("all: %s of CPU time, %s written, %s of memory for each worker\n",
                duration_text(all.seconds).c_str(),
                size_text(static_cast<uint64_t>(all.bytes)).c_str(),
                size_text(sample.peak_bytes).c_str());
    std::printf("%s pieces of about %s each\n", grouped(pieces).c_str(),
                duration_text(all.seconds / static_cast<double>(pieces)).c_str());
    for (const std::string& path : bad) std::printf("cannot be read: %s\n", one_line(path).c_str());
    return;
  }
  Output output("-");
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("rigs", uint64_t{job.rigs.size()});
  json.member("takes", uint64_t{job.takes.size()});
  write_cost(json, all);
  json.key("bad_takes");
  json.begin_array();
  for (const std::string& path : bad) json.value(path);
  json.end_array();
  json.key("sample");
  json.begin_object();
  json.member("rig", job.rigs[sample.task.rig]);
  json.member("take", job.takes[sample.task.take]);
  json.member("frames", sample.frames);
  json.key("open_cpu_seconds");
  json.fixed(sample.open_seconds, 6);
  json.key("cpu_seconds");
  json.fixed(sample.seconds, 6);
  json.member("bytes", sample.bytes);
  json.member("peak_memory", sample.peak_bytes);
  json.end_object();
  json.key("pieces");
  json.begin_array(JsonWriter::Layout::kLines);
  for (FarmPiece piece{1, pieces}; piece.index <= pieces; ++piece.index) {
    json.begin_object();
    json.member("piece", piece.text());
    write_cost(json, cost_of(tasks, piece, frames, sample));
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
  output.commit();
}

// Submissions -------------------------------------------------------------------------------------

/// The program that is running, by a path that other machines can use as well.
std::string own_path() {
  std::error_code reason;
  const fs::path path = fs::read_symlink("/proc/self/exe", reason);
  return reason ? "mien" : path.string();
}

void write_submission(const FarmOptions& options, FarmJob job, uint64_t pieces,
                      const Session& session) {
  if (options.folder.empty()) {
    fail_usage("--engine " + options.engine, "there is no folder for the submission",
               "add --write FOLDER");
  }
  const auto engine =
      static_cast<FarmEngine>(parse_word("--engine", options.engine) - 1);  // after "local"
  job.path = fs::absolute(job.path).lexically_normal().string();
  pieces = std::min<uint64_t>(pieces, farm_tasks(job).size());
  const OutputFolder folder(options.folder);
  for (const SubmissionFile& file : submission_files(engine, job, own_path(), pieces)) {
    Output output(folder.file(file.name));
    output.write(file.text);
    output.commit();
    note_written(session, folder.file(file.name), output.size());
  }
  if (!session.quiet) {
    std::printf("%s pieces; submit: %s\n", grouped(pieces).c_str(),
                submission_command(engine, options.folder).c_str());
  }
}

void run_farm(const FarmOptions& options, const Session& session) {
  const size_t engine = parse_word("--engine", options.engine);
  const FarmPiece piece = parse_piece(options.piece);
  const uint64_t pieces =
      options.pieces.empty() ? kUsualPieces : parse_number("--pieces", options.pieces, kMostPieces);
  if (pieces == 0) fail_usage("--pieces 0", "there is nothing to do", "try 8");
  if (options.json && !options.plan) fail_usage("--json", "it is for --plan", "add --plan");
  if (engine == 0 && !options.folder.empty()) {
    fail_usage("--write", "no scheduler is named", "add --engine slurm, say");
  }
  if (engine != 0 && (!options.piece.empty() || options.plan)) {
    fail_usage("--engine " + options.engine, "it writes a submission and runs nothing",
               "leave out --piece and --plan");
  }
  const FarmJob job = read_farm_job(options.job);
  if (engine != 0) {
    write_submission(options, job, pieces, session);
  } else if (options.plan) {
    write_plan(job, pieces, options.json, session);
  } else {
    run_piece(job, piece, options.resume, session);
  }
}

}  // namespace

Command add_farm_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<FarmOptions>();
  CLI::App* farm = app.add_subcommand("farm", "Run many takes on many rigs, in pieces for a farm");
  farm->add_option("JOB", options->job, "JSON with rigs, takes and outputs")
      ->type_name("")
      ->required();
  farm->add_flag("--plan", options->plan,
                 "Print tasks, and what they cost by the time of a sample, and run nothing else");
  farm->add_flag("--json", options->json, "With --plan: as JSON, with each piece");
  farm->add_option("--piece", options->piece,
                   "Run one piece of N, such as 3/8; mpi takes rank and size from the\nlauncher's "
                   "environment (default: 1/1)")
      ->type_name("K/N");
  farm->add_flag("--resume", options->resume,
                 "Leave out tasks whose files are there with the content that they had when "
                 "they\nwere written, from the same rig, take and settings");
  farm->add_option("--pieces", options->pieces,
                   "Pieces of a plan or a submission (default: 100, or as many as there are tasks)")
      ->type_name("N");
  farm->add_option("--engine", options->engine,
                   "local (default) runs here; the others write a submission: dask, mpi, slurm,\n"
                   "opencue, deadline, openjd, flamenco")
      ->type_name("NAME");
  farm->add_option("--write", options->folder, "Folder for the submission")->type_name("FOLDER");
  farm->footer(
      "JOB is one JSON object; its paths are relative to its folder:\n"
      "  {\"rigs\": [\"heads/*.rig\"], \"takes\": [\"lines/*.clip\"], \"lod\": 0, \"rate\": 60,\n"
      "   \"outputs\": [\n"
      "    {\"kind\": \"joints\", \"path\": \"out/{rig}/{take}.npy\"},\n"
      "    {\"kind\": \"vertices\", \"path\": \"out/{rig}/{take}.face.npy\", \"mesh\": \"face\"},\n"
      "    {\"kind\": \"glb\", \"path\": \"out/{rig}/{take}.glb\"},\n"
      "    {\"kind\": \"png\", \"path\": \"out/{rig}/{take}.{frame}.png\", \"size\": \"256\"}]}\n"
      "Takes are clips, CSV or JSON. With {frame} in the path, each frame has its own file.\n"
      "\"clip\" writes the controls for captured takes, as 'mien solve'. Files are the same\n"
      "whatever the pieces, and appear whole or not at all. A task that fails does not stop the\n"
      "others; JOB.farm/ beside JOB.json says what was done and what failed. See docs/farms.md.\n\n"
      "Examples:\n"
      "  mien farm job.json --plan --pieces 64\n"
      "  mien farm job.json\n"
      "  mien farm job.json --piece 3/64 --resume\n"
      "  mien farm job.json --engine slurm --write submit --pieces 64");
  return {farm, [options, &session] { run_farm(*options, session); }};
}

}  // namespace mien::cli
