// Convex hulls compared with boxes of the same form, closed forms and geometry.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "harness/engine/sweep.h"
#include "harness/engine/world_check.h"
#include "harness/world/shapes.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

using HullFace = std::array<std::uint32_t, 3>;

BodyShape hull_shape(std::vector<Eigen::Vector3d> corners, const std::vector<HullFace>& faces) {
  std::string why;
  BodyShape shape;
  auto hull = hull_with(std::move(corners), faces, shape.p_BS, why);
  REQUIRE_MESSAGE(hull.has_value(), why);
  shape.form = ShapeForm::kHull;
  shape.size_m = hull->size_m;
  shape.hull = std::make_shared<const ConvexHull>(std::move(*hull));
  return shape;
}

/// A box as eight corners and twelve faces.
BodySpec hull_box(std::string name, const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_WB,
                  double mass_kg = 0.0) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(Eigen::Vector3d((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                                      (i & 4) != 0 ? 0.5 : -0.5)
                          .cwiseProduct(size_m));
  }
  BodySpec body = box_body(std::move(name), size_m, p_WB, mass_kg);
  body.shapes = {hull_shape(corners, {{{0, 4, 6}},
                                      {{0, 6, 2}},
                                      {{1, 3, 7}},
                                      {{1, 7, 5}},
                                      {{0, 1, 5}},
                                      {{0, 5, 4}},
                                      {{2, 6, 7}},
                                      {{2, 7, 3}},
                                      {{0, 2, 3}},
                                      {{0, 3, 1}},
                                      {{4, 5, 7}},
                                      {{4, 7, 6}}})};
  return body;
}

/// The corner at the origin and one on each axis.
BodyShape corner_piece(double x, double y, double z) {
  return hull_shape({{0.0, 0.0, 0.0}, {x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, z}},
                    {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}});
}

struct HullWorld {
  HullWorld(EngineKind engine, const WorldSpec& spec)
      : owned(make_world(stepped_by(engine, spec))), world(*owned) {
    const auto problems = check_world(stepped_by(engine, spec));
    for (const auto& problem : problems) CAPTURE(problem.message);
    REQUIRE(problems.empty());
    REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
  }
  void run(double time_s) {
    const auto steps = std::lround(time_s / world.timestep_s());
    for (long i = 0; i < steps; ++i) REQUIRE(world.step());
  }
  BodyId body(const char* name) const { return *world.layout().find_body(name); }
  std::unique_ptr<PhysicsWorld> owned;
  PhysicsWorld& world;
};

TEST_CASE("volume, centroid and moments are those of the body") {
  const auto box = hull_box("box", {0.1, 0.2, 0.3}, {0.0, 0.0, 0.0}).shapes.front();
  CHECK(volume_m3(box) == doctest::Approx(0.006));
  CHECK(box.hull->centroid.norm() < 1e-12);
  CHECK(box.hull->moments_m2(0, 0) == doctest::Approx((0.04 + 0.09) / 12.0));
  CHECK(box.hull->moments_m2(2, 2) == doctest::Approx((0.01 + 0.04) / 12.0));
  CHECK(std::abs(box.hull->moments_m2(0, 1)) < 1e-12);
  // A tetrahedron of three right angles: a sixth of the box, its centroid at a quarter of each
  // edge.
  const auto piece = corner_piece(0.3, 0.6, 0.9);
  CHECK(volume_m3(piece) == doctest::Approx(0.3 * 0.6 * 0.9 / 6.0));
  CHECK((centroid_B(piece) - Eigen::Vector3d(0.075, 0.15, 0.225)).norm() < 1e-12);
  // About the right angle the integral of x^2 is V a^2 / 10, that of x y is V a b / 20.
  const double x2 = 0.09 / 10.0 - 0.075 * 0.075, y2 = 0.36 / 10.0 - 0.15 * 0.15;
  CHECK(piece.hull->moments_m2(2, 2) == doctest::Approx(x2 + y2));
  CHECK(piece.hull->moments_m2(0, 1) == doctest::Approx(-(0.18 / 20.0 - 0.075 * 0.15)));
}

TEST_CASE("what is not closed and convex is no hull") {
  Eigen::Vector3d middle;
  const std::vector<Eigen::Vector3d> corners = {
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const std::vector<HullFace> faces = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
  const auto made = [&](std::vector<Eigen::Vector3d> at, const std::vector<HullFace>& of) {
    std::string why;
    return hull_with(std::move(at), of, middle, why).has_value();
  };
  CHECK(made(corners, faces));
  CHECK_FALSE(made(corners, {faces[0], faces[1], faces[2]}));
  CHECK_FALSE(made(corners, {faces[0], faces[1], faces[2], faces[2]}));
  CHECK_FALSE(made(corners, {faces[0], faces[1], faces[2], {{1, 2, 9}}}));
  auto inside = corners;
  inside.emplace_back(0.9, 0.9, 0.9);  // outside of the face across
  CHECK_FALSE(made(inside, faces));
  auto flat = corners;
  flat[3] = {0.5, 0.5, 0.0};
  CHECK_FALSE(made(flat, faces));
  auto odd = corners;
  odd[3].z() = std::nan("");
  CHECK_FALSE(made(odd, faces));
}

TEST_CASE(
    "a hull stands for ten seconds on the floor, on a box, on a hull, and carries what is round") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec can =
        box_body("can", round_size_m(ShapeForm::kCylinder, 0.05, 0.2), {3.0, 0.0, 0.3}, 1.0);
    can.shapes.front().form = ShapeForm::kCylinder;
    BodySpec ball =
        box_body("ball", round_size_m(ShapeForm::kSphere, 0.05, 0.0), {4.0, 0.0, 0.25}, 1.0);
    ball.shapes.front().form = ShapeForm::kSphere;
    WorldSpec spec = world_of({hull_box("on_floor", {0.1, 0.1, 0.2}, {0.0, 0.0, 0.1}, 1.0),
                               box_body("table", {1.0, 1.0, 0.2}, {1.0, 0.0, 0.1}),
                               hull_box("on_table", {0.1, 0.1, 0.2}, {1.0, 0.0, 0.3}, 1.0),
                               hull_box("slab", {0.8, 0.8, 0.2}, {2.0, 0.0, 0.1}),
                               hull_box("on_slab", {0.1, 0.1, 0.2}, {2.0, 0.0, 0.3}, 1.0),
                               hull_box("slab2", {0.8, 0.8, 0.2}, {3.0, 0.0, 0.1}), can,
                               hull_box("slab3", {0.8, 0.8, 0.2}, {4.0, 0.0, 0.1}), ball,
                               hull_box("lower", {0.3, 0.3, 0.1}, {0.0, 2.0, 0.05}, 2.0),
                               hull_box("upper", {0.1, 0.1, 0.1}, {0.02, 2.03, 0.15}, 0.5)});
    spec.bodies[2].yaw_rad = 0.3;
    spec.bodies[4].yaw_rad = 0.7;
    HullWorld still(engine, spec);
    still.run(10.0);
    for (const BodySpec& body : spec.bodies) {
      CAPTURE(body.name);
      const BodyId id = still.body(body.name.c_str());
      CHECK((still.world.position(id) - body.p_WB).norm() < 0.001);
      // A ball may have rolled by that millimetre.
      const double turn_rad = body.name == "ball" ? 0.001 / 0.05 : 0.0014;
      CHECK(still.world.rotation(id)(2, 2) > std::cos(turn_rad));
    }
  }
}

/// A prism with that many sides, as the hull of a mug is one.
BodyShape prism(std::uint32_t sides, double radius_m, double height_m) {
  std::vector<Eigen::Vector3d> corners;
  std::vector<HullFace> faces;
  for (const double z : {-0.5 * height_m, 0.5 * height_m}) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / sides;
      corners.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), z);
    }
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    faces.push_back({{k, next, sides + next}});
    faces.push_back({{k, sides + next, sides + k}});
    if (k == 0 || next == 0) continue;
    faces.push_back({{0, next, k}});
    faces.push_back({{sides, sides + k, sides + next}});
  }
  return hull_shape(corners, faces);
}

TEST_CASE("what has many corners below stands on all sides of them") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    std::vector<BodySpec> bodies = {box_body("table", {0.6, 0.6, 0.2}, {1.0, 0.0, 0.1}),
                                    hull_box("slab", {0.6, 0.6, 0.2}, {2.0, 0.0, 0.1}),
                                    box_body("plinth", {0.6, 0.6, 0.2}, {3.0, 0.0, 0.1})};
    bodies[2].shapes = {prism(32, 0.3, 0.2)};
    for (int i = 0; i < 4; ++i) {
      BodySpec mug = box_body("mug" + std::to_string(i), {0.08, 0.08, 0.1},
                              {static_cast<double>(i), 0.0, i == 0 ? 0.05 : 0.25}, 0.3);
      mug.shapes = {prism(32, 0.04, 0.1)};
      bodies.push_back(mug);
    }
    const WorldSpec spec = world_of(bodies);
    HullWorld still(engine, spec);
    still.run(10.0);
    for (const BodySpec& body : spec.bodies) {
      CAPTURE(body.name);
      const BodyId id = still.body(body.name.c_str());
      CHECK((still.world.position(id) - body.p_WB).norm() < 0.001);
      CHECK(still.world.rotation(id)(2, 2) > 1.0 - 1e-6);
    }
  }
}

TEST_CASE("a hull that is a box slides down a slope as that box does, and as Coulomb says") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double slope = 0.35, mu = 0.2, time_s = 1.0;
    double ways[2] = {};
    for (const bool is_hull : {false, true}) {
      BodySpec ramp = box_body("ramp", {6.0, 1.0, 0.2}, {0.0, 0.0, 2.0});
      ramp.shapes.front().pitch_rad = slope;
      const Eigen::Vector3d up(std::sin(slope), 0.0, std::cos(slope));
      const Eigen::Vector3d p = ramp.p_WB + 0.2 * up;
      BodySpec thing = is_hull ? hull_box("thing", {0.2, 0.2, 0.2}, p, 1.0)
                               : box_body("thing", {0.2, 0.2, 0.2}, p, 1.0);
      thing.shapes.front().pitch_rad = slope;
      WorldSpec spec = world_of({ramp, thing});
      spec.friction.fallback = mu;
      HullWorld running(engine, spec);
      running.run(time_s);
      ways[is_hull ? 1 : 0] = (running.world.position(running.body("thing")) - p).norm();
    }
    const double expected = 0.5 * 9.81 * (std::sin(slope) - mu * std::cos(slope)) * time_s * time_s;
    CHECK(ways[0] == doctest::Approx(expected).epsilon(0.01));
    CHECK(ways[1] == doctest::Approx(expected).epsilon(0.01));
    CHECK(ways[1] == doctest::Approx(ways[0]).epsilon(0.005));
  }
}

TEST_CASE("hulls that fall on each other repeat to the bit, in this world and in a fresh one") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec top = hull_box("top", {0.1, 0.1, 0.2}, {0.02, 0.01, 0.6}, 1.0);
    top.shapes.front().pitch_rad = 0.4;
    BodySpec piece = box_body("piece", {0.1, 0.1, 0.1}, {0.05, 0.0, 0.9}, 0.3);
    piece.shapes = {corner_piece(0.2, 0.15, 0.1)};
    const WorldSpec spec =
        world_of({hull_box("low", {0.1, 0.1, 0.2}, {0.0, 0.0, 0.1}, 1.0), top, piece});
    HullWorld one(engine, spec), other(engine, spec);
    one.run(3.0);
    other.run(3.0);
    CHECK(one.world.digest() == other.world.digest());
    const auto first = one.world.digest();
    REQUIRE_FALSE(one.world.reset(default_placements(one.world.layout()), 1).has_value());
    one.run(3.0);
    CHECK(one.world.digest() == first);
    // They have come to rest above the floor, none of them in another.
    for (const char* name : {"low", "top", "piece"}) {
      CHECK(one.world.bounds(one.body(name)).low.z() > -0.002);
    }
  }
}

TEST_CASE("probes, rays, bounds and sweeps see the hull, not the box round it") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec piece = box_body("piece", {1.0, 1.0, 1.0}, {0.0, 0.0, 1.0});
    piece.shapes = {corner_piece(1.0, 1.0, 1.0)};
    const auto world_owned = make_world(stepped_by(engine, world_of({piece})));
    auto& world = *world_owned;
    const BodyId id = *world.layout().find_body("piece");
    const BodyMask none(1, false);
    const auto probe_at = [](double x, double y, double z) {
      return Probe{Eigen::Vector3d::Constant(0.02), {x, y, z}, Eigen::Matrix3d::Identity()};
    };
    CHECK(world.overlaps(probe_at(0.32, 0.32, 1.32), id));     // on the slope
    CHECK(world.overlaps(probe_at(0.1, 0.1, 1.1), id));        // wholly within
    CHECK_FALSE(world.overlaps(probe_at(0.6, 0.6, 1.6), id));  // in the box round it alone
    const auto hit = world.ray_meets({0.25, 0.25, 5.0}, {0.25, 0.25, 0.5}, id);
    REQUIRE(hit.has_value());
    CHECK(*hit == doctest::Approx(5.0 - 1.5));
    CHECK(contains(world.layout().bodies[id].shapes.front(), {0.3, 0.3, 0.3}));
    CHECK_FALSE(contains(world.layout().bodies[id].shapes.front(), {0.4, 0.4, 0.4}));
    // Turned by half a right angle about z, its corners say how wide it is, not those of its box.
    BodySpec turned = piece;
    turned.yaw_rad = 0.25 * std::numbers::pi;
    const auto second_owned = make_world(stepped_by(engine, world_of({turned})));
    auto& second = *second_owned;
    const BodyBounds bounds = second.bounds(*second.layout().find_body("piece"));
    CHECK(bounds.high.y() == doctest::Approx(std::sqrt(0.5)));
    CHECK(bounds.low.x() == doctest::Approx(-std::sqrt(0.5)));
    // The lowest point of a hull on its tip, for starts that choose `bottom`.
    BodySpec tip = piece;
    tip.mass_kg = 1.0;
    tip.shapes.front().roll_rad = std::numbers::pi;
    tip.shapes.front().p_BS.setZero();
    const auto third_owned = make_world(stepped_by(engine, world_of({tip})));
    auto& third = *third_owned;
    CHECK(third.bounds(*third.layout().find_body("piece")).low.z() == doctest::Approx(0.5));
    // Something small that a start puts into a hull is an invalid start.
    const auto fourth_owned = make_world(stepped_by(engine, world_of({piece})));
    auto& fourth = *fourth_owned;
    CHECK(fourth.find_obstacle(probe_at(0.2, 0.2, 1.2), none, 0.0).has_value());
    WorldSpec within = world_of({hull_box("block", {1.0, 1.0, 1.0}, {0.0, 0.0, 0.5}),
                                 box_body("crumb", {0.02, 0.02, 0.02}, {0.1, 0.1, 0.5}, 0.01)});
    const auto fifth_owned = make_world(stepped_by(engine, within));
    auto& fifth = *fifth_owned;
    const auto overlap = fifth.reset(default_placements(fifth.layout()), 1);
    REQUIRE(overlap.has_value());
    CHECK(overlap->first == "block");
  }
}

class HullChance {
 public:
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d point(double reach_m) {
    return {within(-reach_m, reach_m), within(-reach_m, reach_m), within(-reach_m, reach_m)};
  }
  Eigen::Matrix3d turn() {
    return (Eigen::AngleAxisd(within(-3.0, 3.0), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(within(-3.0, 3.0), Eigen::Vector3d::UnitY()))
        .toRotationMatrix();
  }

 private:
  std::mt19937 engine_{5};
};

TEST_CASE("probes find a hull where they share a point with it, rays where its planes are") {
  BodySpec thing = box_body("thing", {1.0, 1.0, 1.0}, {0.0, 0.0, 2.0});
  thing.shapes = {prism(7, 0.3, 0.5)};
  thing.shapes.front().roll_rad = 0.4;
  const BodyShape& shape = thing.shapes.front();
  const ConvexHull& hull = *shape.hull;
  const Eigen::Matrix3d R = shape_rotation(shape);
  const Eigen::Vector3d middle = thing.p_WB + shape.p_BS;
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const auto world = make_world(stepped_by(engine, world_of({thing})));
    const BodyId id = *world->layout().find_body("thing");
    HullChance chance;
    int found = 0, apart = 0, met = 0;
    for (int i = 0; i < 1500; ++i) {
      CAPTURE(i);
      const Probe probe{{0.2, 0.1, 0.3}, middle + chance.point(0.6), chance.turn()};
      bool shares = false, cornered = false;
      for (int k = 0; k < 300 && !shares; ++k) {
        const Eigen::Vector3d p_W =
            probe.p_WS + probe.R_WS * chance.point(0.5).cwiseProduct(probe.size_m);
        shares = contains(shape, p_W - thing.p_WB);
      }
      // Beyond one of the hull's planes as a whole.
      for (std::size_t k = 0; k < hull.normals.size(); ++k) {
        const Eigen::Vector3d normal = R * hull.normals[k];
        const double reach_m = 0.5 * (probe.R_WS.transpose() * normal).cwiseAbs().dot(probe.size_m);
        cornered = cornered || normal.dot(probe.p_WS - middle) - reach_m > hull.offsets[k] + 1e-5;
      }
      if (shares) CHECK(world->overlaps(probe, id));
      if (cornered) CHECK_FALSE(world->overlaps(probe, id));
      found += shares ? 1 : 0;
      apart += cornered ? 1 : 0;
      const Eigen::Vector3d from = middle + 2.0 * chance.point(1.0).normalized();
      const Eigen::Vector3d to = middle + chance.point(0.4);
      const auto hit = world->ray_meets(from, to, id);
      if (!hit) continue;
      ++met;
      const Eigen::Vector3d p_H = R.transpose() * (from + *hit * (to - from).normalized() - middle);
      CHECK(std::abs(hull.depth_of(p_H)) < 1e-6);
    }
    CHECK(found > 200);
    CHECK(apart > 200);
    CHECK(met > 300);
  }
}

void compare_hulls_with_boxes(EngineKind engine) {
  CAPTURE(to_string(engine));
  HullChance chance;
  int deep = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    const Eigen::Vector3d p_W = Eigen::Vector3d(0.0, 0.0, 2.0) + chance.point(0.25);
    const double roll = chance.within(-3.0, 3.0), pitch = chance.within(-1.5, 1.5);
    std::array<std::optional<Overlap>, 2> overlaps;
    for (const bool is_hull : {false, true}) {
      const auto make = [&](const char* name, const Eigen::Vector3d& size,
                            const Eigen::Vector3d& at, double mass_kg) {
        return is_hull ? hull_box(name, size, at, mass_kg) : box_body(name, size, at, mass_kg);
      };
      BodySpec upper = make("upper", {0.2, 0.3, 0.1}, p_W, 1.0);
      upper.shapes.front().roll_rad = roll;
      upper.shapes.front().pitch_rad = pitch;
      WorldSpec spec = world_of({make("lower", {0.4, 0.2, 0.2}, {0.0, 0.0, 2.0}, 0.0), upper});
      spec.solver.start_penetration_m = 1e-4;
      const auto world = make_world(stepped_by(engine, spec));
      overlaps[is_hull ? 1 : 0] = world->reset(default_placements(world->layout()), 1);
    }
    REQUIRE(overlaps[0].has_value() == overlaps[1].has_value());
    if (!overlaps[0]) continue;
    ++deep;
    CHECK(overlaps[1]->depth_m == doctest::Approx(overlaps[0]->depth_m).epsilon(0.11));
  }
  CHECK(deep > 50);
}

TEST_CASE("hulls that are boxes are as deep in each other as these boxes are") {
  for (const EngineKind engine : engines_with_trees()) compare_hulls_with_boxes(engine);
}

TEST_CASE("a moving hull meets what its hull meets") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec mover = box_body("mover", {0.2, 0.2, 0.2}, {0.0, 0.0, 0.5}, 1.0);
    mover.shapes = {corner_piece(0.4, 0.4, 0.4)};
    const WorldSpec spec = world_of({mover, box_body("post", {0.1, 0.1, 0.1}, {2.0, 0.2, 0.85}),
                                     box_body("wall", {0.1, 2.0, 1.0}, {3.0, 0.0, 0.6})});
    const auto world_owned = make_world(stepped_by(engine, spec));
    auto& world = *world_owned;
    BodyMask moves(3, false), none(3, false);
    moves[world.layout().find_body("mover")->index()] = true;
    const Sweep sweep(world, moves, none, 0.001);
    const auto hit = sweep.along(Eigen::Vector3d::Zero(), {4.0, 0.0, 0.0}, 0.005);
    REQUIRE(hit.has_value());
    CHECK(hit->obstacle == "wall");  // it passes below the post, which its box would not
    CHECK(hit->way_m == doctest::Approx(2.95 - 0.4).epsilon(0.01));
  }
}

}  // namespace
}  // namespace parallax::harness
