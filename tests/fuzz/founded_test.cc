// Founded completion against brute force over random cyclic definitions.
//
// A model is a list of clauses over few atoms, written as formulas. The test grounds and evaluates
// them itself: of all assignments it keeps those that satisfy the clauses and are the least model
// of their reduct (Gelfond and Lifschitz 1988), and those that no assignment with fewer completed
// atoms satisfies as well (circumscription). Both must be the traces, unless two atoms of a circle
// stand in one clause: there the model is refused.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tests/fuzz/differential.h"
#include "tests/fuzz/oracles.h"
#include "tests/support/deep.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

enum class Kind : std::uint8_t { kEvent, kFluent, kPredicate };

/// An atom of a formula; `shift` is added to `time`, unless the timepoint is fixed.
struct Literal {
  Kind kind = Kind::kPredicate;
  std::size_t index = 0;
  int shift = 0;
  bool fixed = false;
  bool positive = true;

  std::string text() const {
    const auto time = fixed        ? std::to_string(shift)
                      : shift == 0 ? std::string("time")
                                   : "time+" + std::to_string(shift);
    const auto name = std::string(1, "EFP"[static_cast<std::size_t>(kind)]) + std::to_string(index);
    const std::string sign = positive ? "" : "!";
    if (kind == Kind::kPredicate) return sign + name + "()";
    return sign + (kind == Kind::kEvent ? "Happens(" : "HoldsAt(") + name + "()," + time + ")";
  }
};

/// `body -> head & head`, or `body -> head | head`; `body <-> head` says both ways.
struct Rule {
  std::vector<Literal> body, heads;
  bool disjunction = false, both_ways = false, labelled = true;

  std::string text(bool with_labels) const {
    std::string out = with_labels && labelled ? "Delta: " : "";
    const auto timed = [](const Literal& one) {
      return one.kind != Kind::kPredicate && !one.fixed;
    };
    if (std::any_of(body.begin(), body.end(), timed) ||
        std::any_of(heads.begin(), heads.end(), timed)) {
      out += "[time] ";
    }
    for (std::size_t i = 0; i < body.size(); ++i) out += (i > 0 ? " & " : "") + body[i].text();
    if (!body.empty()) out += both_ways ? " <-> " : " -> ";
    const auto* sign = disjunction ? " | " : " & ";
    if (heads.size() > 1) out += "(";
    for (std::size_t i = 0; i < heads.size(); ++i) out += (i > 0 ? sign : "") + heads[i].text();
    return out + (heads.size() > 1 ? ").\n" : ".\n");
  }
};

using Bits = std::uint32_t;

struct Clause {
  Bits positive = 0, negative = 0;
  bool is_reason = true;
  bool is_tautology() const { return (positive & negative) != 0; }
  bool holds(Bits truth) const { return (truth & positive) != 0 || (~truth & negative) != 0; }
};

/// The random choices of a model.
struct Shape {
  std::size_t events = 0, fluents = 0, predicates = 0;
  int horizon = 1;
  bool fluents_completed = false, labels = false;
  std::size_t closed_predicates = 0;  // the first ones are completed
};

class Model {
 public:
  explicit Model(std::uint64_t seed) : random_(seed) {
    const auto roll = random_.below(4);
    if (roll == 0) shape_ = {0, 0, 6, 1, false, false, 4 + random_.below(2)};
    if (roll == 1) shape_ = {3, 1, 0, 2, false, false, 0};
    if (roll == 2) shape_ = {2, 1, 3, 1, false, false, 2};
    if (roll == 3) shape_ = {2, 2, 0, 2, true, false, 0};
    shape_.labels = random_.chance(25);
    const auto count = 3 + random_.below(6);
    for (std::size_t i = 0; i < count; ++i) rules_.push_back(rule());
    ground();
  }

  std::string text() const {
    std::string out = "range time 0 " + std::to_string(shape_.horizon) + "\noption founded on\n";
    for (std::size_t i = 0; i < shape_.events; ++i) out += "event E" + std::to_string(i) + "()\n";
    for (std::size_t i = 0; i < shape_.fluents; ++i) {
      out += "fluent F" + std::to_string(i) + "()\nnoninertial F" + std::to_string(i) + "\n";
    }
    for (std::size_t i = 0; i < shape_.predicates; ++i) {
      out += "predicate P" + std::to_string(i) + "()\n";
    }
    for (const auto& rule : rules_) out += rule.text(shape_.labels);
    const std::string label = shape_.labels ? "Delta " : "";
    if (shape_.events > 0) out += "completion " + label + "Happens\n";
    if (shape_.fluents_completed) out += "completion " + label + "HoldsAt\n";
    for (std::size_t i = 0; i < shape_.closed_predicates; ++i) {
      out += "completion " + label + "P" + std::to_string(i) + "\n";
    }
    return out;
  }

  /// Does every rule have an instance? Others are refused.
  bool says_something() const { return !silent_; }
  std::size_t atoms() const { return bits_; }
  bool satisfies(Bits truth) const {
    return std::all_of(clauses_.begin(), clauses_.end(),
                       [&](const Clause& clause) { return clause.holds(truth); });
  }

  /// The completed atoms are the least model of the reduct: of the rules `p <- rest` that each
  /// clause gives to each of its positive atoms.
  bool is_stable(Bits truth) const {
    Bits derived = truth & ~completed_;
    for (Bits before = ~derived; before != derived;) {
      before = derived;
      for (const auto& clause : clauses_) {
        if (!clause.is_reason || clause.is_tautology()) continue;
        for (Bits atom = 1; atom != Bits{1} << bits_; atom <<= 1U) {
          if ((clause.positive & completed_ & atom) == 0) continue;
          const bool others_false = (clause.positive & ~atom & truth) == 0;
          if (others_false && (clause.negative & ~derived) == 0) derived |= atom;
        }
      }
    }
    return derived == truth;
  }

  bool is_minimal(Bits truth) const {
    const auto open = truth & completed_;
    for (Bits part = open; part != 0;) {
      part = (part - 1) & open;
      const auto smaller = (truth & ~completed_) | part;
      const bool fits = std::all_of(clauses_.begin(), clauses_.end(), [&](const Clause& clause) {
        return !clause.is_reason || clause.holds(smaller);
      });
      if (fits) return false;
    }
    return true;
  }

  /// Do two completed atoms of a circle stand in one clause?
  bool has_split_circle() const {
    std::vector<Bits> needs(bits_, 0);
    for (const auto& clause : clauses_) {
      if (!clause.is_reason || clause.is_tautology()) continue;
      for (std::size_t p = 0; p < bits_; ++p) {
        if ((clause.positive & completed_) >> p & 1U) needs[p] |= clause.negative & completed_;
      }
    }
    for (std::size_t k = 0; k < bits_; ++k) {
      for (auto& own : needs) own |= (own >> k & 1U) != 0 ? needs[k] : 0;
    }
    for (const auto& clause : clauses_) {
      if (!clause.is_reason || clause.is_tautology()) continue;
      for (std::size_t p = 0; p < bits_; ++p) {
        for (std::size_t q = 0; q < p; ++q) {
          const Bits pair = Bits{1} << p | Bits{1} << q;
          if ((clause.positive & completed_ & pair) != pair) continue;
          if ((needs[p] >> q & 1U) != 0 && (needs[q] >> p & 1U) != 0) return true;
        }
      }
    }
    return false;
  }

  /// The atoms that are true, but for open predicates that `known` does not have.
  std::string key(Bits truth, const std::set<std::string>& known) const {
    std::string out;
    for (std::size_t p = 0; p < shape_.predicates; ++p) {
      const auto name = "P" + std::to_string(p) + "()";
      if (p >= shape_.closed_predicates && !known.contains(name)) continue;
      if (truth >> place({Kind::kPredicate, p}, 0) & 1U) out += name + " ";
    }
    for (int t = 0; t <= shape_.horizon; ++t) {
      out += "; ";
      for (std::size_t f = 0; f < shape_.fluents; ++f) {
        if (truth >> place({Kind::kFluent, f}, t) & 1U) out += "F" + std::to_string(f) + "() ";
      }
      for (std::size_t e = 0; t < shape_.horizon && e < shape_.events; ++e) {
        if (truth >> place({Kind::kEvent, e}, t) & 1U) out += "E" + std::to_string(e) + "() ";
      }
    }
    return out;
  }
  static std::string key(const compiler::Valuation& trace) {
    std::string out;
    for (const auto& name : trace.predicates) out += name + " ";
    for (std::size_t t = 0; t < trace.holds.size(); ++t) {
      out += "; ";
      for (const auto& name : trace.holds[t]) out += name + " ";
      for (const auto& name : trace.happens[t]) out += name + " ";
    }
    return out;
  }

 private:
  Literal atom(bool fixed) {
    Literal out;
    const auto kinds = {shape_.events, shape_.fluents, shape_.predicates};
    auto number = random_.below(shape_.events + shape_.fluents + shape_.predicates);
    int kind = 0;
    for (const auto count : kinds) {
      if (number < count) break;
      number -= count;
      ++kind;
    }
    out.kind = static_cast<Kind>(kind);
    out.index = number;
    out.fixed = fixed;
    if (fixed)
      out.shift = static_cast<int>(random_.below(static_cast<std::size_t>(shape_.horizon)));
    if (!fixed && random_.chance(15)) out.shift = 1;
    return out;
  }

  Rule rule() {
    Rule out;
    const bool fixed = random_.chance(20);
    const auto size = random_.below(10);
    const std::size_t body = size < 2 ? 0 : size < 7 ? 1 : 2;
    for (std::size_t i = 0; i < body; ++i) {
      out.body.push_back(atom(fixed));
      out.body.back().positive = random_.chance(85);
    }
    out.heads.push_back(atom(fixed));
    if (random_.chance(20)) {
      out.heads.push_back(atom(fixed));
      out.disjunction = random_.chance(50);
    }
    out.both_ways = !out.body.empty() && random_.chance(15);
    out.labelled = random_.chance(85);
    return out;
  }

  bool exists(const Literal& literal, int time) const {
    if (literal.kind == Kind::kPredicate) return true;
    const auto t = literal.fixed ? literal.shift : time + literal.shift;
    return t <= (literal.kind == Kind::kEvent ? shape_.horizon - 1 : shape_.horizon);
  }
  std::size_t place(const Literal& literal, int time) const {
    const auto t = static_cast<std::size_t>(literal.fixed ? literal.shift : time + literal.shift);
    const auto points = static_cast<std::size_t>(shape_.horizon) + 1;
    if (literal.kind == Kind::kPredicate) return literal.index;
    if (literal.kind == Kind::kFluent) {
      return shape_.predicates + literal.index * points + t;
    }
    return shape_.predicates + shape_.fluents * points + literal.index * (points - 1) + t;
  }

  void ground() {
    const auto points = static_cast<std::size_t>(shape_.horizon) + 1;
    bits_ = shape_.predicates + shape_.fluents * points + shape_.events * (points - 1);
    for (std::size_t p = 0; p < bits_; ++p) {
      const bool predicate = p < shape_.predicates;
      const bool fluent = !predicate && p < shape_.predicates + shape_.fluents * points;
      const bool completed =
          predicate ? p < shape_.closed_predicates : !fluent || shape_.fluents_completed;
      if (completed) completed_ |= Bits{1} << p;
    }
    for (const auto& rule : rules_) ground(rule);
  }
  void ground(const Rule& rule) {
    bool any = false;
    const auto timed = rule.text(false).find("[time]") != std::string::npos;
    for (int time = 0; time <= (timed ? shape_.horizon : 0); ++time) {
      const auto is_there = [&](const Literal& one) { return exists(one, time); };
      if (!std::all_of(rule.body.begin(), rule.body.end(), is_there)) continue;
      if (!std::all_of(rule.heads.begin(), rule.heads.end(), is_there)) continue;
      any = true;
      instance(rule, time);
    }
    silent_ = silent_ || !any;
  }
  void add(Clause& clause, const Literal& literal, bool positive, int time) const {
    (positive ? clause.positive : clause.negative) |= Bits{1} << place(literal, time);
  }
  /// `body -> heads`, and `heads -> body`.
  void instance(const Rule& rule, int time) {
    const bool is_reason = !shape_.labels || rule.labelled;
    Clause body{0, 0, is_reason};
    for (const auto& one : rule.body) add(body, one, !one.positive, time);
    if (rule.disjunction) {
      auto all = body;
      for (const auto& head : rule.heads) add(all, head, true, time);
      clauses_.push_back(all);
    } else {
      for (const auto& head : rule.heads) {
        clauses_.push_back(body);
        add(clauses_.back(), head, true, time);
      }
    }
    if (!rule.both_ways) return;
    for (const auto& one : rule.body) {
      Clause back{0, 0, is_reason};
      add(back, one, one.positive, time);
      if (rule.disjunction) {
        for (const auto& head : rule.heads) {
          clauses_.push_back(back);
          add(clauses_.back(), head, false, time);
        }
      } else {
        for (const auto& head : rule.heads) add(back, head, false, time);
        clauses_.push_back(back);
      }
    }
  }

  FuzzRandom random_;
  Shape shape_;
  std::vector<Rule> rules_;
  std::vector<Clause> clauses_;
  Bits completed_ = 0;
  std::size_t bits_ = 0;
  bool silent_ = false;
};

struct Figures {
  int compared = 0, refused = 0, smaller = 0;  // smaller: completion alone has more traces
};

void compare(const Model& model, Figures& figures) {
  const auto text = model.text();
  CAPTURE(text);
  const FuzzCompilation made(text, {});
  REQUIRE_MESSAGE(made.typed, made.codes());
  const auto codes = made.codes();
  CAPTURE(codes);
  std::set<Bits> satisfying;
  for (Bits truth = 0; truth != Bits{1} << model.atoms(); ++truth) {
    if (model.satisfies(truth)) satisfying.insert(truth);
  }
  if (!made.compiled) {
    ++figures.refused;
    const auto has = [&](const std::string& code) { return codes.find(code) != std::string::npos; };
    CHECK((has("E3003") || has("E3004") || has("E3022")));
    if (has("E3003")) CHECK(satisfying.empty());
    if (has("E3004")) CHECK_FALSE(model.says_something());
    if (has("E3022")) CHECK(model.has_split_circle());
    return;
  }
  const auto found = solver_valuations(*made.compiled, 10'000);
  REQUIRE(found.complete);
  std::set<std::string> ours, stable, minimal, observed;
  for (const auto& trace : found.traces) {
    ours.insert(Model::key(trace));
    observed.insert(trace_key(trace, false));
  }
  for (const auto truth : satisfying) {
    if (model.is_stable(truth)) stable.insert(model.key(truth, *found.predicates));
    if (model.is_minimal(truth)) minimal.insert(model.key(truth, *found.predicates));
  }
  CHECK(ours == minimal);
  if (!model.has_split_circle()) CHECK(ours == stable);
  const auto enumerated = enumerated_traces(*made.compiled, 10'000);
  CHECK(enumerated.traces.size() == observed.size());
  CHECK(counted_traces(*made.compiled) == std::to_string(observed.size()));
  ++figures.compared;
  auto unfounded = text;
  unfounded.replace(unfounded.find("founded on"), 10, "founded off");
  const FuzzCompilation plain(unfounded, {});
  REQUIRE(plain.compiled);
  const auto more = solver_valuations(*plain.compiled, 10'000);
  CHECK(more.traces.size() >= found.traces.size());
  if (more.traces.size() > found.traces.size()) ++figures.smaller;
}

TEST_CASE("founded traces are the stable and the minimal models of cyclic definitions") {
  const std::uint64_t count = is_deep() ? 4'000 : 300;
  Figures figures;
  for (std::uint64_t seed = 1; seed <= count; ++seed) compare(Model(seed), figures);
  MESSAGE(figures.compared << " models compared, " << figures.smaller
                           << " with fewer traces than completion leaves, " << figures.refused
                           << " refused");
  CHECK(figures.compared > static_cast<int>(count / 2));
  CHECK(figures.smaller > static_cast<int>(count / 20));
}

/// Can the model be written as a logic program? E3051 says where not.
bool is_exported(const std::string& text) {
  FuzzCompilation made(text, {});
  return made.typed && compiler::to_asp(*made.typed, made.files, {}, made.sink).has_value();
}

/// Compares all oracles on a founded model; clingo only if it is exported. Was it?
bool compare_founded(const std::string& text, bool clingo) {
  CAPTURE(text);
  DifferentialOptions options;
  options.clingo = clingo && is_exported(text);
  const auto result = compare_oracles(text, options);
  CAPTURE(result.code);
  CAPTURE(result.detail);
  // A circle may be broken by what a way of grounding leaves out, and refused by the others.
  const bool other_refuses = result.code.starts_with("grounding") && result.detail == "E3022";
  CHECK((result.kind != Comparison::Kind::kDiffer || other_refuses));
  return options.clingo;
}

TEST_CASE("evaluator, logic program and all ways of grounding agree on founded traces") {
  const bool installed = clingo_is_installed();
  const std::uint64_t count = is_deep() ? 400 : 40;
  std::uint64_t exported = 0;
  for (std::uint64_t seed = 10'001; seed <= 10'000 + count; ++seed) {
    exported += compare_founded(Model(seed).text(), installed) ? 1 : 0;
  }
  if (installed) CHECK(exported > count / 4);
}

TEST_CASE("they agree on founded models of all constructs, counts and effects of effects") {
  const bool installed = clingo_is_installed();
  const std::uint64_t count = is_deep() ? 600 : 40;
  RandomAdditions additions;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    additions.effect_constraints = seed % 2 == 0;
    additions.aggregates = seed % 3 == 0;
    const auto model = random_model(seed, kBruteForceSize, additions);
    compare_founded("option founded on\n" + model.print(), installed);
  }
}

}  // namespace
}  // namespace parallax::test
