#include "harness/cluster/fleet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/diagnostic_printer.h"
#include "harness/cluster/remote_worker.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMostNames = 6;  // of files that differ

/// Reasons may end with lines that a worker wrote; the first line is ours.
std::string first_line(const std::string& text) {
  auto line = text.substr(0, text.find('\n'));
  if (line.ends_with(':')) line.pop_back();
  return base::printable(line);
}

/// The further ones become notes.
void add_notes(base::DiagnosticBuilder warning, const std::string& text) {
  for (auto begin = text.find('\n'); begin != std::string::npos;) {
    const auto end = text.find('\n', begin + 1);
    auto line = text.substr(begin + 1, end - begin - 1);
    while (line.ends_with('\r')) line.pop_back();
    if (!line.empty()) warning.note(std::move(line));
    begin = end;
  }
}

/// Which files make the builds differ; empty: one of them does not say.
std::string difference(const ProgramIdentity& there, const ProgramIdentity& here) {
  auto names = differing_objects(there, here);
  if (names.empty()) return {};
  if (names.size() > kMostNames) {
    names.resize(kMostNames);
    names.emplace_back("...");
  }
  return fmt::format("not the same: {}", fmt::join(names, ", "));
}

}  // namespace

Fleet::Fleet(std::vector<WorkerPlace> places, FleetOptions options) : options_(std::move(options)) {
  for (auto& place : places) {
    place_of_.insert(place_of_.end(), static_cast<std::size_t>(place.slots), places_.size());
    places_.push_back({std::move(place), {}, 0, {}, 0, {}, {}, {}});
  }
  usable_ = place_of_.size();
  in_use_.resize(usable_);
  dropped_.resize(usable_);
}

std::int64_t Fleet::slots() const { return static_cast<std::int64_t>(place_of_.size()); }

std::unique_ptr<RemoteSimulator> Fleet::simulator(std::vector<std::string> worker) {
  return std::make_unique<RemoteWorker>(shared_from_this(), std::move(worker));
}

std::optional<Fleet::Slot> Fleet::take() {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < place_of_.size(); ++i) {
    const Slot slot = (options_.first_slot + i) % place_of_.size();
    if (in_use_[slot] || dropped_[slot]) continue;
    in_use_[slot] = true;
    return slot;
  }
  return std::nullopt;
}

void Fleet::give_back(Slot slot) {
  const std::lock_guard lock(mutex_);
  in_use_[slot] = false;
}

void Fleet::drop(Slot slot) {
  dropped_[slot] = true;
  if (--usable_ == 0 && options_.stop != nullptr) options_.stop->store(true);
}

void Fleet::set_self(ProgramIdentity self) {
  const std::lock_guard lock(mutex_);
  if (options_.self.version.empty()) options_.self = std::move(self);
}

bool Fleet::admit(Slot slot, const ProgramIdentity& found) {
  const std::lock_guard lock(mutex_);
  if (found == options_.self) return true;
  auto& place = places_[place_of_[slot]];
  // Another version may say and understand other things.
  if (options_.mixed && found.version == options_.self.version) {
    place.mixed_in = found;
    return true;
  }
  place.refused = found;
  drop(slot);
  return false;
}

void Fleet::give_up(Slot slot, const std::string& why) {
  const std::lock_guard lock(mutex_);
  auto& place = places_[place_of_[slot]];
  ++place.given_up;
  place.why = why;
  drop(slot);
}

void Fleet::note_banner(Slot slot, const Banner& banner) {
  const std::lock_guard lock(mutex_);
  auto& known = places_[place_of_[slot]].banner;
  if (known.lines == 0) known = banner;
}

void Fleet::note_loss(Slot slot, const std::string& why) {
  const std::lock_guard lock(mutex_);
  auto& place = places_[place_of_[slot]];
  ++place.losses;
  place.last_loss = why;
}

bool Fleet::agree(Slot slot, const std::string& worker, const SimulatorInfo& info) {
  const std::lock_guard lock(mutex_);
  auto text = encode_reply(0, HelloReply{kProtocolVersion, info});
  auto name = fmt::format("{} {}", info.name, info.version);
  const auto [at, is_first] = agreed_.try_emplace(worker, Agreed{text, name, slot});
  const auto& agreed = at->second;
  if (is_first || agreed.info == text) return true;
  // Which of the two is right is not for us to say, nor may it depend on who was first.
  const bool in_order = agreed.slot < slot;
  const auto said = [&](Slot where, const std::string& what) {
    return fmt::format("`{}` brings {}", place(where).text, what);
  };
  disagreement_ = in_order ? said(agreed.slot, agreed.name) + ", " + said(slot, name)
                           : said(slot, name) + ", " + said(agreed.slot, agreed.name);
  if (agreed.name == name) disagreement_ += ", which say different things of themselves";
  if (options_.stop != nullptr) options_.stop->store(true);
  return false;
}

void Fleet::report_refused(const ProgramIdentity& found, const std::string& place,
                           base::DiagnosticSink& sink) const {
  const auto& self = options_.self;
  if (found.version == self.version && found.build == self.build && !found.arithmetic.empty()) {
    sink.error_about(codes::kWorkerArithmetic, place, found.arithmetic, self.arithmetic);
  } else {
    auto warning =
        sink.error_about(codes::kWorkerRefused, place, to_string(found), to_string(self));
    if (const auto what = difference(found, self); !what.empty()) warning.note(what);
  }
}

bool Fleet::report(base::DiagnosticSink& sink,
                   const std::function<void(const std::string&)>& remark) const {
  const std::lock_guard lock(mutex_);
  for (const auto& place : places_) {
    const auto& text = place.place.text;
    if (place.banner.lines > 0) {
      remark(fmt::format(
          "`{}` says {} before the handshake: {}", text,
          place.banner.lines == 1 ? "a line" : fmt::format("{} lines", place.banner.lines),
          base::printable(place.banner.first)));
    }
    if (place.mixed_in) {
      const auto what = difference(*place.mixed_in, options_.self);
      remark(fmt::format("`{}` is of another kind: parallax {}, here {}{}", text,
                         to_string(*place.mixed_in), to_string(options_.self),
                         what.empty() ? "" : "; " + what));
    }
    if (place.losses > 0) {
      remark(fmt::format(
          "`{}`: {} lost; the last: {}", text,
          place.losses == 1 ? "a worker was" : fmt::format("{} workers were", place.losses),
          first_line(place.last_loss)));
    }
    if (place.refused) report_refused(*place.refused, text, sink);
    if (place.given_up > 0) {
      add_notes(sink.error_about(codes::kPlaceGivenUp, text, place.given_up, place.place.slots,
                                 first_line(place.why)),
                place.why);
    }
  }
  if (!disagreement_.empty()) {
    sink.error_about(codes::kWorkersDiffer, "", disagreement_);
    return false;
  }
  if (usable_ == 0) sink.error_about(codes::kNoWorkerLeft, "");
  return true;
}

}  // namespace parallax::harness
