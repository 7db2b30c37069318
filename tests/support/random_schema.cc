#include "tests/support/random_schema.h"

#include <algorithm>

namespace parallax::test {
namespace {

class SchemaMaker {
 public:
  SchemaMaker(FuzzRandom& random, bool large) : random_(random), large_(large) {}

  RandomSchema make() {
    schema_.horizon = static_cast<int>(random_.below(large_ ? 4 : 3)) + 1;
    schema_.offsets = random_.chance(25);
    if (schema_.offsets) schema_.horizon = std::max(schema_.horizon, 3);  // room for an end inside
    load();
    time();
    plain_sorts();
    integer_sorts();
    reified_sorts();
    symbols();
    functions();
    properties();
    return std::move(schema_);
  }

 private:
  void declare(std::string text) { schema_.statements.push_back({std::move(text), {}, {}}); }

  void load() {
    schema_.encoding3 = random_.chance(10);
    if (schema_.encoding3) declare("option encoding 3");
    if (schema_.encoding3 && random_.chance(50)) declare("option trajectory on");
    if (random_.chance(5)) declare("option manualrelease on"), manual_ = true;
    schema_.causal = random_.chance(14);
    if (schema_.causal) declare("load foundations/ECCausal.e");
    schema_.interval = random_.chance(9);
    if (schema_.interval) declare("load foundations/DEC.e");
  }

  void range(const std::string& sort, int lower, int upper) {
    declare("range " + sort + " " + std::to_string(lower) + " " + std::to_string(upper));
    schema_.ranges[sort] = {lower, upper};
    schema_.ancestors[sort] = {sort, "integer"};
    for (int value = lower; value <= upper; ++value) {
      schema_.elements[sort].push_back(std::to_string(value));
    }
  }

  void time() {
    range("time", 0, schema_.horizon);
    if (schema_.offsets) range("offset", random_.chance(20) ? 0 : 1, schema_.horizon);
  }

  void plain_sort(const std::string& name, const std::string& parent,
                  const std::vector<std::string>& constants) {
    declare("sort " + name + (parent.empty() ? "" : ": " + parent));
    std::string list;
    for (const auto& constant : constants) list += (list.empty() ? "" : ", ") + constant;
    if (!constants.empty()) declare(name + " " + list);
    schema_.plain.push_back(name);
    auto& ancestors = schema_.ancestors[name];
    ancestors = {name};
    if (!parent.empty()) ancestors.push_back(parent);
    schema_.elements[name];
    for (const auto& ancestor : ancestors) {
      auto& elements = schema_.elements[ancestor];
      elements.insert(elements.end(), constants.begin(), constants.end());
    }
  }

  void plain_sorts() {
    if (!random_.chance(80)) return;
    const bool sub = random_.chance(40);
    if (sub && random_.chance(50)) {
      plain_sort("thing", "", {});
      plain_sort("tool", "thing", {"Saw"});
      if (random_.chance(50)) plain_sort("toy", "thing", {"Ball"});
      if (schema_.elements.contains("toy") && random_.chance(40)) {
        declare("tool! Ball");  // a constant of two sorts
        schema_.elements["tool"].push_back("Ball");
      }
    } else if (sub) {
      plain_sort("thing", "", {"Ant"});
      plain_sort("tool", "thing", {"Saw"});
    } else {
      plain_sort("thing", "",
                 random_.chance(60) ? std::vector<std::string>{"Ant", "Bee"}
                                    : std::vector<std::string>{"Ant"});
    }
    if (random_.chance(25)) plain_sort("ghost", "", {});
  }

  void integer_sorts() {
    if (!random_.chance(45)) return;
    declare("sort level: integer");
    const int lower = static_cast<int>(random_.below(3)) - 2;
    range("level", lower, lower + 1 + static_cast<int>(random_.below(2)));
  }

  void constructor(const std::string& keyword, RandomSymbol symbol,
                   std::vector<RandomSymbol>& into) {
    std::string list;
    for (const auto& argument : symbol.arguments) list += (list.empty() ? "" : ",") + argument;
    declare(keyword + " " + symbol.name + "(" + list + ")");
    into.push_back(std::move(symbol));
  }

  /// Adds the instances of a constructor to its sort's elements.
  void add_elements(const RandomSymbol& symbol) {
    std::vector<std::string> texts = {symbol.name + "("};
    for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
      std::vector<std::string> longer;
      for (const auto& text : texts) {
        for (const auto& element : schema_.elements[symbol.arguments[i]]) {
          longer.push_back(text + (i > 0 ? "," : "") + element);
        }
      }
      texts = std::move(longer);
    }
    for (const auto& text : texts) schema_.elements[symbol.result].push_back(text + ")");
  }

  void reified_sorts() {
    if (!random_.chance(30)) return;
    declare("reified sort belief");
    schema_.ancestors["belief"] = {"belief"};
    schema_.elements["belief"];
    constructor("belief", {"Dark", {}, "belief"}, schema_.terms);
    add_elements(schema_.terms.back());
    if (random_.chance(50) && schema_.elements.contains("thing")) {
      constructor("belief", {"Near", {"thing"}, "belief"}, schema_.terms);
      add_elements(schema_.terms.back());
    }
    if (!random_.chance(50)) return;
    declare("reified sort wish");
    schema_.ancestors["wish"] = {"wish"};
    schema_.elements["wish"];
    constructor("wish", {"Want", {"belief"}, "wish"}, schema_.terms);
    add_elements(schema_.terms.back());
  }

  std::vector<std::string> argument_sorts(std::size_t most) {
    std::vector<std::string> candidates = schema_.plain;
    for (const auto* sort : {"level", "belief", "wish"}) {
      if (schema_.elements.contains(sort)) candidates.emplace_back(sort);
    }
    std::vector<std::string> arguments;
    if (candidates.empty()) return arguments;
    const auto count = random_.below(most + 1);
    for (std::size_t i = 0; i < count; ++i) arguments.push_back(random_.pick(candidates));
    return arguments;
  }

  void symbols() {
    schema_.ancestors["fluent"] = {"fluent"};
    schema_.ancestors["event"] = {"event"};
    schema_.elements["fluent"];
    schema_.elements["event"];
    const auto some = [&](std::size_t least, std::size_t spread) {
      return least + random_.below(spread);
    };
    const auto fluents = some(1, large_ ? 3 : 2);
    for (std::size_t i = 0; i < fluents; ++i) {
      constructor("fluent", {"F" + std::to_string(i), argument_sorts(1), "fluent"},
                  schema_.fluents);
      add_elements(schema_.fluents.back());
    }
    const auto events = some(1, large_ ? 3 : 2);
    for (std::size_t i = 0; i < events; ++i) {
      constructor("event", {"E" + std::to_string(i), argument_sorts(large_ ? 2 : 1), "event"},
                  schema_.events);
      add_elements(schema_.events.back());
    }
    const auto predicates = random_.below(large_ ? 3 : 2);
    for (std::size_t i = 0; i < predicates; ++i) {
      auto arguments = argument_sorts(2);
      if (random_.chance(20)) arguments.emplace_back("time");
      if (random_.chance(5)) arguments.emplace_back("event");
      constructor("predicate", {"P" + std::to_string(i), arguments, ""}, schema_.predicates);
    }
    if (schema_.causal) {
      for (const auto* name : {"Started", "Stopped", "Initiated", "Terminated"}) {
        schema_.predicates.push_back({name, {"fluent", "time"}, ""});
      }
    }
    if (schema_.interval) {
      schema_.predicates.push_back({"Clipped", {"time", "fluent", "time"}, ""});
      schema_.predicates.push_back({"Declipped", {"time", "fluent", "time"}, ""});
    }
  }

  void functions() {
    const auto count = random_.below(3);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::string> results;
      for (const auto* sort : {"thing", "tool", "level", "belief"}) {
        if (schema_.elements.contains(sort) && !schema_.elements[sort].empty()) {
          results.emplace_back(sort);
        }
      }
      if (results.empty()) return;
      RandomSymbol function{"G" + std::to_string(i), argument_sorts(2), random_.pick(results)};
      if (function.arguments.empty()) continue;
      std::string list;
      for (const auto& argument : function.arguments) list += (list.empty() ? "" : ",") + argument;
      declare("function " + function.name + "(" + list + "): " + function.result);
      std::vector<std::string> tuples = {""};
      for (const auto& argument : function.arguments) {
        std::vector<std::string> longer;
        for (const auto& tuple : tuples) {
          for (const auto& element : schema_.elements[argument]) {
            longer.push_back(tuple + (tuple.empty() ? "" : ",") + element);
          }
        }
        tuples = std::move(longer);
      }
      for (const auto& tuple : tuples) {
        const auto& value = random_.pick(schema_.elements[function.result]);
        RandomFormula entry{function.name + "(" + tuple + ")=" + value, {}};
        schema_.statements.push_back({{}, {}, entry});
      }
      schema_.functions.push_back(std::move(function));
    }
  }

  void properties() {
    for (const auto& fluent : schema_.fluents) {
      if (manual_) schema_.manual_release.push_back(fluent.name);
      if (random_.chance(12)) {
        declare("noninertial " + fluent.name);
        schema_.noninertial.push_back(fluent.name);
      } else if (random_.chance(8)) {
        declare("manualrelease " + fluent.name);
        schema_.manual_release.push_back(fluent.name);
      } else if (random_.chance(20)) {
        schema_.releasable.push_back(fluent.name);
      }
    }
  }

  FuzzRandom& random_;
  const bool large_;
  bool manual_ = false;
  RandomSchema schema_;
};

}  // namespace

bool RandomSchema::below(const std::string& sort, const std::string& ancestor) const {
  const auto found = ancestors.find(sort);
  return found != ancestors.end() &&
         std::find(found->second.begin(), found->second.end(), ancestor) != found->second.end();
}

bool RandomSchema::related(const std::string& a, const std::string& b) const {
  if (below(a, b) || below(b, a) || (is_integer(a) && is_integer(b))) return true;
  const auto in_both = [&](const std::string& element) {
    const auto& other = elements.at(b);
    return std::find(other.begin(), other.end(), element) != other.end();
  };
  const auto found = elements.find(a);
  return found != elements.end() && elements.contains(b) &&
         std::any_of(found->second.begin(), found->second.end(), in_both);
}

std::size_t RandomSchema::instances(const RandomSymbol& symbol) const {
  std::size_t count = 1;
  for (const auto& argument : symbol.arguments) count *= elements.at(argument).size();
  return count;
}

std::size_t RandomSchema::atoms() const {
  const auto points = static_cast<std::size_t>(horizon) + 1;
  std::size_t count = 0;
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const auto& fluent : fluents) {
    count += points * instances(fluent);
    if (has(noninertial, fluent.name)) continue;  // released throughout: nothing to choose
    if (has(manual_release, fluent.name) || has(releasable, fluent.name)) {
      count += points * instances(fluent);
    }
  }
  for (const auto& event : events) count += (points - 1) * instances(event);
  for (const auto& predicate : predicates) count += instances(predicate);
  return count;
}

RandomSchema random_schema(FuzzRandom& random, bool large) {
  return SchemaMaker(random, large).make();
}

}  // namespace parallax::test
