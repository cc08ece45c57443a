// SPDX-License-Identifier: MIT
#include "author/document/remove_controls.h"

#include "author/document/check_view.h"
#include "author/document/renumber.h"
#include "runtime/load/dna/format/dna_writer.h"

namespace mien::author {

namespace {

/// A PSD control is a product: it is gone if one of its inputs is.
void mark_products(const dna::PsdTable& psds, const Span<uint8_t>& gone) {
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t i = 0; i < psds.rows.count; ++i) {
      if (psds.columns[i] >= gone.count || !gone[psds.columns[i]] || gone[psds.rows[i]]) continue;
      gone[psds.rows[i]] = 1;
      changed = true;
    }
  }
}

Status check_operations(const dna::DnaView& view, const Span<uint8_t>& gone, Error& error) {
  const auto refuse = [&](const char* what, uint32_t control) {
    return fail(
        error, Status::kInvalidArgument, kNoOffset,
        "%s refers to control %u, which would be removed, and its trained weights need all of "
        "them: keep the control, or open the file without machine-learned behavior",
        what, control);
  };
  for (const dna::MlType& type : view.mlbe.types) {
    for (const auto& set : type.operations) {
      for (const dna::MlOperation& operation : set) {
        if (!lists_controls(operation)) continue;
        for (uint32_t i = 0; i < operation.parameters.count; ++i) {
          const uint32_t control = operation.parameters[i];
          if (control < gone.count && gone[control]) return refuse("an ML operation", control);
        }
      }
    }
  }
  for (const dna::NeuralNetwork& network : view.mlbh.networks) {
    if (network.layers.count != 0 && view.mlbe.types.count == 0) continue;  // loses an output
    for (uint32_t i = 0; i < network.output_indices.count; ++i) {
      const uint32_t control = network.output_indices[i];
      if (control < gone.count && gone[control]) return refuse("the output of a network", control);
    }
  }
  return Status::kOk;
}

}  // namespace

Status remove_controls(Document& document, Kind kind, Span<const uint32_t> indices, Error& error) {
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  uint32_t first = 0;
  switch (kind) {
    case Kind::kPsdControl: first = edit.view.first_psd(); break;
    case Kind::kMlControl: first = edit.view.first_ml(); break;
    case Kind::kRbfControl: first = edit.view.first_rbf(); break;
    default: break;
  }
  const dna::LayerKind& rbfe = dna::kLayerKinds[static_cast<size_t>(dna::LayerId::kRbfe)];
  if (kind == Kind::kRbfControl && !dna::is_written(edit.view, rbfe, {edit.view.version, true})) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "in version 2.%u every RBF pose has a control: write the file in version 2.5 first",
                unsigned{edit.view.version});
  }
  const uint32_t count = kind == Kind::kGuiControl ? edit.view.defn.gui_control_names.count
                                                   : edit.view.control_count();
  const Span<uint8_t> gone = edit.arena().array<uint8_t>(count);
  if (gone.count != count) return no_memory(error, "an edit");
  for (uint32_t index : indices) gone[first + index] = 1;
  bool done = false;
  if (kind == Kind::kGuiControl) {
    Renumbering numbers;
    for (uint8_t& is_gone : gone) is_gone = !is_gone;  // kept
    done = number_kept(gone, edit.arena(), numbers) &&
           renumber_gui_controls(edit.view, numbers, edit.arena());
  } else {
    mark_products(edit.view.bhvr.controls.psds, gone);
    if (Status s = check_operations(edit.view, gone, error); s != Status::kOk) return s;
    done = renumber_controls(edit.view, gone, edit.arena());
  }
  if (!done) return no_memory(error, "an edit");
  if (Status s = check_view(edit.view, error); s != Status::kOk) return s;
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
