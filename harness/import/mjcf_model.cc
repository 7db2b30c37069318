#include "harness/import/mjcf_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <type_traits>

#include "harness/import/mesh.h"

namespace parallax::harness {
namespace {

/// Each type once, for the writer and the reader alike.
template <typename Archive>
class Fields {
 public:
  explicit Fields(Archive& archive) : archive_(archive) {}

  template <typename... T>
  void all(T&... values) {
    (one(values), ...);
  }

 private:
  void one(std::string& text) { archive_.text(text); }
  void one(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    archive_.raw(&byte, sizeof(byte));
    value = byte != 0;
  }
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void one(T& value) { archive_.raw(&value, sizeof(value)); }
  template <int kRows>
  void one(Eigen::Matrix<double, kRows, 1>& v) {
    archive_.raw(v.data(), kRows * sizeof(double));
  }
  template <typename T>
  void one(std::vector<T>& list) {
    archive_.list(list);
    if constexpr (std::is_arithmetic_v<T>) {
      if (!list.empty()) archive_.raw(list.data(), list.size() * sizeof(T));
    } else {
      for (T& item : list) one(item);
    }
  }
  template <typename A, typename B>
  void one(std::pair<A, B>& pair) {
    all(pair.first, pair.second);
  }
  void one(MjcfFrame& f) { all(f.p, f.wxyz); }
  void one(MjcfBody& b) {
    all(b.name, b.parent, b.is_static, b.frame, b.mass_kg, b.centre, b.moments_kg_m2);
  }
  void one(MjcfJoint& j) {
    all(j.name, j.body, j.type, j.p_BJ, j.axis_B, j.is_limited, j.low, j.high, j.damping,
        j.friction, j.stiffness, j.armature, j.is_soft, j.has_margin);
  }
  void one(MjcfGeom& g) {
    all(g.name, g.body, g.form, g.size, g.frame, g.mesh, g.contact_type, g.contact_affinity,
        g.dimension, g.friction, g.has_priority, g.has_margin, g.is_soft);
  }
  void one(MjcfMesh& m) { all(m.name, m.points, m.faces); }
  void one(MjcfRest& r) { all(r.kind, r.tag, r.count, r.first, r.body); }

  Archive& archive_;
};

template <typename Archive>
void pass(Archive& archive, std::string& fault, MjcfModel& m) {
  Fields<Archive>(archive).all(fault, m.fault_line, m.fault_tag, m.gravity_m_s2, m.filters_parents,
                               m.has_contacts, m.bodies, m.joints, m.geoms, m.meshes, m.excluded,
                               m.rest);
}

class Writer {
 public:
  void raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  template <typename T>
  void list(const std::vector<T>& list) {
    const std::uint64_t size = list.size();
    raw(&size, sizeof(size));
  }
  void text(const std::string& text) {
    const std::uint64_t size = text.size();
    raw(&size, sizeof(size));
    raw(text.data(), text.size());
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}

  void raw(void* data, std::size_t size) {
    if (!has(size)) return;
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  /// No list has more items than bytes are left: each takes one at least.
  template <typename T>
  void list(std::vector<T>& list) {
    std::uint64_t size = 0;
    raw(&size, sizeof(size));
    constexpr std::size_t kItem = std::is_arithmetic_v<T> ? sizeof(T) : 8;
    if (size > (bytes_.size() - at_) / kItem) is_sound_ = false;
    if (is_sound_) list.resize(size);
  }
  void text(std::string& text) {
    std::uint64_t size = 0;
    raw(&size, sizeof(size));
    if (!has(size)) return;
    text.assign(bytes_, at_, size);
    at_ += size;
  }
  bool is_done() const { return is_sound_ && at_ == bytes_.size(); }

 private:
  bool has(std::uint64_t size) {
    if (size > bytes_.size() - at_) is_sound_ = false;
    return is_sound_;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool is_sound_ = true;
};

bool is_mesh(const MjcfMesh& mesh) {
  const std::size_t count = mesh.points.size() / 3;
  return mesh.points.size() % 3 == 0 && mesh.faces.size() % 3 == 0 &&
         mesh.faces.size() / 3 <= kMaxMeshFaces && count <= 3 * kMaxMeshFaces &&
         std::all_of(mesh.points.begin(), mesh.points.end(),
                     [](float x) { return std::isfinite(x); }) &&
         std::all_of(mesh.faces.begin(), mesh.faces.end(),
                     [&](std::uint32_t point) { return point < count; });
}

/// Checks the lists and the indices into them; other numbers may be anything.
bool is_sound(const MjcfModel& model) {
  const auto is_body = [&](std::uint32_t body) { return body < model.bodies.size(); };
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    if (model.bodies[i].parent >= i) return false;
  }
  for (const MjcfJoint& joint : model.joints) {
    if (!is_body(joint.body) || joint.type > MjcfJointType::kHinge) return false;
  }
  for (const MjcfGeom& geom : model.geoms) {
    if (!is_body(geom.body) || geom.form > MjcfForm::kMesh) return false;
    if (geom.form == MjcfForm::kMesh && geom.mesh >= model.meshes.size()) return false;
  }
  return !model.bodies.empty() && std::all_of(model.meshes.begin(), model.meshes.end(), &is_mesh) &&
         std::all_of(model.excluded.begin(), model.excluded.end(),
                     [&](const auto& pair) { return is_body(pair.first) && is_body(pair.second); });
}

bool is_frame(const MjcfFrame& f) {
  return f.p.allFinite() && f.wxyz.allFinite() && std::abs(f.wxyz.norm() - 1.0) < 1e-6;
}

bool are_finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

bool has_numbers(const MjcfBody& body) {
  return is_frame(body.frame) && is_frame(body.centre) && std::isfinite(body.mass_kg) &&
         body.moments_kg_m2.allFinite();
}
bool has_numbers(const MjcfJoint& joint) {
  return joint.p_BJ.allFinite() && joint.axis_B.allFinite() &&
         are_finite({joint.low, joint.high, joint.damping, joint.friction});
}
bool has_numbers(const MjcfGeom& geom) {
  return geom.size.allFinite() && is_frame(geom.frame) && std::isfinite(geom.friction);
}

std::string bytes_of(const MjcfModel& model) {
  Writer writer;
  MjcfModel copy = model;
  std::string fault = copy.fault.value_or("");
  pass(writer, fault, copy);
  return writer.take();
}

std::optional<MjcfModel> model_of(const std::string& bytes) {
  Reader reader(bytes);
  MjcfModel model;
  std::string fault;
  pass(reader, fault, model);
  if (!reader.is_done()) return std::nullopt;
  if (!fault.empty()) {
    model.fault = fault;
    return model;
  }
  if (!is_sound(model)) return std::nullopt;
  return model;
}

}  // namespace parallax::harness
