#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"

namespace parallax::runtime {

/// Value that a text claims for an atom, and where.
struct AtomClaim {
  bool value = true;
  base::SourceRange source;
};

/// Values that a text claims for the atoms of one kind at one timepoint, by printed name.
struct AtomClaims {
  /// Atoms that are not listed are false. Otherwise nothing is claimed about them.
  bool closed = false;
  std::map<std::string, AtomClaim, std::less<>> listed = {};
  /// Said to be undetermined: not listed, and nothing is said of it even if the others are false.
  std::set<std::string, std::less<>> open = {};

  std::optional<bool> value(const std::string& name) const {
    const auto found = listed.find(name);
    if (found != listed.end()) return found->second.value;
    return closed && !open.contains(name) ? std::optional(false) : std::nullopt;
  }
};

struct ClaimedPoint {
  AtomClaims holds, happens, released;
  base::SourceRange source;
};

/// A trace as a file describes it. It need not mention every atom.
struct ClaimedTrace {
  std::int64_t number = 0;
  std::vector<ClaimedPoint> points;  // not empty
  AtomClaims predicates;
  base::SourceRange source;
  compiler::Timepoint length() const { return static_cast<compiler::Timepoint>(points.size()) - 1; }
};

}  // namespace parallax::runtime
