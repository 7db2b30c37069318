// Proofs by the clauses of a plan: resolution depth first and in written order, as in Prolog.
//
// Goals still to be proved are a linked list, so alternatives share their ends; choices are a
// stack, and bindings are undone by a trail. `cut` drops the choices made since its clause was
// tried; `not`, `->`, `once` and `findall` are built from choices, cuts and failure. There is no
// recursion, so depth is no matter.
//
// Some goals only the model can answer. The proof then stops with a question whose ways fork the
// exploration of the plan, and is run again from its start with one answer more; as it depends
// on nothing else, it asks the same questions again. Of the orders in which the model's answers
// could be tried, only those that lead to different ends are explored. Cost: steps are counted
// and limited.

#include "compiler/interpreter/prolog_search.h"

#include <algorithm>
#include <utility>

namespace parallax::compiler {

using Step = ProofSearch::Step;

std::uint32_t ProofSearch::goal(Goal::Kind kind, PrologTermId term, std::uint32_t next,
                                std::uint32_t number, DatumId at) {
  goals_.push_back({kind, term, next, number, at});
  return static_cast<std::uint32_t>(goals_.size() - 1);
}

std::uint32_t ProofSearch::sequence(const Arguments& goals, std::uint32_t next,
                                    std::uint32_t number, DatumId at) {
  for (auto one = goals.rbegin(); one != goals.rend(); ++one) {
    next = goal(Goal::Kind::kProve, *one, next, number, at);
  }
  return next;
}

ProofSearch::Choice& ProofSearch::choose(Choice::Kind kind, PrologTermId term, std::uint32_t next,
                                         std::uint32_t number, DatumId at) {
  choices_.push_back({kind, false, terms.mark(), term, {}, next, number, at, {}, {}});
  return choices_.back();
}

std::optional<bool> ProofAnswers::said(const FormulaTree& guard) const {
  const auto found = known.find(guard.text);
  return found == known.end() ? std::optional<bool>() : found->second;
}

std::optional<std::uint32_t> ProofAnswers::take(std::span<const ModelWay> ways) {
  if (ways.size() == 1) {
    if (const auto holds = said(ways[0].guard)) return *holds ? 1 : 0;
  }
  if (next == given.size()) return std::nullopt;
  const auto answer = given[next++];
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (answer == 0) known.emplace(ways[i].guard.text, false);
    if (answer == i + 1) known.emplace(ways[i].guard.text, true);
  }
  return answer;
}

ProofStop ProofSearch::first(PrologTermId wanted, DatumId at) {
  wanted_ = wanted;
  current_ = goal(Goal::Kind::kProve, wanted, 0, 0, at);
  while (current_ != 0) {
    const auto here = goals_[current_];
    current_ = here.next;
    at_ = here.at;
    if (!world.spend(here.at, terms.exhausted())) return ProofError{};
    auto step = execute(here);
    while (step == Step::kFalse) {
      if (terms.exhausted()) {
        world.spend(at_, true);
        return ProofError{};
      }
      if (choices_.empty()) return ProofNone{};
      const auto choice = std::move(choices_.back());
      choices_.pop_back();
      if (choice.dead) continue;
      terms.undo(choice.trail);
      at_ = choice.at;
      if (!world.spend(choice.at, terms.exhausted())) return ProofError{};
      step = resume(choice);
    }
    if (step == Step::kStop) return std::move(stopped_);
  }
  return ProofSolved{wanted};
}

Step ProofSearch::resume(const Choice& choice) {
  switch (choice.kind) {
    case Choice::Kind::kClauses:
      return try_clauses(choice.term, choice.number, choice.next, choice.at);
    case Choice::Kind::kOr:
      return try_or(choice.term, choice.next, choice.number, choice.at);
    case Choice::Kind::kResume:
      current_ = choice.next;
      return Step::kTrue;
    case Choice::Kind::kMember:
      return try_member(choice.pattern, choice.term, choice.next, choice.at);
    case Choice::Kind::kCollected:
      return collected(choice.number, choice.next);
    case Choice::Kind::kModel:
      return ask(choice.term, &choice, choice.next, choice.at);
    case Choice::Kind::kModelInOrder:
      return ask_in_order(choice.term, choice.number, choice.next, choice.at);
  }
  return Step::kFalse;
}

Step ProofSearch::execute(const Goal& here) {
  switch (here.kind) {
    case Goal::Kind::kProve:
      return prove(here);
    case Goal::Kind::kCut:
      choices_.resize(std::min<std::size_t>(choices_.size(), here.number));
      return Step::kTrue;
    case Goal::Kind::kSoftCut:
      choices_[here.number].dead = true;
      return Step::kTrue;
    case Goal::Kind::kCollect: {
      auto& collector = collectors_[here.number];
      collector.items.push_back(terms.copy(collector.pattern));
      return Step::kFalse;
    }
    case Goal::Kind::kFail:
      return Step::kFalse;
  }
  return Step::kFalse;
}

Step ProofSearch::prove(const Goal& here) {
  const auto parts = terms.split(here.term);
  const auto name = parts ? terms.symbol(parts->first) : std::nullopt;
  const auto args = parts ? terms.elements(parts->second) : std::nullopt;
  if (!name || !args) return wrong(here.at, "goal", "a goal is (predicate argument...)");
  const auto control = controls().find(*name);
  if (control != controls().end()) return (this->*control->second)(here, *args);
  if (world.is_query(*name, args->size())) {
    return collects() ? ask_in_order(here.term, 0, here.next, here.at)
                      : ask(here.term, nullptr, here.next, here.at);
  }
  if (const auto* entry = find_goal(*name)) {
    if (args->size() >= entry->min_arguments && args->size() <= entry->max_arguments) {
      return entry->function(*this, *args);
    }
    if (!facts_.has(*name)) return wrong(here.at, *name, "it has another number of arguments");
  }
  if (!facts_.has(*name)) {
    world.unknown(*name, args->size(), here.at);
    return stop(ProofError{});
  }
  return try_clauses(here.term, 0, here.next, here.at);
}

Step ProofSearch::try_clauses(PrologTermId term, std::uint32_t from, std::uint32_t next,
                              DatumId at) {
  const auto name = terms.symbol(terms.split(term)->first);
  const auto& clauses = facts_.clauses.find(*name)->second;
  const auto cut_to = height();
  for (auto i = from; i < clauses.size(); ++i) {
    if (!world.spend(clauses[i].source, terms.exhausted())) return stop(ProofError{});
    const auto mark = terms.mark();
    const auto clause = instance_of(clauses[i], terms);
    if (!terms.unify(clause.head, term)) {
      terms.undo(mark);
      continue;
    }
    if (i + 1 < clauses.size()) {
      choose(Choice::Kind::kClauses, term, next, i + 1, at).trail = mark;
    }
    if (term == wanted_) clause_ = clauses[i].source;
    current_ = sequence(clause.body, next, cut_to, clauses[i].source);
    return Step::kTrue;
  }
  return Step::kFalse;
}

Step ProofSearch::try_or(PrologTermId alternatives, std::uint32_t next, std::uint32_t number,
                         DatumId at) {
  const auto parts = terms.split(alternatives);
  if (!parts) return Step::kFalse;
  if (!terms.is_nil(parts->second)) choose(Choice::Kind::kOr, parts->second, next, number, at);
  current_ = goal(Goal::Kind::kProve, parts->first, next, number, at);
  return Step::kTrue;
}

Step ProofSearch::any_of(PrologTermId pattern, PrologTermId list) {
  return try_member(pattern, list, current_, at_);
}

Step ProofSearch::try_member(PrologTermId pattern, PrologTermId list, std::uint32_t next,
                             DatumId at) {
  auto rest = list;
  while (const auto parts = terms.split(rest)) {
    if (!world.spend(at, terms.exhausted())) return stop(ProofError{});
    rest = parts->second;
    const auto mark = terms.mark();
    if (!terms.unify(pattern, parts->first)) {
      terms.undo(mark);
      continue;
    }
    if (!terms.is_nil(rest)) {
      auto& choice = choose(Choice::Kind::kMember, rest, next, 0, at);
      choice.trail = mark;
      choice.pattern = pattern;
    }
    current_ = next;
    return Step::kTrue;
  }
  return Step::kFalse;
}

std::optional<ProofSearch::Query> ProofSearch::query(PrologTermId term, DatumId at) {
  const auto parts = terms.split(term);
  const auto name = *terms.symbol(parts->first);
  Query out;
  std::vector<std::optional<ValueId>> known;
  const auto arguments = terms.elements(parts->second).value_or(Arguments());
  for (const auto argument : arguments) {
    known.push_back(terms.value(argument));
    if (known.back()) continue;
    if (!terms.is_variable(argument)) {
      wrong(at, name, "an argument is a value or a variable, not a list with variables");
      return std::nullopt;
    }
    out.free.push_back(terms.walk(argument));
  }
  auto ways = world.ways(name, known, at);
  if (!ways) {
    stop(ProofError{});
    return std::nullopt;
  }
  out.ways = *std::move(ways);
  // A variable that stands twice has one value: what contradicts itself is not asked.
  std::erase_if(out.ways, [&](const ModelWay& way) {
    for (std::size_t i = 0; i < out.free.size(); ++i) {
      for (std::size_t j = i + 1; j < out.free.size(); ++j) {
        if (out.free[i] == out.free[j] && way.bound[i] != way.bound[j]) return true;
      }
    }
    return false;
  });
  return out;
}

Step ProofSearch::hold(const Query& query, std::size_t way, std::uint32_t next) {
  bool good = true;
  for (std::size_t i = 0; i < query.free.size(); ++i) {
    good = good && terms.unify(query.free[i], terms.atom(query.ways[way].bound[i]));
  }
  current_ = next;
  return truth(good);
}

/// Are all solutions wanted?
bool ProofSearch::collects() const {
  return std::any_of(choices_.begin(), choices_.end(),
                     [](const Choice& choice) { return choice.kind == Choice::Kind::kCollected; });
}

/// A query of the binding table: the model answers, and a free variable is any constant for which
/// it holds. If a later goal fails, the remaining constants are tried.
///
/// The model answers in any order, but not every order has to be explored: the consequences of a
/// way do not depend on the ways that failed before it, so it is enough to take it first. Only the
/// end at which all have failed is left, and one order leads there, the ascending one. A designator
/// that was equated on the way stays so; then the failed ways do matter.
Step ProofSearch::ask(PrologTermId term, const Choice* before, std::uint32_t next, DatumId at) {
  auto asked = query(term, at);
  if (!asked) return Step::kStop;
  auto& ways = asked->ways;
  if (before != nullptr) {
    const auto& used = before->used;
    const auto is_used = [&](const ModelWay& way) {
      return std::find(used.begin(), used.end(), way.name) != used.end();
    };
    if (before->chains == world.links().chains) {
      const auto last = std::find_if(ways.rbegin(), ways.rend(), is_used);
      std::for_each(last, ways.rend(), [](ModelWay& way) { way.elsewhere = true; });
    }
    std::erase_if(ways, is_used);
  }
  const auto known = [&](const ModelWay& way) { return answers_.said(way.guard); };
  std::erase_if(ways, [&](const ModelWay& way) { return known(way) == false; });
  if (ways.empty()) return Step::kFalse;
  if (std::any_of(ways.begin(), ways.end(),
                  [&](const ModelWay& way) { return way.elsewhere && known(way) == true; })) {
    return stop(ProofQuestion{});
  }
  const auto answer = answers_.take(ways);
  if (!answer) return stop(ProofQuestion{std::move(ways)});
  if (*answer == 0) return Step::kFalse;
  if (ways.size() > 1) {
    auto& choice = choose(Choice::Kind::kModel, term, next, 0, at);
    if (before != nullptr) choice.used = before->used;
    choice.used.push_back(ways[*answer - 1].name);
    choice.chains = before != nullptr ? before->chains : world.links().chains;
  }
  return hold(*asked, *answer - 1, next);
}

/// The same where all solutions are collected: constant by constant, in the model's order.
Step ProofSearch::ask_in_order(PrologTermId term, std::uint32_t from, std::uint32_t next,
                               DatumId at) {
  const auto asked = query(term, at);
  if (!asked) return Step::kStop;
  for (auto i = from; i < asked->ways.size(); ++i) {
    const auto answer = answers_.take(std::span(asked->ways).subspan(i, 1));
    if (!answer) return stop(ProofQuestion{{asked->ways[i]}});
    if (*answer == 0) continue;
    if (i + 1 < asked->ways.size()) choose(Choice::Kind::kModelInOrder, term, next, i + 1, at);
    return hold(*asked, i, next);
  }
  return Step::kFalse;
}

Step ProofSearch::collected(std::uint32_t which, std::uint32_t next) {
  const auto collector = std::move(collectors_[which]);
  auto items = collector.items;
  if (collector.kind != "findall" && items.empty()) return Step::kFalse;
  if (collector.kind == "setof") {
    // The last of equal solutions stays, as with remove-duplicates.
    Arguments kept;
    std::vector<ValueId> seen;
    for (auto item = items.rbegin(); item != items.rend(); ++item) {
      const auto value = terms.value(*item);
      if (value && std::find(seen.begin(), seen.end(), *value) != seen.end()) continue;
      if (value) seen.push_back(*value);
      kept.push_back(*item);
    }
    items.assign(kept.rbegin(), kept.rend());
  }
  current_ = next;
  return truth(terms.unify(collector.result, terms.list(items)));
}

Step ProofSearch::call(const std::string& function, const Arguments& arguments, DatumId at,
                       ValueId& out) {
  std::vector<ValueId> given;
  std::optional<PrologTermId> free;
  for (const auto argument : arguments) {
    auto value = terms.value(argument);
    // A free variable is a name to a function, as in CRAM; two would have one name.
    if (!value && terms.is_variable(argument)) {
      const auto variable = terms.walk(argument);
      if (free && *free != variable) return wrong(at, function, "two arguments are free variables");
      free = variable;
      value = values.symbol("?_");
    }
    if (!value) return wrong(at, function, "an argument is not bound to anything");
    given.push_back(*value);
  }
  auto computed = world.call(function, given, at, answers_);
  if (const auto* value = std::get_if<ProofWorld::Value>(&computed)) {
    out = value->value;
    return Step::kTrue;
  }
  if (auto* question = std::get_if<ProofQuestion>(&computed)) return stop(std::move(*question));
  if (const auto* failed = std::get_if<ProofFailed>(&computed)) return stop(*failed);
  if (std::holds_alternative<ProofError>(computed)) return stop(ProofError{});
  return Step::kFalse;  // an error in a Lisp function fails the goal
}

// --- control ------------------------------------------------------------------------------------

Step ProofSearch::control_and(const Goal& here, const Arguments& args) {
  current_ = sequence(args, here.next, here.number, here.at);
  return Step::kTrue;
}

Step ProofSearch::control_or(const Goal& here, const Arguments& args) {
  return try_or(terms.list(args), here.next, here.number, here.at);
}

Step ProofSearch::control_not(const Goal& here, const Arguments& args) {
  if (args.size() != 1) return wrong(here.at, "not", "expected one goal");
  const auto before = height();
  choose(Choice::Kind::kResume, {}, here.next, 0, here.at);
  const auto fail = goal(Goal::Kind::kFail, {}, 0, 0, here.at);
  const auto cut = goal(Goal::Kind::kCut, {}, fail, before, here.at);
  current_ = goal(Goal::Kind::kProve, args[0], cut, height(), here.at);
  return Step::kTrue;
}

/// (-> test then else): the first solution of the test counts, with `*->` each of them.
Step ProofSearch::choice_of(const Goal& here, const Arguments& args, Goal::Kind kind) {
  if (args.size() < 2 || args.size() > 3) {
    return wrong(here.at, "->", "expected a test, a goal and perhaps another goal");
  }
  const auto otherwise = args.size() == 3
                             ? goal(Goal::Kind::kProve, args[2], here.next, here.number, here.at)
                             : goal(Goal::Kind::kFail, {}, 0, 0, here.at);
  const auto before = height();
  choose(Choice::Kind::kResume, {}, otherwise, 0, here.at);
  const auto then = goal(Goal::Kind::kProve, args[1], here.next, here.number, here.at);
  const auto cut = goal(kind, {}, then, before, here.at);
  current_ = goal(Goal::Kind::kProve, args[0], cut, height(), here.at);
  return Step::kTrue;
}

Step ProofSearch::control_if(const Goal& here, const Arguments& args) {
  return choice_of(here, args, Goal::Kind::kCut);
}

Step ProofSearch::control_soft_if(const Goal& here, const Arguments& args) {
  return choice_of(here, args, Goal::Kind::kSoftCut);
}

Step ProofSearch::control_once(const Goal& here, const Arguments& args) {
  const auto cut = goal(Goal::Kind::kCut, {}, here.next, height(), here.at);
  current_ = sequence(args, cut, height(), here.at);
  return Step::kTrue;
}

Step ProofSearch::control_cut(const Goal& here, const Arguments& /*args*/) {
  choices_.resize(std::min<std::size_t>(choices_.size(), here.number));
  return Step::kTrue;
}

/// Whatever makes the first goal true makes the second one true.
Step ProofSearch::control_forall(const Goal& here, const Arguments& args) {
  if (args.size() != 2) return wrong(here.at, "forall", "expected two goals");
  const auto word = [&](std::string_view name) { return terms.atom(values.symbol(name)); };
  const auto otherwise = terms.list({word("not"), args[1]});
  return control_not(here, {terms.list({word("and"), args[0], otherwise})});
}

Step ProofSearch::control_collect(const Goal& here, const Arguments& args) {
  const auto kind = *terms.symbol(terms.split(here.term)->first);
  if (args.size() != 3) return wrong(here.at, kind, "expected a pattern, a goal and a list");
  const auto which = static_cast<std::uint32_t>(collectors_.size());
  collectors_.push_back({kind, args[0], args[2], {}});
  choose(Choice::Kind::kCollected, {}, here.next, which, here.at);
  const auto collect = goal(Goal::Kind::kCollect, {}, 0, which, here.at);
  current_ = goal(Goal::Kind::kProve, args[1], collect, height(), here.at);
  return Step::kTrue;
}

const std::map<std::string_view, ProofSearch::Control>& ProofSearch::controls() {
  static const std::map<std::string_view, Control> kControls = {
      {"and", &ProofSearch::control_and},       {"call", &ProofSearch::control_and},
      {"or", &ProofSearch::control_or},         {"not", &ProofSearch::control_not},
      {"->", &ProofSearch::control_if},         {"*->", &ProofSearch::control_soft_if},
      {"once", &ProofSearch::control_once},     {"cut", &ProofSearch::control_cut},
      {"forall", &ProofSearch::control_forall}, {"findall", &ProofSearch::control_collect},
      {"bagof", &ProofSearch::control_collect}, {"setof", &ProofSearch::control_collect},
  };
  return kControls;
}

}  // namespace parallax::compiler
