#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/geometry/voxel_set.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** Wall time of one step by stage, milliseconds. */
struct StageTimes
{
  double fem = 0.0;      ///< element energies, forces and stiffness
  double field = 0.0;    ///< distance field refresh
  double detect = 0.0;   ///< who overlaps whom
  double respond = 0.0;  ///< contact energies, forces, Hessians
  double solve = 0.0;    ///< linear systems
  double total = 0.0;    ///< the whole step
};

/** How one step went. */
struct StepReport
{
  std::uint64_t step = 0;  ///< number of the step, from 1
  double time_s = 0.0;     ///< simulated time at its end
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0.0;  ///< relative, see SolverConfig::tolerance
  bool converged = false;
  bool out_of_time = false;  ///< ended early, for SolverConfig::budget_ms
  /** Estimate of how far nodes are from where forces balance, m; NaN where nothing tells yet. */
  double position_error_m = 0.0;
  int parts = 1;      ///< the step was taken in, so that nothing in it jumps through anything
  int halvings = 0;   ///< how often the step was halved before it went through
  bool held = false;  ///< it did not go through: the last good state was kept
  double min_det_f = 1.0;
  double max_penetration_m = 0.0;
  int contacts = 0;
  int sleeping = 0;  ///< tissues and membranes that were left out, see SolverConfig::sleep
  StageTimes ms;
};

/**
 * One contact sample between a tool, or an obstacle, and a tissue, or between the first and the
 * second tissue of a pair, world frame. Forces of all samples add up to what acts on the tool, or
 * on the first; where
 * an edge crosses the surface a sample of no depth and area carries a small part of it, and
 * friction has samples of its own without them.
 */
struct ContactPoint
{
  Vec3 position_W;     ///< m
  Vec3 normal_W;       ///< unit, out of the tissue: the direction in which the tool is pushed
  double depth = 0.0;  ///< m
  double area = 0.0;   ///< m^2 of the surface it stands for
  Vec3 force_W;        ///< N, of the tissue on the tool
  Index tissue = -1;   ///< index of the tissue; of a pair, of the one whose depth it is
  Index tet = -1;   ///< of that tissue, which the point is in; -1 where it is its surface in a tool
  Index part = -1;  ///< of the tool, that it acts on
};

/** Force and moment of all tissues on a tool, at the tool frame's origin, in world axes. */
struct Wrench
{
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N m
};

/** Everything of one tissue or membrane that does not change while it deforms. Nodes and tets are
 * in the order of the mesh's file; nodes amid the edges of quadratic tets come after its own. */
struct TissueInfo
{
  std::string name;
  /** Rest state, world frame; quadratic tets as subdivided() cuts them; a membrane has no tets. */
  TetMesh rest;
  BoundarySurface surface;

  bool isMembrane() const { return rest.tets.empty(); }

  std::vector<Index> fixed_nodes;
  std::vector<std::string> remarks;  ///< what reading the mesh turned, left out or found odd
};

struct TissueState
{
  Points positions;              ///< N, world, m
  Points velocities;             ///< N, world, m/s
  std::vector<float> von_mises;  ///< M, Pa; empty unless the scene asks for stress
  bool asleep = false;           ///< from the end of this step on
  int evaluations = 0;           ///< of its elastic energy, forces or stiffness in this step
};

/** One of the solids of a tool that move against each other. */
struct ToolPartState
{
  Pose X_WP = Pose::Identity();
  Wrench wrench_W;  ///< on this part alone, moment about the tool frame's origin
};

struct ToolState
{
  Pose X_WT = Pose::Identity();
  Wrench wrench_W;
  std::vector<ContactPoint> contacts;
  std::vector<ToolPartState> parts;
  JointValues joints;  ///< in the order of ToolInfo::joints
  int attached = 0;    ///< nodes that are tied to it
};

/** Contact of two tissues, of a membrane with a tissue, or of a tissue with itself. */
struct TissuePairState
{
  Index first = -1, second = -1;       ///< indices of the tissues; a membrane is the first
  std::vector<ContactPoint> contacts;  ///< forces are those on the first
};

/** Part of a tool: all its links that always keep their places to each other. */
struct ToolPartInfo
{
  std::string name;      ///< that of its first link; the tool's if it has no other parts
  std::size_t link = 0;  ///< of ToolConfig::linkage, whose frame is the part's
  TriMesh surface;       ///< for display, part frame
};

struct ToolInfo
{
  std::string name;
  std::vector<ToolPartInfo> parts;
  std::vector<Coordinate> joints;  ///< that move by themselves
};

/** Which nodes to tie to a tool, and how. */
struct AttachRequest
{
  std::size_t tool = 0;
  std::optional<std::size_t> part;           ///< empty: each node to the part it is nearest to
  std::optional<std::size_t> tissue;         ///< or membrane; empty: all
  double reach_m = 0.0;                      ///< of the part's surface
  std::optional<double> stiffness_pa_per_m;  ///< empty: kAutoStiffness
};

/** An obstacle's surface for display, world frame: as much of it as tissue has come near to. */
struct ObstacleInfo
{
  std::string name;
  TriMesh surface;
  double cell_size_m = 0.0;
};

/** Contact of all tissues with an obstacle. */
struct ObstacleState
{
  std::vector<ContactPoint> contacts;  ///< forces are those on the obstacle
};

/** A finished step, free of the scene that made it: what publishers and recorders read. */
struct Snapshot
{
  StepReport report;
  std::uint64_t state_hash = 0;
  std::vector<TissueState> tissues;  ///< and membranes after them
  std::vector<ToolState> tools;
  std::vector<ObstacleState> obstacles;
  std::vector<TissuePairState> tissue_pairs;  ///< as the scene file names them
};

struct MaterialChange;

/** Bodies, tools and the one potential they move in. Not thread safe: one thread owns it. */
class Scene
{
 public:
  /**
   * Builds the bodies a configuration names.
   * @throws Error for a mesh that can't be read, a fixed box that fixes nothing, a tool deep inside
   * tissue, tissue deep inside an obstacle, ...
   */
  explicit Scene(const SceneConfig& config);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const SceneConfig& config() const;
  /** Tissues, and after them membranes. */
  const std::vector<TissueInfo>& tissues() const;
  const std::vector<ToolInfo>& tools() const;
  /** Their surfaces grow in steps that take tissue to new places, and change with their cells. */
  const std::vector<ObstacleInfo>& obstacles() const;

  /** Where a tool is now. */
  const Pose& toolPose(std::size_t tool) const;

  /** Simulated time, s. */
  double time() const;

  /** Where the tool shall be at the end of the next step. Key-framed tools ignore it. */
  void setToolTarget(std::size_t tool, const Pose& X_WT);

  /**
   * What the tool's joints shall be at by the end of the next step, as far as their limits and
   * speeds allow; NaN: as before. Key-framed joints ignore it.
   * @param values  in the order of ToolInfo::joints
   * @throws Error unless there are as many
   */
  void setJointTargets(std::size_t tool, const JointValues& values);

  /**
   * Ties surface nodes to a tool by springs that are without force as nodes stand now, until
   * detach() or resetWorld(). Nodes that are fixed, or tied to that part already, are left out.
   * @return how many
   * @throws Error unless the reach is >= 0, the stiffness > 0, and the rest exists
   */
  int attach(const AttachRequest& request);

  /** Unties all nodes from a tool, or from one of its parts. @return how many */
  int detach(std::size_t tool, std::optional<std::size_t> part = std::nullopt);

  /** Moves simulated time on by one time step. Never throws for numerical reasons: see
   * StepReport::held. */
  const StepReport& step();

  /** Rest shape, zero velocity, tools at their initial poses; time goes on. */
  void resetWorld();
  /** The same, and time and the steps' number begin again at zero. Maps stay. */
  void restart();

  /**
   * Writes all that steps to come depend on to a file, in full precision: they have the same bits
   * after loadState() as without, in another process as well.
   * @throws Error if the file can't be written
   */
  void saveState(const std::string& file) const;
  /**
   * Goes on where a scene of the same configuration was when it was saved; what the times of steps
   * decide in a scene with SolverConfig::budget_ms aside.
   * @throws Error for a file that is none, is damaged, or of another scene or version; then nothing
   * has changed
   */
  void loadState(const std::string& file);

  /** Gives a tissue or membrane another material from now on. @throws Error naming what is out of
   * range; then nothing has changed */
  void setMaterial(std::size_t tissue, const MaterialChange& change);

  /**
   * Puts all nodes of a tissue or membrane where they are told to be and gives them velocities,
   * fixed and moved ones, too; of quadratic tets the nodes are those of TissueInfo::rest.
   * @param positions   N, world, m
   * @param velocities  N, world, m/s
   * @throws Error unless as many as the tissue has nodes, all finite
   */
  void setMotion(std::size_t tissue, const Points& positions, const Points& velocities);

  /**
   * Gives an obstacle other cells. Tissue they take in is pushed out slowly, and what sleeps near
   * them wakes up. What that costs depends on the cells that changed near tissue.
   * @param cells  of the size of those there are, in the obstacle's frame
   * @return those there were: letting go of a large map takes time
   * @throws Error for cells of another size
   */
  VoxelSet setObstacleCells(std::size_t obstacle, VoxelSet cells);
  /** The same, and puts it elsewhere. @throws Error for a pose that is not a rotation and a finite
   * translation, too */
  VoxelSet setObstacle(std::size_t obstacle, VoxelSet cells, const Pose& X_WO);

  /** Hash of every bit of the dynamic state: positions, velocities, accelerations, what the stepper
   * carries on and viscous tissue remembers, who sleeps, what contacts carry on (friction's slips,
   * depths that are allowed for now, stiffening), tool poses, joints and what is tied to them,
   * cells of obstacles, step count. */
  std::uint64_t stateHash() const;

  /** Copies the state out, reusing the memory `snapshot` already has. */
  void fillSnapshot(Snapshot& snapshot) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace soft_tissue
