// Clauses of axioms, for somebody who points at one. The model is compiled as `compile --stats`
// does it, and the words about all of its texts are made at once: the next question is about
// another axiom of the same model. Linear in the clauses.

#include "tools/lsp/compiled_texts.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <tuple>

#include "compiler/base/words.h"
#include "compiler/pipeline/compile.h"
#include "runtime/explain/clause_text.h"
#include "tools/app/scenario_model.h"
#include "tools/app/timed_stop.h"

namespace parallax::tools::lsp {
namespace {

constexpr std::size_t kShownClauses = 3;  // of a text

using TextKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::string>;

TextKey key_of(const base::SourceRange& source, std::string_view what) {
  return {source.file.index(), source.begin, source.end, std::string(what)};
}

/// The first clauses of each text, as a reader of the model would write them.
std::map<TextKey, std::string> first_clauses(const compiler::CompiledModel& model) {
  const runtime::ClauseText text(model);
  std::map<TextKey, std::pair<std::size_t, std::string>> found;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.clause_is_definition[i]) continue;
    const auto& origin = model.origins[model.clause_origins[i]];
    auto& [count, lines] = found[key_of(origin.source, to_string(origin.kind))];
    if (count++ < kShownClauses) lines += text.clause(i) + "\n";
  }
  std::map<TextKey, std::string> out;
  for (auto& [key, clauses] : found) {
    auto& [count, lines] = clauses;
    if (count > kShownClauses) lines += "...\n";
    out.emplace(key, std::move(lines));
  }
  return out;
}

std::string cost_line(const compiler::AxiomCost& cost) {
  auto line = fmt::format("{}: {}, {}", cost.what,
                          base::counted(static_cast<std::int64_t>(cost.clauses), "clause"),
                          base::counted(static_cast<std::int64_t>(cost.literals), "literal"));
  if (cost.product > 0)
    line += fmt::format("; {} of {} instances grounded", cost.instances, cost.product);
  return line + "\n";
}

}  // namespace

CompiledTexts::CompiledTexts(const std::string& root, const base::OpenTexts& texts, double seconds)
    : seconds_(seconds) {
  const base::ReadOpenTexts reading(texts);
  const std::atomic<bool> no_other{false};
  TimedStop stop(seconds, no_other);
  Context context({}, stop.flag());
  ModelOptions options;
  options.models = {root};
  options.stats = true;
  std::optional<compiler::Compilation> compilation;
  if (auto compiled = compile_models(options, context)) compilation = *std::move(compiled);
  gave_up_ = stop.flag().load();
  if (compilation && !gave_up_) note(*compilation, context);
}

void CompiledTexts::note(const compiler::Compilation& compilation, const Context& context) {
  const auto clauses = first_clauses(compilation.model);
  for (const auto& cost : compilation.costs) {
    const auto& source = cost.source;
    if (source.end == 0) continue;  // asked for by no text
    auto words = cost_line(cost);
    if (const auto found = clauses.find(key_of(source, cost.what)); found != clauses.end())
      words += fmt::format("```\n{}```\n", found->second);
    const std::filesystem::path path(context.files()[source.file].name());
    by_path_[path.lexically_normal().string()].push_back(
        {source.begin, source.end, std::move(words)});
  }
}

std::string CompiledTexts::about(const std::string& path, std::size_t offset) const {
  if (gave_up_)
    return fmt::format("no clauses are shown: compiling takes more than {} s", seconds_);
  const auto found = by_path_.find(path);
  if (found == by_path_.end()) return {};
  const Compiled* shortest = nullptr;
  std::string words;
  for (const auto& text : found->second) {
    if (offset < text.begin || offset > text.end) continue;
    const auto length = text.end - text.begin;
    if (shortest != nullptr && length > shortest->end - shortest->begin) continue;
    const bool same = shortest != nullptr && length == shortest->end - shortest->begin;
    words = same ? words + text.words : text.words;
    shortest = &text;
  }
  return words;
}

}  // namespace parallax::tools::lsp
