#include <ode/ode.h>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {
namespace {

// The engine's own convex geom stands on one contact point at a time and lets balls slide off its
// faces. The surface of the hull, as a mesh, carries what stands on it at its corners.
dTriMeshDataID mesh_of(OdeWorld::Engine& engine, const std::shared_ptr<const ConvexHull>& hull) {
  for (const auto& [known, mesh] : engine.meshes) {
    if (known == hull) return mesh;
  }
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  static_assert(sizeof(hull->faces.front()) == 3 * sizeof(dTriIndex));
  const dTriMeshDataID mesh = dGeomTriMeshDataCreate();
  dGeomTriMeshDataBuildDouble(mesh, hull->vertices.data(), sizeof(Eigen::Vector3d),
                              static_cast<int>(hull->vertices.size()), hull->faces.data(),
                              static_cast<int>(3 * hull->faces.size()), 3 * sizeof(dTriIndex));
  dGeomTriMeshDataPreprocess2(mesh, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);
  engine.meshes.emplace_back(hull, mesh);
  return mesh;
}

}  // namespace

dxGeom* create_geom(OdeWorld::Engine& engine, dxSpace* space, const GeomForm& form) {
  const Eigen::Vector3d& size_m = form.size_m;
  const double radius_m = 0.5 * size_m.x();
  switch (form.form) {
    case ShapeForm::kBox:
      break;
    case ShapeForm::kSphere:
      return dCreateSphere(space, radius_m);
    case ShapeForm::kCylinder:
      return dCreateCylinder(space, radius_m, size_m.z());
    case ShapeForm::kCapsule:
      return dCreateCapsule(space, radius_m, size_m.z() - size_m.x());
    case ShapeForm::kHull:
      return dCreateTriMesh(space, mesh_of(engine, form.hull), nullptr, nullptr, nullptr);
  }
  return dCreateBox(space, size_m.x(), size_m.y(), size_m.z());
}

void destroy_meshes(OdeWorld::Engine& engine) {
  for (const auto& [hull, mesh] : engine.meshes) dGeomTriMeshDataDestroy(mesh);
  engine.meshes.clear();
}

}  // namespace parallax::harness
