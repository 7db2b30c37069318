// Effects on fluents with a number that an event changes: a stock, a level, a count.
//
// If F(a,m) held before a step and F(a,n) after it, n is expressed by m: by their difference, by an
// argument of the event, or by a declared function with that value. Objects become variables. The
// proposed effect is `HoldsAt(F(a,count1),time) & count2=count1-1 ->
// Initiates(E,F(a,count2),time)`, together with the end of F(a,count1) where that differed as well.
// Cost: pairs of changes and true fluents of one symbol.

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"
#include "compiler/repair/number_term.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostCounterConditions = 12;  // of a symbol; see condition_literals

class CounterEffects {
 public:
  CounterEffects(const EditSubject& subject, std::vector<Edit>& out)
      : subject_(subject), typed_(subject.typed), out_(out) {}

  void make() {
    for (const auto& step : subject_.scope.steps) {
      std::vector<std::string> events = {base::symbol_of(step.event)};
      // A demanded event is in no recording; of one without arguments that is all there is to know.
      for (const auto& event : subject_.scope.demanded) events.push_back(event);
      for (const auto& [fluent, holds] : step.differing) {
        if (!holds || !is_counter(base::symbol_of(fluent))) continue;
        for (const auto& [before, was] : step.before) {
          if (was && base::symbol_of(before) == base::symbol_of(fluent)) {
            for (const auto& event : events) add(step, event, before, fluent);
          }
        }
      }
    }
  }

 private:
  bool is_counter(const std::string& name) const {
    const auto symbol = typed_.find_symbol(name);
    if (!symbol || typed_.symbols[*symbol].kind != SymbolKind::kFluent) return false;
    const auto& of = typed_.symbols[*symbol];
    return !of.noninertial &&
           std::any_of(of.arguments.begin(), of.arguments.end(),
                       [&](SortId sort) { return is_number_sort(typed_, sort); });
  }

  /// The only place, of a number, at which the two differ.
  std::optional<std::size_t> place_of_change(const std::vector<SortId>& sorts,
                                             const std::vector<std::string>& from,
                                             const std::vector<std::string>& to) const {
    std::optional<std::size_t> out;
    for (std::size_t i = 0; i < sorts.size(); ++i) {
      if (from[i] == to[i]) continue;
      if (out || !is_number_sort(typed_, sorts[i])) return std::nullopt;
      out = i;
    }
    return out;
  }

  void add(const EditScope::Step& step, const std::string& event, const std::string& before,
           const std::string& after) {
    const auto symbol = typed_.find_symbol(event);
    if (!symbol || typed_.symbols[*symbol].kind != SymbolKind::kEvent) return;
    const bool seen = base::symbol_of(step.event) == event;
    const auto of_event = seen ? arguments_of(step.event) : std::vector<std::string>();
    auto sorts = typed_.symbols[*symbol].arguments;
    const auto event_arity = sorts.size();
    if (seen && of_event.size() != event_arity) return;
    const auto fluent = typed_.find_symbol(base::symbol_of(after));
    const auto& places = typed_.symbols[*fluent].arguments;
    const auto from = arguments_of(before), to = arguments_of(after);
    if (from.size() != places.size() || to.size() != places.size()) return;
    const auto place = place_of_change(places, from, to);
    if (!place) return;
    // The event's arguments, then the objects that it has not, then the two numbers.
    std::vector<std::string> objects = of_event;
    objects.resize(event_arity);
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (i == *place || std::find(objects.begin(), objects.end(), from[i]) != objects.end()) {
        continue;
      }
      // Arguments of a demanded event that fit are those of the fluent.
      const auto open = std::find(objects.begin(), objects.begin() + dist(event_arity), "");
      const auto at = static_cast<std::size_t>(open - objects.begin());
      if (at < event_arity && typed_.sorts_overlap(sorts[at], places[i])) {
        objects[at] = from[i];
      } else {
        objects.push_back(from[i]);
        sorts.push_back(places[i]);
      }
    }
    sorts.push_back(places[*place]);
    sorts.push_back(places[*place]);
    const auto names = variables_for(typed_, sorts);
    const auto old_name = names[names.size() - 2], new_name = names.back();
    const auto term = [&](const std::string& number) {
      ConditionLiteral out;
      out.symbol = typed_.symbols[*fluent].name;
      for (std::size_t i = 0; i < from.size(); ++i) {
        const auto found = std::find(objects.begin(), objects.end(), from[i]);
        const auto name =
            i == *place ? number : names[static_cast<std::size_t>(found - objects.begin())];
        out.arguments.push_back({LiteralArgument::Kind::kVariable, name});
      }
      return out;
    };
    const auto steps =
        ways(number_of(from[*place], {}), number_of(to[*place], {}), objects, names, sorts);
    const auto ended = step.differing.find(before);
    const bool ends = ended != step.differing.end() && !ended->second;
    for (const auto& [way, oddity] : steps) {
      Edit edit;
      edit.kind = Edit::Kind::kAddEffect;
      edit.event = event;
      edit.variables = names;
      edit.event_arity = event_arity;
      ConditionLiteral equation;
      equation.kind = ConditionLiteral::Kind::kEqual;
      equation.arguments = {{LiteralArgument::Kind::kVariable, new_name},
                            {LiteralArgument::Kind::kTerm, way}};
      edit.given = {term(old_name), equation};
      edit.oddity = oddity;
      const auto happens = event + "(" + list({names.begin(), names.begin() + dist(event_arity)});
      const auto effect = [&](const char* kind, const std::string& number) {
        std::vector<std::string> arguments;
        for (const auto& each : term(number).arguments) arguments.push_back(each.name);
        return std::string(kind) + "(" + happens + ")," + typed_.symbols[*fluent].name + "(" +
               list(arguments) + "),time)";
      };
      edit.text = effect("Initiates", new_name);
      if (ends) {
        auto both = edit;
        both.text = effect("Terminates", old_name) + " & " + edit.text;
        both.words = "changes `" + typed_.symbols[*fluent].name + "`";
        push(std::move(both), sorts);
        edit.oddity += 1;
      }
      push(std::move(edit), sorts);
    }
  }

  /// Terms for the new number, over the variables: "count1-1", "count1+amount", "Price(item)".
  std::vector<OtherText> ways(std::optional<std::int64_t> from, std::optional<std::int64_t> to,
                              const std::vector<std::string>& objects,
                              const std::vector<std::string>& names,
                              const std::vector<SortId>& sorts) const {
    std::vector<OtherText> out;
    if (!from || !to) return out;
    const auto& old_name = names[names.size() - 2];
    const auto step = std::abs(*to - *from);
    const auto* sign = *to > *from ? "+" : "-";
    out.emplace_back(old_name + sign + std::to_string(step), step == 1 ? 2 : 4);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (!is_number_sort(typed_, sorts[i])) continue;
      if (number_of(objects[i], {}) == step) out.emplace_back(old_name + sign + names[i], 2);
      if (number_of(objects[i], {}) == *to) out.emplace_back(names[i], 3);
    }
    std::map<std::string, std::string> values = {{old_name, std::to_string(*from)}};
    for (std::size_t i = 0; i < objects.size(); ++i) values[names[i]] = objects[i];
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i + 1 < names.size(); ++i) variables.push_back({names[i], sorts[i]});
    for (const auto& term : function_terms(typed_, sorts.back(), variables)) {
      const auto value = table_value(with_names(term, values));
      if (!value) continue;
      if (*value == step) out.emplace_back(old_name + sign + term, 2);
      if (*value == *to) out.emplace_back(term, 2);
    }
    return out;
  }

  /// The value of a ground term of a declared function.
  std::optional<std::int64_t> table_value(const std::string& term) const {
    const auto symbol = typed_.find_symbol(base::symbol_of(term));
    const auto arguments = arguments_of(term);
    for (const auto& entry : typed_.function_values) {
      if (entry.function != symbol || entry.arguments.size() != arguments.size()) continue;
      bool same = true;
      for (std::size_t i = 0; i < arguments.size() && same; ++i) {
        const auto& own = typed_.terms[entry.arguments[i]];
        const auto text = own.kind == TermKind::kInteger  ? std::to_string(own.integer)
                          : own.kind == TermKind::kObject ? typed_.objects[own.object].name
                                                          : std::string();
        same = text == arguments[i];
      }
      const auto& value = typed_.terms[entry.value];
      if (same && value.kind == TermKind::kInteger) return value.integer;
    }
    return std::nullopt;
  }

  void push(Edit edit, const std::vector<SortId>& sorts) {
    std::string key = edit.text;
    for (const auto& literal : edit.given) key += "|" + print(literal, "time", edit.variables);
    if (!known_.insert(key).second) return;
    const auto place = out_.size();
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < sorts.size(); ++i)
      variables.push_back({edit.variables[i], sorts[i]});
    const auto given = edit.given;
    const auto arity = edit.event_arity;
    out_.push_back(std::move(edit));
    subject_.relevance.add_conditions(typed_, place, variables, arity, kMostCounterConditions,
                                      given, out_);
  }

  static std::ptrdiff_t dist(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }
  static std::string list(const std::vector<std::string>& names) {
    std::string out;
    for (const auto& name : names) out += (out.empty() ? "" : ",") + name;
    return out;
  }

  const EditSubject& subject_;
  const TypedModel& typed_;
  std::vector<Edit>& out_;
  std::set<std::string> known_;
};

}  // namespace

void add_counter_effects(const EditSubject& subject, std::vector<Edit>& edits) {
  CounterEffects(subject, edits).make();
}

}  // namespace parallax::compiler
