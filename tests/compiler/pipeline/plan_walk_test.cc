#include "compiler/plan/plan_walk.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "compiler/pipeline/plan_questions.h"
#include "tests/support/deep.h"
#include "tests/support/interpreter/interpreter.h"
#include "tests/support/interpreter/random_case.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using compiler::BranchId;
using compiler::PlanWalk;
using Strings = std::vector<std::string>;

std::string lower(std::string text) {
  for (auto& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

PlanItem keyword(const std::string& text) {
  PlanItem item;
  item.kind = PlanItem::Kind::kSymbol;
  item.text = text;
  return item;
}

/// The choices of one execution: those given, then the first ones.
class Picks {
 public:
  std::uint64_t pick(std::uint64_t count) {
    if (next_ == chosen_.size()) chosen_.push_back({0, count});
    return chosen_[next_++].first;
  }
  /// Begins the next execution, depth first; false if there is none.
  bool advance() {
    next_ = 0;
    while (!chosen_.empty() && ++chosen_.back().first == chosen_.back().second) chosen_.pop_back();
    return !chosen_.empty();
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint64_t>> chosen_;
  std::size_t next_ = 0;
};

/// Walks through a plan's graph in the discrete world, whose states the questions are asked of.
class Walker final : public compiler::PlanSurroundings {
 public:
  Walker(const PlannedModel& planned, const RuleModel& model, bool with_reason)
      : planned_(planned),
        model_(model),
        world_(model),
        reason_(with_reason ? "busy" : "anything"),
        questions_(planned.graph(), planned.formulas(), planned.typed()) {
    if (questions_.too_large()) throw std::runtime_error("too large");
    // `Kind(t1,k1)`: the predicate that the formulas may mention.
    for (std::size_t i = 0; i < questions_.predicates().size(); ++i) {
      const auto& name = questions_.predicates()[i];
      const auto is = [&](const auto& thing) {
        return name == "Kind(" + thing.first + "," + thing.second + ")";
      };
      questions_.settle(i, std::any_of(model.things.begin(), model.things.end(), is));
    }
  }

  bool holds(BranchId branch, const compiler::RegisterObjects& registers) override {
    if (!questions_.of_guard(branch).one_state) throw std::runtime_error("no question of a state");
    return questions_.holds(branch, registers,
                            [&](std::uint32_t fluent) { return observed(fluent); });
  }
  std::uint64_t choose(std::uint64_t count) override { return picks_.pick(count); }

  Executions all(int horizon) {
    Executions out;
    for (std::size_t start = 0; start < world_.initial_states(); ++start) {
      do {
        world_.reset(start);
        one(horizon, out);
        ++out.runs;
      } while (picks_.advance());
    }
    return out;
  }

 private:
  bool observed(std::uint32_t fluent) const {
    const auto& text = questions_.fluents()[fluent];
    const auto open = text.find('(');
    std::vector<PlanItem> items = {keyword(lower(text.substr(0, open)))};
    const auto argument = text.substr(open + 1, text.size() - open - 2);
    if (!argument.empty()) items.push_back(keyword(argument));
    return world_.holds(items);
  }

  /// Result of the success formula in the current state.
  struct Judged {
    bool success = false;
    Strings found;
  };
  Judged judge(compiler::LocationId id, const PlanWalk& walk) const {
    const auto fluent = [&](std::uint32_t number) { return observed(number); };
    Judged out{questions_.succeeds(id, walk.registers(), fluent), {}};
    if (planned_.graph().locations[id].result) {
      out.found = questions_.found(id, walk.registers(), fluent);
    }
    return out;
  }

  /// The designator that the binding table maps to the event.
  PlanItem designator(const std::string& event) const {
    const auto open = event.find('(');
    const auto argument = event.substr(open + 1, event.size() - open - 2);
    for (const auto& binding : model_.bindings) {
      if (!binding.event.starts_with(event.substr(0, open + 1))) continue;
      PlanItem out;
      out.kind = PlanItem::Kind::kDesignator;
      out.keys.emplace_back("type", keyword(binding.type));
      PlanItem object = keyword(argument);
      if (binding.returns) {
        object = {};
        object.kind = PlanItem::Kind::kDesignator;
        object.keys.emplace_back("type", keyword(argument));
      }
      if (!argument.empty()) out.keys.emplace_back("object", object);
      return out;
    }
    throw std::runtime_error("no binding for " + event);
  }

  void one(int horizon, Executions& out) {
    PlanWalk walk(planned_.graph());
    std::string key;
    for (int time = 0;; ++time) {
      walk.go_on(*this);
      if (const auto* end = walk.end()) {
        if (time == 0 && horizon > 0 && world_.hit()) {
          out.keys.insert(";");
        } else if (end->kind == compiler::TerminalKind::kFailed) {
          out.failures.insert(end->detail);
        } else if (end->kind == compiler::TerminalKind::kBound) {
          out.beyond_horizon = true;
        }
        return;
      }
      if (time == horizon) {
        out.beyond_horizon = true;
        return;
      }
      const auto event = walk.event();
      const auto id = *walk.location();
      const auto& location = planned_.graph().locations[id];
      const bool judged_before = location.success.time_offset == 0;
      auto judged = judged_before ? judge(id, walk) : Judged();
      const auto outcome = world_.perform(designator(event));
      if (!judged_before) judged = judge(id, walk);
      if (judged.success != outcome.success || judged.found != outcome.returns) {
        throw std::runtime_error("judged otherwise: " + event);
      }
      if (outcome.event != event) throw std::runtime_error(outcome.event + " for " + event);
      key += event;
      std::string returned;
      if (outcome.success && !outcome.returns.empty()) {
        const auto count = outcome.returns.size();
        returned = outcome.returns[picks_.pick(count)];
        key += "=" + returned;
      }
      key += ";";
      if (world_.hit()) {
        out.keys.insert(key);
        return;
      }
      if (outcome.success) {
        walk.succeed(returned);
      } else if (walk.fail(reason_) != outcome.failure_class) {
        throw std::runtime_error("another condition");
      }
    }
  }

  const PlannedModel& planned_;
  const RuleModel& model_;
  RuleWorld world_;
  std::string reason_;
  compiler::PlanQuestions questions_;
  Picks picks_;
};

/// The conditions of the table, each by the reason `busy`; what `else` says is another one.
std::string by_reason(const RuleModel& model) {
  std::string out;
  for (std::size_t at = 0; const auto& binding : model.bindings) {
    const auto text = model.binding_text();
    const auto end = text.find('\n', at);
    const auto line = text.substr(at, end - at);
    const auto cut = line.rfind(" else ");
    out += line.substr(0, cut) + " else condition on busy " + binding.failure_class +
           " on idle simple-plan-failure\n";
    at = end + 1;
  }
  return out;
}

TEST_CASE("random plans in random models: walked paths are those of the interpreter") {
  const std::uint64_t cases = is_deep() ? 2000 : 500;
  std::size_t runs = 0;
  std::size_t keys = 0;
  std::size_t failures = 0;
  std::size_t turns = 0;
  int too_large = 0;
  for (std::uint64_t seed = 1; seed <= cases + static_cast<std::uint64_t>(too_large); ++seed) {
    CAPTURE(seed);
    const auto plan_case = random_plan_case(seed);
    const bool with_reason = seed % 2 == 0;
    const auto& model = plan_case.model;
    const PlannedModel planned(model.model_text(), plan_case.plan_text(),
                               with_reason ? by_reason(model) : model.binding_text(),
                               model.constraint_text(), plan_case.horizon, plan_case.by_turns,
                               with_reason);
    if (planned.codes().find("CPL051") != std::string::npos) {
      ++too_large;
      continue;
    }
    if (!planned.compiles()) FAIL(planned.codes() << "\n" << plan_case.plan_text());
    RuleWorld world(model);
    const auto wanted =
        execute_all(plan_case.plan_text(), world, plan_case.horizon, plan_case.by_turns);
    const auto walked = Walker(planned, model, with_reason).all(plan_case.horizon);
    CAPTURE(plan_case.plan_text());
    CAPTURE(model.binding_text());
    REQUIRE(walked.keys == wanted.keys);
    REQUIRE(walked.failures == wanted.failures);
    REQUIRE(walked.beyond_horizon == wanted.beyond_horizon);
    runs += walked.runs;
    keys += walked.keys.size();
    failures += walked.failures.size();
    if (plan_case.by_turns) turns += walked.keys.size();
  }
  // The generator is of use only if much happens.
  CHECK(too_large < 10 + static_cast<int>(cases) / 50);
  CHECK(runs > 5 * cases);
  CHECK(keys > cases / 2);
  CHECK(failures > cases / 4);
  CHECK(turns > cases / 10);
}

}  // namespace
}  // namespace parallax::test
