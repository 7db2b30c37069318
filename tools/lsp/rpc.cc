// Members of messages, checked as they are taken: an editor may send anything, and a member that is
// missing or has another type is answered with an error that names it.

#include "tools/lsp/rpc.h"

#include <fmt/format.h>

namespace parallax::tools::lsp {

const Json& member(const Json& object, const char* name) {
  const auto* found = base::json_member(object, name);
  if (found == nullptr)
    throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is missing", name)};
  return *found;
}

std::string text_member(const Json& object, const char* name) {
  const auto text = base::json_as<std::string>(member(object, name));
  if (!text) throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is no text", name)};
  return *text;
}

std::int64_t number_member(const Json& object, const char* name) {
  const auto number = base::json_as<std::int64_t>(member(object, name));
  if (!number)
    throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is no whole number", name)};
  return *number;
}

EditorPlace place_of(const Json& position) {
  return {number_member(position, "line"), number_member(position, "character")};
}

Json json_of(const EditorPlace& place) {
  return {{"line", place.line}, {"character", place.column}};
}

Json range_of(const Positions& positions, std::size_t begin, std::size_t end) {
  return {{"start", json_of(positions.place(begin))}, {"end", json_of(positions.place(end))}};
}

}  // namespace parallax::tools::lsp
