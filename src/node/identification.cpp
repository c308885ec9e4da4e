#include "soft_tissue_sim/node/identification.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/replay.h"
#include "soft_tissue_sim/node/scene_loader.h"
#include "soft_tissue_sim/node/wrench_comparison.h"
#include "soft_tissue_sim/scene/scene_parameter.h"
#include "soft_tissue_sim/solver/least_squares.h"

namespace soft_tissue_sim
{
namespace
{
using Eigen::VectorXd;
using soft_tissue::Error;
using soft_tissue::LeastSquaresFit;
using soft_tissue::SceneParameter;

/** A logarithm may come to this far from where it starts: nobody starts 1000 times off. */
constexpr double kFarthest = 7.0;
constexpr int kForceComponents = 3;

/** Numbers of a scene as the fit sees them: the logarithms of those that vary in proportion. */
class FittedNumbers
{
 public:
  FittedNumbers(const soft_tissue::SceneConfig& scene, const std::vector<std::string>& names)
  {
    for (const std::string& name : names)
    {
      parameters_.emplace_back(scene, name);
    }
  }

  const std::vector<SceneParameter>& parameters() const { return parameters_; }

  VectorXd of(const soft_tissue::SceneConfig& scene) const
  {
    VectorXd fitted(parameters_.size());
    for (std::size_t k = 0; k < parameters_.size(); ++k)
    {
      const double value = parameters_[k].value(scene);
      fitted[k] = parameters_[k].isLogarithmic() ? std::log(value) : value;
    }
    return fitted;
  }

  double number(std::size_t k, double fitted) const
  {
    return parameters_[k].isLogarithmic() ? std::exp(fitted) : fitted;
  }

  void set(soft_tissue::SceneConfig& scene, const VectorXd& fitted) const
  {
    for (std::size_t k = 0; k < parameters_.size(); ++k)
    {
      parameters_[k].set(scene, number(k, fitted[k]));
    }
  }

  soft_tissue::LeastSquaresOptions options(const VectorXd& start) const
  {
    soft_tissue::LeastSquaresOptions options;
    options.lower = start.array() - kFarthest;
    options.upper = start.array() + kFarthest;
    for (std::size_t k = 0; k < parameters_.size(); ++k)
    {
      if (!parameters_[k].isLogarithmic())
      {
        options.lower[k] = parameters_[k].lower();
        options.upper[k] = parameters_[k].upper();
      }
    }
    return options;
  }

 private:
  std::vector<SceneParameter> parameters_;
};

/** Simulated minus measured forces of all tools, tool after tool, N. */
VectorXd forceErrors(const WrenchComparison& comparison, std::size_t tools)
{
  std::vector<double> errors;
  for (std::size_t tool = 0; tool < tools; ++tool)
  {
    for (const WrenchPair& pair : comparison.pairs(tool))
    {
      const soft_tissue::Vec3 error = pair.simulated_W.force - pair.measured_W.force;
      errors.insert(errors.end(), error.data(), error.data() + kForceComponents);
    }
  }
  return Eigen::Map<const VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

double rootMeanSquare(const VectorXd& components)
{
  return std::sqrt(kForceComponents * components.squaredNorm() /
                   static_cast<double>(components.size()));
}

/** What a fit found, for people and programs. */
struct Finding
{
  const FittedNumbers& numbers;
  const VectorXd& start;
  const LeastSquaresFit& fit;
  double error_before_n, error_after_n;

  std::string text() const
  {
    std::ostringstream text;
    for (std::size_t k = 0; k < numbers.parameters().size(); ++k)
    {
      const double at = fit.parameters[k], half = fit.half_width[k];
      text << numbers.parameters()[k].name() << ": " << numbers.number(k, at) << ", 95 % between "
           << numbers.number(k, at - half) << " and " << numbers.number(k, at + half) << " (from "
           << numbers.number(k, start[k]) << ")\n";
    }
    text << "force error " << error_after_n << " N rms, before " << error_before_n << " N; "
         << fit.evaluations << " replays" << (fit.converged ? "" : ", NOT CONVERGED") << "\n";
    return text.str();
  }

  std::string json() const
  {
    JsonWriter json;
    json.beginObject().value("converged", fit.converged);
    json.value("iterations", static_cast<std::uint64_t>(fit.iterations));
    json.value("replays", static_cast<std::uint64_t>(fit.evaluations));
    json.value("error_rms_n", error_after_n).value("error_rms_before_n", error_before_n);
    json.beginArray("parameters");
    for (std::size_t k = 0; k < numbers.parameters().size(); ++k)
    {
      const double at = fit.parameters[k], half = fit.half_width[k];
      json.beginObject().value("name", numbers.parameters()[k].name());
      json.value("value", numbers.number(k, at)).value("start", numbers.number(k, start[k]));
      json.value("low", numbers.number(k, at - half)).value("high", numbers.number(k, at + half));
      json.endObject();
    }
    json.endArray().endObject();
    return json.text();
  }
};

/** @throws Error if it can't be written */
void writeFile(const std::string& path, const std::string& text)
{
  std::ofstream stream(path);
  stream << text;
  stream.close();
  if (!stream)
  {
    throw Error("json " + path + ": can't be written");
  }
}

}  // namespace

void identifyParameters(const RunOptions& options)
{
  Replay replay = readReplay(options);
  const FittedNumbers numbers(replay.config, options.identify);
  const WrenchComparison measured = readComparison(options, replay);
  if (!options.json.empty())
  {
    writeFile(options.json, "");  // a wrong name must not cost a night
  }
  double error_before_n = -1.0;
  const soft_tissue::Residuals residuals = [&](const VectorXd& fitted) {
    numbers.set(replay.config, fitted);
    soft_tissue::Scene scene = buildScene(replay.config);
    WrenchComparison comparison = measured;
    runReplay(scene, replay, [&](const soft_tissue::Snapshot& snapshot) {
      comparison.add(snapshot);
      return true;
    });
    const VectorXd errors = forceErrors(comparison, replay.config.tools.size());
    const double error_n = rootMeanSquare(errors);
    error_before_n = error_before_n < 0.0 ? error_n : error_before_n;
    if (!options.quiet)
    {
      for (std::size_t k = 0; k < numbers.parameters().size(); ++k)
      {
        std::fprintf(stderr, "%s %g, ", numbers.parameters()[k].name().c_str(),
                     numbers.number(k, fitted[k]));
      }
      std::fprintf(stderr, "error %g N rms\n", error_n);
    }
    return errors;
  };
  const VectorXd start = numbers.of(replay.config);
  const LeastSquaresFit fit =
      soft_tissue::fitLeastSquares(residuals, start, kForceComponents, numbers.options(start));
  const Finding finding{numbers, start, fit, error_before_n,
                        fit.root_mean_square * std::sqrt(1.0 * kForceComponents)};
  if (!options.json.empty())
  {
    writeFile(options.json, finding.json());
  }
  if (!options.quiet)
  {
    std::printf("%s", finding.text().c_str());
  }
}

}  // namespace soft_tissue_sim
