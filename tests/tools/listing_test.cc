// How a list of traces is written down, over traces that are made by hand: no model is compiled to
// find them and no program is started.

#include <doctest/doctest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/text_model.h"
#include "tools/app/trace_listing.h"
#include "tools/app/trace_writer.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using runtime::Trace;
using tools::TraceWriter;

class Capture final : public tools::Context {
 public:
  Capture() = default;
  Capture(Form form, std::atomic<bool>& stop) : Context(form, stop) {}
  void result(const std::string& text) override { pieces.push_back(text); }
  std::string text() const {
    std::string out;
    for (const auto& piece : pieces) out += piece;
    return out;
  }
  std::vector<std::string> pieces;
};

constexpr const char* kLamp = "range time 0 1\nfluent On()\nevent Press()\n";

/// Dark; bright after a press. Fluent and event are the first of the model, or of the table.
Trace lamp(std::int64_t number, bool pressed) {
  auto symbols = std::make_shared<compiler::SymbolTable>();
  const auto on = symbols->add_fluent("On()");
  const auto press = symbols->add_event("Press()");
  Trace trace;
  trace.number = number;
  trace.symbols = symbols;
  trace.points.resize(2);
  if (pressed) {
    trace.points[0].happens = {press};
    trace.points[1].holds = {on};
  }
  return trace;
}

constexpr const char* kDarkText = "trace 1\n  0\n  1\n";
constexpr const char* kBrightText = "trace 2\n  0\n      > Press()\n  1\n      + On()\n";
constexpr const char* kBrightLine =
    R"x({"trace":2,"timepoints":[{"time":0,"happens":["Press()"],"holds":[],"released":[]},)x"
    R"x({"time":1,"happens":[],"holds":["On()"],"released":[]}],"predicates":[]})x";

class Listed final : public runtime::TraceSource {
 public:
  explicit Listed(std::vector<Trace> traces) : traces_(std::move(traces)) {}
  std::optional<Trace> next() override {
    if (at_ == traces_.size()) return std::nullopt;
    return traces_[at_++];
  }
  bool exhausted() const override { return at_ == traces_.size(); }
  runtime::SourceStats stats() const override { return {}; }
  std::size_t given() const { return at_; }

 private:
  std::vector<Trace> traces_;
  std::size_t at_ = 0;
};

struct List {
  const compiler::CompiledModel model;
  tools::CertifyOption nothing;
  Listed source{{lamp(1, false), lamp(2, true), lamp(3, false)}};
  tools::TraceCertifier certifier(Capture& context) { return {nothing, {}, model, context}; }
};

TEST_CASE("traces are written as they come, up to the limit, and no more are asked for") {
  List list;
  Capture context;
  auto certifier = list.certifier(context);
  TraceWriter writer({"text", false, 2, nullptr}, nullptr, certifier, context);
  writer.write_all(list.source);
  CHECK(writer.count() == 2);
  CHECK(writer.full());
  CHECK(list.source.given() == 2);
  CHECK(context.pieces == std::vector<std::string>{kDarkText, kBrightText});
  CHECK(writer.list().empty());
  CHECK(writer.checked_field().empty());
  CHECK(writer.checked_remark().empty());
}

TEST_CASE("one trace more is written alike, as text or as a line of JSON") {
  List list;
  Capture context;
  auto certifier = list.certifier(context);
  std::string wanted;
  TraceWriter::Form form;
  SUBCASE("text") { wanted = kBrightText; }
  SUBCASE("lines") { form.format = "jsonl", wanted = std::string(kBrightLine) + '\n'; }
  TraceWriter writer(form, nullptr, certifier, context);
  writer.write(lamp(2, true));
  CHECK(context.text() == wanted);
  CHECK_FALSE(writer.full());
}

TEST_CASE("a document keeps its traces; a count keeps and writes none") {
  std::atomic<bool> stop = false;
  List list;
  Capture context({.json = true}, stop);
  auto certifier = list.certifier(context);
  TraceWriter::Form form;
  std::string wanted;
  SUBCASE("a document") {
    wanted = "[" + runtime::to_jsonl(lamp(1, false)) + "," + kBrightLine + "," +
             runtime::to_jsonl(lamp(3, false)) + "]";
  }
  SUBCASE("a count, whatever the limit") {
    form.count_only = true, form.limit = 1;
    wanted = "[]";
  }
  TraceWriter writer(form, nullptr, certifier, context);
  writer.write_all(list.source);
  CHECK(writer.count() == 3);
  CHECK("[" + writer.list() + "]" == wanted);
  CHECK(context.pieces.empty());
}

TEST_CASE("a raised stop ends a list between two traces") {
  std::atomic<bool> stop = true;
  List list;
  Capture context({}, stop);
  auto certifier = list.certifier(context);
  TraceWriter writer({}, nullptr, certifier, context);
  writer.write_all(list.source);
  CHECK(writer.count() == 0);
  CHECK(list.source.given() == 0);
}

TEST_CASE("long lists are handed on in blocks, and nothing is lost at the end") {
  std::vector<Trace> many;
  std::string wanted;
  for (std::int64_t i = 1; i <= 5000; ++i) {
    many.push_back(lamp(i, i % 2 == 0));
    wanted += runtime::to_text(many.back());
  }
  List list;
  Listed source(std::move(many));
  Capture context;
  auto certifier = list.certifier(context);
  TraceWriter writer({}, nullptr, certifier, context);
  writer.write_all(source);
  CHECK(writer.count() == 5000);
  CHECK(context.pieces.size() < 200);
  CHECK(context.text() == wanted);
}

tools::ModelOptions of(const std::string& file) {
  tools::ModelOptions options;
  options.models = {file};
  return options;
}

/// A list in one of the formats that are objects.
struct Formatted {
  TextModel text{kLamp};
  compiler::Compilation compilation;
  tools::ModelOptions model = of("lamp.e");
  Capture context;

  Formatted() { compilation.model = text.compiled; }
  std::unique_ptr<runtime::ListFormat> make(const tools::ListingOptions& options, bool one) {
    return tools::make_listing(model, options, one, compilation, context);
  }
};

TEST_CASE("text and JSON lines need no object; every other format has one") {
  Formatted list;
  CHECK(list.make({"text", {}}, false) == nullptr);
  CHECK(list.make({"jsonl", {}}, false) == nullptr);
  for (const auto* format : {"csv", "itf", "decreasoner"}) {
    CHECK(list.make({format, {}}, false) != nullptr);
  }
}

TEST_CASE("a table has a row for each timepoint, and its last row tells the end") {
  Formatted list;
  const auto csv = list.make({"csv", {}}, false);
  auto certifier = tools::TraceCertifier({}, {}, list.compilation.model, list.context);
  TraceWriter writer({"csv", false, 0, csv.get()}, nullptr, certifier, list.context);
  Listed source({lamp(1, false), lamp(2, true)});
  writer.write_all(source);
  CHECK(list.context.text() + csv->end({2, true, "complete", " (no proof)", {}}) ==
        "trace,time,On(),Press()\r\n1,0,0,0\r\n1,1,0,\r\n2,0,0,1\r\n2,1,1,\r\n"
        "# complete (no proof): 2 traces,,,\r\n");
}

TEST_CASE("a single ITF trace is a whole file, several are a line each and a closing one") {
  Formatted list;
  const runtime::ListEnd end{1, false, "stopped", {}, {}};
  const auto single = list.make({"itf", {}}, true);
  CHECK(single->begin().empty());
  CHECK(single->trace(lamp(1, true), {}).empty());
  const auto file = single->end(end);
  CHECK(file.starts_with("{\n\"#meta\":"));
  CHECK(file.find("\"complete\":false") != std::string::npos);
  CHECK(file.find("\"mbt::actionTaken\":\"Press()\"") != std::string::npos);

  const auto several = list.make({"itf", {}}, false);
  const auto line = several->trace(lamp(1, true), {});
  CHECK(std::count(line.begin(), line.end(), '\n') == 1);
  CHECK(several->end(end).find("\"summary\":true,\"traces\":1,\"complete\":false") == 1);
  // None was found: the closing line says so all the same.
  CHECK(list.make({"itf", {}}, true)->end({0, true, "complete", {}, {}}).find("\"traces\":0") !=
        std::string::npos);
}

std::string slurp(const fs::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

TEST_CASE("a folder of ITF files says that it was stopped until its list has ended") {
  auto pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
  REQUIRE(::mkdtemp(pattern.data()) != nullptr);
  const fs::path root = pattern, folder = root / "traces";
  Formatted list;
  const auto itf = list.make({"itf", folder.string()}, false);
  CHECK(itf->begin().empty());
  CHECK(slurp(folder / "index.json").find("\"exploration\":\"stopped\"") != std::string::npos);
  CHECK(itf->trace(lamp(1, false), {}).empty());
  CHECK(itf->trace(lamp(2, true), {}).empty());
  CHECK(itf->end({2, true, "complete", " (no proof)", {}}) ==
        "2 traces, complete (no proof), in " + folder.string() + "\n");
  CHECK(slurp(folder / "index.json").find("\"exploration\":\"complete\"") != std::string::npos);
  CHECK(fs::exists(folder / "trace_000001.itf.json"));
  CHECK(slurp(folder / "trace_000002.itf.json").find("\"Press()\"") != std::string::npos);
  CHECK(list.context.sink().error_count() == 0);

  SUBCASE("a second list is not mixed into it") {
    const auto before = slurp(folder / "index.json");
    const auto again = list.make({"itf", folder.string()}, false);
    again->begin();
    CHECK(list.context.stopped());
    again->trace(lamp(1, true), {});
    CHECK(again->end({1, true, "complete", {}, {}}).empty());  // it is not its folder
    CHECK(list.context.sink().error_count() == 1);
    CHECK(slurp(folder / "index.json") == before);
    CHECK(slurp(folder / "trace_000001.itf.json").find("Press()\"") == std::string::npos);
  }
  SUBCASE("a folder that goes away on the way is an error, and the count is what was written") {
    fs::remove_all(root);
    itf->trace(lamp(3, true), {});
    CHECK(list.context.stopped());
    CHECK(itf->end({3, true, "complete", {}, {}}).starts_with("2 traces, stopped"));
    CHECK(list.context.sink().error_count() == 1);
  }
  fs::remove_all(root);
}

TEST_CASE("options that do not go together are refused by name") {
  base::DiagnosticSink sink;
  const auto texts = of("lamp.e"), compiled = of("lamp.cnf");
  CHECK(tools::check_listing(texts, {"itf", "traces"}, sink));
  CHECK(tools::check_listing(compiled, {"itf", "traces"}, sink));
  CHECK(tools::check_listing(texts, {"decreasoner", {}}, sink));
  CHECK(sink.error_count() == 0);
  CHECK_FALSE(tools::check_listing(texts, {"csv", "traces"}, sink));
  CHECK_FALSE(tools::check_listing(compiled, {"decreasoner", {}}, sink));
  REQUIRE(sink.sorted().size() == 2);
  CHECK(sink.exit_code() == 2);
}

TEST_CASE("what stands at the end of a list that a limit cuts short, by format") {
  CHECK(tools::stopped_text("text") == "stopped\n");
  CHECK(tools::stopped_text("decreasoner") == "stopped\n");
  CHECK(tools::stopped_text("csv") == "# stopped\r\n");
  for (const auto* format : {"jsonl", "itf"}) {
    CHECK(tools::stopped_text(format) ==
          "{\"summary\":true,\"complete\":false,\"exploration\":\"stopped\"}\n");
  }
}

}  // namespace
}  // namespace parallax::test
