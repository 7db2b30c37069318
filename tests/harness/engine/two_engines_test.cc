// Properties of a world at rest on which all engines must agree, and properties of those that have
// joint coordinates.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <variant>

#include "harness/engine/link_tree.h"
#include "harness/engine/world_check.h"
#include "harness/world/shapes.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr std::array<ShapeForm, 4> kForms = {ShapeForm::kBox, ShapeForm::kSphere,
                                             ShapeForm::kCylinder, ShapeForm::kCapsule};

BodySpec formed(std::string name, ShapeForm form, const Eigen::Vector3d& p_WB,
                double mass_kg = 0.0) {
  const Eigen::Vector3d size =
      form == ShapeForm::kBox ? Eigen::Vector3d(0.3, 0.5, 0.4) : round_size_m(form, 0.15, 0.4);
  BodySpec body = box_body(std::move(name), size, p_WB, mass_kg);
  body.shapes.front().form = form;
  return body;
}

/// One of each form, leaning, well above the floor and apart from each other.
WorldSpec gallery() {
  std::vector<BodySpec> bodies;
  for (std::size_t i = 0; i < kForms.size(); ++i) {
    BodySpec body = formed("form" + std::to_string(i), kForms[i],
                           {2.0 * static_cast<double>(i), 0.0, 1.0}, i % 2 == 0 ? 0.0 : 2.0);
    body.shapes.front().roll_rad = 0.4;
    body.shapes.front().pitch_rad = -0.7;
    body.yaw_rad = 0.3;
    bodies.push_back(body);
  }
  return world_of(bodies);
}

class Chance {
 public:
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d point(const Eigen::Vector3d& middle, double reach_m) {
    return middle + Eigen::Vector3d(within(-reach_m, reach_m), within(-reach_m, reach_m),
                                    within(-reach_m, reach_m));
  }
  Eigen::Matrix3d turn() {
    return (Eigen::AngleAxisd(within(-3.0, 3.0), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(within(-3.0, 3.0), Eigen::Vector3d::UnitY()))
        .toRotationMatrix();
  }

 private:
  std::mt19937 engine_{7};
};

struct Pair {
  Pair(const WorldSpec& spec, EngineKind engine)
      : ode(make_world(stepped_by(EngineKind::kOde, spec))),
        other(make_world(stepped_by(engine, spec))) {}
  std::unique_ptr<PhysicsWorld> ode, other;
};

void compare_rays(EngineKind engine) {
  CAPTURE(to_string(engine));
  const Pair pair(gallery(), engine);
  Chance chance;
  const BodyMask none(kForms.size(), false);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d middle(2.0 * static_cast<double>(i % 4), 0.0, 1.0);
    const Eigen::Vector3d from = chance.point(middle, 1.5) + Eigen::Vector3d(0.0, 0.0, 0.8);
    const Eigen::Vector3d to = chance.point(middle, 0.8);
    const auto inside = [&](const Eigen::Vector3d& p) {
      const Probe dot{Eigen::Vector3d::Constant(0.002), p, Eigen::Matrix3d::Identity(),
                      ShapeForm::kSphere};
      return pair.ode->find_obstacle(dot, none, 0.0).has_value();
    };
    if (inside(from) || inside(to)) continue;  // where a ray begins or ends in a body is of no use
    const auto a = pair.ode->cast_ray(from, to, none), b = pair.other->cast_ray(from, to, none);
    CAPTURE(i);
    REQUIRE(a.has_value() == b.has_value());
    if (!a) continue;
    ++hits;
    CHECK(a->body == b->body);
    CHECK(a->distance_m == doctest::Approx(b->distance_m).epsilon(1e-6));
  }
  CHECK(hits > 300);
  // The floor from below, too.
  const auto floor = pair.other->cast_ray({9.0, 9.0, -1.0}, {9.0, 9.0, 1.0}, none);
  REQUIRE(floor.has_value());
  CHECK(floor->body == "floor");
  CHECK(floor->distance_m == doctest::Approx(1.0));
}

TEST_CASE("rays meet the same body at the same distance in every engine") {
  for (const EngineKind engine : engines_with_trees()) compare_rays(engine);
}

/// Is one of some points of the probe in a shape of the body?
bool shares_a_point(const PhysicsWorld& world, const Probe& probe, BodyId id, Chance& chance) {
  const BodyShape own{probe.size_m, Eigen::Vector3d::Zero(), 0.0, probe.form};
  const Eigen::Matrix3d R_WB = world.rotation(id);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = chance.point(Eigen::Vector3d::Zero(), 0.5).cwiseProduct(probe.size_m);
    if (!contains(own, p)) continue;
    const Eigen::Vector3d p_W = probe.p_WS + probe.R_WS * p;
    const Eigen::Vector3d p_B = R_WB.transpose() * (p_W - world.position(id));
    if (contains(world.layout().bodies[id].shapes.front(), p_B)) return true;
  }
  return false;
}

void compare_probes(EngineKind engine) {
  CAPTURE(to_string(engine));
  const Pair pair(gallery(), engine);
  Chance chance;
  const BodyMask none(kForms.size(), false);
  int found = 0, free = 0, missed_by_ode = 0;
  for (int i = 0; i < 4000; ++i) {
    const ShapeForm form = kForms[static_cast<std::size_t>(i / 4 % 4)];
    Probe probe{
        form == ShapeForm::kBox ? Eigen::Vector3d(0.2, 0.1, 0.3) : round_size_m(form, 0.08, 0.3),
        chance.point({2.0 * static_cast<double>(i % 4), 0.0, 1.0}, 0.5), chance.turn(), form};
    Probe larger = probe;
    larger.size_m *= 1.03;
    CAPTURE(i);
    const BodyId id(static_cast<std::uint32_t>(i % 4));
    const auto in_other = pair.other->find_obstacle(probe, none, 0.0);
    if (shares_a_point(*pair.ode, probe, id, chance)) {
      REQUIRE(in_other.has_value());
      CHECK(in_other->first == pair.other->layout().bodies[id].name);
      CHECK(pair.other->overlaps(probe, id));
      if (!pair.ode->overlaps(probe, id)) ++missed_by_ode;
      ++found;
    } else if (!pair.ode->find_obstacle(larger, none, 0.0)) {
      CHECK_FALSE(in_other.has_value());
      ++free;
    }
  }
  CHECK(found > 500);
  CHECK(free > 500);
  CHECK(100 * missed_by_ode < found);  // a box that lies in a cylinder as a whole, seldom
}

TEST_CASE(
    "probes of every form find what shares a point with them, and not what is clear of them") {
  for (const EngineKind engine : engines_with_trees()) compare_probes(engine);
}

TEST_CASE("the depth of boxes in each other is that of geometry: by faces, by a corner, by edges") {
  const double edge_m = 0.1 * std::numbers::sqrt2;  // from the middle of a box of 0.2 m to an edge
  struct Case {
    double roll_rad, pitch_rad, lower_roll_rad, reach_m;  // what the two reach towards each other
  };
  const double quarter = 0.25 * std::numbers::pi;
  BodyShape corner{{0.2, 0.2, 0.2}};
  corner.roll_rad = 0.5;
  corner.pitch_rad = 0.4;
  const double corner_m = half_extents(corner.form, corner.size_m, shape_rotation(corner)).z();
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    for (const Case& one : {Case{0.0, 0.0, 0.0, 0.2}, Case{0.5, 0.4, 0.0, 0.1 + corner_m},
                            Case{0.0, quarter, quarter, 2.0 * edge_m}}) {
      CAPTURE(one.reach_m);
      BodySpec lower = box_body("lower", {1.0, 0.2, 0.2}, {0.0, 0.0, 1.0});
      BodySpec upper = box_body("upper", {0.2, 0.2, 0.2}, {0.0, 0.0, 3.0}, 1.0);
      lower.shapes.front().roll_rad = one.lower_roll_rad;
      upper.shapes.front().roll_rad = one.roll_rad;
      upper.shapes.front().pitch_rad = one.pitch_rad;
      if (one.lower_roll_rad != 0.0) upper.shapes.front().size_m.y() = 1.0;
      const auto world = make_world(stepped_by(engine, world_of({lower, upper})));
      auto placements = default_placements(world->layout());
      const auto id = *world->layout().find_body("upper");
      placements[id.index()].p_WB.z() = 1.0 + one.reach_m - 0.01;
      const auto overlap = world->reset(placements, 1);
      REQUIRE(overlap.has_value());
      CHECK(overlap->depth_m == doctest::Approx(0.01).epsilon(1e-6));
      placements[id.index()].p_WB.z() = 1.0 + one.reach_m + 1e-6;
      CHECK_FALSE(world->reset(placements, 1).has_value());
    }
  }
}

TEST_CASE("a start in which bodies overlap is refused by every engine, with the depth") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const auto world = make_world(
        stepped_by(engine, world_of({box_body("shelf", {1.0, 1.0, 0.1}, {0.0, 0.0, 1.0}),
                                     box_body("book", {0.2, 0.2, 0.2}, {0.0, 0.0, 1.3}, 1.0)})));
    auto placements = default_placements(world->layout());
    placements[world->layout().find_body("book")->index()].p_WB.z() = 1.14;
    const auto overlap = world->reset(placements, 1);
    REQUIRE(overlap.has_value());
    CHECK(overlap->first == "book");
    CHECK(overlap->second == "shelf");
    CHECK(overlap->depth_m == doctest::Approx(0.01).epsilon(1e-6));
  }
}

/// The inertia of a shape, summed over small cubes.
Eigen::Matrix3d summed_inertia(const BodyShape& shape, double mass_kg) {
  constexpr int kCubes = 120;
  const Eigen::Vector3d half = half_extents(shape.form, shape.size_m, shape_rotation(shape));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (int x = 0; x < kCubes; ++x) {
    for (int y = 0; y < kCubes; ++y) {
      for (int z = 0; z < kCubes; ++z) {
        const Eigen::Vector3d at(x, y, z);
        const Eigen::Vector3d p =
            ((2.0 * at + Eigen::Vector3d::Ones()) / kCubes - Eigen::Vector3d::Ones())
                .cwiseProduct(half);
        if (!contains(shape, shape.p_BS + p)) continue;
        sum += p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose();
        count += 1.0;
      }
    }
  }
  return mass_kg / count * sum;
}

TEST_CASE("mass and inertia of every form are those of the space that it fills") {
  for (const ShapeForm form : kForms) {
    CAPTURE(static_cast<int>(form));
    BodySpec body = formed("thing", form, {0.0, 0.0, 3.0}, 1.7);
    body.shapes.front().roll_rad = 0.5;
    body.shapes.front().pitch_rad = 0.9;
    body.shapes.front().p_BS = {0.1, -0.2, 0.05};
    const auto tree = grow_tree(lay_out(world_of({body})));
    REQUIRE(std::holds_alternative<LinkTree>(tree));
    const TreeLink& link = *std::get<LinkTree>(tree).links.begin();
    const Eigen::Matrix3d expected = summed_inertia(body.shapes.front(), 1.7);
    CHECK(link.mass_kg == doctest::Approx(1.7));
    CHECK((link.p_LC - body.shapes.front().p_BS).norm() < 1e-12);
    CHECK((link.I_C_kg_m2 - expected).norm() < 0.01 * expected.norm());
  }
}

TEST_CASE("a mass set at reset counts, and leaves nothing behind") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec box = box_body("box", {0.2, 0.2, 0.2}, {0.0, 0.0, 0.1}, 1.0);
    box.settable = {"mass"};
    const auto spec = stepped_by(engine, world_of({box}));
    const auto digest_of = [](PhysicsWorld& world, double mass_kg) {
      auto placements = default_placements(world.layout());
      placements.front().mass_kg = mass_kg;
      placements.front().p_WB.z() = 0.3;
      REQUIRE_FALSE(world.reset(placements, 1).has_value());
      for (int i = 0; i < 300; ++i) REQUIRE(world.step());
      return world.digest();
    };
    const auto fresh = make_world(spec), used = make_world(spec);
    const auto light = digest_of(*fresh, 0.0);
    digest_of(*used, 7.3);
    CHECK(used->mass_kg(*used->layout().find_body("box")) == 7.3);
    CHECK(digest_of(*used, 0.0) == light);
    CHECK(used->mass_kg(*used->layout().find_body("box")) == 1.0);
  }
}

TEST_CASE("a state on its way to infinity is lost in every engine, and no file is written") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = world_of({box_body("rocket", {0.1, 0.1, 0.1}, {0.0, 0.0, 1.0}, 1e-3)});
    JointSpec rail;
    rail.name = "rail";
    rail.child = "rocket";
    spec.joints = {rail};
    const auto world = make_world(stepped_by(engine, spec));
    REQUIRE_FALSE(world->reset(default_placements(world->layout()), 1).has_value());
    world->set_motor(*world->layout().find_slider("rail"), 1e9, 1e12);
    bool lost = false;
    for (int i = 0; i < 100 && !lost; ++i) lost = !world->step();
    CHECK(lost);
    REQUIRE_FALSE(world->reset(default_placements(world->layout()), 1).has_value());
    CHECK(world->step());
    CHECK_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
  }
}

TEST_CASE("boxes that lie flat on each other, turned by 45 degrees, stay where they are") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    // Where roundings turn one of the eight by a hair.
    BodySpec ring = box_body("ring", {0.0446, 0.0446, 0.012}, {0.65, -0.25, 0.755}, 0.5);
    ring.shapes.front().p_BS.z() = -0.039;
    for (int i = 0; i < 8; ++i) {
      const double turn = 0.25 * std::numbers::pi * i;
      ring.shapes.push_back({{0.012, 0.08 * (std::numbers::sqrt2 - 1.0), 0.09},
                             {0.034 * std::cos(turn), 0.034 * std::sin(turn), 0.0},
                             turn});
    }
    WorldSpec spec = world_of({box_body("tray", {0.26, 0.30, 0.01}, {0.65, -0.25, 0.705}), ring});
    spec.solver.surface_layer_m = 0.0002;
    const auto world = make_world(stepped_by(engine, spec));
    const auto id = *world->layout().find_body("ring");
    for (int place = 0; place < 40; ++place) {
      CAPTURE(place);
      auto placements = default_placements(world->layout());
      placements[id.index()].p_WB.x() += 0.0013 * place;
      const Eigen::Vector3d start = placements[id.index()].p_WB;
      REQUIRE_FALSE(world->reset(placements, 1).has_value());
      for (int i = 0; i < 200; ++i) REQUIRE(world->step());
      CHECK((world->position(id) - start).norm() < 0.001);
    }
  }
}

TEST_CASE("a ring of joints is refused by its joint where joints must make trees") {
  WorldSpec spec = world_of({box_body("a", {0.1, 0.1, 0.1}, {0.0, 0.0, 1.0}, 1.0),
                             box_body("b", {0.1, 0.1, 0.1}, {1.0, 0.0, 1.0}, 1.0)});
  JointSpec there;
  there.name = "there";
  there.parent = "a";
  there.child = "b";
  JointSpec back = there;
  back.name = "back";
  std::swap(back.parent, back.child);
  spec.joints = {there, back};
  CHECK(check_world(spec).empty());
  for (const EngineKind engine : {EngineKind::kMujoco, EngineKind::kBullet}) {
    const auto problems = check_world(stepped_by(engine, spec));
    REQUIRE(problems.size() == 1);
    CHECK(problems.front().path == "joints/back");
    CHECK(problems.front().message.find("ring") != std::string::npos);
    CHECK(problems.front().message.ends_with(std::string(engine_title(engine)) + " needs one"));
  }
}

TEST_CASE("what stands on the floor is touched from below, what a pad presses by the pad") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const auto world = make_world(
        stepped_by(engine, world_of({box_body("box", {0.2, 0.2, 0.2}, {0.0, 0.0, 0.1}, 1.0),
                                     box_body("other", {0.2, 0.2, 0.2}, {1.0, 0.0, 0.6}, 1.0)})));
    REQUIRE_FALSE(world->reset(default_placements(world->layout()), 1).has_value());
    for (int i = 0; i < 20; ++i) REQUIRE(world->step());
    CHECK(world->touch(*world->layout().find_body("box")).support);
    CHECK_FALSE(world->touch(*world->layout().find_body("other")).support);
  }
}

}  // namespace
}  // namespace parallax::harness
