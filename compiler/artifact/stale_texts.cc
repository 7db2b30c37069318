#include "compiler/artifact/stale_texts.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/codes/artifacts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/hash.h"
#include "compiler/base/path_gate.h"

namespace parallax::compiler {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTexts = 1000;

enum class State : std::uint8_t { kSame, kChanged, kAbsent };

class TextLookup {
 public:
  TextLookup(const fs::path& artifact, base::SourceFiles& files)
      : folder_(artifact.parent_path()), gate_(false, &files), files_(files) {
    gate_.admit_beside(artifact);
    gate_.admit_current_folder();
  }

  State state_of(const SourceText& source) {
    State out = State::kAbsent;
    for (const auto& place : places_of(source.name)) {
      if (!gate_.admits(place)) continue;
      files_.note_input(place.string());
      base::DiagnosticSink unread;
      const auto text = base::read_file(place, unread);
      if (!text) continue;
      // The hash is of the text without its byte order mark.
      std::string_view bytes = *text;
      if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
      if (base::fnv1a64(bytes) == source.hash) return State::kSame;
      out = State::kChanged;
    }
    return out;
  }

 private:
  std::vector<fs::path> places_of(const fs::path& name) const {
    if (name.is_absolute() || folder_.empty()) return {name};
    return {name, (folder_ / name).lexically_normal()};
  }

  fs::path folder_;
  base::PathGate gate_;
  base::SourceFiles& files_;
};

/// Texts that are no files: those inside the program, and those of options.
bool is_built_in(std::string_view name) {
  return name.starts_with("foundations/") || name.starts_with('-') || name.starts_with('<');
}

/// The lines of the header that name the texts, in their order.
std::vector<base::SourceRange> source_lines(base::FileId artifact, std::string_view text,
                                            std::size_t count) {
  constexpr std::string_view kBegin = "c dec source ";
  std::vector<base::SourceRange> out;
  for (std::size_t at = 0; at < text.size() && out.size() < count;) {
    const auto end = std::min(text.find('\n', at), text.size());
    if (text.substr(at).starts_with(kBegin)) {
      out.push_back({artifact, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(end)});
    }
    at = end + 1;
  }
  return out;
}

}  // namespace

void tell_stale_texts(const CompiledModel& model, base::FileId artifact, base::SourceFiles& files,
                      base::DiagnosticSink& sink) {
  const auto count = std::min(model.sources.size(), kMostTexts);
  TextLookup lookup(files[artifact].name(), files);
  std::vector<State> states(count, State::kSame);
  bool any_is_there = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_built_in(model.sources[i].name)) continue;
    states[i] = lookup.state_of(model.sources[i]);
    any_is_there = any_is_there || states[i] != State::kAbsent;
  }
  const auto lines = source_lines(artifact, files[artifact].text(), count);
  for (std::size_t i = 0; i < std::min(count, lines.size()); ++i) {
    if (states[i] == State::kSame || !any_is_there) continue;
    sink.warning(codes::kArtifactStale, lines[i], model.sources[i].name,
                 states[i] == State::kChanged ? "has changed" : "was removed");
  }
}

}  // namespace parallax::compiler
