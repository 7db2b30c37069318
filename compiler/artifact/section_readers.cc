#include "compiler/artifact/section_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "compiler/artifact/clause_runs.h"
#include "compiler/base/codes/artifacts.h"

namespace parallax::compiler {

namespace {

// "Times" of names that are unique in the whole model.
constexpr Timepoint kEveryTime = -1;
constexpr Timepoint kNoTime = -2;

constexpr std::int64_t kMostClauses = std::int64_t{1} << 31U;

}  // namespace

bool SymbolReader::unique(AtomKind kind, Timepoint time, const std::string& name, bool declared) {
  const auto key = fmt::format("{} {} {} {}", declared, static_cast<int>(kind), time, name);
  if (names_.insert(key).second) return true;
  return cursor_.fail(codes::kArtifactTwice, fmt::format("{} `{}`", to_string(kind), name));
}

bool SymbolReader::claim_slot(std::int64_t slot, AtomKind kind, const std::string& name) {
  const auto index = static_cast<std::size_t>(slot);
  slot_taken_.resize(model_.slots.size(), false);
  if (slot_taken_[index]) {
    return cursor_.fail(codes::kArtifactTwice, fmt::format("slot {}", slot));
  }
  slot_taken_[index] = true;
  model_.slots[index] = {kind, name};
  return is_nameless(kind) || unique(kind, kEveryTime, name, false);
}

/// `NAME SLOT` or `NAME never`; slots from `lower` up to and without `upper`.
bool SymbolReader::read_ground_name(std::string_view what, AtomKind kind, std::int64_t lower,
                                    std::int64_t upper, GroundName& name) {
  if (!cursor_.word(what, name.name) || !unique(kind, kNoTime, name.name, true)) return false;
  const auto text = cursor_.raw_word();
  if (text == "never") return true;
  std::int64_t slot = 0;
  if (!cursor_.parse_number(text, "a slot", lower, upper - 1, slot)) return false;
  name.slot = static_cast<std::uint32_t>(slot);
  return claim_slot(slot, kind, name.name);
}

bool SymbolReader::read_fluent() {
  GroundName fluent;
  std::optional<std::uint32_t> released;
  if (!read_ground_name("the name of a fluent", AtomKind::kHoldsAt, 0, model_.state_slots,
                        fluent)) {
    return false;
  }
  if (!cursor_.at_line_end()) {
    if (cursor_.raw_word() != "released") return cursor_.expected("`released`");
    std::int64_t slot = 0;
    if (!cursor_.number("a slot", 0, std::int64_t{model_.state_slots} - 1, slot) ||
        !claim_slot(slot, AtomKind::kReleasedAt, fluent.name)) {
      return false;
    }
    released = static_cast<std::uint32_t>(slot);
  }
  model_.fluents.push_back(std::move(fluent));
  model_.release_slots.push_back(released);
  return cursor_.end_of_line();
}

bool SymbolReader::read_event() {
  GroundName event;
  if (!read_ground_name("the name of an event", AtomKind::kHappens, model_.state_slots,
                        model_.stride(), event)) {
    return false;
  }
  model_.events.push_back(std::move(event));
  return cursor_.end_of_line();
}

bool SymbolReader::read_kind(AtomKind& kind) {
  const auto known = kAtomKindWords.find(cursor_.raw_word());
  if (!known) return cursor_.expected("the kind of an atom");
  kind = *known;
  return true;
}

bool SymbolReader::read_slot() {
  std::int64_t slot = 0;
  auto kind = AtomKind::kUnused;
  std::string name;
  return cursor_.number("a slot", 0, std::int64_t{model_.stride()} - 1, slot) && read_kind(kind) &&
         cursor_.word("a name", name) && claim_slot(slot, kind, name) && cursor_.end_of_line();
}

bool SymbolReader::read_atom() {
  std::int64_t v = 0, time = 0;
  Atom atom;
  if (!cursor_.number("a variable", 1, model_.base(), v)) return false;
  const auto index = static_cast<std::size_t>(v) - 1;
  fixed_taken_.resize(model_.fixed.size(), false);
  if (fixed_taken_[index]) {
    return cursor_.fail(codes::kArtifactTwice, fmt::format("variable {}", v));
  }
  fixed_taken_[index] = true;
  std::string name;
  if (!read_kind(atom.kind) || !cursor_.word("a name", name)) return false;
  if (!cursor_.at_line_end()) {
    if (!cursor_.number("a timepoint", 0, model_.horizon, time)) return false;
    atom.time = static_cast<Timepoint>(time);
  }
  const bool timeless = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens ||
                        atom.kind == AtomKind::kReleasedAt;
  if (timeless && !atom.time) return cursor_.expected("a timepoint");
  if (!is_nameless(atom.kind) && !unique(atom.kind, atom.time.value_or(kNoTime), name, false)) {
    return false;
  }
  if (is_of_plan(atom.kind)) {
    atom.plan = plan_atom(atom.kind, name);
  } else {
    atom.name = std::move(name);
  }
  model_.fixed[index] = std::move(atom);
  return cursor_.end_of_line();
}

void SymbolReader::name_the_rest() {
  const auto occurring = occurrences(model_);
  slot_taken_.resize(model_.slots.size(), false);
  fixed_taken_.resize(model_.fixed.size(), false);
  for (std::size_t i = 0; i < model_.slots.size(); ++i) {
    if (!slot_taken_[i] && occurring.slots[i]) model_.slots[i].kind = AtomKind::kAuxiliary;
  }
  for (std::size_t i = 0; i < model_.fixed.size(); ++i) {
    if (!fixed_taken_[i] && occurring.fixed[i]) model_.fixed[i].kind = AtomKind::kAuxiliary;
  }
}

bool SymbolReader::check_hits() {
  if (!model_.has_constraints) return true;
  const AtomIndex index(model_);
  for (Timepoint t = 1; t <= model_.horizon; ++t) {
    if (index.hit(t)) continue;
    return cursor_.fail(codes::kArtifactMissing, fmt::format("c dec atom VARIABLE Hit hit {}", t));
  }
  return true;
}

bool ObjectiveReader::read_objective() {
  Objective objective;
  if (!cursor_.word("what is to be least", objective.text)) return false;
  model_.objectives.push_back(std::move(objective));
  total_ = 0;
  return cursor_.end_of_line();
}

/// `WEIGHT at TIMEPOINT [LITERAL]`
bool ObjectiveReader::read_term() {
  if (model_.objectives.empty()) {
    return cursor_.fail(codes::kArtifactMissing, "c dec objective TEXT");
  }
  constexpr auto kMost = kMostObjectiveWeight - 1;
  ObjectiveTerm term;
  if (!cursor_.number("a weight", -kMost, kMost, term.weight)) return false;
  if (term.weight == 0) return cursor_.expected("a weight that is not 0");
  total_ += term.weight < 0 ? -term.weight : term.weight;  // both are below 2^62
  if (total_ > kMost) {
    return cursor_.fail(codes::kArtifactRange, "the sum of all weights", total_, 0, kMost);
  }
  if (cursor_.raw_word() != "at") return cursor_.expected("`at`");
  std::int64_t needed = 0;
  if (!cursor_.number("a timepoint", 0, model_.horizon, needed)) return false;
  term.needed = static_cast<Timepoint>(needed);
  if (cursor_.at_line_end()) {
    model_.objectives.back().terms.push_back(term);
    return true;
  }
  const std::int64_t variables = model_.variable_count();
  std::int64_t literal = 0;
  if (!cursor_.number("a literal", -variables, variables, literal)) return false;
  if (literal == 0) return cursor_.expected("a literal");
  term.literal = Literal::from_dimacs(static_cast<std::int32_t>(literal));
  const auto own = std::min(needed_horizon(model_.atom(term.literal->var())), model_.horizon);
  if (own > term.needed) {
    return cursor_.fail(codes::kArtifactRange, "the timepoint of a term", needed, own,
                        model_.horizon);
  }
  model_.objectives.back().terms.push_back(term);
  return cursor_.end_of_line();
}

bool ProvenanceReader::read_axiom() {
  Origin origin;
  if (!cursor_.word("the id of an axiom", origin.id)) return false;
  const auto index = static_cast<std::uint32_t>(model_.origins.size());
  if (origin.id.empty()) return cursor_.expected("the id of an axiom");
  if (!origins_.emplace(origin.id, index).second) {
    return cursor_.fail(codes::kArtifactTwice, fmt::format("the axiom `{}`", origin.id));
  }
  std::string kind;
  if (!cursor_.word("the kind of an axiom", kind)) return false;
  const auto known = kOriginKindWords.find(kind);
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
    return cursor_.fail(codes::kArtifactMissing, "c dec section fixed");
  }
  auto& section = model_.sections.back();
  ClauseRun run;
  std::string id;
  if (!cursor_.word("the id of an axiom", id)) return false;
  const auto origin = origins_.find(id);
  if (origin == origins_.end()) return cursor_.fail(codes::kArtifactUnknownAxiom, id);
  run.origin = origin->second;
  if (!read_counts(cursor_, run.groups)) return false;
  // Each clause takes a line of at least two bytes, so this bounds every later sum.
  for (const auto& group : run.groups) {
    const std::uint64_t most = cursor_.file_size() / static_cast<std::uint64_t>(section.copies);
    if (group.size() > most || section.clauses + group.size() > most) {
      return cursor_.fail(codes::kArtifactOversized, "the number of clauses",
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
  PlanPerform step;
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
    return cursor_.fail(codes::kArtifactMissing, "c dec step EVENT");
  }
  std::string name;
  if (!cursor_.word("the name of an argument", name)) return false;
  auto [argument, added] = model_.plan.back().arguments.try_emplace(name);
  if (!added) {
    return cursor_.fail(codes::kArtifactTwice, fmt::format("the argument `{}`", name));
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

bool ClauseReader::read(std::uint64_t expected_clauses,
                        const std::vector<std::vector<ClauseRun>>& runs) {
  if (!read_header(expected_clauses)) return false;
  for (std::size_t i = 0; i < model_.sections.size(); ++i) {
    if (!read_section(model_.sections[i], runs[i])) return false;
  }
  return read_rest();
}

bool ClauseReader::read_header(std::uint64_t expected_clauses) {
  std::int64_t variables = 0, clauses = 0;
  if (cursor_.raw_word() != "p" || cursor_.raw_word() != "cnf") return cursor_.expected("`p cnf`");
  if (!cursor_.number("the number of variables", 0, kMostClauses, variables)) return false;
  if (variables != model_.variable_count()) {
    return cursor_.fail(codes::kArtifactCounts, "the number of variables here", variables,
                        "base + horizon * stride + state-slots", model_.variable_count());
  }
  if (!cursor_.number("the number of clauses", 0, kMostClauses, clauses)) return false;
  clause_count_ = static_cast<std::uint64_t>(clauses);
  if (clause_count_ != expected_clauses) {
    return cursor_.fail(codes::kArtifactCounts, "the number of clauses here", clauses,
                        "the sum of the `c dec clauses` lines", expected_clauses);
  }
  return cursor_.end_of_line();
}

/// The current line is `c p show`.
bool ClauseReader::read_projection() {
  cursor_.raw_word(), cursor_.raw_word(), cursor_.raw_word();
  bool good = true;
  for_each_observable(model_, [&](std::int32_t wanted) {
    std::int64_t v = 0;
    good = good && cursor_.number("a variable", 0, model_.variable_count(), v);
    if (!good || v == wanted) return;
    good = cursor_.fail(codes::kArtifactProjection,
                        fmt::format("found {} where {} belongs", v, wanted));
  });
  std::int64_t end = 0;
  return good && cursor_.number("the closing 0", 0, 0, end) && cursor_.end_of_line();
}

bool ClauseReader::read_section(const Section& section, const std::vector<ClauseRun>& runs) {
  const auto take = [&](const ClauseRun& run, std::uint32_t count, bool is_definition) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!next_clause()) return false;
      const auto time = run.timepoint.value_or(usual_timepoint(model_, section, clause_));
      model_.clauses.add(clause_);
      model_.clause_timepoints.push_back(time);
      model_.clause_origins.push_back(run.origin);
      model_.clause_is_definition.push_back(is_definition);
    }
    return true;
  };
  for (const auto& run : runs) {
    for (const auto& group : run.groups) {
      for (std::uint32_t i = 0; i < group.repeat; ++i) {
        if (!take(run, group.plain, false) || !take(run, group.definitions, true)) return false;
      }
    }
  }
  for (std::int64_t copy = 1; copy < section.copies; ++copy) {
    if (!read_copy(section, copy)) return false;
  }
  return true;
}

bool ClauseReader::read_copy(const Section& section, std::int64_t copy) {
  for (std::size_t i = 0; i < section.clauses; ++i) {
    if (!next_clause()) return false;
    const auto first = section.begin + i;
    if (!is_shifted(model_, model_.clauses[first], clause_, copy)) {
      cursor_.sink().error(codes::kArtifactNotShifted, cursor_.line_range(), i + 1, copy);
      return false;
    }
    model_.clauses.add(clause_);
    model_.clause_timepoints.push_back(model_.clause_timepoints[first] +
                                       static_cast<Timepoint>(copy));
    model_.clause_origins.push_back(model_.clause_origins[first]);
    model_.clause_is_definition.push_back(model_.clause_is_definition[first]);
  }
  return true;
}

/// Goes to the next line that is no comment, and reads it as a clause.
bool ClauseReader::next_clause() {
  while (cursor_.next_line()) {
    const auto line = cursor_.line();
    if (line.starts_with("c p show") && model_.clauses.size() == 0) {
      if (!read_projection()) return false;
    } else if (line.starts_with("c dec")) {
      cursor_.raw_word();
      return cursor_.expected("a clause");
    } else if (line != "c" && !line.starts_with("c ")) {
      return parse_clause();
    }
  }
  return cut_off();
}

bool ClauseReader::cut_off() {
  return cursor_.fail(codes::kArtifactTruncated, model_.clauses.size(), clause_count_);
}

bool ClauseReader::parse_clause() {
  clause_.clear();
  const std::int64_t most = model_.variable_count();
  for (;;) {
    if (cursor_.at_line_end()) {
      cursor_.raw_word();
      return cursor_.expected("a literal or the closing 0");
    }
    std::int64_t value = 0;
    if (!cursor_.number("a literal", -most, most, value)) return false;
    if (value == 0) return cursor_.end_of_line();
    clause_.push_back(Literal::from_dimacs(static_cast<std::int32_t>(value)));
  }
}

/// After the last clause: comments and empty lines only.
bool ClauseReader::read_rest() {
  while (cursor_.next_line()) {
    const auto line = cursor_.line();
    if (line.starts_with("c p show") && model_.clauses.size() == 0) {
      if (!read_projection()) return false;
    } else if (!line.empty() && line != "c" && !line.starts_with("c ")) {
      cursor_.raw_word();
      return cursor_.expected("the end of the file");
    }
  }
  return true;
}

}  // namespace parallax::compiler
