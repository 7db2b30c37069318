#include "runtime/trace/decreasoner_format.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "compiler/base/line_diff.h"
#include "compiler/base/whole_number.h"
#include "compiler/base/words.h"
#include "runtime/trace/open_atoms.h"

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

/// The program of 2005 puts a blank behind every comma.
std::string spaced(std::string_view name) {
  std::string out;
  for (const char c : name) {
    out += c;
    if (c == ',') out += ' ';
  }
  return out;
}

std::string timed(std::string_view predicate, std::string_view name, Timepoint t) {
  return std::string(predicate) + '(' + spaced(name) + ", " + std::to_string(t) + ')';
}

std::string line_of(AtomKind kind, std::string_view name, std::optional<Timepoint> time) {
  if (kind == AtomKind::kHoldsAt) return timed("HoldsAt", name, time.value_or(0));
  if (kind == AtomKind::kHappens) return timed("Happens", name, time.value_or(0));
  if (kind == AtomKind::kReleasedAt) return timed("ReleasedAt", name, time.value_or(0));
  return spaced(name);
}

void append_sorted(Lines lines, Lines& out) {
  std::sort(lines.begin(), lines.end());
  std::move(lines.begin(), lines.end(), std::back_inserter(out));
}

/// The variables of atoms that no formula of the model mentions: they are denied by clauses of
/// their own.
std::vector<bool> unmentioned(const CompiledModel& model) {
  std::vector<bool> result(static_cast<std::size_t>(model.variable_count()) + 1, false);
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.origins[model.clause_origins[i]].kind != compiler::OriginKind::kUnmentioned) continue;
    for (const auto literal : model.clauses[i]) {
      result[static_cast<std::size_t>(literal.var())] = true;
    }
  }
  return result;
}

/// The last argument, if it is a number.
std::optional<Timepoint> last_number(std::string_view name) {
  if (!name.ends_with(')')) return std::nullopt;
  name.remove_suffix(1);
  return base::whole_number<Timepoint>(name.substr(name.find_last_of("(,") + 1));
}

}  // namespace

DecreasonerFormat::DecreasonerFormat(const CompiledModel& model, const DecreasonerOptions& options)
    : options_(options), holds_(static_cast<std::size_t>(model.horizon) + 1) {
  collect(model);
  for (auto& fluents : holds_) std::sort(fluents.begin(), fluents.end());
  std::sort(propositions_.begin(), propositions_.end(),
            [](const Proposition& a, const Proposition& b) { return a.line < b.line; });
}

void DecreasonerFormat::collect(const CompiledModel& model) {
  const auto silent = unmentioned(model);
  std::vector<bool> said_last(model.events.size(), false);
  const auto add = [&](AtomKind kind, const std::string& name, std::size_t number,
                       std::optional<Timepoint> time) {
    propositions_.push_back(
        {kind, name, static_cast<std::uint32_t>(number), time, line_of(kind, name, time)});
  };
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (silent[static_cast<std::size_t>(atom.variable)]) return;
    switch (atom.kind) {
      case AtomKind::kHoldsAt:
        holds_[static_cast<std::size_t>(*atom.time)].push_back(atom.fluent());
        add(atom.kind, atom.name, atom.number, atom.time);
        break;
      case AtomKind::kHappens:
        if (atom.time == model.horizon) said_last[atom.number] = true;
        add(atom.kind, atom.name, atom.number, atom.time);
        break;
      case AtomKind::kReleasedAt:
      case AtomKind::kPredicate:
        add(atom.kind, atom.name, atom.number, atom.time);
        break;
      case AtomKind::kLocation:
      case AtomKind::kHit:
      case AtomKind::kRunning:
      case AtomKind::kSucceeded:
      case AtomKind::kResult:
      case AtomKind::kRegister:
      case AtomKind::kAuxiliary:
      case AtomKind::kUnused:
        break;
    }
  });
  // Fluents that nothing releases have no variable here; there, inertia mentions their release.
  for (Timepoint t = 0; t <= model.horizon; ++t) {
    for (std::size_t f = 0; f < model.fluents.size(); ++f) {
      if (!model.release_slots[f]) add(AtomKind::kReleasedAt, model.fluents[f].name, f, t);
    }
  }
  if (!options_.events_completed) return;
  for (std::size_t e = 0; e < model.events.size(); ++e) {
    if (said_last[e]) continue;
    add(AtomKind::kHappens, model.events[e].name, e, model.horizon);
  }
}

bool DecreasonerFormat::is_open(const OpenAtoms& open, const Proposition& proposition) {
  if (proposition.kind == AtomKind::kPredicate) return contains(open.predicates, proposition.name);
  if (proposition.kind != AtomKind::kReleasedAt) return false;
  const auto& fluents = open.released_at(static_cast<std::size_t>(proposition.time.value_or(0)));
  return contains(fluents, compiler::FluentId(proposition.number));
}

bool DecreasonerFormat::is_true(const Trace& trace, const Proposition& proposition) {
  if (proposition.kind == AtomKind::kPredicate) {
    return contains(trace.predicates, proposition.name);
  }
  const auto t = static_cast<std::size_t>(proposition.time.value_or(0));
  if (t >= trace.points.size()) return false;
  const auto& point = trace.points[t];
  if (proposition.kind == AtomKind::kHappens) {
    return contains(point.happens, compiler::EventId(proposition.number));
  }
  const auto& fluents = proposition.kind == AtomKind::kHoldsAt ? point.holds : point.released;
  return contains(fluents, compiler::FluentId(proposition.number));
}

/// Appends fluents that became false, then fluents that became true; at the first timepoint all
/// that hold.
void DecreasonerFormat::append_changes(const Trace& trace, std::size_t t, Lines& out) const {
  const auto& now = trace.points[t].holds;
  Lines gone, come;
  const auto name = [&](compiler::FluentId id) { return spaced(trace.symbols->name(id)) + '.'; };
  for (const auto id : now) {
    if (t == 0) come.push_back(name(id));
    if (t == 0 || contains(trace.points[t - 1].holds, id)) continue;
    // A fluent without a proposition at the timepoint before is not said to begin.
    if (contains(holds_[t - 1], id)) come.push_back('+' + name(id));
  }
  if (t > 0) {
    for (const auto id : trace.points[t - 1].holds) {
      if (!contains(now, id)) gone.push_back('-' + name(id));
    }
  }
  append_sorted(std::move(gone), out);
  append_sorted(std::move(come), out);
}

/// User predicates count as atoms of the timepoint that their last argument prints as.
bool DecreasonerFormat::is_shown_with_time(const Proposition& proposition, Timepoint length) const {
  if (options_.time_diff) {
    return proposition.kind == AtomKind::kHoldsAt;
  }
  const auto time =
      proposition.kind == AtomKind::kPredicate ? last_number(proposition.name) : proposition.time;
  return time && *time >= 0 && *time <= length;
}

/// All false atoms, then the true ones; events are appended by the caller.
void DecreasonerFormat::append_state(const Trace& trace, const OpenAtoms& open, std::size_t t,
                                     Lines& out) const {
  Lines holding;
  for (const auto& one : propositions_) {
    const auto time = one.kind == AtomKind::kPredicate ? last_number(one.name) : one.time;
    if (time != static_cast<Timepoint>(t) || is_open(open, one)) continue;
    if (!is_true(trace, one)) {
      out.push_back('!' + one.line + '.');
    } else if (one.kind != AtomKind::kHappens) {
      holding.push_back(one.line + '.');
    }
  }
  append_sorted(std::move(holding), out);
}

void DecreasonerFormat::append_rest(const Trace& trace, const OpenAtoms& open, Lines& out) const {
  Lines holding, other;
  for (const auto& one : propositions_) {
    if (one.time.value_or(0) > trace.length() || is_shown_with_time(one, trace.length())) continue;
    if (is_open(open, one)) continue;
    if (!is_true(trace, one)) {
      other.push_back('!' + one.line + '.');
    } else if (one.kind != AtomKind::kHappens) {
      holding.push_back(one.line + '.');
    }
  }
  append_sorted(std::move(holding), out);
  append_sorted(std::move(other), out);
}

Lines DecreasonerFormat::lines(const Trace& trace, const OpenAtoms& open) const {
  Lines out;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    out.push_back(std::to_string(t));
    if (options_.time_diff) {
      append_changes(trace, t, out);
    } else {
      append_state(trace, open, t, out);
    }
    Lines events;
    for (const auto name : trace.happens(t)) {
      events.push_back(timed("Happens", name, static_cast<Timepoint>(t)) + '.');
    }
    append_sorted(std::move(events), out);
  }
  if (options_.show_predicates) {
    out.emplace_back("P");
    append_rest(trace, open, out);
  }
  return out;
}

std::string DecreasonerFormat::trace(const Trace& trace, const OpenAtoms& open) {
  auto now = lines(trace, open);
  const bool whole = printed_++ == 0 || !options_.model_diff;
  std::string out = "---\nmodel " + std::to_string(trace.number) + (whole ? ":\n" : " diff:");
  if (whole) {
    for (const auto& line : now) out += line + '\n';
  } else {
    out += base::normal_diff(last_, now) + '\n';
  }
  if (options_.model_diff) last_ = std::move(now);
  return out;
}

std::string DecreasonerFormat::end(const ListEnd& end) {
  std::string out = printed_ > 0 ? "---\n" : "";
  if (end.traces == 0 && end.complete) return out + "no models found" + end.remark + '\n';
  out += base::counted(end.traces, "model");
  return out + (end.complete ? "" : ", " + end.exploration) + end.remark + '\n';
}

}  // namespace parallax::runtime
