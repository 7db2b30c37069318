// Small wrong edits of a plan, one place at a time, to see whether a check notices them.
//
// Operators follow mistakes in plans: a perform or a call forgotten, two that follow each other
// exchanged, an argument replaced with another value that the plan uses in that place, two
// neighbouring arguments exchanged, a guard or a handler dropped (mutation analysis, DeMillo,
// Lipton and Sayward 1978). A name is used only where it is bound. Only what the author wrote is
// edited, not what macros made or what is quoted, and an edit is a change of the text. Mutations
// come in the order of the text.
//
// Cost: linear in the plan's data, with at most three other values for an argument.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "compiler/repair/mutation.h"
#include "compiler/repair/plan_edit.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostOthers = 3;  // values that one argument is replaced with

class PlanMutator {
 public:
  explicit PlanMutator(const PlanText& plan) : plan_(plan), data_(plan.data()) {
    for (std::uint32_t i = 0; i < data_.end_id().index(); ++i) {
      if (plan.is_written(DatumId(i))) collect_values(DatumId(i));
    }
  }

  std::vector<Mutation> make() {
    for (std::uint32_t i = 0; i < data_.end_id().index(); ++i) {
      const DatumId form(i);
      const auto head = data_.head(form);
      if (!head || !plan_.is_written(form) || plan_.is_quoted(form)) continue;
      if (is_action(form)) mutate_action(form);
      if (*head == "when" || *head == "unless") drop_guard(form);
      if (*head == "with-failure-handling") drop_handlers(form);
    }
    std::stable_sort(out_.begin(), out_.end(), [](const Mutation& a, const Mutation& b) {
      return std::pair(a.at.file, a.at.begin) < std::pair(b.at.file, b.at.begin);
    });
    return std::move(out_);
  }

 private:
  bool is_action(DatumId form) const { return plan_.is_perform(form) || plan_.is_call(form); }

  /// Can the datum stand in the place of another value? It must be a literal or a name.
  bool is_value(DatumId datum) const {
    if (data_.head(datum) == "quote") return !data_.is_list(data_.children(datum)[1]);
    return !data_.is_list(datum);
  }

  /// Is the value known there, too? Names of variables are, where they are bound.
  bool is_known(const std::string& value, bool in_designator,
                const std::set<std::string>& scope) const {
    if (!names_.contains(value)) return true;
    return scope.contains(value) || plan_.is_global(value) ||
           (in_designator && !value.starts_with('?'));
  }

  /// Place of a value: "put 2" for an argument of a call, "arm" for a pair of a designator.
  using Place = std::pair<std::string, std::size_t>;
  static constexpr std::size_t kKey = 0;  // the function itself is no argument

  template <typename Visit>
  void for_each_argument(DatumId form, Visit visit) const {
    const auto items = data_.children(form);
    if (plan_.is_call(form)) {
      for (std::size_t k = 1; k < items.size(); ++k) visit(Place(*data_.head(form), k), items[k]);
      return;
    }
    if (!plan_.is_perform(form)) return;
    plan_.for_each_datum({items.begin() + 1, items.end()}, [&](DatumId datum) {
      const auto pair = data_.children(datum);
      if (pair.size() != 2 || data_.is_list(pair[0]) || !is_key(pair[0])) return;
      if (data_.name(pair[0]) != "type") visit(Place(data_.name(pair[0]), kKey), pair[1]);
    });
  }
  bool is_key(DatumId datum) const { return data_.is_symbol(datum) || data_.is_keyword(datum); }

  void collect_values(DatumId form) {
    if (!data_.head(form) || !is_action(form)) return;
    for_each_argument(form, [&](const Place& place, DatumId value) {
      if (!is_value(value)) return;
      auto& values = values_[place];
      const std::string text(plan_.written(value));
      if (data_.is_symbol(value)) names_.insert(text);
      if (std::find(values.begin(), values.end(), text) == values.end()) values.push_back(text);
    });
  }

  void add(std::string kind, std::string words, DatumId at, std::vector<TextChange> changes) {
    out_.push_back(
        {std::move(kind), std::move(words), plan_.source(at), std::move(changes), false});
  }

  TextChange replaced(DatumId datum, std::string text) const {
    const auto& source = plan_.source(datum);
    return {source.file, source.begin, source.end, std::move(text)};
  }

  void mutate_action(DatumId form) {
    const auto body = plan_.parent(form);
    if (body && plan_.statement_around(form) == form) {
      add(plan_.is_perform(form) ? "perform dropped" : "call dropped",
          form_words(plan_, form) + " is dropped", form, {statement_dropped(plan_, form)});
      const auto items = data_.children(*body);
      const auto next = std::find(items.begin(), items.end(), form) + 1;
      if (next != items.end() && data_.head(*next) && is_action(*next) &&
          plan_.written(form) != plan_.written(*next)) {
        add("performs exchanged",
            fmt::format("{} and {} are exchanged", form_words(plan_, form),
                        form_words(plan_, *next)),
            form,
            {replaced(form, std::string(plan_.written(*next))),
             replaced(*next, std::string(plan_.written(form)))});
      }
    }
    exchange_arguments(form);
    const auto statement = plan_.statement_around(form);
    const auto scope = statement ? plan_.scope(*statement) : std::set<std::string>();
    for_each_argument(form, [&](const Place& place, DatumId value) {
      if (!is_value(value)) return;
      std::size_t made = 0;
      for (const auto& other : values_[place]) {
        if (other == plan_.written(value) || made == kMostOthers) continue;
        if (!is_known(other, place.second == kKey, scope)) continue;
        ++made;
        add("argument swapped",
            fmt::format("in {}, `{}` becomes `{}`", form_words(plan_, form), plan_.written(value),
                        other),
            value, {replaced(value, other)});
      }
    });
  }

  void exchange_arguments(DatumId form) {
    if (!plan_.is_call(form)) return;
    const auto items = data_.children(form);
    for (std::size_t k = 1; k + 1 < items.size(); ++k) {
      const auto a = plan_.written(items[k]), b = plan_.written(items[k + 1]);
      if (a == b || data_.is_keyword(items[k]) || data_.is_keyword(items[k + 1])) continue;
      add("argument swapped",
          fmt::format("in {}, `{}` and `{}` are exchanged", form_words(plan_, form), a, b),
          items[k], {replaced(items[k], std::string(b)), replaced(items[k + 1], std::string(a))});
    }
  }

  /// Removes everything that a form does around its body; the body stays.
  TextChange only_body(DatumId form, DatumId before_body) const {
    const auto& source = plan_.source(form);
    return {source.file, source.begin, plan_.source(before_body).end, "(progn"};
  }

  void drop_guard(DatumId form) {
    const auto items = data_.children(form);
    if (items.size() < 3) return;
    add("guard dropped", form_words(plan_, form) + " is done in any case", form,
        {only_body(form, items[1])});
  }

  void drop_handlers(DatumId form) {
    const auto items = data_.children(form);
    if (items.size() < 3) return;
    const auto clauses = data_.children(items[1]);
    for (const auto clause : clauses) {
      add("handler dropped", form_words(plan_, clause) + " is dropped", clause,
          {clauses.size() == 1 ? only_body(form, items[1]) : statement_dropped(plan_, clause)});
    }
  }

  const PlanText& plan_;
  const LispData& data_;
  std::map<Place, std::vector<std::string>> values_;
  std::set<std::string> names_;  // those that are symbols
  std::vector<Mutation> out_;
};

}  // namespace

std::vector<Mutation> plan_mutations(const PlanText& plan) { return PlanMutator(plan).make(); }

}  // namespace parallax::compiler
