// SPDX-License-Identifier: Apache-2.0
//
// The zoo behind the adapter header: the argument names the rasterizer, a specimen of mutation/zoo or a right one:
// "exact", "exact-second", "grid-BITS-ROUNDING-CORNER", such as grid-8-nearest-even-top-left, or "right-NUMBER", which
// is right in its own way and says nothing of it (mutation/zoo/right.hpp), or "further-NAME" (mutation/zoo/further.hpp).
// "undeclared-" before a name: it does not say what its model is.
#include <cstdio>
#include <optional>
#include <string>

#include "certify/adapter.h"
#include "certify/rivals/plugin_frame.hpp"
#include "mutation/zoo/further.hpp"
#include "mutation/zoo/names.hpp"
#include "mutation/zoo/right.hpp"
#include "mutation/zoo/zoo.hpp"
#include "oracle/oracle.hpp"

namespace {

using namespace surefill;

struct Instance {
  Status (*render)(const Target& target, zoo::Draws draws) = nullptr;
  std::optional<Grid> grid;  // of a rasterizer that has one model only; and its fill rule
  FillRule fill_rule = FillRule::top_left;
  const zoo::Choices* right = nullptr;  // of one that is right in its own way
  std::string error;
};

std::string open_error;

Status exact(const Target& target, zoo::Draws draws) {
  const Status status = validate(target, draws);
  if (status == Status::ok) oracle::render(target, draws);
  return status;
}

Status exact_second(const Target& target, zoo::Draws draws) {
  const Status status = validate(target, draws);
  if (status == Status::ok) oracle::clipped::render(target, draws);
  return status;
}

int open_adapter(const char* arguments, surefill_adapter_info* info, void** handle) {
  std::string name = arguments;
  const std::string prefix = "undeclared-";
  const bool undeclared = name.rfind(prefix, 0) == 0;
  if (undeclared) name.erase(0, prefix.size());
  Instance instance;
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    if (name == specimen.name) instance.render = specimen.render;
  }
  for (const zoo::FurtherFault& fault : zoo::further_faults()) {
    if (name == std::string("further-") + fault.name) instance.render = fault.render;
  }
  info->features = adapters::kAllFeatures;
  info->model.kind = SUREFILL_ADAPTER_MODEL_EXACT;
  info->model.profile = SUREFILL_ADAPTER_PROFILE_EXACT;
  if (name == adapters::kExactName) instance.render = exact;
  if (name == adapters::kExactSecondName) instance.render = exact_second;
  for (const adapters::GridRasterizer& grid : adapters::grid_rasterizers()) {
    if (name != grid.name) continue;
    instance.render = exact;
    instance.grid =
        Grid{static_cast<int>(grid.model.grid_bits), 0, 0, static_cast<GridRounding>(grid.model.grid_rounding)};
    instance.fill_rule = static_cast<FillRule>(grid.model.fill_rule);
    info->model = grid.model;
    info->features &= ~static_cast<std::uint32_t>(SUREFILL_ADAPTER_GRIDS | SUREFILL_ADAPTER_FILL_RULES);
  }
  for (std::size_t n = 0; n < zoo::right_rasterizers().size(); ++n) {
    if (name != zoo::right_name(n)) continue;
    instance.right = &zoo::right_rasterizers()[n];
    info->features = SUREFILL_ADAPTER_NOPERSPECTIVE | SUREFILL_ADAPTER_FLAT;
    if (zoo::clips_where_asked(*instance.right)) info->features |= SUREFILL_ADAPTER_DEPTH_CLIP;
    info->model = {};
    info->model.profile = SUREFILL_ADAPTER_PROFILE_OPENGL;
  }
  if (!instance.render && !instance.right) {
    open_error = "the zoo has no rasterizer of this name: " + name + " (surefill zoo shows them)";
    return SUREFILL_ADAPTER_FAILED;
  }
  if (undeclared && !instance.right) {
    info->model = {};
    info->model.profile = SUREFILL_ADAPTER_PROFILE_EXACT;
  }
  std::snprintf(info->name, sizeof info->name, "%s", name.c_str());
  std::snprintf(info->version, sizeof info->version, "%s", SUREFILL_VERSION);
  info->outputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                  SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;
  *handle = new Instance(instance);
  return SUREFILL_ADAPTER_OK;
}

int draw(void* handle, const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  auto& instance = *static_cast<Instance*>(handle);
  if (instance.right) {
    instance.error = "vertices farther than 16384 pixels away";
    return zoo::draw_right(*instance.right, *scene, *image) ? SUREFILL_ADAPTER_OK : SUREFILL_ADAPTER_UNSUPPORTED;
  }
  adapters::PluginFrame frame(*scene, *image);
  if (instance.grid) {
    for (Draw& draw : frame.draws()) {
      draw.grid = draw.conservative == Conservative::none ? instance.grid : std::nullopt;
      draw.fill_rule = instance.fill_rule;
    }
  }
  const Status status = instance.render(frame.target(), frame.draws());
  if (status == Status::ok) return SUREFILL_ADAPTER_OK;
  instance.error = status_text(status);
  return SUREFILL_ADAPTER_FAILED;
}

void close_adapter(void* handle) {
  delete static_cast<Instance*>(handle);
}

const char* error_text(void* handle) {
  return handle ? static_cast<Instance*>(handle)->error.c_str() : open_error.c_str();
}

}  // namespace

extern "C" const surefill_adapter_api* surefill_adapter_entry(std::uint32_t version) {
  static constexpr surefill_adapter_api kApi{SUREFILL_ADAPTER_VERSION, open_adapter, draw, close_adapter, error_text};
  return version == SUREFILL_ADAPTER_VERSION ? &kApi : nullptr;
}
