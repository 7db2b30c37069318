#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/interpreter/unroller.h"
#include "compiler/plan/plan_binding.h"
#include "tools/bench/families/plan_folder.h"

namespace parallax::tools {
namespace {

class OnePlace final : public compiler::PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view, const compiler::PlanPose&) const override {
    return "here";
  }
  std::optional<Nearest> nearest(std::string_view, const compiler::PlanPose&) const override {
    return std::nullopt;
  }
};

TEST_CASE("the folder of plans is read without a word, and grows by a station's performs") {
  std::vector<std::size_t> performs;
  for (const int stations : {1, 2, 3}) {
    auto folder = plan_folder(stations);
    base::SourceFiles files;
    base::DiagnosticSink sink;
    std::vector<base::FileId> plan;
    for (const auto* name : {"package.lisp", "common.lisp"})
      plan.push_back(files.add(name, folder[name]));
    for (int i = 1; i <= stations; ++i) {
      const auto name = "station-" + std::to_string(i) + ".lisp";
      plan.push_back(files.add(name, folder[name]));
    }
    plan.push_back(files.add("main.lisp", folder["main.lisp"]));
    const std::filesystem::path root = PARALLAX_SOURCE_DIR;
    const auto bind = base::load_text(root / "scenarios/kitchen/robot.bind", files, sink);
    REQUIRE(bind.has_value());
    const auto binding = compiler::parse_plan_binding(files, *bind, sink);
    REQUIRE(binding.has_value());
    const auto graph = compiler::unroll_plan(files, plan, *binding, OnePlace(), {}, sink);
    CHECK(sink.sorted().empty());
    REQUIRE(graph.has_value());
    performs.push_back(graph->locations.size());
  }
  CHECK(performs[0] > 40);
  CHECK(performs[1] > performs[0]);
  CHECK(performs[2] > performs[1]);
}

}  // namespace
}  // namespace parallax::tools
