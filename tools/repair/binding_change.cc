#include "tools/repair/binding_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/base/file_io.h"
#include "compiler/base/ground_name.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/repair/edit_grammar.h"

namespace parallax::tools {

std::optional<BoundFailure> bound_failure(const RepairInput& input, const Evidence::Step& step) {
  if (!input.loaded.scenario.bind) return std::nullopt;
  const auto& name = input.loaded.scenario.bind->text;
  base::DiagnosticSink unread;
  base::SourceFiles files;
  auto text = base::read_file(name, unread);
  if (!text) return std::nullopt;
  const auto before = *std::move(text);
  const auto file = files.add(name, before);
  const auto binding = compiler::parse_plan_binding(files, file, unread);
  if (!binding) return std::nullopt;
  const auto symbol = base::symbol_of(step.event);
  const auto entry =
      std::find_if(binding->entries.begin(), binding->entries.end(),
                   [&](const auto& each) { return !each.plan && each.event_symbol == symbol; });
  if (entry == binding->entries.end()) return std::nullopt;
  const auto known = std::find_if(entry->reasons.begin(), entry->reasons.end(),
                                  [&](const auto& each) { return each.reason == step.reason; });
  BoundFailure out;
  const auto told = known == entry->reasons.end() ? entry->failure_class : known->failure_class;
  out.words = fmt::format("`{}` failed for the reason {}; the plan gets `{}` then ({}).",
                          step.event, step.reason, told, files.place(entry->source));
  if (entry->reasons.empty() || known != entry->reasons.end()) return out;
  const auto at = entry->reasons.back().source.end;
  const auto clause = fmt::format(" on {} {}", step.reason, entry->failure_class);
  out.words = fmt::format(
      "`{}` failed for the reason {}, to which the binding table has no condition ({}): it gets "
      "`{}`.",
      step.event, step.reason, files.place(entry->source), clause.substr(1));
  out.file = ChangedFile{files[file].name(), before,
                         compiler::changed_text(before, file, {{file, at, at, clause}})};
  return out;
}

}  // namespace parallax::tools
