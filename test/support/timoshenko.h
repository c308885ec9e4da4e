#pragma once

#include <array>
#include <cmath>

namespace soft_tissue::test
{
/**
 * The first bending vibration of a cantilever whose sections shear and turn, by shooting: classical
 * Runge-Kutta from the clamp, the frequency bisected until moment and shear force at the free end
 * can vanish together. Units of length L, time sqrt(rho A L^4 / EI).
 */
class TimoshenkoCantilever
{
 public:
  /** @param rotary  I / (A L^2); 0: sections without inertia of their own
   * @param shear  EI / (k GA L^2); 0: sections stay normal to the axis */
  TimoshenkoCantilever(double rotary, double shear) : rotary_(rotary), shear_(shear) {}

  /** Radians per unit of time; without rotary inertia and shear 3.51602. */
  double firstFrequency() const
  {
    double low = 1.0, high = 3.6;
    const bool low_sign = determinant(low) > 0.0;
    for (int k = 0; k < 50; ++k)
    {
      const double middle = 0.5 * (low + high);
      ((determinant(middle) > 0.0) == low_sign ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  using State = std::array<double, 4>;  ///< deflection, turn, moment, shear force

  State rate(const State& y, double squared) const
  {
    return {y[1] + shear_ * y[3], y[2], -y[3] - rotary_ * squared * y[1], -squared * y[0]};
  }

  State end(State y, double squared) const
  {
    constexpr int kSteps = 200;
    constexpr double kStep = 1.0 / kSteps;
    const auto moved = [](const State& from, const State& by, double part) {
      State sum;
      for (std::size_t k = 0; k < sum.size(); ++k)
      {
        sum[k] = from[k] + part * by[k];
      }
      return sum;
    };
    for (int k = 0; k < kSteps; ++k)
    {
      const State a = rate(y, squared), b = rate(moved(y, a, 0.5 * kStep), squared);
      const State c = rate(moved(y, b, 0.5 * kStep), squared);
      const State d = rate(moved(y, c, kStep), squared);
      y = moved(moved(moved(moved(y, a, kStep / 6.0), b, kStep / 3.0), c, kStep / 3.0), d,
                kStep / 6.0);
    }
    return y;
  }

  double determinant(double omega) const
  {
    const State one = end({0.0, 0.0, 1.0, 0.0}, omega * omega);
    const State other = end({0.0, 0.0, 0.0, 1.0}, omega * omega);
    return one[2] * other[3] - one[3] * other[2];
  }

  double rotary_, shear_;
};

}  // namespace soft_tissue::test
