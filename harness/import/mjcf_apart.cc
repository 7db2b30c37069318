#include "harness/import/mjcf_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace parallax::harness {
namespace {

using Masks = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Pairs that get a word of their own; more are listed.
constexpr std::size_t kMostPairs = 2000;

enum class Meeting : std::uint8_t { kNever, kSometimes, kAlways };

/// By the bits of all shapes of the one and all of the other.
Meeting meeting_of(const Masks& one, const Masks& other) {
  bool any = false, all = true;
  for (const auto& [type, affinity] : one) {
    for (const auto& [other_type, other_affinity] : other) {
      const bool meets = (type & other_affinity) != 0 || (other_type & affinity) != 0;
      any = any || meets;
      all = all && meets;
    }
  }
  return !any ? Meeting::kNever : all ? Meeting::kAlways : Meeting::kSometimes;
}

class Separator {
 public:
  Separator(const MjcfModel& model, const std::vector<MjcfSide>& sides,
            const std::vector<MjcfSide>& floor, std::vector<LinkDescription>& links,
            LeftOutList& left_out)
      : model_(model), sides_(sides), floor_(floor), links_(links), left_out_(left_out) {
    for (const auto& [one, other] : model.excluded) excluded_.insert(std::minmax(one, other));
    for (std::uint32_t i = 0; i < model.bodies.size(); ++i) find_roots(i);
    groups_.resize(sides.size());
    std::iota(groups_.begin(), groups_.end(), std::size_t{0});
  }

  void run() {
    join_what_is_apart();
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t k = i + 1; k < sides_.size(); ++k) judge(sides_[i], sides_[k], i, k);
    }
    for (const MjcfSide& floor : floor_) {
      for (const MjcfSide& side : sides_) {
        if (model_.bodies[side.body].is_static || meeting(floor, side) == Meeting::kAlways)
          continue;
        leave("pairs of bodies that are kept apart (contype, conaffinity, exclude)", side,
              "the floor");
      }
    }
    name_groups();
  }

 private:
  /// The body that this one is welded to, and the outermost one that moves with it.
  void find_roots(std::uint32_t i) {
    const MjcfBody& body = model_.bodies[i];
    const bool has_joint = std::any_of(model_.joints.begin(), model_.joints.end(),
                                       [&](const MjcfJoint& joint) { return joint.body == i; });
    const bool is_first = i == 0 || body.is_static;
    weld_.push_back(is_first ? 0 : has_joint ? i : weld_[body.parent]);
    tree_.push_back(is_first ? 0 : model_.bodies[body.parent].is_static ? i : tree_[body.parent]);
  }

  Meeting meeting(const MjcfSide& one, const MjcfSide& other) const {
    if (!model_.has_contacts || excluded_.contains(std::minmax(one.body, other.body))) {
      return Meeting::kNever;
    }
    return meeting_of(one.masks, other.masks);
  }

  /// Is it ours to say whether these collide? What is static, or hangs together, never does.
  bool is_open(const MjcfSide& one, const MjcfSide& other) const {
    return tree_[one.body] != tree_[other.body];
  }

  void join_what_is_apart() {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t k = i + 1; k < sides_.size(); ++k) {
        if (!is_open(sides_[i], sides_[k])) continue;
        if (meeting(sides_[i], sides_[k]) == Meeting::kNever) join(i, k);
      }
    }
    // A word keeps all who have it apart, so all of them must be meant.
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t k = i + 1; k < sides_.size(); ++k) {
        if (find(i) != find(k) || !is_open(sides_[i], sides_[k])) continue;
        if (meeting(sides_[i], sides_[k]) != Meeting::kNever) broken_.insert(find(i));
      }
    }
  }

  void judge(const MjcfSide& one, const MjcfSide& other, std::size_t i, std::size_t k) {
    const Meeting meets = meeting(one, other);
    if (is_open(one, other)) {
      const bool is_said = find(i) == find(k) && !broken_.contains(find(i));
      if (meets == Meeting::kAlways || is_said) return;
      if (meets == Meeting::kNever && part(one, other)) return;
      leave("pairs of bodies that are kept apart (contype, conaffinity, exclude)", one,
            links_[other.link].name);
    } else if (tree_[one.body] != 0 && meets != Meeting::kNever && !are_joined(one, other)) {
      leave("collisions of parts that hang together by joints", one, links_[other.link].name);
    }
  }

  /// Gives two bodies a word of their own. False: there are too many such pairs.
  bool part(const MjcfSide& one, const MjcfSide& other) {
    if (pairs_.size() >= kMostPairs) return false;
    pairs_.emplace_back(one.link, other.link);
    return true;
  }

  bool are_joined(const MjcfSide& one, const MjcfSide& other) const {
    const auto a = weld_[one.body], b = weld_[other.body];
    if (a == b) return true;
    const auto above = [&](std::uint32_t weld) { return weld_[model_.bodies[weld].parent]; };
    return model_.filters_parents && (above(a) == b || above(b) == a);
  }

  void leave(const char* what, const MjcfSide& side, const std::string& other) {
    const LinkDescription& link = links_[side.link];
    left_out_.add(what, fmt::format("{} and {}", link.name, other), link.offset);
  }

  /// Words that no other body has.
  void name_groups() {
    std::vector<std::size_t> sizes(sides_.size(), 0);
    for (std::size_t i = 0; i < sides_.size(); ++i) ++sizes[find(i)];
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const std::size_t group = find(i);
      if (sizes[group] < 2 || broken_.contains(group)) continue;
      links_[sides_[i].link].apart = "apart_of_" + plain_name(links_[sides_[group].link].name);
    }
    for (const auto& [a, b] : pairs_) {
      const auto word =
          fmt::format("{}_without_{}", plain_name(links_[a].name), plain_name(links_[b].name));
      for (const auto link : {a, b}) {
        auto& words = links_[link].apart;
        words += words.empty() ? word : ' ' + word;
      }
    }
  }

  std::size_t find(std::size_t i) {
    while (groups_[i] != i) i = groups_[i] = groups_[groups_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t k) {
    const auto a = find(i), b = find(k);
    groups_[std::max(a, b)] = std::min(a, b);
  }

  const MjcfModel& model_;
  const std::vector<MjcfSide>& sides_;
  const std::vector<MjcfSide>& floor_;
  std::vector<LinkDescription>& links_;
  LeftOutList& left_out_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> excluded_;
  std::vector<std::uint32_t> weld_, tree_;  // by body; 0: the world
  std::vector<std::size_t> groups_;         // of sides, by the least of them
  std::set<std::size_t> broken_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // of links
};

}  // namespace

void set_apart(const MjcfModel& model, const std::vector<MjcfSide>& sides,
               const std::vector<MjcfSide>& floor, std::vector<LinkDescription>& links,
               LeftOutList& left_out) {
  Separator(model, sides, floor, links, left_out).run();
}

}  // namespace parallax::harness
