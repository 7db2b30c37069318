#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "compiler/base/file_io.h"
#include "harness/campaign/campaign.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// Writes the texts that a run reads beside its journal as soon as there is one, so that a run that
/// is killed has them, too. Before that the folder may belong to another run.
class InputsKeeper {
 public:
  InputsKeeper(std::filesystem::path file, std::string text, Invocation& invocation)
      : file_(std::move(file)), text_(std::move(text)), invocation_(invocation) {}

  /// Calls `keep` before the first simulation is waited for.
  void watch(harness::CampaignOptions& campaign) {
    campaign.progress = [this, tell = std::move(campaign.progress)](const auto& progress) {
      keep();
      if (tell) tell(progress);
    };
    campaign.on_sample = [this, tell = std::move(campaign.on_sample)](auto row) {
      keep();
      if (tell) tell(std::move(row));
    };
  }
  /// The journal must be open. Writes once; whether that succeeded.
  bool keep() {
    if (text_.empty()) return is_kept_;
    is_kept_ =
        base::write_output(file_, std::exchange(text_, {}), invocation_.files(), invocation_.sink())
            .has_value();
    return is_kept_;
  }

 private:
  std::filesystem::path file_;
  std::string text_;  // empty: nothing to write, or it was written
  Invocation& invocation_;
  bool is_kept_ = true;
};

}  // namespace parallax::tools
