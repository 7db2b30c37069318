#pragma once

#include <string>
#include <vector>

#include "parallax/parallax.h"
#include "tools/app/context.h"

namespace parallax::api {

/// All that was reported so far, in the order of the texts.
std::vector<Message> messages_of(const tools::Context& context);

/// Throws Failure with what was reported.
[[noreturn]] void fail(const tools::Context& context);

}  // namespace parallax::api
