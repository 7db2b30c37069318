#include "harness/import/description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/import/fitting.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kTurnRounding_rad = 1e-9;
constexpr double kPlaceholder_m = 0.01;

double rounded(double angle_rad) {
  return std::abs(angle_rad) < kTurnRounding_rad ? 0.0 : angle_rad;
}

/// "mu0.8"; the name is a material, whose pairs a hyphen joins.
std::string material_of(double friction) {
  std::string name = fmt::format("mu{:g}", friction);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class Assembler {
 public:
  Assembler(Description description, const ImportInput& input, ImportedWorld& world)
      : in_(std::move(description)), input_(input), world_(world) {}

  void run() {
    world_.fault = fit_joints(input_.positions, in_);
    if (world_.fault) return;
    do {
      while (merge_one()) {
      }
      hold_massless();
    } while (fit_massless(in_));
    fit_inertias(in_);
    for (const LinkDescription& link : in_.links) add_body(link);
    for (const JointDescription& joint : in_.joints) add_joint(joint);
    if (in_.has_floor) world_.floor_material = material_of(in_.floor_friction.value_or(1.0));
    if (in_.floor_friction) frictions_.insert(*in_.floor_friction);
    add_friction();
    world_.left_out = in_.left_out.take();
  }

 private:
  LinkDescription* find(const std::string& name) {
    const auto found = std::find_if(in_.links.begin(), in_.links.end(),
                                    [&](const LinkDescription& l) { return l.name == name; });
    return found == in_.links.end() ? nullptr : &*found;
  }

  /// One link without mass becomes part of the one at the other end of a fixed joint.
  bool merge_one() {
    for (std::size_t i = 0; i < in_.joints.size(); ++i) {
      const JointDescription joint = in_.joints[i];
      if (joint.type != JointType::kFixed || joint.parent.empty()) continue;
      LinkDescription* parent = find(joint.parent);
      LinkDescription* child = find(joint.child);
      if (parent == nullptr || child == nullptr) continue;
      if (parent->is_static || child->is_static) continue;
      if (child->mass_kg == 0.0) {
        merge(*child, *parent, i);
        return true;
      }
      if (parent->mass_kg == 0.0 && is_root(joint.parent)) {
        merge(*parent, *child, i);
        return true;
      }
    }
    return false;
  }

  /// A link without mass that is fixed to the world, or to what stands fast, stands fast itself.
  void hold_massless() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const JointDescription& joint : in_.joints) {
        LinkDescription* child = find(joint.child);
        if (joint.type != JointType::kFixed || child == nullptr) continue;
        if (child->mass_kg != 0.0 || child->is_static) continue;
        const LinkDescription* parent = find(joint.parent);
        if (!joint.parent.empty() && (parent == nullptr || !parent->is_static)) continue;
        child->is_static = changed = true;
      }
    }
  }

  bool is_root(const std::string& link) const {
    return std::none_of(in_.joints.begin(), in_.joints.end(), [&](const JointDescription& joint) {
      return joint.child == link && !joint.parent.empty();
    });
  }

  void merge(LinkDescription& gone, LinkDescription& kept, std::size_t joint) {
    const Eigen::Isometry3d X_KG = kept.X_WL.inverse() * gone.X_WL;
    for (LinkShape shape : gone.shapes) {
      shape.X_LS = X_KG * shape.X_LS;
      kept.shapes.push_back(std::move(shape));
    }
    const std::string from = gone.name, to = kept.name;
    in_.joints.erase(in_.joints.begin() + static_cast<std::ptrdiff_t>(joint));
    for (JointDescription& other : in_.joints) {
      if (other.parent == from) other.parent = to;
      if (other.child == from) other.child = to;
    }
    in_.links.erase(std::find_if(in_.links.begin(), in_.links.end(),
                                 [&](const LinkDescription& l) { return l.name == from; }));
  }

  void add_body(const LinkDescription& link) {
    if (link.has_floor && link.shapes.empty()) return;
    ImportedBody out;
    out.offset = link.offset;
    BodySpec& body = out.spec;
    body.name = plain_name(link.name);
    body.p_WB = link.X_WL.translation();
    body.yaw_rad = rounded(heading_rad(link.X_WL.linear()));
    body.apart = link.apart;
    const Eigen::Matrix3d R_BL =
        Eigen::AngleAxisd(-body.yaw_rad, Eigen::Vector3d::UnitZ()) * link.X_WL.linear();
    double rough = -1.0;
    for (const LinkShape& shape : link.shapes) {
      if (shape.mesh) out.meshes.emplace(body.shapes.size(), *shape.mesh);
      if (!shape.corners.empty()) out.hulls.emplace(body.shapes.size(), shape.corners);
      BodyShape one;
      one.form = shape.form;
      one.size_m = shape.size_m;
      one.p_BS = R_BL * shape.X_LS.translation();
      const Eigen::Matrix3d R = R_BL * shape.X_LS.linear();
      one.yaw_rad = rounded(heading_rad(R));
      one.pitch_rad = rounded(std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))));
      one.roll_rad = rounded(std::atan2(R(2, 1), R(2, 2)));
      body.shapes.push_back(one);
      rough = std::max(rough, shape.friction.value_or(-1.0));
    }
    if (rough >= 0.0) {
      frictions_.insert(rough);
      body.material = material_of(rough);
    }
    if (!link.is_static) set_mass(link, R_BL, body);
    if (body.shapes.empty()) {
      if (link.is_static || link.mass_kg == 0.0) {
        if (!is_jointed(link.name)) {
          in_.left_out.add("links without shape and mass", link.name, link.offset);
          return;
        }
        if (link.is_static) {
          in_.left_out.add("links without shape", link.name, link.offset);
        }
      }
      body.shapes.push_back(BodyShape{Eigen::Vector3d::Constant(kPlaceholder_m)});
      body.collides = false;  // stands for a mass without a shape
    }
    if (!link.is_static && link.mass_kg == 0.0 && !world_.fault) {
      world_.fault = TextFault{
          link.offset, fmt::format("the link `{}` has no mass, but is free to move", link.name)};
    }
    world_.bodies.push_back(std::move(out));
  }

  bool is_jointed(const std::string& link) const {
    return std::any_of(in_.joints.begin(), in_.joints.end(), [&](const JointDescription& joint) {
      return joint.parent == link || joint.child == link;
    });
  }

  static void set_mass(const LinkDescription& link, const Eigen::Matrix3d& R_BL, BodySpec& body) {
    body.mass_kg = link.mass_kg;
    if (link.mass_kg == 0.0 || !link.has_own_inertia) return;
    const Eigen::Matrix3d R_BC = R_BL * link.X_LC.linear();
    const Eigen::Matrix3d I = R_BC * link.I_C_kg_m2 * R_BC.transpose();
    body.inertia = InertiaSpec{R_BL * link.X_LC.translation(), 0.5 * (I + I.transpose())};
  }

  void add_joint(const JointDescription& joint) {
    const LinkDescription* child = find(joint.child);
    const LinkDescription* parent = find(joint.parent);
    if (child == nullptr || child->is_static) return;  // models that do not move
    ImportedJoint out;
    out.offset = joint.offset;
    JointSpec& spec = out.spec;
    spec.name = plain_name(joint.name);
    spec.type = joint.type;
    spec.parent = parent == nullptr ? std::string() : plain_name(joint.parent);
    spec.child = plain_name(joint.child);
    spec.axis_W = joint.axis_W;
    spec.max_torque_nm = 0.0;
    const bool turns = joint.type == JointType::kHinge;
    if (turns) {
      spec.p_WA = joint.p_WA;
      spec.damping_nm_s = joint.damping;
      spec.max_torque_nm = joint.friction;
    } else if (joint.type == JointType::kSlider) {
      spec.damping_n_s_m = joint.damping;
      spec.max_force_n = joint.friction;
    }
    if (!joint.leader.empty()) spec.follows = FollowSpec{plain_name(joint.leader), joint.ratio};
    if (turns) set_stops(joint, kMostTurn_rad, 1e3, "rad", spec.low_rad, spec.high_rad);
    if (joint.type == JointType::kSlider) {
      set_stops(joint, 1e3, 1e15, "m", spec.low_m, spec.high_m);
    }
    world_.joints.push_back(std::move(out));
  }

  /// Formats write huge numbers, or infinity, where there is no stop.
  void set_stops(const JointDescription& joint, double most, double none, const char* unit,
                 std::optional<double>& low, std::optional<double>& high) {
    for (const auto& [value, stop] : {std::pair(joint.low, &low), std::pair(joint.high, &high)}) {
      if (std::abs(value) <= most) {
        *stop = value;
      } else if (!(std::abs(value) >= none)) {
        in_.left_out.add(fmt::format("stops beyond {:g} {}", most, unit), joint.name, joint.offset);
      }
    }
  }

  /// As engines of robots do: of two surfaces the smoother decides.
  void add_friction() {
    for (const double a : frictions_) {
      for (const double b : frictions_) {
        // By value: the references of std::minmax do not outlive its arguments.
        const std::pair<std::string, std::string> pair =
            std::minmax({material_of(a), material_of(b)});
        world_.friction.pairs[pair] = std::min(a, b);
      }
    }
  }

  Description in_;
  const ImportInput& input_;
  ImportedWorld& world_;
  std::set<double> frictions_;
};

}  // namespace

void LeftOutList::add(const std::string& what, const std::string& name, std::size_t offset) {
  const auto found = std::find_if(kinds_.begin(), kinds_.end(),
                                  [&](const LeftOut& kind) { return kind.what == what; });
  if (found != kinds_.end()) {
    ++found->count;
  } else {
    kinds_.push_back({what, 1, name, offset});
  }
}

void add_mesh(const ImportInput& input, const std::string& uri, const std::string& from,
              const Eigen::Vector3d& scale, LinkShape shape, LinkDescription& link,
              LeftOutList& left_out) {
  const auto file = input.find_mesh ? input.find_mesh(uri, from) : std::nullopt;
  if (!file) return left_out.add("meshes that are not to be had", link.name, link.offset);
  shape.form = ShapeForm::kHull;
  shape.mesh = MeshUse{*file, scale};
  link.shapes.push_back(std::move(shape));
}

void assemble(Description description, const ImportInput& input, ImportedWorld& world) {
  Assembler(std::move(description), input, world).run();
}

std::string plain_name(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name.compare(i, 2, "::") == 0) ++i;
    const char c = name[i];
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    out.push_back(plain ? c : '_');
  }
  return out;
}

NamePlaces::NamePlaces(const XmlOutline& outline) {
  for (const XmlElement& element : outline.elements) {
    if (element.name.empty()) continue;
    by_tag_.emplace(std::string(element.tag) + " " + std::string(element.name), element.offset);
    by_name_.emplace(element.name, element.offset);
  }
}

std::size_t NamePlaces::of(const std::string& tag, const std::string& name) const {
  const auto found = by_tag_.find(tag + " " + name);
  return found == by_tag_.end() ? 0 : found->second;
}

std::size_t NamePlaces::of_message(const std::string& message) const {
  // libsdformat: "A link named bowl has invalid inertia."
  constexpr std::string_view kNamed = " named ";
  if (const auto at = message.find(kNamed); at != message.npos) {
    const auto begin = at + kNamed.size();
    for (auto end = message.find_first_of(" .,", begin); end != message.npos;
         end = message.find_first_of(" .,", end + 1)) {
      const auto found = by_name_.find(message.substr(begin, end - begin));
      if (found != by_name_.end()) return found->second;
    }
  }
  for (std::size_t i = 0; i < message.size(); ++i) {
    const char open = message[i];
    const char close = open == '[' ? ']' : open;
    if (open != '[' && open != '"' && open != '\'' && open != '`') continue;
    const auto end = message.find(close, i + 1);
    if (end == message.npos) continue;
    std::string name = message.substr(i + 1, end - i - 1);
    if (const auto scope = name.rfind("::"); scope != name.npos) name = name.substr(scope + 2);
    if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
  }
  return 0;
}

}  // namespace parallax::harness
