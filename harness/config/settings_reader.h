#pragma once

// Only harness/config/*.cc include this header.

#include "compiler/base/source_file.h"
#include "harness/config/read_log.h"
#include "harness/config/scenario_settings.h"
#include "harness/config/yaml_reader.h"

namespace parallax::harness {

/// Lists the values of a tree that was read with this log.
ScenarioSettings settings_of(const YamlNode& root, const ReadLog& log,
                             const base::SourceFiles& files);

}  // namespace parallax::harness
