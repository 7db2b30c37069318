#include "tests/support/random_temporal.h"

#include <algorithm>

namespace parallax::test {
namespace {

using Truth = std::optional<bool>;

/// "HoldsAt(On(thing),time-1)" of a trace.
Truth atom_value(std::string atom, const compiler::Valuation& trace, int t,
                 const std::string& thing) {
  const auto variable = atom.find("thing");
  if (variable != std::string::npos) atom.replace(variable, 5, thing);
  if (atom.ends_with("-1)")) --t;
  if (t < 0) return std::nullopt;
  const auto open = atom.find('(') + 1;
  const auto name = atom.substr(open, atom.rfind(',') - open);
  const auto& points = atom.starts_with("Happens") ? trace.happens : trace.holds;
  return points[static_cast<std::size_t>(t)].contains(name);
}

std::string literal(FuzzRandom& random, const std::vector<std::string>& atoms) {
  return (random.chance(40) ? "!" : "") + random.pick(atoms);
}

}  // namespace

std::string TemporalFormula::print() const {
  if (op.empty()) return text;
  if (parts.size() == 1) return op + " (" + parts[0].print() + ")";
  return "(" + parts[0].print() + ") " + op + " (" + parts[1].print() + ")";
}

bool TemporalFormula::has(const std::vector<std::string>& ops) const {
  return std::find(ops.begin(), ops.end(), op) != ops.end() ||
         std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return part.has(ops); });
}

Truth TemporalFormula::value(const compiler::Valuation& trace, int t,
                             const std::string& thing) const {
  const int last = static_cast<int>(trace.holds.size()) - 1;
  if (op.empty()) return atom_value(text, trace, t, thing);
  const auto part = [&](std::size_t i, int at) { return parts[i].value(trace, at, thing); };
  const auto all = [&](std::size_t i, int first, int end) {
    for (int k = first; k <= end; ++k) {
      if (!part(i, k).value_or(true)) return false;
    }
    return true;
  };
  const auto some = [&](std::size_t i, int first, int end) {
    for (int k = first; k <= end; ++k) {
      if (part(i, k).value_or(false)) return true;
    }
    return false;
  };
  if (op == "always") return all(0, t, last);
  if (op == "eventually") return some(0, t, last);
  if (op == "historically") return all(0, 0, t);
  if (op == "once") return some(0, 0, t);
  if (op == "next") return t < last ? part(0, t + 1) : Truth(false);
  if (op == "weak_next") return t < last ? part(0, t + 1) : Truth(true);
  if (op == "previously") return t > 0 ? part(0, t - 1) : Truth(false);
  if (op == "until" || op == "since") {
    for (int k = 0; k <= last; ++k) {
      if (!part(1, k).value_or(false)) continue;
      if (op == "until" && k >= t && all(0, t, k - 1)) return true;
      if (op == "since" && k <= t && all(0, k + 1, t)) return true;
    }
    return false;
  }
  if (op == "[thing]" || op == "{thing}") {
    const auto a = parts[0].value(trace, t, "A"), b = parts[0].value(trace, t, "B");
    if (!a || !b) return a ? a : b;
    return op == "[thing]" ? *a && *b : *a || *b;
  }
  const auto a = part(0, t);
  if (op == "!") return a ? Truth(!*a) : std::nullopt;
  const auto b = part(1, t);
  if (!a || !b) return std::nullopt;
  if (op == "&") return *a && *b;
  if (op == "|") return *a || *b;
  if (op == "->") return !*a || *b;
  return *a == *b;  // <->
}

TemporalFormula random_temporal(FuzzRandom& random, int depth, bool bound) {
  if (depth == 0 || random.chance(15)) {
    std::vector<std::string> atoms = {"HoldsAt(G(),time)", "HoldsAt(On(A),time)",
                                      "HoldsAt(On(B),time)", "Happens(Push(A),time)",
                                      "Happens(Push(B),time)"};
    if (random.chance(20)) atoms = {"HoldsAt(G(),time-1)", "Happens(Push(A),time-1)"};
    if (bound && random.chance(60))
      atoms = {"HoldsAt(On(thing),time)", "Happens(Push(thing),time)"};
    return {{}, random.pick(atoms), {}};
  }
  static const std::vector<std::string> kUnary = {
      "always", "eventually", "next", "weak_next", "historically", "once", "!", "previously"};
  static const std::vector<std::string> kBinary = {"until", "since", "&", "|", "->", "<->"};
  if (!bound && random.chance(15)) {
    return {
        random.chance(50) ? "[thing]" : "{thing}", {}, {random_temporal(random, depth - 1, true)}};
  }
  if (random.chance(55)) {
    return {random.pick(kUnary), {}, {random_temporal(random, depth - 1, bound)}};
  }
  auto left = random_temporal(random, depth - 1, bound);
  return {random.pick(kBinary), {}, {std::move(left), random_temporal(random, depth - 1, bound)}};
}

std::string random_temporal_model(FuzzRandom& random) {
  const std::vector<std::string> states = {"HoldsAt(G(),time)", "HoldsAt(On(A),time)",
                                           "HoldsAt(On(B),time)", "HoldsAt(On(thing),time)"};
  std::string out = "sort thing\nthing A, B\nfluent On(thing)\nfluent G()\nevent Push(thing)\n";
  const auto condition = [&](int chance) {
    return random.chance(static_cast<std::size_t>(chance)) ? literal(random, states) + " -> " : "";
  };
  // An event that initiates a fluent does not terminate it.
  for (const auto* fluent : {"On(A)", "On(B)", "G()"}) {
    const auto* effect = random.chance(50) ? "Initiates" : "Terminates";
    if (random.chance(80)) {
      out += "[thing,time] " + condition(50) + effect + "(Push(thing)," + fluent + ",time).\n";
    }
  }
  if (random.chance(60)) {
    out += "[thing,time] Happens(Push(thing),time) -> " + literal(random, states) + ".\n";
  }
  if (random.chance(40)) {
    out += "[time] !Happens(Push(A),time) | !Happens(Push(B),time).\n";
  }
  // Axioms that demand something and axioms that rule it out can leave a state without a successor.
  const std::vector<std::string> plain(states.begin(), states.end() - 1);
  if (random.chance(40)) {
    const auto* pushed = random.chance(50) ? "A" : "B";
    const auto when = random.chance(30) ? "" : literal(random, plain) + " -> ";
    out += "[time] " + when + "Happens(Push(" + pushed + "),time).\n";
  }
  if (random.chance(30)) {
    out += "[time] !(" + literal(random, plain) + " & " + literal(random, plain) + ").\n";
  }
  if (random.chance(50)) {
    out += random.chance(50) ? "HoldsAt(G(),0).\n" : "[thing] !HoldsAt(On(thing),0).\n";
  }
  return out;
}

}  // namespace parallax::test
