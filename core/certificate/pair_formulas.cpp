// SPDX-License-Identifier: MIT
#include "core/certificate/pair_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/limits.hpp"
#include "core/expression/tape.hpp"

namespace fettle::core::certificate {
namespace {

using expression::Node;
using expression::Operation;

template <class Pair, class Visit>
void for_models(Pair& pair, const Visit& visit) {
    const auto each = [&](auto& x) { std::for_each(x.begin(), x.end(), visit); };
    for (auto* vertices : {&pair.a, &pair.b}) std::for_each(vertices->begin(), vertices->end(), each);
    const auto of_line = [&](auto& line) {
        for (auto& link : line) {
            std::for_each(link.rotation.begin(), link.rotation.end(), each);
            each(link.place);
            for (auto& screw : link.screws) {
                each(screw.point);
                each(screw.axis);
                if (!screw.driven) continue;
                visit(screw.driven->scale);
                visit(screw.driven->shift);
            }
        }
    };
    of_line(pair.line_a);
    of_line(pair.line_b);
    for (auto& loop : pair.loops)
        for (auto& closure : loop.closures) {
            of_line(closure.line_a);
            of_line(closure.line_b);
            for (auto* x : {&closure.point_a, &closure.axis_a, &closure.point_b, &closure.axis_b}) each(*x);
        }
}

// The nodes that are asked for, and those that they need, in their order.
class Extract {
public:
    Extract(const Toleranced& from, const TolerancedPair& pair) : from_(from), pair_(pair), place_(from.nodes.size(), -1) {}

    void want(std::span<const int> point) {
        for (const int node : point) place_[node] = 0;
    }
    expression::Nodes take() {
        for (std::size_t k = place_.size(); k-- > 0;)
            for (int i = 0; place_[k] == 0 && i < expression::operand_count(from_.nodes[k].operation); ++i)
                place_[from_.nodes[k].operands[static_cast<std::size_t>(i)]] = 0;
        expression::Nodes out;
        for (std::size_t k = 0; k < place_.size(); ++k) {
            if (place_[k] < 0) continue;
            Node node = from_.nodes[k];
            for (int i = 0; i < expression::operand_count(node.operation); ++i) {
                int& operand = node.operands[static_cast<std::size_t>(i)];
                operand = place_[operand];
            }
            if (node.operation == Operation::input) {
                const auto at = std::lower_bound(pair_.deviations.begin(), pair_.deviations.end(), node.operands[0]);
                node.operands[0] = static_cast<int>(at - pair_.deviations.begin());
            }
            place_[k] = count_of(out);
            out.push_back(node);
        }
        return out;
    }
    std::optional<DrivenNodes> now(const std::optional<DrivenNodes>& driven) const {
        if (!driven) return std::nullopt;
        return DrivenNodes{place_[driven->scale], place_[driven->shift]};
    }
    NodePoint now(const NodePoint& point) const { return {place_[point[0]], place_[point[1]], place_[point[2]]}; }

private:
    const Toleranced& from_;
    const TolerancedPair& pair_;
    std::vector<int> place_;
};

}  // namespace

double largest_rest(const ModelledPair& models) {
    double out = 0;
    for_models(models, [&](const TaylorModel& x) { out = std::max(out, std::isnan(x.rest) ? infinity : x.rest); });
    return out;
}

ModelledPair restricted(const ModelledPair& whole, const VariableBox& box, const VariableBox& part) {
    std::array<double, most_variables> scale{}, shift{};
    for (std::size_t k = 0; k < scale.size(); ++k) {
        if (!(box.high[k] > box.low[k])) continue;
        const TaylorModel outer = TaylorModel::variable(static_cast<int>(k), box.low[k], box.high[k]),
                          inner = TaylorModel::variable(static_cast<int>(k), part.low[k], part.high[k]);
        scale[k] = geometry::upper(geometry::upper(inner.slopes[k] / outer.slopes[k]));
        shift[k] = (inner.center - outer.center) / outer.slopes[k];
    }
    ModelledPair out = whole;
    for_models(out, [&](TaylorModel& x) {
        double size = std::abs(x.center), moved = 0;
        for (std::size_t k = 0; k < scale.size(); ++k) {
            const double way = x.slopes[k] * shift[k];
            moved += way;
            size += std::abs(way) + std::abs(x.slopes[k]);
            x.slopes[k] *= scale[k];
        }
        x.center += moved;
        x.rest = (x.rest + rounding_of_sums * size) * (1 + 0x1p-50);
    });
    return out;
}

PairFormulas::PairFormulas(const Toleranced& toleranced, const TolerancedPair& pair, const Matrix3X& a, const Matrix3X& b)
    : coordinates_(count_of(pair.coordinates)), variables_(pair.variables()), mesh_a_(a), mesh_b_(b) {
    Extract extract(toleranced, pair);
    const auto want = [&](const auto& nodes) { extract.want(nodes); };
    const auto want_line = [&](const std::vector<int>& line) {
        for (const int body : line) for_frame_nodes(toleranced.bodies[body], want);
    };
    want_line(pair.a);
    want_line(pair.b);
    for (const int loop : pair.loops)
        for (const TolerancedClosure& closure : toleranced.loops[loop].closures) {
            const BodyLines lines = lines_between(toleranced, closure.a, closure.b);
            want_line(lines.a);
            want_line(lines.b);
            for (const NodePoint& point : {closure.point_a, closure.axis_a, closure.point_b, closure.axis_b}) want(point);
        }
    const TolerancedBody &body_a = toleranced.bodies[pair.of_a], &body_b = toleranced.bodies[pair.of_b];
    for (const TolerancedBody* body : {&body_a, &body_b}) std::for_each(body->vertices.begin(), body->vertices.end(), want);
    nodes_ = extract.take();
    const auto position_of = [&](int coordinate) {
        const auto at = std::lower_bound(pair.coordinates.begin(), pair.coordinates.end(), coordinate);
        if (at != pair.coordinates.end() && *at == coordinate) return static_cast<int>(at - pair.coordinates.begin());
        const auto dependent = std::lower_bound(pair.dependents.begin(), pair.dependents.end(), coordinate);
        return count_of(pair.coordinates) + static_cast<int>(dependent - pair.dependents.begin());
    };
    const auto line_of = [&](const std::vector<int>& line, std::vector<Link>& out) {
        for (const int index : line) {
            const TolerancedBody& body = toleranced.bodies[index];
            Link& link = out.emplace_back();
            for (const TolerancedScrew& screw : body.screws)
                link.screws.push_back({position_of(screw.coordinate), extract.now(screw.point), extract.now(screw.axis), screw.turn,
                                       screw.slide, toleranced.coordinates[screw.coordinate].start, extract.now(screw.driven)});
            for (std::size_t i = 0; i < 3; ++i) link.rotation[i] = extract.now(body.rotation[i]);
            link.place = extract.now(body.place);
        }
    };
    line_of(pair.a, line_a_);
    line_of(pair.b, line_b_);
    for (const int index : pair.loops) {
        const TolerancedLoop& from = toleranced.loops[index];
        LoopFormulas& formulas = loop_formulas_.emplace_back();
        formulas.rows = from.rows;
        formulas.size = from.size;
        Loop& loop = loops_.emplace_back();
        for (const int unknown : from.unknowns) {
            loop.unknowns.push_back(position_of(unknown));
            loop.starts.push_back(toleranced.coordinates[unknown].start);
        }
        for (const TolerancedClosure& c : from.closures) {
            const BodyLines lines = lines_between(toleranced, c.a, c.b);
            Closure& closure = formulas.closures.emplace_back();
            line_of(lines.a, closure.line_a);
            line_of(lines.b, closure.line_b);
            closure.point_a = extract.now(c.point_a);
            closure.axis_a = extract.now(c.axis_a);
            closure.point_b = extract.now(c.point_b);
            closure.axis_b = extract.now(c.axis_b);
            for (const auto* line : {&lines.a, &lines.b})
                for (const int body : *line)
                    for (const TolerancedScrew& screw : toleranced.bodies[body].screws) {
                        const int position = position_of(screw.coordinate);
                        if (std::find(loop.unknowns.begin(), loop.unknowns.end(), position) != loop.unknowns.end()) continue;
                        loop.driver = position;
                        loop.driver_start = toleranced.coordinates[screw.coordinate].start;
                    }
        }
    }
    for (const NodePoint& vertex : body_a.vertices) a_.push_back(extract.now(vertex));
    for (const NodePoint& vertex : body_b.vertices) b_.push_back(extract.now(vertex));
}

std::vector<TaylorModel> PairFormulas::positions_over(const VariableBox& box) const {
    std::vector<TaylorModel> out;
    for (int k = 0; k < coordinates_; ++k)
        out.push_back(TaylorModel::variable(k, box.low[static_cast<std::size_t>(k)], box.high[static_cast<std::size_t>(k)]));
    std::size_t dependents = 0;
    for (const Loop& loop : loops_) dependents += loop.unknowns.size();
    out.resize(out.size() + dependents, TaylorModel::unknown());
    return out;
}

ModelledPair PairFormulas::over(const VariableBox& box) const {
    std::vector<TaylorModel> inputs;
    for (int k = coordinates_; k < variables_; ++k)
        inputs.push_back(TaylorModel::variable(k, box.low[static_cast<std::size_t>(k)], box.high[static_cast<std::size_t>(k)]));
    const std::vector<TaylorModel> values = expression::values<TaylorModel>(nodes_, inputs);
    const auto point = [&](const NodePoint& nodes) { return Model3{values[nodes[0]], values[nodes[1]], values[nodes[2]]}; };
    ModelledPair made;
    const auto line_of = [&](const std::vector<Link>& line, std::vector<ChainLink>& out) {
        for (const Link& from : line) {
            ChainLink& link = out.emplace_back();
            for (const Screw& s : from.screws) {
                link.screws.push_back({s.position, point(s.point), point(s.axis), s.turn, s.slide, s.start});
                if (s.driven) link.screws.back().driven = {values[s.driven->scale], values[s.driven->shift]};
            }
            link.rotation = {point(from.rotation[0]), point(from.rotation[1]), point(from.rotation[2])};
            link.place = point(from.place);
        }
    };
    line_of(line_a_, made.line_a);
    line_of(line_b_, made.line_b);
    for (std::size_t l = 0; l < loops_.size(); ++l) {
        const LoopFormulas& from = loop_formulas_[l];
        ModelledLoop& loop = made.loops.emplace_back();
        loop.unknowns = loops_[l].unknowns;
        loop.rows = from.rows;
        loop.size = from.size;
        for (const Closure& c : from.closures) {
            ModelledClosure& closure = loop.closures.emplace_back();
            line_of(c.line_a, closure.line_a);
            line_of(c.line_b, closure.line_b);
            closure.point_a = point(c.point_a);
            closure.axis_a = point(c.axis_a);
            closure.point_b = point(c.point_b);
            closure.axis_b = point(c.axis_b);
        }
    }
    const auto vertices = [&](const std::vector<NodePoint>& nodes, const Matrix3X& mesh, std::vector<Model3>& out) {
        for (const NodePoint& vertex : nodes) out.push_back(point(vertex));
        for (Eigen::Index i = 0; nodes.empty() && i < mesh.cols(); ++i) out.push_back(exact_model(mesh.col(i)));
    };
    vertices(a_, mesh_a_, made.a);
    vertices(b_, mesh_b_, made.b);
    return made;
}

}  // namespace fettle::core::certificate
