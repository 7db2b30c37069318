#pragma once

// Only harness/config/*.cc include this header.

#include <string_view>

#include "harness/config/yaml_fields.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Parts of the section `world`, each reporting at its keys.

void read_vector(const YamlFields& fields, std::string_view key, Eigen::Vector3d& out);
BodySpec read_body(const YamlEntry& entry, base::DiagnosticSink& sink);
HandleSpec read_handle(const YamlNode& node, base::DiagnosticSink& sink);
PlaceSpec read_place(const YamlEntry& entry, base::DiagnosticSink& sink);
/// A robot on a line, or, with `arms`, a mobile one.
void read_robot(const YamlNode& node, WorldSpec& world, base::DiagnosticSink& sink);

}  // namespace parallax::harness
