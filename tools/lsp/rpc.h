#pragma once

#include <cstdint>
#include <string>

#include "compiler/base/json.h"
#include "tools/lsp/positions.h"

namespace parallax::tools::lsp {

using Json = nlohmann::json;

/// Error codes of JSON-RPC and of the Language Server Protocol.
enum class RpcError : int {
  kParse = -32700,
  kInvalidRequest = -32600,
  kNoMethod = -32601,
  kInvalidParams = -32602,
  kNotInitialized = -32002,
  kFailed = -32803,
};

/// Thrown while a request is answered; its sender is told.
struct Refused {
  RpcError code;
  std::string text;
};

/// The member of a message's object. Throws Refused (kInvalidParams) if it is missing, as the next
/// two do if it has another type.
const Json& member(const Json& object, const char* name);
std::string text_member(const Json& object, const char* name);
std::int64_t number_member(const Json& object, const char* name);

/// The protocol's `Position`.
EditorPlace place_of(const Json& position);
Json json_of(const EditorPlace& place);
/// The protocol's `Range` of bytes [begin, end).
Json range_of(const Positions& positions, std::size_t begin, std::size_t end);

}  // namespace parallax::tools::lsp
