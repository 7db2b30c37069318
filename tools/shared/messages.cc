#include "tools/shared/messages.h"

#include <string_view>
#include <utility>

#include "compiler/base/diagnostic_printer.h"
#include "tools/app/version.h"

namespace parallax::api {

static_assert(std::string_view(PARALLAX_VERSION) == tools::kVersion,
              "the header's version is the project's");

std::string version() { return tools::kVersion; }

Failure::Failure(const std::string& what, std::vector<Message> messages)
    : std::runtime_error(what), messages_(std::move(messages)) {}
Failure::~Failure() = default;

std::vector<Message> messages_of(const tools::Context& context) {
  std::vector<Message> out;
  for (const auto& diagnostic : context.sink().sorted()) {
    const auto& known = base::info(diagnostic.code);
    Message message;
    message.is_error = known.severity == base::Severity::kError;
    message.code = known.id;
    message.text = diagnostic.message;
    message.path = diagnostic.subject;
    message.fix = diagnostic.fix;
    if (diagnostic.range) {
      const auto& file = context.files()[diagnostic.range->file];
      const auto place = file.position(diagnostic.range->begin);
      message.path = file.name();
      message.line = static_cast<int>(place.line);
      message.column = static_cast<int>(place.column);
    }
    out.push_back(std::move(message));
  }
  return out;
}

void fail(const tools::Context& context) {
  std::string text;
  for (const auto& diagnostic : context.sink().sorted()) {
    if (base::info(diagnostic.code).severity != base::Severity::kError) continue;
    text += base::to_text(diagnostic, context.files(), {});
  }
  throw Failure(text.empty() ? "stopped before there was an answer" : text, messages_of(context));
}

}  // namespace parallax::api
