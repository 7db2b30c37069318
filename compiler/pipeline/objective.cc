#include "compiler/pipeline/objective.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "compiler/artifact/describe.h"
#include "compiler/base/codes/grounding.h"
#include "compiler/base/codes/texts.h"
#include "compiler/ground/conjuncts.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

/// Where the parts of an objective stand.
struct SumText {
  Token word;  // `count`, `sum`
  std::optional<base::SourceRange> weight;
  base::SourceRange formula;
};

base::Reported malformed(const base::SourceRange& at, const std::string& found,
                         base::DiagnosticSink& sink) {
  return sink.error(codes::kObjectiveForm, at, found);
}

/// Splits at the commas and the colon that stand in no bracket. Text that is no token is left to
/// the parsers of the parts.
base::Result<std::vector<SumText>> split(const base::SourceRange& range,
                                         const base::SourceFiles& files,
                                         base::DiagnosticSink& sink) {
  base::DiagnosticSink unread;
  Lexer lexer(range, files[range.file].text(), Lexer::Mode::kFormulaOnly, unread);
  std::vector<SumText> sums;
  while (true) {
    const auto word = lexer.next();
    const auto name = word.kind == TokenKind::kName ? lexer.text(word) : "";
    if (name != "count" && name != "sum") {
      return malformed(lexer.range(word), lexer.describe(word), sink);
    }
    auto begin = word.end;
    std::optional<base::SourceRange> weight;
    int depth = 0;
    auto token = lexer.peek();
    for (;; token = lexer.peek()) {
      const auto kind = token.kind;
      if (kind == TokenKind::kEnd || (kind == TokenKind::kComma && depth == 0)) break;
      (void)lexer.next();
      if (kind == TokenKind::kOpenParen || kind == TokenKind::kOpenBracket ||
          kind == TokenKind::kOpenBrace) {
        ++depth;
      } else if (kind == TokenKind::kCloseParen || kind == TokenKind::kCloseBracket ||
                 kind == TokenKind::kCloseBrace) {
        --depth;
      } else if (kind == TokenKind::kColon && depth == 0 && !weight && name == "sum") {
        weight = base::SourceRange{range.file, begin, token.begin};
        begin = token.end;
      }
    }
    if (name == "sum" && !weight) return malformed(lexer.range(token), lexer.describe(token), sink);
    sums.push_back({word, weight, {range.file, begin, token.begin}});
    if (token.kind == TokenKind::kEnd) return sums;
    (void)lexer.next();
  }
}

base::Result<CheckedSum> check(const SumText& text, TypedModel& model,
                               const base::SourceFiles& files, base::DiagnosticSink& sink) {
  auto formula = parse_formula(text.formula, files, sink);
  if (!formula) return sink.already_reported();
  if (!text.weight) return check_sum(model, {&formula->ast, formula->root}, std::nullopt, sink);
  auto weight = parse_formula(*text.weight, files, sink);
  if (!weight) return sink.already_reported();
  return check_sum(model, {&formula->ast, formula->root}, TreePart{&weight->ast, weight->root},
                   sink);
}

/// Grounds the instances of an objective: a weight for each formula that is counted.
class ObjectiveGrounder {
 public:
  ObjectiveGrounder(const CheckedObjective& objective, GroundModel& model,
                    FormulaGrounder& grounder, base::DiagnosticSink& sink)
      : objective_(objective),
        model_(model),
        grounder_(grounder),
        sink_(sink),
        origin_(model.add_origin(objective.source, OriginKind::kObjective)) {}

  base::Status run() {
    for (const auto& sum : objective_.sums) {
      if (!add(sum)) return sink_.already_reported();
    }
    if (!has_atom_) return sink_.error(codes::kObjectiveEmpty, objective_.source);
    GroundObjective out{objective_.text, {}};
    std::int64_t total = 0;
    for (const auto& [key, weight] : weights_) {
      const auto magnitude = weight < 0 ? -weight : weight;
      if (__builtin_add_overflow(total, magnitude, &total) || total >= kMostObjectiveWeight) {
        return sink_.error(codes::kObjectiveTooLarge, objective_.source);
      }
      if (weight != 0) out.terms.push_back({weight, literal(key.second, key.first), key.first});
    }
    model_.add_objective(std::move(out));
    return base::Unit{};
  }

 private:
  base::Status add(const CheckedSum& sum) {
    grounder_.start(objective_.source);
    const auto& variables = sum.variables;
    std::vector<GroundTermId> instances;
    if (!variables.empty()) {
      instances = grounder_.instances(variables, conjuncts_of(model_.typed(), sum.formula, false));
    }
    const auto count = variables.empty() ? 1 : instances.size() / variables.size();
    for (std::size_t i = 0; i < count && !grounder_.failed(); ++i) {
      const auto instance = std::span(instances).subspan(i * variables.size(), variables.size());
      for (std::size_t v = 0; v < variables.size(); ++v) grounder_.bind(variables[v], instance[v]);
      if (!add_instance(sum, instance)) return sink_.already_reported();
    }
    for (const auto variable : variables) grounder_.unbind(variable);
    if (grounder_.failed()) return sink_.already_reported();
    return base::Unit{};
  }

  base::Status add_instance(const CheckedSum& sum, std::span<const GroundTermId> instance) {
    std::int64_t weight = 1;
    if (sum.weight) {
      const auto value = grounder_.term(*sum.weight);
      if (grounder_.failed()) return sink_.already_reported();
      if (!value) return base::Unit{};
      weight = model_.terms()[*value].integer;
    }
    const auto formula = grounder_.ground(sum.formula);
    if (grounder_.failed()) return sink_.already_reported();
    if (!formula) return base::Unit{};
    if (*formula == model_.formulas().falsity()) return base::Unit{};
    has_atom_ = has_atom_ || *formula != model_.formulas().truth();
    auto needed = model_.needed_horizon_of(*formula);
    const auto& typed = model_.typed();
    for (std::size_t v = 0; v < instance.size(); ++v) {
      if (typed.variables[sum.variables[v]].sort != typed.core.time) continue;
      needed = std::max(needed, static_cast<Timepoint>(model_.terms()[instance[v]].integer));
    }
    auto& known = weights_[{needed, *formula}];
    if (__builtin_add_overflow(known, weight, &known) || known >= kMostObjectiveWeight ||
        known <= -kMostObjectiveWeight) {
      return sink_.error(codes::kObjectiveTooLarge, objective_.source);
    }
    return base::Unit{};
  }

  /// The formula, or an atom that says the same.
  FormulaId literal(FormulaId formula, Timepoint needed) {
    auto& formulas = model_.formulas();
    if (formulas.kind(formula) != FormulaNodeKind::kAnd) return formula;
    const auto atom = model_.auxiliary_atom(needed);
    model_.require(formulas.equivalence(atom, formula), origin_);
    return atom;
  }

  const CheckedObjective& objective_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::uint32_t origin_;
  std::map<std::pair<Timepoint, FormulaId>, std::int64_t> weights_;
  bool has_atom_ = false;
};

}  // namespace

base::Result<CheckedObjective> check_objective(const base::SourceRange& range, TypedModel& model,
                                               const base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  const auto texts = split(range, files, sink);
  if (!texts) return sink.already_reported();
  CheckedObjective objective{one_line(files.text(range)), range, {}};
  bool fine = true;
  for (const auto& text : *texts) {
    auto sum = check(text, model, files, sink);
    if (sum) objective.sums.push_back(*std::move(sum));
    fine = fine && sum.has_value();
  }
  if (!fine) return sink.already_reported();
  return objective;
}

base::Status encode_objective(const CheckedObjective& objective, GroundModel& model,
                              FormulaGrounder& grounder, base::DiagnosticSink& sink) {
  return ObjectiveGrounder(objective, model, grounder, sink).run();
}

}  // namespace parallax::compiler
