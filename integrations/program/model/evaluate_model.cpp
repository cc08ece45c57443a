// SPDX-License-Identifier: MIT
#include "integrations/program/model/evaluate_model.h"

#include <algorithm>

#include "integrations/program/model/ml_model.h"
#include "integrations/program/model/rbf_model.h"

namespace mien::model {

std::vector<double> evaluate_controls(const LayerRig& rig, const std::vector<float>& raw,
                                      uint32_t lod, double noise) {
  std::vector<double> controls = initial_controls(rig);
  std::copy(raw.begin(), raw.end(), controls.begin());
  model_ml(rig, lod, std::vector<double>(rig.regions.size(), 1.0), false, controls);
  if (rig.rbf_count != 0) model_rbf(rig, lod, controls, {noise});
  model_psds(rig.base, controls);
  return controls;
}

}  // namespace mien::model
