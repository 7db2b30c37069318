#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace parallax::test {

/// A value of an executed plan.
struct PlanItem {
  enum class Kind { kNil, kTrue, kSymbol, kNumber, kString, kList, kDesignator, kFailure };
  Kind kind = Kind::kNil;
  std::string text;      // of a symbol, a string, a failure's class; a designator's kind
  bool keyword = false;  // kSymbol: :left, not left
  bool object = false;   // kSymbol: an object that a perform returned, known by its name
  double number = 0.0;
  std::vector<PlanItem> items;
  std::vector<std::pair<std::string, PlanItem>> keys;  // of a designator

  bool is_nil() const { return kind == Kind::kNil; }
  const PlanItem* key(const std::string& name) const {
    for (const auto& [key, value] : keys) {
      if (key == name) return &value;
    }
    return nullptr;
  }
  friend bool operator==(const PlanItem&, const PlanItem&) = default;
};

/// The discrete world that a plan is executed in: one definite state, and the effects of performs
/// on it.
class World {
 public:
  virtual ~World() = default;
  virtual std::size_t initial_states() const = 0;
  virtual void reset(std::size_t initial_state) = 0;

  struct Outcome {
    std::string event;  // as traces print it
    bool success = false;
    std::string failure_class;
    std::vector<std::string> returns;  // one of these, if there are any
  };
  /// Carries the event out.
  virtual Outcome perform(const PlanItem& designator) = 0;
  /// `(holds '(name argument...))`; the first item is the fluent's name as the plan writes it.
  virtual bool holds(const std::vector<PlanItem>& fluent) const = 0;
  /// Does the state constraint hold now, after the event that was carried out last?
  virtual bool hit() const = 0;
};

}  // namespace parallax::test
