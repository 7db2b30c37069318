// Reader of the Informal Trace Format as itf_format.h describes it. It also reads the variants of
// other tools: plain booleans for fluents without arguments, lists for tuples, maps that do not
// list every atom, files without the variables of releases, predicates or events.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/base/codes/artifacts.h"
#include "runtime/trace/claim_reader.h"
#include "runtime/trace/itf_format.h"

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

class ItfReader {
 public:
  ItfReader(const JsonValue& root, ClaimReader& reader) : root_(root), reader_(reader) {}

  base::Result<ClaimedTrace> run() {
    auto& sink = reader_.sink();
    trace_.source = root_.source();
    const auto states = root_.find("states");
    if (!read_head() || !read_vars()) return sink.already_reported();
    if (!states->is(JsonKind::kArray)) return reader_.unexpected("a list of states", *states);
    const auto items = states->items();
    if (items.empty()) return reader_.unexpected("at least one state", *states);
    trace_.points.resize(items.size());
    for (std::size_t t = 0; t < items.size(); ++t) {
      if (!read_state(items[t], t)) return sink.already_reported();
    }
    return std::move(trace_);
  }

 private:
  struct Variable {
    std::string name, symbol;
    std::optional<AtomKind> kind;  // none: the action or its picks
  };

  bool fail(std::string_view what, const JsonValue& found) {
    reader_.unexpected(what, found);
    return false;
  }

  bool read_head() {
    if (const auto loop = root_.find("loop")) {
      return fail("a finite trace, without `loop`", *loop);
    }
    const auto meta = root_.find("#meta");
    const auto number = meta ? meta->find("trace") : std::nullopt;
    if (number && number->integer().value_or(0) < 1) return fail("a number from 1 on", *number);
    if (number) trace_.number = *number->integer();
    return true;
  }

  bool read_vars() {
    const auto vars = root_.find("vars");
    if (!vars) return fail("an object with `vars`", root_);
    if (!vars->is(JsonKind::kArray)) return fail("a list of names", *vars);
    for (const auto& var : vars->items()) {
      if (!var.is(JsonKind::kString)) return fail("the name of a variable", var);
      const auto name = var.text();
      auto& variable = vars_.emplace_back(Variable{std::string(name), std::string(name), {}});
      if (name == kItfAction || name == kItfPicks) continue;
      variable.kind = AtomKind::kHoldsAt;
      if (name.starts_with(kItfReleased)) {
        variable.kind = AtomKind::kReleasedAt;
        variable.symbol = name.substr(kItfReleased.size());
      } else if (name.starts_with(kItfPredicate)) {
        variable.kind = AtomKind::kPredicate;
        variable.symbol = name.substr(kItfPredicate.size());
      }
      if (!reader_.has_symbol(*variable.kind, variable.symbol)) {
        reader_.sink().error(
            codes::kTraceUnknownAtom, var.source(),
            variable.kind == AtomKind::kPredicate ? "formula with the predicate" : "fluent",
            variable.symbol);
        return false;
      }
    }
    return true;
  }

  bool read_state(const JsonValue& state, std::size_t t) {
    if (!state.is(JsonKind::kObject)) return fail("a state", state);
    auto& point = trace_.points[t];
    point.source = state.source();
    std::optional<std::set<std::string>> taken, picked;
    for (const auto& variable : vars_) {
      const auto value = state.find(variable.name);
      if (!value) return fail(fmt::format("a state with a value of `{}`", variable.name), state);
      if (variable.kind) {
        auto& claims = variable.kind == AtomKind::kHoldsAt      ? point.holds
                       : variable.kind == AtomKind::kReleasedAt ? point.released
                                                                : trace_.predicates;
        if (!read_map(variable, *value, claims)) return false;
      } else if (variable.name == kItfAction) {
        taken.emplace();
        if (!read_action(*value, t, *taken)) return false;
      } else {
        picked.emplace();
        if (!read_picks(*value, *picked)) return false;
      }
    }
    if (!taken && !picked) return true;
    if (taken && picked && *taken != *picked) {
      return fail(fmt::format("the events of `{}` in `{}`", kItfAction, kItfPicks),
                  *state.find(kItfPicks));
    }
    const auto& events = taken ? *taken : *picked;
    const auto source = state.find(taken ? kItfAction : kItfPicks)->source();
    if (t == 0) return events.empty() || fail("no event before the first state", state);
    auto& happens = trace_.points[t - 1].happens;
    happens.closed = true;
    return std::all_of(events.begin(), events.end(), [&](const std::string& event) {
      return reader_.claim(AtomKind::kHappens, event, {true, source}, happens);
    });
  }

  bool read_action(const JsonValue& value, std::size_t t, std::set<std::string>& events) {
    if (!value.is(JsonKind::kString)) return fail("the events, joined by `+`", value);
    auto text = value.text();
    if (t == 0 && text == kItfInit) return true;
    while (!text.empty()) {
      const auto end = std::min(text.find('+'), text.size());
      if (!split_atom(text.substr(0, end))) return fail("the events, joined by `+`", value);
      if (!events.emplace(text.substr(0, end)).second) return fail("each event once", value);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return true;
  }

  /// {"Go": {"tag": "Some", "value": {"#set": [{"#tup": ["r2"]}]}}, ...}
  bool read_picks(const JsonValue& value, std::set<std::string>& events) {
    if (!value.is(JsonKind::kObject)) return fail("a record by event symbol", value);
    const auto members = value.members();
    for (std::size_t i = 0; i + 1 < members.size(); i += 2) {
      const auto& option = members[i + 1];
      const auto tag = option.find("tag");
      if (!tag || !tag->is(JsonKind::kString)) return fail("`Some` or `None`", option);
      if (tag->text() == "None") continue;
      const auto picked = option.find("value");
      const auto tuples = picked ? picked->find("#set") : std::nullopt;
      if (tag->text() != "Some" || !tuples || !tuples->is(JsonKind::kArray)) {
        return fail("`Some` set of tuples", option);
      }
      for (const auto& tuple : tuples->items()) {
        AtomText atom{std::string(members[i].text()), {}};
        if (!read_tuple(tuple, atom.arguments)) return false;
        events.insert(join_atom(atom));
      }
    }
    return true;
  }

  bool read_map(const Variable& variable, const JsonValue& value, AtomClaims& claims) {
    if (value.is(JsonKind::kBoolean)) {
      return reader_.claim(*variable.kind, variable.symbol + "()",
                           {value.boolean(), value.source()}, claims);
    }
    const auto pairs = value.find("#map");
    if (!pairs || !pairs->is(JsonKind::kArray)) {
      return fail(fmt::format("a `#map` for `{}`", variable.name), value);
    }
    for (const auto& pair : pairs->items()) {
      const auto sides = pair.items();
      if (!pair.is(JsonKind::kArray) || sides.size() != 2) return fail("a pair", pair);
      if (!sides[1].is(JsonKind::kBoolean)) return fail("true or false", sides[1]);
      AtomText atom{variable.symbol, {}};
      if (!read_tuple(sides[0], atom.arguments)) return false;
      if (!reader_.claim(*variable.kind, join_atom(atom), {sides[1].boolean(), pair.source()},
                         claims)) {
        return false;
      }
    }
    return true;
  }

  bool read_tuple(const JsonValue& value, std::vector<std::string>& arguments) {
    const auto tuple = value.find("#tup");
    const auto& list = tuple ? *tuple : value;
    if (!list.is(JsonKind::kArray)) {
      arguments.emplace_back();
      return read_argument(value, arguments.back());
    }
    for (const auto& item : list.items()) {
      arguments.emplace_back();
      if (!read_argument(item, arguments.back())) return false;
    }
    return true;
  }

  bool read_argument(const JsonValue& value, std::string& argument) {
    const auto big = value.find("#bigint");
    if (value.is(JsonKind::kString)) {
      argument = value.text();
    } else if (value.integer()) {
      argument = std::to_string(*value.integer());
    } else if (big && big->is(JsonKind::kString)) {
      argument = big->text();
    } else {
      return fail("an argument: a string or a whole number", value);
    }
    return true;
  }

  JsonValue root_;
  ClaimReader& reader_;
  std::vector<Variable> vars_;
  ClaimedTrace trace_;
};

}  // namespace

base::Result<ClaimedTrace> read_itf_trace(const JsonValue& root, ClaimReader& reader) {
  return ItfReader(root, reader).run();
}

}  // namespace parallax::runtime
