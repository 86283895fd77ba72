// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/certificate/toleranced.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using expression::Node;
using expression::Operation;
using files::JsonNode;
using files::JsonWriter;

int operands_written(Operation operation) { return operation == Operation::input ? 1 : expression::operand_count(operation); }

void write_nodes(JsonWriter& out, const expression::Nodes& nodes) {
    std::string operations;
    std::vector<int> operands;
    std::vector<double> numbers;
    for (const Node& node : nodes) {
        operations += (operations.empty() ? "" : " ") + std::string(expression::to_string(node.operation));
        operands.insert(operands.end(), node.operands.begin(), node.operands.begin() + operands_written(node.operation));
        if (node.operation == Operation::constant) numbers.push_back(node.number);
    }
    out.key("operations");
    out.string(operations);
    out.key("operands");
    out.numbers(operands);
    out.key("numbers");
    out.numbers(numbers);
}

void write_body(JsonWriter& out, const TolerancedBody& body) {
    const auto number = [&](std::string_view name, double value) {
        out.key(name);
        out.number(value);
    };
    const auto points = [&](std::string_view name, const auto& list) {
        std::vector<int> flat;
        for (const NodePoint& point : list) flat.insert(flat.end(), point.begin(), point.end());
        out.key(name);
        out.numbers(flat);
    };
    out.text += '{';
    number("parent", body.parent);
    out.key("screws");
    out.list(body.screws.size(), ", ", [&](std::size_t i) {
        const TolerancedScrew& screw = body.screws[i];
        out.text += '{';
        number("coordinate", screw.coordinate);
        points("point", std::vector<NodePoint>{screw.point});
        points("axis", std::vector<NodePoint>{screw.axis});
        if (screw.driven) {
            out.key("driven");
            out.text += '{';
            number("scale", screw.driven->scale);
            number("shift", screw.driven->shift);
        }
        number("turn", screw.turn);
        number("slide", screw.slide);
        out.text += screw.driven ? "}}" : "}";
    });
    points("rotation", body.rotation);
    points("place", std::vector<NodePoint>{body.place});
    points("vertices", body.vertices);
    out.text += '}';
}

constexpr std::string_view closure_points[] = {"point_a", "axis_a", "point_b", "axis_b"};
std::array<NodePoint TolerancedClosure::*, 4> closure_members() {
    return {&TolerancedClosure::point_a, &TolerancedClosure::axis_a, &TolerancedClosure::point_b, &TolerancedClosure::axis_b};
}

void write_loop(JsonWriter& out, const TolerancedLoop& loop) {
    const auto number = [&](std::string_view name, double value) {
        out.key(name);
        out.number(value);
    };
    out.text += '{';
    out.key("closures");
    out.list(loop.closures.size(), ", ", [&](std::size_t i) {
        out.text += '{';
        number("a", loop.closures[i].a);
        number("b", loop.closures[i].b);
        for (std::size_t k = 0; k < 4; ++k) {
            out.key(closure_points[k]);
            out.numbers(loop.closures[i].*closure_members()[k]);
        }
        out.text += '}';
    });
    out.key("unknowns");
    out.numbers(loop.unknowns);
    out.key("rows");
    out.numbers(loop.rows);
    number("size", loop.size);
    out.text += '}';
}

double number_of(const JsonNode& node) { return node.number().value_or(0); }

std::vector<int> node_numbers_of(const JsonNode& node) {
    std::vector<int> out;
    for (const double x : node.numbers().value_or(std::vector<double>{})) {
        if (x != std::floor(x) || std::abs(x) > 1e9) {
            node.fail(ErrorCode::out_of_range, "whole numbers are expected");
            return {};
        }
        out.push_back(static_cast<int>(x));
    }
    return out;
}

expression::Nodes read_nodes(const JsonNode& node) {
    const std::string text = node.require("operations").string().value_or("");
    const std::vector<int> operands = node_numbers_of(node.require("operands"));
    const std::vector<double> numbers = node.require("numbers").numbers().value_or(std::vector<double>{});
    expression::Nodes out;
    std::size_t operand = 0, number = 0;
    const auto fail = [&](const char* key, const std::string& message) {
        node[key].fail(ErrorCode::inconsistent, message);
        return expression::Nodes{};
    };
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        const std::string_view name = std::string_view(text).substr(from, to - from);
        from = to + 1;
        const auto operation = expression::operation_of(name);
        if (!operation) return fail("operations", "there is no operation `" + std::string(name) + "`");
        Node& made = out.emplace_back();
        made.operation = *operation;
        const auto count = static_cast<std::size_t>(operands_written(*operation));
        if (operand + count > operands.size()) return fail("operands", "some are missing");
        std::copy_n(operands.begin() + static_cast<std::ptrdiff_t>(operand), count, made.operands.begin());
        operand += count;
        if (*operation != Operation::constant) continue;
        if (number == numbers.size()) return fail("numbers", "some are missing");
        made.number = numbers[number++];
    }
    if (operand != operands.size()) return fail("operands", "there are too many");
    if (number != numbers.size()) return fail("numbers", "there are too many");
    return out;
}

std::vector<NodePoint> read_points(const JsonNode& node) {
    const std::vector<int> flat = node_numbers_of(node);
    if (flat.size() % 3 != 0) node.fail(ErrorCode::inconsistent, "three numbers of nodes per point are expected");
    std::vector<NodePoint> out;
    for (std::size_t i = 0; i + 2 < flat.size(); i += 3) out.push_back({flat[i], flat[i + 1], flat[i + 2]});
    return out;
}

NodePoint read_node_point(const JsonNode& node) {
    const std::vector<NodePoint> points = read_points(node);
    if (points.size() == 1) return points.front();
    node.fail(ErrorCode::inconsistent, "three numbers of nodes are expected");
    return {};
}

TolerancedBody read_body(const JsonNode& node) {
    TolerancedBody out;
    out.parent = node.require("parent").integer(-1).value_or(-1);
    for (const JsonNode& screw : node.require("screws").elements()) {
        const bool is_driven = screw["driven"].exists();
        const JsonNode numbers = is_driven ? screw["driven"] : screw;
        TolerancedScrew& made = out.screws.emplace_back(TolerancedScrew{
            screw.require("coordinate").integer(0).value_or(0), read_node_point(screw.require("point")),
            read_node_point(screw.require("axis")), number_of(numbers.require("turn")), number_of(numbers.require("slide"))});
        if (is_driven) made.driven = {numbers.require("scale").integer(0).value_or(0), numbers.require("shift").integer(0).value_or(0)};
    }
    const std::vector<NodePoint> rotation = read_points(node.require("rotation"));
    if (rotation.size() == 3)
        std::copy(rotation.begin(), rotation.end(), out.rotation.begin());
    else
        node["rotation"].fail(ErrorCode::inconsistent, "three rows are expected");
    out.place = read_node_point(node.require("place"));
    out.vertices = read_points(node.require("vertices"));
    return out;
}

TolerancedLoop read_loop(const JsonNode& node) {
    TolerancedLoop out;
    for (const JsonNode& from : node.require("closures").elements()) {
        TolerancedClosure& closure = out.closures.emplace_back();
        closure.a = from.require("a").integer(-1).value_or(-1);
        closure.b = from.require("b").integer(-1).value_or(-1);
        for (std::size_t k = 0; k < 4; ++k) closure.*closure_members()[k] = read_node_point(from.require(closure_points[k]));
    }
    out.unknowns = node_numbers_of(node.require("unknowns"));
    out.rows = node_numbers_of(node.require("rows"));
    out.size = number_of(node.require("size"));
    return out;
}

}  // namespace

void write_toleranced(JsonWriter& out, const Toleranced& toleranced) {
    out.text += '{';
    out.key("deviations");
    out.list(toleranced.deviations.size(), ",\n ", [&](std::size_t i) {
        const Deviation& d = toleranced.deviations[i];
        out.text += '{';
        out.key("of");
        out.string(d.of);
        for (const auto& [name, value] : {std::pair{"lower", d.lower}, {"upper", d.upper}, {"base", d.base}}) {
            out.key(name);
            out.number(value);
        }
        out.key("unit");
        out.string(d.unit);
        out.text += '}';
    });
    write_nodes(out, toleranced.nodes);
    out.key("coordinates");
    out.list(toleranced.coordinates.size(), ",\n ", [&](std::size_t i) { write_coordinate(out, toleranced.coordinates[i]); });
    out.key("bodies");
    out.list(toleranced.bodies.size(), ",\n ", [&](std::size_t i) { write_body(out, toleranced.bodies[i]); });
    out.key("loops");
    out.list(toleranced.loops.size(), ",\n ", [&](std::size_t i) { write_loop(out, toleranced.loops[i]); });
    out.key("duration");
    out.number(toleranced.duration);
    out.text += '}';
}

Toleranced read_toleranced(const JsonNode& node) {
    Toleranced out;
    node.allow_keys({"deviations", "operations", "operands", "numbers", "coordinates", "bodies", "loops", "duration"});
    for (const JsonNode& d : node.require("deviations").elements())
        out.deviations.push_back({d.require("of").string().value_or(""), number_of(d.require("lower")), number_of(d.require("upper")),
                                  number_of(d.require("base")), d.require("unit").string().value_or("")});
    out.nodes = read_nodes(node);
    for (const JsonNode& c : node.require("coordinates").elements()) out.coordinates.push_back(read_coordinate(c));
    for (const JsonNode& body : node.require("bodies").elements()) out.bodies.push_back(read_body(body));
    for (const JsonNode& loop : node.require("loops").elements()) out.loops.push_back(read_loop(loop));
    out.duration = number_of(node.require("duration"));
    return out;
}

}  // namespace fettle::core::certificate
