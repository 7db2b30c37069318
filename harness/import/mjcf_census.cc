#include "harness/import/mjcf_census.h"

#include "harness/import/xml_census.h"

namespace parallax::harness {
namespace {

/// Elements and attributes of MuJoCo 2.2 that have a counterpart in our worlds. Attributes
/// stand here too where the compiled model says whether they matter, as `stiffness`: its springs
/// are listed from there, with what default classes come to.
constexpr TakenOf kReadInMjcf[] = {
    {"mujoco", "model", "", "compiler option default asset worldbody contact",
     "custom equality tendon actuator sensor keyframe"},
    {"compiler",
     "autolimits boundmass boundinertia settotalmass balanceinertia strippath coordinate angle "
     "fitaabb eulerseq meshdir texturedir discardvisual convexhull usethread fusestatic "
     "inertiafromgeom inertiagrouprange exactmeshinertia"},
    {"option",
     "timestep apirate impratio tolerance noslip_tolerance mpr_tolerance gravity wind magnetic "
     "density viscosity o_margin o_solref o_solimp integrator collision cone jacobian solver "
     "iterations noslip_iterations mpr_iterations",
     "", "flag"},
    {"flag",
     "constraint equality frictionloss limit contact passive gravity clampctrl warmstart "
     "filterparent actuation refsafe sensor override energy fwdinv sensornoise multiccd"},
    // Classes of what is listed wherever it stands say nothing by themselves.
    {"default", "class", "", "default mesh joint geom",
     "material site camera light pair equality tendon general motor position velocity intvelocity "
     "damper cylinder muscle adhesion"},
    {"asset", "", "", "mesh", "texture skin material"},
    {"mesh", "name class file vertex face refpos refquat scale smoothnormal=false"},
    {"worldbody", "", "", "body geom", "site camera light"},
    {"body", "name childclass mocap pos quat axisangle xyaxes zaxis euler", "",
     "inertial body joint freejoint geom", "site camera light"},
    {"inertial", "pos quat axisangle xyaxes zaxis euler mass diaginertia fullinertia"},
    {"joint",
     "name class type group=0 pos axis springdamper limited solreflimit solimplimit "
     "solreffriction solimpfriction stiffness range margin ref springref=0 armature damping "
     "frictionloss"},
    {"freejoint", "name group=0"},
    {"geom",
     "name class type group=0 contype conaffinity condim priority size friction mass density "
     "shellinertia solmix solref solimp margin gap fromto pos quat axisangle xyaxes zaxis euler "
     "hfield mesh fitscale material fluidshape=none"},
    {"contact", "", "", "exclude", "pair"},
    {"exclude", "name body1 body2"},
};

}  // namespace

void list_unread_mjcf(const XmlOutline& outline,
                      const std::function<std::size_t(std::size_t offset)>& place_of,
                      LeftOutList& left_out) {
  list_rest(outline, kReadInMjcf, place_of, left_out);
}

}  // namespace parallax::harness
