#include "compiler/plan/loop_clauses.h"

#include <fmt/core.h>

#include <string_view>

namespace parallax::compiler {
namespace {

class LoopParser {
 public:
  LoopParser(const LispData& data, std::span<const DatumId> items) : data_(data), items_(items) {}

  std::variant<std::vector<LoopClause>, LoopError> parse() {
    if (!items_.empty() && data_.is_list(items_.front())) {
      LoopClause clause;
      clause.body.assign(items_.begin(), items_.end());
      return std::vector<LoopClause>{std::move(clause)};
    }
    std::vector<LoopClause> out;
    while (i_ < items_.size()) {
      LoopClause clause;
      if (!parse_clause(clause)) return error_;
      const bool iterates = clause.bounded() || clause.kind == LoopKind::kRange;
      if (iterates && !out.empty() && !iterating_) return LoopError{"`for` behind the body", at()};
      iterating_ = iterates;
      out.push_back(std::move(clause));
    }
    return out;
  }

 private:
  std::optional<DatumId> at() const {
    return i_ < items_.size() ? std::optional(items_[i_]) : std::nullopt;
  }
  /// The next item as a word, without taking it; loop keywords may be symbols or keywords.
  std::string_view word() const {
    if (i_ >= items_.size()) return {};
    const auto item = items_[i_];
    return data_.is_symbol(item) || data_.is_keyword(item) ? data_.name(item) : std::string_view();
  }
  bool take_word(std::string_view wanted) {
    if (word() != wanted) return false;
    ++i_;
    return true;
  }
  bool fail(std::string text) {
    error_ = {std::move(text), at()};
    return false;
  }
  bool take_form(std::optional<DatumId>& out) {
    if (i_ >= items_.size()) return fail("the clause ends too early");
    out = items_[i_++];
    return true;
  }
  bool simple(LoopClause& clause, LoopKind kind) {
    clause.kind = kind;
    ++i_;
    return take_form(clause.form);
  }
  bool parse_clause(LoopClause& clause) {
    const auto name = word();
    if (name == "repeat") return simple(clause, LoopKind::kRepeat);
    if (name == "while") return simple(clause, LoopKind::kWhile);
    if (name == "until") return simple(clause, LoopKind::kUntil);
    if (name == "collect" || name == "collecting") return simple(clause, LoopKind::kCollect);
    if (name == "do" || name == "doing") {
      ++i_;
      while (i_ < items_.size() && data_.is_list(items_[i_])) clause.body.push_back(items_[i_++]);
      return !clause.body.empty() || fail("`do` needs a form");
    }
    if (name == "for" || name == "as") {
      ++i_;
      return parse_for(clause);
    }
    return fail(fmt::format("the loop clause `{}`", print_datum(data_, items_[i_])));
  }
  bool parse_for(LoopClause& clause) {
    if (i_ >= items_.size() || !data_.is_symbol(items_[i_]))
      return fail("a loop variable is a name");
    clause.variable = data_.name(items_[i_++]);
    if (take_word("in")) {
      clause.kind = LoopKind::kIn;
      return take_form(clause.form);
    }
    clause.kind = LoopKind::kRange;
    bool any = false;
    if (take_word("from") || take_word("upfrom")) any = true;
    if (!any && take_word("downfrom")) any = clause.down = true;
    if (any && !take_form(clause.form)) return false;
    for (;;) {
      if (take_word("to") || take_word("upto")) {
      } else if (take_word("below")) {
        clause.exclusive = true;
      } else if (take_word("downto")) {
        clause.down = true;
      } else if (take_word("above")) {
        clause.down = clause.exclusive = true;
      } else if (take_word("by")) {
        any = true;
        if (!take_form(clause.step)) return false;
        continue;
      } else {
        return any || fail(fmt::format("this kind of `for {}`", clause.variable));
      }
      any = true;
      if (!take_form(clause.limit)) return false;
    }
  }

  const LispData& data_;
  std::span<const DatumId> items_;
  std::size_t i_ = 0;
  bool iterating_ = true;  // all clauses so far iterate
  LoopError error_;
};

}  // namespace

std::variant<std::vector<LoopClause>, LoopError> parse_loop(const LispData& data,
                                                            std::span<const DatumId> items) {
  return LoopParser(data, items).parse();
}

}  // namespace parallax::compiler
