// The predicates of rules that are neither control nor clauses: what CRAM's Prolog and its
// designators define, as far as the rules of its packages use it.
#include <algorithm>
#include <map>

#include "compiler/builtins/unknown_values.h"
#include "compiler/interpreter/prolog_search.h"

namespace parallax::compiler {
namespace {

using Search = ProofSearch;
using Step = ProofSearch::Step;
using Arguments = ProofSearch::Arguments;

Step goal_true(Search& /*search*/, const Arguments& /*args*/) { return Step::kTrue; }
Step goal_fail(Search& /*search*/, const Arguments& /*args*/) { return Step::kFalse; }

Step goal_unify(Search& search, const Arguments& args) {
  return Search::truth(search.terms.unify(args[0], args[1]));
}

Step goal_bound(Search& search, const Arguments& args) {
  return Search::truth(!search.terms.is_variable(args[0]));
}

Step goal_ground(Search& search, const Arguments& args) {
  return Search::truth(search.terms.value(args[0]).has_value());
}

Step goal_member(Search& search, const Arguments& args) { return search.any_of(args[0], args[1]); }

/// (symbol-value *name* value), of the globals that the robot's packages define.
Step goal_symbol_value(Search& search, const Arguments& args) {
  const auto name = search.terms.symbol(args[0]);
  const auto value = name ? robot_global(*name, search.values) : std::nullopt;
  if (!value) {
    return search.wrong(search.at(), "symbol-value", "it knows the robot's own globals only");
  }
  return Search::truth(search.terms.unify(args[1], search.terms.atom(*value)));
}

/// Is each element of the first list, known, in the second one?
Step goal_subset(Search& search, const Arguments& args) {
  const auto part = search.terms.elements(args[0]);
  const auto whole = search.terms.elements(args[1]);
  if (!part || !whole) return Step::kFalse;
  return Search::truth(std::all_of(part->begin(), part->end(), [&](PrologTermId item) {
    const auto value = search.terms.value(item);
    return value && std::any_of(whole->begin(), whole->end(), [&](PrologTermId other) {
             return search.terms.value(other) == value;
           });
  }));
}

/// Two lists that are known; with a free one it would have to guess.
Step goal_append(Search& search, const Arguments& args) {
  const auto first = search.terms.elements(args[0]);
  if (!first) return search.wrong(search.at(), "append", "the first list must be known");
  auto out = args[1];
  for (auto item = first->rbegin(); item != first->rend(); ++item) {
    out = search.terms.pair(*item, out);
  }
  return Search::truth(search.terms.unify(args[2], out));
}

Step goal_length(Search& search, const Arguments& args) {
  const auto items = search.terms.elements(args[0]);
  if (!items) return Step::kFalse;
  const auto length = search.values.number(Number(static_cast<std::int64_t>(items->size())));
  return Search::truth(search.terms.unify(args[1], search.terms.atom(length)));
}

Step goal_symbol_fun(Search& search, std::string_view function, const Arguments& args) {
  ValueId out;
  const auto step = search.call(std::string(function), args, search.at(), out);
  if (step != Step::kTrue) return step;
  return Search::truth(!search.values.is_nil(out));
}
Step goal_less(Search& search, const Arguments& args) { return goal_symbol_fun(search, "<", args); }
Step goal_more(Search& search, const Arguments& args) { return goal_symbol_fun(search, ">", args); }
Step goal_at_most(Search& search, const Arguments& args) {
  return goal_symbol_fun(search, "<=", args);
}
Step goal_at_least(Search& search, const Arguments& args) {
  return goal_symbol_fun(search, ">=", args);
}

/// (lisp-fun function argument... result)
Step goal_lisp_fun(Search& search, const Arguments& args) {
  const auto name = search.terms.symbol(args[0]);
  if (!name) return search.wrong(search.at(), "lisp-fun", "expected the name of a function");
  ValueId out;
  const auto step = search.call(*name, {args.begin() + 1, args.end() - 1}, search.at(), out);
  if (step != Step::kTrue) return step;
  return Search::truth(search.terms.unify(args.back(), search.terms.atom(out)));
}

Step goal_lisp_pred(Search& search, const Arguments& args) {
  const auto name = search.terms.symbol(args[0]);
  if (!name) return search.wrong(search.at(), "lisp-pred", "expected the name of a function");
  return goal_symbol_fun(search, *name, {args.begin() + 1, args.end()});
}

Step goal_lisp_type(Search& search, const Arguments& args) {
  return goal_symbol_fun(search, "typep", args);
}

// --- designators --------------------------------------------------------------------------------

std::optional<ValueId> designator(Search& search, PrologTermId term) {
  const auto value = search.terms.value(term);
  if (!value || !is_designator(search.values[*value])) return std::nullopt;
  return value;
}

/// (property designator (:key value)), (desig-prop designator (:key value)): each property that
/// fits.
Step goal_property(Search& search, const Arguments& args) {
  const auto whole = designator(search, args[0]);
  const auto pair = search.terms.elements(args[1]);
  if (!whole) return Step::kFalse;
  if (!pair || pair->size() != 2) {
    return search.wrong(search.at(), "property", "a property is (:key value)");
  }
  const auto key = search.terms.symbol(pair->front());
  const auto wanted = search.terms.symbol(pair->back());
  if (key == "type" && wanted) {
    const auto type = property_value(search.values, *whole, "type");
    if (type && search.values[*type].text == *wanted) search.fits = *whole;
  }
  return search.any_of(args[1], search.terms.atom(property_list(search.values, *whole)));
}

Step goal_description(Search& search, const Arguments& args) {
  const auto whole = designator(search, args[0]);
  if (!whole) return Step::kFalse;
  const auto list = search.terms.atom(property_list(search.values, *whole));
  return Search::truth(search.terms.unify(args[1], list));
}

/// (designator class description designator): makes a designator from a known description, or takes
/// one apart.
Step goal_designator(Search& search, const Arguments& args) {
  if (args.size() == 1) return Search::truth(designator(search, args[0]).has_value());
  if (args.size() != 3)
    return search.wrong(search.at(), "designator", "expected one or three arguments");
  auto& values = search.values;
  if (const auto whole = designator(search, args[2])) {
    const auto kind = values[*whole].kind == ValueKind::kModel ? DesignatorKind::kObject
                                                               : values[*whole].designator;
    const auto list = search.terms.atom(property_list(values, *whole));
    const auto type = search.terms.atom(values.keyword(to_string(kind)));
    return Search::truth(search.terms.unify(args[0], type) && search.terms.unify(args[1], list));
  }
  const auto name = search.terms.symbol(args[0]);
  const auto kind = name ? designator_class(*name) : std::nullopt;
  const auto description = search.terms.value(args[1]);
  if (!name || !description) return Step::kFalse;
  auto keys = keys_of_list(values, *description);
  if (!kind || !keys) {
    return search.wrong(search.at(), "designator", "expected a class and ((:key value) ...)");
  }
  const auto made = search.world.links().make(values, *kind, *std::move(keys));
  return Search::truth(search.terms.unify(args[2], search.terms.atom(made)));
}

Step goal_current(Search& search, const Arguments& args) {
  const auto value = search.terms.value(args[0]);
  if (!value) return Step::kFalse;
  const auto current = search.world.links().current(*value);
  return Search::truth(search.terms.unify(args[1], search.terms.atom(current)));
}

Step goal_desig_equal(Search& search, const Arguments& args) {
  const auto left = designator(search, args[0]), right = designator(search, args[1]);
  return Search::truth(left && right && search.world.links().same(*left, *right));
}

/// The solutions that differ for the model: the designator itself.
Step goal_groundings(Search& search, const Arguments& args) {
  const auto whole = designator(search, args[0]);
  if (!whole) return Step::kFalse;
  ValueId reference;
  const auto step = search.call("reference", {args[0]}, search.at(), reference);
  if (step != Step::kTrue) return step;
  const auto list = search.terms.list({search.terms.atom(reference)});
  return Search::truth(search.terms.unify(args[1], list));
}

Step goal_reference(Search& search, const Arguments& args) {
  ValueId reference;
  const auto step = search.call("reference", {args[0]}, search.at(), reference);
  if (step != Step::kTrue) return step;
  return Search::truth(search.terms.unify(args[1], search.terms.atom(reference)));
}

template <DesignatorKind kKind>
Step goal_of_class(Search& search, const Arguments& args) {
  const auto whole = designator(search, args[0]);
  if (!whole) return Step::kFalse;
  const auto& value = search.values[*whole];
  if (value.kind == ValueKind::kModel) return Search::truth(kKind == DesignatorKind::kObject);
  return Search::truth(value.designator == kKind);
}

Step goal_class(Search& search, const Arguments& args) {
  const auto whole = designator(search, args[0]);
  if (!whole) return Step::kFalse;
  const auto& value = search.values[*whole];
  const auto kind = value.kind == ValueKind::kModel ? DesignatorKind::kObject : value.designator;
  const auto name = search.terms.atom(search.values.keyword(to_string(kind)));
  return Search::truth(search.terms.unify(args[1], name));
}

constexpr std::size_t kMany = 1000;
constexpr GoalEntry kGoals[] = {
    {"true", 0, 0, goal_true},
    {"fail", 0, 0, goal_fail},
    {"==", 2, 2, goal_unify},
    {"equal", 2, 2, goal_unify},
    {"bound", 1, 1, goal_bound},
    {"ground", 1, 1, goal_ground},
    {"member", 2, 2, goal_member},
    {"subset", 2, 2, goal_subset},
    {"symbol-value", 2, 2, goal_symbol_value},
    {"append", 3, 3, goal_append},
    {"length", 2, 2, goal_length},
    {"<", 2, 2, goal_less},
    {">", 2, 2, goal_more},
    {"<=", 2, 2, goal_at_most},
    {">=", 2, 2, goal_at_least},
    {"lisp-fun", 2, kMany, goal_lisp_fun},
    {"lisp-pred", 1, kMany, goal_lisp_pred},
    {"lisp-type", 2, 2, goal_lisp_type},
    {"assert-type", 3, 3, goal_true},
    {"format", 0, kMany, goal_true},
    {"warn", 0, kMany, goal_true},
    {"error", 0, kMany, goal_fail},
    {"property", 2, 2, goal_property},
    {"property-member", 2, 2,
     [](Search& search, const Arguments& args) {
       return goal_property(search, {args[1], args[0]});
     }},
    {"desig-prop", 2, 2, goal_property},
    {"desig-description", 2, 2, goal_description},
    {"designator", 1, 3, goal_designator},
    {"current-designator", 2, 2, goal_current},
    {"newest-effective-designator", 2, 2, goal_current},
    {"desig-equal", 2, 2, goal_desig_equal},
    {"designator-groundings", 2, 2, goal_groundings},
    {"desig-reference", 2, 2, goal_reference},
    {"desig-class", 2, 2, goal_class},
    {"effective-designator", 1, 1,
     [](Search& search, const Arguments& args) {
       return Search::truth(designator(search, args[0]).has_value());
     }},
    {"loc-desig?", 1, 1, goal_of_class<DesignatorKind::kLocation>},
    {"obj-desig?", 1, 1, goal_of_class<DesignatorKind::kObject>},
    {"action-desig?", 1, 1, goal_of_class<DesignatorKind::kAction>},
    {"motion-desig?", 1, 1, goal_of_class<DesignatorKind::kMotion>},
};

}  // namespace

const GoalEntry* find_goal(std::string_view name) {
  static const auto table = [] {
    std::map<std::string_view, const GoalEntry*> out;
    for (const auto& entry : kGoals) out.emplace(entry.name, &entry);
    return out;
  }();
  const auto found = table.find(name);
  return found == table.end() ? nullptr : found->second;
}

}  // namespace parallax::compiler
