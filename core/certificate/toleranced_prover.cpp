// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/toleranced_prover.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/expression/tape.hpp"

namespace fettle::core::certificate {
namespace {

using expression::Node;
using expression::Operation;

constexpr double no_bound = std::numeric_limits<double>::infinity();
constexpr double rounding = 0x1p-47;          // of sums of as many numbers as there are variables, relative to their magnitudes
constexpr std::size_t most_pairs = 36;        // of vertices that are looked at one by one
constexpr std::size_t most_models_kept = 64;  // boxes of deviations
constexpr double finest_slice = 1e-6;         // of what drives a loop
constexpr double fine_rest = 1e-6;            // of the bodies' size: models of all deviations with less are good for parts of them

template <class Visit>
void for_models(ModelledPair& pair, const Visit& visit) {
    const auto each = [&](Model3& x) { std::for_each(x.begin(), x.end(), visit); };
    for (auto* vertices : {&pair.a, &pair.b}) std::for_each(vertices->begin(), vertices->end(), each);
    const auto of_line = [&](std::vector<ChainLink>& line) {
        for (ChainLink& link : line) {
            std::for_each(link.rotation.begin(), link.rotation.end(), each);
            each(link.place);
            for (ChainScrew& screw : link.screws) {
                each(screw.point);
                each(screw.axis);
            }
        }
    };
    of_line(pair.line_a);
    of_line(pair.line_b);
    for (ModelledLoop& loop : pair.loops)
        for (ModelledClosure& closure : loop.closures) {
            of_line(closure.line_a);
            of_line(closure.line_b);
            for (Model3* x : {&closure.point_a, &closure.axis_a, &closure.point_b, &closure.axis_b}) each(*x);
        }
}

// The same models over a part of the box, of whose variables those of the box are linear functions.
std::shared_ptr<const ModelledPair> restricted(const ModelledPair& whole, const VariableBox& box, const VariableBox& part) {
    std::array<double, most_variables> scale{}, shift{};
    for (std::size_t k = 0; k < scale.size(); ++k) {
        if (!(box.high[k] > box.low[k])) continue;
        const TaylorModel outer = TaylorModel::variable(static_cast<int>(k), box.low[k], box.high[k]),
                          inner = TaylorModel::variable(static_cast<int>(k), part.low[k], part.high[k]);
        scale[k] = geometry::upper(geometry::upper(inner.slopes[k] / outer.slopes[k]));
        shift[k] = (inner.center - outer.center) / outer.slopes[k];
    }
    const auto out = std::make_shared<ModelledPair>(whole);
    for_models(*out, [&](TaylorModel& x) {
        double size = std::abs(x.center), moved = 0;
        for (std::size_t k = 0; k < scale.size(); ++k) {
            const double way = x.slopes[k] * shift[k];
            moved += way;
            size += std::abs(way) + std::abs(x.slopes[k]);
            x.slopes[k] *= scale[k];
        }
        x.center += moved;
        x.rest = (x.rest + rounding * size) * (1 + 0x1p-50);
    });
    return out;
}

TaylorModel along(const Vector3& n, const Model3& x) { return scaled(n[0], x[0]) + scaled(n[1], x[1]) + scaled(n[2], x[2]); }

// How far the values of a set of vertices reach, in n.x.
struct ValueReach {
    std::vector<TaylorModel> values;
    std::array<double, most_variables> middle{};  // of their slopes

    void find_middle() {
        for (std::size_t k = 0; k < middle.size(); ++k) {
            double low = no_bound, high = -no_bound;
            for (const TaylorModel& x : values) {
                low = std::min(low, x.slopes[k]);
                high = std::max(high, x.slopes[k]);
            }
            middle[k] = 0.5 * low + 0.5 * high;
        }
    }
    // sign 1: least of them without the middle's part; -1: the same of -x.
    double least(double sign) const {
        double out = no_bound;
        for (const TaylorModel& x : values) {
            double spread = x.rest, size = std::abs(x.center) + x.rest;
            for (std::size_t k = 0; k < middle.size(); ++k) {
                spread += std::abs(x.slopes[k] - middle[k]);
                size += std::abs(x.slopes[k]) + std::abs(middle[k]);
            }
            const double value = sign * x.center - spread - rounding * size;
            if (!(value >= out)) out = value;  // also what is no number
        }
        return out;
    }
};

double least_of_pairs(const ValueReach& a, const ValueReach& b) {
    double out = no_bound;
    for (const TaylorModel& x : a.values)
        for (const TaylorModel& y : b.values) {
            double spread = x.rest + y.rest, size = std::abs(x.center) + std::abs(y.center) + spread;
            for (std::size_t k = 0; k < x.slopes.size(); ++k) {
                spread += std::abs(x.slopes[k] - y.slopes[k]);
                size += std::abs(x.slopes[k]) + std::abs(y.slopes[k]);
            }
            const double value = x.center - y.center - spread - rounding * size;
            if (!(value >= out)) out = value;
        }
    return out;
}

double least_of_pieces(ValueReach& a, ValueReach& b) {
    a.find_middle();
    b.find_middle();
    double common = 0, size = 0;
    for (std::size_t k = 0; k < a.middle.size(); ++k) {
        common += std::abs(a.middle[k] - b.middle[k]);
        size += std::abs(a.middle[k]) + std::abs(b.middle[k]);
    }
    const double of_a = a.least(1), of_b = b.least(-1);
    return of_a + of_b - common - rounding * (size + std::abs(of_a) + std::abs(of_b));
}

std::vector<int> vertices_of(const Region& region) {
    std::vector<int> out(region.vertices.begin(), region.vertices.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

}  // namespace

// What the pair needs of the nodes, and where its frames and vertices are in it.
struct TolerancedProver::Program {
    struct Screw {
        int position;
        NodePoint point, axis;
        double turn, slide, start;
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
    struct Loop {
        std::vector<Closure> closures;
        std::vector<int> unknowns, rows;
        std::vector<double> starts;  // of the unknowns
        double size;
        int driver;
        double driver_start;
    };
    expression::Nodes nodes;
    std::vector<Link> line_a, line_b;
    std::vector<Loop> loops;
    std::vector<NodePoint> a, b;
    const Matrix3X *mesh_a, *mesh_b;
};

namespace {

// The nodes that are asked for, and those that they need, in their order.
class Extract {
public:
    Extract(const Toleranced& from, const TolerancedPair& pair) : from_(from), pair_(pair), place_(from.nodes.size(), -1) {}

    void want(const NodePoint& point) {
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
    NodePoint now(const NodePoint& point) const { return {place_[point[0]], place_[point[1]], place_[point[2]]}; }

private:
    const Toleranced& from_;
    const TolerancedPair& pair_;
    std::vector<int> place_;
};

template <class Visit>
void for_points(const TolerancedBody& body, const Visit& visit) {
    for (const TolerancedScrew& screw : body.screws) {
        visit(screw.point);
        visit(screw.axis);
    }
    for (const NodePoint& row : body.rotation) visit(row);
    visit(body.place);
}

}  // namespace

TolerancedProver::TolerancedProver(const Toleranced& toleranced, const TolerancedPair& pair, const Matrix3X& a, const Matrix3X& b)
    : count_(pair.variables()), first_deviation_(count_of(pair.coordinates)) {
    const auto program = std::make_shared<Program>();
    Extract extract(toleranced, pair);
    const auto want = [&](const NodePoint& point) { extract.want(point); };
    const auto want_line = [&](const std::vector<int>& line) {
        for (const int body : line) for_points(toleranced.bodies[body], want);
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
    program->nodes = extract.take();
    const auto position_of = [&](int coordinate) {
        const auto at = std::lower_bound(pair.coordinates.begin(), pair.coordinates.end(), coordinate);
        if (at != pair.coordinates.end() && *at == coordinate) return static_cast<int>(at - pair.coordinates.begin());
        const auto dependent = std::lower_bound(pair.dependents.begin(), pair.dependents.end(), coordinate);
        return count_of(pair.coordinates) + static_cast<int>(dependent - pair.dependents.begin());
    };
    const auto line_of = [&](const std::vector<int>& line, std::vector<Program::Link>& out) {
        for (const int index : line) {
            const TolerancedBody& body = toleranced.bodies[index];
            Program::Link& link = out.emplace_back();
            for (const TolerancedScrew& screw : body.screws)
                link.screws.push_back({position_of(screw.coordinate), extract.now(screw.point), extract.now(screw.axis), screw.turn,
                                       screw.slide, toleranced.coordinates[screw.coordinate].start});
            for (std::size_t i = 0; i < 3; ++i) link.rotation[i] = extract.now(body.rotation[i]);
            link.place = extract.now(body.place);
        }
    };
    line_of(pair.a, program->line_a);
    line_of(pair.b, program->line_b);
    for (const int index : pair.loops) {
        const TolerancedLoop& from = toleranced.loops[index];
        Program::Loop& loop = program->loops.emplace_back();
        loop.rows = from.rows;
        loop.size = from.size;
        loop.driver = -1;
        for (const int unknown : from.unknowns) {
            loop.unknowns.push_back(position_of(unknown));
            loop.starts.push_back(toleranced.coordinates[unknown].start);
        }
        for (const TolerancedClosure& c : from.closures) {
            const BodyLines lines = lines_between(toleranced, c.a, c.b);
            Program::Closure& closure = loop.closures.emplace_back();
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
    for (const NodePoint& vertex : body_a.vertices) program->a.push_back(extract.now(vertex));
    for (const NodePoint& vertex : body_b.vertices) program->b.push_back(extract.now(vertex));
    program->mesh_a = &a;
    program->mesh_b = &b;
    program_ = program;
    for (std::size_t k = 0; k < pair.coordinates.size(); ++k) {
        const LinkageCoordinate& c = toleranced.coordinates[pair.coordinates[k]];
        box_.low[k] = c.low;
        box_.high[k] = c.high;
        base_.low[k] = base_.high[k] = c.start;
    }
    for (std::size_t j = 0; j < pair.deviations.size(); ++j) {
        const Deviation& d = toleranced.deviations[pair.deviations[j]];
        const std::size_t k = pair.coordinates.size() + j;
        box_.low[k] = d.lower;
        box_.high[k] = d.upper;
        base_.low[k] = base_.high[k] = d.base;
    }
    for (const Matrix3X* vertices : {&a, &b})
        if (vertices->cols() > 0) size_ += std::sqrt(vertices->colwise().squaredNorm().maxCoeff());
    const auto whole = std::make_shared<ModelledPair>(*evaluated(box_));
    for_models(*whole, [&](const TaylorModel& x) { whole_rest_ = std::max(whole_rest_, std::isnan(x.rest) ? no_bound : x.rest); });
    whole_ = whole;
    slices_.resize(program_->loops.size());
    for (std::size_t loop = 0; loop < slices_.size() && is_bounded() && loop_fault_.empty(); ++loop) slice_loop(loop);
}

std::vector<TaylorModel> TolerancedProver::variables_over(const VariableBox& box) const {
    std::vector<TaylorModel> out;
    for (int k = 0; k < first_deviation_; ++k)
        out.push_back(TaylorModel::variable(k, box.low[static_cast<std::size_t>(k)], box.high[static_cast<std::size_t>(k)]));
    std::size_t dependents = 0;
    for (const Program::Loop& loop : program_->loops) dependents += loop.unknowns.size();
    out.resize(out.size() + dependents, TaylorModel::unknown());
    return out;
}

std::optional<LoopEnclosure> TolerancedProver::over_slice(std::size_t loop, double low, double high,
                                                          const std::vector<double>& guess) const {
    VariableBox box = box_;
    const auto driver = static_cast<std::size_t>(program_->loops[loop].driver);
    box.low[driver] = low;
    box.high[driver] = high;
    return enclosed_loop(whole_->loops[loop], variables_over(box), guess);
}

namespace {

// The enclosure where variable k is at t.
LoopEnclosure fixed_at(LoopEnclosure found, std::size_t k, double t) {
    for (TaylorModel& x : found.linear) {
        x.center += t * x.slopes[k];
        x.slopes[k] = 0;
    }
    return found;
}

std::vector<double> middles_of(const LoopEnclosure& found) {
    std::vector<double> out;
    for (const TaylorModel& x : found.linear) out.push_back(x.center);
    return out;
}

}  // namespace

// From the start on to both ends of what drives the loop.
void TolerancedProver::slice_loop(std::size_t loop) {
    const Program::Loop& from = program_->loops[loop];
    if (from.driver < 0 || from.driver >= first_deviation_) {
        loop_fault_ = "a loop is driven by another loop, which is not dealt with";
        return;
    }
    const auto driver = static_cast<std::size_t>(from.driver);
    const double low = box_.low[driver], high = box_.high[driver], start = from.driver_start;
    std::vector<Slice>& slices = slices_[loop];
    for (double half = (high - low) / 128; slices.empty() && half >= finest_slice * (high - low); half /= 2) {
        const double first = std::max(low, start - half), last = std::min(high, start + half);
        const auto found = over_slice(loop, first, last, from.starts);
        if (!found) {
            if (!(half > 0)) break;
            continue;
        }
        // Where the loop is at the base is the solution that is meant.
        std::array<double, most_variables> t{};
        for (std::size_t k = 0; k < t.size(); ++k) {
            const double at_low = k == driver ? first : box_.low[k], at_high = k == driver ? last : box_.high[k];
            const TaylorModel variable = TaylorModel::variable(static_cast<int>(k), at_low, at_high);
            t[k] = variable.slopes[k] > 0 ? (base_.low[k] - variable.center) / variable.slopes[k] : 0;
        }
        bool is_there = true;
        for (std::size_t i = 0; i < from.starts.size(); ++i)
            is_there = is_there && std::abs(linear_value(found->linear[i], t) - from.starts[i]) + 1e-9 < found->only[i];
        if (is_there) slices.push_back({first, last, *found});
        if (!(half > 0)) break;
    }
    if (!slices.empty() && extend(loop, true, slices) && extend(loop, false, slices)) return;
    loop_fault_ =
        "where the joints of its loop are cannot be enclosed for all of their range and all tolerances: does it come near a dead "
        "centre, or do the lengths not close it everywhere?";
}

bool TolerancedProver::extend(std::size_t loop, bool upwards, std::vector<Slice>& slices) const {
    const auto driver = static_cast<std::size_t>(program_->loops[loop].driver);
    const double low = box_.low[driver], high = box_.high[driver];
    double width = slices.back().high - slices.back().low;
    while (upwards ? slices.back().high < high : slices.front().low > low) {
        const Slice& before = upwards ? slices.back() : slices.front();
        if (!(width > finest_slice * (high - low))) return false;
        const double from = upwards ? before.high : std::max(low, before.low - width),
                     to = upwards ? std::min(high, before.high + width) : before.low;
        const double half = 0.5 * (before.high - before.low), middle = 0.5 * (before.high + before.low);
        const LoopEnclosure ahead = fixed_at(before.found, driver, half > 0 ? (0.5 * (from + to) - middle) / half : 0);
        const auto found = over_slice(loop, from, to, middles_of(ahead));
        const double side = upwards ? 1 : -1;
        if (!found || !is_same_branch(fixed_at(before.found, driver, side), fixed_at(*found, driver, -side))) {
            width /= 2;
            continue;
        }
        width *= 1.5;
        slices.insert(upwards ? slices.end() : slices.begin(), Slice{from, to, *found});
    }
    return true;
}

bool TolerancedProver::enclose_loops(const VariableBox& box, const ModelledPair& models, std::vector<TaylorModel>& positions) const {
    for (std::size_t loop = 0; loop < program_->loops.size(); ++loop) {
        const auto driver = static_cast<std::size_t>(program_->loops[loop].driver);
        const double at = 0.5 * (box.low[driver] + box.high[driver]);
        const auto slice =
            std::find_if(slices_[loop].begin(), slices_[loop].end(), [&](const Slice& each) { return each.low <= at && at <= each.high; });
        if (slice == slices_[loop].end()) return false;
        // The slice's solution over the box's deviations, in the middle of what drives the loop.
        LoopEnclosure known = slice->found;
        for (std::size_t k = 0; k < most_variables; ++k) {
            const double low = k == driver ? slice->low : box_.low[k], high = k == driver ? slice->high : box_.high[k];
            const TaylorModel outer = TaylorModel::variable(static_cast<int>(k), low, high),
                              inner = TaylorModel::variable(static_cast<int>(k), box.low[k], box.high[k]);
            if (!(outer.slopes[k] > 0)) continue;
            const double middle = k == driver ? at : inner.center;
            for (TaylorModel& x : known.linear) {
                x.center += x.slopes[k] * ((middle - outer.center) / outer.slopes[k]);
                x.slopes[k] *= k == driver ? 0 : inner.slopes[k] / outer.slopes[k];
            }
        }
        const auto found = enclosed_loop(models.loops[loop], positions, middles_of(known));
        if (!found || !is_same_branch(known, fixed_at(*found, driver, 0))) return false;
        const std::vector<TaylorModel> solved = found->positions();
        for (std::size_t i = 0; i < solved.size(); ++i) positions[static_cast<std::size_t>(program_->loops[loop].unknowns[i])] = solved[i];
    }
    return true;
}

std::optional<std::vector<double>> TolerancedProver::dependents_at(const VariableBox::Values& at) {
    if (program_->loops.empty()) return std::vector<double>{};
    const PlacedPair found = placed({at, at});
    if (!found.is_known) return std::nullopt;
    std::vector<double> out;
    for (std::size_t k = static_cast<std::size_t>(first_deviation_); k < found.positions.size(); ++k)
        out.push_back(found.positions[k].center);
    return out;
}

std::shared_ptr<const ModelledPair> TolerancedProver::models(const VariableBox& box) {
    std::vector<double> key;
    for (int k = first_deviation_; k < count_; ++k) {
        const auto i = static_cast<std::size_t>(k);
        key.push_back(box.low[i]);
        key.push_back(box.high[i]);
    }
    bool is_point = true;
    for (std::size_t i = 0; i + 1 < key.size(); i += 2) is_point = is_point && key[i] == key[i + 1];
    // Made of given dimensions the bodies have no rest but rounding, and are hardly ever asked for again.
    if (is_point && !key.empty()) return evaluated(box);
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    const auto found = whole_ && whole_rest_ <= fine_rest * size_ ? restricted(*whole_, box_, box) : evaluated(box);
    if (known_.size() > most_models_kept) known_.clear();
    return known_[key] = found;
}

std::shared_ptr<const ModelledPair> TolerancedProver::evaluated(const VariableBox& box) const {
    std::vector<TaylorModel> inputs;
    for (int k = first_deviation_; k < count_; ++k)
        inputs.push_back(TaylorModel::variable(k, box.low[static_cast<std::size_t>(k)], box.high[static_cast<std::size_t>(k)]));
    const std::vector<TaylorModel> values = expression::values<TaylorModel>(program_->nodes, inputs);
    const auto point = [&](const NodePoint& nodes) { return Model3{values[nodes[0]], values[nodes[1]], values[nodes[2]]}; };
    const auto made = std::make_shared<ModelledPair>();
    const auto line_of = [&](const std::vector<Program::Link>& line, std::vector<ChainLink>& out) {
        for (const Program::Link& from : line) {
            ChainLink& link = out.emplace_back();
            for (const Program::Screw& s : from.screws)
                link.screws.push_back({s.position, point(s.point), point(s.axis), s.turn, s.slide, s.start});
            link.rotation = {point(from.rotation[0]), point(from.rotation[1]), point(from.rotation[2])};
            link.place = point(from.place);
        }
    };
    line_of(program_->line_a, made->line_a);
    line_of(program_->line_b, made->line_b);
    for (const Program::Loop& from : program_->loops) {
        ModelledLoop& loop = made->loops.emplace_back();
        loop.unknowns = from.unknowns;
        loop.rows = from.rows;
        loop.size = from.size;
        for (const Program::Closure& c : from.closures) {
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
    vertices(program_->a, *program_->mesh_a, made->a);
    vertices(program_->b, *program_->mesh_b, made->b);
    return made;
}

PlacedPair TolerancedProver::placed(const VariableBox& box) {
    PlacedPair out;
    out.models = models(box);
    out.positions = variables_over(box);
    out.is_known = loop_fault_.empty() && enclose_loops(box, *out.models, out.positions);
    if (!out.is_known) return out;
    const ModelPose a = pose_along(out.models->line_a, out.positions), b = pose_along(out.models->line_b, out.positions);
    out.rotation = product(transposed(b.rotation), a.rotation);
    out.place = transposed_times(b.rotation, a.place - b.place);
    return out;
}

double TolerancedProver::least_along(const PlacedPair& at, const Vector3& n, std::span<const int> a, std::span<const int> b) {
    if (!at.is_known) return -no_bound;
    const ModelMatrix columns = transposed(at.rotation);
    const Model3 f{along(n, columns[0]), along(n, columns[1]), along(n, columns[2])};
    const TaylorModel offset = along(n, at.place);
    ValueReach of_a, of_b;
    for (const int v : a) of_a.values.push_back(dot(f, at.models->a[v]) + offset);
    for (const int v : b) of_b.values.push_back(along(n, at.models->b[v]));
    const double least = a.size() * b.size() <= most_pairs ? least_of_pairs(of_a, of_b) : least_of_pieces(of_a, of_b);
    return std::isnan(least) ? -no_bound : least;
}

double TolerancedProver::least_turning(const PlacedPair& at, const Model3& n, std::span<const int> a, std::span<const int> b) {
    if (!at.is_known || a.size() * b.size() > most_pairs) return -no_bound;
    const Interval length = dot(n, n).interval();
    double least = no_bound;
    for (const int v : a) {
        const Model3 x = times(at.rotation, at.models->a[v]) + at.place;
        for (const int w : b) {
            const double low = dot(n, x - at.models->b[w]).interval().low;
            if (!(low >= least)) least = low;  // also what is no number
        }
    }
    if (!(least > 0) || !(length.high < 1e12)) return -no_bound;
    return geometry::lower(least / geometry::upper(std::sqrt(length.high)));
}

Model3 turning_vector(std::span<const Vector3> vectors) {
    Model3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        out[i].center = vectors[0][row];
        for (std::size_t k = 1; k < vectors.size(); ++k) out[i].slopes[k - 1] = vectors[k][row];
    }
    return out;
}

long TolerancedProver::prove(const Region& a, const Region& b, const VariableBox& box, char kind, std::span<const Vector3> normals,
                             double lower) {
    const std::size_t wanted_vectors = kind == still_leaf ? 1 : 1 + static_cast<std::size_t>(count_);
    if (normals.size() != wanted_vectors) return 0;
    for (const Vector3& normal : normals)
        if (!normal.allFinite() || !(normal.norm() < 1e6)) return 0;
    if (!(normals[0].norm() > 1e-6)) return 0;
    const PlacedPair at = placed(box);
    const std::vector<int> of_a = vertices_of(a), of_b = vertices_of(b);
    if (kind == turning_leaf) return least_turning(at, turning_vector(normals), of_a, of_b) >= lower ? 1 : 0;
    const double length = norm_bound(Interval3{normals[0][0], normals[0][1], normals[0][2]});
    return least_along(at, normals[0], of_a, of_b) >= (Interval(lower) * Interval(length)).high ? 1 : 0;
}

std::optional<Interval> TolerancedProver::distance_at(const geometry::Mesh& mesh_a, const CertifiedPoint& a, const geometry::Mesh& mesh_b,
                                                      const CertifiedPoint& b, const VariableBox::Values& at) {
    const PlacedPair placed_pair = placed({at, at});
    if (!placed_pair.is_known) return Interval{0, no_bound};
    Interval3 X_a, X_b;
    const auto of_a = [&](int v) { return intervals(placed_pair.models->a[v]); };
    const auto of_b = [&](int v) { return intervals(placed_pair.models->b[v]); };
    if (!point_of(mesh_a, a, of_a, X_a) || !point_of(mesh_b, b, of_b, X_b)) return std::nullopt;
    Interval squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        Interval x = placed_pair.place[i].interval() - X_b[i];
        for (std::size_t j = 0; j < 3; ++j) x = x + placed_pair.rotation[i][j].interval() * X_a[j];
        if (!std::isfinite(x.low) || !std::isfinite(x.high)) return Interval{0, no_bound};
        squares = squares + square(x);
    }
    return sqrt(squares);
}

double TolerancedProver::mismatch_at_base(const kinematics::Pose& pose_a, const kinematics::Pose& pose_b, const Matrix3X& a,
                                          const Matrix3X& b) {
    const PlacedPair at = placed(base_);
    if (!at.is_known) return no_bound;
    const auto distance = [](const Model3& x, const Vector3& y) { return norm_bound(intervals(x - exact_model(y))); };
    double of_a = 0, of_b = 0, radius = 0;
    for (Eigen::Index v = 0; v < a.cols(); ++v) {
        of_a = std::max(of_a, distance(at.models->a[static_cast<std::size_t>(v)], a.col(v)));
        radius = std::max(radius, a.col(v).norm());
    }
    for (Eigen::Index v = 0; v < b.cols(); ++v) of_b = std::max(of_b, distance(at.models->b[static_cast<std::size_t>(v)], b.col(v)));
    const Matrix3 rotation = pose_b.rotation.transpose() * pose_a.rotation;
    const Vector3 place = pose_b.rotation.transpose() * (pose_a.position - pose_b.position);
    double turned = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        turned += distance(at.rotation[i], rotation.row(row).transpose());
    }
    const double sum = of_a + of_b + turned * radius * 1.001 + distance(at.place, place);
    // The products of doubles above are off by less than this.
    return sum * (1 + 1e-12) + 1e-14 * (radius + pose_a.position.norm() + pose_b.position.norm());
}

double TolerancedProver::witness_room(const Interval3&, const Interval3&) {
    const PlacedPair at = placed(base_);
    return 1e-11 * (size_ + norm_bound(intervals(at.place))) * (1 + norm_bound(intervals(at.place))) + 1e-300;
}

}  // namespace fettle::core::certificate
