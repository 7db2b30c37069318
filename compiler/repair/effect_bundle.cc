#include "compiler/repair/effect_bundle.h"

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_relevance.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostEffects = 6;      // of one bundle
constexpr std::size_t kMostLifted = 4;       // objects of which each is a variable or a constant
constexpr std::size_t kMostConditions = 20;  // of a symbol; see condition_literals

/// A fluent that changed at a step.
struct Change {
  std::string symbol;
  std::vector<std::string> arguments;
  bool begins = false;
  friend auto operator<=>(const Change&, const Change&) = default;
};
using Group = std::vector<Change>;

bool share_an_object(const Change& a, const Change& b) {
  return std::any_of(a.arguments.begin(), a.arguments.end(), [&](const auto& object) {
    return std::find(b.arguments.begin(), b.arguments.end(), object) != b.arguments.end();
  });
}

class BundleMaker {
 public:
  BundleMaker(const ModelAst& model, const TypedModel& typed, const std::vector<AxiomForm>& forms,
              const EditScope& scope, std::vector<Edit>& edits)
      : typed_(typed), scope_(scope), relevance_(model, forms, scope), edits_(edits) {}

  void make() {
    for (const auto& step : scope_.steps) {
      const auto event = typed_.find_symbol(base::symbol_of(step.event));
      if (!event || typed_.symbols[*event].kind != SymbolKind::kEvent) continue;
      if (typed_.symbols[*event].arguments.size() != arguments_of(step.event).size()) continue;
      for (const auto& group : groups_of(changes_of(step))) {
        if (group.size() > 1 && group.size() <= kMostEffects) bundles_of(step, *event, group);
      }
    }
  }

 private:
  std::vector<Change> changes_of(const EditScope::Step& step) const {
    std::vector<Change> out;
    for (const auto& [fluent, holds] : step.differing) {
      const auto before = step.before.find(fluent);
      if (before != step.before.end() && before->second == holds) continue;
      const auto symbol = typed_.find_symbol(base::symbol_of(fluent));
      if (!symbol || typed_.symbols[*symbol].kind != SymbolKind::kFluent) continue;
      // A defined fluent follows from the others.
      if (typed_.symbols[*symbol].noninertial) continue;
      auto arguments = arguments_of(fluent);
      if (arguments.size() != typed_.symbols[*symbol].arguments.size()) continue;
      out.push_back({base::symbol_of(fluent), std::move(arguments), holds});
    }
    return out;
  }

  /// Groups of changes that are connected by objects. Another group joins each fluent that ended
  /// with those that began and share an object with it, so that two things that slip are two cases
  /// of one sentence.
  static std::set<Group> groups_of(const std::vector<Change>& changes) {
    std::set<Group> out;
    std::set<Change> open(changes.begin(), changes.end());
    while (!open.empty()) {
      Group group = {*open.begin()};
      open.erase(open.begin());
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (auto other = open.begin(); other != open.end();) {
          if (!share_an_object(group[i], *other)) {
            ++other;
            continue;
          }
          group.push_back(*other);
          other = open.erase(other);
        }
      }
      std::sort(group.begin(), group.end());
      out.insert(std::move(group));
    }
    for (const auto& ended : changes) {
      if (ended.begins) continue;
      Group group = {ended};
      for (const auto& begun : changes) {
        if (begun.begins && share_an_object(ended, begun)) group.push_back(begun);
      }
      std::sort(group.begin(), group.end());
      out.insert(std::move(group));
    }
    return out;
  }

  /// The narrowest sort among the places at which the object stands.
  SortId sort_of(const std::string& object, const Group& group) const {
    std::optional<std::pair<std::size_t, SortId>> best;
    for (const auto& change : group) {
      const auto& sorts = typed_.symbols[*typed_.find_symbol(change.symbol)].arguments;
      for (std::size_t i = 0; i < sorts.size(); ++i) {
        if (change.arguments[i] != object) continue;
        const auto size = constants_of(typed_, sorts[i]).size();
        if (!best || size < best->first) best = {size, sorts[i]};
      }
    }
    return best->second;
  }

  void bundles_of(const EditScope::Step& step, SymbolId event, const Group& group) {
    const auto of_event = arguments_of(step.event);
    std::vector<std::string> liftable;
    for (const auto& change : group) {
      if (change.begins) continue;
      for (const auto& object : change.arguments) {
        const bool known = std::find(of_event.begin(), of_event.end(), object) != of_event.end() ||
                           std::find(liftable.begin(), liftable.end(), object) != liftable.end();
        if (!known) liftable.push_back(object);
      }
    }
    const std::size_t all = std::size_t{1} << std::min(liftable.size(), kMostLifted);
    for (std::size_t constants = 0; constants < all; ++constants) {
      std::vector<std::string> lifted;
      for (std::size_t i = 0; i < liftable.size(); ++i) {
        if (i >= kMostLifted || (constants >> i & 1U) == 0) lifted.push_back(liftable[i]);
      }
      bundle(event, of_event, group, lifted, false, constants == 0);
      if (scope_.open_outcomes) bundle(event, of_event, group, lifted, true, constants == 0);
    }
  }

  void bundle(SymbolId event, const std::vector<std::string>& of_event, const Group& group,
              const std::vector<std::string>& lifted, bool open, bool with_conditions) {
    auto sorts = typed_.symbols[event].arguments;
    for (const auto& object : lifted) sorts.push_back(sort_of(object, group));
    const auto names = variables_for(typed_, sorts);
    std::map<std::string, std::string> variable_of;
    for (std::size_t i = 0; i < of_event.size(); ++i) variable_of.emplace(of_event[i], names[i]);
    for (std::size_t i = 0; i < lifted.size(); ++i) {
      variable_of.emplace(lifted[i], names[of_event.size() + i]);
    }
    Edit edit;
    edit.kind = Edit::Kind::kAddEffect;
    edit.event = typed_.symbols[event].name;
    edit.variables = names;
    edit.event_arity = of_event.size();
    edit.oddity = 2 + static_cast<int>(group.size()) + (open ? 1 : 0);
    const auto term = [&](const Change& change) {
      ConditionLiteral literal;
      literal.symbol = change.symbol;
      for (const auto& object : change.arguments) {
        const auto found = variable_of.find(object);
        const bool is_variable = found != variable_of.end();
        literal.arguments.push_back(
            {is_variable ? LiteralArgument::Kind::kVariable : LiteralArgument::Kind::kConstant,
             is_variable ? found->second : object});
      }
      return literal;
    };
    const auto text_of = [](const ConditionLiteral& literal) {
      std::string out;
      for (const auto& each : literal.arguments) out += (out.empty() ? "" : ",") + each.name;
      return literal.symbol + "(" + out + ")";
    };
    std::string happens = edit.event + "(";
    for (std::size_t i = 0; i < of_event.size(); ++i) happens += (i == 0 ? "" : ",") + names[i];
    happens += ")";
    std::string ends, begins;
    for (const auto& change : group) {
      const auto literal = term(change);
      edit.oddity += static_cast<int>(2 * literal.count(LiteralArgument::Kind::kConstant));
      if (!change.begins) edit.given.push_back(literal);
      const auto* kind = open ? "Releases" : change.begins ? "Initiates" : "Terminates";
      edit.text += (edit.text.empty() ? "" : " & ") + std::string(kind) + "(" + happens + "," +
                   text_of(literal) + ",time)";
      auto& list = change.begins ? begins : ends;
      list += (list.empty() ? "`" : ", `") + text_of(literal) + "`";
    }
    tell_apart(group, term, edit.given);
    edit.words = std::string(open ? "can " : "");
    if (!ends.empty()) edit.words += (open ? "end " : "ends ") + ends;
    if (!ends.empty() && !begins.empty()) edit.words += " and ";
    if (!begins.empty()) edit.words += (open ? "begin " : "begins ") + begins;
    std::string key = edit.text;
    for (const auto& literal : edit.given) key += "|" + print(literal, "time", names);
    if (!known_.insert(key).second) return;
    const auto place = edits_.size();
    const auto given = edit.given;
    edits_.push_back(std::move(edit));
    if (with_conditions) conditions(place, of_event.size(), names, sorts, given);
  }

  /// Adds conditions that a fluent that ends and one that begins are not the same.
  template <typename Term>
  static void tell_apart(const Group& group, const Term& term,
                         std::vector<ConditionLiteral>& given) {
    for (const auto& ended : group) {
      for (const auto& begun : group) {
        if (ended.begins || !begun.begins || ended.symbol != begun.symbol) continue;
        const auto a = term(ended).arguments, b = term(begun).arguments;
        for (std::size_t i = 0; i < a.size(); ++i) {
          if (a[i] == b[i]) continue;
          const bool variable = a[i].kind == LiteralArgument::Kind::kVariable ||
                                b[i].kind == LiteralArgument::Kind::kVariable;
          const bool first = a[i].kind == LiteralArgument::Kind::kVariable;
          ConditionLiteral differs;
          differs.kind = ConditionLiteral::Kind::kEqual;
          differs.negated = true;
          differs.arguments = {first ? a[i] : b[i], first ? b[i] : a[i]};
          if (variable) given.push_back(std::move(differs));
          break;
        }
      }
    }
  }

  void conditions(std::size_t of, std::size_t arity, const std::vector<std::string>& names,
                  const std::vector<SortId>& sorts, const std::vector<ConditionLiteral>& given) {
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < names.size(); ++i) variables.push_back({names[i], sorts[i]});
    relevance_.add_conditions(typed_, of, variables, arity, kMostConditions, given, edits_);
  }

  const TypedModel& typed_;
  const EditScope& scope_;
  const EditRelevance relevance_;
  std::vector<Edit>& edits_;
  std::set<std::string> known_;
};

}  // namespace

void add_effect_bundles(const ModelAst& model, const TypedModel& typed,
                        const std::vector<AxiomForm>& forms, const EditScope& scope,
                        std::vector<Edit>& edits) {
  BundleMaker(model, typed, forms, scope, edits).make();
}

}  // namespace parallax::compiler
