#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// What the naive expansion may cost. Once overdrawn it stays so, and all work ends soon.
class ReferenceBudget {
 public:
  /// `stop`, if there is one, outlives the budget: once raised, all is spent.
  ReferenceBudget(std::int64_t units, const std::atomic<bool>* stop) : left_(units), stop_(stop) {}
  /// False from the moment on at which more was spent than there is.
  bool spend(std::int64_t units = 1) {
    const bool stopped = stop_ != nullptr && stop_->load(std::memory_order_relaxed);
    left_ = stopped || units > left_ ? -1 : left_ - units;
    return left_ >= 0;
  }
  bool spent() const { return left_ < 0; }
  void spend_all() { left_ = -1; }

 private:
  std::int64_t left_;
  const std::atomic<bool>* stop_;
};

/// The ground terms of a typed model as the reference evaluator sees them: by their printed form
/// and nothing else (unique names). Numbered, so that sets and environments stay small.
class ReferenceTerms {
 public:
  using Value = std::uint32_t;
  using Environment = std::vector<Value>;  // by variable

  /// Lists the domain of every sort; `model` and `budget` outlive the object.
  ReferenceTerms(const TypedModel& model, ReferenceBudget& budget);

  const std::vector<Value>& domain(SortId sort) const { return domains_[sort.index()]; }
  /// An integer sort without any range has every integer.
  bool member(SortId sort, Value value) const;
  const std::string& text(Value value) const { return texts_[value]; }
  std::optional<std::int64_t> number(Value value) const { return numbers_[value]; }
  /// None: an argument lies outside its sort, a function has no value, arithmetic leaves the
  /// integers (division by zero, overflow). Recursion as deep as the term.
  std::optional<Value> term(TermId term, const Environment& environment);
  /// The values of an atom's or constructor's arguments, each a member of its sort.
  std::optional<std::vector<Value>> arguments(const Symbol& symbol,
                                              const std::vector<TermId>& terms,
                                              const Environment& environment);
  /// `Name(a,b)`
  std::string applied(const Symbol& symbol, const std::vector<Value>& arguments) const;
  /// How deep the model's terms nest, at most `limit` + 1.
  static std::size_t depth(const TypedModel& model, std::size_t limit);

 private:
  Value intern(const std::string& text, std::optional<std::int64_t> number);
  Value integer(std::int64_t value) { return intern(std::to_string(value), value); }
  void list_domain(SortId sort);
  void list_instances(const Symbol& symbol, std::vector<Value>& out);
  std::optional<Value> arithmetic(ArithmeticOp op, Value left, Value right);

  const TypedModel& model_;
  ReferenceBudget& budget_;
  std::vector<std::string> texts_;
  std::vector<std::optional<std::int64_t>> numbers_;
  std::unordered_map<std::string, Value> values_;
  std::vector<std::vector<Value>> domains_;         // by sort
  std::vector<std::unordered_set<Value>> members_;  // by sort
  std::vector<bool> listed_;                        // by sort
  std::unordered_map<Value, Value> function_values_;
};

}  // namespace parallax::compiler
