#include "tools/app/dead_retries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <string>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/plan/plan_graph.h"
#include "runtime/enumerate/dead_steps.h"

namespace parallax::tools {

void report_dead_retries(const compiler::Compilation& compilation, Context& context) {
  if (!compilation.plan) return;
  std::vector<std::vector<std::size_t>> earlier;
  bool repeats = false;
  for (const auto& attempts : compiler::earlier_attempts(*compilation.plan)) {
    earlier.emplace_back();
    for (const auto attempt : attempts) earlier.back().push_back(attempt.index());
    repeats = repeats || !attempts.empty();
  }
  if (!repeats) return;
  runtime::SolverSession session(compilation.model, runtime::make_cadical_solver(&context.stop()));
  // One warning for a perform and event, in the order of the text.
  std::map<std::pair<std::uint32_t, std::string>, std::pair<base::SourceRange, int>> found;
  for (const auto step : runtime::dead_steps(session, earlier)) {
    const auto& dead = compilation.model.plan[step];
    auto& entry = found.try_emplace({dead.source.begin, dead.event}, dead.source, 0).first->second;
    ++entry.second;
  }
  for (const auto& [key, entry] : found) {
    context.sink().warning(codes::kDeadRetry, entry.first, key.second, entry.second);
  }
}

void report_dead_handlers(const compiler::Compilation& compilation, Context& context) {
  if (!compilation.plan || compilation.plan->handlers.empty()) return;
  runtime::SolverSession session(compilation.model, runtime::make_cadical_solver(&context.stop()));
  for (const auto& handler : compilation.plan->handlers) {
    if (handler.otherwise) continue;
    std::vector<std::size_t> steps;
    for (const auto location : handler.failures) steps.push_back(location.index());
    if (!steps.empty() && runtime::can_fail(session, steps)) continue;
    context.sink().warning(codes::kDeadHandler, handler.source,
                           fmt::format("{}", fmt::join(handler.failure_classes, "`, `")),
                           steps.empty() ? "" : " in the model");
  }
}

}  // namespace parallax::tools
