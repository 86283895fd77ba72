// SPDX-License-Identifier: MIT
/// The formulas of two bodies as made (toleranced.hpp), of the joints that they hang on and of the loops that these close, and what they
/// are over a box of deviations, as Taylor models.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/certificate/taylor_model.hpp"
#include "core/certificate/toleranced.hpp"
#include "core/certificate/toleranced_chain.hpp"
#include "core/certificate/toleranced_loop.hpp"

namespace fettle::core::certificate {

/// Relative to their magnitudes, of sums of as many numbers as there are variables.
inline constexpr double rounding_of_sums = 0x1p-47;

/// A box of a pair's variables: its coordinates, then its deviations.
struct VariableBox {
    using Values = std::array<double, most_variables>;
    Values low{}, high{};  ///< those beyond the pair's own are 0
    bool operator==(const VariableBox&) const = default;
};

/// Vertices and frames over a box of deviations.
struct ModelledPair {
    std::vector<Model3> a, b;               ///< vertices, in the bodies' frames
    std::vector<ChainLink> line_a, line_b;  ///< outermost first; positions: the pair's coordinates, then its dependents
    std::vector<ModelledLoop> loops;
};

/// The largest rest in them; infinite where one is no number.
double largest_rest(const ModelledPair& models);
/// The same models over a part of the box, of whose variables those of the box are linear functions.
ModelledPair restricted(const ModelledPair& whole, const VariableBox& box, const VariableBox& part);

class PairFormulas {
public:
    /// Contract: checked; the pair is of it. @param a, b  Vertices of the bodies' meshes, of those that have no formulas. Must stay where
    /// they are.
    PairFormulas(const Toleranced& toleranced, const TolerancedPair& pair, const Matrix3X& a, const Matrix3X& b);

    int coordinates() const { return coordinates_; }
    int variables() const { return variables_; }

    ModelledPair over(const VariableBox& box) const;

    /// Which coordinates of a loop follow from which.
    struct Loop {
        std::vector<int> unknowns;   ///< places in the list of positions
        std::vector<double> starts;  ///< of the unknowns
        int driver = -1;             ///< place of the other one
        double driver_start = 0;
    };
    const std::vector<Loop>& loops() const { return loops_; }
    /// The pair's coordinates over the box; its dependents are not known yet.
    std::vector<TaylorModel> positions_over(const VariableBox& box) const;

private:
    struct Screw {
        int position;
        NodePoint point, axis;
        double turn, slide, start;
        std::optional<DrivenNodes> driven;
    };
    struct Link {
        std::vector<Screw> screws;
        std::array<NodePoint, 3> rotation;
        NodePoint place;
    };
    struct Closure {
        std::vector<Link> line_a, line_b;
        NodePoint point_a, axis_a, point_b, axis_b;
    };
    struct LoopFormulas {
        std::vector<Closure> closures;
        std::vector<int> rows;
        double size;
    };

    int coordinates_ = 0, variables_ = 0;
    expression::Nodes nodes_;  // what the pair needs of the model's
    std::vector<Link> line_a_, line_b_;
    std::vector<LoopFormulas> loop_formulas_;
    std::vector<Loop> loops_;
    std::vector<NodePoint> a_, b_;
    const Matrix3X &mesh_a_, &mesh_b_;
};

}  // namespace fettle::core::certificate
