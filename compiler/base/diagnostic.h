#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic_code.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"

namespace parallax::base {

enum class Severity : std::uint8_t { kError, kWarning };

/// Class of an error, which determines the exit code of the program (docs: interface, exit codes).
enum class DiagnosticClass : std::uint8_t {
  kUsage,         // 2: unknown flag, missing file
  kInput,         // 3: a model, plan, scenario or artifact has an error
  kInconclusive,  // 4: a limit ended the run, the simulator was lost too often
  kInternal,      // 5: an independent check disagreed
};

struct DiagnosticInfo {
  DiagnosticCode code;
  std::string_view name;  // "kUnknownKey"
  std::string_view id;    // "E5102"
  Severity severity;
  DiagnosticClass klass;
  std::string_view format;  // fmt format string of the message
  std::string_view help;    // how to mend it, in a sentence
};
const DiagnosticInfo& info(DiagnosticCode code);
/// All codes, in their order.
const std::vector<DiagnosticInfo>& all_diagnostics();

struct DiagnosticNote {
  std::optional<SourceRange> range;
  std::string text;
};

struct Diagnostic {
  DiagnosticCode code;
  std::optional<SourceRange> range;  // where, in a text that was read
  std::string subject;               // else: a path or another name, possibly empty
  std::string message;
  std::vector<DiagnosticNote> notes;
  std::string fix;
  std::string help;       // advice for this place; empty: that of the registry
  std::size_t again = 0;  // further places at which the same name is unknown
};

class DiagnosticSink;

/// Returned by DiagnosticSink::error and warning: adds notes and a fix, converts to Reported.
class DiagnosticBuilder {
 public:
  DiagnosticBuilder& note(SourceRange range, std::string text);
  DiagnosticBuilder& note(std::string text);
  DiagnosticBuilder& fix(std::string text);
  DiagnosticBuilder& help(std::string text);
  operator Reported() const { return Reported(); }  // NOLINT: the point of the type
  template <typename T>
  operator Result<T>() const {  // NOLINT: `return sink.error(...)` from any fallible function
    return Result<T>(Reported());
  }

 private:
  friend class DiagnosticSink;
  DiagnosticBuilder(DiagnosticSink& sink, std::size_t index) : sink_(&sink), index_(index) {}
  Diagnostic* entry();
  DiagnosticSink* sink_;
  std::size_t index_;
};

/// Collects errors in the user's input; never prints. Beyond the limits errors and warnings are
/// counted but not kept. An unknown name is one error, however often it is used: further places are
/// counted in a note.
class DiagnosticSink {
 public:
  static constexpr std::size_t kUsualLimit = 20;

  explicit DiagnosticSink(std::size_t error_limit = kUsualLimit,
                          std::size_t warning_limit = kUsualLimit)
      : error_limit_(error_limit), warning_limit_(warning_limit) {}

  /// The arguments fill the format of the code's registry line.
  template <typename... Args>
  DiagnosticBuilder error(DiagnosticCode code, SourceRange range, const Args&... args) {
    return add(code, range, {}, fmt::format(fmt::runtime(info(code).format), args...));
  }
  /// For errors without a place in a text: a missing file, a process. `subject` is usually a path.
  template <typename... Args>
  DiagnosticBuilder error_about(DiagnosticCode code, std::string subject, const Args&... args) {
    return add(code, std::nullopt, std::move(subject),
               fmt::format(fmt::runtime(info(code).format), args...));
  }
  template <typename... Args>
  DiagnosticBuilder warning(DiagnosticCode code, SourceRange range, const Args&... args) {
    return error(code, range, args...);
  }

  /// Reports again what another sink has, at `place`: for texts that were made from the user's.
  /// `made` is shown in a note.
  void adopt(const DiagnosticSink& other, SourceRange place, const std::string& made);

  /// Warnings of this code are neither kept nor counted from now on.
  void mute(DiagnosticCode warning) { muted_.push_back(warning); }

  std::size_t error_count() const { return error_count_; }
  /// Those of them that are places of an error which is kept.
  std::size_t merged_count() const { return merged_; }
  std::size_t warning_count() const { return warning_count_; }
  bool has_errors() const { return error_count_ != 0; }
  /// The exit code that the errors ask for: the smallest class wins (usage before input ...).
  int exit_code() const;
  /// For a function that only knows that something below it has reported already.
  Reported already_reported() const;
  /// Sorted by file, offset and code, duplicates removed; those without a range come first.
  std::vector<Diagnostic> sorted() const;

 private:
  friend class DiagnosticBuilder;
  DiagnosticBuilder add(DiagnosticCode code, std::optional<SourceRange> range, std::string subject,
                        std::string message);
  std::vector<Diagnostic> entries_;
  std::vector<DiagnosticCode> muted_;
  std::map<std::pair<DiagnosticCode, std::string>, std::size_t> unknown_;  // entries, by message
  std::size_t merged_ = 0;
  std::size_t error_limit_;
  std::size_t warning_limit_;
  std::size_t error_count_ = 0;
  std::size_t warning_count_ = 0;
  Diagnostic dropped_{};
};

}  // namespace parallax::base
