#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/lisp_reader.h"
#include "compiler/plan/lisp_token.h"

namespace parallax::compiler {

/// What waits for its next datum.
enum class OpenKind : std::uint8_t {
  kList,
  kPrefix,   // 'x and the like: takes one datum
  kFeature,  // #+ or #-: takes the feature expression
  kSkip,     // takes one datum and drops it
};

struct OpenDatum {
  OpenKind kind = OpenKind::kList;
  std::uint32_t begin = 0;
  std::size_t first_child = 0;  // kList: index into the stack of finished children
  std::string_view word;        // kPrefix: the symbol at the head of the list
  bool negated = false;         // kFeature: #-
};

/// Reads a file without recursion: what is open lies on a stack.
class LispReader {
 public:
  LispReader(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink)
      : file_(file), cursor_(files[file].text()), sink_(sink) {}

  base::Result<LispText> read();

 private:
  base::SourceRange range(std::uint32_t begin) const { return {file_, begin, cursor_.position()}; }
  base::DiagnosticBuilder unreadable(base::SourceRange where, std::string_view text) {
    failed_ = true;
    return sink_.error(base::DiagnosticCode::kUnreadableDatum, where, text);
  }
  bool suppressed() const { return skips_ != 0; }
  bool push(OpenDatum open);
  void pop();
  void deliver(DatumId datum);
  void deliver_once(DatumId datum, std::optional<DatumId>& wrapped);
  void close_list();
  void read_next();
  void read_string();
  void read_token();
  void read_symbol(const LispToken& token, std::uint32_t begin);
  void read_sharp();
  void read_character(std::uint32_t begin);
  void reject_macro(std::uint32_t begin);
  void report_open_list();

  base::FileId file_;
  LispCursor cursor_;
  base::DiagnosticSink& sink_;
  LispText out_;
  std::vector<OpenDatum> open_;
  std::vector<DatumId> finished_;                // children of the open lists
  std::size_t skips_ = 0;                        // open kSkip frames
  std::optional<base::SourceRange> column_one_;  // first `(` at column 1 inside an open list
  bool failed_ = false;
  bool stopped_ = false;
};

}  // namespace parallax::compiler
