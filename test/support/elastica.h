#pragma once

#include <array>
#include <cmath>

namespace soft_tissue::test
{
/** Loads and compliances of a cantilever along x in units of its length L and EI / L^2. */
struct BeamLoad
{
  double tip = 0.0;      ///< alpha = P L^2 / EI, downwards whatever the beam does
  double weight = 0.0;   ///< beta = q L^3 / EI, per rest length, downwards
  double stretch = 0.0;  ///< EI / (EA L^2); 0: inextensible
  double shear = 0.0;    ///< EI / (k GA L^2); 0: sections stay normal to the axis
};

/** Where the end of a cantilever goes, in units of its length. */
struct BeamTip
{
  double along = 0.0;  ///< u, towards the clamp
  double down = 0.0;   ///< w
  double angle = 0.0;  ///< rad
};

/**
 * The plane rod of Reissner by shooting: classical Runge-Kutta from the clamp, the clamp's moment
 * bisected until the free end has none. Without stretch and shear it is the elastica.
 */
class Rod
{
 public:
  explicit Rod(const BeamLoad& load) : load_(load) {}

  BeamTip tip() const
  {
    double low = 0.0;
    double high = load_.tip * (1.0 + load_.tip * load_.stretch) + load_.weight;
    for (int k = 0; k < 60; ++k)
    {
      const double middle = 0.5 * (low + high);
      (end(middle)[kMoment] < 0.0 ? low : high) = middle;
    }
    const State last = end(0.5 * (low + high));
    return {1.0 - last[kX], last[kDown], last[kAngle]};
  }

 private:
  enum
  {
    kAngle,
    kMoment,
    kX,
    kDown,
  };
  using State = std::array<double, 4>;

  State rate(double s, const State& y) const
  {
    const double force = load_.tip + load_.weight * (1.0 - s);
    const double sine = std::sin(y[kAngle]), cosine = std::cos(y[kAngle]);
    const double length = 1.0 + load_.stretch * force * sine;
    const double slip = load_.shear * force * cosine;
    const double x = length * cosine - slip * sine;
    return {y[kMoment], -force * x, x, length * sine + slip * cosine};
  }

  State end(double clamp_moment) const
  {
    constexpr int kSteps = 400;
    constexpr double kStep = 1.0 / kSteps;
    const auto moved = [](const State& y, const State& rate, double by) {
      State sum;
      for (std::size_t k = 0; k < y.size(); ++k)
      {
        sum[k] = y[k] + by * rate[k];
      }
      return sum;
    };
    State y = {0.0, clamp_moment, 0.0, 0.0};
    for (int k = 0; k < kSteps; ++k)
    {
      const double s = k * kStep;
      const State a = rate(s, y);
      const State b = rate(s + 0.5 * kStep, moved(y, a, 0.5 * kStep));
      const State c = rate(s + 0.5 * kStep, moved(y, b, 0.5 * kStep));
      const State d = rate(s + kStep, moved(y, c, kStep));
      for (std::size_t i = 0; i < y.size(); ++i)
      {
        y[i] += kStep / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
      }
    }
    return y;
  }

  BeamLoad load_;
};

}  // namespace soft_tissue::test
