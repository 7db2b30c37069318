#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lisp/lisp_data.h"

namespace parallax::compiler {

/// Finds what a run of a plan can come to: everything that the text of what it comes to names.
class PlanReach {
 public:
  explicit PlanReach(const LispData& data) : data_(data) {}
  /// A function, macro or global.
  void define(std::string_view key, DatumId form) { definitions_.emplace(key, form); }
  /// A `define-condition`: where the reader of a slot is named, its :initform counts.
  void add_slots(DatumId condition);
  /// A `def-fact-group`. A rule for a type of actions counts where the type is named, any other
  /// clause where its predicate is.
  void add_facts(DatumId group);
  /// The run begins with these forms and with the definitions of these names.
  void find(std::span<const DatumId> forms, std::span<const std::string> names);
  bool contains(std::string_view key) const { return reached_.contains(key); }

 private:
  struct Clause {
    std::vector<std::string> conditions;  // names, of which any is enough; none: it always counts
    DatumId form;
  };
  void reach(std::string_view name);
  void read(DatumId form);
  bool counts(const Clause& clause) const;

  const LispData& data_;
  std::multimap<std::string, DatumId, std::less<>> definitions_;
  std::vector<Clause> clauses_;
  std::set<std::string, std::less<>> reached_;  // names and keys
  std::vector<DatumId> open_;
};

}  // namespace parallax::compiler
