// SPDX-License-Identifier: MIT
// Each public function that says it may lack memory, with every one of its requests failing in turn. The list
// is compared with the headers, so a function that is added later has to be added here.
#include <gtest/gtest.h>
#include <mien_solve.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tests/support/bytes.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/document_edits.h"
#include "tests/support/memory_stream.h"
#include "tests/support/mesh_source.h"
#include "tests/support/public_functions.h"
#include "tests/support/rig_handles.h"
#include "tests/support/temporary_path.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

namespace fs = std::filesystem;

std::set<std::string> functions_that_take_memory() {
  std::set<std::string> found;
  for (const PublicFunction& function : kPublicFunctions) {
    if (function.takes_memory) found.insert(function.name);
  }
  return found;
}

template <class Object>
struct Owned {
  Object* object = nullptr;
  void (*destroy)(Object*);

  explicit Owned(void (*with)(Object*)) : destroy(with) {}
  ~Owned() { destroy(object); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
};

/// An object of each kind, all from one allocator that counts.
struct World {
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  const fs::path folder = temporary_path("every_allocation");
  const std::string dna_file = path("a.dna"), baked_file = path("a.mien"),
                    clip_file = path("a.clip");
  const std::string mix_file = path("a.mix"), written_file = path("b");
  Owned<MienDna> dna{mien_dna_close};
  Owned<MienDna> tiny{mien_dna_close};  // with layers that lower versions lack
  Owned<MienRig> rig{mien_rig_destroy};
  Owned<MienDeformer> deformer{mien_deformer_destroy};
  Owned<MienDerivatives> derivatives{mien_derivatives_destroy};
  Owned<MienBaked> baked{mien_baked_close};
  Owned<MienRig> baked_rig{mien_rig_destroy};
  Owned<MienClip> clip{mien_clip_close};
  Owned<MienClipBinding> binding{mien_clip_binding_destroy};
  Owned<MienMix> mix{mien_mix_destroy};
  Owned<MienSolverStack> stack{mien_solver_stack_destroy};
  Owned<MienDeformer> head_deformer{mien_deformer_destroy};   // with eyes
  Owned<MienDeformer> fixed_deformer{mien_deformer_destroy};  // 16-bit storage
  Bytes dna_bytes, tiny_bytes, baked_bytes, clip_bytes, mix_bytes;
  uint32_t raw_count = 0;
  std::vector<std::string> names;
  std::vector<MienStringView> name_views;
  std::vector<float> values;
  MienClipEvent event = {0, {"word", 4}, 0.5f, 0};
  MienMixLayer layer = {};
  MienAimSolver aim = {};
  MienSolver solver = {};

  template <class Desc>
  Desc desc() const {
    return desc_with<Desc>(&allocator);
  }
  std::string path(const char* name) const { return (folder / name).u8string(); }

  MienClipDesc clip_desc() const {
    auto wanted = desc<MienClipDesc>();
    wanted.frame_count = 70;
    wanted.channel_count = 2;
    wanted.names = name_views.data();
    wanted.values = values.data();
    wanted.events = &event;
    wanted.event_count = 1;
    return wanted;
  }
  MienMixDesc mix_desc() const {
    auto wanted = desc<MienMixDesc>();
    wanted.layers = &layer;
    wanted.layer_count = 1;
    wanted.deformer = deformer.object;
    wanted.guards = MIEN_GUARD_ALL;
    return wanted;
  }
  MienSolverStackDesc stack_desc() const {
    auto wanted = desc<MienSolverStackDesc>();
    wanted.solvers = &solver;
    wanted.solver_count = 1;
    wanted.curve_count = 6;
    wanted.check_writes = 1;
    return wanted;
  }

  World() {
    fs::remove_all(folder);
    fs::create_directories(folder);
    auto generate = desc<MienGenerateDesc>();
    generate.preset = MIEN_PRESET_SMALL;
    generate.seed = 1;
    done(mien_dna_generate(&generate, &dna.object, nullptr));
    const auto of_rig = desc<MienRigDesc>();
    done(mien_rig_create(dna.object, &of_rig, &rig.object, nullptr));
    const auto of_deformer = desc<MienDeformerDesc>();
    done(mien_deformer_create(dna.object, rig.object, &of_deformer, &deformer.object, nullptr));
    auto of_derivatives = desc<MienDerivativesDesc>();
    of_derivatives.deformer = deformer.object;
    done(mien_derivatives_create(rig.object, &of_derivatives, &derivatives.object, nullptr));
    dna_bytes = write_dna(dna.object);
    Arena arena(default_allocator());
    tiny_bytes = dna::written(dna::tiny_rig(arena));
    const auto of_tiny = desc<MienDnaDesc>();
    done(mien_dna_open_memory(tiny_bytes.data(), tiny_bytes.size(), &of_tiny, &tiny.object,
                              nullptr));
    size_t size = 0;
    done(mien_bake_memory(rig.object, deformer.object, nullptr, 0, &size, nullptr));
    baked_bytes.resize(size);
    done(mien_bake_memory(rig.object, deformer.object, baked_bytes.data(), size, &size, nullptr));
    const auto of_baked = desc<MienBakedDesc>();
    done(mien_baked_open_memory(baked_bytes.data(), size, &of_baked, &baked.object, nullptr));
    const auto of_baked_rig = desc<MienBakedRigDesc>();
    done(mien_rig_from_baked(baked.object, &of_baked_rig, &baked_rig.object, nullptr));

    done(mien_rig_count(rig.object, MIEN_KIND_RAW_CONTROL, &raw_count));
    for (uint32_t i = 0; i < 2; ++i) {
      MienStringView name;
      done(mien_rig_name(rig.object, MIEN_KIND_RAW_CONTROL, i, &name));
      names.emplace_back(name.data, name.count);
    }
    for (const std::string& name : names) name_views.push_back({name.data(), name.size()});
    for (size_t i = 0; i < 140; ++i) values.push_back(static_cast<float>(i % 97) / 128);
    const MienClipDesc of_clip = clip_desc();
    done(mien_clip_build(&of_clip, &clip.object, nullptr));
    done(mien_clip_write_memory(clip.object, nullptr, 0, &size, nullptr));
    clip_bytes.resize(size);
    done(mien_clip_write_memory(clip.object, clip_bytes.data(), size, &size, nullptr));
    const auto of_binding = desc<MienClipBindingDesc>();
    done(mien_clip_binding_create(clip.object, rig.object, &of_binding, &binding.object, nullptr));

    layer.weight = 1;
    const MienMixDesc of_mix = mix_desc();
    done(mien_mix_create(rig.object, &of_mix, &mix.object, nullptr));
    done(mien_mix_write_memory(mix.object, nullptr, 0, &size, nullptr));
    mix_bytes.resize(size);
    done(mien_mix_write_memory(mix.object, mix_bytes.data(), size, &size, nullptr));
    aim.joint = 1;
    aim.target_joint = MIEN_NO_JOINT;
    aim.axis[2] = 1;
    aim.cone_degrees = 40;
    aim.weight = 1;
    solver.aim = &aim;
    const MienSolverStackDesc of_stack = stack_desc();
    done(mien_solver_stack_create(deformer.object, &of_stack, &stack.object, nullptr));

    const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0);
    const RigHandle head_rig = create_rig(head.get());
    done(mien_deformer_create(head.get(), head_rig.get(), nullptr, &head_deformer.object, nullptr));
    auto fixed = desc<MienDeformerDesc>();
    fixed.storage = MIEN_STORAGE_16_BIT;
    done(mien_deformer_create(dna.object, rig.object, &fixed, &fixed_deformer.object, nullptr));

    for (const auto& [file, bytes] : {std::pair{&dna_file, &dna_bytes},
                                      {&baked_file, &baked_bytes},
                                      {&clip_file, &clip_bytes},
                                      {&mix_file, &mix_bytes}}) {
      std::ofstream out(fs::u8path(*file), std::ios::binary);
      out.write(reinterpret_cast<const char*>(bytes->data()),
                static_cast<std::streamsize>(bytes->size()));
    }
  }
  ~World() { fs::remove_all(folder); }

 private:
  static void done(MienStatus status) { ASSERT_STREQ(mien_status_name(status), "OK"); }
};

/// What a call made is destroyed at once; NULL if it failed.
template <class Object, class Make>
MienStatus made_and_destroyed(void (*destroy)(Object*), const Make& make) {
  Object* object = reinterpret_cast<Object*>(&destroy);  // to be overwritten
  const MienStatus status = make(&object);
  EXPECT_EQ(object == nullptr, status != MIEN_OK);
  destroy(object);
  return status;
}

struct Call {
  const char* function;
  std::function<MienStatus(MienError*)> run;
};

template <class Function, class... Given>
auto calls(Function function, Given... given) {
  return [=](MienError* error) { return function(given..., error); };
}

/// A function that takes, behind what is given, a description, the object that it makes, and an error.
template <class Object, class Desc, class Function, class... Given>
auto makes(void (*destroy)(Object*), const Desc& desc, Function make, Given... given) {
  return [=](MienError* error) {
    return made_and_destroyed(destroy,
                              [&](Object** out) { return make(given..., &desc, out, error); });
  };
}

/// The same, of a stream of `bytes`.
template <class Object, class Desc, class Function>
auto opens(void (*destroy)(Object*), const Desc& desc, Function open, const Bytes& bytes) {
  return [=, &bytes](MienError* error) {
    MemoryStream source(bytes);
    const Stream stream = source.get();
    const MienStream given = {stream.user, stream.size, stream.read};
    return makes(destroy, desc, open, &given)(error);
  };
}

/// The procedural head at its last LOD, with expressions.
struct AuthorInput {
  author::TestMesh mesh = author::procedural_mesh(7, true);
  std::vector<MienAuthorShape> shapes;
  MienAuthorMesh given = sized<MienAuthorMesh>();
  MienAuthorLod lod = {};  // three corners of the first face

  AuthorInput() {
    lod.corners = mesh.corners.data();
    lod.corner_count = 3;
    for (size_t s = 0; s < mesh.shape_names.size(); ++s) {
      MienAuthorShape shape = {};
      shape.name = {mesh.shape_names[s].data(), mesh.shape_names[s].size()};
      shape.displacements = mesh.displacements[s].data();
      shape.position_count = mesh.displacements[s].size() / 3;
      shapes.push_back(shape);
    }
    given.positions = mesh.positions.data();
    given.position_count = mesh.positions.size() / 3;
    given.face_sizes = mesh.face_sizes.data();
    given.face_count = mesh.face_sizes.size();
    given.corners = mesh.corners.data();
    given.corner_count = mesh.corners.size();
    given.shapes = shapes.data();
    given.shape_count = shapes.size();
  }
};

std::vector<Call> calls_of_dna(const World& w) {
  auto small = w.desc<MienGenerateDesc>();
  small.preset = MIEN_PRESET_SMALL;
  // What a lower version leaves out is checked for.
  auto lower = sized<MienWriteDesc>();
  lower.version = 4;
  lower.unknown_layers = MIEN_UNKNOWN_LAYERS_DROP;
  return {
      {"mien_dna_open_file",
       makes(mien_dna_close, w.desc<MienDnaDesc>(), mien_dna_open_file, w.dna_file.c_str())},
      {"mien_dna_open_memory", makes(mien_dna_close, w.desc<MienDnaDesc>(), mien_dna_open_memory,
                                     w.dna_bytes.data(), w.dna_bytes.size())},
      {"mien_dna_open_stream",
       opens(mien_dna_close, w.desc<MienDnaDesc>(), mien_dna_open_stream, w.dna_bytes)},
      {"mien_dna_write_file",
       calls(mien_dna_write_file, w.dna.object, w.written_file.c_str(), nullptr)},
      {"mien_dna_write_memory",
       [&w, lower](MienError* error) {
         size_t size;
         return mien_dna_write_memory(w.tiny.object, &lower, nullptr, 0, &size, error);
       }},
      {"mien_dna_validate_file", makes(mien_report_destroy, w.desc<MienValidateDesc>(),
                                       mien_dna_validate_file, w.dna_file.c_str())},
      {"mien_dna_validate_memory",
       makes(mien_report_destroy, w.desc<MienValidateDesc>(), mien_dna_validate_memory,
             w.dna_bytes.data(), w.dna_bytes.size())},
      {"mien_dna_generate", makes(mien_dna_close, small, mien_dna_generate)},
  };
}

std::vector<Call> calls_of_rigs(const World& w) {
  static constexpr uint32_t kFirstPosition = 0;
  auto tangents = w.desc<MienDeformerDesc>();
  tangents.with_tangents = 1;
  auto copied = w.desc<MienBakedDesc>();
  copied.file_access = MIEN_FILE_READ;
  auto of_derivatives = w.desc<MienDerivativesDesc>();
  of_derivatives.deformer = w.deformer.object;
  auto of_jacobian = w.desc<MienJacobianDesc>();
  of_jacobian.from_point = MIEN_POINT_RAW;
  of_jacobian.to_point = MIEN_POINT_POSITIONS;
  auto sums = w.desc<MienRigDesc>();
  sums.reuse = MIEN_REUSE_SUMS;
  auto baked_sums = w.desc<MienBakedRigDesc>();
  baked_sums.reuse = MIEN_REUSE_SUMS;
  return {
      {"mien_rig_create",
       makes(mien_rig_destroy, w.desc<MienRigDesc>(), mien_rig_create, w.dna.object)},
      {"mien_rig_create", makes(mien_rig_destroy, sums, mien_rig_create, w.dna.object)},
      {"mien_instance_create", makes(mien_instance_destroy, w.desc<MienInstanceDesc>(),
                                     mien_instance_create, w.rig.object)},
      {"mien_batch_create",
       makes(mien_batch_destroy, batch_desc(20, 3, &w.allocator), mien_batch_create, w.rig.object)},
      {"mien_deformer_create",
       makes(mien_deformer_destroy, tangents, mien_deformer_create, w.dna.object, w.rig.object)},
      {"mien_deformer_create_subset",
       makes(mien_deformer_destroy, w.allocator, mien_deformer_create_subset, w.deformer.object, 0u,
             &kFirstPosition, size_t{1})},
      {"mien_deformer_instance_create",
       makes(mien_deformer_instance_destroy, w.desc<MienDeformerInstanceDesc>(),
             mien_deformer_instance_create, w.deformer.object)},
      {"mien_deformer_triangles",
       [&w](MienError* error) {
         auto mesh = sized<MienMesh>();
         if (MienStatus status = mien_deformer_mesh(w.fixed_deformer.object, 0, &mesh)) {
           return status;
         }
         std::vector<uint32_t> triangles(size_t{3} * mesh.triangle_count);
         const MienStatus status = mien_deformer_triangles(w.fixed_deformer.object, 0,
                                                           triangles.data(), triangles.size());
         if (status != MIEN_OK) error->message[0] = '?';  // it takes no MienError
         return status;
       }},
      {"mien_derivatives_create",
       makes(mien_derivatives_destroy, of_derivatives, mien_derivatives_create, w.rig.object)},
      {"mien_jacobian_create", makes(mien_jacobian_destroy, of_jacobian, mien_jacobian_create,
                                     static_cast<const MienDerivatives*>(w.derivatives.object))},
      {"mien_bake_file",
       calls(mien_bake_file, w.rig.object, w.deformer.object, w.written_file.c_str())},
      {"mien_baked_open_file",
       makes(mien_baked_close, copied, mien_baked_open_file, w.baked_file.c_str())},
      {"mien_baked_open_memory",
       makes(mien_baked_close, w.desc<MienBakedDesc>(), mien_baked_open_memory,
             w.baked_bytes.data(), w.baked_bytes.size())},
      {"mien_baked_open_stream",
       opens(mien_baked_close, w.desc<MienBakedDesc>(), mien_baked_open_stream, w.baked_bytes)},
      {"mien_rig_from_baked",
       makes(mien_rig_destroy, w.desc<MienBakedRigDesc>(), mien_rig_from_baked, w.baked.object)},
      {"mien_rig_from_baked",
       makes(mien_rig_destroy, baked_sums, mien_rig_from_baked, w.baked.object)},
      {"mien_deformer_from_baked",
       makes(mien_deformer_destroy, w.desc<MienBakedDeformerDesc>(), mien_deformer_from_baked,
             w.baked.object, w.baked_rig.object)},
  };
}

std::vector<Call> calls_of_clips(const World& w) {
  auto copied = w.desc<MienClipOpenDesc>();
  copied.file_access = MIEN_FILE_READ;
  return {
      {"mien_clip_build", makes(mien_clip_close, w.clip_desc(), mien_clip_build)},
      {"mien_clip_open_file",
       makes(mien_clip_close, copied, mien_clip_open_file, w.clip_file.c_str())},
      {"mien_clip_open_memory",
       makes(mien_clip_close, w.desc<MienClipOpenDesc>(), mien_clip_open_memory,
             w.clip_bytes.data(), w.clip_bytes.size())},
      {"mien_clip_open_stream",
       opens(mien_clip_close, w.desc<MienClipOpenDesc>(), mien_clip_open_stream, w.clip_bytes)},
      {"mien_clip_write_file", calls(mien_clip_write_file, w.clip.object, w.written_file.c_str())},
      {"mien_clip_player_create", makes(mien_clip_player_destroy, w.desc<MienClipPlayerDesc>(),
                                        mien_clip_player_create, w.clip.object)},
      {"mien_clip_binding_create", makes(mien_clip_binding_destroy, w.desc<MienClipBindingDesc>(),
                                         mien_clip_binding_create, w.clip.object, w.rig.object)},
      {"mien_clip_binding_snaps",
       [&w](MienError* error) {
         float snaps[2];
         return mien_clip_binding_snaps(w.binding.object, w.deformer.object, 0.02f, snaps, 2,
                                        error);
       }},
  };
}

std::vector<Call> calls_of_solving(const World& w) {
  static constexpr uint32_t kControls[] = {0, 1};
  static constexpr MienSolvePoint kPoint = {0, {0, 1, 2}, {0.25f, 0.25f, 0.5f}};
  auto desc = w.desc<MienFitDesc>();
  desc.deformer = w.deformer.object;
  desc.controls = kControls;
  desc.control_count = 2;
  desc.points = &kPoint;
  desc.point_count = 1;
  static constexpr float kPositions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  static constexpr uint32_t kTriangles[] = {0, 1, 2, 2, 1, 3};
  auto surface = w.desc<MienFitSurfaceDesc>();
  surface.positions = kPositions;
  surface.position_count = 4;
  surface.triangles = kTriangles;
  surface.triangle_count = 2;
  return {{"mien_fit_create", makes(mien_fit_destroy, desc, mien_fit_create, w.rig.object)},
          {"mien_fit_surface_create",
           makes(mien_fit_surface_destroy, surface, mien_fit_surface_create)}};
}

std::vector<Call> calls_of_mixes(const World& w) {
  return {
      {"mien_mix_create", makes(mien_mix_destroy, w.mix_desc(), mien_mix_create, w.rig.object)},
      {"mien_mix_open_file", makes(mien_mix_destroy, w.desc<MienMixOpenDesc>(), mien_mix_open_file,
                                   w.mix_file.c_str(), w.rig.object)},
      {"mien_mix_open_memory",
       makes(mien_mix_destroy, w.desc<MienMixOpenDesc>(), mien_mix_open_memory, w.mix_bytes.data(),
             w.mix_bytes.size(), w.rig.object)},
      {"mien_mix_write_file", calls(mien_mix_write_file, w.mix.object, w.written_file.c_str())},
      {"mien_mix_write_memory",
       [&w](MienError* error) {
         Bytes bytes(w.mix_bytes.size());
         size_t size;
         return mien_mix_write_memory(w.mix.object, bytes.data(), bytes.size(), &size, error);
       }},
      {"mien_mix_write_text",
       [&w](MienError* error) {
         size_t size;
         return mien_mix_write_text(w.mix.object, nullptr, 0, &size, error);
       }},
      {"mien_mix_mirror",
       [&w](MienError* error) {
         std::vector<uint16_t> curves(w.raw_count);
         return mien_mix_mirror(w.deformer.object, curves.data(), curves.size(), error);
       }},
      {"mien_mix_mask",
       [&w](MienError* error) {
         std::vector<float> mask(w.raw_count);
         const uint32_t group = 0;
         return mien_mix_mask(w.rig.object, &group, 1, 0, mask.data(), mask.size(), error);
       }},
      {"mien_gaze_create",
       makes(mien_gaze_destroy, w.desc<MienGazeDesc>(), mien_gaze_create, w.head_deformer.object)},
      {"mien_mixer_create",
       makes(mien_mixer_destroy, w.desc<MienMixerDesc>(), mien_mixer_create, w.mix.object)},
      {"mien_solver_stack_create", makes(mien_solver_stack_destroy, w.stack_desc(),
                                         mien_solver_stack_create, w.deformer.object)},
      {"mien_solver_state_create", makes(mien_solver_state_destroy, w.desc<MienSolverStateDesc>(),
                                         mien_solver_state_create, w.stack.object)},
  };
}

std::vector<Call> calls_of_authoring(const World& w, const AuthorInput& input) {
  auto desc = w.desc<MienAuthorDesc>();
  desc.facial_joints = 6;
  desc.lods = 2;
  desc.influences = 4;
  auto with_lods = desc;
  with_lods.facial_joints = with_lods.influences = 1;
  with_lods.lod_meshes = &input.lod;
  with_lods.lod_mesh_count = 1;
  const auto rig = [&input](const MienAuthorDesc& given) {
    return [&input, given](MienError* error) {
      return made_and_destroyed(mien_dna_close, [&](MienDna** out) {
        return made_and_destroyed(mien_author_report_close, [&](MienAuthorReport** report) {
          return mien_author_rig(&input.given, &given, out, report, error);
        });
      });
    };
  };
  return {{"mien_author_rig", rig(desc)}, {"mien_author_rig", rig(with_lods)}};
}

/// A change of a document, which is made and destroyed with it.
template <class Edit>
auto edits(const World& w, const Edit& edit) {
  return [&w, edit](MienError* error) {
    const auto desc = w.desc<MienDocumentDesc>();
    MienDocument* document = nullptr;
    MienStatus status = mien_document_create(w.tiny.object, &desc, &document, error);
    if (status == MIEN_OK) status = edit(document, error);
    mien_document_destroy(document);
    return status;
  };
}

std::vector<Call> calls_of_documents(const World& w, const DocumentHandle& other) {
  const auto desc = w.desc<MienDocumentDesc>();
  const auto validate = w.desc<MienValidateDesc>();
  static const float number = 2;
  static const int64_t integer = 0;
  std::vector<Call> calls = {
      {"mien_document_create",
       makes(mien_document_destroy, desc, mien_document_create, w.tiny.object)},
      {"mien_document_create", makes(mien_document_destroy, desc, mien_document_create, nullptr)},
      {"mien_document_write_floats", edits(w,
                                           [](MienDocument* d, MienError* error) {
                                             return mien_document_write_floats(
                                                 d, "geom.meshes[0].positions.xs", 0, 1, &number,
                                                 error);
                                           })},
      {"mien_document_write_integers", edits(w,
                                             [](MienDocument* d, MienError* error) {
                                               return mien_document_write_integers(
                                                   d, "defn.jointHierarchy", 0, 1, &integer, error);
                                             })},
      {"mien_document_write_string", edits(w,
                                           [](MienDocument* d, MienError* error) {
                                             return mien_document_write_string(
                                                 d, "defn.jointNames[0]", "a", 1, error);
                                           })},
      {"mien_document_splice", edits(w,
                                     [](MienDocument* d, MienError* error) {
                                       return mien_document_splice(d, "desc.metadata", 0, 0, 3,
                                                                   error);
                                     })},
      {"mien_document_resize", edits(w,
                                     [](MienDocument* d, MienError* error) {
                                       return mien_document_resize(d, "desc.metadata", 900, error);
                                     })},
      {"mien_document_mark", edits(w,
                                   [](MienDocument* d, MienError* error) {
                                     uint64_t mark;
                                     return mien_document_mark(d, &mark, error);
                                   })},
      {"mien_document_to_dna", edits(w,
                                     [desc](MienDocument* d, MienError* error) {
                                       return makes(mien_dna_close, desc, mien_document_to_dna,
                                                    d)(error);
                                     })},
      {"mien_document_open_file",
       [desc](MienError* error) {
         MienDocument* made = nullptr;
         const std::string path = golden::path_of("tiny");
         const MienStatus status = mien_document_open_file(path.c_str(), &desc, &made, error);
         mien_document_destroy(made);
         return status;
       }},
      {"mien_document_write_file", edits(w,
                                         [&w](MienDocument* d, MienError* error) {
                                           return mien_document_write_file(
                                               d, w.written_file.c_str(), nullptr, error);
                                         })},
      {"mien_document_write_stream",
       edits(w,
             [](MienDocument* d, MienError* error) {
               const auto take = [](void*, const void*, size_t size) { return size; };
               const MienByteSink sink = {nullptr, take};
               return mien_document_write_stream(d, &sink, nullptr, error);
             })},
      {"mien_document_write_memory", edits(w,
                                           [](MienDocument* d, MienError* error) {
                                             size_t size = 0;
                                             return mien_document_write_memory(d, nullptr, nullptr,
                                                                               0, &size, error);
                                           })},
      {"mien_document_validate", edits(w,
                                       [validate](MienDocument* d, MienError* error) {
                                         return makes(mien_report_destroy, validate,
                                                      mien_document_validate, d)(error);
                                       })},
  };
  // Those that refuse their arguments for this rig are called by tests/author/document, too.
  for (const DocumentEdit& edit : document_edits()) {
    calls.push_back({edit.function, edits(w, [&other, edit](MienDocument* d, MienError* error) {
                       Random random(1, 1);
                       const MienStatus status = edit.run(d, other.get(), random, error);
                       return status == MIEN_ERROR_MEMORY ? status : MIEN_OK;
                     })});
  }
  return calls;
}

/// Requests that the call makes.
size_t survive_every_failure(World& world, const Call& call) {
  SCOPED_TRACE(call.function);
  CountingAllocator& memory = world.memory;
  const size_t live = memory.live, bytes = memory.bytes;
  for (size_t k = 1;; ++k) {
    for (const bool keep_failing : {false, true}) {
      memory.restart();
      memory.fail_at = k;
      memory.keep_failing = keep_failing;
      MienError error = sized<MienError>();
      const MienStatus status = call.run(&error);
      EXPECT_STREQ(mien_status_name(status), memory.failed ? "MEMORY" : "OK")
          << "request " << k << ": " << error.message;
      EXPECT_EQ(memory.live, live) << "request " << k;
      EXPECT_EQ(memory.bytes, bytes) << "request " << k;
      EXPECT_EQ(memory.first_wrong, "");
      if (memory.failed) {
        EXPECT_NE(error.message[0], 0);
      }
    }
    memory.fail_at = 0;
    if (memory.failed == 0) return k - 1;
  }
}

TEST(EveryAllocation, MayFailUnderEveryFunctionThatTakesMemory) {
  World world;
  const AuthorInput input;
  const DocumentHandle other = create_document(world.tiny.object);
  ASSERT_FALSE(HasFailure());
  std::set<std::string> called;
  for (const auto& calls : {calls_of_dna(world), calls_of_rigs(world), calls_of_clips(world),
                            calls_of_mixes(world), calls_of_solving(world),
                            calls_of_authoring(world, input), calls_of_documents(world, other)}) {
    for (const Call& call : calls) {
      const size_t requests = survive_every_failure(world, call);
      EXPECT_GT(requests, 0u) << call.function;
      printf("%s: %zu requests\n", call.function, requests);
      called.insert(call.function);
    }
  }
  EXPECT_EQ(called, functions_that_take_memory());
}

}  // namespace
}  // namespace mien
