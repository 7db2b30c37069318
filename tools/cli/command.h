#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "tools/app/context.h"
#include "tools/cli/option_table.h"
#include "tools/cli/output.h"

namespace parallax::tools {

/// Options that every command understands.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  int verbosity = 0;
  std::string color = "auto";        // auto, always, never
  std::string diagnostics = "text";  // text, json, sarif
  double time_limit_s = 0.0;         // 0: none
  std::int64_t memory_limit_mb = 0;  // 0: none
  bool allow_outside = false;
  std::string footprint;  // the file that says what was read; empty: none
};

/// One run of one command: where results go, and what ends it.
class Invocation final : public Context {
 public:
  explicit Invocation(const CommonOptions& options);
  const CommonOptions& options() const { return options_; }

  bool color_on(int descriptor) const;
  /// On standard error, unless --quiet.
  void remark(const std::string& text) const override;
  /// On standard error.
  void statistics(const std::string& text) const override { write_error(text); }
  /// The result of the command; standard output holds nothing else.
  /// When it cannot be written the stop flag is raised, and `finish` reports it.
  void result(const std::string& text) override;
  /// A result that another program reads byte by byte, such as a model.
  void exact_result(const std::string& text);
  /// The result under --json: one object. `finish` adds the diagnostics as its field `diagnostics`
  /// and prints it.
  void document(std::string json) override;
  /// The question was answered to its end, even if a limit was reached meanwhile.
  void answered() { answered_ = true; }
  bool is_answered() const { return answered_; }
  /// Prints the diagnostics. With --json, standard output gets one document: the command's, or the
  /// error document if it made none. Returns the exit code for the errors, `code` without any.
  int finish(int code);

 private:
  void keep_result(bool written);
  void report_output_error();
  void write_footprint();
  void print_diagnostics(const std::vector<base::Diagnostic>& diagnostics) const;

  CommonOptions options_;
  std::string document_;
  bool answered_ = false;
  bool is_lost_ = false;  // the result could not be written
  base::DiagnosticSink before_output_error_;
};

/// A subcommand: how it is spelled, and what runs it.
struct Command {
  OptionTable options;
  std::function<int(Invocation&)> run;
};
/// A command that runs a function with the options that its table fills.
template <typename Options, typename Run>
Command command_of(OptionTable table, std::shared_ptr<Options> options, Run run) {
  return {std::move(table), [options = std::move(options), run](Invocation& invocation) {
            return run(*options, invocation);
          }};
}

/// Adds the options that every command has.
void add_common_options(OptionTable& table, CommonOptions& options);

Command adapter_check_command();
Command run_command();
Command repair_command();
Command replay_command();
Command report_command();
Command bisect_command();
Command check_command();
Command confirm_command();
Command threshold_command();
Command coverage_command();
Command compile_command();
Command consequences_command();
Command suite_command();
Command traces_command();
Command verify_command();
Command diagnostics_command();
Command doctor_command();
Command lsp_command();
Command export_command();
Command fmt_command();
Command learn_command();
Command new_command();
Command ledger_command();
Command record_command();
Command replay_adapter_command();
Command schema_command();
Command prove_command();
Command rates_command();
Command draw_command();
Command explain_command();
Command diff_command();
Command monitor_command();
Command calibrate_command();
Command worker_command();
Command supervise_command();

/// {"status": "error", "diagnostics": [...]} and a newline.
std::string error_document(const std::vector<base::Diagnostic>& diagnostics,
                           const base::SourceFiles& files);

}  // namespace parallax::tools
