#include "tools/app/preferred_traces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "compiler/base/codes/files.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/json.h"
#include "compiler/base/suggest.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;

constexpr std::size_t kMostChoices = 1'000;

/// The names in `Ab(A,B), Stuck`, without blanks.
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ' ') continue;
    if (c == ',' && depth == 0) {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

/// Does the model declare it? What no formula mentions has no atom.
bool is_known(const std::string& name, const compiler::Compilation& compilation) {
  const auto is_it = [&](const std::string& ground) { return base::is_instance(ground, name); };
  const auto& model = compilation.model;
  for (const auto* list : {&model.fluents, &model.events}) {
    for (const auto& one : *list) {
      if (is_it(one.name)) return true;
    }
  }
  for (const auto& atom : model.fixed) {
    if (atom.kind == AtomKind::kPredicate && is_it(atom.name)) return true;
  }
  if (!compilation.typed) return false;
  const auto& typed = *compilation.typed;
  const auto symbol = typed.find_symbol(base::symbol_of(name));
  if (!symbol) return false;
  // The calculus' own predicates have other atoms than their names say.
  for (const auto& own : {typed.core.happens, typed.core.holds_at, typed.core.released_at,
                          typed.core.initiates, typed.core.terminates, typed.core.releases,
                          typed.core.trajectory, typed.core.anti_trajectory}) {
    if (own == symbol) return false;
  }
  const auto kind = typed.symbols[*symbol].kind;
  const bool is_empty =
      (kind == compiler::SymbolKind::kFluent || kind == compiler::SymbolKind::kEvent) &&
      base::symbol_of(name) == name;  // over a sort without elements
  return is_empty || kind == compiler::SymbolKind::kPredicate;
}

base::Reported no_such_atom(const std::string& name, const compiler::Compilation& compilation,
                            Context& context) {
  std::vector<std::string> names;
  if (compilation.typed) {
    for (const auto& symbol : compilation.typed->symbols) {
      if (symbol.kind != compiler::SymbolKind::kFunction) names.push_back(symbol.name);
    }
  }
  auto error = context.sink().error_about(
      codes::kUsage, "--prefer",
      fmt::format("the model has no fluent, event or predicate `{}`", name));
  if (const auto near = base::nearest_name(name, names)) error.fix(*near);
  return error;
}

std::string printed_atom(const compiler::AtomRef& atom) {
  return atom.time ? fmt::format("{} at {}", atom.name, *atom.time) : atom.name;
}

}  // namespace

std::optional<PreferredTraces> PreferredTraces::of(const std::vector<std::string>& levels,
                                                   const compiler::Compilation& compilation,
                                                   Context& context) {
  const auto& model = compilation.model;
  if (model.has_constraints) {
    context.sink().error_about(codes::kUsage, "--prefer",
                               "compares traces of one length: no plan, scenario or --until");
    return std::nullopt;
  }
  PreferredTraces out;
  std::map<std::int32_t, std::string> texts;
  // Predicates have no order among the variables.
  using Entry = std::tuple<compiler::Timepoint, std::string, std::int32_t>;
  for (const auto& level : levels) {
    std::vector<Entry> entries;
    const auto names = names_in(level);
    for (const auto& name : names) {
      if (is_known(name, compilation)) continue;
      (void)no_such_atom(name, compilation, context);
      return std::nullopt;
    }
    model.for_each_atom([&](const compiler::AtomRef& atom) {
      if (atom.kind != AtomKind::kHoldsAt && atom.kind != AtomKind::kHappens &&
          atom.kind != AtomKind::kPredicate) {
        return;
      }
      for (const auto& name : names) {
        if (!base::is_instance(atom.name, name)) continue;
        if (texts.emplace(atom.variable, printed_atom(atom)).second) {
          entries.emplace_back(atom.time.value_or(0), atom.name, atom.variable);
        }
      }
    });
    std::sort(entries.begin(), entries.end());
    auto& literals = out.levels_.emplace_back();
    for (const auto& entry : entries) {
      literals.push_back(runtime::Literal::positive(std::get<2>(entry)));
    }
  }
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()),
                                 runtime::Loading::kWitness);
  out.choices_ = runtime::minimal_choices(session, out.levels_, kMostChoices);
  if (!out.choices_.complete) {
    context.sink().error_about(
        codes::kLimitReached, "--prefer",
        context.stopped() ? "on time" : fmt::format("of {} minimal sets", kMostChoices));
    return std::nullopt;
  }
  for (const auto& choice : out.choices_.choices) {
    auto& set = out.sets_.emplace_back();
    for (const auto& level : choice) {
      for (const auto literal : level) set.push_back(texts.at(literal.var()));
    }
  }
  std::sort(out.sets_.begin(), out.sets_.end());
  return out;
}

std::string PreferredTraces::text() const {
  constexpr std::size_t kMostLines = 10;
  std::string out;
  for (std::size_t i = 0; i < sets_.size() && i < kMostLines; ++i) {
    out += fmt::format("minimal: {}\n",
                       sets_[i].empty() ? "nothing" : fmt::format("{}", fmt::join(sets_[i], ", ")));
  }
  if (sets_.size() > kMostLines) out += fmt::format("and {} more\n", sets_.size() - kMostLines);
  return out;
}

std::string PreferredTraces::fields() const {
  return fmt::format("\"minimal_sets\":{},", base::json_text(nlohmann::json(sets_)));
}

}  // namespace parallax::tools
