// SPDX-License-Identifier: MIT
// mien.hpp as users build it: without exceptions and RTTI, with them, as C++17 and as C++20.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mien_author.hpp>
#include <string>
#include <vector>

namespace {

void check(bool condition, const char* text, int line) {
  if (condition) return;
  std::fprintf(stderr, "mien_test.cpp:%d: failed: %s\n", line, text);
  std::exit(1);
}
#define CHECK(...) check(static_cast<bool>(__VA_ARGS__), #__VA_ARGS__, __LINE__)

mien::Dna generated(MienPreset preset = MIEN_PRESET_SMALL) {
  mien::GenerateDesc desc;
  desc.preset = preset;
  return mien::generate(desc).value();
}

/// A stream over bytes.
struct Bytes {
  std::vector<unsigned char> data;

  MienStream stream() { return {this, data.size(), read}; }
  static size_t read(void* user, uint64_t offset, void* buffer, size_t size) {
    const Bytes& bytes = *static_cast<const Bytes*>(user);
    std::memcpy(buffer, bytes.data.data() + offset, size);
    return size;
  }
};

/// A stream whose function says that it has copied another number of bytes than it was asked for.
struct Liar {
  Bytes bytes;
  size_t (*told)(size_t asked);

  MienStream stream() { return {this, bytes.data.size(), read}; }
  static size_t read(void* user, uint64_t offset, void* buffer, size_t size) {
    Liar& liar = *static_cast<Liar*>(user);
    const size_t told = liar.told(size);
    Bytes::read(&liar.bytes, offset, buffer, told < size ? told : size);
    return told;
  }
};

/// Streams that give too much, too little, nothing, or have no function.
template <typename Object>
void test_streams_of(const std::vector<unsigned char>& data) {
  size_t (*const lies[])(size_t) = {
      [](size_t) { return size_t{0}; },
      [](size_t asked) { return asked - 1; },
      [](size_t asked) { return asked + 1; },
      [](size_t) { return SIZE_MAX; },
  };
  for (const auto lie : lies) {
    Liar liar = {{data}, lie};
    CHECK(Object::open(liar.stream()).status() == MIEN_ERROR_FILE_READ);
  }
  Liar honest = {{data}, [](size_t asked) { return asked; }};
  CHECK(Object::open(honest.stream()));
  MienStream without = honest.stream();
  without.read = nullptr;
  CHECK(Object::open(without).status() == MIEN_ERROR_NULL_ARGUMENT);
  MienStream empty = honest.stream();
  empty.size = 0;
  CHECK(!Object::open(empty));
  MienStream endless = honest.stream();
  endless.size = UINT64_MAX;
  endless.read = [](void*, uint64_t, void*, size_t) { return size_t{0}; };
  CHECK(!Object::open(endless));
}

void test_streams() {
  const mien::Dna dna = generated();
  std::vector<unsigned char> bytes(dna.write(mien::Span<unsigned char>()).value());
  CHECK(dna.write(bytes));
  test_streams_of<mien::Dna>(bytes);

  const mien::Rig rig = mien::Rig::create(dna).value();
  bytes.resize(mien::bake(mien::Span<unsigned char>(), rig).value());
  CHECK(mien::bake(bytes, rig));
  test_streams_of<mien::Baked>(bytes);

  const MienStringView name = mien::view("jawOpen");
  const float values[] = {0, 1};
  mien::ClipDesc desc;
  desc.frame_count = 2;
  desc.channel_count = 1;
  desc.names = &name;
  desc.values = values;
  const mien::Clip clip = mien::Clip::build(desc).value();
  bytes.resize(clip.write(mien::Span<unsigned char>()).value());
  CHECK(clip.write(bytes));
  test_streams_of<mien::Clip>(bytes);
}

void test_baked_files() {
  const mien::Dna dna = generated();
  const mien::Rig rig = mien::Rig::create(dna).value();
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  Bytes bytes;
  bytes.data.resize(mien::bake(mien::Span<unsigned char>(), rig, deformer).value());
  CHECK(mien::bake(bytes.data, rig, deformer));
  const MienStream stream = bytes.stream();
  for (const bool by_stream : {false, true}) {
    mien::Baked baked = (by_stream ? mien::Baked::open(stream)
                                   : mien::Baked::open(bytes.data.data(), bytes.data.size()))
                            .value();
    CHECK(baked.info()->file_bytes == bytes.data.size());
    const mien::Rig opened = baked.rig().value();
    const mien::Deformer meshes = baked.deformer(opened).value();
    baked.reset();
    CHECK(opened.count(MIEN_KIND_JOINT) == rig.count(MIEN_KIND_JOINT));
    CHECK(meshes.info()->mesh_count == rig.count(MIEN_KIND_MESH));
  }
  CHECK(mien::bake("/dev/null", rig));
  std::vector<unsigned char> alone(mien::bake(mien::Span<unsigned char>(), rig).value());
  CHECK(mien::bake(alone, rig));
  const mien::Baked without = mien::Baked::open(alone.data(), alone.size()).value();
#ifndef MIEN_EXCEPTIONS
  CHECK(without.deformer(without.rig().value()).status() == MIEN_ERROR_BAKED_PART);
  CHECK(mien::Baked::open("/dev/null").error().status() == MIEN_ERROR_BAKED_SIGNATURE);
#endif

  bytes.data.resize(dna.write(mien::Span<unsigned char>()).value());
  CHECK(dna.write(bytes.data));
  CHECK(mien::Dna::open(bytes.stream())->info()->joint_count == dna.info()->joint_count);
}

void test_life() {
  mien::Rig rig = mien::Rig::create(generated()).value();
  mien::Instance face = rig.instance().value();
  CHECK(rig.count(MIEN_KIND_JOINT) > 0);
  CHECK(rig.joint_parents().size() == rig.count(MIEN_KIND_JOINT));
  CHECK(face.raw_controls().size() == rig.count(MIEN_KIND_RAW_CONTROL));
  for (float& control : face.raw_controls()) control = 0.5f;
  CHECK(rig.evaluate(face));
  CHECK(face.joints().size() == rig.info()->joint_value_count);
  float sum = 0;
  for (const float value : face.joints()) sum += value * value;
  CHECK(sum > 0);

  // Moving takes the object along; what is left is empty and may be used.
  const float* const joints = face.joints().data();
  mien::Instance moved = std::move(face);
  CHECK(moved.joints().data() == joints);
  CHECK(!face && face.joints().empty() && face.raw_controls().empty());  // NOLINT: on purpose
  CHECK(rig.evaluate(face).status() == MIEN_ERROR_NULL_ARGUMENT);
  CHECK(face.reset_values().status() == MIEN_ERROR_NULL_ARGUMENT);
  mien::Instance& itself = moved;
  moved = std::move(itself);
  CHECK(moved.joints().data() == joints);
  moved = rig.instance().value();
  CHECK(rig.evaluate(moved, rig.info()->lod_count - 1));

  // The order of destruction does not matter.
  rig.reset();
  CHECK(rig.evaluate(moved).status() == MIEN_ERROR_NULL_ARGUMENT);
  CHECK(!moved.joints().empty());
  mien_instance_destroy(moved.release());
}

void test_mixing() {
  const mien::Dna dna = generated();
  const mien::Rig rig = mien::Rig::create(dna).value();
  const uint32_t raw_count = rig.count(MIEN_KIND_RAW_CONTROL);
  const uint16_t curves[] = {0};
  const float half[] = {0.5f};
  const MienMixPose pose = {curves, half, 1};
  MienMixLayer layers[3] = {};
  layers[0].weight = layers[1].weight = layers[2].weight = 1;
  layers[1].source = MIEN_LAYER_SOURCE_POSES;
  layers[1].mode = MIEN_BLEND_MODE_SCREEN;
  layers[1].pose_count = 1;
  layers[2].source = MIEN_LAYER_SOURCE_STREAM;
  layers[2].curves = curves;
  layers[2].curve_count = 1;
  const MienMixStroke stroke = {0, 100, 0, 100, 0, MIEN_BLEND_MODE_MAX, 1, 0, 1, 0};
  MienMixReaction reaction = {};
  reaction.strokes = &stroke;
  reaction.stroke_count = 1;
  reaction.adapted = 1;
  reaction.level_on = 0.5f;
  mien::MixDesc desc;
  desc.layers = layers;
  desc.layer_count = 3;
  desc.poses = &pose;
  desc.pose_count = 1;
  desc.reactions = &reaction;
  desc.reaction_count = 1;
  desc.variable_count = 1;
  // What the rig says about itself.
  std::vector<float> mask(raw_count);
  CHECK(mien::Mix::antagonists(rig, {}) && mien::Mix::mask(rig, {}, 1, mask));
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  std::vector<uint16_t> mirror(raw_count + 1);
  CHECK(mien::Mix::mirror(deformer, mirror) && mirror[raw_count] == raw_count);
#ifndef MIEN_EXCEPTIONS
  CHECK(mien::Gaze::create(deformer).status() == MIEN_ERROR_NAME);  // this rig has no such eyes
  CHECK(mien::Gaze().info().status() == MIEN_ERROR_NULL_ARGUMENT);
  CHECK(mien::Gaze().look_at({0, 0, 1000}, mask).status() == MIEN_ERROR_NULL_ARGUMENT);
#endif

  std::vector<MienMatrixEntry> matrix(mien::arkit_matrix({}).value());
  CHECK(mien::arkit_matrix(matrix) && matrix.back().weight > 0);
  char name[32];
  const auto name_bytes = mien::control_name("AU12_L", mien::Span<char>(name, sizeof name));
  CHECK(name_bytes && std::string_view(name, name_bytes.value()) == "mouthSmileLeft");
  CHECK(rig.match("nobody").status() == MIEN_ERROR_NAME);
  CHECK(mien::control_name("nobody", mien::Span<char>()).status() == MIEN_ERROR_NAME);

  const mien::Mix mix = mien::Mix::create(rig, desc).value();
  CHECK(mix.info()->curve_count == raw_count + 1);
  std::vector<unsigned char> mix_bytes(mix.write(mien::Span<unsigned char>()).value());
  CHECK(mix.write(mix_bytes).value() == mix_bytes.size() && mix.write("mien_test.mix"));
  const mien::Mix same = mien::Mix::open(mix_bytes, &rig).value();
  std::vector<unsigned char> again(mix_bytes.size());
  CHECK(same.write(again).value() == again.size() && again == mix_bytes);
  CHECK(mien::Mix::open("mien_test.mix", nullptr)
            .value()
            .write(mien::Span<unsigned char>())
            .value() == again.size());
  std::vector<char> text(same.write_text({}).value());
  CHECK(same.write_text(text).value() == text.size() && text.back() == '\n');
  std::remove("mien_test.mix");

  mien::MixerDesc with_stages;
  with_stages.stages = 1;
  mien::Mixer mixer = mix.mixer(with_stages).value(), other = mix.mixer().value();
  mien::Instance face = rig.instance().value();
  CHECK(mixer.set_pose_weight(1, 0, 1) && mixer.set_variable(0, 0.25f));
  CHECK(mixer.set_weight(0, 0.5f, 10) && mixer.stop(0));
  CHECK(mixer.trigger(0, 1, -1) && mixer.end_stimulus(0));
  CHECK(other.set_level(0, 0.5f) && other.step(MIEN_TICKS_PER_SECOND) && other.row()[0] == 0.25f);
#ifndef MIEN_EXCEPTIONS
  CHECK(mixer.set_guard(0, 1).status() == MIEN_ERROR_INDEX);
  CHECK(mixer.guard(0).status() == MIEN_ERROR_INDEX);
  uint32_t layer = 0;
  CHECK(mixer.event(0, layer).status() == MIEN_ERROR_INDEX);
  CHECK(mixer.play(0, mien::Clip(), mien::ClipBinding()).status() == MIEN_ERROR_NULL_ARGUMENT);
#endif
  CHECK(mixer.push(2, 1000, half).value() && !mixer.push(2, 1000, half).value());
  CHECK(mixer.step(500, face) && face.raw_controls()[0] == 0.5f);
  CHECK(mixer.row()[0] == 0.5f && mixer.row()[raw_count] == 0.25f);
  CHECK(mixer.stage(0)[0] == 0 && mixer.stage(1)[0] == 0.5f && other.stage(0).empty());
  CHECK(mixer.info()->tick == 500);
  std::vector<unsigned char> bytes(mixer.snapshot({}).value());
  CHECK(mixer.snapshot(bytes) && other.restore(bytes, {}) && other.info()->tick == 500);
  CHECK(mixer.guard(0).status() == MIEN_ERROR_INDEX);
  CHECK(mix.guard(0).status() == MIEN_ERROR_INDEX);
  MienMixStroke glare[5];
  CHECK(mien::Mix::glare(3, glare)->strokes == glare && glare[1].pose == 4);
  CHECK(mien::Mix::glare(3, {}).status() == MIEN_ERROR_NULL_ARGUMENT);
  MienMixer* const both[] = {mixer.get(), other.get()};
  CHECK(mien::Mixer::step(both, {}, 100) && mixer.row()[0] == other.row()[0]);
}

void raise_joint(void* user, const MienSolverCall* call) {
  for (uint32_t i = 0; i < call->pose_count; ++i) {
    call->poses[i].locals[1] += *static_cast<float*>(user);
    call->poses[i].outputs[0] = 5;
  }
}

void test_solvers() {
  mien::GenerateDesc small;
  small.preset = MIEN_PRESET_SMALL;
  const mien::Dna dna = mien::generate(small).value();
  const mien::Rig rig = mien::Rig::create(dna).value();
  mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  std::vector<mien::DeformerInstance> bodies;
  for (int i = 0; i < 2; ++i) bodies.push_back(deformer.instance().value());
  const float before = bodies[0].joint_matrices()[13];
  float rise = 2;
  const uint16_t root = 0;
  MienUserSolver raise = {};
  raise.user = &rise;
  raise.solve = raise_joint;
  raise.writes = &root;
  raise.write_count = 1;
  raise.output_count = 1;
  MienSolver solver = {};
  solver.custom = &raise;
  mien::SolverStackDesc desc;
  desc.solvers = &solver;
  desc.solver_count = 1;
  desc.check_writes = 1;
  mien::SolverStack stack = mien::SolverStack::create(deformer, desc).value();
  CHECK(stack.info()->output_count == 1);
  std::vector<mien::SolverState> states;
  for (int i = 0; i < 2; ++i) states.push_back(stack.state().value());
  stack.reset();
  deformer.reset();
  CHECK(states[0].step(bodies[0], 10) && bodies[0].joint_matrices()[13] == before + 2);
  CHECK(states[0].outputs(0)[0] == 5 && states[0].outputs(1).empty());
  CHECK(states[0].transforms().size() % 10 == 0 && states[0].undeclared().value().empty());
  rise = 3;
  for (mien::DeformerInstance& body : bodies) CHECK(body.update({}, {}));
  CHECK(mien::step_batch(states, bodies, {}, 10));
  CHECK(bodies[1].joint_matrices()[13] == before + 3);
  CHECK(!mien::step_batch(states, {}, {}, 10));
  CHECK(mien::SolverState().step(bodies[0], 1).status() == MIEN_ERROR_NULL_ARGUMENT);
  solver.custom = nullptr;
  CHECK(mien::SolverStack::create(mien::Deformer(), desc).status() == MIEN_ERROR_NULL_ARGUMENT);
}

void test_clips() {
  const MienStringView names[] = {mien::view("jawOpen"), mien::view("nobody")};
  const float values[] = {0, 1, 0.5f, 1, 1, 1};
  const MienClipEvent events[] = {{0, mien::view("M"), 1, 0}};
  mien::ClipDesc desc;
  desc.frame_count = 3;
  desc.channel_count = 2;
  desc.names = names;
  desc.values = values;
  desc.events = events;
  desc.event_count = 1;
  Bytes bytes;
  {
    const mien::Clip built = mien::Clip::build(desc).value();
    bytes.data.resize(built.write(mien::Span<unsigned char>()).value());
    CHECK(built.write(bytes.data) && built.write("/dev/null"));
  }
  const MienStream stream = bytes.stream();
  for (const bool by_stream : {false, true}) {
    mien::Clip clip = (by_stream ? mien::Clip::open(stream)
                                 : mien::Clip::open(bytes.data.data(), bytes.data.size()))
                          .value();
    CHECK(clip.verify() && clip.info()->frame_count == 3);
    CHECK(mien::view(clip.channel(1)->name) == "nobody" &&
          clip.find_channel("nobody").value() == 1);
    CHECK(clip.event(0)->value == 1);
    float rows[4];
    CHECK(clip.read(1, 2, rows) && rows[0] == 0.5f && rows[3] == 1);
    CHECK(clip.read(0, 3, rows).status() == MIEN_ERROR_INVALID_ARGUMENT);

    mien::GenerateDesc head;
    head.preset = MIEN_PRESET_HEAD;
    const mien::Rig rig = mien::Rig::create(mien::generate(head).value()).value();
    mien::Instance face = rig.instance().value();
    const mien::ClipBinding binding = clip.bind(rig).value();
    CHECK(binding.info()->missing_channels.count == 1);
    mien::ClipPlayer player = clip.player().value();
    clip.reset();
    CHECK(player.advance(MIEN_TICKS_PER_SECOND / 120));
    MienClipEvent event;
    CHECK(player.next_event(event) && mien::view(event.name) == "M");
    CHECK(!player.next_event(event));
    CHECK(binding.apply(player.sample(), face.raw_controls()));
    CHECK(face.raw_controls()[rig.find(MIEN_KIND_RAW_CONTROL, "jawOpen").value()] == 0.25f);
    CHECK(player.seek(MIEN_TICKS_PER_SECOND) && player.sample()[0] == 1);
    CHECK(player.set_speed(-2) && player.info()->loops == 0);
  }
  CHECK(mien::Clip::open("/nonexistent").status() == MIEN_ERROR_FILE_OPEN);
}

void test_empty_objects() {
  const mien::Dna dna;
  const mien::Rig rig;
  const mien::Report report;
  CHECK(!dna.info() && !dna.layer(0) && !dna.field("") && !dna.string("desc.name"));
  CHECK(!dna.field_name("", 0) && !dna.write("/nonexistent"));
  CHECK(!rig.info() && !mien::statistics(rig, 0) && !mien::statistics(mien::Instance()) &&
        !rig.name(MIEN_KIND_JOINT, 0) && !rig.instance());
  CHECK(rig.count(MIEN_KIND_JOINT) == 0 && rig.joint_parents().empty());
  CHECK(rig.neutral_joint_values().empty() && rig.initial_raw_controls().empty());
  CHECK(!rig.find(MIEN_KIND_JOINT, "x") && !rig.psd_inputs(0));
  CHECK(!rig.lod_indices(MIEN_KIND_JOINT, 0) && !rig.variable_joint_values(0));
  CHECK(!mien::Rig::create(dna));
  CHECK(report.error_count() == 0 && report.warning_count() == 0 && !report.finding(0));
}

void test_errors() {
  const auto missing = mien::Dna::open("/nonexistent/head.dna");
  CHECK(!missing && missing.status() == MIEN_ERROR_FILE_OPEN);
  CHECK(std::string(missing.error().message()).find("head.dna") != std::string::npos);
  CHECK(missing.error().byte_offset() == MIEN_NO_OFFSET);
  CHECK(std::string(missing.error().name()) == "FILE_OPEN");

  const auto broken = mien::Dna::open("DNA", 3);
  CHECK(!broken && broken.status() == MIEN_ERROR_DNA_TRUNCATED);
  CHECK(broken.error().byte_offset() <= 3);

  const mien::Rig rig = mien::Rig::create(generated()).value();
  mien::Instance face = rig.instance().value();
  const auto unknown = rig.find(MIEN_KIND_JOINT, "nobody");
  CHECK(!unknown && unknown.status() == MIEN_ERROR_NAME && *unknown == 0);
  CHECK(std::string(unknown.error().message()) == "NAME");
  CHECK(rig.find(MIEN_KIND_JOINT, "nobody").value_or(7) == 7);
  CHECK(rig.evaluate(face, 99).status() == MIEN_ERROR_LOD);
  CHECK(std::string(rig.evaluate(face, 99).name()) == "LOD");
  CHECK(rig.evaluate_joint_group(face, 0, 1u << 30).status() == MIEN_ERROR_INDEX);
  CHECK(rig.evaluate_rbf_solver(face, 0, 1u << 30).status() == MIEN_ERROR_INDEX);
  CHECK(rig.evaluate_twist_swing(face, 0, 1u << 30).status() == MIEN_ERROR_INDEX);
  CHECK(rig.evaluate_stages(face, 0, MIEN_STAGE_PSD | MIEN_STAGE_JOINTS));
  CHECK(rig.map_gui_to_raw(face) && rig.map_raw_to_gui(face));

  // An error can be kept when its result is gone.
  mien::Error error;
  CHECK(error.status() == MIEN_OK);
  error = mien::Dna::open("DNA", 3).error();
  CHECK(error.status() == MIEN_ERROR_DNA_TRUNCATED && error.message()[0] != 0);
}

void test_fields_and_files() {
  const mien::Dna dna = generated();
  const MienDnaInfo info = dna.info().value();
  CHECK(dna.layer(0)->code == std::string("desc"));
  CHECK(dna.field("defn.jointNames")->count == info.joint_count);
  CHECK(dna.field_name("defn.neutralJointTranslations", 1).value() == "ys");
  CHECK(!dna.string("desc.name").value().empty());
  CHECK(dna.field("defn.nothing").status() == MIEN_ERROR_NAME);

  std::vector<float> xs(info.joint_count);
  CHECK(dna.read("defn.neutralJointTranslations.xs", 0, xs));
  std::array<int64_t, 2> parents;
  CHECK(dna.read("defn.jointHierarchy", 0, parents) && parents[0] == 0);
  CHECK(!dna.read("defn.neutralJointTranslations.xs", 1, xs));

  std::vector<unsigned char> bytes(dna.write(mien::Span<unsigned char>()).value());
  CHECK(dna.write(bytes).value() == bytes.size());
  bytes.resize(bytes.size() - 1);
  CHECK(dna.write(bytes).status() == MIEN_ERROR_INVALID_ARGUMENT);
  bytes.resize(bytes.size() + 1);
  CHECK(dna.write(bytes));
  mien::DnaDesc one_lod;
  one_lod.lods = 1;
  const mien::Dna cut = mien::Dna::open(bytes.data(), bytes.size(), one_lod).value();
  CHECK(cut.info()->lod_count == 1);

  CHECK(mien::coordinate_system_name(0) && !mien::coordinate_system_name(1000));
  CHECK(mien::coordinate_system("nothing").status() == MIEN_ERROR_NAME);
  const mien::CoordinateSystem unreal = mien::coordinate_system("unreal").value();
  mien::DnaDesc converted;
  converted.system = &unreal;
  const mien::Dna turned = mien::Dna::open(bytes.data(), bytes.size(), converted).value();
  CHECK(turned.info()->axes[2] == unreal.axes[2]);

  const mien::Report report = mien::Report::of(bytes.data(), bytes.size()).value();
  CHECK(report.error_count() == 0);
  const mien::Report faults = mien::Report::of("no DNA", 6).value();
  CHECK(faults.error_count() > 0 && !mien::view(faults.finding(0)->message).empty());
  CHECK(!mien::Report::of("/nonexistent"));
}

void run_in_order(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  ++*static_cast<int*>(user);
  for (uint32_t i = count; i-- > 0;) task(context, i);
}

void test_batch() {
  const mien::Rig rig = mien::Rig::create(generated()).value();
  mien::BatchDesc desc;
  desc.capacity = 3;
  desc.tasks = 2;
  mien::Batch batch = rig.batch(desc).value();
  CHECK(rig.batch_bytes(desc).value() > 0);
  desc.capacity = ~0u;
  CHECK(!rig.batch(desc));
  std::vector<mien::Instance> faces;
  for (int i = 0; i < 3; ++i) {
    faces.push_back(rig.instance().value());
    for (float& control : faces.back().raw_controls()) control = 0.25f * static_cast<float>(i);
  }
  const uint32_t lods[] = {0, 1, 0};
  CHECK(rig.evaluate_batch(batch, faces, lods));
  mien::Instance alone = rig.instance().value();
  for (float& control : alone.raw_controls()) control = 0.5f;
  CHECK(rig.evaluate(alone));
  CHECK(std::memcmp(alone.joints().data(), faces[2].joints().data(),
                    alone.joints().size() * sizeof(float)) == 0);
  int runs = 0;
  const MienParallelFor parallel = {&runs, run_in_order};
  CHECK(rig.evaluate_batch(batch, faces, lods, MIEN_STAGE_ALL, &parallel));
  CHECK(!rig.evaluate_batch(batch, faces, mien::Span<const uint32_t>(lods, 2)));
  // An empty owner is refused, and nothing is evaluated.
  mien::Instance second = std::move(faces[1]);
  CHECK(rig.evaluate_batch(batch, faces, lods).status() == MIEN_ERROR_NULL_ARGUMENT);
  faces[1] = std::move(second);
  mien::Batch none;
  CHECK(!rig.evaluate_batch(none, faces, lods));
}

void test_deformer() {
  const mien::Dna dna = generated(MIEN_PRESET_LARGE);
  const mien::Rig rig = mien::Rig::create(dna).value();
  mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  mien::Instance face = rig.instance().value();
  for (float& control : face.raw_controls()) control = 0.25f;
  CHECK(rig.evaluate(face));

  mien::DeformerInstance pose = deformer.instance().value();
  const MienMesh mesh = deformer.mesh(0).value();
  const auto neutral = mien::view(mesh.positions);
  CHECK(neutral.size() == size_t{3} * mesh.position_count);
  CHECK(mien::view(mesh.triangles).size() == size_t{3} * mesh.triangle_count);
  CHECK(pose.update(face) && pose.deform(0));
  const auto moved = pose.positions(0);
  float most = 0;
  for (size_t i = 0; i < moved.size(); ++i) {
    const float by = moved[i] - neutral[i];
    if (by * by > most) most = by * by;
  }
  CHECK(most > 0 && moved.size() == neutral.size());
  CHECK(pose.normals(0).size() == size_t{3} * mesh.vertex_count);
  CHECK(pose.joint_matrices().size() == size_t{16} * deformer.info()->joint_count);
  CHECK(pose.skin_matrices().size() == deformer.bind_matrices().size());
  CHECK(deformer.inverse_bind_matrices().size() == deformer.bind_matrices().size());

  // From arrays, by threads, and in a batch: the same bits.
  mien::DeformerInstance same = deformer.instance().value();
  int runs = 0;
  const MienParallelFor parallel = {&runs, run_in_order};
  CHECK(same.update(face.joints(), face.blend_shapes()));
  CHECK(same.deform(0, MIEN_NORMALS_SKINNED, &parallel) && runs > 0);
  CHECK(std::memcmp(same.positions(0).data(), moved.data(), moved.size() * sizeof(float)) == 0);
  mien::DeformerInstance both[] = {std::move(pose), std::move(same)};
  CHECK(mien::deform_batch(both, 0));
  pose = std::move(both[0]);
  same = std::move(both[1]);
  CHECK(std::memcmp(same.positions(0).data(), moved.data(), moved.size() * sizeof(float)) == 0);
  CHECK(same.update({}, {}));

  // Vertices, for one instance and for two.
  std::vector<float> vertices(size_t{2} * 3 * mesh.vertex_count);
  mien::VertexOutput output;
  output.vertex_capacity = mesh.vertex_count;
  output.positions = {vertices.data(), 12, MIEN_VERTEX_FORMAT_FLOAT32X3};
  CHECK(pose.write_vertices(0, output) && vertices[0] == pose.positions(0)[0]);
  output.vertex_capacity -= 1;
  CHECK(pose.write_vertices(0, output).status() == MIEN_ERROR_INVALID_ARGUMENT);
  output.vertex_capacity += 1;
  mien::VertexOutput outputs[] = {output, output};
  outputs[1].positions.data = vertices.data() + vertices.size() / 2;
  both[0] = std::move(pose);
  both[1] = std::move(same);
  CHECK(mien::write_vertices_batch(both, 0, outputs));
  CHECK(!mien::write_vertices_batch(both, 0, mien::Span<const mien::VertexOutput>(outputs, 1)));
  pose = std::move(both[0]);
  same = std::move(both[1]);
  CHECK(vertices[vertices.size() / 2] == same.positions(0)[0]);

  std::vector<float> transforms(size_t{10} * deformer.info()->joint_count);
  CHECK(pose.local_transforms(transforms));
  transforms.pop_back();
  CHECK(!pose.local_transforms(transforms));
  std::vector<float> deltas(neutral.size());
  CHECK(deformer.target(0, 0, deltas) && !deformer.target(0, 1u << 30, deltas));
  const MienMesh shape = deformer.mesh(0).value();
  std::vector<uint32_t> triangles(shape.triangles.count);
  std::vector<float> uvs(shape.texture_coordinates.count);
  CHECK(deformer.triangles(0, triangles) && deformer.texture_coordinates(0, uvs));
  CHECK(triangles.back() == shape.triangles.data[triangles.size() - 1]);
  CHECK(uvs.back() == shape.texture_coordinates.data[uvs.size() - 1]);
  const auto held = deformer.influences(0, 0).value();
  CHECK(held.joints.size() == held.weights.size() && !held.joints.empty());

  deformer.reset();
  CHECK(pose.deform(0) && !deformer.info() && !deformer.mesh(0) && !deformer.instance());
  CHECK(!deformer.influences(0, 0) && deformer.bind_matrices().empty());
  CHECK(!mien::Deformer::create(dna, mien::Rig()));
  mien::DeformerInstanceDesc last_lod;
  last_lod.lods = uint64_t{1} << 7;
  const mien::Deformer again = mien::Deformer::create(dna, rig).value();
  mien::DeformerInstance small = again.instance(last_lod).value();
  CHECK(small.deform(0).status() == MIEN_ERROR_LOD && small.positions(0).empty());
  mien::DeformerInstance empty;
  CHECK(!empty.update(face) && !empty.deform(0) && empty.joint_matrices().empty());
}

struct Counted {
  size_t blocks = 0;
};

void* allocate(void* user, size_t size, size_t alignment) {
  ++static_cast<Counted*>(user)->blocks;
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void release(void* user, void* block, size_t, size_t) {
  --static_cast<Counted*>(user)->blocks;
  std::free(block);
}

void test_allocators() {
  Counted counted;
  const MienAllocator allocator = {&counted, allocate, release};
  mien::RigDesc desc;
  desc.allocator = &allocator;
  desc.rotation_output = MIEN_ROTATION_OUTPUT_QUATERNION;
  mien::InstanceDesc instance_desc;
  instance_desc.allocator = &allocator;
  {
    const mien::Rig rig = mien::Rig::create(generated(), desc).value();
    const mien::Instance face = rig.instance(instance_desc).value();
    CHECK(counted.blocks >= 2);
    CHECK(face.joints().size() == size_t{10} * rig.count(MIEN_KIND_JOINT));
  }
  CHECK(counted.blocks == 0);
}

#ifdef MIEN_EXCEPTIONS
template <class Call>
MienStatus thrown_by(Call&& call) {
  try {
    call();
  } catch (const mien::Exception& exception) {
    CHECK(exception.what()[0] != 0);
    return exception.error().status();
  }
  return MIEN_OK;
}

void test_exceptions() {
  const mien::Rig rig = mien::Rig::create(generated()).value();
  mien::Instance face = rig.instance().value();
  CHECK(thrown_by([] { mien::Dna::open("DNA", 3).value(); }) == MIEN_ERROR_DNA_TRUNCATED);
  CHECK(thrown_by([&] { rig.evaluate(face, 99).value(); }) == MIEN_ERROR_LOD);
  CHECK(thrown_by([&] { rig.find(MIEN_KIND_JOINT, "x").value(); }) == MIEN_ERROR_NAME);
  CHECK(thrown_by([&] { generated().write("/nonexistent/x").value(); }) == MIEN_ERROR_FILE_WRITE);
  const auto kept = rig.find(MIEN_KIND_JOINT, "x");
  CHECK(thrown_by([&] { (void)kept.value(); }) == MIEN_ERROR_NAME);
  CHECK(thrown_by([&] { rig.evaluate(face).value(); }) == MIEN_OK);
}
#else
void test_exceptions() {}
#endif

}  // namespace

std::vector<unsigned char> bytes_of(const mien::Dna& dna) {
  std::vector<unsigned char> bytes(dna.write(mien::Span<unsigned char>()).value());
  dna.write(bytes).value();
  return bytes;
}

void test_document_fields() {
  const mien::Dna dna = generated();
  const auto before = bytes_of(dna);
  mien::Document head = mien::Document::of(dna).value();
  CHECK(bytes_of(head.to_dna().value()) == before);
  const uint64_t mark = head.mark().value();
  CHECK(head.write("desc.name", std::string_view("Ada")) && *head.string("desc.name") == "Ada");
  const char* const xs = "defn.neutralJointTranslations.xs";
  const float two[] = {1.5f, 2.5f};
  float read[2] = {};
  CHECK(head.write(xs, 1, two) && head.read(xs, 1, read) && read[1] == 2.5f);
  const int64_t gender[] = {2};
  int64_t found[] = {0};
  CHECK(head.write("desc.gender", 0, gender) && head.read("desc.gender", 0, found));
  CHECK(found[0] == 2 && head.bytes("desc.name")->size() == 3);
  CHECK(*head.field_name("desc", 0) == "name" && head.field("desc.metadata")->is_array == 0);
  CHECK(head.resize("desc.metadata", 2) && head.splice("desc.metadata", 0, 1, 3));
  CHECK(head.field("desc.metadata")->count == 4);
  CHECK(head.add_layer("note", 1, 0, "hi"));
  const auto layers = head.layer_count().value();
  CHECK(layers.version == 8 && layers.count == 12 && head.layer(11)->second == "hi");
  CHECK(std::string(head.layer(0)->first.code) == "desc");
  CHECK(head.clear_layers(8) && head.layer_count()->count == 0);
  CHECK(head.undo(mark) && bytes_of(head.to_dna().value()) == before);
  CHECK(head.validate()->error_count() == 0);

  CHECK(head.write("desc.name", 0, two).status() == MIEN_ERROR_INVALID_ARGUMENT);
  CHECK(head.field("no.such").status() == MIEN_ERROR_NAME && head.undo(77).status() != MIEN_OK);
  mien::Document none;
  CHECK(none.mark().status() == MIEN_ERROR_NULL_ARGUMENT && !none.to_dna());
  CHECK(mien::Document::empty()->field("defn.jointNames")->count == 0);
}

void test_document_operations() {
  const mien::Dna dna = generated();
  mien::Document head = mien::Document::of(dna).value();
  const mien::Document other = mien::Document::of(dna).value();
  const uint32_t joint = 2, mesh = 0;
  CHECK(head.rename(MIEN_KIND_JOINT, joint, "jaw"));
  CHECK(*head.find(MIEN_KIND_JOINT, "jaw") == joint);
  CHECK(head.find(MIEN_KIND_JOINT, "no such").status() == MIEN_ERROR_NAME);
  const float place[] = {1, 2, 3};
  CHECK(head.set_neutral(joint, place) && head.set_neutral(joint, {}, place));
  CHECK(head.set_neutral(joint, place, mien::Span<const float>(place, 1)).status() ==
        MIEN_ERROR_MISMATCH);
  float x = 0;
  CHECK(head.read("defn.neutralJointRotations.zs", joint, mien::Span<float>(&x, 1)) && x == 3);

  const size_t count = head.field("geom.meshes[0].positions.xs")->count;
  std::vector<float> positions(3 * count, 0.5f), weights(count, 0.5f);
  const std::vector<uint16_t> joints(count, 1);
  CHECK(head.set_weights(mesh, 1, joints, weights) && head.normalize_weights(mesh));
  CHECK(head.read("geom.meshes[0].skinWeights[0].weights", 0, mien::Span<float>(&x, 1)) && x == 1);
  CHECK(head.limit_influences(mesh, 1) && head.smooth_weights(mesh));
  const uint32_t vertex[] = {7};
  CHECK(head.set_target(mesh, 0, place, vertex) && head.prune_targets(100)->deltas > 0);
  mien::PruneJointsDesc prune;
  prune.translation = 1;
  CHECK(head.prune_joints(prune)->removed_count > 0);
  mien::Placement doubled;
  doubled.scale = 2;
  CHECK(head.place(doubled) && head.conform(mesh, positions));
  CHECK(head.set_positions(mesh, positions));
  CHECK(head.undo());
  CHECK(head.make_lod(1, 0) && head.copy_layers(other, MIEN_LAYER_DESCRIPTOR));
  CHECK(*head.copy_mesh(other, mesh) == mesh);
  CHECK(head.copy_mesh(head, mesh).status() == MIEN_ERROR_INVALID_ARGUMENT);
  CHECK(head.clear_joints(vertex) && head.remove(MIEN_KIND_JOINT, vertex));
  CHECK(head.merge_joints(other, 10) && head.split_joints(other));
  CHECK(head.convert(*mien::coordinate_system("unreal")) && head.clear(MIEN_KIND_ANIMATED_MAP));
  CHECK(head.keep_lods(1) && head.to_dna()->info()->lod_count == 1);
  CHECK(head.undo());
  std::vector<MienControlError> errors(4);
  CHECK(*head.transplant(other, errors) == 4);
  const uint64_t meshes = head.field("defn.meshNames")->count;
  mien::ProjectDesc by_uv;
  by_uv.match = MIEN_MATCH_UV;
  CHECK(meshes < 2 || head.project(1, 0, by_uv));
}

int main() {
  CHECK(mien::version() == MIEN_VERSION && mien::is_available(MIEN_ISA_SCALAR));
  CHECK(std::string(mien::name_of(MIEN_ISA_SCALAR)) == "scalar");
  test_life();
  test_streams();
  test_baked_files();
  test_clips();
  test_mixing();
  test_solvers();
  test_empty_objects();
  test_errors();
  test_fields_and_files();
  test_batch();
  test_deformer();
  test_allocators();
  test_document_fields();
  test_document_operations();
  test_exceptions();
  std::puts("mien.hpp: all well");
}
