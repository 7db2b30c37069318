// Definitions that a model lacks.
//
// A fluent without inertia holds where formulas about states say so; one that no equivalence
// defines is left open. Its definition is sought among `A & B`, `A | B` and `{x} A & B` of at most
// three literals, as one that is true of every state that was seen. A row is a state with values
// for the fluent's arguments, and a literal is a set of rows, with one set for each value of x. A
// conjunction is extended only while it covers all rows in which the fluent holds; disjunctions are
// conjunctions of the opposites. The definitions of the least size, and of the next, are proposed.
// Cost: literals to the third power, times rows and values of x, over 64.

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"
#include "compiler/repair/number_term.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostParts = 3;        // literals of a definition
constexpr std::size_t kMostBegun = 4000;     // sets of literals that are extended
constexpr std::size_t kMostFound = 8;        // definitions of one fluent
constexpr std::size_t kMostEachSymbol = 40;  // literals, or values of a sort
constexpr std::size_t kMostRows = 4000;
constexpr int kMissingDefinition = 4;  // oddity; a definition is rather wrong than forgotten

using SeenState = std::map<std::string, bool>;
using Values = std::map<std::string, std::string>;

/// A set of rows.
class RowSet {
 public:
  explicit RowSet(std::size_t rows) : words_((rows + 63) / 64) {}
  void add(std::size_t row) { words_[row / 64] |= std::uint64_t{1} << (row % 64); }
  bool covers(const RowSet& other) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if ((other.words_[i] & ~words_[i]) != 0) return false;
    }
    return true;
  }
  RowSet& operator&=(const RowSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
  }
  RowSet& operator|=(const RowSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }
  bool operator==(const RowSet&) const = default;

 private:
  std::vector<std::uint64_t> words_;
};

/// A literal, and where it is true: by value of the inner variable, or once.
struct Part {
  ConditionLiteral literal;
  std::vector<RowSet> rows;
};

RowSet any_of_slices(const std::vector<RowSet>& slices) {
  auto out = slices.front();
  for (const auto& slice : slices) out |= slice;
  return out;
}

/// Is the literal true in the state? None: it cannot be told.
std::optional<bool> truth(const ConditionLiteral& literal, const SeenState& state,
                          const Values& values) {
  if (literal.kind == ConditionLiteral::Kind::kEqual) return compares(literal, values);
  if (literal.kind != ConditionLiteral::Kind::kFluent) return std::nullopt;
  const auto pattern = atom_pattern(literal, values);
  if (literal.count(LiteralArgument::Kind::kSome) == 0) {
    const auto found = state.find(pattern);
    return (found != state.end() && found->second) != literal.negated;
  }
  const bool any = std::any_of(state.begin(), state.end(), [&](const auto& atom) {
    return atom.second && matches(atom.first, pattern);
  });
  return any != literal.negated;
}

/// Looks for definitions of one fluent.
class DefinitionSearch {
 public:
  DefinitionSearch(const EditSubject& subject, const Symbol& fluent)
      : subject_(subject),
        fluent_(fluent),
        variables_(variables_for(subject.typed, fluent.arguments)) {
    find_rows();
  }

  /// Bodies of definitions with their oddity: "HoldsAt(A(x),time) & ...". Empty: the fluent was
  /// always seen alike, or nothing fits.
  std::vector<std::pair<std::string, int>> bodies() {
    if (rows_.empty() || always(true) || always(false)) return {};
    const auto positive = rows_where(true), negative = rows_where(false);
    const auto own = parts({});
    search(own, positive, [&](const auto& set) { add(set, own, "", " & ", false); });
    search(own, negative, [&](const auto& set) { add(set, own, "", " | ", true); });
    for (const auto& sort : subject_.typed.sorts) {
      const auto inner = inner_variable(sort.name);
      if (!inner) continue;
      const auto all = parts(inner);
      search(all, positive,
             [&](const auto& set) { add(set, all, "{" + *inner + "} ", " & ", false); });
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const auto& a, const auto& b) { return a.second < b.second; });
    std::erase_if(found_,
                  [&](const auto& each) { return each.second > found_.front().second + 2; });
    if (found_.size() > kMostFound) found_.resize(kMostFound);
    return std::move(found_);
  }

  bool always(bool value) const {
    return std::all_of(rows_.begin(), rows_.end(),
                       [&](const Row& row) { return row.holds == value; });
  }
  bool is_seen() const { return !rows_.empty(); }

  std::string head() const {
    std::string arguments;
    for (const auto& variable : variables_) arguments += (arguments.empty() ? "" : ",") + variable;
    return "HoldsAt(" + fluent_.name + "(" + arguments + "),time)";
  }
  std::string quantified() const {
    std::string out = "[";
    for (const auto& variable : variables_) out += variable + ",";
    return out + "time] ";
  }

 private:
  struct Row {
    const SeenState* state;
    Values values;
    bool holds;
  };

  void find_rows() {
    for (const auto& state : subject_.scope.states) {
      for (const auto& [atom, holds] : state) {
        if (base::symbol_of(atom) != fluent_.name || rows_.size() == kMostRows) continue;
        Values values;
        const auto arguments = arguments_of(atom);
        for (std::size_t i = 0; i < std::min(arguments.size(), variables_.size()); ++i) {
          values[variables_[i]] = arguments[i];
        }
        rows_.push_back({&state, std::move(values), holds});
      }
    }
  }

  RowSet rows_where(bool value) const {
    RowSet out(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].holds == value) out.add(i);
    }
    return out;
  }

  /// A variable of the sort beside those of the fluent. None: the sort has no constants.
  std::optional<std::string> inner_variable(const std::string& sort) const {
    const auto id = subject_.typed.find_sort(sort);
    if (!id || id == subject_.typed.core.time) return std::nullopt;
    const auto constants = constants_of(subject_.typed, *id);
    if (constants.empty() || constants.size() > kMostEachSymbol) return std::nullopt;
    auto name = sort;
    for (int i = 1; std::find(variables_.begin(), variables_.end(), name) != variables_.end();
         ++i) {
      name = sort + std::to_string(i);
    }
    return name;
  }

  /// The literals over the fluent's variables, and over the inner one.
  std::vector<Part> parts(const std::optional<std::string>& inner) const {
    const auto& typed = subject_.typed;
    std::vector<SortedVariable> all;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      all.push_back({variables_[i], fluent_.arguments[i]});
    }
    std::vector<std::string> values = {""};
    if (inner) {
      const auto sort = *sort_of_variable(typed, *inner);
      all.push_back({*inner, sort});
      values = constants_of(typed, sort);
    }
    std::vector<Part> out;
    for (auto& literal : condition_literals(typed, all, kMostEachSymbol)) {
      if (literal.symbol == fluent_.name) continue;
      Part part{std::move(literal), std::vector<RowSet>(values.size(), RowSet(rows_.size()))};
      if (fill(part, inner, values)) out.push_back(std::move(part));
    }
    return out;
  }

  bool fill(Part& part, const std::optional<std::string>& inner,
            const std::vector<std::string>& values) const {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      auto row = rows_[i].values;
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (inner) row[*inner] = values[k];
        const auto holds = truth(part.literal, *rows_[i].state, row);
        if (!holds) return false;
        if (*holds) part.rows[k].add(i);
      }
    }
    return true;
  }

  /// Calls `take` for sets of parts, smallest first, of which some slice is true exactly in the
  /// rows of `wanted`.
  template <typename Take>
  void search(const std::vector<Part>& all, const RowSet& wanted, const Take& take) {
    struct Begun {
      std::vector<std::size_t> set;
      std::vector<RowSet> rows;
    };
    std::vector<Begun> begun(1);
    for (std::size_t size = 1; size <= kMostParts; ++size) {
      std::vector<Begun> next;
      const auto before = found_.size();
      for (const auto& base : begun) {
        for (std::size_t i = base.set.empty() ? 0 : base.set.back() + 1; i < all.size(); ++i) {
          auto rows = all[i].rows;
          for (std::size_t k = 0; k < base.rows.size(); ++k) rows[k] &= base.rows[k];
          const auto covered = any_of_slices(rows);
          if (!covered.covers(wanted) || (!base.rows.empty() && rows == base.rows)) continue;
          auto set = base.set;
          set.push_back(i);
          if (covered == wanted) {
            take(set);
          } else if (size < kMostParts && next.size() < kMostBegun) {
            next.push_back({std::move(set), std::move(rows)});
          }
        }
      }
      if (found_.size() > before) return;
      begun = std::move(next);
    }
  }

  void add(const std::vector<std::size_t>& set, const std::vector<Part>& all,
           const std::string& quantifier, const std::string& sign, bool opposite) {
    if (sign == " | " && set.size() == 1) return;  // the same as a conjunction
    auto taken = variables_;
    if (!quantifier.empty()) taken.push_back(quantifier.substr(1, quantifier.find('}') - 1));
    std::string body;
    int oddity = kMissingDefinition + 2 * static_cast<int>(set.size()) - 2;
    bool of_inner = quantifier.empty();
    for (const auto i : set) {
      auto literal = all[i].literal;
      if (opposite) literal.negated = !literal.negated;
      const bool names_fluent = literal.kind == ConditionLiteral::Kind::kFluent;
      if (names_fluent) {
        oddity += 2 * static_cast<int>(literal.count(LiteralArgument::Kind::kConstant));
      }
      body += (body.empty() ? "" : sign) + print(literal, "time", taken);
      of_inner = of_inner ||
                 (names_fluent &&
                  std::any_of(literal.arguments.begin(), literal.arguments.end(),
                              [&](const auto& argument) { return argument.name == taken.back(); }));
    }
    // Without a fluent of x, `{x} A & x<2` says no more than A.
    if (!of_inner) return;
    if (!quantifier.empty()) ++oddity;
    found_.emplace_back(quantifier + body, oddity);
  }

  const EditSubject& subject_;
  const Symbol& fluent_;
  const std::vector<std::string> variables_;
  std::vector<Row> rows_;
  std::vector<std::pair<std::string, int>> found_;
};

/// Is the formula an equivalence with the fluent on one side?
bool defines(const Ast& ast, const AxiomForm& form, const std::string& fluent) {
  const auto& root = ast[form.body];
  const bool is_definition = form.kind == AxiomForm::Kind::kState &&
                             root.kind == NodeKind::kBinary && root.op == Operator::kIff;
  if (!is_definition) return false;
  for (const std::uint32_t i : {0U, 1U}) {
    const auto& side = ast[ast.child(root, i)];
    if (side.kind == NodeKind::kApply && ast.name(side) == "HoldsAt" &&
        ast.name(ast[ast.child(side, 0)]) == fluent) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::set<std::string> undefined_fluents(const ModelAst& model, const TypedModel& typed,
                                        const std::vector<AxiomForm>& forms) {
  std::set<std::string> out;
  for (const auto& symbol : typed.symbols) {
    if (symbol.kind != SymbolKind::kFluent || !symbol.noninertial) continue;
    const bool is_defined = std::any_of(forms.begin(), forms.end(), [&](const AxiomForm& form) {
      return defines(model.ast(form.place), form, symbol.name);
    });
    if (!is_defined) out.insert(symbol.name);
  }
  return out;
}

void add_missing_definitions(const EditSubject& subject, std::vector<Edit>& edits) {
  const AxiomForm* behind = nullptr;
  for (const auto& form : subject.forms) {
    if (form.kind != AxiomForm::Kind::kStart) behind = &form;
  }
  if (behind == nullptr) return;
  const auto file = subject.model.ast(behind->place).file();
  const auto add = [&](const std::string& text, int oddity) {
    Edit edit;
    edit.kind = Edit::Kind::kAddFact;
    edit.text = text;
    edit.words = "a definition is missing";
    edit.change = {file, behind->end, behind->end, "\n" + text};
    edit.oddity = oddity;
    edits.push_back(std::move(edit));
  };
  for (const auto& name : undefined_fluents(subject.model, subject.typed, subject.forms)) {
    DefinitionSearch search(subject, subject.typed.symbols[*subject.typed.find_symbol(name)]);
    if (!search.is_seen()) continue;
    for (const bool value : {true, false}) {
      if (!search.always(value)) continue;
      add(search.quantified() + (value ? "" : "!") + search.head() + ".", kMissingDefinition);
    }
    for (const auto& [body, oddity] : search.bodies()) {
      add(search.quantified() + search.head() + " <-> " + body + ".", oddity);
    }
  }
}

}  // namespace parallax::compiler
