#include "compiler/sema/calculus_axioms.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/elaborator.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

using Part = ClauseShape::Part;
using Clause = std::vector<Part>;

// Larger formulas are none of the axioms; this bounds the recursion below as well.
constexpr std::uint32_t kMostNodes = 120;
constexpr std::size_t kMostClauses = 16;
constexpr std::size_t kMostLiterals = 12;

/// The calculus in the ways it is written: with the intervals of Mueller 2006 (StoppedIn) and those
/// of Mueller 2004 (Clipped), effects taken together or one by one.
constexpr std::string_view kAxioms = R"(
[event,fluent1,fluent2,time,offset]
Happens(event,time) & Initiates(event,fluent1,time) & 0<offset &
Trajectory(fluent1,time,fluent2,offset) & !Clipped(time,fluent1,time+offset) ->
HoldsAt(fluent2,time+offset).
[event,fluent1,fluent2,time,offset]
Happens(event,time) & Initiates(event,fluent1,time) & 0<offset &
Trajectory(fluent1,time,fluent2,offset) & !StoppedIn(time,fluent1,time+offset) ->
HoldsAt(fluent2,time+offset).
[event,fluent1,fluent2,time,offset]
Happens(event,time) & Terminates(event,fluent1,time) & 0<offset &
AntiTrajectory(fluent1,time,fluent2,offset) & !Declipped(time,fluent1,time+offset) ->
HoldsAt(fluent2,time+offset).
[event,fluent1,fluent2,time,offset]
Happens(event,time) & Terminates(event,fluent1,time) & 0<offset &
AntiTrajectory(fluent1,time,fluent2,offset) & !StartedIn(time,fluent1,time+offset) ->
HoldsAt(fluent2,time+offset).
[fluent,time]
HoldsAt(fluent,time) & !ReleasedAt(fluent,time+1) &
!({event} Happens(event,time) & Terminates(event,fluent,time)) -> HoldsAt(fluent,time+1).
[fluent,time]
!HoldsAt(fluent,time) & !ReleasedAt(fluent,time+1) &
!({event} Happens(event,time) & Initiates(event,fluent,time)) -> !HoldsAt(fluent,time+1).
[fluent,time]
ReleasedAt(fluent,time) &
!({event} Happens(event,time) & (Initiates(event,fluent,time) | Terminates(event,fluent,time))) ->
ReleasedAt(fluent,time+1).
[fluent,time]
ReleasedAt(fluent,time) & !({event} Happens(event,time) & Initiates(event,fluent,time)) &
!({event} Happens(event,time) & Terminates(event,fluent,time)) -> ReleasedAt(fluent,time+1).
[fluent,time]
ReleasedAt(fluent,time) &
!({event} (Happens(event,time) & Initiates(event,fluent,time)) |
          (Happens(event,time) & Terminates(event,fluent,time))) -> ReleasedAt(fluent,time+1).
[fluent,time]
!ReleasedAt(fluent,time) & !({event} Happens(event,time) & Releases(event,fluent,time)) ->
!ReleasedAt(fluent,time+1).
[event,fluent,time]
Happens(event,time) & Initiates(event,fluent,time) -> HoldsAt(fluent,time+1).
[event,fluent,time]
Happens(event,time) & Terminates(event,fluent,time) -> !HoldsAt(fluent,time+1).
[event,fluent,time]
Happens(event,time) & Releases(event,fluent,time) -> ReleasedAt(fluent,time+1).
[event,fluent,time]
Happens(event,time) & (Initiates(event,fluent,time) | Terminates(event,fluent,time)) ->
!ReleasedAt(fluent,time+1).
)";

constexpr std::string_view kDefinitions = R"(
[time1,fluent,time2]
Clipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Terminates(event,fluent,time).
[time1,fluent,time2]
Declipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Initiates(event,fluent,time).
[time1,fluent,time2]
StoppedIn(time1,fluent,time2) <->
{event,time} time1<time & time<time2 & Happens(event,time) & Terminates(event,fluent,time).
[time1,fluent,time2]
StartedIn(time1,fluent,time2) <->
{event,time} time1<time & time<time2 & Happens(event,time) & Initiates(event,fluent,time).
)";

constexpr std::array<std::string_view, 4> kIntervals = {"Clipped", "Declipped", "StoppedIn",
                                                        "StartedIn"};

NodeId body_of(const Ast& ast, NodeId id) {
  while (ast[id].kind == NodeKind::kForall) id = ast.child(ast[id], ast[id].child_count - 1);
  return id;
}

}  // namespace

/// Negation normal form, then clauses.
class ShapeMaker {
 public:
  explicit ShapeMaker(const Ast& ast) : ast_(ast) {}

  std::optional<ClauseShape> make(NodeId root) {
    ClauseShape shape;
    shape.ast_ = &ast_;
    const auto whole = part(root, false);
    if (!whole || !clauses(*whole, shape.clauses_)) return std::nullopt;
    return shape;
  }

 private:
  /// A universal quantifier is its body: variables stand for all their values unless some kExists
  /// says otherwise. None: the formula has something in it that is in none of those looked for.
  std::optional<Part> part(NodeId id, bool negated) const {
    const Node& node = ast_[id];
    Part made;
    switch (node.kind) {
      case NodeKind::kName:
      case NodeKind::kNumber:
      case NodeKind::kCount:
      case NodeKind::kSum:
        return std::nullopt;
      case NodeKind::kApply:
        made.node = id;
        made.negated = negated;
        return made;
      case NodeKind::kUnary:
        if (node.op != Operator::kNot) return std::nullopt;
        return part(ast_.child(node, 0), !negated);
      case NodeKind::kForall:
      case NodeKind::kExists: {
        auto body = part(ast_.child(node, node.child_count - 1), negated);
        if (!body || (node.kind == NodeKind::kForall) != negated) return body;
        made.kind = Part::Kind::kExists;
        for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
          made.variables.push_back(ast_.name(ast_[ast_.child(node, i)]));
        }
        made.parts.push_back(*std::move(body));
        return made;
      }
      case NodeKind::kBinary:
        return binary(node, negated);
    }
    return std::nullopt;
  }

  std::optional<Part> binary(const Node& node, bool negated) const {
    if (is_comparison(node.op)) return comparison(node, negated);
    if (node.op == Operator::kAnd || node.op == Operator::kOr) {
      std::vector<std::pair<NodeId, bool>> children;
      for (std::uint32_t i = 0; i < node.child_count; ++i) {
        children.emplace_back(ast_.child(node, i), negated);
      }
      return junction((node.op == Operator::kAnd) != negated, children);
    }
    if (node.op == Operator::kImplies) {
      return junction(negated, {{ast_.child(node, 0), !negated}, {ast_.child(node, 1), negated}});
    }
    if (node.op != Operator::kIff) return std::nullopt;
    const auto a = ast_.child(node, 0), b = ast_.child(node, 1);
    auto forth = junction(false, {{a, !negated}, {b, false}});
    auto back = junction(false, {{a, negated}, {b, true}});
    if (!forth || !back) return std::nullopt;
    return joined(true, {*std::move(forth), *std::move(back)});
  }

  std::optional<Part> junction(bool conjunction,
                               const std::vector<std::pair<NodeId, bool>>& children) const {
    std::vector<Part> parts;
    for (const auto& [child, negated] : children) {
      auto made = part(child, negated);
      if (!made) return std::nullopt;
      parts.push_back(*std::move(made));
    }
    return joined(conjunction, std::move(parts));
  }

  static Part joined(bool conjunction, std::vector<Part> parts) {
    Part whole;
    whole.kind = conjunction ? Part::Kind::kAnd : Part::Kind::kOr;
    for (auto& part : parts) {
      if (part.kind == whole.kind) {
        std::move(part.parts.begin(), part.parts.end(), std::back_inserter(whole.parts));
      } else {
        whole.parts.push_back(std::move(part));
      }
    }
    return whole;
  }

  /// `=`, `<` and `<=` are enough.
  Part comparison(const Node& node, bool negated) const {
    Part made;
    made.kind = Part::Kind::kCompare;
    made.left = ast_.child(node, 0);
    made.right = ast_.child(node, 1);
    made.op = node.op;
    if (node.op == Operator::kEqual || node.op == Operator::kNotEqual) {
      made.negated = negated != (node.op == Operator::kNotEqual);
      made.op = Operator::kEqual;
      return made;
    }
    bool strict = node.op == Operator::kLess || node.op == Operator::kGreater;
    bool turned = node.op == Operator::kGreater || node.op == Operator::kGreaterEqual;
    if (negated) {
      strict = !strict;
      turned = !turned;
    }
    if (turned) std::swap(made.left, made.right);
    made.op = strict ? Operator::kLess : Operator::kLessEqual;
    return made;
  }

  /// False: too many.
  bool clauses(const Part& whole, std::vector<Clause>& out) const {
    if (whole.kind == Part::Kind::kAnd) {
      for (const auto& part : whole.parts) {
        if (!clauses(part, out)) return false;
      }
      return true;
    }
    std::vector<Clause> made = {{}};
    const std::vector<Part> one = {whole};
    for (const auto& part : whole.kind == Part::Kind::kOr ? whole.parts : one) {
      std::vector<Clause> ways;
      if (part.kind == Part::Kind::kAnd) {
        if (!clauses(part, ways)) return false;
      } else {
        ways = {{part}};
      }
      if (made.size() * ways.size() > kMostClauses) return false;
      std::vector<Clause> longer;
      for (const auto& before : made) {
        for (const auto& way : ways) {
          longer.push_back(before);
          longer.back().insert(longer.back().end(), way.begin(), way.end());
        }
      }
      made = std::move(longer);
    }
    std::move(made.begin(), made.end(), std::back_inserter(out));
    return out.size() <= kMostClauses &&
           std::all_of(out.begin(), out.end(),
                       [](const Clause& clause) { return clause.size() <= kMostLiterals; });
  }

  const Ast& ast_;
};

namespace {

/// Pairs the parts of two clauses, trying each order, and the variables with them.
class ShapeMatcher {
 public:
  ShapeMatcher(const Ast& ast, const Ast& pattern_ast) : ast_(ast), pattern_ast_(pattern_ast) {}

  bool same(const Clause& a, const Clause& pattern) {
    names_.clear();
    return unordered(a, pattern, [] { return true; });
  }

 private:
  using Names = std::map<std::string_view, std::string_view>;

  /// Both lists paired in some order so that `then` is true afterwards.
  template <typename Then>
  bool unordered(const std::vector<Part>& a, const std::vector<Part>& pattern, const Then& then) {
    if (a.size() != pattern.size()) return false;
    std::vector<bool> used(a.size(), false);
    return pair_from(0, a, pattern, used, then);
  }

  template <typename Then>
  bool pair_from(std::size_t next, const std::vector<Part>& a, const std::vector<Part>& pattern,
                 std::vector<bool>& used, const Then& then) {
    if (next == pattern.size()) return then();
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (used[i]) continue;
      const auto names = names_;
      used[i] = true;
      if (part(a[i], pattern[next]) && pair_from(next + 1, a, pattern, used, then)) return true;
      used[i] = false;
      names_ = names;
    }
    return false;
  }

  bool part(const Part& a, const Part& pattern) {
    if (a.kind != pattern.kind || a.negated != pattern.negated) return false;
    switch (a.kind) {
      case Part::Kind::kAtom:
        return term(a.node, pattern.node);
      case Part::Kind::kCompare:
        return a.op == pattern.op && term(a.left, pattern.left) && term(a.right, pattern.right);
      case Part::Kind::kExists: {
        // An existential formula depends on the sorts of its variables.
        const auto sorts = [](const Part& exists) {
          std::vector<std::string_view> all;
          for (const auto name : exists.variables) all.push_back(sort_of_variable(name));
          std::sort(all.begin(), all.end());
          return all;
        };
        if (sorts(a) != sorts(pattern)) return false;
        // The same name may be bound again beside it.
        const auto outside = names_;
        for (const auto name : a.variables) names_.erase(name);
        if (!unordered(a.parts, pattern.parts, [] { return true; })) return false;
        for (const auto name : a.variables) {
          names_.erase(name);
          if (const auto before = outside.find(name); before != outside.end()) {
            names_.insert(*before);
          }
        }
        return true;
      }
      case Part::Kind::kAnd:
      case Part::Kind::kOr:
        return unordered(a.parts, pattern.parts, [] { return true; });
    }
    return false;
  }

  bool term(NodeId a_id, NodeId pattern_id) {
    const Node& a = ast_[a_id];
    const Node& pattern = pattern_ast_[pattern_id];
    if (a.kind != pattern.kind) return false;
    switch (a.kind) {
      case NodeKind::kName:
        return name(ast_.name(a), pattern_ast_.name(pattern));
      case NodeKind::kNumber:
        return ast_.name(a) == pattern_ast_.name(pattern);
      case NodeKind::kApply:
        if (ast_.name(a) != pattern_ast_.name(pattern)) return false;
        return terms_in_order(a, pattern);
      case NodeKind::kBinary: {
        if (a.op != pattern.op || a.child_count != 2 || pattern.child_count != 2) return false;
        const auto names = names_;
        if (terms_in_order(a, pattern)) return true;
        names_ = names;
        return a.op == Operator::kAdd && term(ast_.child(a, 0), pattern_ast_.child(pattern, 1)) &&
               term(ast_.child(a, 1), pattern_ast_.child(pattern, 0));
      }
      case NodeKind::kUnary:
      case NodeKind::kForall:
      case NodeKind::kExists:
      case NodeKind::kCount:
      case NodeKind::kSum:
        return false;
    }
    return false;
  }

  bool terms_in_order(const Node& a, const Node& pattern) {
    if (a.child_count != pattern.child_count) return false;
    for (std::uint32_t i = 0; i < a.child_count; ++i) {
      if (!term(ast_.child(a, i), pattern_ast_.child(pattern, i))) return false;
    }
    return true;
  }

  /// Names in patterns are variables; a constant beside one is the name of no variable's sort, and
  /// two variables never stand for one.
  bool name(std::string_view a, std::string_view pattern) {
    if (a.empty() || a[0] < 'a' || a[0] > 'z') return false;
    const auto [entry, added] = names_.emplace(a, pattern);
    if (!added) return entry->second == pattern;
    return std::count_if(names_.begin(), names_.end(),
                         [&](const auto& pair) { return pair.second == pattern; }) == 1;
  }

  const Ast& ast_;
  const Ast& pattern_ast_;
  Names names_;  // to the pattern's
};

}  // namespace

std::optional<ClauseShape> ClauseShape::of(const Ast& ast, const Statement& formula) {
  if (formula.formula.index() - formula.first_node.index() > kMostNodes) return std::nullopt;
  return ShapeMaker(ast).make(formula.formula);
}

bool ClauseShape::same_as(const ClauseShape& pattern) const {
  if (clauses_.size() != pattern.clauses_.size()) return false;
  std::vector<bool> used(clauses_.size(), false);
  return std::all_of(clauses_.begin(), clauses_.end(), [&](const Clause& clause) {
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] || !ShapeMatcher(*ast_, *pattern.ast_).same(clause, pattern.clauses_[i]))
        continue;
      used[i] = true;
      return true;
    }
    return false;
  });
}

bool ClauseShape::all_among(const std::vector<ClauseShape>& patterns) const {
  return std::all_of(clauses_.begin(), clauses_.end(), [&](const Clause& clause) {
    return std::any_of(patterns.begin(), patterns.end(), [&](const ClauseShape& pattern) {
      ShapeMatcher matcher(*ast_, *pattern.ast_);
      return std::any_of(pattern.clauses_.begin(), pattern.clauses_.end(),
                         [&](const Clause& other) { return matcher.same(clause, other); });
    });
  });
}

CalculusAxioms::CalculusAxioms() {
  base::DiagnosticSink sink;
  asts_.reserve(2);
  for (const auto text : {kAxioms, kDefinitions}) {
    const auto file = files_.add("axioms", std::string(text));
    asts_.push_back(parse_file(file, files_, sink));
    auto& shapes = asts_.size() == 1 ? axioms_ : definitions_;
    for (const auto& statement : asts_.back().statements()) {
      if (auto shape = ClauseShape::of(asts_.back(), statement))
        shapes.push_back(*std::move(shape));
    }
  }
}

bool CalculusAxioms::is_usual_definition(const ClauseShape& shape) const {
  return std::any_of(definitions_.begin(), definitions_.end(),
                     [&](const ClauseShape& definition) { return shape.same_as(definition); });
}

std::optional<std::string_view> CalculusAxioms::defined_interval(const Ast& ast, NodeId formula) {
  const Node& body = ast[body_of(ast, formula)];
  if (body.kind != NodeKind::kBinary || body.op != Operator::kIff) return std::nullopt;
  for (std::uint32_t i = 0; i < body.child_count; ++i) {
    const Node& side = ast[ast.child(body, i)];
    if (side.kind != NodeKind::kApply) continue;
    const auto found = std::find(kIntervals.begin(), kIntervals.end(), ast.name(side));
    if (found != kIntervals.end()) return *found;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
