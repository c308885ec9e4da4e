#include "soft_tissue_sim/field/deformed_distance.h"

#include <cmath>
#include <optional>

#include "surface_sign.h"

namespace soft_tissue
{
namespace
{
/** From here squares of distances have no number any more, m; bodies are points by far. */
constexpr double kFar = 1e100;
}  // namespace

class DeformedDistance::Impl
{
 public:
  explicit Impl(const BoundarySurface& surface) : surface_(surface) {}

  void update(const Points& x)
  {
    x_ = x;
    if (tree_.empty())
    {
      tree_.build(surface_.triangles, x_);
    }
    else
    {
      tree_.refit(x_);
    }
    sign_.emplace(surface_, x_);
  }

  Answer at(const Vec3& p) const
  {
    Answer answer;
    if (!sign_)
    {
      return answer;
    }
    if (p.allFinite() && p.lpNorm<Eigen::Infinity>() > kFar)
    {
      answer.depth = -p.stableNorm();
      answer.gradient = -p.stableNormalized();
      return answer;
    }
    const TriangleTree::Nearest nearest = tree_.nearest(p, x_);
    if (nearest.triangle < 0)
    {
      return answer;
    }
    const double distance = std::sqrt(nearest.point.squared_distance);
    const bool inside = sign_->inside(p, nearest.triangle, nearest.point);
    answer.triangle = nearest.triangle;
    answer.depth = inside ? distance : -distance;
    answer.gradient =
        distance > 0.0 ? Vec3((p - nearest.point.point) / answer.depth)
                       : Vec3(-sign_->normal(nearest.triangle, nearest.point.weights).normalized());
    return answer;
  }

 private:
  const BoundarySurface& surface_;
  Points x_;
  TriangleTree tree_;
  std::optional<SurfaceSign> sign_;
};

DeformedDistance::DeformedDistance(const BoundarySurface& surface)
    : impl_(std::make_unique<Impl>(surface))
{}

DeformedDistance::~DeformedDistance() = default;
DeformedDistance::DeformedDistance(DeformedDistance&&) noexcept = default;

void DeformedDistance::update(const Points& x)
{
  impl_->update(x);
}

DeformedDistance::Answer DeformedDistance::at(const Vec3& p) const
{
  return impl_->at(p);
}

}  // namespace soft_tissue
