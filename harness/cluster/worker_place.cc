#include "harness/cluster/worker_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/whole_number.h"
#include "harness/cluster/shell_words.h"

namespace parallax::harness {
namespace {

constexpr std::string_view kSpace = " \t\r";

/// The lines of a text that say something.
class HostsReader {
 public:
  HostsReader(base::FileId file, std::string_view text, base::DiagnosticSink& sink)
      : file_(file), text_(text), sink_(sink) {}

  base::Result<std::vector<WorkerPlace>> read() {
    const auto errors_before = sink_.error_count();
    for (std::size_t begin = 0; begin < text_.size();) {
      const auto end = std::min(text_.find('\n', begin), text_.size());
      read_line(begin, end);
      begin = end + 1;
    }
    if (sink_.error_count() != errors_before) return sink_.already_reported();
    if (places_.empty()) return fail(0, 0, "the file names no place");
    return std::move(places_);
  }

 private:
  base::DiagnosticBuilder fail(std::size_t begin, std::size_t end, const std::string& why) {
    return sink_.error(codes::kBadHostLine,
                       base::SourceRange{file_, static_cast<std::uint32_t>(begin),
                                         static_cast<std::uint32_t>(end)},
                       why);
  }

  void read_line(std::size_t begin, std::size_t end) {
    const auto first = text_.find_first_not_of(kSpace, begin);
    if (first >= end || text_[first] == '#') return;
    const auto behind = std::min(text_.find_first_of(kSpace, first), end);
    const auto word = text_.substr(first, behind - first);
    const auto slots = base::whole_number<std::uint32_t>(word);
    if (!slots || *slots == 0 || *slots > kMostSlots) {
      fail(first, behind,
           fmt::format("a line begins with its number of slots, 1 to {}", kMostSlots));
      return;
    }
    slots_ += *slots;
    if (slots_ > kMostSlots) {
      fail(first, behind, fmt::format("these are more than {} slots in all", kMostSlots));
      return;
    }
    auto last = end;
    while (last > behind && kSpace.find(text_[last - 1]) != std::string_view::npos) --last;
    const auto from = std::min(text_.find_first_not_of(kSpace, behind), last);
    const auto prefix = text_.substr(from, last - from);
    auto split = split_shell_words(prefix);
    if (!split.fault.empty()) {
      fail(from + split.fault_at, from + split.fault_at + 1, split.fault);
    } else if (split.words.empty()) {
      fail(first, behind, "no command follows; `env` starts workers on this machine");
    } else {
      places_.push_back({std::move(split.words), std::string(prefix), *slots});
    }
  }

  base::FileId file_;
  std::string_view text_;
  base::DiagnosticSink& sink_;
  std::vector<WorkerPlace> places_;
  std::int64_t slots_ = 0;
};

}  // namespace

base::Result<WorkerPlace> launcher_place(const std::string& text, std::int64_t slots,
                                         base::DiagnosticSink& sink) {
  auto split = split_shell_words(text);
  if (!split.fault.empty()) {
    return sink.error_about(codes::kBadLauncher, "--launcher",
                            fmt::format("{} (byte {})", split.fault, split.fault_at + 1));
  }
  if (split.words.empty()) {
    return sink.error_about(codes::kBadLauncher, "--launcher", "it has no word");
  }
  return WorkerPlace{std::move(split.words), text, slots};
}

base::Result<std::vector<WorkerPlace>> read_hosts(const std::filesystem::path& path,
                                                  base::SourceFiles& files,
                                                  base::DiagnosticSink& sink) {
  const auto file = base::load_text(path, files, sink);
  if (!file) return sink.already_reported();
  return HostsReader(*file, files[*file].text(), sink).read();
}

}  // namespace parallax::harness
