#pragma once

#include <array>
#include <string>
#include <vector>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
/** Adds a tissue to a scene, of the first one's material. */
inline TissueConfig& addTissue(SceneConfig& config, const std::string& name,
                               const std::string& mesh_file, const Vec3& position)
{
  TissueConfig tissue = config.tissues.empty() ? TissueConfig() : config.tissues[0];
  tissue.name = name;
  tissue.mesh.file = mesh_file;
  tissue.pose.position_m = position;
  tissue.fixed.clear();
  config.tissues.push_back(tissue);
  return config.tissues.back();
}

/** Lets two tissues, or a tissue and a tool, touch. */
inline ContactConfig& addPair(SceneConfig& config, const std::string& one, const std::string& other,
                              Response response)
{
  ContactConfig contact;
  contact.tissue = one;
  contact.other = other;
  contact.response = response;
  config.contacts.push_back(contact);
  return config.contacts.back();
}

/** A mesh in a file of its own. */
inline std::string saved(const ScratchFolder& folder, const std::string& name, const TetMesh& mesh)
{
  const std::string file = folder.path(name);
  saveGmsh(file, mesh);
  return file;
}

/** Sum of all forces on the first tissue of a pair, N. */
inline Vec3 forceOnFirst(const TissuePairState& pair)
{
  Vec3 force = Vec3::Zero();
  for (const ContactPoint& point : pair.contacts)
  {
    force += point.force_W;
  }
  return force;
}

/** Mean of a tissue's nodes, m. */
inline Vec3 centreOf(const TissueState& tissue)
{
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : tissue.positions)
  {
    sum += p;
  }
  return sum / static_cast<double>(tissue.positions.size());
}

/** Root mean square speed of all nodes, m/s. */
inline double rmsSpeed(const Snapshot& snapshot)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (const TissueState& tissue : snapshot.tissues)
  {
    for (const Vec3& v : tissue.velocities)
    {
      sum += v.squaredNorm();
    }
    count += tissue.velocities.size();
  }
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace soft_tissue::test
