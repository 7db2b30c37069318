#include "harness/draw/robot_drawing.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/draw/shown_text.h"
#include "harness/world/shapes.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

constexpr double kPixels_m = 330.0;
constexpr double kLine = 17.0, kGap = 30.0, kHead = 60.0;  // pixels
constexpr double kLabelFont_px = 12.0;
constexpr int kFacets = 20;

struct Label {
  Eigen::Vector3d at_W;
  std::string text;
};

/// Looking along one axis of the world.
struct View {
  std::string title;
  Eigen::Vector3d right, up;
  std::vector<Label> labels;
  std::vector<std::pair<Eigen::Isometry3d, std::string>> frames;
  Eigen::Vector2d flat(const Eigen::Vector3d& p) const { return {right.dot(p), up.dot(p)}; }
};

std::string list_text(const Eigen::Vector3d& v) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x(), v.y(), v.z());
}

Eigen::Isometry3d pose_of(const BodySpec& body) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation() = body.p_WB;
  return X;
}

/// Points whose hull is the shape, in its own frame.
std::vector<Eigen::Vector3d> hull_points(const BodyShape& shape) {
  Probe probe;
  probe.size_m = shape.size_m;
  probe.form = shape.form;
  probe.hull = shape.hull;
  return outline_points(probe);
}

class RobotDrawing {
 public:
  RobotDrawing(const WorldSpec& spec, const std::string& title)
      : spec_(spec), title_(title), layout_(lay_out(spec)) {
    const BodyId base = *layout_.find_body(base_body(spec));
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      if (layout_.assembly_of[i] == layout_.assembly_of[base.index()]) {
        parts_.push_back(layout_.bodies.id_at(i));
      }
    }
    side_ = {"from the side", Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), {}, {}};
    top_ = {"from above", Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), {}, {}};
    if (spec.mobile) {
      note_mobile(*spec.mobile);
    } else {
      note_line(spec.robot);
    }
  }

  std::string svg() {
    for (const View* view : {&side_, &top_}) {
      for (const Label& label : view->labels) {
        column_ = std::max(column_, text_width_px(label.text, kLabelFont_px) + kGap);
      }
    }
    const double width = 2.0 * column_ + kPixels_m * extent(side_).x() + 2.0 * kGap;
    std::string out;
    double y = kHead;
    for (const View* view : {&side_, &top_}) y = draw(*view, y, out);
    const std::string head = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scene\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<text x=\"20\" y=\"30\" font-size=\"18\">{2}</text>\n",
        width, y, shown_in_full(title_));
    return head + out + "</svg>\n";
  }

 private:
  const BodySpec& body(const std::string& name) const {
    return layout_.bodies[*layout_.find_body(name)];
  }
  const JointSpec& joint(const std::string& name) const {
    return *std::find_if(spec_.joints.begin(), spec_.joints.end(),
                         [&](const JointSpec& one) { return one.name == name; });
  }
  Eigen::Vector3d middle(const std::string& name) const {
    return pose_of(body(name)) * body(name).shapes.front().p_BS;
  }

  std::string joint_text(const JointSpec& j) const {
    if (j.type == JointType::kGantry) {
      std::string text =
          fmt::format("`{}`: gantry, {:g} N, {:g} N m", j.name, j.max_force_n, j.max_torque_nm);
      if (j.suspension) {
        text += fmt::format(", springs {:.3g} N/m, {:.3g} N m/rad", j.suspension->stiffness_n_m,
                            j.suspension->stiffness_nm_rad);
      }
      return text;
    }
    const bool hinge = j.type == JointType::kHinge;
    Eigen::Index axis = 0;
    j.axis_W.cwiseAbs().maxCoeff(&axis);
    return fmt::format("`{}`: {} {}, {:g} to {:g} {}, {:g} {}", j.name, hinge ? "about" : "along",
                       "xyz"[axis], (hinge ? j.low_rad : j.low_m).value_or(0.0),
                       (hinge ? j.high_rad : j.high_m).value_or(0.0), hinge ? "rad" : "m",
                       hinge ? j.max_torque_nm : j.max_force_n, hinge ? "N m" : "N");
  }

  void note_mobile(const MobileRobotSpec& robot) {
    const Eigen::Isometry3d X_WB = pose_of(body(robot.base_body));
    for (View* view : {&side_, &top_}) view->frames.emplace_back(X_WB, "B");
    side_.labels.push_back(
        {X_WB.translation(), fmt::format("B: frame of `{}`, on the floor", robot.base_body)});
    side_.labels.push_back(
        {X_WB * Eigen::Vector3d(-0.2, 0.0, 0.12), joint_text(joint(robot.base_joint))});
    side_.labels.push_back(
        {X_WB * robot.camera.p_BC,
         fmt::format("camera: at_m {}, half_angle_rad {:g}", list_text(robot.camera.p_BC),
                     robot.camera.half_angle_rad)});
    if (!robot.torso_joint.empty()) {
      const JointSpec& lift = joint(robot.torso_joint);
      side_.labels.push_back({middle(lift.child), joint_text(lift)});
    }
    for (const ArmSpec& arm : robot.arms) note_arm(arm, X_WB, &arm == &robot.arms.front());
  }

  void note_arm(const ArmSpec& arm, const Eigen::Isometry3d& X_WB, bool in_detail) {
    const Eigen::Isometry3d X_WP = pose_of(body(arm.palm_body));
    const Eigen::Vector3d tool = 0.5 * (middle(arm.near_pad_body) + middle(arm.far_pad_body));
    tools_.push_back(tool);
    top_.frames.emplace_back(X_WP, "P");
    top_.labels.push_back(
        {tool, fmt::format("tool point of `{}`; carry_m {}", arm.name, list_text(arm.carry_B))});
    top_.labels.push_back({X_WP.translation() + Eigen::Vector3d(0.03, 0.0, 0.0),
                           fmt::format("P: `{}` (palm_body), wrist_rad 0", arm.palm_body)});
    top_.labels.push_back(
        {middle(arm.near_pad_body), fmt::format("`{}` (near_pad_body)", arm.near_pad_body)});
    top_.labels.push_back(
        {middle(arm.far_pad_body),
         fmt::format("`{}` (far_pad_body), opening_m {:g}", arm.far_pad_body, arm.opening_m)});
    top_.labels.push_back(
        {X_WB * arm.p_BS, fmt::format("shoulder of `{}`: [m] {}; reach to {:.4g} m", arm.name,
                                      list_text(arm.p_BS), arm.max_reach_m)});
    if (!in_detail) return;
    side_.frames.emplace_back(X_WP, "P");
    side_.labels.push_back({tool, "tool point: the middle between the pads"});
    side_.labels.push_back({middle(arm.near_pad_body) + Eigen::Vector3d(0.0, 0.0, 0.05),
                            joint_text(joint(arm.finger_joint)) +
                                fmt::format(", grip_force_n {:g}", arm.grip_force_n)});
    if (arm.chain.empty()) {
      side_.labels.push_back({X_WP.translation(), joint_text(joint(arm.joint))});
    }
    for (const std::string& name : arm.chain) {
      const JointSpec& j = joint(name);
      const bool slides = j.type == JointType::kSlider;
      side_.labels.push_back({slides ? body(j.child).p_WB : j.p_WA, joint_text(j)});
    }
  }

  void note_line(const LineRobotSpec& robot) {
    const Eigen::Vector3d tool = 0.5 * (middle(robot.near_pad_body) + middle(robot.far_pad_body));
    tools_.push_back(tool);
    const Eigen::Isometry3d X_WB = pose_of(body(robot.base_body));
    for (View* view : {&side_, &top_}) view->frames.emplace_back(X_WB, "B");
    side_.labels.push_back(
        {X_WB.translation(), fmt::format("B: `{}` (base_body)", robot.base_body)});
    const std::pair<const char*, const std::string*> joints[] = {
        {"base_joint", &robot.base_joint},
        {"reach_joint", &robot.reach_joint},
        {"lift_joint", &robot.lift_joint},
        {"finger_joint", &robot.finger_joint}};
    for (const auto& [role, name] : joints) {
      const JointSpec& j = joint(*name);
      side_.labels.push_back({middle(j.child), joint_text(j) + fmt::format(" ({})", role)});
    }
    side_.labels.push_back({tool, "tool point: the middle between the pads"});
    top_.labels.push_back({tool, fmt::format("tool point {}", list_text(tool))});
    top_.labels.push_back(
        {middle(robot.near_pad_body), fmt::format("`{}` (near_pad_body)", robot.near_pad_body)});
    top_.labels.push_back({middle(robot.far_pad_body),
                           fmt::format("`{}` (far_pad_body), opening_m {:g}, grip_force_n {:g}",
                                       robot.far_pad_body, robot.opening_m, robot.grip_force_n)});
  }

  std::vector<Eigen::Vector3d> outline(BodyId id, const BodyShape& shape) const {
    Eigen::Isometry3d X_BS = Eigen::Isometry3d::Identity();
    X_BS.linear() = shape_rotation(shape);
    X_BS.translation() = shape.p_BS;
    std::vector<Eigen::Vector3d> points = hull_points(shape);
    for (Eigen::Vector3d& p : points) p = pose_of(layout_.bodies[id]) * X_BS * p;
    return points;
  }

  std::pair<Eigen::Vector2d, Eigen::Vector2d> bounds(const View& view) const {
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const BodyId id : parts_) {
      for (const BodyShape& shape : layout_.bodies[id].shapes) {
        for (const Eigen::Vector3d& p : outline(id, shape)) {
          low = low.cwiseMin(view.flat(p));
          high = high.cwiseMax(view.flat(p));
        }
      }
    }
    return {low, high};
  }
  Eigen::Vector2d extent(const View& view) const {
    const auto [low, high] = bounds(view);
    return high - low;
  }

  /// Draws the view below `top` and says where it ends.
  double draw(const View& view, double top, std::string& out) const {
    const auto [low, high] = bounds(view);
    const Eigen::Vector2d middle = 0.5 * (low + high);
    std::vector<Label> left, right;
    for (const Label& label : view.labels) {
      (view.flat(label.at_W).x() < middle.x() ? left : right).push_back(label);
    }
    const double lines = kLine * static_cast<double>(std::max(left.size(), right.size()) + 1);
    const double height = std::max(kPixels_m * (high - low).y(), lines) + 2.0 * kGap;
    const double centre = top + kLine + 0.5 * height;
    const double x0 = column_ + kGap;
    const auto pixel = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(x0 + kPixels_m * (p.x() - low.x()),
                             centre - kPixels_m * (p.y() - middle.y()));
    };
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"14\">{}</text>\n", x0,
                       top + kLine, view.title);
    for (const BodyId id : parts_) draw_body(view, id, pixel, out);
    for (const auto& [X, name] : view.frames) draw_frame(view, X, name, pixel, out);
    for (const Eigen::Vector3d& tool : tools_) {
      const Eigen::Vector2d p = pixel(view.flat(tool));
      out += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}h12M{2:.1f} {3:.1f}v12\" stroke=\"#c00000\" "
          "stroke-width=\"1.5\"/>\n",
          p.x() - 6.0, p.y(), p.x(), p.y() - 6.0);
    }
    const double edge = x0 + kPixels_m * (high - low).x() + kGap;
    draw_column(view, left, column_ - 6.0, centre, true, pixel, out);
    draw_column(view, right, edge + 6.0, centre, false, pixel, out);
    return top + kLine + height + kGap;
  }

  template <typename Pixel>
  void draw_body(const View& view, BodyId id, const Pixel& pixel, std::string& out) const {
    const BodySpec& spec = layout_.bodies[id];
    for (const BodyShape& shape : spec.shapes) {
      std::vector<Eigen::Vector2d> points;
      for (const Eigen::Vector3d& p : outline(id, shape)) points.push_back(view.flat(p));
      out += "<polygon points=\"";
      for (const Eigen::Vector2d& p : hull(std::move(points))) {
        out += fmt::format("{:.1f},{:.1f} ", pixel(p).x(), pixel(p).y());
      }
      out += spec.material == "pad" ? "\" fill=\"#e8b070\"" : "\" fill=\"#c8d4e4\"";
      out += " fill-opacity=\"0.55\" stroke=\"#405070\" stroke-width=\"0.8\"/>\n";
    }
  }

  template <typename Pixel>
  static void draw_frame(const View& view, const Eigen::Isometry3d& X, const std::string& name,
                         const Pixel& pixel, std::string& out) {
    constexpr double kArrow_m = 0.12;
    const Eigen::Vector2d o = pixel(view.flat(X.translation()));
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d tip_W = X * Eigen::Vector3d(kArrow_m * Eigen::Vector3d::Unit(axis));
      const Eigen::Vector2d tip = pixel(view.flat(tip_W));
      if ((tip - o).norm() < 1.0) continue;
      out += fmt::format(
          "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"2\"/>\n", o.x(),
          o.y(), tip.x(), tip.y(),
          axis == 0   ? "#d03030"
          : axis == 1 ? "#209020"
                      : "#2040d0");
    }
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n",
                       o.x() - 13.0, o.y() + 14.0, name);
  }

  /// Draws labels one under the other, in the order of the heights of the objects that they name.
  template <typename Pixel>
  static void draw_column(const View& view, std::vector<Label> labels, double x, double centre,
                          bool ends_there, const Pixel& pixel, std::string& out) {
    const auto height = [&](const Label& label) { return pixel(view.flat(label.at_W)).y(); };
    std::stable_sort(labels.begin(), labels.end(),
                     [&](const Label& a, const Label& b) { return height(a) < height(b); });
    const double count = static_cast<double>(labels.size());
    // Each as near to what it names as those above it, and those to come below it, allow.
    std::vector<double> at;
    double lowest = centre + 0.5 * kLine * count + 200.0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double wanted = height(labels[i]);
      at.push_back(at.empty() ? wanted : std::max(wanted, at.back() + kLine));
    }
    for (std::size_t i = labels.size(); i-- > 0;) {
      at[i] = std::min(at[i], lowest);
      lowest = at[i] - kLine;
    }
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const Eigen::Vector2d p = pixel(view.flat(labels[i].at_W));
      out += fmt::format(
          "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#909090\" stroke-width=\"0.6\" "
          "fill=\"none\"/>\n<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"#404040\"/>\n",
          p.x(), p.y(), x + (ends_there ? 2.0 : -2.0), at[i] - 4.0, p.x(), p.y());
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, at[i],
                         ends_there ? " text-anchor=\"end\"" : "", shown_in_full(labels[i].text));
    }
  }

  const WorldSpec& spec_;
  std::string title_;
  WorldLayout layout_;
  std::vector<BodyId> parts_;
  std::vector<Eigen::Vector3d> tools_;
  View side_, top_;
  double column_ = 0.0;  // width of the labels on either side
};

}  // namespace

std::string robot_svg(const WorldSpec& spec, const std::string& title) {
  return RobotDrawing(spec, title).svg();
}

}  // namespace parallax::harness
