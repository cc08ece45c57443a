// SPDX-License-Identifier: MIT
// The loop of an engine: characters talk, come near and go away again. README.md explains it.
#define MIEN_EXCEPTIONS
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <filesystem>
#include <future>

#include "assets.h"
#include "jobs.h"

namespace {

constexpr uint32_t kCharacterCount = 24;
constexpr float kNear = 4,
                kFar =
                    6;  // meters: full heads are streamed in nearer than kNear, and out beyond kFar
constexpr uint32_t kFramesToStream =
    8;  // a head is in use so many frames after its request, on every machine
constexpr uint64_t kLeastBudget = 10'000;  // joint values and positions per frame

struct Options {
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  uint32_t frames = 180;
  uint64_t budget = 90'000;  // as above
  double milliseconds =
      0;  // 0: the budget stays as it is; otherwise it follows the time that frames take
  bool is_reloading = true;  // rewrite the pak file during the run, as a build step would
};

struct Character {
  uint32_t head = 0, lod = 0;  // LOD of the head, not of the asset
  float distance = 0;
  std::shared_ptr<const Asset> asset;
  mien::Instance face;
  mien::DeformerInstance body;
  std::vector<uint32_t> jaw, lids;  // indices of raw controls
  uint64_t hash = 0;
};

struct Head {
  std::shared_ptr<const Asset> far, full;  // full: null unless it is in memory
  std::future<std::shared_ptr<const Asset>> loading;
  uint32_t arrival = 0;
};

struct Report {
  uint64_t hash = 0, degraded = 0, streamed = 0, reloads = 0, rejected = 0, worst_cost = 0;
  double milliseconds = 0;  // of all frames
  uint32_t lods[8] = {};    // frames of characters by LOD
};

uint64_t hash_of(uint64_t hash, mien::Span<const float> values) {
  for (const float value : values) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3;
  }
  return hash;
}

// The pak file of a generation: built once, then copied.
void put_pak(const std::string& path, uint64_t generation) {
  const std::string built = path + "." + std::to_string(generation);
  if (!std::filesystem::exists(built)) build_pak(built, generation, 10 * generation);
  std::filesystem::copy_file(built, path + ".copy",
                             std::filesystem::copy_options::overwrite_existing);
  replace_file(path + ".copy", path);
}

class Engine {
 public:
  Engine(const std::string& path, const Options& options)
      : options_(options), path_(path), jobs_(options.threads), pak_(path),
        characters_(kCharacterCount) {
    for (uint32_t i = 0; i < kHeadCount; ++i) heads_[i].far = load_asset(pak_, i, false);
    for (uint32_t i = 0; i < kCharacterCount; ++i) {
      characters_[i].head = i % kHeadCount;
      wear(characters_[i], heads_[i % kHeadCount].far);
    }
  }

  Report run() {
    using Clock = std::chrono::steady_clock;
    for (frame_ = 0; frame_ < options_.frames; ++frame_) {
      if (options_.is_reloading) pretend_to_be_the_build_step();
      const Clock::time_point start = Clock::now();
      move();
      reload();
      stream();
      choose_lods();
      jobs_.for_each(kCharacterCount, [this](uint32_t i) { animate(characters_[i], i); });
      for (const Character& character : characters_) {
        report_.hash = (report_.hash ^ character.hash) * 0x100000001b3;
        ++report_.lods[character.lod];
      }
      const std::chrono::duration<double, std::milli> took = Clock::now() - start;
      report_.milliseconds += took.count();
      if (options_.milliseconds > 0) {
        const double factor = std::min(std::max(options_.milliseconds / took.count(), 0.9), 1.05);
        options_.budget = std::max(kLeastBudget, uint64_t(double(options_.budget) * factor));
      }
    }
    return report_;
  }

 private:
  // Gives a character another asset; its raw controls keep their values, by name.
  static void wear(Character& character, const std::shared_ptr<const Asset>& asset) {
    mien::Instance face = asset->rig.instance().value();
    mien::DeformerInstance body = asset->deformer.instance().value();
    if (character.asset) {
      const mien::Rig& old = character.asset->rig;
      const mien::Span<float> from = character.face.raw_controls(), to = face.raw_controls();
      for (uint32_t i = 0; i < from.size(); ++i) {
        const auto found =
            asset->rig.find(MIEN_KIND_RAW_CONTROL, old.name(MIEN_KIND_RAW_CONTROL, i).value());
        if (found) to[*found] = from[i];
      }
    }
    const auto indices = [&](std::initializer_list<const char*> names) {
      std::vector<uint32_t> result;
      for (const char* name : names) {
        if (const auto found = asset->rig.find(MIEN_KIND_RAW_CONTROL, name))
          result.push_back(*found);
      }
      return result;
    };
    character.jaw = indices({"jawOpen"});
    character.lids = indices({"eyeBlinkLeft", "eyeBlinkRight"});
    character.face = std::move(face);
    character.body = std::move(body);
    character.asset = asset;
  }

  void move() {
    for (uint32_t i = 0; i < kCharacterCount; ++i) {
      // They walk to and fro, each at its own time.
      const uint32_t phase = (frame_ + 40 * i) % 480;
      characters_[i].distance = 1 + 0.1f * float(phase < 240 ? phase : 480 - phase);
    }
  }

  void stream() {
    for (uint32_t i = 0; i < kHeadCount; ++i) {
      Head& head = heads_[i];
      float nearest = 1000;
      for (const Character& character : characters_) {
        if (character.head == i) nearest = std::min(nearest, character.distance);
      }
      if (head.loading.valid() && frame_ >= head.arrival) {
        head.full = head.loading.get();  // waits only if the disk is slower than kFramesToStream
        ++report_.streamed;
      }
      if (nearest < kNear && !head.full && !head.loading.valid()) {
        head.loading = std::async(std::launch::async, load_asset, pak_, i, true);
        head.arrival = frame_ + kFramesToStream;
      }
      if (nearest > kFar) head.full.reset();
      for (Character& character : characters_) {
        if (character.head != i) continue;
        const bool is_full =
            head.full && character.distance < (character.asset == head.full ? kFar : kNear);
        const std::shared_ptr<const Asset>& wanted = is_full ? head.full : head.far;
        if (character.asset != wanted) wear(character, wanted);
      }
    }
  }

  // The LOD that suits the distance; then LODs of those farthest away are degraded until the frame fits its budget.
  void choose_lods() {
    uint64_t cost = 0;
    for (Character& character : characters_) {
      const uint32_t wanted =
          uint32_t(std::min(7.0f, std::max(0.0f, std::log2(character.distance) * 2)));
      character.lod = std::min(std::max(wanted, character.asset->first_lod), last_lod(character));
      cost += cost_of(character);
    }
    while (cost > options_.budget) {
      Character* farthest = nullptr;
      for (Character& character : characters_) {
        if (character.lod < last_lod(character) &&
            (!farthest || character.distance > farthest->distance)) {
          farthest = &character;
        }
      }
      if (!farthest) break;
      cost -= cost_of(*farthest);
      ++farthest->lod;
      cost += cost_of(*farthest);
      ++report_.degraded;
    }
    report_.worst_cost = std::max(report_.worst_cost, cost);
  }

  static uint32_t last_lod(const Character& character) {
    return character.asset->first_lod + character.asset->lod_count - 1;
  }
  static uint64_t cost_of(const Character& character) {
    return character.asset->cost_of_lod[character.lod - character.asset->first_lod];
  }

  // One job: everything that it writes belongs to its character. Allocates nothing.
  void animate(Character& character, uint32_t index) const {
    const uint32_t lod = character.lod - character.asset->first_lod;
    const mien::Span<float> controls = character.face.raw_controls();
    const uint32_t talk = (frame_ * 3 + index * 17) % 60, blink = (frame_ + index * 29) % 120;
    for (const uint32_t jaw : character.jaw)
      controls[jaw] = float(talk < 30 ? talk : 60 - talk) / 40;
    for (const uint32_t lid : character.lids) controls[lid] = blink < 4 ? 1.0f : 0.0f;
    character.asset->rig.evaluate(character.face, lod).value();
    character.body.update(character.face).value();
    uint64_t hash = hash_of(0xcbf29ce484222325, character.face.joints());
    for (const uint32_t mesh : character.asset->meshes_of_lod[lod]) {
      character.body.deform(mesh).value();
      hash = hash_of(hash, character.body.positions(mesh));
    }
    character.hash = hash;
  }

  // Opens the pak file again when it was replaced. A damaged one is reported, and the old heads stay.
  void reload() {
    if (Pak::generation_of(path_) == seen_) return;
    seen_ = Pak::generation_of(path_);
    if (seen_ == pak_.generation()) return;
    try {
      const Pak pak(path_);
      std::shared_ptr<const Asset> far[kHeadCount];
      for (uint32_t i = 0; i < kHeadCount; ++i) far[i] = load_asset(pak, i, false);
      pak_ = pak;
      for (uint32_t i = 0; i < kHeadCount; ++i) {
        if (heads_[i].loading.valid()) heads_[i].loading.get();  // of the old file
        heads_[i].full.reset();
        heads_[i].far = far[i];
      }
      ++report_.reloads;
    } catch (const std::exception& e) {
      std::fprintf(stderr, "frame %u: the new pak file is not used: %s\n", frame_, e.what());
      ++report_.rejected;
    }
  }

  void pretend_to_be_the_build_step() const {
    if (frame_ == options_.frames / 3) put_pak(path_, 2);
    if (frame_ == options_.frames / 2)
      write_pak(path_, 3, {{"head0.far", {1, 2, 3}}, {"head1.far", {}}});
  }

  Options options_;
  std::string path_;
  Jobs jobs_;
  Pak pak_;
  Head heads_[kHeadCount];
  std::vector<Character> characters_;
  Report report_;
  uint64_t seen_ = 0;
  uint32_t frame_ = 0;
};

Report run(const std::string& path, const Options& options) {
  put_pak(path, 1);
  return Engine(path, options).run();
}

void print(const Report& report, unsigned threads) {
  std::printf("%u threads: hash %016" PRIx64 ", %" PRIu64 " heads streamed in, %" PRIu64
              " reloads, %" PRIu64 " rejected, LODs degraded %" PRIu64 " times, at most %" PRIu64
              " values in a frame\n",
              threads, report.hash, report.streamed, report.reloads, report.rejected,
              report.degraded, report.worst_cost);
  for (uint32_t lod = 0; lod < 8; ++lod) {
    std::printf("LOD %u: %u%s", lod, report.lods[lod], lod < 7 ? ", " : "\n");
  }
}

// The same bits with one thread and with several, and everything that the loop is for happened.
int check(const std::string& path, Options options) {
  Report first;
  for (const unsigned threads : {1u, 4u}) {
    options.threads = threads;
    const Report report = run(path, options);
    print(report, threads);
    if (threads == 1) first = report;
    if (report.hash != first.hash || report.reloads != 1 || report.rejected != 1 ||
        report.streamed < 2 || report.degraded == 0 || report.worst_cost > options.budget ||
        report.lods[0] == 0 || report.lods[7] == 0) {
      std::fprintf(stderr, "the loop does not do what it should\n");
      return 1;
    }
  }
  options.is_reloading = false;
  if (run(path, options).hash == first.hash) {
    std::fprintf(stderr, "reloading changed nothing\n");
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  bool is_check = false;
  std::string path = (std::filesystem::temp_directory_path() / "mien_engine.pak").string();
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--check") {
      is_check = true;
    } else if (i + 1 < argc && option == "--threads") {
      options.threads = std::max(1u, unsigned(std::stoul(argv[++i])));
    } else if (i + 1 < argc && option == "--frames") {
      options.frames = uint32_t(std::stoul(argv[++i]));
    } else if (i + 1 < argc && option == "--budget") {
      options.budget = std::stoull(argv[++i]);
    } else if (i + 1 < argc && option == "--milliseconds") {
      options.milliseconds = std::stod(argv[++i]);
    } else if (i + 1 < argc && option == "--pak") {
      path = argv[++i];
    } else {
      std::fprintf(stderr,
                   "engine [--check] [--threads N] [--frames N] [--budget VALUES] [--milliseconds "
                   "T] [--pak FILE]\n");
      return 2;
    }
  }
  for (const char* generation : {".1", ".2"}) std::filesystem::remove(path + generation);
  if (is_check) return check(path, options);
  const Report report = run(path, options);
  print(report, options.threads);
  std::printf("%u frames, %.2f ms each\n", options.frames,
              report.milliseconds / std::max(1u, options.frames));
  return 0;
} catch (const std::logic_error&) {
  std::fprintf(stderr, "an option is not a number\n");
  return 2;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
