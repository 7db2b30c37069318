#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/base/ground_name.h"
#include "harness/config/scenario.h"
#include "tools/page/gather.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostSourceBytes = 64'000, kMostSourcesBytes = 400'000;

void add_regions(const harness::Scenario& scenario, PageData& page) {
  using harness::RegionAxis;
  if (!scenario.mapping) return;
  for (const auto& region : scenario.mapping->regions().regions()) {
    PageRegion out;
    out.name = region.name;
    out.moves = !region.frame.empty();
    const double dx = out.moves ? region.frame_start[0] : 0.0;
    const double dy = out.moves ? region.frame_start[1] : 0.0;
    if (const auto& x = region.on(RegionAxis::kX)) out.x = {x->lower + dx, x->upper + dx};
    if (const auto& y = region.on(RegionAxis::kY)) out.y = {y->lower + dy, y->upper + dy};
    for (const auto axis : {RegionAxis::kBottom, RegionAxis::kZ}) {
      const double dz = out.moves ? region.frame_start[2] : 0.0;
      if (const auto& z = region.on(axis)) out.z = {z->lower + dz, z->upper + dz};
    }
    out.frame = region.frame;
    out.frame_start = region.frame_start;
    if (out.x || out.y) page.regions.push_back(std::move(out));
  }
}

/// Bodies that stand still, as rectangles seen from above.
void add_furniture(const harness::Scenario& scenario, PageData& page) {
  for (const auto& body : scenario.world.bodies) {
    if (body.mass_kg > 0.0) continue;
    const double c = std::cos(body.yaw_rad), s = std::sin(body.yaw_rad);
    for (const auto& shape : body.shapes) {
      const double px = body.p_WB.x() + c * shape.p_BS.x() - s * shape.p_BS.y();
      const double py = body.p_WB.y() + s * shape.p_BS.x() + c * shape.p_BS.y();
      const double yaw = body.yaw_rad + shape.yaw_rad;
      const double cx = 0.5 * shape.size_m.x(), cy = 0.5 * shape.size_m.y();
      auto& corners = page.furniture.emplace_back();
      const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (std::size_t i = 0; i < 4; ++i) {
        const double u = signs[i][0] * cx, v = signs[i][1] * cy;
        corners[i] = {px + std::cos(yaw) * u - std::sin(yaw) * v,
                      py + std::sin(yaw) * u + std::cos(yaw) * v};
      }
    }
  }
}

void add_sources(const base::SourceFiles& files, PageData& page) {
  std::size_t bytes = 0;
  std::set<std::string> known;
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    const auto& file = files[base::FileId(i)];
    const bool is_shown = file.name().ends_with(".lisp") || file.name().ends_with(".e") ||
                          file.name().ends_with(".bind");
    if (!is_shown || !known.insert(file.name()).second) continue;
    if (file.text().size() > kMostSourceBytes || bytes > kMostSourcesBytes) continue;
    bytes += file.text().size();
    page.sources.push_back({file.name(), std::string(file.text())});
  }
}

/// "Go" of "Go(r2)".
bool speaks_of(const std::string& text, const std::string& symbol) {
  for (auto at = text.find(symbol + '('); at != std::string::npos;
       at = text.find(symbol + '(', at + 1)) {
    const bool begins =
        at == 0 || std::string_view("(, &|!{[>-.").find(text[at - 1]) != std::string_view::npos;
    if (begins) return true;
  }
  return false;
}

void add_axioms(const compiler::CompiledModel& model, PageData& page) {
  std::set<std::string> symbols;
  for (const auto& trace : page.traces) {
    for (const auto& step : trace.steps) symbols.insert(base::symbol_of(step.event));
  }
  for (const auto& timeline : page.timelines) {
    for (const auto& step : timeline.steps) symbols.insert(base::symbol_of(step.event));
  }
  for (const auto& symbol : symbols) {
    std::vector<PagePlace> places;
    std::set<std::string> seen;
    for (const auto& origin : model.origins) {
      const bool is_axiom = origin.kind == compiler::OriginKind::kAxiom ||
                            origin.kind == compiler::OriginKind::kEffectAxiom ||
                            origin.kind == compiler::OriginKind::kTrajectoryAxiom;
      if (!is_axiom || origin.place.file.empty() || !speaks_of(origin.text, symbol)) continue;
      auto place = origin.place.file + ':' + std::to_string(origin.place.begin.line);
      if (seen.insert(place + origin.text).second) places.push_back({place, origin.text});
    }
    if (!places.empty()) page.axioms.emplace_back(symbol, std::move(places));
  }
}

}  // namespace

void add_world(const ScenarioModel& loaded, const base::SourceFiles& files, PageData& page) {
  add_regions(loaded.scenario, page);
  add_furniture(loaded.scenario, page);
  add_sources(files, page);
  add_axioms(loaded.compilation.model, page);
}

}  // namespace parallax::tools
