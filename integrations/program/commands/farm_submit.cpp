// SPDX-License-Identifier: MIT
#include "integrations/program/commands/farm_submit.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "integrations/program/commands/farm_record.h"

namespace mien::cli {

namespace {

using SubmitJson = nlohmann::ordered_json;

/// For a POSIX shell.
std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

/// Letters, digits, - and _: what schedulers take as a name.
std::string plain_name(const FarmJob& job) {
  std::string name = "mien-" + job.name;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-' && c != '_') c = '_';
  }
  return name;
}

/// The parts of the command; `piece` is what the scheduler replaces by the number.
Words piece_command(const FarmJob& job, const std::string& program, const std::string& piece) {
  return {program, "farm", job.path, "--piece", piece, "--resume"};
}

std::string dask_script(const FarmJob& job, const std::string& program, uint64_t pieces) {
  const auto word = [](const std::string& text) { return SubmitJson(text).dump(); };
  const std::string count = std::to_string(pieces);
  return "#!/usr/bin/env python3\n"
         "\"\"\"Runs the pieces of a job with Dask: on the scheduler whose address is given, "
         "otherwise on this machine.\n"
         "\n"
         "    python3 dask_farm.py [tcp://HOST:8786]\n"
         "\"\"\"\n"
         "import subprocess\n"
         "import sys\n"
         "\n"
         "from distributed import Client, LocalCluster, as_completed\n"
         "\n"
         "PROGRAM = " +
         word(program) +
         "\n"
         "JOB = " +
         word(job.path) +
         "\n"
         "PIECES = " +
         count +
         "\n"
         "\n"
         "\n"
         "def run(piece):\n"
         "    command = [PROGRAM, \"farm\", JOB, \"--piece\", f\"{piece}/{PIECES}\", \"--resume\", "
         "\"--quiet\"]\n"
         "    done = subprocess.run(command, capture_output=True, text=True)\n"
         "    return piece, done.returncode, done.stderr\n"
         "\n"
         "\n"
         "def main():\n"
         "    cluster = sys.argv[1] if len(sys.argv) > 1 else LocalCluster(threads_per_worker=1, "
         "dashboard_address=None)\n"
         "    worst = 0\n"
         "    with Client(cluster) as client:\n"
         "        pieces = client.map(run, range(1, PIECES + 1), pure=False)\n"
         "        for future in as_completed(pieces):\n"
         "            piece, code, text = future.result()\n"
         "            worst = max(worst, code)\n"
         "            print(f\"piece {piece}/{PIECES}: \" + (\"done\" if code == 0 else f\"exit "
         "code {code}\\n{text}\"), flush=True)\n"
         "    if len(sys.argv) == 1:\n"
         "        cluster.close()\n"
         "    return worst\n"
         "\n"
         "\n"
         "if __name__ == \"__main__\":\n"
         "    sys.exit(main())\n";
}

std::string slurm_script(const FarmJob& job, const std::string& program, uint64_t pieces) {
  const std::string count = std::to_string(pieces);
  return "#!/bin/sh\n"
         "#SBATCH --job-name=" +
         plain_name(job) +
         "\n"
         "#SBATCH --array=1-" +
         count +
         "\n"
         "#SBATCH --ntasks=1\n"
         "#SBATCH --cpus-per-task=1\n"
         "#SBATCH --requeue\n"
         "exec " +
         shell_word(program) + " farm " + shell_word(job.path) +
         " --piece \"${SLURM_ARRAY_TASK_ID}/" + count + "\" --resume\n";
}

std::string mpi_script(const FarmJob& job, const std::string& program) {
  return "#!/bin/sh\n"
         "# One process for each piece: the launcher tells each its rank. mpirun -n 16 "
         "./mpi_farm.sh\n"
         "exec " +
         shell_word(program) + " farm " + shell_word(job.path) + " --piece mpi --resume\n";
}

std::string opencue_spec(const FarmJob& job, const std::string& program, uint64_t pieces) {
  std::string command;
  for (const std::string& word :
       piece_command(job, program, "#IFRAME#/" + std::to_string(pieces))) {
    command += (command.empty() ? "" : " ") + shell_word(word);
  }
  return "<?xml version=\"1.0\"?>\n"
         "<!DOCTYPE spec SYSTEM \"../dtd/cjsl-1.12.dtd\">\n"
         "<!-- Set facility, show, shot, user and uid to those of the studio. -->\n"
         "<spec>\n"
         "  <facility>local</facility>\n"
         "  <show>testing</show>\n"
         "  <shot>default</shot>\n"
         "  <user>mien</user>\n"
         "  <uid>1000</uid>\n"
         "  <job name=\"" +
         plain_name(job) +
         "\">\n"
         "    <paused>False</paused>\n"
         "    <maxretries>2</maxretries>\n"
         "    <layers>\n"
         "      <layer name=\"pieces\" type=\"Render\">\n"
         "        <cmd>" +
         xml_text(command) +
         "</cmd>\n"
         "        <range>1-" +
         std::to_string(pieces) +
         "</range>\n"
         "        <chunk>1</chunk>\n"
         "        <cores>1</cores>\n"
         "        <services>\n"
         "          <service>shell</service>\n"
         "        </services>\n"
         "      </layer>\n"
         "    </layers>\n"
         "  </job>\n"
         "</spec>\n";
}

std::vector<SubmissionFile> deadline_files(const FarmJob& job, const std::string& program,
                                           uint64_t pieces) {
  const std::string count = std::to_string(pieces);
  return {{"job_info.txt", "Plugin=CommandLine\nName=" + plain_name(job) + "\nFrames=1-" + count +
                               "\nChunkSize=1\n"},
          {"plugin_info.txt", "Shell=\nShellExecute=False\nStartupDirectory=\nExecutable=" +
                                  program + "\nArguments=farm <QUOTE>" + job.path +
                                  "<QUOTE> --piece <STARTFRAME>/" + count + " --resume\n"}};
}

std::string openjd_template(const FarmJob& job, const std::string& program, uint64_t pieces) {
  Words arguments = piece_command(job, program, "{{Task.Param.Piece}}/" + std::to_string(pieces));
  arguments.erase(arguments.begin());
  const SubmitJson run = {{"command", program}, {"args", arguments}};
  const SubmitJson piece = {
      {"name", "Piece"}, {"type", "INT"}, {"range", "1-" + std::to_string(pieces)}};
  const SubmitJson step = {
      {"name", "Pieces"},
      {"parameterSpace", {{"taskParameterDefinitions", SubmitJson::array({piece})}}},
      {"script", {{"actions", {{"onRun", run}}}}}};
  return SubmitJson{{"specificationVersion", "jobtemplate-2023-09"},
                    {"name", plain_name(job)},
                    {"steps", SubmitJson::array({step})}}
             .dump(2) +
         "\n";
}

std::vector<SubmissionFile> flamenco_files(const FarmJob& job, const std::string& program,
                                           uint64_t pieces) {
  const std::string type =
      "// A job type for Flamenco: put this file into the folder \"scripts\" beside the manager.\n"
      "const JOB_TYPE = {\n"
      "    label: \"Mien Farm\",\n"
      "    settings: [\n"
      "        { key: \"program\", type: \"string\", required: true },\n"
      "        { key: \"job\", type: \"string\", required: true },\n"
      "        { key: \"pieces\", type: \"int32\", required: true },\n"
      "    ]\n"
      "};\n"
      "\n"
      "function compileJob(job) {\n"
      "    const settings = job.settings;\n"
      "    for (let piece = 1; piece <= settings.pieces; piece++) {\n"
      "        const task = author.Task(`piece-${piece}`, \"misc\");\n"
      "        task.addCommand(author.Command(\"exec\", {\n"
      "            exe: settings.program,\n"
      "            args: [\"farm\", settings.job, \"--piece\", `${piece}/${settings.pieces}`, "
      "\"--resume\"],\n"
      "        }));\n"
      "        job.addTask(task);\n"
      "    }\n"
      "}\n";
  const SubmitJson submission = {
      {"name", plain_name(job)},
      {"type", "mien-farm"},
      {"priority", 50},
      {"submitter_platform", "linux"},
      {"settings", {{"program", program}, {"job", job.path}, {"pieces", pieces}}}};
  return {{"mien-farm.js", type}, {"job.json", submission.dump(2) + "\n"}};
}

}  // namespace

std::vector<SubmissionFile> submission_files(FarmEngine engine, const FarmJob& job,
                                             const std::string& program, uint64_t pieces) {
  switch (engine) {
    case FarmEngine::kDask: return {{"dask_farm.py", dask_script(job, program, pieces)}};
    case FarmEngine::kMpi: return {{"mpi_farm.sh", mpi_script(job, program)}};
    case FarmEngine::kSlurm: return {{"slurm_farm.sh", slurm_script(job, program, pieces)}};
    case FarmEngine::kOpenCue: return {{"opencue_job.xml", opencue_spec(job, program, pieces)}};
    case FarmEngine::kDeadline: return deadline_files(job, program, pieces);
    case FarmEngine::kOpenJd: return {{"template.json", openjd_template(job, program, pieces)}};
    case FarmEngine::kFlamenco: break;
  }
  return flamenco_files(job, program, pieces);
}

std::string submission_command(FarmEngine engine, const std::string& folder) {
  const auto in = [&](const char* name) {
    return shell_word((std::filesystem::path(folder) / name).string());
  };
  switch (engine) {
    case FarmEngine::kDask: return "python3 " + in("dask_farm.py") + " [tcp://SCHEDULER:8786]";
    case FarmEngine::kMpi: return "mpirun -n N sh " + in("mpi_farm.sh");
    case FarmEngine::kSlurm: return "sbatch " + in("slurm_farm.sh");
    case FarmEngine::kOpenCue: return "launch " + in("opencue_job.xml") + " with the OpenCue API";
    case FarmEngine::kDeadline:
      return "deadlinecommand " + in("job_info.txt") + " " + in("plugin_info.txt");
    case FarmEngine::kOpenJd: return "openjd run " + in("template.json");
    case FarmEngine::kFlamenco: break;
  }
  return "curl -H 'Content-Type: application/json' --data @" + in("job.json") +
         " http://MANAGER:8080/api/v3/jobs";
}

}  // namespace mien::cli
