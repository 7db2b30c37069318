#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/word_table.h"
#include "compiler/lisp/number.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/pose_locator.h"

namespace parallax::compiler {

struct ValueTag {};
using ValueId = base::Id<ValueTag>;

enum class ValueKind : std::uint8_t {
  kNil,
  kSymbol,
  kNumber,
  kString,
  kCons,
  kVector,  // a position [m]
  kQuaternion,
  kPose,
  kTransform,
  kUnknown,  // only the robot knows it: a term, the function and the list of its arguments
  kDesignator,
  kFailure,   // text: the class
  kModel,     // determined by the model; see PlanGraph::values
  kCounter,   // hidden iteration count of a bounded loop
  kNotGiven,  // stands for an argument whose default the function computes
  kFurther,   // the rest of a list of solutions, of which only the first is known
  kFunction,
  kValues,   // the values of a `values` form, not one of them: head is the list of all
  kCell,     // a thing that can be changed, by its identity; text: what it is
  kNetwork,  // a fluent computed from others: the function, and head is the list of its arguments
};

enum class DesignatorKind : std::uint8_t { kMotion, kAction, kObject, kLocation, kAllObjects };
inline constexpr auto kDesignatorKindWords =
    base::word_table<DesignatorKind>("motion", "action", "object", "location", "all objects");
constexpr std::string_view to_string(DesignatorKind kind) { return kDesignatorKindWords.of(kind); }

/// A function as a value: a unit of the plan or a built-in. One that shares variables with the code
/// around it lives no longer than they do; a frame and places on the stack say how long that is.
struct PlanFunctionValue {
  std::uint32_t unit = 0;
  bool builtin = false;     // unit is the number of a built-in
  std::uint32_t link = 0;   // 1 + the frame around it; 0: it needs none
  std::uint32_t reach = 0;  // 1 + the highest place of a variable that it shares
  friend bool operator==(const PlanFunctionValue&, const PlanFunctionValue&) = default;
};

/// Where a cons that was made of a datum came from: the datum at `index` of `list`, or only the
/// place in a template that the list was made at.
struct DatumOrigin {
  std::uint32_t list = 0;  // 1 + its datum; 0: from nowhere
  std::uint32_t index = 0;
  bool made = false;  // of a macro's own text: turned back, it is a new datum
  friend bool operator==(const DatumOrigin&, const DatumOrigin&) = default;
};
inline constexpr std::uint32_t kWholeTemplate = 0xFFFFFFFF;  // as index

/// A value of a plan variable. Immutable; equal values have equal ids (see ValueStore).
struct Value {
  ValueKind kind = ValueKind::kNil;
  std::string text;      // symbol name, string, failure class, child frame, function of a term
  bool keyword = false;  // kSymbol: :left, not left
  Number number;         // kNumber, kCounter
  std::string key;       // kSymbol: what it is found by, where that is not its name
  // kCons; stamp of a pose (nil: none); arguments of a term; kFunction: the list of variables that
  // it keeps; kValues: all
  ValueId head;
  ValueId tail;
  DatumOrigin origin;          // kCons, while macros are expanded
  PlanFunctionValue function;  // kFunction; others: the shortest life of a function in it
  PlanPose pose;               // kPose and kTransform; kVector and kQuaternion use their part
  DesignatorKind designator = DesignatorKind::kMotion;
  // kDesignator: in written order; kModel: the description that it was sought by; kFailure: slots
  std::vector<std::pair<std::string, ValueId>> keys;
  std::uint32_t identity = 0;  // kDesignator: tells it from another one with the same keys
  ModelValueId model;
  std::vector<ModelValueId> registers;    // of the model values in it, sorted; set by the store
  std::vector<std::uint32_t> identities;  // of the designators in it, sorted; set by the store
};

/// How many further solutions of a location `next-solution` has gone through.
inline constexpr std::string_view kSolutionKey = "solution";

/// More values than any plan needs; a loop that builds ever longer lists reaches it.
inline constexpr std::size_t kMaxPlanValues = 250000;
/// Characters in all of them together; a loop that doubles a string reaches it.
inline constexpr std::size_t kMaxPlanText = 16'000'000;

/// Hash-conses values: structurally equal values get the same id, so that two states of a plan are
/// equal exactly if their ids are.
class ValueStore {
 public:
  ValueStore();
  ValueId nil() const { return ValueId(0); }
  ValueId truth() const { return truth_; }
  ValueId boolean(bool value) const { return value ? truth_ : nil(); }
  ValueId symbol(std::string_view name);
  ValueId keyword(std::string_view name);
  ValueId string(std::string_view text);
  ValueId number(const Number& number);
  ValueId counter(std::int64_t count);
  ValueId cons(ValueId head, ValueId tail);
  ValueId list(const std::vector<ValueId>& items);
  ValueId failure(std::string_view failure_class);
  /// The failure that a Lisp error becomes where it leaves a task.
  ValueId envelope(ValueId error);
  /// The error in an envelope; none for any other value.
  std::optional<ValueId> enveloped(ValueId failure) const;
  ValueId model(ModelValueId id);
  ValueId not_given();
  ValueId multiple(const std::vector<ValueId>& all);
  /// A symbol that no text can name.
  ValueId gensym(std::string_view prefix);
  ValueId intern(Value value);

  /// `eql` and `equal` of Lisp; where a value came from does not matter. `same` of lists is their
  /// structure: there are no two lists that differ in nothing but their identity.
  bool same(ValueId a, ValueId b) const;
  bool equal(ValueId a, ValueId b) const;
  /// May two things that Lisp tells apart have this value? `equal` looks into lists and strings,
  /// `eql` does not.
  bool may_be_two(ValueId id, bool equal) const;
  /// Says why the answer of a built-in may be another one on the robot; the text is a literal.
  void doubt(std::string_view why) { doubt_ = why; }
  /// The last doubt since this was asked; empty: none.
  std::string_view take_doubt() { return std::exchange(doubt_, {}); }
  /// The first of multiple values; any other value is itself.
  ValueId primary(ValueId id) const;

  const Value& operator[](ValueId id) const { return values_[id]; }
  ValueKind kind(ValueId id) const { return values_[id].kind; }
  bool is_nil(ValueId id) const { return id == nil(); }
  /// The elements of a proper list; none for anything else.
  std::optional<std::vector<ValueId>> elements(ValueId id) const;
  /// The value of one key of a designator.
  std::optional<ValueId> key(ValueId designator, std::string_view name) const;
  /// More than kMaxPlanValues were made, or more than kMaxPlanText in them. Lists are not built any
  /// more, and the plan's execution must stop.
  bool full() const { return values_.size() > kMaxPlanValues || too_much_text(); }
  bool too_much_text() const { return text_size_ > kMaxPlanText; }
  /// The number of list elements that `elements` has walked over: work that steps do not show.
  std::int64_t elements_read() const { return elements_read_; }
  /// For messages.
  std::string print(ValueId id) const;

 private:
  void note_parts(Value& value) const;

  base::Store<ValueId, Value> values_;
  std::map<std::string, ValueId> ids_;
  ValueId truth_;
  std::int64_t gensyms_ = 0;
  std::string_view doubt_;
  bool from_data_ = false;                  // values exist that know where they came from
  mutable std::int64_t elements_read_ = 0;  // a statistic, no part of the value
  std::size_t text_size_ = 0;
};

}  // namespace parallax::compiler
