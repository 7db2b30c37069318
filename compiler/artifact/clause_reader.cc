#include "compiler/artifact/clause_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/artifact/derived.h"
#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

constexpr std::int64_t kMostClauses = std::int64_t{1} << 31U;

}  // namespace

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
    return cursor_.fail(DiagnosticCode::kArtifactCounts, "the number of variables here", variables,
                        "base + horizon * stride + state-slots", model_.variable_count());
  }
  if (!cursor_.number("the number of clauses", 0, kMostClauses, clauses)) return false;
  clause_count_ = static_cast<std::uint64_t>(clauses);
  if (clause_count_ != expected_clauses) {
    return cursor_.fail(DiagnosticCode::kArtifactCounts, "the number of clauses here", clauses,
                        "the sum of the `c dec clauses` lines", expected_clauses);
  }
  return cursor_.end_of_line();
}

/// The current line is `c p show`.
bool ClauseReader::read_projection() {
  cursor_.raw_word(), cursor_.raw_word(), cursor_.raw_word();
  for (const auto wanted : observable_variables(model_)) {
    std::int64_t v = 0;
    if (!cursor_.number("a variable", 0, model_.variable_count(), v)) return false;
    if (v != wanted) {
      return cursor_.fail(DiagnosticCode::kArtifactProjection,
                          fmt::format("found {} where {} belongs", v, wanted));
    }
  }
  std::int64_t end = 0;
  return cursor_.number("the closing 0", 0, 0, end) && cursor_.end_of_line();
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
      cursor_.sink().error(DiagnosticCode::kArtifactNotShifted, cursor_.line_range(), i + 1, copy);
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
  return cursor_.fail(DiagnosticCode::kArtifactTruncated, model_.clauses.size(), clause_count_);
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
