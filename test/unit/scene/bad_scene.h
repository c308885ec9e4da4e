#pragma once

#include <ostream>

#include "scene_folder.h"

namespace soft_tissue
{
inline constexpr const char* kGood = R"(time_step_s: 0.005
gravity_m_per_s2: [0, 0, -9.81]
solver: {tolerance: 1.0e-3, max_iterations: 20, linear: auto}
tissues:
  - name: liver
    mesh: {file: mesh.msh, length_unit: m}
    material: {young_modulus_pa: 3000, poisson_ratio: 0.45, density_kg_per_m3: 1060}
    regions: [{tag: 2, young_modulus_pa: 3.0e4}]
    fixed: [{box_m: [[-0.2, -0.2, -0.01], [0.2, 0.2, 0.002]]}]
    field: {method: cffm}
  - name: kidney
    mesh: {file: mesh.msh, length_unit: m}
    material: {young_modulus_pa: 9000, poisson_ratio: 0.4, density_kg_per_m3: 1050}
tools:
  - name: probe
    shape: {capsule: {radius_m: 0.004, length_m: 0.02}}
    pose_source:
      keyframes: [{time_s: 0, position_m: [0, 0, 0.1]}, {time_s: 1, position_m: [0, 0, 0]}]
  - name: hook
    shape: {mesh: {file: mesh.msh, length_unit: m, scale: [1, 1, 1]}}
    pose_source: {topic: servo_cp}
contacts:
  - {between: [liver, probe], response: segment, stiffness_pa_per_m: 1.0e7, friction: 0.1}
outputs: {stress: false}
)";

/** One change to the good scene and what it must be answered with, after the file's name. */
struct BadScene
{
  const char* from;
  const char* to;
  const char* complaint;
};

/** What a test that fails calls it. */
inline void PrintTo(const BadScene& scene, std::ostream* out)
{
  *out << scene.from << " -> " << scene.to;
}

}  // namespace soft_tissue
