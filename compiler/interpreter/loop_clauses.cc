#include "compiler/interpreter/loop_clauses.h"

#include <fmt/core.h>

#include <string_view>
#include <utility>

namespace parallax::compiler {
namespace {

struct LoopWord {
  std::string_view word;
  LoopKind kind;
};

/// Words that one form follows.
constexpr LoopWord kSimple[] = {
    {"repeat", LoopKind::kRepeat},       {"while", LoopKind::kWhile},
    {"until", LoopKind::kUntil},         {"collect", LoopKind::kCollect},
    {"collecting", LoopKind::kCollect},  {"append", LoopKind::kAppend},
    {"appending", LoopKind::kAppend},    {"nconc", LoopKind::kAppend},
    {"nconcing", LoopKind::kAppend},     {"sum", LoopKind::kSum},
    {"summing", LoopKind::kSum},         {"count", LoopKind::kCount},
    {"counting", LoopKind::kCount},      {"maximize", LoopKind::kMaximize},
    {"maximizing", LoopKind::kMaximize}, {"minimize", LoopKind::kMinimize},
    {"minimizing", LoopKind::kMinimize}, {"return", LoopKind::kReturn},
    {"always", LoopKind::kAlways},       {"never", LoopKind::kNever},
    {"thereis", LoopKind::kThereis},
};

bool accumulates(LoopKind kind) {
  return kind == LoopKind::kCollect || kind == LoopKind::kAppend || kind == LoopKind::kSum ||
         kind == LoopKind::kCount || kind == LoopKind::kMaximize || kind == LoopKind::kMinimize;
}

class LoopParser {
 public:
  LoopParser(const LispData& data, std::span<const DatumId> items) : data_(data), items_(items) {}

  std::variant<LoopClauses, LoopError> parse() {
    LoopClauses out;
    if (!items_.empty() && data_.is_list(items_.front())) {
      LoopClause clause;
      clause.body.assign(items_.begin(), items_.end());
      out.clauses.push_back(std::move(clause));
      return out;
    }
    if (take_word("named")) {
      if (i_ >= items_.size() || !data_.is_symbol(items_[i_])) return LoopError{"a name", at()};
      out.name = data_.is_nil(items_[i_]) ? "nil" : data_.name(items_[i_]);
      ++i_;
    }
    while (i_ < items_.size()) {
      const auto before = i_;
      if (!parse_clause(out.clauses)) return error_;
      const auto& last = out.clauses.back();
      const bool variable = last.iterates() || last.kind == LoopKind::kWith;
      if (variable && !iterating_) return LoopError{"`for` behind the body", items_[before]};
      iterating_ = iterating_ && (variable || last.kind == LoopKind::kInitially ||
                                  last.kind == LoopKind::kFinally);
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
  bool take_forms(LoopClause& clause, LoopKind kind) {
    clause.kind = kind;
    const std::string name(word());
    ++i_;
    while (i_ < items_.size() && data_.is_list(items_[i_])) clause.body.push_back(items_[i_++]);
    return !clause.body.empty() || fail(fmt::format("`{}` needs a form", name));
  }

  bool parse_clause(std::vector<LoopClause>& out) {
    if (word() == "for" || word() == "as") return parse_joined(out, &LoopParser::parse_for);
    if (word() == "with") return parse_joined(out, &LoopParser::parse_with);
    LoopClause clause;
    if (word() == "initially") {
      if (!take_forms(clause, LoopKind::kInitially)) return false;
    } else if (word() == "finally") {
      if (!take_forms(clause, LoopKind::kFinally)) return false;
    } else if (!parse_body_clause(clause)) {
      return false;
    }
    out.push_back(std::move(clause));
    return true;
  }

  /// for ... and ..., with ... and ...
  bool parse_joined(std::vector<LoopClause>& out, bool (LoopParser::*part)(LoopClause&)) {
    bool joined = false;
    do {
      ++i_;
      LoopClause clause;
      clause.joined = joined;
      if (!(this->*part)(clause)) return false;
      if (joined && clause.kind == LoopKind::kEquals) {
        return fail("`and` before `for v = ...`; write another `for`");
      }
      out.push_back(std::move(clause));
      joined = true;
    } while (word() == "and");
    return true;
  }

  bool parse_body_clause(LoopClause& clause) {
    const auto name = word();
    if (name == "do" || name == "doing") return take_forms(clause, LoopKind::kDo);
    if (name == "when" || name == "if" || name == "unless") return parse_when(clause);
    for (const auto& simple : kSimple) {
      if (simple.word != name) continue;
      clause.kind = simple.kind;
      ++i_;
      if (!take_form(clause.form)) return false;
      if (!accumulates(clause.kind) || !take_word("into")) return true;
      if (i_ >= items_.size() || !data_.is_symbol(items_[i_])) return fail("`into` needs a name");
      clause.result = items_[i_];
      clause.into = data_.name(items_[i_++]);
      return true;
    }
    if (i_ >= items_.size()) return fail("the clause ends too early");
    return fail(fmt::format("the loop clause `{}`", print_datum(data_, items_[i_])));
  }

  bool parse_when(LoopClause& clause) {
    clause.kind = LoopKind::kWhen;
    clause.negated = word() == "unless";
    ++i_;
    if (++depth_ > kMaxDepth) return fail("conditions nested too deep");
    if (!take_form(clause.form) || !parse_branch(clause.inner)) return false;
    if (take_word("else") && !parse_branch(clause.otherwise)) return false;
    take_word("end");
    --depth_;
    return true;
  }

  bool parse_branch(std::vector<LoopClause>& out) {
    do {
      LoopClause clause;
      if (!parse_body_clause(clause)) return false;
      out.push_back(std::move(clause));
    } while (take_word("and"));
    return true;
  }

  bool take_variable(LoopClause& clause) {
    const bool named =
        i_ < items_.size() && (data_.is_symbol(items_[i_]) || data_.is_list(items_[i_]));
    if (!named) return fail("a loop variable is a name");
    clause.variable = items_[i_++];
    return true;
  }

  bool parse_with(LoopClause& clause) {
    clause.kind = LoopKind::kWith;
    if (!take_variable(clause)) return false;
    return !take_word("=") || take_form(clause.form);
  }

  bool parse_for(LoopClause& clause) {
    if (!take_variable(clause)) return false;
    if (word() == "in" || word() == "on") {
      clause.kind = word() == "in" ? LoopKind::kIn : LoopKind::kOn;
      ++i_;
      return take_form(clause.form) && (!take_word("by") || take_form(clause.step));
    }
    if (take_word("across")) {
      clause.kind = LoopKind::kIn;
      clause.list = "%elements";
      return take_form(clause.form);
    }
    if (take_word("being")) return parse_table(clause);
    if (take_word("=")) {
      clause.kind = LoopKind::kEquals;
      return take_form(clause.form) && (!take_word("then") || take_form(clause.then));
    }
    clause.kind = LoopKind::kRange;
    if (data_.is_list(*clause.variable)) return fail("a pattern counts nothing");
    return parse_range(clause);
  }

  /// being the hash-keys of table [using (hash-value v)], and the other way round
  bool parse_table(LoopClause& clause) {
    clause.kind = LoopKind::kIn;
    if (!take_word("the")) take_word("each");
    clause.values = word().starts_with("hash-value");
    if (!clause.values && !word().starts_with("hash-key")) {
      return fail(fmt::format("this kind of `for {}`", print_datum(data_, *clause.variable)));
    }
    ++i_;
    if (!take_word("of")) take_word("in");
    if (!take_form(clause.form)) return false;
    clause.list = clause.values ? "hash-table-values" : "hash-table-keys";
    if (!take_word("using")) return true;
    const auto other = i_ < items_.size() ? data_.children(items_[i_]) : std::span<const DatumId>();
    if (other.size() != 2) return fail("`using` needs (hash-value name)");
    clause.second = other[1];
    clause.list = "hash-table-alist";
    ++i_;
    return true;
  }

  bool parse_range(LoopClause& clause) {
    bool any = false;
    for (;;) {
      if (take_word("from") || take_word("upfrom")) {
        if (!take_form(clause.form)) return false;
      } else if (take_word("downfrom")) {
        clause.down = true;
        if (!take_form(clause.form)) return false;
      } else if (take_word("by")) {
        if (!take_form(clause.step)) return false;
      } else if (word() == "to" || word() == "upto" || word() == "below" || word() == "downto" ||
                 word() == "above") {
        clause.exclusive = word() == "below" || word() == "above";
        clause.down = clause.down || word() == "downto" || word() == "above";
        ++i_;
        if (!take_form(clause.limit)) return false;
      } else {
        return any ||
               fail(fmt::format("this kind of `for {}`", print_datum(data_, *clause.variable)));
      }
      any = true;
    }
  }

  static constexpr int kMaxDepth = 100;
  const LispData& data_;
  std::span<const DatumId> items_;
  std::size_t i_ = 0;
  int depth_ = 0;
  bool iterating_ = true;  // all clauses so far iterate
  LoopError error_;
};

}  // namespace

std::variant<LoopClauses, LoopError> parse_loop(const LispData& data,
                                                std::span<const DatumId> items) {
  return LoopParser(data, items).parse();
}

}  // namespace parallax::compiler
