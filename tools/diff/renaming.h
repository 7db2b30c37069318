#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/diff/revision.h"

namespace parallax::tools {

/// A name of the old side that the new side has under another name: a constant, a sort, a fluent,
/// an event, a region, a body.
struct Renaming {
  std::string before, after;
  bool is_variable = false;  // named after a sort (`person1`); not told
};

/// `OLD=NEW`, two names; none if the text is no such rule.
std::optional<Renaming> parse_renaming(std::string_view text);

/// Finds names that only one side has and that are used alike: more than half of the facts and
/// settings that have the one are, but for the name, those that have the other. The most similar
/// pairs are matched first. None where more than 64 names are on one side alone.
std::vector<Renaming> find_renamings(const ModelRevision& old_side, const ModelRevision& new_side);

/// The same renamings, with the variables that are named after renamed sorts.
std::vector<Renaming> with_variables(std::vector<Renaming> renamings, const ModelRevision& old_side,
                                     const ModelRevision& new_side);

/// Has the side the name?
bool has_name(const ModelRevision& side, const std::string& name);

/// Gives the side the new names, all at once.
void rename(ModelRevision& side, const std::vector<Renaming>& renamings);

/// "names: 1 renamed" and a line for each but variables; with `stat` the first line alone. Empty
/// without any.
std::string renamings_text(const std::vector<Renaming>& renamings, bool stat);
/// [{"old", "new"}]
std::string renamings_json(const std::vector<Renaming>& renamings);

}  // namespace parallax::tools
