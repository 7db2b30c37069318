#pragma once

#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/sample_row.h"
#include "tools/cli/option_table.h"
#include "tools/cli/replaceable.h"

namespace parallax::tools {

class Invocation;

/// `--samples FILE` of `run` and `rates`: one row for each simulation, collected and written when
/// all are over.
class SampleOutput {
 public:
  static void add_option(OptionTable& command, std::string& path);

  /// An empty path: nothing is collected or written.
  explicit SampleOutput(std::string path) : path_(std::move(path)) {}

  /// Before anything is simulated: is it a file that may be written? Reports kUsage for an ending
  /// that is neither .csv nor .jsonl.
  base::Status check(Invocation& invocation) const;
  /// Which collects rows of simulations; outlived by the object.
  harness::SampleListener listener();
  const std::vector<harness::SampleRow>& rows() const { return rows_; }
  /// Collects rows, whether or not they are to be written.
  void collect() { collects_ = true; }
  base::Status write(Invocation& invocation) const;

 private:
  std::string path_;
  bool collects_ = false;
  std::vector<harness::SampleRow> rows_;
};

}  // namespace parallax::tools
