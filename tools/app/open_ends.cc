#include "tools/app/open_ends.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace parallax::tools {

std::string place_text(const compiler::TextPlace& place) {
  if (place.file.empty()) return {};
  return fmt::format("{}:{}:{}", place.file, place.begin.line, place.begin.column);
}

std::vector<std::string> open_end_texts(const compiler::CompiledModel& model,
                                        const runtime::OpenEnds& ends) {
  std::vector<std::string> out;
  for (const auto number : ends.cuts) {
    const auto& cut = model.plan_cuts[number];
    out.push_back(fmt::format("bound reached: `{}` at {}", cut.form, place_text(cut.place)));
  }
  if (ends.step) {
    const auto& step = model.plan[*ends.step];
    out.push_back(fmt::format("the plan goes on beyond timepoint {} with {} at {}", model.horizon,
                              step.event, place_text(step.place)));
  }
  return out;
}

std::string bounds_field(const std::vector<std::string>& bounds) {
  if (bounds.empty()) return {};
  return fmt::format("\"bounds\":{},", nlohmann::json(bounds).dump());
}

}  // namespace parallax::tools
