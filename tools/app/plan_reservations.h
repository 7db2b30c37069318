#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/plan/plan_graph.h"
#include "tools/app/context.h"

namespace parallax::compiler {
struct Compilation;
}

namespace parallax::tools {

/// Why a claim about a plan has no proof although the search found nothing against it: the real
/// plan may have executions that were not explored.
struct PlanReservations {
  bool orders = false;   // of branches, of which only some were explored
  bool meaning = false;  // a form that is taken in another way than the real language may
  bool cut = false;      // a loop or calls that go on beyond their bound

  bool any() const { return orders || meaning || cut; }
  /// `not of every order`, `approximated`, `within the bounds of loops and calls`, or several of
  /// them; empty without any.
  std::string words() const {
    std::string out;
    const auto add = [&](bool is_so, const char* what) {
      if (is_so) out += (out.empty() ? "" : ", ") + std::string(what);
    };
    add(orders, "not of every order");
    add(meaning, "approximated");
    add(cut, "within the bounds of loops and calls");
    return out;
  }
  /// The same with `no proof` at its end.
  std::string verdict() const;
  /// Names of the JSON fields that tell them, each with its value.
  std::vector<std::pair<std::string, bool>> fields() const;
};

/// The first timepoint at which control of the plan can be where unrolling was cut, for all that
/// its graph says. None: it cannot be there within the horizon.
std::optional<compiler::Timepoint> first_cut(const compiler::CompiledModel& model);
/// Can it be there within the horizon?
bool may_be_cut(const compiler::CompiledModel& model);
/// Can it be there before the horizon, so that something up to the horizon is not known?
bool goes_behind_cut(const compiler::CompiledModel& model);

/// The reservations of the plan's gaps; none without a plan. The second form adds
/// `goes_behind_cut`.
PlanReservations reservations_of(const std::optional<compiler::PlanGraph>& plan);
PlanReservations reservations_of(const compiler::Compilation& compilation);

/// One sentence for each gap of the plan: "not explored: the other orders of `par` at
/// plan.lisp:2:3", "approximated: ...".
std::vector<std::string> gap_texts(const std::optional<compiler::PlanGraph>& plan,
                                   const Context& context);
/// The same for gaps and for the places where control can come to a cut: "unrolling was cut: `p` at
/// plan.lisp:2:75".
std::vector<std::string> reservation_texts(const compiler::Compilation& compilation,
                                           const Context& context);

/// Says on standard error at which places the real plan may have other executions than those that
/// are explored, and where unrolling was cut. For answers that carry no proof.
void tell_reservations(const compiler::Compilation& compilation, Context& context);

/// "plan.lisp:3:5"; empty for a place that is not known.
std::string place_text(const compiler::TextPlace& place);

}  // namespace parallax::tools
