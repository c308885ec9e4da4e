#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/contact/obstacle_contact.h"
#include "soft_tissue_sim/contact/tissue_contact.h"
#include "soft_tissue_sim/contact/tool_contact.h"
#include "soft_tissue_sim/energy/anchor_springs.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/scene/scene.h"
#include "soft_tissue_sim/scene/step_budget.h"
#include "soft_tissue_sim/solver/newton.h"
#include "tissue_elasticity.h"

namespace soft_tissue
{
struct SoftBodyModel;

/** A minimisation that stops with more of the forces unbalanced has failed: the step is halved. */
constexpr double kFailedResidual = 0.05;

/** The scene itself. Building is in scene_build.cpp, its contacts in
 * scene_pairs.cpp and scene_obstacles.cpp, what they do in scene_contacts.cpp, moving in
 * scene_step.cpp and scene_inertia.cpp, resting in scene_sleep.cpp, tools in scene_tools.cpp, what
 * is tied to them in scene_attachments.cpp, reading out in scene.cpp, saving and loading in
 * scene_state.cpp, materials anew in scene_material.cpp. */
class Scene::Impl
{
 public:
  explicit Impl(const SceneConfig& config);

  const StepReport& step();
  void resetWorld();
  void restart();
  void setMotion(std::size_t tissue, const Points& positions, const Points& velocities);
  void setJointTargets(std::size_t tool, const JointValues& values);
  int attach(const AttachRequest& request);
  int detach(std::size_t tool, std::optional<std::size_t> part);
  void refuseDeepStart();
  VoxelSet setObstacle(std::size_t obstacle, VoxelSet cells, const Pose& X_WO);
  void setMaterial(std::size_t tissue, const MaterialChange& change);
  std::uint64_t identity() const;
  std::string stateBytes();
  void exchange(StateArchive& archive);
  std::uint64_t stateHash() const;
  void fillSnapshot(Snapshot& snapshot);

  /** How often a step may be halved before it is given up. */
  static constexpr int kMaxHalvings = 4;

  SceneConfig config_;
  std::vector<TissueInfo> tissue_info_;            ///< nodes numbered as in x_
  std::vector<TissueInfo> tissues_in_file_order_;  ///< the same for those who ask
  std::vector<ToolInfo> tool_info_;
  std::vector<ObstacleInfo> obstacle_info_;
  StepReport report_;

  /** Solids of a tool that keep their places to each other. */
  struct ToolPart
  {
    RigidBodyShape shape;
    std::size_t link = 0;               ///< whose frame is the part's
    Pose X_WP = Pose::Identity();       ///< now
    Pose X_WP_goal = Pose::Identity();  ///< at the end of the step
    int attached = 0;                   ///< nodes that are tied to it
  };
  struct Tool
  {
    std::vector<ToolPart> parts;
    PoseSeries track;                     ///< key frames; empty: moved from outside
    JointSeries joint_track;              ///< the same of its joints
    Pose X_WT = Pose::Identity();         ///< now
    Pose X_WT_goal = Pose::Identity();    ///< at the end of the step
    Pose X_WT_target = Pose::Identity();  ///< where it shall go, if its speed allows
    JointValues joints, joints_goal, joints_target;
    ToolState state;
  };
  std::vector<Tool, Eigen::aligned_allocator<Tool>> tools_;

  struct Obstacle
  {
    std::shared_ptr<VoxelShape> shape;
    Pose X_WO = Pose::Identity();
    Box3 shown;            ///< what of it ObstacleInfo has, its own frame
    bool changes = false;  ///< its cells come from outside
    ObstacleState state;
  };
  std::vector<Obstacle, Eigen::aligned_allocator<Obstacle>> obstacles_;

 private:
  /** What a tissue or membrane adds to the scene, and where its nodes stand among all. */
  struct Tissue
  {
    Index first_node = 0;
    Index node_count = 0;
    std::vector<Index> file_node;            ///< see SoftBodyModel
    Adjacency neighbours;                    ///< nodes that elasticity couples
    std::unique_ptr<TissueElasticity> tets;  ///< of a tissue
    std::unique_ptr<EnergyTerm> membrane;    ///< elasticity of a membrane
    double short_edge = 0.0;                 ///< see TissueBody
    double inner_radius = 0.0;               ///< see innerRadius(); 0: not known yet
    double min_det_f = 1.0;                  ///< after the last step that moved it
    int evaluations = 0;                     ///< see TissueState
    Box3 reach;                              ///< see findReaches()
  };
  /** Nodes that key frames move. */
  struct MovedNodes
  {
    std::size_t tissue = 0;
    std::vector<Index> rows;
    PoseSeries track;
    Pose X_FW = Pose::Identity();  ///< the world in the first key frame's frame
  };
  /** A node that is tied to a part of a tool. */
  struct Attachment
  {
    std::size_t tool = 0, part = 0;
    std::size_t tissue = 0;
    Index row = 0;
    Vec3 place_P = Vec3::Zero();  ///< where it is drawn to, part frame, m
    double stiffness = 0.0;       ///< N/m
  };
  struct Contact
  {
    std::size_t tissue = 0;  ///< or membrane
    std::size_t other = 0;   ///< index of the tool, the obstacle, or the other tissue
    std::size_t part = 0;    ///< of the tool
    std::size_t named = 0;   ///< index of its ContactConfig
    std::unique_ptr<SurfacePoints> points;  ///< of a membrane too coarse for the other
    std::unique_ptr<ContactTerm> term;
    ToolContact* with_tool = nullptr;  ///< the term, as what it is
    TissueContact* with_tissue = nullptr;
    ObstacleContact* with_obstacle = nullptr;
    std::size_t pair = 0;  ///< of two tissues: index of their TissuePairState
    double size_m = 0.0;   ///< radius of a ball that fits in the tool or a cell, or in both tissues
    bool refresh = true;
    std::optional<double> max_penetration_m;
    double start_depth_m = 0.0;  ///< two tissues start in each other by, if that is deep
    double allowance_m = 0.0;    ///< depth that presses nothing yet; of an obstacle the largest
    Points force, last_force;  ///< minus those on nodes of both, at the end of this part of a step
                               ///< and of the last; for bdf2 alone
  };
  /** How a group of tissues moves as a whole. */
  struct Motion
  {
    double mass = 0.0;
    Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();
    Vec3 spin = Vec3::Zero();  ///< angular momentum about the centre
  };
  struct SavedState
  {
    Points x, v, acceleration;
  };

  Tissue& addSoftBody(std::size_t index, const SoftBodyModel& model);
  void addTissue(std::size_t index);
  void addMembrane(std::size_t index);
  void addTool(std::size_t index);
  void addObstacle(std::size_t index);
  void addContact(std::size_t index);
  void makeDrag();
  void makeSolver();
  void addToolContacts(const ContactConfig& config, const Contact& named);
  void addTissueContact(const ContactConfig& config, Contact& contact);
  void addObstacleContact(const ContactConfig& config, Contact& contact);
  void checkObstacle(std::size_t index, const VoxelSet& cells, const Pose& X_WO) const;
  void showObstacles();
  void refuseDeepStart(const Contact& contact);
  void findDeepStarts();
  void allow(double depth_m, Contact& contact);
  void easeDeepStarts();
  std::string itemOf(std::size_t tissue) const;
  double stiffnessAgainstRigid(std::size_t tissue, double radius_m) const;
  bool isFine(std::size_t tissue, double radius_m) const;
  double innerRadiusOf(std::size_t tissue);
  TissueBody bodyOf(std::size_t tissue) const;
  TissueBody surfaceFor(double size_m, const ContactConfig& config, Contact& contact) const;
  FieldConfig fieldConfigOf(std::size_t tissue) const;
  std::unique_ptr<DistanceField> fieldOf(std::size_t tissue) const;
  /** Calls visit(tets) for each tissue's. */
  template <typename Visit>
  void forTets(const Visit& visit)
  {
    for (Tissue& tissue : tissues_)
    {
      if (tissue.tets != nullptr)
      {
        visit(*tissue.tets);
      }
    }
  }
  void aimTools();
  void placeTool(std::size_t index);
  Pose targetOf(std::size_t index, const JointValues& joints) const;
  void aim(std::size_t index, double end_s);
  static void arrive(Tool& tool);
  JointValues initialJoints(std::size_t index) const;
  Pose partAt(std::size_t tool, const ToolPart& part, double s) const;
  const ToolPart& partOf(const Contact& contact) const
  {
    return tools_[contact.other].parts[contact.part];
  }
  bool isMoving(const ToolPart& part) const
  {
    return part.X_WP.matrix() != part.X_WP_goal.matrix();
  }
  double motionOfAttached() const;
  void attachTissue(std::size_t tissue, const AttachRequest& request);
  void noteAttachments();
  void beginAttachments(double to);
  void collectAttachments();
  void countAttachments();
  void wakeThose(const std::vector<char>& chosen);
  int partsOfStep() const;
  double mostMotion(const Contact& contact) const;
  double motionOfTissue(std::size_t tissue, const Vec3& drift, Box3& reach) const;
  double motionOfTool(const Contact& contact) const;
  double motionOfTissues(const Contact& contact) const;
  double motionInObstacle(const Contact& contact) const;
  std::vector<ContactPoint>& pointsOf(const Contact& contact);
  void beginContacts(double from, double to);
  bool advance(double from, double to, int depth);
  bool minimise(double from, double to);
  NewtonReport findBalance();
  NewtonReport descend(Points* other);
  bool isDynamic() const { return config_.solver.stepper != Stepper::quasi_static; }
  void chooseFormulas(double h);
  StepStart startOfPart() const;
  void beginInertia();
  void dropThePast(double h);
  bool findBlows();
  void takeForce(Contact& contact);
  void forgetPast();
  std::size_t sleepers() const;
  bool sleeps(const Contact& contact) const;
  void findReaches();
  bool areNear(const Contact& contact) const;
  bool isDriven(std::size_t tissue) const;
  bool isQuiet(std::size_t tissue) const;
  void wakeUp();
  void wake(std::size_t island);
  void fallAsleep();
  void setSleepers();
  bool stiffenWhereTooDeep();
  std::optional<double> wholeBudget() const;
  double timeLeft() const;
  void reportEnd();
  void standStillIfBetter(double h);
  void extrapolate(double end_s);
  void placeMovedNodes(double time_s, Points& x) const;
  template <typename Visit>
  void forEachNodeOf(std::size_t group, const Visit& visit) const;
  Vec3 centreOf(std::size_t group, const Points& x) const;
  Motion motionOf(std::size_t group, const Points& x) const;
  Mat3 inertiaOf(std::size_t group, const Vec3& centre) const;
  void findGroups();
  void takeVelocities(double h);
  Vec3 endOf(std::size_t group, const Motion& start, double h) const;
  void keepMotion(std::size_t group, double h);
  void setOff();
  void stop();
  void forgetWay();
  void finishStep();
  void collectContacts();
  void takeMaterial(std::size_t tissue);
  double stiffnessOf(const ContactConfig& config, const Contact& contact) const;
  void exchangeMaterials(StateArchive& archive);
  void exchangeStepper(StateArchive& archive);
  void exchangeTissues(StateArchive& archive);
  void exchangeTools(StateArchive& archive);
  void exchangeAttachments(StateArchive& archive);
  void exchangeObstacles(StateArchive& archive);
  void exchangeContacts(StateArchive& archive);
  void exchangeReport(StateArchive& archive);
  std::vector<EnergyTerm*> allTerms();

  std::vector<Tissue> tissues_;
  std::vector<MovedNodes, Eigen::aligned_allocator<MovedNodes>> moved_;
  std::vector<Contact> contacts_;
  std::vector<TissuePairState> pairs_;
  std::vector<Attachment> attachments_;  ///< by ascending tools, parts and rows
  AnchorSprings anchors_;                ///< the same in this part of a step, but those that sleep
  Points x_, x_rest_, v_;
  Points acceleration_;  ///< of the last step, to start the next one from; moves nothing by itself
  std::vector<std::size_t> group_;   ///< per tissue: the first of those it touches, itself included
  std::vector<char> held_;           ///< per tissue: something outside holds it or its group
  std::vector<Motion> goal_;         ///< per free group: how it moves at the end of the step
  std::vector<char> asleep_;         ///< per tissue: it is left out
  std::vector<double> quiet_s_;      ///< per tissue that is awake: for how long it hardly moved
  std::vector<std::size_t> island_;  ///< per tissue that sleeps: the first of those it sleeps with
  std::vector<std::size_t> islands_found_;
  std::vector<double> masses_;
  std::vector<double> load_masses_;  ///< what gravity pulls at
  std::vector<double> drags_;        ///< kg/s; empty: none
  std::unique_ptr<Inertia> inertia_;
  std::unique_ptr<Drag> drag_;  ///< null: none
  std::unique_ptr<Gravity> gravity_;
  std::unique_ptr<NewtonSolver> newton_;
  NewtonOptions newton_options_;
  Timer step_timer_;
  StepBudget budget_;
  NewtonReport end_;                  ///< how the last minimisation ended
  double finish_s_ = 0.0;             ///< what reading out the last step took
  double last_h_ = 0.0;               ///< length of the last part of a step, s
  Points x_last_, v_last_;            ///< where that began
  std::vector<char> smooth_;          ///< per tissue: steps may carry on what was before
  std::vector<StepFormula> formula_;  ///< per tissue, of the running part of a step
  Points contact_force_;              ///< zero outside takeForce()
  std::vector<EnergyTerm*> terms_;
  std::vector<double> term_seconds_;
  Points extrapolated_;
  Points before_step_;             ///< positions at the start of the running step
  Points before_;                  ///< positions at the start of the running minimisation
  std::vector<SavedState> saved_;  ///< one per level of halving
  bool was_held_ = false;          ///< the last step
};

}  // namespace soft_tissue
