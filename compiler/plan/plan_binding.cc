#include "compiler/plan/plan_binding.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/binding_parser.h"

namespace parallax::compiler {

using base::DiagnosticCode;
using base::SourceRange;

namespace {

bool same_keys(const BindingEntry& a, const BindingEntry& b) {
  std::set<std::string> left;
  std::set<std::string> right;
  for (const auto& key : a.keys) left.insert(key.key);
  for (const auto& key : b.keys) right.insert(key.key);
  return left == right;
}

}  // namespace

/// Gives a bare `place` in the formula the variable of the event's only `place(...)`.
bool BindingParser::repeat_mapping(BindingEntry& entry) {
  std::map<std::string, std::set<std::string>> mapped;  // variables, by function
  for (const auto& argument : entry.event_arguments) {
    for (const auto& parameter : argument.parameters) {
      mapped[parameter.function].insert(parameter.variable);
      if (!parameter.variable.empty()) continue;
      failed_ = true;
      sink_.error(DiagnosticCode::kBindingSyntax, entry.source,
                  fmt::format("`{}(?variable)` in the event", parameter.function), "the bare name");
      return false;
    }
  }
  for (auto& node : entry.formula.nodes) {
    if (node.leaf != LeafKind::kParameter) continue;
    auto& parameter = entry.formula.parameters[node.number];
    if (!parameter.variable.empty()) continue;
    const auto& variables = mapped[parameter.function];
    if (variables.size() == 1) {
      parameter.variable = *variables.begin();
    } else {  // a constant of the model that happens to have this name
      node.leaf = LeafKind::kName;
    }
  }
  return true;
}

bool BindingParser::check_variables(const BindingEntry& entry) {
  bool good = true;
  const auto check = [&](const std::string& variable, SourceRange where) {
    const auto known = [&](const BindingKey& key) { return key.variable == variable; };
    if (std::any_of(entry.keys.begin(), entry.keys.end(), known)) return;
    good = false;
    failed_ = true;
    sink_.error(DiagnosticCode::kBindingVariable, where, variable);
  };
  for (const auto& argument : entry.event_arguments) {
    for (const auto& parameter : argument.parameters) check(parameter.variable, entry.source);
  }
  for (const auto& parameter : entry.formula.parameters) {
    if (!parameter.variable.empty()) check(parameter.variable, entry.formula_source);
  }
  for (const auto& variable : entry.plan_arguments) check(variable, entry.source);
  return good;
}

bool BindingParser::add(const BindingEntry& entry) {
  for (const auto& other : out_.entries) {
    if (other.kind != entry.kind || other.type != entry.type || !same_keys(other, entry)) continue;
    failed_ = true;
    sink_.error(DiagnosticCode::kDuplicateBinding, entry.source, to_string(entry.kind), entry.type)
        .note(other.source, "first bound here");
    return false;
  }
  out_.entries.push_back(entry);
  return true;
}

/// An alias takes over every entry of its target; an alias may name an earlier alias.
void BindingParser::expand_aliases() {
  for (const auto& alias : aliases_) {
    const auto matches = [&](const BindingEntry& entry, PerformKind kind) {
      return entry.type == alias.target && entry.kind == kind;
    };
    std::vector<BindingEntry> found;
    const auto collect = [&](PerformKind kind) {
      for (const auto& entry : out_.entries) {
        if (matches(entry, kind)) found.push_back(entry);
      }
    };
    const auto other =
        alias.kind == PerformKind::kMotion ? PerformKind::kAction : PerformKind::kMotion;
    collect(alias.target_kind.value_or(alias.kind));
    if (found.empty() && !alias.target_kind) collect(other);
    if (found.empty()) {
      failed_ = true;
      sink_.error(DiagnosticCode::kBindingAlias, alias.source, alias.target);
    }
    for (auto& entry : found) {
      for (const auto& type : alias.types) {
        entry.kind = alias.kind;
        entry.type = type;
        entry.source = alias.source;
        add(entry);
      }
    }
  }
}

base::Result<PlanBinding> BindingParser::parse() {
  end_ = cleaned_.entries.empty() ? text_.size() : cleaned_.entries.front();
  skip_blanks();
  if (i_ != end_) expected("an entry that starts with `motion`, `action`, `query` or `object`");
  for (std::size_t n = 0; n < cleaned_.entries.size(); ++n) {
    i_ = cleaned_.entries[n];
    end_ = n + 1 < cleaned_.entries.size() ? cleaned_.entries[n + 1] : text_.size();
    parse_entry();
  }
  expand_aliases();
  if (failed_) return sink_.already_reported();
  return std::move(out_);
}

std::string_view to_string(PerformKind kind) {
  return kind == PerformKind::kMotion ? "motion" : "action";
}

std::string normalise_key(std::string_view key) {
  if (key == "target" || key == "pose" || key == "location" || key == "goal") return "target";
  if (key == "object" || key == "for") return "object";
  if (key == "arm" || key == "gripper" || key.starts_with("left-") || key.starts_with("right-")) {
    return "arm";
  }
  return std::string(key);
}

std::vector<std::string> PlanBinding::types(PerformKind kind) const {
  std::vector<std::string> out;
  for (const auto& entry : entries) {
    if (entry.kind != kind) continue;
    if (std::find(out.begin(), out.end(), entry.type) == out.end()) out.push_back(entry.type);
  }
  return out;
}

base::Result<PlanBinding> parse_plan_binding(const base::SourceFiles& files, base::FileId file,
                                             base::DiagnosticSink& sink) {
  return BindingParser(files, file, sink).parse();
}

}  // namespace parallax::compiler
