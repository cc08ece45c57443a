// SPDX-License-Identifier: MIT
//
// Mien for C++17 and later: owners, spans and results over mien.h, in one header. Nothing is added
// to what the C interface does, and nothing hidden: get() gives the handle for all that is not
// here.
//
//   Owners      Dna, Report, Rig, Instance, Batch, Deformer, DeformerInstance, Baked, Clip, ClipPlayer,
//               ClipBinding, Mix, Mixer, Gaze, SolverStack and SolverState release what they hold. They
//               can be moved, not copied. Calls on an empty one (default, moved from) return
//               MIEN_ERROR_NULL_ARGUMENT; its spans are empty.
//   Results     A call that can fail returns a Result: test it, then use *result; or use value().
//               Errors carry status, byte offset and message.
//   Spans       std::span where the standard library has it, else a Span with the same core. They
//               point into the object they came from and live as long as it does.
//   Exceptions  None; the header compiles with -fno-exceptions. With MIEN_EXCEPTIONS defined before it
//               is included, value() of a failed Result throws mien::Exception. Without, it aborts.
//   Linking     Files of one program may differ in MIEN_EXCEPTIONS and in the C++ standard: each
//               combination has an inline namespace of its own. Types of one do not convert to another.
//
// Units, threads and shapes: see mien.h. What makes and changes files is in mien_author.hpp.
#pragma once

#include <mien.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#if __has_include(<version>)
#include <version>
#endif
#ifdef __cpp_lib_span
#include <span>
#endif
#ifdef MIEN_EXCEPTIONS
#include <exception>
#endif

#if defined(MIEN_EXCEPTIONS) && defined(__cpp_lib_span)
#define MIEN_CPP_NAMESPACE exceptions_std_span
#elif defined(MIEN_EXCEPTIONS)
#define MIEN_CPP_NAMESPACE exceptions_own_span
#elif defined(__cpp_lib_span)
#define MIEN_CPP_NAMESPACE plain_std_span
#else
#define MIEN_CPP_NAMESPACE plain_own_span
#endif

namespace mien {
inline namespace MIEN_CPP_NAMESPACE {

// ---- Spans and descs ---------------------------------------------------------------------

#ifdef __cpp_lib_span
template <class T>
using Span = std::span<T>;
#else
template <class T>
class Span {
 public:
  using value_type = std::remove_cv_t<T>;

  constexpr Span() = default;
  constexpr Span(T* data, size_t size) : data_(data), size_(size) {}
  /// Arrays, vectors and other spans.
  template <class Range, class = decltype(static_cast<T*>(std::declval<Range&>().data()))>
  constexpr Span(Range&& range)  // NOLINT: implicit, as std::span is
      : data_(range.data()), size_(range.size()) {}
  template <size_t Count>
  constexpr Span(T (&array)[Count]) : data_(array), size_(Count) {}  // NOLINT: as above

  constexpr T* data() const { return data_; }
  constexpr size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr T& operator[](size_t i) const { return data_[i]; }
  constexpr T* begin() const { return data_; }
  constexpr T* end() const { return data_ + size_; }
  constexpr Span subspan(size_t first, size_t count) const { return {data_ + first, count}; }

 private:
  T* data_ = nullptr;
  size_t size_ = 0;
};
#endif

/// A struct of mien.h with all fields zero and its size in place.
template <class Struct>
struct Sized : Struct {
  Sized() : Struct() { this->struct_size = sizeof(Struct); }
};
using DnaDesc = Sized<MienDnaDesc>;
using WriteDesc = Sized<MienWriteDesc>;
using RigDesc = Sized<MienRigDesc>;
using BakedDesc = Sized<MienBakedDesc>;
using BakedRigDesc = Sized<MienBakedRigDesc>;
using BakedDeformerDesc = Sized<MienBakedDeformerDesc>;
using DeformerDesc = Sized<MienDeformerDesc>;
using DeformerInstanceDesc = Sized<MienDeformerInstanceDesc>;
using VertexOutput = Sized<MienVertexOutput>;
using InstanceDesc = Sized<MienInstanceDesc>;
using BatchDesc = Sized<MienBatchDesc>;
using ValidateDesc = Sized<MienValidateDesc>;
using ClipDesc = Sized<MienClipDesc>;
using ClipOpenDesc = Sized<MienClipOpenDesc>;
using ClipPlayerDesc = Sized<MienClipPlayerDesc>;
using ClipBindingDesc = Sized<MienClipBindingDesc>;
using MixDesc = Sized<MienMixDesc>;
using MixOpenDesc = Sized<MienMixOpenDesc>;
using MixerDesc = Sized<MienMixerDesc>;
using PlayDesc = Sized<MienPlayDesc>;
using GazeDesc = Sized<MienGazeDesc>;
using SolverStackDesc = Sized<MienSolverStackDesc>;
using SolverStateDesc = Sized<MienSolverStateDesc>;
using CoordinateSystem = Sized<MienCoordinateSystem>;

inline std::string_view view(const MienStringView& text) { return {text.data, text.count}; }
inline MienStringView view(std::string_view text) { return {text.data(), text.size()}; }
inline Span<const float> view(const MienFloatView& floats) { return {floats.data, floats.count}; }
inline Span<float> view(const MienMutableFloatView& floats) { return {floats.data, floats.count}; }
inline Span<const uint16_t> view(const MienIndex16View& list) { return {list.data, list.count}; }
inline Span<const uint32_t> view(const MienIndex32View& list) { return {list.data, list.count}; }

inline uint32_t version() { return mien_version(); }
inline bool is_available(MienIsa isa) { return mien_isa_available(isa) != 0; }
inline const char* name_of(MienIsa isa) { return mien_isa_name(isa); }

// ---- Errors and results -------------------------------------------------------------------------

/// Why a call failed.
class Error {
 public:
  Error() = default;
  explicit Error(MienStatus status) : status_(status) {}
  Error(MienStatus status, const MienError& detail) : status_(status) {
    if (detail.status == MIEN_OK) return;
    byte_offset_ = detail.byte_offset;
    std::memcpy(message_, detail.message, sizeof(message_));
  }

  MienStatus status() const { return status_; }
  /// "DNA_TRUNCATED"
  const char* name() const { return mien_status_name(status_); }
  /// What, where and what to do; the name of the status if the call says nothing else.
  const char* message() const { return message_[0] ? message_ : name(); }
  /// In the file; MIEN_NO_OFFSET if there is no such place.
  uint64_t byte_offset() const { return byte_offset_; }

 private:
  MienStatus status_ = MIEN_OK;
  uint64_t byte_offset_ = MIEN_NO_OFFSET;
  char message_[sizeof(MienError::message)] = {};
};

#ifdef MIEN_EXCEPTIONS
class Exception : public std::exception {
 public:
  explicit Exception(const Error& error) : error_(error) {}
  const char* what() const noexcept override { return error_.message(); }
  const Error& error() const noexcept { return error_; }

 private:
  Error error_;
};
[[noreturn]] inline void fail(const Error& error) { throw Exception(error); }
#else
[[noreturn]] inline void fail(const Error&) { std::abort(); }
#endif

/// What a call without a result returns that is made every frame: true if it went well.
class [[nodiscard]] Status {
 public:
  Status(MienStatus status) : status_(status) {}  // NOLINT: it is one
  explicit operator bool() const { return status_ == MIEN_OK; }
  operator MienStatus() const = delete;  // it would be false for success
  MienStatus status() const { return status_; }
  const char* name() const { return mien_status_name(status_); }
  Error error() const { return Error(status_); }
  void value() const {
    if (status_ != MIEN_OK) fail(error());
  }

 private:
  MienStatus status_;
};

/// A value, or why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T&& value) : value_(std::move(value)) {}  // NOLINT: a value is a result
  Result(const Error& error) : error_(error) {}    // NOLINT: so is an error
  Result(MienStatus status, T&& value, const MienError* detail = nullptr)
      : value_(std::move(value)), error_(status == MIEN_OK ? Error()
                                         : detail          ? Error(status, *detail)
                                                           : Error(status)) {}

  bool has_value() const { return error_.status() == MIEN_OK; }
  explicit operator bool() const { return has_value(); }
  MienStatus status() const { return error_.status(); }
  const Error& error() const { return error_; }

  /// The value; of a failure, one that is empty or zero.
  T& operator*() & { return value_; }
  const T& operator*() const& { return value_; }
  T&& operator*() && { return std::move(value_); }
  T* operator->() { return &value_; }
  const T* operator->() const { return &value_; }

  /// The value; throws or aborts if there is none.
  const T& value() const& {
    if (!has_value()) fail(error_);
    return value_;
  }
  T value() && {
    if (!has_value()) fail(error_);
    return std::move(value_);
  }
  T value_or(T other) && { return has_value() ? std::move(value_) : std::move(other); }

 private:
  T value_{};
  Error error_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result(MienStatus status, const MienError& detail)
      : error_(status == MIEN_OK ? Error() : Error(status, detail)) {}
  explicit operator bool() const { return error_.status() == MIEN_OK; }
  MienStatus status() const { return error_.status(); }
  const Error& error() const { return error_; }
  void value() const {
    if (!*this) fail(error_);
  }

 private:
  Error error_;
};

/// The system of an engine or tool, for DnaDesc::system: "unreal", "unity", "blender", ...
inline Result<CoordinateSystem> coordinate_system(std::string_view name) {
  CoordinateSystem system;
  const MienStatus status = mien_coordinate_system_find_n(name.data(), name.size(), &system);
  return {status, std::move(system)};
}
/// The names, from index 0 on; MIEN_ERROR_INDEX past the last.
inline Result<std::string_view> coordinate_system_name(uint32_t index) {
  MienStringView name = {nullptr, 0};
  const MienStatus status = mien_coordinate_system_name(index, &name);
  return {status, view(name)};
}

// ---- Owners -------------------------------------------------------------------------------------

/// A handle and the duty to release it.
template <class Handle, void (*release_handle)(Handle*)>
class Owner {
 public:
  Owner() = default;
  explicit Owner(Handle* handle) : handle_(handle) {}
  Owner(Owner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) reset(std::exchange(other.handle_, nullptr));
    return *this;
  }
  ~Owner() { release_handle(handle_); }

  Handle* get() const { return handle_; }
  explicit operator bool() const { return handle_ != nullptr; }
  /// Gives up the duty.
  Handle* release() { return std::exchange(handle_, nullptr); }
  void reset(Handle* handle = nullptr) { release_handle(std::exchange(handle_, handle)); }

  using handle_type = Handle;

 private:
  Handle* handle_ = nullptr;
};

/// The handles of neighboring owners: an owner is its handle and nothing else.
template <class Object>
typename Object::handle_type* const* handles_of(Span<Object> objects) {
  static_assert(std::is_standard_layout<Object>::value &&
                    sizeof(Object) == sizeof(typename Object::handle_type*),
                "an owner is one pointer");
  return reinterpret_cast<typename Object::handle_type* const*>(objects.data());
}

/// Calls `create(&handle, &error)` and wraps the result.
template <class Object, class Create>
Result<Object> make(Create&& create) {
  typename Object::handle_type* handle = nullptr;
  Sized<MienError> error;
  const MienStatus status = create(&handle, &error);
  return {status, Object(handle), &error};
}

/// A checked, read-only view of a DNA file. May be used by several threads at once.
class Dna : public Owner<MienDna, mien_dna_close> {
 public:
  using Owner::Owner;

  static Result<Dna> open(const char* path, const DnaDesc& desc = {}) {
    return make<Dna>([&](MienDna** out, MienError* error) {
      return mien_dna_open_file(path, &desc, out, error);
    });
  }
  /// `bytes` have to outlive the Dna, unchanged.
  static Result<Dna> open(const void* bytes, size_t size, const DnaDesc& desc = {}) {
    return make<Dna>([&](MienDna** out, MienError* error) {
      return mien_dna_open_memory(bytes, size, &desc, out, error);
    });
  }
  /// Reads the header, the index and the chosen layers. `stream` is not needed afterwards.
  static Result<Dna> open(const MienStream& stream, const DnaDesc& desc = {}) {
    return make<Dna>([&](MienDna** out, MienError* error) {
      return mien_dna_open_stream(&stream, &desc, out, error);
    });
  }

  Result<MienDnaInfo> info() const {
    Sized<MienDnaInfo> info;
    return {mien_dna_info(get(), &info), std::move(info)};
  }
  Result<MienDnaLayer> layer(uint32_t index) const {
    Sized<MienDnaLayer> layer;
    return {mien_dna_layer(get(), index, &layer), std::move(layer)};
  }

  /// What is at a path such as "bhvr.joints.jointGroups[7].values".
  Result<MienDnaField> field(const char* path) const {
    Sized<MienDnaField> field;
    Sized<MienError> error;
    return {mien_dna_field(get(), path, &field, &error), std::move(field), &error};
  }
  Result<std::string_view> field_name(const char* path, uint32_t index) const {
    MienStringView name;
    Sized<MienError> error;
    const MienStatus status = mien_dna_child_name(get(), path, index, &name, &error);
    return {status, view(name), &error};
  }
  Result<std::string_view> string(const char* path) const {
    MienStringView text;
    Sized<MienError> error;
    const MienStatus status = mien_dna_read_string(get(), path, &text, &error);
    return {status, view(text), &error};
  }
  /// Fills `out` with the elements from `first` on.
  Result<void> read(const char* path, uint64_t first, Span<float> out) const {
    Sized<MienError> error;
    return {mien_dna_read_floats(get(), path, first, out.size(), out.data(), &error), error};
  }
  Result<void> read(const char* path, uint64_t first, Span<int64_t> out) const {
    Sized<MienError> error;
    return {mien_dna_read_integers(get(), path, first, out.size(), out.data(), &error), error};
  }

  Result<void> write(const char* path, const WriteDesc& desc = {}) const {
    Sized<MienError> error;
    return {mien_dna_write_file(get(), path, &desc, &error), error};
  }
  /// Writes to memory and tells how many bytes that took; with an empty buffer, would take.
  Result<size_t> write(Span<unsigned char> buffer, const WriteDesc& desc = {}) const {
    size_t size = 0;
    Sized<MienError> error;
    void* const data = buffer.empty() ? nullptr : buffer.data();
    const MienStatus status =
        mien_dna_write_memory(get(), &desc, data, buffer.size(), &size, &error);
    return {status, std::move(size), &error};
  }
};

/// All findings of a file.
class Report : public Owner<MienReport, mien_report_destroy> {
 public:
  using Owner::Owner;

  static Result<Report> of(const char* path, const ValidateDesc& desc = {}) {
    return make<Report>([&](MienReport** out, MienError* error) {
      return mien_dna_validate_file(path, &desc, out, error);
    });
  }
  static Result<Report> of(const void* bytes, size_t size, const ValidateDesc& desc = {}) {
    return make<Report>([&](MienReport** out, MienError* error) {
      return mien_dna_validate_memory(bytes, size, &desc, out, error);
    });
  }

  uint32_t error_count() const { return counts().first; }
  uint32_t warning_count() const { return counts().second; }
  /// In the order of the checks: 0 ... errors + warnings - 1.
  Result<MienFinding> finding(uint32_t index) const {
    Sized<MienFinding> finding;
    return {mien_report_finding(get(), index, &finding), std::move(finding)};
  }

 private:
  std::pair<uint32_t, uint32_t> counts() const {
    std::pair<uint32_t, uint32_t> found(0, 0);
    if (mien_report_counts(get(), &found.first, &found.second) != MIEN_OK) return {0, 0};
    return found;
  }
};

/// One character. For one thread at a time.
class Instance : public Owner<MienInstance, mien_instance_destroy> {
 public:
  using Owner::Owner;

  /// Inputs, to be written in place. The spans stay the same until the instance goes.
  Span<float> gui_controls() { return span(mien_instance_gui_controls); }
  Span<float> raw_controls() { return span(mien_instance_raw_controls); }
  Span<float> ml_masks() { return span(mien_instance_ml_masks); }

  /// Outputs of the last evaluation, as mien.h describes them. The spans stay the same.
  Span<const float> controls() const { return span(mien_instance_controls); }
  Span<const float> psd_controls() const { return span(mien_instance_psd_controls); }
  Span<const float> ml_controls() const { return span(mien_instance_ml_controls); }
  Span<const float> rbf_controls() const { return span(mien_instance_rbf_controls); }
  Span<const float> joints() const { return span(mien_instance_joints); }
  Span<const float> blend_shapes() const { return span(mien_instance_blend_shapes); }
  Span<const float> animated_maps() const { return span(mien_instance_animated_maps); }

  Status reset_values() { return mien_instance_reset(get()); }

 private:
  Span<float> span(MienStatus (*call)(MienInstance*, MienMutableFloatView*)) {
    MienMutableFloatView found = {nullptr, 0};
    return call(get(), &found) == MIEN_OK ? view(found) : Span<float>();
  }
  Span<const float> span(MienStatus (*call)(const MienInstance*, MienFloatView*)) const {
    MienFloatView found = {nullptr, 0};
    return call(get(), &found) == MIEN_OK ? view(found) : Span<const float>();
  }
};

/// Room for evaluating many instances at once. For one thread at a time.
class Batch : public Owner<MienBatch, mien_batch_destroy> {
 public:
  using Owner::Owner;
};

/// A DNA packed for evaluation. Immutable: may be used by several threads at once.
class Rig : public Owner<MienRig, mien_rig_destroy> {
 public:
  using Owner::Owner;

  /// The Dna may be closed afterwards.
  static Result<Rig> create(const Dna& dna, const RigDesc& desc = {}) {
    return make<Rig>([&](MienRig** out, MienError* error) {
      return mien_rig_create(dna.get(), &desc, out, error);
    });
  }

  /// A character in its initial state. May outlive the rig, but is evaluated by it only.
  Result<Instance> instance(const InstanceDesc& desc = {}) const {
    return make<Instance>([&](MienInstance** out, MienError* error) {
      return mien_instance_create(get(), &desc, out, error);
    });
  }

  Result<MienRigInfo> info() const {
    Sized<MienRigInfo> info;
    return {mien_rig_info(get(), &info), std::move(info)};
  }

  /// How many things of a kind there are; 0 of an empty rig.
  uint32_t count(MienKind kind) const {
    uint32_t count = 0;
    return mien_rig_count(get(), kind, &count) == MIEN_OK ? count : 0;
  }
  Result<std::string_view> name(MienKind kind, uint32_t index) const {
    MienStringView name;
    const MienStatus status = mien_rig_name(get(), kind, index, &name);
    return {status, view(name)};
  }
  Result<uint32_t> find(MienKind kind, std::string_view name) const {
    uint32_t index = 0;
    const MienStatus status = mien_rig_find_n(get(), kind, name.data(), name.size(), &index);
    return {status, std::move(index)};
  }
  /// What a name of another tool means on this rig.
  struct Match {
    MienNameMatch how = MIEN_NAME_MATCH_NONE;
    size_t count = 0;
    MienControlShare shares[MIEN_MOST_SHARES] = {};
  };
  Result<Match> match(std::string_view name) const {
    Match match;
    uint32_t how = 0;
    const MienStatus status = mien_rig_match(get(), name.data(), name.size(), match.shares,
                                             MIEN_MOST_SHARES, &match.count, &how);
    match.how = static_cast<MienNameMatch>(how);
    return {status, std::move(match)};
  }

  Result<Span<const uint16_t>> lod_indices(MienKind kind, uint32_t lod) const {
    MienIndex16View found;
    const MienStatus status = mien_rig_lod_indices(get(), kind, lod, &found);
    return {status, view(found)};
  }
  Result<Span<const uint16_t>> variable_joint_values(uint32_t lod) const {
    MienIndex16View found;
    const MienStatus status = mien_rig_variable_joint_values(get(), lod, &found);
    return {status, view(found)};
  }
  Result<Span<const uint16_t>> psd_inputs(uint32_t psd) const {
    MienIndex16View found;
    const MienStatus status = mien_rig_psd_inputs(get(), psd, &found);
    return {status, view(found)};
  }
  Span<const uint16_t> joint_parents() const {
    MienIndex16View found;
    return mien_rig_joint_parents(get(), &found) == MIEN_OK ? view(found) : view(MienIndex16View{});
  }
  Span<const float> neutral_joint_values() const {
    MienFloatView found;
    const MienStatus status = mien_rig_neutral_joint_values(get(), &found);
    return status == MIEN_OK ? view(found) : view(MienFloatView{});
  }
  Span<const float> initial_raw_controls() const {
    MienFloatView found;
    const MienStatus status = mien_rig_initial_raw_controls(get(), &found);
    return status == MIEN_OK ? view(found) : view(MienFloatView{});
  }

  Status map_gui_to_raw(Instance& instance) const {
    return mien_rig_map_gui_to_raw(get(), instance.get());
  }
  Status map_raw_to_gui(Instance& instance) const {
    return mien_rig_map_raw_to_gui(get(), instance.get());
  }
  Status evaluate(Instance& instance, uint32_t lod = 0) const {
    return mien_rig_evaluate(get(), instance.get(), lod);
  }
  /// `stages`: MIEN_STAGE_..., combined with |.
  Status evaluate_stages(Instance& instance, uint32_t lod, uint32_t stages) const {
    return mien_rig_evaluate_stages(get(), instance.get(), lod, stages);
  }
  Result<Batch> batch(const BatchDesc& desc = {}) const {
    return make<Batch>([&](MienBatch** out, MienError* error) {
      return mien_batch_create(get(), &desc, out, error);
    });
  }
  Result<uint64_t> batch_bytes(const BatchDesc& desc = {}) const {
    uint64_t bytes = 0;
    const MienStatus status = mien_batch_bytes(get(), &desc, &bytes);
    return {status, std::move(bytes)};
  }
  /// Different instances of this rig, each at its own LOD: as many LODs as instances.
  Status evaluate_batch(Batch& batch, Span<Instance> instances, Span<const uint32_t> lods,
                        uint32_t stages = MIEN_STAGE_ALL,
                        const MienParallelFor* parallel = nullptr) const {
    if (lods.size() != instances.size() || instances.size() > UINT32_MAX) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
    return mien_rig_evaluate_batch(get(), batch.get(), handles_of(instances), lods.data(),
                                   static_cast<uint32_t>(instances.size()), stages, parallel);
  }
  Status evaluate_joint_group(Instance& instance, uint32_t lod, uint32_t group) const {
    return mien_rig_evaluate_joint_group(get(), instance.get(), lod, group);
  }
  Status evaluate_rbf_solver(Instance& instance, uint32_t lod, uint32_t solver) const {
    return mien_rig_evaluate_rbf_solver(get(), instance.get(), lod, solver);
  }
  Status evaluate_twist_swing(Instance& instance, uint32_t lod, uint32_t setup) const {
    return mien_rig_evaluate_twist_swing(get(), instance.get(), lod, setup);
  }
};

/// One character's joint matrices, positions and normals. For one thread at a time.
class DeformerInstance : public Owner<MienDeformerInstance, mien_deformer_instance_destroy> {
 public:
  using Owner::Owner;

  Status update(const Instance& instance) {
    return mien_deformer_instance_update(get(), instance.get());
  }
  /// The layouts of Instance::joints() and blend_shapes(); empty: no deltas, all 0.
  Status update(Span<const float> joint_values, Span<const float> channel_weights) {
    return mien_deformer_instance_update_from_values(get(), joint_values.data(),
                                                     joint_values.size(), channel_weights.data(),
                                                     channel_weights.size());
  }
  Status deform(uint32_t mesh, MienNormals normals = MIEN_NORMALS_DEFAULT,
                const MienParallelFor* parallel = nullptr) {
    return mien_deformer_instance_deform(get(), mesh, normals, parallel);
  }

  /// Deforms the mesh, then writes its vertices to memory of yours.
  Status write_vertices(uint32_t mesh, const VertexOutput& output,
                        MienNormals normals = MIEN_NORMALS_DEFAULT,
                        const MienParallelFor* parallel = nullptr) {
    return mien_deformer_instance_write_vertices(get(), mesh, normals, &output, parallel);
  }

  /// x y z per position, x y z per vertex; empty for a mesh without memory. The spans stay the same.
  Span<const float> positions(uint32_t mesh) const {
    return span(mien_deformer_instance_positions, mesh);
  }
  Span<const float> normals(uint32_t mesh) const {
    return span(mien_deformer_instance_normals, mesh);
  }
  /// 16 floats per joint, column by column.
  Span<const float> joint_matrices() const { return span(mien_deformer_instance_joint_matrices); }
  Span<const float> skin_matrices() const { return span(mien_deformer_instance_skin_matrices); }
  /// Fills 10 floats per joint: tx ty tz qx qy qz qw sx sy sz.
  Status local_transforms(Span<float> out) const {
    return mien_deformer_instance_local_transforms(get(), out.data(), out.size());
  }

 private:
  template <class Call, class... Mesh>
  Span<const float> span(Call call, Mesh... mesh) const {
    MienFloatView found = {nullptr, 0};
    return call(get(), mesh..., &found) == MIEN_OK ? view(found) : Span<const float>();
  }
};

/// One mesh of several instances of a deformer.
inline Status deform_batch(Span<DeformerInstance> instances, uint32_t mesh,
                           MienNormals normals = MIEN_NORMALS_DEFAULT,
                           const MienParallelFor* parallel = nullptr) {
  return mien_deformer_instance_deform_batch(handles_of(instances), instances.size(), mesh, normals,
                                             parallel);
}

/// The same, and the vertices of instance i go to outputs[i].
inline Status write_vertices_batch(Span<DeformerInstance> instances, uint32_t mesh,
                                   Span<const VertexOutput> outputs,
                                   MienNormals normals = MIEN_NORMALS_DEFAULT,
                                   const MienParallelFor* parallel = nullptr) {
  if (outputs.size() != instances.size()) return MIEN_ERROR_INVALID_ARGUMENT;
  return mien_deformer_instance_write_vertices_batch(handles_of(instances), instances.size(), mesh,
                                                     normals, outputs.data(), parallel);
}

/// Geometry and joint hierarchy of a DNA. Immutable: may be used by several threads at once.
class Deformer : public Owner<MienDeformer, mien_deformer_destroy> {
 public:
  using Owner::Owner;

  /// Both may go afterwards.
  static Result<Deformer> create(const Dna& dna, const Rig& rig, const DeformerDesc& desc = {}) {
    return make<Deformer>([&](MienDeformer** out, MienError* error) {
      return mien_deformer_create(dna.get(), rig.get(), &desc, out, error);
    });
  }

  /// Of some positions of one mesh, ascending. This one may go.
  Result<Deformer> subset(uint32_t mesh, Span<const uint32_t> positions) const {
    return make<Deformer>([&](MienDeformer** out, MienError* error) {
      return mien_deformer_create_subset(get(), mesh, positions.data(), positions.size(), nullptr,
                                         out, error);
    });
  }
  /// A pose in neutral. May outlive the deformer.
  Result<DeformerInstance> instance(const DeformerInstanceDesc& desc = {}) const {
    return make<DeformerInstance>([&](MienDeformerInstance** out, MienError* error) {
      return mien_deformer_instance_create(get(), &desc, out, error);
    });
  }

  Result<MienDeformerInfo> info() const {
    Sized<MienDeformerInfo> info;
    return {mien_deformer_info(get(), &info), std::move(info)};
  }
  /// The neutral mesh; view() makes spans of its arrays.
  Result<MienMesh> mesh(uint32_t mesh) const {
    Sized<MienMesh> found;
    return {mien_deformer_mesh(get(), mesh, &found), std::move(found)};
  }
  struct Influences {
    Span<const uint16_t> joints;
    Span<const float> weights;
  };
  Result<Influences> influences(uint32_t mesh, uint32_t position) const {
    MienIndex16View joints = {nullptr, 0};
    MienFloatView weights = {nullptr, 0};
    const MienStatus status = mien_deformer_influences(get(), mesh, position, &joints, &weights);
    return {status, Influences{view(joints), view(weights)}};
  }
  /// Fills three vertices for each triangle of the mesh, with any storage.
  Status triangles(uint32_t mesh, Span<uint32_t> out) const {
    return mien_deformer_triangles(get(), mesh, out.data(), out.size());
  }
  /// Fills u v for each vertex of the mesh, with any storage.
  Status texture_coordinates(uint32_t mesh, Span<float> out) const {
    return mien_deformer_texture_coordinates(get(), mesh, out.data(), out.size());
  }
  /// Fills x y z for each position of the mesh.
  Status target(uint32_t mesh, uint32_t target, Span<float> out) const {
    return mien_deformer_target(get(), mesh, target, out.data(), out.size());
  }
  /// 16 floats per joint, column by column.
  Span<const float> bind_matrices() const { return span(mien_deformer_bind_matrices); }
  Span<const float> inverse_bind_matrices() const {
    return span(mien_deformer_inverse_bind_matrices);
  }

 private:
  Span<const float> span(MienStatus (*call)(const MienDeformer*, MienFloatView*)) const {
    MienFloatView found = {nullptr, 0};
    return call(get(), &found) == MIEN_OK ? view(found) : Span<const float>();
  }
};

/// A file that bake() or `mien bake` wrote: a rig, and its deformer if it has one, as they are in
/// memory. What is made of it keeps the file open. May be used by several threads at once.
class Baked : public Owner<MienBaked, mien_baked_close> {
 public:
  using Owner::Owner;

  static Result<Baked> open(const char* path, const BakedDesc& desc = {}) {
    return make<Baked>([&](MienBaked** out, MienError* error) {
      return mien_baked_open_file(path, &desc, out, error);
    });
  }
  /// `bytes` have to outlive the Baked and all that is made of it, unchanged.
  static Result<Baked> open(const void* bytes, size_t size, const BakedDesc& desc = {}) {
    return make<Baked>([&](MienBaked** out, MienError* error) {
      return mien_baked_open_memory(bytes, size, &desc, out, error);
    });
  }
  /// Reads all of `stream`, which is not needed afterwards.
  static Result<Baked> open(const MienStream& stream, const BakedDesc& desc = {}) {
    return make<Baked>([&](MienBaked** out, MienError* error) {
      return mien_baked_open_stream(&stream, &desc, out, error);
    });
  }

  Result<MienBakedInfo> info() const {
    Sized<MienBakedInfo> info;
    return {mien_baked_info(get(), &info), std::move(info)};
  }
  Result<Rig> rig(const BakedRigDesc& desc = {}) const {
    return make<Rig>([&](MienRig** out, MienError* error) {
      return mien_rig_from_baked(get(), &desc, out, error);
    });
  }
  /// `rig` is one that rig() made.
  Result<Deformer> deformer(const Rig& rig, const BakedDeformerDesc& desc = {}) const {
    return make<Deformer>([&](MienDeformer** out, MienError* error) {
      return mien_deformer_from_baked(get(), rig.get(), &desc, out, error);
    });
  }
};

/// Writes a baked file; without a deformer, the rig alone.
inline Result<void> bake(const char* path, const Rig& rig, const Deformer& deformer = Deformer()) {
  Sized<MienError> error;
  return {mien_bake_file(rig.get(), deformer.get(), path, &error), error};
}
/// The same to memory. Tells how many bytes that took; with an empty buffer, would take.
inline Result<size_t> bake(Span<unsigned char> buffer, const Rig& rig,
                           const Deformer& deformer = Deformer()) {
  size_t size = 0;
  Sized<MienError> error;
  void* const data = buffer.empty() ? nullptr : buffer.data();
  const MienStatus status =
      mien_bake_memory(rig.get(), deformer.get(), data, buffer.size(), &size, &error);
  return {status, std::move(size), &error};
}

// ---- Clips --------------------------------------------------------------------------------------

/// One character's playing of a clip, which it keeps alive. For one thread at a time.
class ClipPlayer : public Owner<MienClipPlayer, mien_clip_player_destroy> {
 public:
  using Owner::Owner;

  Result<MienClipPlayerInfo> info() const {
    Sized<MienClipPlayerInfo> info;
    return {mien_clip_player_info(get(), &info), std::move(info)};
  }
  /// Times are in ticks, of which a second has MIEN_TICKS_PER_SECOND.
  Status seek(int64_t tick) { return mien_clip_player_seek(get(), tick); }
  Status advance(int64_t ticks) { return mien_clip_player_advance(get(), ticks); }
  Status set_speed(int32_t numerator, int32_t denominator = 1) {
    return mien_clip_player_set_speed(get(), numerator, denominator);
  }
  /// Whether the last advance passed another event, which is written to `event`.
  bool next_event(MienClipEvent& event) {
    uint32_t found = 0;
    return mien_clip_player_next_event(get(), &event, &found) == MIEN_OK && found != 0;
  }
  /// Values of all channels at the position. The span stays the same.
  Span<const float> sample() {
    MienFloatView values = {nullptr, 0};
    return mien_clip_player_sample(get(), &values) == MIEN_OK ? view(values) : Span<const float>();
  }
};

/// Which channel of a clip drives which raw control of a rig. Immutable.
class ClipBinding : public Owner<MienClipBinding, mien_clip_binding_destroy> {
 public:
  using Owner::Owner;

  Result<MienClipBindingInfo> info() const {
    Sized<MienClipBindingInfo> info;
    return {mien_clip_binding_info(get(), &info), std::move(info)};
  }
  /// Writes the raw controls that are driven, and no others.
  Status apply(Span<const float> values, Span<float> raw_controls) const {
    return mien_clip_binding_apply(get(), values.data(), values.size(), raw_controls.data(),
                                   raw_controls.size());
  }
  /// For ClipDesc::snaps: steps of which half moves nothing by more than `tolerance` millimeters.
  Result<void> snaps(const Deformer& deformer, float tolerance, Span<float> out) const {
    Sized<MienError> error;
    return {
        mien_clip_binding_snaps(get(), deformer.get(), tolerance, out.data(), out.size(), &error),
        error};
  }
};

/// Control curves at a constant rate. Immutable: may be used by several threads at once.
class Clip : public Owner<MienClip, mien_clip_close> {
 public:
  using Owner::Owner;

  static Result<Clip> build(const ClipDesc& desc) {
    return make<Clip>(
        [&](MienClip** out, MienError* error) { return mien_clip_build(&desc, out, error); });
  }
  static Result<Clip> open(const char* path, const ClipOpenDesc& desc = {}) {
    return make<Clip>([&](MienClip** out, MienError* error) {
      return mien_clip_open_file(path, &desc, out, error);
    });
  }
  /// `bytes` have to outlive the Clip and its players, unchanged.
  static Result<Clip> open(const void* bytes, size_t size, const ClipOpenDesc& desc = {}) {
    return make<Clip>([&](MienClip** out, MienError* error) {
      return mien_clip_open_memory(bytes, size, &desc, out, error);
    });
  }
  /// Reads all of `stream`, which is not needed afterwards.
  static Result<Clip> open(const MienStream& stream, const ClipOpenDesc& desc = {}) {
    return make<Clip>([&](MienClip** out, MienError* error) {
      return mien_clip_open_stream(&stream, &desc, out, error);
    });
  }

  Result<MienClipInfo> info() const {
    Sized<MienClipInfo> info;
    return {mien_clip_info(get(), &info), std::move(info)};
  }
  Result<MienClipChannel> channel(uint32_t index) const {
    Sized<MienClipChannel> channel;
    return {mien_clip_channel(get(), index, &channel), std::move(channel)};
  }
  Result<uint32_t> find_channel(std::string_view name) const {
    uint32_t index = 0;
    const MienStatus status = mien_clip_find_channel_n(get(), name.data(), name.size(), &index);
    return {status, std::move(index)};
  }
  Result<MienClipEvent> event(uint32_t index) const {
    MienClipEvent event;
    const MienStatus status = mien_clip_event(get(), index, &event);
    return {status, std::move(event)};
  }
  /// Whether the bytes are those that were written.
  Result<void> verify() const {
    Sized<MienError> error;
    return {mien_clip_verify(get(), &error), error};
  }
  /// Fills `out`, which has room for the frames, row after row.
  Result<void> read(uint32_t first_frame, uint32_t frame_count, Span<float> out) const {
    Sized<MienClipInfo> info;
    Sized<MienError> error;
    if (mien_clip_info(get(), &info) == MIEN_OK &&
        out.size() / (info.channel_count ? info.channel_count : 1) < frame_count) {
      return {MIEN_ERROR_INVALID_ARGUMENT, error};
    }
    return {mien_clip_read(get(), first_frame, frame_count, out.data(), 0, &error), error};
  }

  Result<void> write(const char* path) const {
    Sized<MienError> error;
    return {mien_clip_write_file(get(), path, &error), error};
  }
  /// Writes to memory and tells how many bytes that took; with an empty buffer, would take.
  Result<size_t> write(Span<unsigned char> buffer) const {
    size_t size = 0;
    Sized<MienError> error;
    void* const data = buffer.empty() ? nullptr : buffer.data();
    const MienStatus status = mien_clip_write_memory(get(), data, buffer.size(), &size, &error);
    return {status, std::move(size), &error};
  }

  Result<ClipPlayer> player(const ClipPlayerDesc& desc = {}) const {
    return make<ClipPlayer>([&](MienClipPlayer** out, MienError* error) {
      return mien_clip_player_create(get(), &desc, out, error);
    });
  }
  Result<ClipBinding> bind(const Rig& rig, const ClipBindingDesc& desc = {}) const {
    return make<ClipBinding>([&](MienClipBinding** out, MienError* error) {
      return mien_clip_binding_create(get(), rig.get(), &desc, out, error);
    });
  }
};

/// For ClipBindingDesc::matrix of clips with the names of ARKit. Writes as many entries as there is room
/// for, and tells how many there are.
inline Result<size_t> arkit_matrix(Span<MienMatrixEntry> out) {
  size_t count = 0;
  const MienStatus status = mien_arkit_matrix(out.data(), out.size(), &count);
  return {status, std::move(count)};
}

/// The usual name of a control, "mouthSmileLeft" for "AU12_L". Writes as many bytes as there is room for, and tells how
/// many there are.
inline Result<size_t> control_name(std::string_view name, Span<char> out) {
  size_t count = 0;
  const MienStatus status =
      mien_control_name(name.data(), name.size(), out.data(), out.size(), &count);
  return {status, std::move(count)};
}

// ---- Mixing -------------------------------------------------------------------------------------

/// One character in a mix. Clips and bindings that it plays have to outlive their playback. For one
/// thread at a time; push() may be called by another one.
class Mixer : public Owner<MienMixer, mien_mixer_destroy> {
 public:
  using Owner::Owner;

  Result<void> play(uint32_t layer, const Clip& clip, const ClipBinding& binding,
                    const PlayDesc& desc = {}) {
    Sized<MienError> error;
    return {mien_mixer_play(get(), layer, clip.get(), binding.get(), &desc, &error), error};
  }
  Status stop(uint32_t layer, int64_t fade_ticks = 0) {
    return mien_mixer_stop(get(), layer, fade_ticks);
  }
  Status set_weight(uint32_t layer, float weight, int64_t fade_ticks = 0) {
    return mien_mixer_set_weight(get(), layer, weight, fade_ticks);
  }
  Status set_pose_weight(uint32_t layer, uint32_t pose, float weight, int64_t fade_ticks = 0) {
    return mien_mixer_set_pose_weight(get(), layer, pose, weight, fade_ticks);
  }
  Status set_variable(uint32_t variable, float value) {
    return mien_mixer_set_variable(get(), variable, value);
  }
  Status set_guard(uint32_t guard, float activation) {
    return mien_mixer_set_guard(get(), guard, activation);
  }
  /// Negative ticks: until end_stimulus().
  Status trigger(uint32_t reaction, float strength, int64_t hold_ticks) {
    return mien_mixer_trigger(get(), reaction, strength, hold_ticks);
  }
  Status end_stimulus(uint32_t reaction) { return mien_mixer_release(get(), reaction); }
  Status set_level(uint32_t reaction, float level) {
    return mien_mixer_set_level(get(), reaction, level);
  }
  /// Whether the row was accepted: it was not late and there was room.
  Result<bool> push(uint32_t layer, int64_t tick, Span<const float> values) {
    uint32_t accepted = 0;
    const MienStatus status =
        mien_mixer_push(get(), layer, tick, values.data(), values.size(), &accepted);
    return {status, accepted != 0};
  }
  Status step(int64_t ticks) { return mien_mixer_step(get(), ticks, nullptr); }
  Status step(int64_t ticks, Instance& instance) {
    return mien_mixer_step(get(), ticks, instance.get());
  }
  /// Several at once; `instances` is empty or has one for each mixer.
  static Status step(Span<MienMixer* const> mixers, Span<MienInstance* const> instances,
                     int64_t ticks) {
    if (!instances.empty() && instances.size() != mixers.size()) return MIEN_ERROR_INVALID_ARGUMENT;
    return mien_mixer_step_batch(mixers.data(), instances.empty() ? nullptr : instances.data(),
                                 mixers.size(), ticks);
  }

  /// Raw controls, then pose variables, as the last step left them. The span stays the same.
  Span<const float> row() const {
    MienFloatView row = {nullptr, 0};
    return mien_mixer_row(get(), &row) == MIEN_OK ? view(row) : Span<const float>();
  }
  /// The row after a stage; empty without MixerDesc.stages.
  Span<const float> stage(uint32_t stage) const {
    MienFloatView row = {nullptr, 0};
    return mien_mixer_stage(get(), stage, &row) == MIEN_OK ? view(row) : Span<const float>();
  }
  /// What a guard did in the last step.
  Result<MienGuardState> guard(uint32_t guard) const {
    Sized<MienGuardState> state;
    return {mien_mixer_guard(get(), guard, &state), std::move(state)};
  }
  Result<MienMixerInfo> info() const {
    Sized<MienMixerInfo> info;
    return {mien_mixer_info(get(), &info), std::move(info)};
  }
  /// An event of the last step; `layer` gets the number of its layer.
  Result<MienClipEvent> event(uint32_t index, uint32_t& layer) const {
    MienClipEvent event;
    const MienStatus status = mien_mixer_event(get(), index, &event, &layer);
    return {status, std::move(event)};
  }
  /// Writes a snapshot and tells how many bytes that took; with an empty buffer, would take.
  Result<size_t> snapshot(Span<unsigned char> buffer) {
    size_t size = 0;
    Sized<MienError> error;
    void* const data = buffer.empty() ? nullptr : buffer.data();
    const MienStatus status = mien_mixer_snapshot(get(), data, buffer.size(), &size, &error);
    return {status, std::move(size), &error};
  }
  Result<void> restore(Span<const unsigned char> bytes, Span<const MienMixerClip> clips) {
    Sized<MienError> error;
    return {
        mien_mixer_restore(get(), bytes.data(), bytes.size(), clips.data(), clips.size(), &error),
        error};
  }
};

/// What is mixed for one rig, and how. Immutable: may be used by several threads at once.
class Mix : public Owner<MienMix, mien_mix_destroy> {
 public:
  using Owner::Owner;

  static Result<Mix> create(const Rig& rig, const MixDesc& desc) {
    return make<Mix>([&](MienMix** out, MienError* error) {
      return mien_mix_create(rig.get(), &desc, out, error);
    });
  }
  /// Without a rig: to look into it, or to write it again.
  static Result<Mix> open(const char* path, const Rig* rig, const MixOpenDesc& desc = {}) {
    return make<Mix>([&](MienMix** out, MienError* error) {
      return mien_mix_open_file(path, rig ? rig->get() : nullptr, &desc, out, error);
    });
  }
  static Result<Mix> open(Span<const unsigned char> bytes, const Rig* rig,
                          const MixOpenDesc& desc = {}) {
    return make<Mix>([&](MienMix** out, MienError* error) {
      return mien_mix_open_memory(bytes.data(), bytes.size(), rig ? rig->get() : nullptr, &desc,
                                  out, error);
    });
  }
  Result<void> write(const char* path) const {
    Sized<MienError> error;
    return {mien_mix_write_file(get(), path, &error), error};
  }
  /// Writes to memory and tells how many bytes that took; with an empty buffer, would take.
  Result<size_t> write(Span<unsigned char> buffer) const {
    size_t size = 0;
    Sized<MienError> error;
    void* const data = buffer.empty() ? nullptr : buffer.data();
    const MienStatus status = mien_mix_write_memory(get(), data, buffer.size(), &size, &error);
    return {status, std::move(size), &error};
  }
  /// The same as text.
  Result<size_t> write_text(Span<char> buffer) const {
    size_t size = 0;
    Sized<MienError> error;
    void* const data = buffer.empty() ? nullptr : buffer.data();
    const MienStatus status = mien_mix_write_text(get(), data, buffer.size(), &size, &error);
    return {status, std::move(size), &error};
  }

  Result<MienMixInfo> info() const {
    Sized<MienMixInfo> info;
    return {mien_mix_info(get(), &info), std::move(info)};
  }
  /// A guard, as it was measured.
  Result<MienMixGuardInfo> guard(uint32_t guard) const {
    Sized<MienMixGuardInfo> found;
    return {mien_mix_guard(get(), guard, &found), std::move(found)};
  }
  /// A response to a light in the eyes: fills 5 strokes, which the reaction refers to.
  static Result<MienMixReaction> glare(uint32_t first_pose, Span<MienMixStroke> strokes) {
    MienMixReaction reaction = {};
    const MienStatus status = mien_mix_glare(first_pose, strokes.data(), strokes.size(), &reaction);
    return {status, std::move(reaction)};
  }
  /// May outlive the mix.
  Result<Mixer> mixer(const MixerDesc& desc = {}) const {
    return make<Mixer>([&](MienMixer** out, MienError* error) {
      return mien_mixer_create(get(), &desc, out, error);
    });
  }

  /// Writes as many pairs as there is room for; how many there are.
  static Result<size_t> antagonists(const Rig& rig, Span<MienMixAntagonists> out) {
    size_t count = 0;
    const MienStatus status = mien_mix_antagonists(rig.get(), out.data(), out.size(), &count);
    return {status, std::move(count)};
  }
  /// For MixDesc::mirror.
  static Result<void> mirror(const Deformer& deformer, Span<uint16_t> out) {
    Sized<MienError> error;
    const MienStatus status = mien_mix_mirror(deformer.get(), out.data(), out.size(), &error);
    return {status, error};
  }
  /// For MienMixLayer::mask.
  static Result<void> mask(const Rig& rig, Span<const uint32_t> groups, float otherwise,
                           Span<float> out) {
    Sized<MienError> error;
    const MienStatus status = mien_mix_mask(rig.get(), groups.data(), groups.size(), otherwise,
                                            out.data(), out.size(), &error);
    return {status, error};
  }
};

class Gaze : public Owner<MienGaze, mien_gaze_destroy> {
 public:
  using Owner::Owner;

  /// The deformer may be destroyed afterwards.
  static Result<Gaze> create(const Deformer& deformer, const GazeDesc& desc = {}) {
    return make<Gaze>([&](MienGaze** out, MienError* error) {
      return mien_gaze_create(deformer.get(), &desc, out, error);
    });
  }
  Result<MienGazeInfo> info() const {
    Sized<MienGazeInfo> info;
    return {mien_gaze_info(get(), &info), std::move(info)};
  }
  Status look_at(const MienGazeTarget& target, Span<float> row,
                 MienGazeRest* rest = nullptr) const {
    return mien_gaze_look_at(get(), &target, row.data(), row.size(), rest);
  }
};

// ---- Solvers ------------------------------------------------------------------------------------

/// What the solvers of one character remember. For one thread at a time.
class SolverState : public Owner<MienSolverState, mien_solver_state_destroy> {
 public:
  using Owner::Owner;

  /// After DeformerInstance::update(), before deform().
  Status step(DeformerInstance& instance, int64_t ticks, const MienSolverInput& input = {}) {
    return mien_solver_state_step(get(), instance.get(), &input, ticks);
  }
  /// Row of a mixer; empty: none.
  Status step(DeformerInstance& instance, int64_t ticks, Span<const float> row, uint32_t lod = 0) {
    return step(instance, ticks, MienSolverInput{row.data(), row.size(), lod, 0});
  }

  /// What a solver has published in the last step.
  Span<const float> outputs(uint32_t solver) const {
    MienFloatView found = {nullptr, 0};
    return mien_solver_state_outputs(get(), solver, &found) == MIEN_OK ? view(found)
                                                                       : Span<const float>();
  }
  /// After the last step, 10 floats per joint: tx ty tz qx qy qz qw sx sy sz.
  Span<const float> transforms() const {
    MienFloatView found = {nullptr, 0};
    return mien_solver_state_transforms(get(), &found) == MIEN_OK ? view(found)
                                                                  : Span<const float>();
  }
  /// With SolverStackDesc::check_writes: the solver that changed a joint which is not in its list.
  Result<std::string_view> undeclared() const {
    MienStringView name = {nullptr, 0};
    const MienStatus status = mien_solver_state_undeclared(get(), &name);
    return {status, view(name)};
  }
};

/// Steps states of one stack; `inputs` is empty or has one for each.
inline Status step_batch(Span<SolverState> states, Span<DeformerInstance> instances,
                         Span<const MienSolverInput> inputs, int64_t ticks) {
  if (instances.size() != states.size() || (!inputs.empty() && inputs.size() != states.size())) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  return mien_solver_state_step_batch(handles_of(states), handles_of(instances),
                                      inputs.empty() ? nullptr : inputs.data(), states.size(),
                                      ticks);
}

/// Solvers of one deformer, which move joints after the rig has posed them. Immutable: may be used by
/// several threads at once.
class SolverStack : public Owner<MienSolverStack, mien_solver_stack_destroy> {
 public:
  using Owner::Owner;

  /// May outlive the deformer.
  static Result<SolverStack> create(const Deformer& deformer, const SolverStackDesc& desc) {
    return make<SolverStack>([&](MienSolverStack** out, MienError* error) {
      return mien_solver_stack_create(deformer.get(), &desc, out, error);
    });
  }
  Result<MienSolverStackInfo> info() const {
    Sized<MienSolverStackInfo> info;
    return {mien_solver_stack_info(get(), &info), std::move(info)};
  }
  /// May outlive the stack.
  Result<SolverState> state(const SolverStateDesc& desc = {}) const {
    return make<SolverState>([&](MienSolverState** out, MienError* error) {
      return mien_solver_state_create(get(), &desc, out, error);
    });
  }
};

// ---- Experimental -------------------------------------------------------------------------------

#ifdef MIEN_EXPERIMENTAL
/// What one evaluation of the rig at a LOD works through.
inline Result<MienRigStatistics> statistics(const Rig& rig, uint32_t lod) {
  Sized<MienRigStatistics> statistics;
  return {mien_rig_statistics(rig.get(), lod, &statistics), std::move(statistics)};
}
/// What the joint stage reads for the controls as they are.
inline Result<MienInstanceStatistics> statistics(const Instance& instance) {
  Sized<MienInstanceStatistics> statistics;
  return {mien_instance_statistics(instance.get(), &statistics), std::move(statistics)};
}
#endif

}  // namespace MIEN_CPP_NAMESPACE
}  // namespace mien
