#include "tools/app/trace_writer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

/// Block size of the output, so that listing millions of traces is not one call for each.
constexpr std::size_t kBlock = std::size_t{1} << 16U;

/// After so many traces it is worth asking of all at once whether they leave atoms open.
constexpr std::int64_t kAskedOneByOne = 16;

/// Initial states of one trace that are counted; each costs a solver call.
constexpr std::int64_t kCountedStarts = 10;

std::string starts_text(std::int64_t starts) {
  return fmt::format("  from {}{} initial states that differ in nothing printed\n",
                     starts < kCountedStarts ? "" : "at least ", starts);
}

/// The object on this line with the number.
std::string with_starts(std::string object, std::int64_t starts) {
  object.pop_back();
  object += fmt::format(",\"initial_states\":{}", starts);
  return object + (starts < kCountedStarts ? "}" : ",\"more_initial_states\":true}");
}

}  // namespace

const runtime::TraceFormat& TraceWriter::format() const {
  return form_.format == "jsonl" ? runtime::jsonl_format() : runtime::text_format();
}

/// False if a stop was raised before it was known which atoms are open.
bool TraceWriter::print(const runtime::Trace& trace) {
  if (form_.count_only) return true;
  std::optional<runtime::OpenAtoms> open = runtime::OpenAtoms();
  if (form_.open_atoms != nullptr) {
    if (count_ == kAskedOneByOne) (void)form_.open_atoms->none_is_open();
    open = form_.open_atoms->find(trace);
    if (!open && !form_.prints_unsettled) return false;
  }
  const auto starts = count_starts(trace);
  const auto line = [&] {
    auto object = open ? runtime::to_jsonl(trace, *open) : runtime::observable_jsonl(trace);
    return starts > 1 ? with_starts(std::move(object), starts) : object;
  };
  if (context_.form().json) {
    list_ += (list_.empty() ? "" : ",") + line();
  } else if (form_.listing != nullptr) {
    // Where nothing is claimed of an atom, these formats leave it out like an undetermined one.
    context_.result(
        form_.listing->trace(trace, open ? *open : form_.open_atoms->all_hidden(trace)));
  } else if (form_.format == "jsonl") {
    context_.result(line() + '\n');
  } else {
    context_.result(runtime::to_text(trace) + (starts > 1 ? starts_text(starts) : ""));
  }
  return true;
}

/// How many initial states the trace stands for, where the form says that.
std::int64_t TraceWriter::count_starts(const runtime::Trace& trace) {
  if (!ends_ || form_.listing != nullptr) return 1;
  return ends_->initial_states(trace, form_.asked, kCountedStarts);
}

TraceWriter::TraceWriter(Form form, TraceCheck* check, TraceCertifier& certifier, Context& context)
    : form_(std::move(form)), check_(check), certifier_(certifier), context_(context) {
  if (form_.listing != nullptr) context_.result(form_.listing->begin());
  const bool shows = !form_.count_only || !form_.ended.empty();
  if (form_.plan == nullptr || !shows) return;
  ends_.emplace(*form_.plan, runtime::make_cadical_solver(&context_.stop()), form_.all_hits);
}

bool TraceWriter::is_wanted(const std::string& ended) const {
  if (form_.ended.empty()) return true;
  const auto wanted = form_.ended == "failed" ? std::string(" FAILED(") : " " + form_.ended;
  return (" " + ended).find(wanted) != std::string::npos;
}

void TraceWriter::write(const runtime::Trace& given) {
  auto trace = given;
  if (ends_) trace.ended = ends_->of(trace);
  if (!is_wanted(trace.ended)) {
    certifier_.add(trace);
    return;
  }
  if (!print(trace)) {
    cut_short_ = true;
    return;
  }
  ++count_;
  if (check_ != nullptr) check_->check(trace);
  certifier_.add(trace);
}

/// Traces as such are needed for checks, for a proof, for the document, for other formats, and
/// where they may leave atoms open.
bool TraceWriter::needs_traces() {
  if (check_ != nullptr || certifier_.is_asked() || ends_ || form_.count_only ||
      form_.listing != nullptr || context_.form().json) {
    return true;
  }
  if (form_.open_atoms == nullptr) return false;
  return count_ < kAskedOneByOne || !form_.open_atoms->none_is_open();
}

void TraceWriter::write_all(runtime::TraceSource& source) {
  std::string block;
  while (!full() && !context_.stopped()) {
    if (!needs_traces()) {
      if (!source.print_next(format(), block)) break;
      ++count_;
      // The first ones appear at once.
      if (block.size() < kBlock && count_ > 100) continue;
      context_.result(block);
      block.clear();
    } else {
      const auto trace = source.next();
      if (!trace) break;
      write(*trace);
    }
  }
  if (!block.empty()) context_.result(block);
}

std::string TraceWriter::checked_field() const {
  return check_ == nullptr ? "" : fmt::format("\"checked\":{},", check_->checked());
}

std::string TraceWriter::checked_remark() const {
  return check_ == nullptr ? "" : fmt::format(", {} checked", check_->checked());
}

std::vector<std::string> open_end_texts(const compiler::CompiledModel& model,
                                        const runtime::OpenEnds& ends) {
  std::vector<std::string> out;
  for (const auto number : ends.cuts) {
    const auto& cut = model.plan_cuts[number];
    out.push_back(fmt::format("bound reached: `{}` at {}", cut.form, place_text(cut.place)));
  }
  if (ends.step) {
    const auto& step = model.plan[*ends.step];
    out.push_back(fmt::format("the plan goes on beyond timepoint {} with {} at {}", model.horizon,
                              step.event, place_text(step.place)));
  }
  return out;
}

std::string dead_end_text(const compiler::CompiledModel& model, std::string_view does,
                          compiler::Timepoint length) {
  return fmt::format(
      "a prefix that cannot go on {} at timepoint {}: no trace of horizon {} begins like that",
      does, length, model.horizon);
}

std::string bounds_field(const std::vector<std::string>& bounds) {
  if (bounds.empty()) return {};
  return fmt::format("\"bounds\":{},", base::json_text(nlohmann::json(bounds)));
}

}  // namespace parallax::tools
