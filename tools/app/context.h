#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"

namespace parallax::tools {

/// Environment of this library's functions besides their options: the texts that were read, the
/// diagnostics, the stop flag and the output. A program that wants the output derives from it; the
/// base class drops output and collects diagnostics in the sink.
class Context {
 public:
  struct Form {
    bool json = false;                 // the answer is one document, not text
    double time_limit_s = 0.0;         // 0: none; explanations try less where it is short
    std::int64_t memory_limit_mb = 0;  // 0: none; proofs take half of it
    bool allow_outside = false;        // files may name any other (docs/reference/trust.md)
  };

  Context() : stop_(&own_stop_) {}
  /// `stop` may be raised at any time, by another thread or a signal, and ends the work early; the
  /// library raises it where an answer cannot be written. It outlives the object.
  Context(Form form, std::atomic<bool>& stop) : form_(form), stop_(&stop) {}
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Form& form() const { return form_; }
  base::SourceFiles& files() { return files_; }
  const base::SourceFiles& files() const { return files_; }
  base::DiagnosticSink& sink() { return sink_; }
  const base::DiagnosticSink& sink() const { return sink_; }
  std::atomic<bool>& stop() const { return *stop_; }
  bool stopped() const { return stop_->load(); }

  /// The answer as text, piece by piece as it is found.
  virtual void result(const std::string& /*text*/) {}
  /// The answer as one JSON object: `Form::json`.
  virtual void document(std::string /*json*/) {}
  /// A line about what is going on; not part of the answer.
  virtual void remark(const std::string& /*text*/) const {}
  /// Figures that somebody asked for; not part of the answer.
  virtual void statistics(const std::string& /*text*/) const {}

 private:
  Form form_;
  std::atomic<bool> own_stop_{false};
  std::atomic<bool>* stop_;
  base::SourceFiles files_;
  base::DiagnosticSink sink_;
};

}  // namespace parallax::tools
