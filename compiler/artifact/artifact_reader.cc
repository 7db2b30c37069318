#include "compiler/artifact/artifact_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/compiled_model.h"
#include "compiler/artifact/section_readers.h"
#include "compiler/base/codes/artifacts.h"
#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/base/hash.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/whole_number.h"

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

/// Warns (kArtifactStale) of the texts that a compiled model was made from and that are others by
/// now, or gone while one beside them is still there. They are looked for by the names in the
/// header, from the current folder and from that of the artifact; where none is found nothing is
/// said. Only files that the artifact may name (PathGate) are read; all are inputs of `files`.
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

constexpr std::int64_t kMaxHorizon = 1'000'000;  // as on the command line
// A variable takes some bytes wherever it is used; models may have some that are used nowhere.
constexpr std::int64_t kFreeVariables = 1'000'000;
constexpr std::int64_t kFreeTableEntries = 4096;
constexpr std::int64_t kBytesPerTableEntry = 8;

class ArtifactReader {
 public:
  ArtifactReader(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink)
      : cursor_(files, file, sink),
        symbols_(cursor_, model_),
        objectives_(cursor_, model_),
        provenance_(cursor_, model_) {}

  base::Result<CompiledModel> run() && {
    if (!read_format() || !read_entries()) return cursor_.sink().already_reported();
    ClauseReader clauses(cursor_, model_);
    if (!clauses.read(provenance_.clause_count(), provenance_.runs())) {
      return cursor_.sink().already_reported();
    }
    if (!check_hash()) return cursor_.sink().already_reported();
    symbols_.name_the_rest();
    return std::move(model_);
  }

 private:
  struct Entry {
    std::string_view key;
    bool (ArtifactReader::*read)();
    bool once;         // at most one line, which has to be there but for `producer`
    bool needs_frame;  // speaks of slots, variables or timepoints
  };
  static const std::vector<Entry>& entries();

  bool read_format();
  bool read_entries();
  bool read_entry();
  bool read_producer();
  bool read_option();
  bool read_source();
  bool read_fnv(std::uint64_t& hash);
  bool read_horizon();
  bool read_base() { return read_size("the number of fixed variables", base_); }
  bool read_stride() { return read_size("the number of slots", stride_); }
  bool read_state_slots() { return read_size("the number of state slots", state_slots_); }
  bool read_state_constraints() { return read_flag(model_.has_constraints); }
  bool read_fluent() { return symbols_.read_fluent(); }
  bool read_event() { return symbols_.read_event(); }
  bool read_slot() { return symbols_.read_slot(); }
  bool read_atom() { return symbols_.read_atom(); }
  bool read_objective() { return objectives_.read_objective(); }
  bool read_term() { return objectives_.read_term(); }
  bool read_in() { return provenance_.read_in(); }
  bool read_axiom() { return provenance_.read_axiom(); }
  bool read_section() { return provenance_.read_section(); }
  bool read_clauses() { return provenance_.read_clauses(); }
  bool read_step() { return provenance_.read_step(); }
  bool read_argument() { return provenance_.read_argument(); }
  bool read_cut() { return provenance_.read_cut(); }
  bool read_hash();
  bool check_hash();

  bool read_size(std::string_view what, std::int64_t& size);
  bool read_flag(bool& flag);
  bool complete_frame();

  ArtifactCursor cursor_;
  CompiledModel model_;
  SymbolReader symbols_;
  ObjectiveReader objectives_;
  ProvenanceReader provenance_;
  std::set<std::string_view> seen_;  // keys that stand once
  std::int64_t minor_ = 0;
  std::int64_t base_ = 0, stride_ = 0, state_slots_ = 0;
  bool has_frame_ = false;
  std::optional<std::uint64_t> hash_;  // expected hash of the lines
  base::SourceRange hash_place_;
};

const std::vector<ArtifactReader::Entry>& ArtifactReader::entries() {
  using Reader = ArtifactReader;
  static const std::vector<Entry> table = {
      {"producer", &Reader::read_producer, true, false},
      {"option", &Reader::read_option, false, false},
      {"source", &Reader::read_source, false, false},
      {"horizon", &Reader::read_horizon, true, false},
      {"base", &Reader::read_base, true, false},
      {"stride", &Reader::read_stride, true, false},
      {"state-slots", &Reader::read_state_slots, true, false},
      {"state-constraints", &Reader::read_state_constraints, true, false},
      {"fluent", &Reader::read_fluent, false, true},
      {"event", &Reader::read_event, false, true},
      {"slot", &Reader::read_slot, false, true},
      {"atom", &Reader::read_atom, false, true},
      {"objective", &Reader::read_objective, false, true},
      {"term", &Reader::read_term, false, true},
      {"in", &Reader::read_in, false, false},
      {"axiom", &Reader::read_axiom, false, false},
      {"section", &Reader::read_section, false, true},
      {"clauses", &Reader::read_clauses, false, true},
      {"step", &Reader::read_step, false, false},
      {"argument", &Reader::read_argument, false, false},
      {"cut", &Reader::read_cut, false, false},
      {"hash", &Reader::read_hash, false, false},
  };
  return table;
}

/// `c dec format MAJOR.MINOR` is the first line.
bool ArtifactReader::read_format() {
  if (!cursor_.next_line()) return cursor_.fail(codes::kNotAnArtifact, "it is empty");
  if (!cursor_.line().starts_with("c dec format ")) {
    cursor_.raw_word();
    return cursor_.fail(codes::kNotAnArtifact, "its first line is not `c dec format 1.0`");
  }
  cursor_.raw_word(), cursor_.raw_word(), cursor_.raw_word();
  const auto version = cursor_.raw_word();
  const auto dot = version.find('.');
  if (dot == std::string_view::npos) return cursor_.expected("a version MAJOR.MINOR");
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  std::int64_t major = 0;
  if (!cursor_.parse_number(version.substr(0, dot), "the major version", 0, kMost, major) ||
      !cursor_.parse_number(version.substr(dot + 1), "the minor version", 0, kMost, minor_)) {
    return false;
  }
  if (major != kFormatMajor) {
    return cursor_.fail(codes::kArtifactVersion, fmt::format("{}.{}", major, minor_), kFormatMajor);
  }
  return cursor_.end_of_line();
}

bool ArtifactReader::read_entries() {
  while (cursor_.next_line()) {
    const auto line = cursor_.line();
    if (line.starts_with("p ")) return complete_frame() && symbols_.check_hits();
    if (line.starts_with("c dec ")) {
      if (!read_entry()) return false;
    } else if (!line.empty() && line != "c" && !line.starts_with("c ")) {
      cursor_.raw_word();
      return cursor_.expected("`c dec`, a comment or `p cnf`");
    }
  }
  return cursor_.expected("`p cnf`");
}

bool ArtifactReader::read_entry() {
  cursor_.raw_word(), cursor_.raw_word();
  const auto key = cursor_.raw_word();
  for (const auto& entry : entries()) {
    if (entry.key != key) continue;
    if (entry.once && !seen_.insert(entry.key).second) {
      return cursor_.fail(codes::kArtifactTwice, fmt::format("`c dec {}`", key));
    }
    if (entry.needs_frame && !complete_frame()) return false;
    return (this->*entry.read)();
  }
  if (minor_ <= kFormatMinor) return cursor_.expected("an entry of the format");
  constexpr std::size_t kShown = 40;
  cursor_.warn(codes::kArtifactUnknownKey, key.substr(0, kShown),
               fmt::format("{}.{}", kFormatMajor, minor_));
  return true;
}

bool ArtifactReader::read_producer() {
  return cursor_.word("a program and its version", model_.producer) && cursor_.end_of_line();
}

bool ArtifactReader::read_option() {
  std::string name, value;
  if (!cursor_.word("the name of an option", name)) return false;
  if (model_.options.contains(name)) {
    return cursor_.fail(codes::kArtifactTwice, fmt::format("the option `{}`", name));
  }
  if (!cursor_.word("the value of an option", value)) return false;
  model_.options.emplace(std::move(name), std::move(value));
  return cursor_.end_of_line();
}

bool ArtifactReader::read_source() {
  SourceText source;
  if (!cursor_.word("the name of a file", source.name) || !read_fnv(source.hash)) return false;
  model_.sources.push_back(std::move(source));
  return cursor_.end_of_line();
}

bool ArtifactReader::read_fnv(std::uint64_t& hash) {
  constexpr std::size_t kHashDigits = 16;
  if (cursor_.raw_word() != "fnv1a64") return cursor_.expected("`fnv1a64`");
  const auto digits = cursor_.raw_word();
  const auto number = base::whole_number<std::uint64_t>(digits, 16);
  if (digits.size() != kHashDigits || !number) return cursor_.expected("16 hexadecimal digits");
  hash = *number;
  return true;
}

bool ArtifactReader::read_hash() {
  if (hash_) return cursor_.fail(codes::kArtifactTwice, "`c dec hash`");
  std::uint64_t hash = 0;
  if (!read_fnv(hash)) return false;
  hash_ = hash;
  hash_place_ = cursor_.last();
  return cursor_.end_of_line();
}

/// Are the lines those that were written? A file edited by hand has to lose its hash.
bool ArtifactReader::check_hash() {
  if (!hash_ || *hash_ == cursor_.hash()) return true;
  cursor_.sink().error(codes::kArtifactCounts, hash_place_, "the hash of the lines",
                       fmt::format("{:016x}", cursor_.hash()), "`c dec hash`",
                       fmt::format("{:016x}", *hash_));
  return false;
}

bool ArtifactReader::read_horizon() {
  std::int64_t horizon = 0;
  if (!cursor_.number("the horizon", 0, kMaxHorizon, horizon)) return false;
  model_.horizon = static_cast<Timepoint>(horizon);
  return cursor_.end_of_line();
}

bool ArtifactReader::read_size(std::string_view what, std::int64_t& size) {
  const auto bytes = static_cast<std::int64_t>(cursor_.file_size());
  if (!cursor_.number(what, 0, std::numeric_limits<std::int32_t>::max(), size)) return false;
  if (size > kFreeTableEntries + bytes / kBytesPerTableEntry) {
    return cursor_.fail(codes::kArtifactOversized, what, size, bytes);
  }
  return cursor_.end_of_line();
}

bool ArtifactReader::read_flag(bool& flag) {
  const auto text = cursor_.raw_word();
  if (text != "yes" && text != "no") return cursor_.expected("`yes` or `no`");
  flag = text == "yes";
  return cursor_.end_of_line();
}

/// Makes the tables once everything is known that sizes them.
bool ArtifactReader::complete_frame() {
  if (has_frame_) return true;
  for (const auto& entry : entries()) {
    if (!entry.once || entry.key == "producer" || seen_.contains(entry.key)) continue;
    return cursor_.fail(codes::kArtifactMissing, fmt::format("c dec {}", entry.key));
  }
  if (state_slots_ > stride_) {
    return cursor_.fail(codes::kArtifactRange, "the number of state slots", state_slots_, 0,
                        stride_);
  }
  const auto bytes = static_cast<std::int64_t>(cursor_.file_size());
  const auto variables = base_ + std::int64_t{model_.horizon} * stride_ + state_slots_;
  if (variables > kFreeVariables + bytes ||
      variables > std::numeric_limits<std::int32_t>::max() / 2) {
    return cursor_.fail(codes::kArtifactOversized, "the number of variables", variables, bytes);
  }
  model_.fixed.resize(static_cast<std::size_t>(base_));
  model_.slots.resize(static_cast<std::size_t>(stride_));
  model_.state_slots = static_cast<std::uint32_t>(state_slots_);
  has_frame_ = true;
  return true;
}

}  // namespace

base::Result<CompiledModel> read_artifact(base::FileId file, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  return ArtifactReader(file, files, sink).run();
}

base::Result<CompiledModel> load_artifact(const std::filesystem::path& path,
                                          base::SourceFiles& files, base::DiagnosticSink& sink) {
  files.note_input(path.string());
  auto text = base::read_file(path, sink, kMaxArtifactBytes);
  if (!text) return sink.already_reported();
  const auto file = files.add(path.string(), *std::move(text));
  auto model = read_artifact(file, files, sink);
  if (model) tell_stale_texts(*model, file, files, sink);
  return model;
}

}  // namespace parallax::compiler
