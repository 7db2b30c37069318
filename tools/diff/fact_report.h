#pragma once

#include <string>
#include <vector>

#include "compiler/compare/fact.h"

namespace parallax::tools {

/// Two lists of facts and what they have not in common; outlived by the lists.
struct FactReport {
  const std::vector<compiler::Fact>& old_facts;
  const std::vector<compiler::Fact>& new_facts;
  compiler::FactDifference difference;
};
FactReport compare(const std::vector<compiler::Fact>& old_facts,
                   const std::vector<compiler::Fact>& new_facts);

/// The part of the difference that is of one kind.
compiler::FactDifference of_kind(const FactReport& report, compiler::FactKind kind);

/// "TITLE: 1 removed, 2 added" and a line for each, in the order of the texts; with `stat` the
/// first line alone. Empty if there is no difference of the kind.
std::string to_text(const FactReport& report, compiler::FactKind kind, const std::string& title,
                    bool stat);

/// {"removed": [{"text", "file", "line"}], "added": [...], "changed": [{"old": {...}, "new":
/// {...}}]}
std::string to_json(const FactReport& report, compiler::FactKind kind);

}  // namespace parallax::tools
