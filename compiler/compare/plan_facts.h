#pragma once

#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/compare/fact.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

/// A fact for every form of a plan file, as data: layout, comments and case say nothing. A
/// definition is known by its name. That the forms stand in an order is a fact of its own, since a
/// later definition replaces an earlier one.
std::vector<Fact> plan_facts(const LispText& plan, const base::SourceFiles& files);

/// Drops the facts of an order from both revisions where what both have stands in the same order;
/// what was added and removed are facts of their own. A name that occurs twice keeps it.
void drop_equal_order(std::vector<Fact>& old_facts, std::vector<Fact>& new_facts);

/// The order of the declarations among the facts of a model, where it says something: the first
/// initial state is the first by this order.
Fact declaration_order(const std::vector<Fact>& facts);

/// A fact for every entry of a binding table, without comments and layout, and one for their order,
/// since the first entry that matches counts.
std::vector<Fact> binding_facts(base::FileId file, const base::SourceFiles& files);

/// The forms in their order, in a layout of our own of at most 100 columns where the data allow.
std::string canonical_plan(const LispText& plan);

/// A piece that only one of two forms has, or two pieces of which one replaces the other.
struct DatumEdit {
  std::string removed, added;  // on one line; empty: there is none
  FactPlace old_place, new_place;
  /// Text that was put around the unchanged part, or taken away from around it; `...` stands for
  /// that part. Empty if the edit is not such a wrap.
  std::string around;
};

/// The smallest pieces in which two forms differ, in the order of the text.
std::vector<DatumEdit> datum_edits(const LispText& old_plan, DatumId old_form,
                                   const LispText& new_plan, DatumId new_form,
                                   const base::SourceFiles& files);

}  // namespace parallax::compiler
