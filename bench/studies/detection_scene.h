#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/collision/clip_pairs.h"
#include "soft_tissue_sim/collision/pair_finder.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue::studies
{
/** A body, where its nodes are now and which elements pairs are looked for among. */
struct DetectionBody
{
  explicit DetectionBody(TetMesh body);

  ElementSet edges() const;
  ElementSet tets() const;

  TetMesh mesh;
  BoundarySurface surface;
  Points x;
};

/** Two bodies, or one with itself, that move a little from turn to turn. */
struct DetectionScene
{
  std::string name;
  DetectionBody a, b;  ///< in one body b does not count
  Vec3 shift;          ///< of b at rest, m
  bool one_body = false;
  double wobble = 1e-3;  ///< m, how far nodes are bent from where they are at rest

  const DetectionBody& second() const { return one_body ? a : b; }

  /** Places all nodes for a turn. */
  void move(int turn);
};

/** Pieces of the first body's surface edges inside tets of the second, of the pairs in a list;
 * those that a plane parts are dropped from it. */
std::size_t countPieces(const DetectionBody& first, const DetectionBody& second,
                        std::vector<ElementPair>& pairs, std::vector<ClippedPair>& pieces);
/** The same, a pair at a time. */
std::size_t countPiecesOneByOne(const DetectionBody& first, const DetectionBody& second,
                                const std::vector<ElementPair>& pairs);
/** Pairs of tets in a list that overlap, each by separating axes. */
std::size_t countTetsOneByOne(const DetectionBody& first, const DetectionBody& second,
                              const std::vector<ElementPair>& pairs);

/** All pairs whose boxes overlap, each with each. */
std::vector<ElementPair> everyPair(const ElementSet& first, const ElementSet& second,
                                   const Points& x_first, const Points& x_second, bool one_body);

}  // namespace soft_tissue::studies
