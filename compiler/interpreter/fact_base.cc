#include "compiler/interpreter/fact_base.h"

#include <algorithm>
#include <map>
#include <string>

#include "compiler/base/codes/plans.h"

namespace parallax::compiler {
namespace {

class ClauseReader {
 public:
  ClauseReader(const LispData& data, ValueStore& values, base::DiagnosticSink& sink)
      : data_(data), values_(values), sink_(sink) {}

  void read(DatumId form, FactBase& out) {
    const auto items = data_.children(form);
    if (data_.head(form) != "<-" || items.size() < 2) {
      sink_.error(codes::kPlanRule, data_.source(form), print_datum_head(form),
                  "a fact group holds clauses: (<- (predicate argument...) goal...)");
      return;
    }
    const auto head = items[1];
    const auto name = data_.head(head);
    if (!name) {
      sink_.error(codes::kPlanRule, data_.source(form), "<-",
                  "a clause proves (predicate argument...)");
      return;
    }
    clause_ = {};
    variables_.clear();
    clause_.source = form;
    clause_.head = node(head);
    for (const auto goal : items.subspan(2)) {
      if (!data_.head(goal)) {
        sink_.error(codes::kPlanRule, data_.source(goal), *name,
                    "a goal is (predicate argument...)");
        return;
      }
      clause_.body.push_back(node(goal));
    }
    clause_.variables = next_;
    out.clauses[std::string(*name)].push_back(std::move(clause_));
  }

 private:
  std::string print_datum_head(DatumId form) const {
    return std::string(data_.head(form).value_or("..."));
  }

  std::uint32_t add(FactClause::Node::Kind kind, std::uint32_t first, std::uint32_t second = 0) {
    clause_.nodes.push_back({kind, first, second});
    return static_cast<std::uint32_t>(clause_.nodes.size() - 1);
  }

  std::uint32_t atom(ValueId value) { return add(FactClause::Node::Kind::kAtom, value.index()); }

  /// Functions of the plan are found by their key, which says the package where that matters.
  std::uint32_t symbol(DatumId datum, bool function) {
    const auto& name = data_.name(datum);
    if (name == "nil") return atom(values_.nil());
    if (!name.starts_with('?')) return atom(values_.symbol(function ? data_.key(datum) : name));
    const auto fresh = name == "?_";
    const auto found = variables_.find(name);
    const auto number = fresh || found == variables_.end() ? next_++ : found->second;
    if (!fresh) variables_.emplace(name, number);
    return add(FactClause::Node::Kind::kVariable, number);
  }

  /// As deep as the text nests, which its reader bounds.
  std::uint32_t node(DatumId datum, bool function = false) {
    switch (data_[datum].kind) {
      case DatumKind::kSymbol:
        return symbol(datum, function);
      case DatumKind::kKeyword:
        return atom(values_.keyword(data_.name(datum)));
      case DatumKind::kNumber:
        return atom(values_.number(data_.number(datum)));
      case DatumKind::kString:
      case DatumKind::kCharacter:
        return atom(values_.string(data_.name(datum)));
      case DatumKind::kList:
        return list(datum);
    }
    return atom(values_.nil());
  }

  std::uint32_t list(DatumId datum) {
    const auto head = data_.head(datum).value_or("");
    const auto items = data_.children(datum);
    const bool calls = head == "lisp-fun" || head == "lisp-pred";
    std::vector<std::uint32_t> parts;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const bool solution = head == kGroundingRule && i == 2 && data_.is_list(items[i]);
      parts.push_back(solution ? call(items[i]) : node(items[i], calls && i == 1));
    }
    return chain(parts, data_.is_dotted(datum));
  }

  /// (function argument...), which a rule says an action is carried out by.
  std::uint32_t call(DatumId datum) {
    std::vector<std::uint32_t> parts;
    for (const auto item : data_.children(datum)) parts.push_back(node(item, parts.empty()));
    return chain(parts, data_.is_dotted(datum));
  }

  std::uint32_t chain(std::vector<std::uint32_t>& parts, bool dotted) {
    auto rest = dotted ? parts.back() : atom(values_.nil());
    if (dotted) parts.pop_back();
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      rest = add(FactClause::Node::Kind::kPair, *part, rest);
    }
    return rest;
  }

  const LispData& data_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  FactClause clause_;
  std::map<std::string, std::uint32_t, std::less<>> variables_;
  std::uint32_t next_ = 0;
};

}  // namespace

/// A head whose list of arguments ends in a variable fits any number that is large enough.
bool FactBase::has(std::string_view name, std::size_t arguments) const {
  using Kind = FactClause::Node::Kind;
  const auto found = clauses.find(name);
  if (found == clauses.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](const FactClause& clause) {
    std::size_t items = 0;
    auto rest = clause.head;
    for (; clause.nodes[rest].kind == Kind::kPair; rest = clause.nodes[rest].second) ++items;
    const bool open = clause.nodes[rest].kind == Kind::kVariable;
    return open ? items <= arguments + 1 : items == arguments + 1;
  });
}

ClauseInstance instance_of(const FactClause& clause, TermStore& terms) {
  std::vector<PrologTermId> made;
  std::vector<std::optional<PrologTermId>> variables(clause.variables);
  made.reserve(clause.nodes.size());
  for (const auto& node : clause.nodes) {
    switch (node.kind) {
      case FactClause::Node::Kind::kAtom:
        made.push_back(terms.atom(ValueId(node.first)));
        break;
      case FactClause::Node::Kind::kPair:
        made.push_back(terms.pair(made[node.first], made[node.second]));
        break;
      case FactClause::Node::Kind::kVariable:
        if (!variables[node.first]) variables[node.first] = terms.variable();
        made.push_back(*variables[node.first]);
        break;
    }
  }
  ClauseInstance out{made[clause.head], {}};
  for (const auto goal : clause.body) out.body.push_back(made[goal]);
  return out;
}

bool is_fact_group(const LispData& data, DatumId form) {
  return data.head(form) == "def-fact-group";
}

namespace {

using GroupOfPredicate = std::map<std::string, DatumId, std::less<>>;

/// A predicate that another group defines must be listed by this one: in CRAM loading fails.
void check_predicates(const LispData& data, DatumId group, GroupOfPredicate& groups,
                      base::DiagnosticSink& sink) {
  const auto items = data.children(group);
  const auto listed = data.children(items[2]);
  for (const auto clause : items.subspan(3)) {
    const auto parts = data.children(clause);
    if (parts.size() < 2 || !data.head(parts[1])) continue;
    const auto& predicate = data.key(data.children(parts[1])[0]);
    const auto [first, added] = groups.emplace(predicate, group);
    const auto is_listed = [&](DatumId item) {
      return data.is_symbol(item) && data.key(item) == predicate;
    };
    if (added || first->second == group) continue;
    if (std::any_of(listed.begin(), listed.end(), is_listed)) continue;
    sink.error(codes::kPlanRule, data.source(clause), predicate,
               "another group defines the predicate, and this one does not list it")
        .note(data.source(first->second), "the other group");
  }
}

}  // namespace

FactBase read_fact_groups(const LispText& text, ValueStore& values, base::DiagnosticSink& sink) {
  FactBase out;
  GroupOfPredicate groups;
  for (const auto form : text.forms) {
    if (!is_fact_group(text.data, form)) continue;
    const auto items = text.data.children(form);
    const bool headed =
        items.size() >= 3 && (text.data.is_list(items[2]) || text.data.is_nil(items[2]));
    if (!headed) {
      sink.error(codes::kPlanRule, text.data.source(form), "def-fact-group",
                 "expected a name, a list of predicates and clauses");
      continue;
    }
    check_predicates(text.data, form, groups, sink);
    for (const auto clause : items.subspan(3)) {
      ClauseReader(text.data, values, sink).read(clause, out);
    }
  }
  return out;
}

}  // namespace parallax::compiler
