#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/scenarios.h"
#include "harness/law/expression.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMaxLength = 10'000;  // characters of a formula
constexpr int kMaxDepth = 100;              // brackets, signs and powers in each other

bool begins_name(char c) { return base::is_letter(c) || c == '_'; }
bool continues_name(char c) { return begins_name(c) || base::is_digit(c) || c == '.'; }

}  // namespace

/// Recursive descent over the text, writing steps as it goes.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const base::SourceRange& source,
                   base::DiagnosticSink& sink)
      : text_(text), source_(source), sink_(sink) {}

  bool parse(Expression::Kind wanted, Expression& out) {
    out_ = &out;
    next();
    const auto kind = disjunction();
    if (failed_) return false;
    if (!token_.empty()) return fail(fmt::format("`{}` follows where it should end", token_));
    if (kind != wanted) {
      at_ = 0;
      return fail(wanted == Expression::Kind::kNumber
                      ? "it is true or false, where a number is wanted"
                      : "it is a number, where a condition is wanted");
    }
    return true;
  }

 private:
  using Kind = Expression::Kind;
  using Operation = Expression::Operation;

  bool fail(const std::string& why) {
    if (failed_) return false;
    failed_ = true;
    base::SourceRange range = source_;
    // The text may have been written with escapes; then its own end bounds the place.
    const auto length = source_.end - source_.begin;
    auto from = std::min<std::size_t>(at_, length);
    // A text that ends too early is shown at its last word.
    if (from == text_.size()) {
      while (from > 0 && (from == length || base::is_space(text_[from]))) --from;
    }
    const auto size = std::max<std::size_t>(token_.size(), 1);
    range.begin = source_.begin + static_cast<decltype(range.begin)>(from);
    range.end = source_.begin +
                static_cast<decltype(range.end)>(std::min<std::size_t>(from + size, length));
    if (range.end <= range.begin) range = source_;
    sink_.error(codes::kBadFormula, range, why);
    token_ = {};
    return false;
  }

  /// Takes the next token; empty at the end.
  void next() {
    std::size_t at = at_ + token_.size();
    while (at < text_.size() && (text_[at] == ' ' || text_[at] == '\t' || text_[at] == '\n')) ++at;
    at_ = at;
    token_ = {};
    if (at == text_.size()) return;
    std::size_t end = at + 1;
    const char c = text_[at];
    if (begins_name(c)) {
      while (end < text_.size() && continues_name(text_[end])) ++end;
    } else if (base::is_digit(c) || c == '.') {
      while (end < text_.size() && (continues_name(text_[end]) || ends_in_exponent(at, end))) ++end;
    } else if ((c == '<' || c == '>' || c == '=' || c == '!') && end < text_.size() &&
               text_[end] == '=') {
      ++end;
    } else {
      // A character of several bytes is one.
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xc0U) == 0x80U) ++end;
    }
    token_ = text_.substr(at, end - at);
  }

  /// Is a sign at `end` that of an exponent?
  bool ends_in_exponent(std::size_t begin, std::size_t end) const {
    const char sign = text_[end], e = text_[end - 1];
    return (sign == '+' || sign == '-') && (e == 'e' || e == 'E') && end - begin > 1;
  }

  void push(Operation operation, double number = 0.0, std::size_t index = 0) {
    out_->steps_.push_back({operation, number, index});
    // A binary operation replaces two values by one.
    const bool adds = operation == Operation::kPush || operation == Operation::kLoad;
    const bool keeps = operation == Operation::kNegate || operation == Operation::kNot ||
                       operation == Operation::kAbs || operation == Operation::kSqrt ||
                       operation == Operation::kSin || operation == Operation::kCos;
    if (adds) {
      out_->depth_ = std::max(out_->depth_, ++height_);
    } else if (!keeps) {
      --height_;
    }
  }

  bool need(Kind kind, Kind wanted, std::string_view what, std::size_t at) {
    if (failed_ || kind == wanted) return !failed_;
    at_ = at;
    token_ = what;
    return fail(fmt::format("`{}` is about {}", what,
                            wanted == Kind::kNumber ? "numbers, not what is true or false"
                                                    : "what is true or false, not numbers"));
  }

  Kind disjunction() { return logical("or", Operation::kOr, &ExpressionParser::conjunction); }
  Kind conjunction() { return logical("and", Operation::kAnd, &ExpressionParser::negation); }

  Kind logical(std::string_view word, Operation operation, Kind (ExpressionParser::*operand)()) {
    auto kind = (this->*operand)();
    while (!failed_ && token_ == word) {
      const auto at = at_;
      next();
      const auto other = (this->*operand)();
      if (!need(kind, Kind::kTruth, word, at) || !need(other, Kind::kTruth, word, at)) break;
      push(operation);
    }
    return kind;
  }

  Kind negation() {
    if (token_ != "not") return comparison();
    const Deeper deeper(*this);
    const auto at = at_;
    if (failed_) return Kind::kTruth;
    next();
    if (need(negation(), Kind::kTruth, "not", at)) push(Operation::kNot);
    return Kind::kTruth;
  }

  Kind comparison() {
    static constexpr std::array<std::string_view, 6> kWords = {"<", "<=", ">", ">=", "==", "!="};
    const auto kind = sum();
    const auto is_word = [&] {
      return std::find(kWords.begin(), kWords.end(), token_) != kWords.end();
    };
    if (failed_ || !is_word()) {
      if (!failed_ && token_ == "=") fail("`=` compares nothing; `==` does");
      return kind;
    }
    const auto word = token_;
    const auto at = at_;
    next();
    const auto other = sum();
    if (!need(kind, Kind::kNumber, word, at) || !need(other, Kind::kNumber, word, at)) return kind;
    if (is_word()) {
      fail("comparisons do not chain: `a < b and b < c` says it");
      return Kind::kTruth;
    }
    // With 1 the sides are swapped.
    if (word == "==") push(Operation::kEqual);
    if (word == "!=") push(Operation::kUnequal);
    if (word == "<") push(Operation::kLess, 0.0, 0);
    if (word == ">") push(Operation::kLess, 0.0, 1);
    if (word == "<=") push(Operation::kAtMost, 0.0, 0);
    if (word == ">=") push(Operation::kAtMost, 0.0, 1);
    return Kind::kTruth;
  }

  Kind sum() {
    return chain("+", Operation::kAdd, "-", Operation::kSubtract, &ExpressionParser::product);
  }
  Kind product() {
    return chain("*", Operation::kMultiply, "/", Operation::kDivide, &ExpressionParser::sign);
  }

  Kind chain(std::string_view one, Operation first, std::string_view two, Operation second,
             Kind (ExpressionParser::*operand)()) {
    const auto kind = (this->*operand)();
    while (!failed_ && (token_ == one || token_ == two)) {
      const auto word = token_;
      const auto at = at_;
      next();
      const auto other = (this->*operand)();
      if (!need(kind, Kind::kNumber, word, at) || !need(other, Kind::kNumber, word, at)) break;
      push(word == one ? first : second);
    }
    return kind;
  }

  Kind sign() {
    if (token_ != "-" && token_ != "+") return power();
    const Deeper deeper(*this);
    if (failed_) return Kind::kNumber;
    const auto word = token_;
    const auto at = at_;
    next();
    if (need(sign(), Kind::kNumber, word, at) && word == "-") push(Operation::kNegate);
    return Kind::kNumber;
  }

  Kind power() {
    const auto kind = atom();
    if (failed_ || token_ != "^") return kind;
    const Deeper deeper(*this);
    if (failed_) return kind;
    const auto at = at_;
    next();
    const auto exponent = sign();
    if (need(kind, Kind::kNumber, "^", at) && need(exponent, Kind::kNumber, "^", at)) {
      push(Operation::kPower);
    }
    return Kind::kNumber;
  }

  Kind atom() {
    if (failed_) return Kind::kNumber;
    if (token_.empty()) {
      fail("it ends where a value is wanted");
      return Kind::kNumber;
    }
    const char c = token_.front();
    if (c == '(') return bracketed();
    if (base::is_digit(c) || c == '.') return number();
    if (!begins_name(c) || token_ == "and" || token_ == "or" || token_ == "not") {
      fail(fmt::format("`{}` stands where a value is wanted", token_));
      return Kind::kNumber;
    }
    const auto word = token_;
    const auto at = at_;
    next();
    if (token_ == "(") return call(word, at);
    load(word, at);
    return Kind::kNumber;
  }

  Kind bracketed() {
    const Deeper deeper(*this);
    if (failed_) return Kind::kNumber;
    next();
    const auto kind = disjunction();
    close();
    return kind;
  }

  void close() {
    if (failed_) return;
    if (token_ == ")") return next();
    fail(token_.empty() ? std::string("a bracket is not closed")
                        : fmt::format("`{}` stands where `)` is wanted", token_));
  }

  Kind number() {
    double value = 0.0;
    const auto* end = token_.data() + token_.size();
    const auto [stop, error] = std::from_chars(token_.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
      fail(fmt::format("`{}` is not a finite number", token_));
      return Kind::kNumber;
    }
    push(Operation::kPush, value);
    next();
    return Kind::kNumber;
  }

  void load(std::string_view name, std::size_t at) {
    auto& names = out_->names_;
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const auto& known) { return known.text == name; });
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (found == names.end()) {
      auto range = source_;
      if (at + name.size() <= static_cast<std::size_t>(source_.end - source_.begin)) {
        range.begin = source_.begin + static_cast<decltype(range.begin)>(at);
        range.end = range.begin + static_cast<decltype(range.end)>(name.size());
      }
      names.push_back({std::string(name), range});
    }
    push(Operation::kLoad, 0.0, index);
  }

  Kind call(std::string_view word, std::size_t at) {
    struct Function {
      std::string_view name;
      Operation operation;
      std::size_t least, most;  // arguments
    };
    constexpr auto kAny = std::numeric_limits<std::size_t>::max();
    static constexpr std::array<Function, 7> kFunctions = {{{"min", Operation::kMin, 2, kAny},
                                                            {"max", Operation::kMax, 2, kAny},
                                                            {"hypot", Operation::kHypot, 2, 2},
                                                            {"abs", Operation::kAbs, 1, 1},
                                                            {"sqrt", Operation::kSqrt, 1, 1},
                                                            {"sin", Operation::kSin, 1, 1},
                                                            {"cos", Operation::kCos, 1, 1}}};
    const auto found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                    [&](const Function& one) { return one.name == word; });
    if (found == kFunctions.end()) {
      at_ = at;
      token_ = word;
      fail(fmt::format("there is no function `{}` (there are abs, cos, hypot, max, min, sin, sqrt)",
                       word));
      return Kind::kNumber;
    }
    const Deeper deeper(*this);
    std::size_t count = 0;
    do {
      if (failed_) return Kind::kNumber;
      next();
      if (!need(disjunction(), Kind::kNumber, word, at)) return Kind::kNumber;
      // From the second argument on, each is combined with the result so far.
      if (++count > 1) push(found->operation);
    } while (token_ == ",");
    close();
    if (failed_) return Kind::kNumber;
    if (count < found->least || count > found->most) {
      at_ = at;
      token_ = word;
      fail(fmt::format("`{}` takes {}{}, not {}", word, found->most == kAny ? "at least " : "",
                       found->least, count));
    }
    if (found->most == 1) push(found->operation);
    return Kind::kNumber;
  }

  struct Deeper {
    explicit Deeper(ExpressionParser& parser) : parser_(parser) {
      if (++parser_.nesting_ > kMaxDepth) parser_.fail("it nests too deeply");
    }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    ~Deeper() { --parser_.nesting_; }
    ExpressionParser& parser_;
  };

  std::string_view text_;
  base::SourceRange source_;
  base::DiagnosticSink& sink_;
  Expression* out_ = nullptr;
  std::string_view token_;
  std::size_t at_ = 0;
  std::size_t height_ = 0;
  int nesting_ = 0;
  bool failed_ = false;
};

base::Result<Expression> Expression::parse(std::string_view text, Kind wanted,
                                           const base::SourceRange& source,
                                           base::DiagnosticSink& sink) {
  if (text.size() > kMaxLength) {
    return sink.error(codes::kBadFormula, source,
                      fmt::format("it has {} characters, more than {}", text.size(), kMaxLength));
  }
  Expression out;
  out.text_ = text;
  if (!ExpressionParser(out.text_, source, sink).parse(wanted, out)) return sink.already_reported();
  return out;
}

}  // namespace parallax::harness
