// SPDX-License-Identifier: MIT
// A DNA file as typed, read-only views of its layers.
//
//     DnaView
//       version, index            what the container said, in file order
//       desc dsce defn bhvr ...   the layers; empty if not loaded
//
// A view is plain data. Its arrays point into the file, or into the arena if they were created or
// changed. Its lists are in the arena. The caller of read_dna() owns both.
#pragma once

#include "runtime/load/dna/format/dna_schema.h"

namespace mien::dna {

/// Layers to load. The numbers are those of MIEN_LAYER_... in mien.h.
enum LayerMask : uint32_t {
  kLayerDescriptor = 1,
  kLayerDefinition = 2,
  kLayerBehavior = 4,
  kLayerGeometry = 8,
  kLayerMachineLearned = 16,
  kLayerRbf = 32,
  kLayerJointMetadata = 64,
  kLayerTwistSwing = 128,
  kLayersAll = 255,
};

/// The known layers, in the order in which a writer appends those that an index lacks.
enum class LayerId : uint8_t {
  kDesc,
  kDefn,
  kBhvr,
  kGeom,
  kMlbh,
  kRbfb,
  kRbfe,
  kJbmd,
  kTwsw,
  kMlbe,
  kDsce
};
constexpr size_t kLayerIdCount = 11;

constexpr uint32_t layer_code(const char (&text)[5]) {
  return uint32_t(uint8_t(text[0])) << 24 | uint32_t(uint8_t(text[1])) << 16 |
         uint32_t(uint8_t(text[2])) << 8 | uint8_t(text[3]);
}

struct LayerKind {
  LayerId id;
  const char* name;        // also the first part of a field's path
  uint32_t code;           // four letters
  uint32_t layer_version;  // major << 16 | minor
  uint16_t since;          // first file version that has it
  uint32_t loaded_by;      // any of these bits loads it
};

constexpr LayerKind kLayerKinds[kLayerIdCount] = {
    {LayerId::kDesc, "desc", layer_code("desc"), 0x10001, 1, kLayerDescriptor},
    {LayerId::kDefn, "defn", layer_code("defn"), 0x10001, 1, kLayerDefinition},
    {LayerId::kBhvr, "bhvr", layer_code("bhvr"), 0x10001, 1, kLayerBehavior},
    {LayerId::kGeom, "geom", layer_code("geom"), 0x10001, 1, kLayerGeometry},
    {LayerId::kMlbh, "mlbh", layer_code("mlbh"), 0x10000, 3, kLayerMachineLearned},
    {LayerId::kRbfb, "rbfb", layer_code("rbfb"), 0x10000, 4, kLayerRbf},
    {LayerId::kRbfe, "rbfe", layer_code("rbfe"), 0x10000, 5, kLayerRbf},
    {LayerId::kJbmd, "jbmd", layer_code("jbmd"), 0x10000, 4, kLayerJointMetadata},
    {LayerId::kTwsw, "twsw", layer_code("twsw"), 0x10000, 4, kLayerTwistSwing},
    {LayerId::kMlbe, "mlbe", layer_code("mlbe"), 0x10000, 6, kLayerMachineLearned},
    {LayerId::kDsce, "dsce", layer_code("dsce"), 0x10000, 7, kLayerDescriptor},
};

/// The known layer of this code and layer version; null for others.
const LayerKind* find_layer_kind(uint32_t code, uint32_t layer_version);

/// `layers` and everything that they need; 0 means all.
uint32_t close_layer_mask(uint32_t layers);

/// True if `version` (2.version) has the faceWindingOrder byte in its dsce layer.
constexpr bool version_has_face_winding(uint16_t version) { return version < 1 || version > 7; }

struct IndexEntry {
  uint32_t code = 0;
  uint32_t layer_version = 0;
  const uint8_t* data = nullptr;  // its bytes; null if a stream was not asked for them. Unknown
                                  // layers are written from here.
  uint32_t size = 0;
  uint32_t offset = 0;  // in the file
};

/// Memory in the arena that has an offset in the file: a part that was read from a stream, or an array
/// that was converted.
struct FileSegment {
  const uint8_t* data = nullptr;
  uint64_t offset = 0;
  size_t size = 0;
  const FileSegment* next = nullptr;
};

struct DnaView {
  uint16_t generation = 2;
  uint16_t version = 8;
  uint32_t loaded = 0;                     // LayerMask
  bool lacks_blend_shape_targets = false;  // the geometry was loaded without them

  /// File order. The sections of a 2.1 file are listed as desc, defn, bhvr and geom.
  List<IndexEntry> index;

  Descriptor desc;
  DescriptorExtension dsce;
  Definition defn;
  Behavior bhvr;
  Geometry geom;
  MachineLearnedBehavior mlbh;
  MachineLearnedBehaviorExtension mlbe;
  RbfBehavior rbfb;
  RbfBehaviorExtension rbfe;
  JointBehaviorMetadata jbmd;
  TwistSwingBehavior twsw;

  /// Number of ML controls: of mlbh if it is loaded, else read from its first bytes if RBF behavior
  /// is (whose control numbers start behind them).
  uint32_t ml_control_count = 0;

  /// The file, to turn addresses into offsets: whole, or null; and segments. Both are null if the view
  /// was made here.
  const uint8_t* file = nullptr;
  const FileSegment* segments = nullptr;
  size_t file_size = 0;

  bool has(uint32_t layers) const { return (loaded & layers) != 0; }

  /// Byte offset of an address within the file or a segment, else kNoOffset.
  uint64_t offset_of(const void* address) const { return offset_of(address, segments); }
  /// The same with other segments.
  uint64_t offset_of(const void* address, const FileSegment* first) const;

  /// Number of the first PSD, ML and RBF control (docs/dna-format.md, 8.3 "Control numbers"), and
  /// of all controls.
  uint32_t first_psd() const { return defn.raw_control_names.count; }
  uint32_t first_ml() const { return first_psd() + bhvr.controls.psd_count; }
  uint32_t first_rbf() const { return first_ml() + ml_control_count; }
  uint32_t control_count() const { return first_rbf() + rbfe.pose_control_names.count; }
};

/// Calls f(record) with the layer's record; View is DnaView or const DnaView.
template <class View, class F>
decltype(auto) with_layer(View& view, LayerId id, F&& f) {
  switch (id) {
    case LayerId::kDesc: return f(view.desc);
    case LayerId::kDefn: return f(view.defn);
    case LayerId::kBhvr: return f(view.bhvr);
    case LayerId::kGeom: return f(view.geom);
    case LayerId::kMlbh: return f(view.mlbh);
    case LayerId::kRbfb: return f(view.rbfb);
    case LayerId::kRbfe: return f(view.rbfe);
    case LayerId::kJbmd: return f(view.jbmd);
    case LayerId::kTwsw: return f(view.twsw);
    case LayerId::kMlbe: return f(view.mlbe);
    case LayerId::kDsce: break;
  }
  return f(view.dsce);
}

}  // namespace mien::dna
