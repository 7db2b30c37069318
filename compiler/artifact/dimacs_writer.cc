#include "compiler/artifact/dimacs_writer.h"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace parallax::compiler {
namespace {

std::string_view kind_name(AtomKind kind) {
  switch (kind) {
    case AtomKind::kHoldsAt:
      return "HoldsAt";
    case AtomKind::kHappens:
      return "Happens";
    case AtomKind::kReleasedAt:
      return "ReleasedAt";
    case AtomKind::kPredicate:
      return "Predicate";
    case AtomKind::kLocation:
      return "Location";
    case AtomKind::kHit:
      return "Hit";
    case AtomKind::kRunning:
      return "Running";
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return {};
}

void write_origins(const CompiledModel& model, const base::SourceFiles& files, std::string& out) {
  std::size_t begin = 0;
  while (begin < model.clauses.size()) {
    std::size_t end = begin + 1;
    const auto origin_index = model.clause_origins[begin];
    while (end < model.clauses.size() && model.clause_origins[end] == origin_index) ++end;
    const auto& origin = model.origins[origin_index];
    const auto& file = files[origin.source.file];
    const auto from = file.position(origin.source.begin);
    const auto to = file.position(origin.source.end);
    fmt::format_to(std::back_inserter(out), "c dec origin {}..{} {} {}:{}:{}-{}:{}\n", begin,
                   end - 1, origin.what, file.name(), from.line, from.column, to.line, to.column);
    begin = end;
  }
}

}  // namespace

std::string to_dimacs(const CompiledModel& model, const base::SourceFiles& files) {
  std::string out = "c dec format 0.1\n";
  fmt::format_to(std::back_inserter(out), "c dec horizon {}\n", model.horizon);
  std::string show = "c p show";
  model.for_each_atom([&](std::int32_t variable, AtomKind kind, const std::string& name,
                          std::optional<Timepoint> time) {
    fmt::format_to(std::back_inserter(out), "c dec atom {} {} {}", variable, kind_name(kind), name);
    if (time) fmt::format_to(std::back_inserter(out), " {}", *time);
    out += '\n';
    if (kind == AtomKind::kHoldsAt || kind == AtomKind::kHappens) {
      fmt::format_to(std::back_inserter(show), " {}", variable);
    }
  });
  write_origins(model, files, out);
  fmt::format_to(std::back_inserter(out), "c t pmc\np cnf {} {}\n{} 0\n", model.variable_count(),
                 model.clauses.size(), show);
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    for (const auto literal : model.clauses[i]) {
      fmt::format_to(std::back_inserter(out), "{} ", literal.dimacs());
    }
    out += "0\n";
  }
  return out;
}

}  // namespace parallax::compiler
