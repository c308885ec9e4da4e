#include <gtest/gtest.h>

#include <cstdio>

#include "support/contact_scene.h"
#include "support/finite_difference.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kStep = 0.01;  // s
constexpr double kCoefficient = 0.4;
const Vec3 kTool(0.0102, 0.0097, 0.0165);

TetMesh tissue()
{
  return slab(Vec3::Zero(), {0.021, 0.021, 0.014}, 3, 3, 2);
}

ContactOptions rubbing(ContactOptions options)
{
  options.friction = kCoefficient;
  return options;
}

/** A ball in a slab, and the same without friction, for one step in which the ball moves on. */
struct Rub
{
  ContactScene with, without;
  Points start;
  Pose X_before = at(kTool), X_after;

  Rub(const ContactOptions& options, const Vec3& moved)
      : with(tissue(), makeSphere(0.006), rubbing(options)),
        without(tissue(), makeSphere(0.006), options),
        start(shaken(with.mesh.nodes, 0.0004, 51)),
        X_after(at(kTool + moved))
  {
    with.contact->beginStep(start, X_before, X_after, true);
    without.contact->beginStep(start, X_before, X_after, true);
  }

  double value(const Points& x) { return with.contact->value(x) - without.contact->value(x); }
  Eigen::VectorXd gradient(const Points& x)
  {
    return gradientOf(*with.contact, x) - gradientOf(*without.contact, x);
  }
  Eigen::MatrixXd hessian(const Points& x)
  {
    const Adjacency& rows = with.node_neighbours;
    return hessianOf(*with.contact, x, rows, Curvature::exact) -
           hessianOf(*without.contact, x, rows, Curvature::exact);
  }
};

/** Slides of a fraction of the stick length, of about it, and of many of it. */
const std::vector<double> kSlides = {2e-7, 1e-6, 2e-4};
}  // namespace

TEST(Friction, DerivativesAreThoseOfItsPotential)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    for (const double slide : kSlides)
    {
      Rub rub(options, slide * Vec3(0.8, -0.6, 0.1));
      const Points x = shaken(rub.start, 0.2 * slide, 52);
      const Eigen::VectorXd gradient = rub.gradient(x);
      const Eigen::MatrixXd hessian = rub.hessian(x);
      ASSERT_GT(gradient.norm(), 0.0);
      RandomGeometry random(53);
      double off = 0.0, off2 = 0.0;
      for (int k = 0; k < 4; ++k)
      {
        Eigen::VectorXd way(gradient.size());
        for (double& w : way)
        {
          w = random.uniform(-1.0, 1.0);
        }
        const auto moved = [&](double s) {
          Points y = x;
          for (Eigen::Index i = 0; i < way.size(); ++i)
          {
            y[i / 3][i % 3] += s * way[i];
          }
          return y;
        };
        const double step = 1e-3 * slide;
        const double slope = (rub.value(moved(step)) - rub.value(moved(-step))) / (2.0 * step);
        off = std::max(off, std::abs(slope - gradient.dot(way)) / (gradient.norm() * way.norm()));
        const Eigen::VectorXd change =
            (rub.gradient(moved(step)) - rub.gradient(moved(-step))) / (2.0 * step);
        off2 = std::max(off2, (change - hessian * way).norm() / (hessian.norm() * way.norm()));
      }
      std::printf("  %s, slide %.0e m: gradient off by %.1e, Hessian by %.1e\n",
                  nameOf(options).c_str(), slide, off, off2);
      EXPECT_LT(off, 1e-5);
      EXPECT_LT(off2, 1e-5);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian);
      EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * hessian.norm());
    }
  }
}

TEST(Friction, IsCoulombsForceAgainstTheSlideAndBalanced)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    const Vec3 way(0.8, -0.6, 0.0);
    Rub rub(options, 1e-4 * way);
    double pressed = 0.0;  // by the contacts the step starts with
    ContactScene at_start(tissue(), makeSphere(0.006), options);
    at_start.begin(rub.start, rub.X_before);
    for (const ContactSample& s : at_start.contact->samples(rub.start))
    {
      pressed += s.stiffness_area > 0.0 ? s.force : 0.0;
    }
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double sum = 0.0;
    for (const FrictionForce& f : rub.with.contact->frictionForces(rub.start))
    {
      EXPECT_NEAR(f.on_first.dot(f.normal), 0.0, 1e-12);
      EXPECT_LT(f.on_first.dot(way), 0.0) << "the tissue holds the tool back";
      sum += f.on_first.norm();
      force += f.on_first;
      moment += f.position.cross(f.on_first);
    }
    ASSERT_GT(pressed, 0.0);
    EXPECT_NEAR(sum, kCoefficient * pressed, 1e-9 * pressed) << nameOf(options);
    const Eigen::VectorXd gradient = rub.gradient(rub.start);
    for (std::size_t i = 0; i < rub.start.size(); ++i)
    {
      force -= gradient.segment<3>(3 * i);
      moment -= rub.start[i].cross(Vec3(gradient.segment<3>(3 * i)));
    }
    EXPECT_LT(force.norm(), 1e-9 * sum);
    EXPECT_LT(moment.norm(), 1e-9 * sum);
  }
}

TEST(Friction, OfATissueThatIsCarriedAlongIsZero)
{
  Rub rub(contactModels(1e6)[3], Vec3(1e-4, 2e-5, 0.0));
  Points carried = rub.start;
  for (Vec3& p : carried)
  {
    p += Vec3(1e-4, 2e-5, 0.0);
  }
  ASSERT_FALSE(rub.with.contact->frictionForces(carried).empty());
  for (const FrictionForce& f : rub.with.contact->frictionForces(carried))
  {
    EXPECT_LT(f.on_first.norm(), 1e-10);
  }
  // A turning tool takes its points of contact along as well.
  const Pose turn = at(kTool) * Eigen::AngleAxisd(0.01, Vec3::UnitZ());
  rub.with.contact->beginStep(rub.start, at(kTool), turn, true);
  double torque = 0.0;
  for (const FrictionForce& f : rub.with.contact->frictionForces(rub.start))
  {
    torque += (f.position - kTool).cross(f.on_first).z();
  }
  EXPECT_LT(torque, -1e-9) << "and is held back by the tissue";
}

}  // namespace soft_tissue::test
