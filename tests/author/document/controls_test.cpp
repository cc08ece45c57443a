// SPDX-License-Identifier: MIT
// Removing controls: what is left evaluates as it did with the removed ones at 0. And the list of layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "author/base/random.h"
#include "tests/support/bytes.h"
#include "tests/support/documents.h"

namespace mien {
namespace {

using Names = std::vector<std::string>;

MienStatus remove_control(const DocumentHandle& document, uint32_t kind, const std::string& name,
                          MienError* error) {
  uint32_t index = 0;
  const MienStatus found = mien_document_find(document.get(), kind, name.c_str(), &index, error);
  return found != MIEN_OK ? found : mien_document_remove(document.get(), kind, &index, 1, error);
}

/// Names of the PSD controls that a removed control takes with it, by following the products.
std::set<int64_t> products_of(const DocumentHandle& document, int64_t control) {
  const auto rows = integers_of(document, "bhvr.controls.psds.rows");
  const auto columns = integers_of(document, "bhvr.controls.psds.columns");
  std::set<int64_t> gone = {control};
  for (size_t before = 0; before != gone.size();) {
    before = gone.size();
    for (size_t i = 0; i < rows.size(); ++i) {
      if (gone.count(columns[i])) gone.insert(rows[i]);
    }
  }
  gone.erase(control);
  return gone;
}

/// Quaternions and networks sum in another order.
void expect_close(const std::vector<float>& a, const std::vector<float>& b, double tolerance,
                  const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(std::remainder(a[i] - b[i], 360), 0, tolerance) << what << " " << i;
}

// For every raw control in turn: the rig without it against the rig where it is 0.
TEST(RemoveControls, IsAsIfTheyStayedZero) {
  for (const char* name : {"tiny", "small", "ml"}) {
    const Bytes bytes = golden::read_rig(name);
    const DnaHandle whole = open_dna(bytes);
    const RigHandle rig = create_rig(whole.get());
    const DocumentHandle document = document_of(bytes);
    const Names controls = strings_of(document, "defn.rawControlNames");
    const bool has_quaternions = field_of(document, "jbmd.jointRepresentations").count != 0;
    const bool has_networks = field_of(document, "mlbh.neuralNetworks").count != 0;
    const double tolerance = has_quaternions ? 1e-2 : has_networks ? 1e-5 : 0;
    size_t removed = 0;
    for (size_t c = 0; c < controls.size(); c += 1 + controls.size() / 12) {
      SCOPED_TRACE(std::string(name) + " without " + controls[c]);
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      const auto products = products_of(document, static_cast<int64_t>(c));
      const int64_t psds = integers_of(document, "bhvr.controls.psdCount")[0];
      const size_t solvers = field_of(document, "rbfb.solvers").count;
      MienError error = sized<MienError>();
      ASSERT_EQ(remove_control(document, MIEN_KIND_RAW_CONTROL, controls[c], &error), MIEN_OK)
          << error.message;
      Names left = controls;
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(c));
      EXPECT_EQ(strings_of(document, "defn.rawControlNames"), left);
      EXPECT_EQ(integers_of(document, "bhvr.controls.psdCount")[0],
                psds - static_cast<int64_t>(products.size()));
      // Joints that a solver moves stay where they are without it.
      if (field_of(document, "rbfb.solvers").count != solvers) continue;
      ++removed;
      const DnaHandle less = dna_of(document);
      const RigHandle smaller = create_rig(less.get());
      Character before(rig), after(smaller);
      Random random(c, 3);
      for (int frame = 0; frame < 3; ++frame) {
        for (size_t i = 0; i < left.size(); ++i) {
          const float value = static_cast<float>(random.below(1024)) / 1024;
          before.raw[i + (i >= c)] = after.raw[i] = value;
        }
        before.raw[c] = 0;
        before.evaluate(0);
        after.evaluate(0);
        const auto floats = [](const auto& span) {
          return std::vector<float>(span.begin(), span.end());
        };
        expect_close(floats(before.joints), floats(after.joints), tolerance, "joints");
        expect_close(floats(before.channels), floats(after.channels), tolerance, "channels");
      }
    }
    EXPECT_GT(removed, 3u) << name;
    ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(document), bytes);
  }
}

TEST(RemoveControls, TakesProductsOfPsdControlsAlong) {
  const DocumentHandle document = document_of(golden::read_rig("small"));
  const int64_t raw = static_cast<int64_t>(field_of(document, "defn.rawControlNames").count);
  const int64_t count = integers_of(document, "bhvr.controls.psdCount")[0];
  ASSERT_GT(count, 2);
  const auto products = products_of(document, raw + 1);
  MienError error = sized<MienError>();
  ASSERT_EQ(remove_control(document, MIEN_KIND_PSD_CONTROL, "psd1", &error), MIEN_OK)
      << error.message;
  EXPECT_EQ(integers_of(document, "bhvr.controls.psdCount")[0],
            count - 1 - static_cast<int64_t>(products.size()));
  EXPECT_TRUE(dna_of(document));
  EXPECT_EQ(remove_control(document, MIEN_KIND_PSD_CONTROL, "psd" + std::to_string(count), &error),
            MIEN_ERROR_NAME);
  EXPECT_EQ(remove_control(document, MIEN_KIND_PSD_CONTROL, "psd01", &error), MIEN_ERROR_NAME);
}

TEST(RemoveControls, OfTheGuiLeaveTheOtherSlidersAlone) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle before = document_of(bytes), after = document_of(bytes);
  const Names names = strings_of(before, "defn.guiControlNames");
  ASSERT_GT(names.size(), 2u);
  MienError error = sized<MienError>();
  ASSERT_EQ(remove_control(after, MIEN_KIND_GUI_CONTROL, names[1], &error), MIEN_OK);
  Names left = names;
  left.erase(left.begin() + 1);
  EXPECT_EQ(strings_of(after, "defn.guiControlNames"), left);
  const auto rows = [&](const DocumentHandle& document, const Names& of) {
    std::vector<std::vector<std::string>> found;
    const std::string table = "bhvr.controls.conditionals.";
    const auto inputs = integers_of(document, table + "inputIndices");
    const auto outputs = integers_of(document, table + "outputIndices");
    const auto slopes = floats_of(document, table + "slopeValues");
    for (size_t i = 0; i < inputs.size(); ++i) {
      if (of[static_cast<size_t>(inputs[i])] == names[1]) continue;
      found.push_back({of[static_cast<size_t>(inputs[i])], std::to_string(outputs[i]),
                       std::to_string(slopes[i])});
    }
    return found;
  };
  EXPECT_EQ(rows(after, left), rows(before, names));
  EXPECT_TRUE(dna_of(after));
}

/// Sets the columns of a control to 0 in all joint groups.
void silence(const DocumentHandle& document, int64_t control) {
  for (size_t g = 0; g < field_of(document, "bhvr.joints.jointGroups").count; ++g) {
    const std::string group = "bhvr.joints.jointGroups[" + std::to_string(g) + "]";
    const auto inputs = integers_of(document, group + ".inputIndices");
    auto values = floats_of(document, group + ".values");
    for (size_t i = 0; i < values.size(); ++i) {
      if (inputs[i % inputs.size()] == control) values[i] = 0;
    }
    ASSERT_EQ(write_floats(document, group + ".values", values), MIEN_OK);
  }
}

// What a network or a solver computed for the control is gone; everything else is as with columns of zeros.
TEST(RemoveControls, OfNetworksAndSolversIsAsIfTheyStayedZero) {
  size_t compared = 0;
  for (const char* name : {"tiny", "ml", "small", "body"}) {
    const Bytes bytes = golden::read_rig(name);
    const DocumentHandle without = document_of(bytes), zero = document_of(bytes);
    for (uint32_t kind : {MIEN_KIND_ML_CONTROL, MIEN_KIND_RBF_CONTROL}) {
      const bool ml = kind == MIEN_KIND_ML_CONTROL;
      const Names controls =
          strings_of(without, ml ? "mlbh.mlControlNames" : "rbfe.poseControlNames");
      int64_t first = static_cast<int64_t>(field_of(without, "defn.rawControlNames").count) +
                      integers_of(without, "bhvr.controls.psdCount")[0];
      if (!ml) first += static_cast<int64_t>(field_of(without, "mlbh.mlControlNames").count);
      for (size_t c = 0; c < controls.size(); c += 1 + controls.size() / 4) {
        SCOPED_TRACE(std::string(name) + " without " + controls[c]);
        MienError error = sized<MienError>();
        ASSERT_EQ(remove_control(without, kind, controls[c], &error), MIEN_OK) << error.message;
        Names left = controls;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(c));
        EXPECT_EQ(strings_of(without, ml ? "mlbh.mlControlNames" : "rbfe.poseControlNames"), left);
        const int64_t control = first + static_cast<int64_t>(c);
        silence(zero, control);
        const auto inputs = integers_of(zero, "bhvr.blendShapeChannels.inputIndices"),
                   outputs = integers_of(zero, "bhvr.blendShapeChannels.outputIndices");
        const DnaHandle before_dna = dna_of(zero), after_dna = dna_of(without);
        const RigHandle before_rig = create_rig(before_dna.get()),
                        after_rig = create_rig(after_dna.get());
        ASSERT_TRUE(before_rig && after_rig);
        Character before(before_rig), after(after_rig);
        Random random(c, 5);
        for (int frame = 0; frame < 3; ++frame) {
          for (size_t i = 0; i < before.raw.count; ++i) {
            before.raw[i] = after.raw[i] = static_cast<float>(random.below(1024)) / 1024;
          }
          before.evaluate(0);
          after.evaluate(0);
          const auto floats = [](const auto& span) {
            return std::vector<float>(span.begin(), span.end());
          };
          expect_close(floats(before.joints), floats(after.joints), 1e-2, "joints");
          for (size_t i = 0; i < inputs.size(); ++i) {
            if (inputs[i] == control) continue;
            const auto output = static_cast<size_t>(outputs[i]);
            EXPECT_NEAR(before.channels[output], after.channels[output], 1e-5);
          }
        }
        ++compared;
        ASSERT_EQ(mien_document_undo(without.get(), 0, nullptr), MIEN_OK);
        ASSERT_EQ(mien_document_undo(zero.get(), 0, nullptr), MIEN_OK);
      }
    }
    EXPECT_EQ(bytes_of(without), bytes);
  }
  EXPECT_GT(compared, 12u);
}

TEST(RemoveControls, RefusesWhatTrainedWeightsOrTheVersionNeed) {
  MienError error = sized<MienError>();
  const DocumentHandle old = document_of(golden::read_rig("tiny_v24"));
  const uint32_t first = 0;
  EXPECT_EQ(mien_document_remove(old.get(), MIEN_KIND_RBF_CONTROL, &first, 1, &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(std::string(error.message).find("2.5"), std::string::npos) << error.message;
  // Networks whose operations list controls.
  const Bytes bytes = golden::read_rig("ml_ext");
  const DocumentHandle extended = document_of(bytes);
  bool refused = false;
  const uint32_t count = static_cast<uint32_t>(field_of(extended, "defn.rawControlNames").count);
  for (uint32_t c = 0; c < count && !refused; ++c) {
    const MienStatus status =
        mien_document_remove(extended.get(), MIEN_KIND_RAW_CONTROL, &c, 1, &error);
    refused = status == MIEN_ERROR_INVALID_ARGUMENT;
    if (status == MIEN_OK) {
      ASSERT_EQ(mien_document_undo(extended.get(), 0, nullptr), MIEN_OK);
    }
  }
  EXPECT_TRUE(refused);
  EXPECT_NE(std::string(error.message).find("refers to control"), std::string::npos);
  EXPECT_EQ(bytes_of(extended), bytes);
}

struct ListedLayer {
  std::string code, bytes;
  uint32_t major, minor;
};
std::vector<ListedLayer> layers_of(const DocumentHandle& document, uint32_t* version = nullptr) {
  uint32_t number = 0, count = 0;
  EXPECT_EQ(mien_document_layer_count(document.get(), &number, &count, nullptr), MIEN_OK);
  if (version) *version = number;
  std::vector<ListedLayer> layers;
  for (uint32_t i = 0; i < count; ++i) {
    MienDnaLayer layer = sized<MienDnaLayer>();
    MienStringView bytes = {};
    EXPECT_EQ(mien_document_layer(document.get(), i, &layer, &bytes, nullptr), MIEN_OK);
    layers.push_back({layer.code, std::string(bytes.data ? bytes.data : "", bytes.count),
                      layer.version_major, layer.version_minor});
  }
  return layers;
}

TEST(Layers, CanBeListedAnewInAnyOrder) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle document = document_of(bytes);
  uint32_t version = 0;
  auto layers = layers_of(document, &version);
  ASSERT_GT(layers.size(), 3u);
  std::swap(layers[1], layers[2]);
  layers.insert(layers.begin() + 1, ListedLayer{"note", std::string("a\0b", 3), 3, 4});
  ASSERT_EQ(mien_document_clear_layers(document.get(), version, nullptr), MIEN_OK);
  for (const ListedLayer& layer : layers) {
    ASSERT_EQ(mien_document_add_layer(document.get(), layer.code.c_str(), layer.major, layer.minor,
                                      layer.bytes.data(), layer.bytes.size(), nullptr),
              MIEN_OK);
  }
  const DnaHandle dna = dna_of(document);
  for (uint32_t i = 0; i < layers.size(); ++i) {
    MienDnaLayer found = sized<MienDnaLayer>();
    ASSERT_EQ(mien_dna_layer(dna.get(), i, &found), MIEN_OK);
    EXPECT_EQ(found.code, layers[i].code);
    EXPECT_EQ(found.version_major, layers[i].major);
    EXPECT_EQ(found.version_minor, layers[i].minor);
  }
  const DocumentHandle again = create_document(dna.get());
  EXPECT_EQ(layers_of(again)[1].bytes, std::string("a\0b", 3));
  EXPECT_EQ(bytes_of(again), bytes_of(document));
  ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
  EXPECT_EQ(bytes_of(document), bytes);
}

TEST(Layers, RefusesWhatAFileCannotHave) {
  const DocumentHandle document = document_of(golden::read_rig("small"));
  MienError error = sized<MienError>();
  const auto add = [&](const char* code, uint32_t major, const char* bytes, size_t size) {
    return mien_document_add_layer(document.get(), code, major, 1, bytes, size, &error);
  };
  EXPECT_EQ(add("defn", 1, nullptr, 0), MIEN_ERROR_INVALID_ARGUMENT);  // is there
  EXPECT_EQ(add("defn", 2, "x", 1), MIEN_OK);                          // of a later version
  EXPECT_EQ(add("bhvr", 1, "x", 1), MIEN_ERROR_INVALID_ARGUMENT);      // is known
  EXPECT_EQ(add("long", 65536, nullptr, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(add("longer", 1, nullptr, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(add("note", 1, nullptr, 3), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_document_clear_layers(document.get(), 0, &error), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_document_clear_layers(document.get(), 65536, &error), MIEN_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(mien_document_clear_layers(document.get(), 1, &error), MIEN_OK);
  EXPECT_EQ(add("note", 1, "x", 1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(add("geom", 1, nullptr, 0), MIEN_OK);
  MienDnaLayer layer = sized<MienDnaLayer>();
  MienStringView bytes = {};
  EXPECT_EQ(mien_document_layer(document.get(), 1, &layer, &bytes, &error), MIEN_ERROR_INDEX);
}

}  // namespace
}  // namespace mien
