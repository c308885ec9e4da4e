#include "schema_sections.h"

namespace soft_tissue
{
/** In config_check.cpp: names that clash, contacts that name nothing. */
void checkScene(const Item& item, SceneConfig& scene);

namespace
{
const Section<SleepConfig>& sleepSection()
{
  static const Section<SleepConfig> section =
      Section<SleepConfig>(
          "sleep",
          "When tissues and membranes count as being at rest. Those that touch, or "
          "nearly do, sleep together. They wake as soon as something awake comes "
          "near, a tool near them moves, or key frames move their nodes.")
          .optional("speed_m_per_s", &SleepConfig::speed_m_per_s,
                    number(0.0, 1.0, Ends::open_below), "No node is faster.")
          .optional("acceleration_m_per_s2", &SleepConfig::acceleration_m_per_s2,
                    number(0.0, 1.0, Ends::open_below),
                    "No node's velocity changes more quickly; far less than gravity, or bodies "
                    "sleep at the top of their flight.")
          .optional("after_s", &SleepConfig::after_s, number(0.0, 1000.0, Ends::closed),
                    "For how long.");
  return section;
}

void checkSolver(const Item& item, SolverConfig& solver)
{
  if (solver.sleep && solver.stepper == Stepper::quasi_static)
  {
    item.rejectKey("sleep", "must not stand with stepper quasi_static, which has no speeds");
  }
}

const Section<SolverConfig>& solverSection()
{
  static const Section<SolverConfig> section =
      Section<SolverConfig>("solver", "How a step is solved.")
          .optional(
              "stepper", &SolverConfig::stepper,
              choice<Stepper>({{"implicit_euler", Stepper::implicit_euler},
                               {"bdf2", Stepper::bdf2},
                               {"quasi_static", Stepper::quasi_static}}),
              "implicit_euler: with inertia, of first order; bdf2: of second order, and hardly "
              "damps what steps resolve; quasi_static: equilibrium at each step.")
          .optional("tolerance", &SolverConfig::tolerance, number(0.0, 0.1, Ends::open_below),
                    "Residual at which Newton's method stops, over the sum of the norms of the "
                    "acting forces.")
          .optional("max_iterations", &SolverConfig::max_iterations, integer(1, 1000),
                    "Newton iterations a step may take.")
          .optional("linear", &SolverConfig::linear,
                    choice<LinearSolverKind>({{"auto", LinearSolverKind::automatic},
                                              {"pcg", LinearSolverKind::pcg},
                                              {"cholesky", LinearSolverKind::cholesky}},
                                             {"multigrid"}),
                    "Solver of the linear systems. pcg: conjugate gradients; cholesky: factors; "
                    "auto: the former, until the latter prove to be less work.")
          .optional("budget_ms", &SolverConfig::budget_ms,
                    maybe(number(0.0, 1e6, Ends::open_below), "none", true),
                    "Wall time a step may take in sim_node: it then ends with the forces balanced "
                    "as far as time allowed, and says so in stats. run_scene ignores it: a replay "
                    "must not depend on the machine's load. none: a step takes the time it needs.")
          .optional("sleep", &SolverConfig::sleep, maybe(mapOf(sleepSection()), "never", true),
                    "When what is at rest is left out of steps, which then cost nothing.")
          .finally(checkSolver);
  return section;
}

void setPair(ContactConfig& contact, const std::pair<std::string, std::string>& names)
{
  contact.tissue = names.first;
  contact.other = names.second;
}

void checkLaw(const Item& item, ContactConfig& contact)
{
  const bool is_pressure = contact.law == ContactLaw::pressure;
  if (is_pressure && contact.penalty)
  {
    item.at("penalty").rejectValue(
        "is for laws fisher2001 and marchal2004, which aren't asked for");
  }
  if (!is_pressure && !contact.penalty)
  {
    item.rejectKey("penalty", "missing, must be given with law " + item.at("law").scalar());
  }
  if (!is_pressure && contact.stiffness_pa_per_m)
  {
    item.at("stiffness_pa_per_m").rejectValue("is for law pressure; this one has a penalty");
  }
  if (contact.law == ContactLaw::fisher2001 && contact.response != Response::point)
  {
    item.at("law").rejectValue("knows nodes alone, must stand with response: point");
  }
}

const Section<OctomapOutputConfig>& octomapOutputSection()
{
  static const Section<OctomapOutputConfig> section =
      Section<OctomapOutputConfig>("octomap output",
                                   "The tissues as OctoMap cells: occupied where anything of a "
                                   "tissue or membrane is, free where it was and left.")
          .required("resolution_m", &OctomapOutputConfig::resolution_m,
                    number(1e-4, 1.0, Ends::closed), "Edge length of the cells.")
          .optional("rate_hz", &OctomapOutputConfig::rate_hz, number(0.0, 1e3, Ends::closed),
                    "Most maps a second; 0: one for every step that is published.");
  return section;
}

const Section<OutputsConfig>& outputsSection()
{
  static const Section<OutputsConfig> section =
      Section<OutputsConfig>("outputs", "What is computed only to be looked at.")
          .optional("stress", &OutputsConfig::stress, boolean(), "Von Mises stress of each tet.")
          .optional("octomap", &OutputsConfig::octomap,
                    maybe(mapOf(octomapOutputSection()), "none", true),
                    "The tissues as occupancy, on octomap_full and octomap_binary.");
  return section;
}

}  // namespace

const Section<ContactConfig>& contactSection()
{
  static const Section<ContactConfig> section =
      Section<ContactConfig>("contact", "A pair that may touch; pairs not named pass through.")
          .required("between", setPair, namePair(),
                    "Who touches whom; each pair once. A tissue named twice touches itself. Two "
                    "membranes, tools or obstacles pass through each other.")
          .optional("response", &ContactConfig::response,
                    choice<Response>({{"point", Response::point},
                                      {"segment", Response::segment},
                                      {"auto", Response::automatic}}),
                    "Where contact pressure is integrated: at surface nodes, or along surface "
                    "edges; auto: at nodes where both surfaces' edges are mostly shorter than " +
                        shortest(kFineEdge) + " R, R as in stiffness_pa_per_m.")
          .optional("law", &ContactConfig::law,
                    choice<ContactLaw>({{"pressure", ContactLaw::pressure},
                                        {"fisher2001", ContactLaw::fisher2001},
                                        {"marchal2004", ContactLaw::marchal2004}}),
                    "What a depth d costs. pressure: stiffness times d is a pressure, whatever the "
                    "mesh. The others are for comparison, and depend on the mesh. fisher2001: each "
                    "node costs k d^2; marchal2004: each node feels k d, or each edge k d "
                    "integrated along it.")
          .optional("penalty", &ContactConfig::penalty,
                    maybe(number(0.0, 1e15, Ends::open_below), "none", false),
                    "The k of law fisher2001 or marchal2004, which need it: N/m, along edges "
                    "N/m^2.")
          .optional("stiffness_pa_per_m", &ContactConfig::stiffness_pa_per_m,
                    maybe(number(kContactStiffness), "auto", true),
                    "Contact pressure per depth; auto: " + shortest(kAutoStiffness) +
                        " E / R, E being the tissue's Young's modulus and R the radius of the "
                        "largest ball inside the tool, half a cell of an obstacle; of two tissues, "
                        "E of the softer one and the smaller R, of a tissue and a membrane the "
                        "tissue's; of a membrane E t / R^2 in place of E / R, t being its "
                        "thickness.")
          .optional(
              "friction", &ContactConfig::friction, number(0.0, 2.0, Ends::closed),
              "Coulomb coefficient; what it holds gives way by less than 0.1 mm/s times the step.")
          .optional("damping_s_per_m", &ContactConfig::damping_s_per_m,
                    number(0.0, 1e6, Ends::closed),
                    "Pressure that bodies coming nearer feel beyond that of the depth, as a share "
                    "of it per m/s; bodies that part feel none.")
          .optional("max_penetration_m", &ContactConfig::max_penetration_m,
                    maybe(number(0.0, 1.0, Ends::open), "none", true),
                    "Depth that contact keeps to by getting stiffer where it is deeper.")
          .finally(checkLaw);
  return section;
}

const Section<SceneConfig>& sceneSection()
{
  static const Section<SceneConfig> section =
      Section<SceneConfig>("scene file", "What a scene does not name does not exist.")
          .optional("time_step_s", &SceneConfig::time_step_s, number(0.0, 1.0, Ends::open_below),
                    "Simulated time of one step.")
          .optional("gravity_m_per_s2", &SceneConfig::gravity_m_per_s2, vectorOfNorm(1000.0),
                    "Gravity in the world frame.")
          .optional("materials", &SceneConfig::materials, file(),
                    "Materials file the presets are looked up in.")
          .optional("solver", &SceneConfig::solver, mapOf(solverSection()), "How a step is solved.")
          .optional("tissues", &SceneConfig::tissues, listOf(mapOf(tissueSection())),
                    "Soft bodies; a scene has at least one, or a membrane.")
          .optional("membranes", &SceneConfig::membranes, listOf(mapOf(membraneSection())),
                    "Thin soft bodies, that touch tissues, tools and obstacles from both sides.")
          .optional("tools", &SceneConfig::tools, listOf(mapOf(toolSection())), "Rigid tools.")
          .optional("obstacles", &SceneConfig::obstacles, listOf(mapOf(obstacleSection())),
                    "What stands still in the world.")
          .optional("contacts", &SceneConfig::contacts, listOf(mapOf(contactSection())),
                    "Pairs that may touch.")
          .optional("outputs", &SceneConfig::outputs, mapOf(outputsSection()),
                    "What is computed only to be looked at.")
          .finally(checkScene);
  return section;
}

}  // namespace soft_tissue
