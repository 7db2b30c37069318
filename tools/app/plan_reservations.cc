#include "tools/app/plan_reservations.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/artifact/atom.h"
#include "compiler/base/shown_text.h"
#include "compiler/pipeline/compile.h"

namespace parallax::tools {

std::string PlanReservations::verdict() const {
  const auto why = words();
  return (why.empty() ? "" : why + ", ") + "no proof";
}

std::vector<std::pair<std::string, bool>> PlanReservations::fields() const {
  std::vector<std::pair<std::string, bool>> out;
  if (orders) out.emplace_back("every_order", false);
  if (meaning) out.emplace_back("approximated", true);
  if (cut) out.emplace_back("cut", true);
  return out;
}

std::optional<compiler::Timepoint> first_cut(const compiler::CompiledModel& model) {
  if (model.plan_cuts.empty()) return std::nullopt;
  std::optional<compiler::Timepoint> first;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const bool is_cut = atom.kind == compiler::AtomKind::kLocation && atom.time &&
                        std::holds_alternative<compiler::PlanCutId>(atom.plan);
    if (is_cut && (!first || *atom.time < *first)) first = *atom.time;
  });
  return first;
}

bool may_be_cut(const compiler::CompiledModel& model) { return first_cut(model).has_value(); }

bool goes_behind_cut(const compiler::CompiledModel& model) {
  const auto first = first_cut(model);
  return first && *first < model.horizon;
}

PlanReservations reservations_of(const std::optional<compiler::PlanGraph>& plan) {
  PlanReservations out;
  if (!plan) return out;
  for (const auto& gap : plan->gaps) {
    (gap.kind == compiler::GapKind::kOrder ? out.orders : out.meaning) = true;
  }
  return out;
}

PlanReservations reservations_of(const compiler::Compilation& compilation) {
  auto out = reservations_of(compilation.plan);
  out.cut = goes_behind_cut(compilation.model);
  return out;
}

std::vector<std::string> gap_texts(const std::optional<compiler::PlanGraph>& plan,
                                   const Context& context) {
  std::vector<std::string> out;
  if (!plan) return out;
  for (const auto& gap : plan->gaps) {
    const bool orders = gap.kind == compiler::GapKind::kOrder;
    out.push_back(fmt::format("{}: {} at {}", orders ? "not explored" : "approximated", gap.text,
                              context.files().place(gap.source)));
  }
  return out;
}

std::vector<std::string> reservation_texts(const compiler::Compilation& compilation,
                                           const Context& context) {
  auto out = gap_texts(compilation.plan, context);
  const auto& model = compilation.model;
  const compiler::AtomIndex index(model);
  for (std::size_t cut = 0; cut < model.plan_cuts.size(); ++cut) {
    const compiler::PlanCutId id(static_cast<std::uint32_t>(cut));
    // Control stays there.
    if (!index.at(id, model.horizon)) continue;
    out.push_back(fmt::format("unrolling was cut: `{}` at {}", model.plan_cuts[cut].form,
                              place_text(model.plan_cuts[cut].place)));
  }
  return out;
}

void tell_reservations(const compiler::Compilation& compilation, Context& context) {
  for (const auto& text : reservation_texts(compilation, context)) context.remark(text);
}

std::string place_text(const compiler::TextPlace& place) {
  if (place.file.empty()) return {};
  return fmt::format("{}:{}:{}", base::printable(place.file), place.begin.line, place.begin.column);
}

}  // namespace parallax::tools
