#include "tools/app/trace_listing.h"

#include <filesystem>
#include <optional>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/words.h"
#include "runtime/trace/csv_format.h"
#include "runtime/trace/itf_format.h"
#include "runtime/trace/open_atoms.h"
#include "tools/app/trace_listing.h"
#include "tools/app/version.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using runtime::ListEnd;
using runtime::OpenAtoms;
using runtime::Trace;

/// One trace on standard output is a whole ITF file, which says how the list ended.
class SingleItf final : public runtime::ListFormat {
 public:
  explicit SingleItf(runtime::ItfFormat format) : format_(std::move(format)) {}
  std::string trace(const Trace& trace, const OpenAtoms& open) override {
    trace_ = trace;
    open_ = open;
    return {};
  }
  std::string end(const ListEnd& end) override {
    return trace_ ? format_.document(*trace_, open_, end) : format_.end(end);
  }

 private:
  runtime::ItfFormat format_;
  std::optional<Trace> trace_;
  OpenAtoms open_;
};

/// A file for each trace, and `index.json`, which says from the start that the list was stopped and
/// is replaced at the end.
class ItfFolder final : public runtime::ListFormat {
 public:
  ItfFolder(runtime::ItfFormat format, fs::path folder, Context& context)
      : format_(std::move(format)),
        folder_(std::move(folder)),
        sink_(context.sink()),
        stop_(context.stop()) {}

  std::string begin() override {
    std::error_code error;
    fs::create_directories(folder_, error);
    const bool empty = !error && fs::is_empty(folder_, error);
    if (error) {
      fail(sink_.error_about(codes::kFileNotWritable, folder_.string(), error.message()));
    } else if (!empty) {
      fail(sink_.error_about(codes::kUsage, folder_.string(),
                             "the folder is not empty; name a new one for --output"));
    } else {
      write("index.json", format_.end({0, false, "stopped", {}, {}}));
    }
    return {};
  }
  std::string trace(const Trace& trace, const OpenAtoms& open) override {
    write(fmt::format("trace_{:06}.itf.json", trace.number), format_.document(trace, open, {}));
    if (!failed_) ++written_;
    return {};
  }
  std::string end(const ListEnd& end) override {
    auto known = end;
    if (failed_) known = {written_, false, "stopped", {}, {}};
    if (!failed_) write("index.json", format_.end(known));
    if (failed_ && written_ == 0) return {};  // the error says it
    return fmt::format("{}, {}{}, in {}\n", base::counted(known.traces, "trace"), known.exploration,
                       known.remark, folder_.string());
  }

 private:
  void fail(const base::Reported&) {
    failed_ = true;
    stop_.store(true);
  }
  void write(const std::string& name, const std::string& text) {
    if (failed_) return;
    const auto written = base::write_file_atomically(folder_ / name, text, sink_);
    if (!written) fail(sink_.already_reported());
  }

  runtime::ItfFormat format_;
  fs::path folder_;
  base::DiagnosticSink& sink_;
  std::atomic<bool>& stop_;
  std::int64_t written_ = 0;
  bool failed_ = false;
};

runtime::ItfFormat itf_format(const ModelOptions& model, const compiler::Compilation& compilation,
                              const base::SourceFiles& files) {
  runtime::ItfOptions options;
  options.tool = fmt::format("parallax {}", kVersion);
  for (const auto& name : model.models) {
    options.source += (options.source.empty() ? "" : " ") + name;
  }
  if (compilation.typed != nullptr) {
    for (const auto& symbol : compilation.typed->symbols) {
      if (symbol.kind != compiler::SymbolKind::kEvent) continue;
      const auto& file = files[symbol.declared.file];
      options.declared[symbol.name] = {file.name(), file.position(symbol.declared.begin),
                                       file.position(symbol.declared.end)};
    }
  }
  return {compilation.model, std::move(options)};
}

}  // namespace

bool check_listing(const ModelOptions& model, const ListingOptions& options,
                   base::DiagnosticSink& sink) {
  if (!options.output.empty() && options.format != "itf") {
    sink.error_about(codes::kUsage, "",
                     "--output names a folder of ITF files and needs --format itf; the other "
                     "formats go to standard output");
    return false;
  }
  if (options.format == "decreasoner" && names_artifact(model)) {
    sink.error_about(codes::kUsage, model.models.front(),
                     "--format decreasoner depends on the options of the texts; name them instead");
    return false;
  }
  return true;
}

std::unique_ptr<runtime::ListFormat> make_listing(const ModelOptions& model,
                                                  const ListingOptions& options, bool one_trace,
                                                  const compiler::Compilation& compilation,
                                                  Context& context) {
  if (options.format == "csv") return std::make_unique<runtime::CsvFormat>(compilation.model);
  if (options.format == "decreasoner") {
    const auto typed = compilation.typed.get();
    return std::make_unique<runtime::DecreasonerFormat>(
        compilation.model,
        typed != nullptr ? decreasoner_options(*typed) : runtime::DecreasonerOptions{});
  }
  if (options.format != "itf") return nullptr;
  auto format = itf_format(model, compilation, context.files());
  if (!options.output.empty()) {
    return std::make_unique<ItfFolder>(std::move(format), options.output, context);
  }
  if (one_trace) return std::make_unique<SingleItf>(std::move(format));
  return std::make_unique<runtime::ItfFormat>(std::move(format));
}

std::string stopped_text(const std::string& format) {
  if (format == "jsonl" || format == "itf") {
    return "{\"summary\":true,\"complete\":false,\"exploration\":\"stopped\"}\n";
  }
  return format == "csv" ? "# stopped\r\n" : "stopped\n";
}

}  // namespace parallax::tools
