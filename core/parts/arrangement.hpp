// SPDX-License-Identifier: MIT
/// Curves, cut wherever they meet, and loops put together from the pieces: what Booleans and offsets of profiles are made with.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/path.hpp"

namespace fettle::core::parts {

struct ArrangedCurve {
    Segment segment;
    int group = 0;
};

/// Part of a curve between two nodes, nothing meeting it in between.
struct Piece {
    std::size_t source = 0;  ///< which curve
    Cut begin, end;          ///< on it
    int from = 0, to = 0;    ///< nodes
    bool backwards = false;  ///< against its curve; from and to are in the direction of the piece
};

struct Arrangement {
    std::vector<ArrangedCurve> curves;
    std::vector<Point2> nodes;
    std::vector<int> starts;    ///< per curve: the node that it starts at
    std::vector<Piece> pieces;  ///< by curve, each along it; of one that is shorter than the tolerance there is none
    double tolerance = 0;       ///< what is nearer than this is the same [m]

    Curve curve_of(const Piece& piece) const;
    Vector2 middle_of(const Piece& piece) const;
    /// Whether two pieces lie on each other, in the same (1) or in opposite directions (-1); 0: they do not.
    int coincide(const Piece& a, const Piece& b) const;
};

/// @param within_groups  Whether curves of the same group are cut by each other too.
/// Points nearer than `tolerance` to each other are one node: that of the earlier curve.
Arrangement arranged(std::vector<ArrangedCurve> curves, double tolerance, bool within_groups);

Piece turned_round(Piece piece);

enum class Combination { unite, subtract, intersect };

/// The pieces that bound the combination of groups 0 and 1, which are the loops a and b, as they run round it.
std::vector<Piece> bounding(const Arrangement& arrangement, const std::vector<Loop>& a, const std::vector<Loop>& b,
                            Combination combination);

/// Pieces that lie on others, by the nodes they join.
class Coincidence {
public:
    explicit Coincidence(const Arrangement& arrangement);

    /// 1, -1: one lies on it in the same, the opposite direction; 0: none. `other` is which.
    int find(std::size_t piece, bool of_other_group, std::size_t& other) const;

private:
    const Arrangement& arrangement_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> by_nodes_;
};

/// Pieces that run with the material to their left, by index, in loops; where several leave a node, the sharpest turn to the left.
/// Errors: a piece that nothing follows.
Result<std::vector<std::vector<std::size_t>>> chains_from(const Arrangement& arrangement, const std::vector<Piece>& pieces);

/// Loops from pieces that run with the material to their left. Pieces of one curve that follow each other become one again.
/// Errors: as above.
Result<std::vector<Loop>> loops_from(const Arrangement& arrangement, const std::vector<Piece>& pieces);

}  // namespace fettle::core::parts
