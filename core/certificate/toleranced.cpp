// SPDX-License-Identifier: MIT
#include "core/certificate/toleranced.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "core/base/limits.hpp"
#include "core/expression/tape.hpp"
#include "core/geometry/range.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using expression::Node;
using expression::Operation;

base::Errors fault(const std::string& where, const std::string& message) {
    return {{ErrorCode::inconsistent, "/tolerances/" + where, message}};
}

bool is_usable_node(const Node& node, std::size_t place, std::size_t inputs) {
    if (node.operation > Operation::choose) return false;
    if (node.operation == Operation::constant) return base::is_usable_number(node.number);
    if (node.operation == Operation::input) return node.operands[0] >= 0 && static_cast<std::size_t>(node.operands[0]) < inputs;
    for (int i = 0; i < expression::operand_count(node.operation); ++i) {
        const int operand = node.operands[static_cast<std::size_t>(i)];
        if (operand < 0 || static_cast<std::size_t>(operand) >= place) return false;
    }
    return true;
}

bool ends_in_the_world(const Toleranced& toleranced, std::size_t body) {
    int at = static_cast<int>(body);
    for (std::size_t k = 0; k <= toleranced.bodies.size(); ++k) {
        if (at == -1) return true;
        if (at < 0 || at >= count_of(toleranced.bodies)) return false;
        at = toleranced.bodies[at].parent;
    }
    return false;
}

bool is_usable_body(const Toleranced& toleranced, std::size_t index, int vertices) {
    const TolerancedBody& body = toleranced.bodies[index];
    if (!body.vertices.empty() && count_of(body.vertices) != vertices) return false;
    bool usable = ends_in_the_world(toleranced, index);
    const auto look = [&](const auto& point) {
        for (const int node : point) usable = usable && node >= 0 && node < count_of(toleranced.nodes);
    };
    for_frame_nodes(body, look);
    for (const NodePoint& vertex : body.vertices) look(vertex);
    for (const TolerancedScrew& screw : body.screws)
        usable = usable && screw.coordinate >= 0 && screw.coordinate < count_of(toleranced.coordinates) &&
                 base::is_usable_number(screw.turn) && base::is_usable_number(screw.slide);
    return usable;
}

std::vector<int> ancestry(const Toleranced& toleranced, int body) {
    std::vector<int> out;
    for (int at = body; at >= 0; at = toleranced.bodies[at].parent) out.push_back(at);
    std::reverse(out.begin(), out.end());
    return out;
}

// `unknowns`: of all loops so far.
bool is_usable_loop(const Toleranced& toleranced, const TolerancedLoop& loop, std::set<int>& unknowns) {
    if (loop.unknowns.empty() || loop.unknowns.size() != loop.rows.size() || !(loop.size > 0) || !base::is_usable_number(loop.size))
        return false;
    for (const int unknown : loop.unknowns)
        if (unknown < 0 || unknown >= count_of(toleranced.coordinates) || !unknowns.insert(unknown).second) return false;
    for (const int row : loop.rows)
        if (row < 0 || row >= 6 * count_of(loop.closures) || std::count(loop.rows.begin(), loop.rows.end(), row) > 1) return false;
    std::set<int> drivers;
    for (const TolerancedClosure& closure : loop.closures) {
        for (const int body : {closure.a, closure.b})
            if (body < -1 || body >= count_of(toleranced.bodies)) return false;
        for (const NodePoint& point : {closure.point_a, closure.axis_a, closure.point_b, closure.axis_b})
            for (const int node : point)
                if (node < 0 || node >= count_of(toleranced.nodes)) return false;
        const BodyLines lines = lines_between(toleranced, closure.a, closure.b);
        for (const auto* line : {&lines.a, &lines.b})
            for (const int body : *line)
                for (const TolerancedScrew& screw : toleranced.bodies[body].screws) {
                    const bool is_unknown = std::find(loop.unknowns.begin(), loop.unknowns.end(), screw.coordinate) != loop.unknowns.end();
                    if (is_unknown && screw.driven) return false;
                    if (!is_unknown) drivers.insert(screw.coordinate);
                }
    }
    return drivers.size() == 1;
}

bool same_nodes(const expression::Nodes& x, const expression::Nodes& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Node& a, const Node& b) {
        if (a.operation != b.operation || a.number != b.number) return false;
        const int count = a.operation == Operation::input ? 1 : expression::operand_count(a.operation);
        return std::equal(a.operands.begin(), a.operands.begin() + count, b.operands.begin());
    });
}

}  // namespace

bool is_over_ranges(const Toleranced& toleranced) {
    return std::any_of(toleranced.coordinates.begin(), toleranced.coordinates.end(),
                       [](const LinkageCoordinate& c) { return c.low < c.high; });
}

bool same_toleranced(const Toleranced& x, const Toleranced& y) {
    return x.deviations == y.deviations && same_nodes(x.nodes, y.nodes) && x.coordinates == y.coordinates && x.bodies == y.bodies &&
           x.loops == y.loops && x.duration == y.duration;
}

double farthest(const Toleranced& toleranced, const TolerancedScrew& screw) {
    const LinkageCoordinate& c = toleranced.coordinates[screw.coordinate];
    if (!screw.driven) return c.high - c.low;
    std::vector<geometry::Range> deviations;
    for (const Deviation& d : toleranced.deviations) deviations.emplace_back(d.lower, d.upper);
    const std::vector<geometry::Range> of_nodes = expression::values<geometry::Range>(toleranced.nodes, deviations);
    const geometry::Range way(c.low - c.start, c.high - c.start);
    return (of_nodes[screw.driven->shift] + of_nodes[screw.driven->scale] * way).magnitude();
}

base::Errors check_toleranced(const Toleranced& toleranced, const std::vector<int>& vertices) {
    if (!base::is_usable_number(toleranced.duration) || toleranced.duration < 0) return fault("duration", "a time is expected, or 0");
    for (std::size_t k = 0; k < toleranced.deviations.size(); ++k) {
        const Deviation& d = toleranced.deviations[k];
        const bool usable = base::is_usable_number(d.lower) && base::is_usable_number(d.upper);
        if (!usable || !(d.lower <= d.base && d.base <= d.upper))
            return fault("deviations/" + std::to_string(k), "lower <= base <= upper is expected");
    }
    for (std::size_t k = 0; k < toleranced.nodes.size(); ++k)
        if (!is_usable_node(toleranced.nodes[k], k, toleranced.deviations.size()))
            return fault("nodes/" + std::to_string(k), "an operation on nodes before it is expected");
    for (std::size_t k = 0; k < toleranced.coordinates.size(); ++k) {
        const LinkageCoordinate& c = toleranced.coordinates[k];
        const bool usable = base::is_usable_number(c.low) && base::is_usable_number(c.high);
        if (!usable || !(c.low <= c.start && c.start <= c.high))
            return fault("coordinates/" + std::to_string(k), "low <= start <= high is expected");
    }
    if (toleranced.bodies.size() != vertices.size()) return fault("bodies", "one entry per body of the model is expected");
    for (std::size_t k = 0; k < vertices.size(); ++k)
        if (!is_usable_body(toleranced, k, vertices[k]))
            return fault("bodies/" + std::to_string(k), "its nodes, coordinates or parents are not there, or it has other vertices");
    std::set<int> unknowns;
    for (std::size_t k = 0; k < toleranced.loops.size(); ++k)
        if (!is_usable_loop(toleranced, toleranced.loops[k], unknowns))
            return fault("loops/" + std::to_string(k),
                         "bodies, nodes, as many conditions as coordinates of its own are expected, and one "
                         "coordinate that drives it");
    return {};
}

BodyLines lines_between(const Toleranced& toleranced, int a, int b) {
    const std::vector<int> from_a = ancestry(toleranced, a), from_b = ancestry(toleranced, b);
    std::size_t common = 0;
    while (common < from_a.size() && common < from_b.size() && from_a[common] == from_b[common]) ++common;
    const auto from = static_cast<std::ptrdiff_t>(common);
    return {{from_a.begin() + from, from_a.end()}, {from_b.begin() + from, from_b.end()}};
}

namespace {

// What moves two bodies against each other, loops and all.
class Reach {
public:
    explicit Reach(const Toleranced& toleranced) : toleranced_(toleranced), reached_(toleranced.nodes.size(), false) {}

    void add_lines(const BodyLines& lines) {
        for (const auto* line : {&lines.a, &lines.b})
            for (const int body : *line) {
                for_frame_nodes(toleranced_.bodies[body], [&](const auto& nodes) { add(nodes); });
                for (const TolerancedScrew& screw : toleranced_.bodies[body].screws) add_coordinate(screw.coordinate);
            }
    }
    void add(std::span<const int> point) {
        for (const int node : point) reached_[node] = true;
    }
    void finish(TolerancedPair& pair) {
        std::set<int> deviations;
        for (std::size_t k = reached_.size(); k-- > 0;) {
            if (!reached_[k]) continue;
            const Node& node = toleranced_.nodes[k];
            if (node.operation == Operation::input) deviations.insert(node.operands[0]);
            for (int i = 0; i < expression::operand_count(node.operation); ++i) reached_[node.operands[static_cast<std::size_t>(i)]] = true;
        }
        for (const int c : coordinates_) (loop_of(c) < 0 ? pair.coordinates : pair.dependents).push_back(c);
        pair.deviations.assign(deviations.begin(), deviations.end());
        pair.loops.assign(loops_.begin(), loops_.end());
    }

private:
    int loop_of(int coordinate) const {
        for (int k = 0; k < count_of(toleranced_.loops); ++k) {
            const std::vector<int>& unknowns = toleranced_.loops[k].unknowns;
            if (std::find(unknowns.begin(), unknowns.end(), coordinate) != unknowns.end()) return k;
        }
        return -1;
    }
    void add_coordinate(int coordinate) {
        if (!coordinates_.insert(coordinate).second) return;
        const int loop = loop_of(coordinate);
        if (loop < 0 || !loops_.insert(loop).second) return;
        for (const int unknown : toleranced_.loops[loop].unknowns) add_coordinate(unknown);
        for (const TolerancedClosure& closure : toleranced_.loops[loop].closures) {
            for (const NodePoint& point : {closure.point_a, closure.axis_a, closure.point_b, closure.axis_b}) add(point);
            add_lines(lines_between(toleranced_, closure.a, closure.b));
        }
    }

    const Toleranced& toleranced_;
    std::vector<bool> reached_;
    std::set<int> coordinates_, loops_;
};

}  // namespace

TolerancedPair toleranced_pair(const Toleranced& toleranced, int a, int b) {
    TolerancedPair pair;
    pair.of_a = a;
    pair.of_b = b;
    const BodyLines lines = lines_between(toleranced, a, b);
    pair.a = lines.a;
    pair.b = lines.b;
    Reach reach(toleranced);
    reach.add_lines(lines);
    for (const int body : {a, b})
        for (const NodePoint& vertex : toleranced.bodies[body].vertices) reach.add(vertex);
    reach.finish(pair);
    return pair;
}

}  // namespace fettle::core::certificate
