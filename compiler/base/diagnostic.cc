#include "compiler/base/diagnostic.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "compiler/base/codes/artifacts.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/codes/grounding.h"
#include "compiler/base/codes/names.h"
#include "compiler/base/codes/plans.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/base/codes/texts.h"

namespace parallax::base {
namespace {

constexpr std::size_t kDropped = std::numeric_limits<std::size_t>::max();

/// Cuts the middle out of a long message: it quotes the input, and hostile input has names of a
/// megabyte. The cause in front and the text after the quotation stay.
std::string shortened(std::string message) {
  constexpr std::size_t kLongest = 2000, kKept = 900;
  if (message.size() <= kLongest) return message;
  return message.substr(0, kKept) + " [...] " + message.substr(message.size() - kKept);
}

bool is_unknown_name(DiagnosticCode code) {
  return code == codes::kUnknownSort || code == codes::kUnknownName ||
         code == codes::kVariableWithoutSort;
}

auto sort_key(const Diagnostic& d) {
  const bool located = d.range.has_value();
  return std::tuple(located, located ? d.range->file.index() : 0U, located ? d.range->begin : 0U,
                    static_cast<int>(d.code));
}

}  // namespace

const std::vector<DiagnosticInfo>& all_diagnostics() {
  static const auto table = [] {
    std::vector<DiagnosticInfo> all = {
#define PARALLAX_DIAGNOSTIC(name, code, severity, klass, format, help) \
  {codes::name, #name, code, Severity::severity, DiagnosticClass::klass, format, help},
#include "compiler/base/codes/artifacts.def"
#include "compiler/base/codes/campaigns.def"
#include "compiler/base/codes/files.def"
#include "compiler/base/codes/grounding.def"
#include "compiler/base/codes/names.def"
#include "compiler/base/codes/plans.def"
#include "compiler/base/codes/scenarios.def"
#include "compiler/base/codes/texts.def"
#undef PARALLAX_DIAGNOSTIC
    };
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.code < b.code; });
    return all;
  }();
  return table;
}

const DiagnosticInfo& info(DiagnosticCode code) {
  const auto& all = all_diagnostics();
  return *std::lower_bound(all.begin(), all.end(), code,
                           [](const auto& entry, auto wanted) { return entry.code < wanted; });
}

Diagnostic* DiagnosticBuilder::entry() {
  return index_ == kDropped ? &sink_->dropped_ : &sink_->entries_[index_];
}

DiagnosticBuilder& DiagnosticBuilder::note(SourceRange range, std::string text) {
  entry()->notes.push_back({range, shortened(std::move(text))});
  return *this;
}

DiagnosticBuilder& DiagnosticBuilder::note(std::string text) {
  entry()->notes.push_back({std::nullopt, shortened(std::move(text))});
  return *this;
}

DiagnosticBuilder& DiagnosticBuilder::fix(std::string text) {
  entry()->fix = shortened(std::move(text));
  return *this;
}

DiagnosticBuilder& DiagnosticBuilder::help(std::string text) {
  entry()->help = shortened(std::move(text));
  return *this;
}

DiagnosticBuilder DiagnosticSink::add(DiagnosticCode code, std::optional<SourceRange> range,
                                      std::string subject, std::string message) {
  const bool is_error = info(code).severity == Severity::kError;
  auto& count = is_error ? error_count_ : warning_count_;
  const bool muted = !is_error && std::find(muted_.begin(), muted_.end(), code) != muted_.end();
  const auto drop = [&] {
    dropped_ = Diagnostic{};
    return DiagnosticBuilder(*this, kDropped);
  };
  if (muted) return drop();
  ++count;
  const bool unknown = range && is_unknown_name(code);
  if (unknown) {
    const auto first = unknown_.find({code, message});
    if (first != unknown_.end()) {
      auto& entry = entries_[first->second];
      if (entry.range != range) ++entry.again;
      ++merged_;
      return drop();
    }
  }
  const auto kept = is_error ? count - merged_ : count;
  if (kept > (is_error ? error_limit_ : warning_limit_)) return drop();
  if (unknown) unknown_.emplace(std::pair(code, message), entries_.size());
  entries_.push_back(
      {code, range, std::move(subject), shortened(std::move(message)), {}, {}, {}, 0});
  return DiagnosticBuilder(*this, entries_.size() - 1);
}

void DiagnosticSink::adopt(const DiagnosticSink& other, SourceRange place,
                           const std::string& made) {
  for (const auto& entry : other.sorted()) {
    auto builder = add(entry.code, place, {}, entry.message);
    builder.note("this is about `" + made + "`, made from the text here");
    if (!entry.fix.empty()) builder.fix(entry.fix);
    if (!entry.help.empty()) builder.help(entry.help);
  }
}

int DiagnosticSink::exit_code() const {
  int code = 0;
  for (const auto& entry : entries_) {
    if (info(entry.code).severity != Severity::kError) continue;
    // A path in a text is for the text to mend, not for the command line.
    const bool in_text = entry.range && (entry.code == codes::kFileNotFound ||
                                         entry.code == codes::kFileUnreadable ||
                                         entry.code == codes::kNotARegularFile);
    const auto klass = in_text ? DiagnosticClass::kInput : info(entry.code).klass;
    const int mine = 2 + static_cast<int>(klass);
    // An internal error outranks everything: a check that disagreed must not hide behind a typo.
    if (mine == 5) return 5;
    code = code == 0 ? mine : std::min(code, mine);
  }
  return code;
}

Reported DiagnosticSink::already_reported() const {
  PARALLAX_REQUIRE(has_errors(), "something was reported before");
  return Reported();
}

std::vector<Diagnostic> DiagnosticSink::sorted() const {
  auto result = entries_;
  std::stable_sort(result.begin(), result.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return sort_key(a) < sort_key(b);
  });
  const auto same = [](const Diagnostic& a, const Diagnostic& b) {
    return a.code == b.code && a.range == b.range && a.message == b.message &&
           a.subject == b.subject;
  };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  for (auto& entry : result) {
    if (entry.again == 0) continue;
    entry.notes.push_back(
        {std::nullopt, entry.again == 1
                           ? std::string("it is used in another place as well")
                           : fmt::format("it is used in {} other places as well", entry.again)});
  }
  return result;
}

}  // namespace parallax::base
