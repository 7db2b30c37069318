#include "compiler/artifact/provenance_reader.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {

using base::DiagnosticCode;

bool ProvenanceReader::read_axiom() {
  Origin origin;
  if (!cursor_.word("the id of an axiom", origin.id)) return false;
  const auto index = static_cast<std::uint32_t>(model_.origins.size());
  if (origin.id.empty()) return cursor_.expected("the id of an axiom");
  if (!origins_.emplace(origin.id, index).second) {
    return cursor_.fail(DiagnosticCode::kArtifactTwice, fmt::format("the axiom `{}`", origin.id));
  }
  std::string kind;
  if (!cursor_.word("the kind of an axiom", kind)) return false;
  const auto known = origin_kind(kind);
  if (!known) return cursor_.expected("the kind of an axiom");
  origin.kind = *known;
  if (!places_.read_place(cursor_, origin.place) || !cursor_.word("a text", origin.text)) {
    return false;
  }
  origin.source = cursor_.last();
  model_.origins.push_back(std::move(origin));
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_section() {
  Section section;
  section.begin = static_cast<std::size_t>(clause_count_);
  const auto type = cursor_.raw_word();
  if (type == "repeated") {
    std::int64_t width = 0;
    if (!cursor_.number("a width", 0, model_.horizon, width)) return false;
    section.repeated = true;
    section.width = static_cast<Timepoint>(width);
    section.copies = std::int64_t{model_.horizon} - width + 1;
  } else if (type != "fixed") {
    return cursor_.expected("`fixed` or `repeated`");
  }
  model_.sections.push_back(section);
  runs_.emplace_back();
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_clauses() {
  if (model_.sections.empty()) {
    return cursor_.fail(DiagnosticCode::kArtifactMissing, "c dec section fixed");
  }
  auto& section = model_.sections.back();
  ClauseRun run;
  std::string id;
  if (!cursor_.word("the id of an axiom", id)) return false;
  const auto origin = origins_.find(id);
  if (origin == origins_.end()) return cursor_.fail(DiagnosticCode::kArtifactUnknownAxiom, id);
  run.origin = origin->second;
  if (!read_counts(cursor_, run.groups)) return false;
  // Each clause takes a line of at least two bytes, so this bounds every later sum.
  for (const auto& group : run.groups) {
    const std::uint64_t most = cursor_.file_size() / static_cast<std::uint64_t>(section.copies);
    if (group.size() > most || section.clauses + group.size() > most) {
      return cursor_.fail(DiagnosticCode::kArtifactOversized, "the number of clauses",
                          fmt::format("{} times {}", group.size(), section.copies),
                          cursor_.file_size());
    }
    section.clauses += static_cast<std::size_t>(group.size());
    clause_count_ += group.size() * static_cast<std::uint64_t>(section.copies);
  }
  if (!cursor_.at_line_end()) {
    if (cursor_.raw_word() != "at") return cursor_.expected("`at`");
    std::int64_t time = 0;
    if (!cursor_.number("a timepoint", 0, model_.horizon - section.copies + 1, time)) return false;
    run.timepoint = static_cast<Timepoint>(time);
  }
  runs_.back().push_back(std::move(run));
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_step() {
  PlanStep step;
  if (!cursor_.word("the event of a step", step.event)) return false;
  step.source = cursor_.last();
  if (!cursor_.word("a failure class", step.failure_class) ||
      !places_.read_place(cursor_, step.place)) {
    return false;
  }
  model_.plan.push_back(std::move(step));
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_cut() {
  PlanCut cut;
  if (!cursor_.word("the form that was cut", cut.form)) return false;
  cut.source = cursor_.last();
  if (!places_.read_place(cursor_, cut.place)) return false;
  model_.plan_cuts.push_back(std::move(cut));
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_argument() {
  if (model_.plan.empty()) {
    return cursor_.fail(DiagnosticCode::kArtifactMissing, "c dec step EVENT");
  }
  std::string name;
  if (!cursor_.word("the name of an argument", name)) return false;
  auto [argument, added] = model_.plan.back().arguments.try_emplace(name);
  if (!added) {
    return cursor_.fail(DiagnosticCode::kArtifactTwice, fmt::format("the argument `{}`", name));
  }
  const auto type = cursor_.raw_word();
  return read_value(type, argument->second) && cursor_.end_of_line();
}

bool ProvenanceReader::read_value(std::string_view type, PlanValue& value) {
  if (type == "text") {
    std::string text;
    if (!cursor_.word("a text", text)) return false;
    value = std::move(text);
    return true;
  }
  if (type == "integer") {
    using Limits = std::numeric_limits<std::int64_t>;
    std::int64_t number = 0;
    if (!cursor_.number("the argument", Limits::min(), Limits::max(), number)) return false;
    value = number;
    return true;
  }
  if (type != "real") return cursor_.expected("`real`, `integer` or `text`");
  const auto text = cursor_.raw_word();
  double number = 0.0;
  const auto* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return cursor_.expected("a number");
  value = number;
  return true;
}

}  // namespace parallax::compiler
