#include "tools/cli/sample_output.h"

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "harness/report/sample_table.h"
#include "tools/cli/command.h"

namespace parallax::tools {
namespace {

bool is_csv(const std::string& path) { return path.ends_with(".csv"); }

}  // namespace

void SampleOutput::add_option(OptionTable& command, std::string& path) {
  command
      .option("--samples", path,
              "Write one row per simulation (.csv or .jsonl): start, outcome, cause, margins")
      .file({"csv", "jsonl"});
}

base::Status SampleOutput::check(Invocation& invocation) const {
  if (path_.empty()) return base::Unit{};
  auto& sink = invocation.sink();
  if (!is_csv(path_) && !path_.ends_with(".jsonl")) {
    return sink.error_about(codes::kUsage, path_,
                            "--samples writes .csv or .jsonl; end the name in one of them");
  }
  return check_replaceable(path_, harness::is_sample_table, invocation.files(), sink);
}

harness::SampleListener SampleOutput::listener() {
  if (path_.empty() && !collects_) return {};
  return [this](harness::SampleRow row) { rows_.push_back(std::move(row)); };
}

base::Status SampleOutput::write(Invocation& invocation) const {
  if (path_.empty()) return base::Unit{};
  const auto text = is_csv(path_) ? harness::samples_csv(rows_) : harness::samples_jsonl(rows_);
  return base::write_output(path_, text, invocation.files(), invocation.sink());
}

}  // namespace parallax::tools
