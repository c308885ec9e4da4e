#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Two triangles (a, b, c) and (b, a, d) at an edge, at rest. */
struct AngleRest
{
  double angle;       ///< rad
  double inverse[2];  ///< of (kSmallArea times twice the area)^2 of each, 1/m^4
};

/** Share of its rest area below which a triangle's angles begin to fade. */
constexpr double kSmallArea = 0.1;
/** Of (area / kSmallArea)^2: below it nothing is left but rounding errors. */
constexpr double kNoArea = 1e-12;

/** The angle between two triangles beyond that at rest, faded where one has collapsed, and its
 * derivative by a, b, c, d. Positive where c and d rise on the side of their normals. */
struct AngleSlope
{
  double value = 0.0;
  Vec3 by[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/** What makes angles of collapsed triangles smooth: 1 from u = 1 on, u^3 near 0. */
struct Fade
{
  double value = 1.0, slope = 0.0, curvature = 0.0;

  explicit Fade(double u)
  {
    if (u < 1.0)
    {
      value = u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
      slope = 30.0 * u * u * (1.0 - u) * (1.0 - u);
      curvature = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
    }
  }
};

/** One of the triangles: (p, q, r), its edge from p to q. */
struct AngleSide
{
  Vec3 edge, arm, normal;  ///< q - p, r - p, edge x arm
  double length;           ///< |edge|
  double area2, u;         ///< |normal|^2; in units of the small area

  AngleSide(const Vec3& along, double size, const Vec3& to_r, double inverse)
      : edge(along), arm(to_r), normal(edge.cross(arm)), length(size), area2(normal.squaredNorm())
  {
    u = area2 * inverse;
  }

  /** Of r's foot on the edge, from p. */
  double share() const { return arm.dot(edge) / (length * length); }
};

struct AngleSides
{
  AngleSide one, other;

  AngleSides(const AngleRest& rest, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
      : AngleSides(rest, a, b, c, d, (b - a).norm())
  {}

  const AngleSide& operator[](int k) const { return k == 0 ? one : other; }
  double leastArea() const { return std::min(one.u, other.u); }

 private:
  AngleSides(const AngleRest& rest, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
             double length)
      : one(b - a, length, c - a, rest.inverse[0]), other(a - b, length, d - b, rest.inverse[1])
  {}
};

/** atan2(sine, cosine) to a few roundings, the same on every machine: by half angles to where a
 * polynomial in t^2, through Chebyshev's points of [0, tan(pi/8)^2], is exact to 4e-18. */
inline double angleOf(double sine, double cosine)
{
  constexpr double kPi = 3.14159265358979323846, kEighth = 0.41421356237309503;
  constexpr double kTerms[] = {1.0,
                               -0.3333333333333312,
                               0.19999999999940893,
                               -0.14285714279250245,
                               0.11111110744919658,
                               -0.09090896809064027,
                               0.07692045330902225,
                               -0.06662951813629191,
                               0.05846878297330872,
                               -0.05035102456601552,
                               0.03796525745386593,
                               -0.017805397205419446};
  const double radius = std::sqrt(sine * sine + cosine * cosine) + std::abs(cosine);
  double t = radius > 0.0 ? sine / radius : 0.0;  // tan of half the angle to the nearer axis
  double turns = 2.0;
  if (std::abs(t) > kEighth)
  {
    t /= 1.0 + std::sqrt(1.0 + t * t);
    turns = 4.0;
  }
  const double u = t * t;
  double sum = kTerms[11];
  for (int k = 10; k >= 0; --k)
  {
    sum = sum * u + kTerms[k];
  }
  const double angle = turns * t * sum;
  return cosine >= 0.0 ? angle : std::copysign(kPi, sine) - angle;
}

/** In [-pi, pi]. */
inline double angleBetween(const AngleSides& sides)
{
  return angleOf(sides.other.normal.cross(sides.one.normal).dot(sides.one.edge),
                 sides.one.length * sides.one.normal.dot(sides.other.normal));
}

/** Derivative of u by p, q, r. */
inline void areaSlope(const AngleSide& side, double inverse, Vec3* by)
{
  by[0] = 2.0 * inverse * side.normal.cross(side.arm - side.edge);
  by[1] = 2.0 * inverse * side.arm.cross(side.normal);
  by[2] = 2.0 * inverse * side.normal.cross(side.edge);
}

/** Nodes of the two sides among (a, b, c, d), as AngleSide names them. */
constexpr int kSideNodes[2][3] = {{0, 1, 2}, {1, 0, 3}};

/** The angle beyond that at rest alone, faded. */
inline double angleValue(const AngleRest& rest, const AngleSides& sides)
{
  const double least = sides.leastArea();
  const double fade = least < 1.0 ? Fade(sides[0].u).value * Fade(sides[1].u).value : 1.0;
  return least < kNoArea ? 0.0 : fade * (angleBetween(sides) - rest.angle);
}

/**
 * The angle with its derivative: c moved along its triangle's normal turns it by one over its
 * height, and what that does to a and b is split as a lever is.
 */
inline void angleSlope(const AngleRest& rest, const AngleSides& sides, AngleSlope& angle)
{
  if (sides.leastArea() < kNoArea)
  {
    angle = AngleSlope();
    return;
  }
  const AngleSide &one = sides.one, &other = sides.other;
  angle.value = angleBetween(sides) - rest.angle;
  angle.by[2] = one.length / one.area2 * one.normal;
  angle.by[3] = one.length / other.area2 * other.normal;
  const double share = one.share(), other_share = other.share();
  angle.by[0] = (share - 1.0) * angle.by[2] - other_share * angle.by[3];
  angle.by[1] = (other_share - 1.0) * angle.by[3] - share * angle.by[2];
}

/** Multiplies an angle by the fade of both its triangles. */
inline void fadeSlope(const AngleRest& rest, const AngleSides& sides, AngleSlope& angle)
{
  const Fade fade[2] = {Fade(sides[0].u), Fade(sides[1].u)};
  for (Vec3& by : angle.by)
  {
    by *= fade[0].value * fade[1].value;
  }
  for (int k = 0; k < 2; ++k)
  {
    Vec3 by_area[3];
    areaSlope(sides[k], rest.inverse[k], by_area);
    for (int i = 0; i < 3; ++i)
    {
      angle.by[kSideNodes[k][i]] += angle.value * fade[k].slope * fade[1 - k].value * by_area[i];
    }
  }
  angle.value *= fade[0].value * fade[1].value;
}

inline Mat3 crossMatrix(const Vec3& v)
{
  Mat3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/** How one side turns the angle: derivatives of angleSlope()'s `turn` by p and q. */
struct TurnSlope
{
  Vec3 turn;
  Mat3 by_p, by_q;

  explicit TurnSlope(const AngleSide& side)
  {
    const double scale = side.length / side.area2;
    turn = scale * side.normal;
    const Vec3 flip = (2.0 / side.area2) * side.normal;
    const Vec3 stretch = side.normal / (side.area2 * side.length);
    // Of the normal by p: v = arm - edge, crossed; by q: v = -arm.
    const Vec3 p = side.arm - side.edge, q = -side.arm;
    const Vec3 along = scale * flip, edge = side.edge;
    by_p = crossMatrix(scale * p);
    by_p.noalias() -= along * side.normal.cross(p).transpose();
    by_p.noalias() -= stretch * edge.transpose();
    by_q = crossMatrix(scale * q);
    by_q.noalias() -= along * side.normal.cross(q).transpose();
    by_q.noalias() += stretch * edge.transpose();
  }
};

/** Second derivatives of the angle itself, blocks (i, j) with i <= j in a, b, c, d. */
inline void angleCurvature(const AngleSides& sides, Mat3 (*k)[4])
{
  const TurnSlope one(sides[0]), other(sides[1]);
  k[0][2] = one.by_p.transpose();
  k[1][2] = one.by_q.transpose();
  k[1][3] = other.by_p.transpose();
  k[0][3] = other.by_q.transpose();
  k[2][3].setZero();
  const auto share_by_q = [](const AngleSide& s) -> Vec3 {
    return (s.arm - 2.0 * s.share() * s.edge) / (s.length * s.length);
  };
  const auto share_by_p = [](const AngleSide& s) -> Vec3 {
    return ((2.0 * s.share() - 1.0) * s.edge - s.arm) / (s.length * s.length);
  };
  k[0][1] = (sides[0].share() - 1.0) * one.by_q - sides[1].share() * other.by_p;
  k[0][1].noalias() += one.turn * share_by_q(sides[0]).transpose();
  k[0][1].noalias() -= other.turn * share_by_p(sides[1]).transpose();
  // Moving all nodes alike changes nothing.
  k[0][0] = -(k[0][1] + k[0][2] + k[0][3]);
  k[1][1] = -(k[0][1].transpose() + k[1][2] + k[1][3]);
  k[2][2] = -(k[0][2] + k[1][2]);
  k[3][3] = -(k[0][3] + k[1][3]);
}

/** Makes of second derivatives of the angle those of the faded one; `angle` is not faded yet. */
inline void fadeCurvature(const AngleRest& rest, const AngleSides& sides, const AngleSlope& angle,
                          Mat3 (*k)[4])
{
  const Fade fade[2] = {Fade(sides[0].u), Fade(sides[1].u)};
  Vec3 by_fade[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Vec3 by_area[2][4];
  Mat3 twice[4][4];
  for (auto& row : twice)
  {
    std::fill_n(row, 4, Mat3::Zero());
  }
  for (int s = 0; s < 2; ++s)
  {
    const AngleSide& side = sides[s];
    const int* nodes = kSideNodes[s];
    Vec3 by[3];
    areaSlope(side, rest.inverse[s], by);
    std::fill_n(by_area[s], 4, Vec3::Zero());
    const Vec3 v[3] = {side.arm - side.edge, -side.arm, side.edge};
    const double first = fade[s].slope * fade[1 - s].value;
    const double second = fade[s].curvature * fade[1 - s].value;
    const Mat3 normal = crossMatrix(side.normal);
    for (int i = 0; i < 3; ++i)
    {
      by_area[s][nodes[i]] = by[i];
      by_fade[nodes[i]] += first * by[i];
      for (int j = 0; j < 3; ++j)
      {
        Mat3 area = v[i].dot(v[j]) * Mat3::Identity() - v[j] * v[i].transpose();
        area += i == j ? Mat3::Zero() : Mat3(((j - i + 3) % 3 == 1 ? -1.0 : 1.0) * normal);
        twice[nodes[i]][nodes[j]] +=
            2.0 * first * rest.inverse[s] * area + second * by[i] * by[j].transpose();
      }
    }
  }
  const double value = fade[0].value * fade[1].value, slopes = fade[0].slope * fade[1].slope;
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i; j < 4; ++j)
    {
      twice[i][j] += slopes * (by_area[0][i] * by_area[1][j].transpose() +
                               by_area[1][i] * by_area[0][j].transpose());
      k[i][j] = value * k[i][j] + by_fade[i] * angle.by[j].transpose() +
                angle.by[i] * by_fade[j].transpose() + angle.value * twice[i][j];
    }
  }
}

}  // namespace soft_tissue
