// SPDX-License-Identifier: MIT
#include "core/part_files/facet_bound.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/parts/curve_geometry.hpp"

namespace fettle::core::part_files {
namespace {

using base::Dimension;
using base::infinity;
using files::JsonNode;
using parts::Profile;

constexpr double fewest = 4;                  // facets of any solid
constexpr std::size_t most_compared = 2'000;  // boxes, each with each

struct Box {
    Vector3 low = Vector3::Constant(infinity), high = Vector3::Constant(-infinity);

    void add(const Box& b) {
        low = low.cwiseMin(b.low);
        high = high.cwiseMax(b.high);
    }
    bool is_known() const { return low.allFinite() && high.allFinite(); }
    bool meets(const Box& b) const { return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all(); }
};

const Box everywhere{Vector3::Constant(-infinity), Vector3::Constant(infinity)};

struct SolidBound {
    double facets = fewest;  // at least
    Box box = everywhere;
};

Box round_box(double radius, double low, double high) { return {{-radius, -radius, low}, {radius, radius, high}}; }

// With room for rounding.
SolidBound bound(double facets, const Box& box) {
    if (!box.is_known()) return {std::max(fewest, facets), everywhere};
    const Vector3 room = Vector3::Constant(1e-9 * (box.high - box.low).norm());
    return {std::max(fewest, facets), {box.low - room, box.high + room}};
}

// How much farther out flats that touch a circle of `count` segments have their vertices.
double reach(int count) { return 1 / std::cos(std::numbers::pi / std::max(3, count)); }

// `map` takes points to points and keeps straight lines straight.
template <class Map>
Box mapped(const Box& box, const Map& map) {
    if (!box.is_known()) return everywhere;
    Box out;
    for (int corner = 0; corner < 8; ++corner) {
        const auto end = [&](int axis) { return (corner >> axis & 1) != 0 ? box.high[axis] : box.low[axis]; };
        const Vector3 x = map(Vector3(end(0), end(1), end(2)));
        out.add({x, x});
    }
    return out.is_known() ? out : everywhere;
}

Box turned(const Box& box, const Vector3& axis, double angle, const Vector3& about) {
    const Matrix3 rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    return mapped(box, [&](const Vector3& x) -> Vector3 { return about + rotation * (x - about); });
}

Box box_of(const std::vector<SolidBound>& solids) {
    Box out;
    for (const SolidBound& solid : solids) out.add(solid.box);
    return out;
}

// All facets of those that stand apart from all others.
double united_facets(const std::vector<SolidBound>& solids) {
    if (solids.size() > most_compared) return fewest;
    double facets = 0;
    for (const SolidBound& solid : solids) {
        const auto is_met = [&](const SolidBound& other) { return &other != &solid && other.box.meets(solid.box); };
        if (std::none_of(solids.begin(), solids.end(), is_met)) facets += solid.facets;
    }
    return std::max(fewest, facets);
}

// What an outline becomes by its facets.
struct OutlineBound {
    double facets = 0;    // flats in different directions, at least: those between the first and the last of each arc, and lines at corners
    double slanted = 0;   // of these, those that are neither on the axis nor square to it
    double radius = 0;    // of the point farthest from the axis, of those known
    double distance = 0;  // of the point farthest from the origin, of those known
    Box box;              // [m], z is 0
};

bool is_corner(const parts::Segment& before, const parts::Segment& after) {
    const auto* a = std::get_if<parts::Line>(&before.curve);
    const auto* b = std::get_if<parts::Line>(&after.curve);
    if (a == nullptr || b == nullptr) return true;
    const Vector2 u = value(a->end) - value(a->start), v = value(b->end) - value(b->start);
    return std::abs(u.x() * v.y() - u.y() * v.x()) > 1e-6 * u.norm() * v.norm();
}

OutlineBound outline_bound(const Profile& profile, const parts::Facets& of_drawing) {
    OutlineBound out;
    for (const parts::Loop& loop : profile.loops) {
        const parts::Segment* before = &loop.segments.back();
        for (const parts::Segment& segment : loop.segments) {
            const parts::Facets& facets = segment.facets ? *segment.facets : of_drawing;
            const Vector2 start = value(parts::start_of(segment.curve)), end = value(parts::end_of(segment.curve));
            out.radius = std::max(out.radius, std::abs(end.x()));
            out.distance = std::max(out.distance, end.norm());
            const parts::Box2 box = parts::box_of(segment.curve);
            double room = 0;
            if (const auto* arc = std::get_if<parts::Arc>(&segment.curve)) {
                const int count = parts::facet_count(segment.curve, facets);
                const double flats = std::max(0, parts::is_whole_circle(*arc) ? count : count - 1);
                out.facets += flats;
                out.slanted += std::max(0.0, flats - 2);  // two flats of a circle are square to the axis
                room = arc->radius.value * (reach(parts::segments_of(facets, arc->radius.value, 2 * std::numbers::pi)) - 1);
            } else if (std::holds_alternative<parts::Line>(segment.curve) && is_corner(*before, segment)) {
                const double level = 1e-6 * (end - start).norm();
                out.facets += 1;
                if (std::abs(end.y() - start.y()) > level && std::max(std::abs(start.x()), std::abs(end.x())) > level) out.slanted += 1;
            }
            out.box.add({{box.low.x() - room, box.low.y() - room, 0}, {box.high.x() + room, box.high.y() + room, 0}});
            before = &segment;
        }
    }
    return out;
}

double farthest(const Box& outline) {
    return std::hypot(std::max(-outline.low.x(), outline.high.x()), std::max(-outline.low.y(), outline.high.y()));
}

// What is known of solids by name while they are walked through.
struct Walk : Sheet {
    explicit Walk(const Sheet& sheet) : Sheet(sheet) {}
    std::map<std::string, Result<SolidBound>> bounds;
};

class SolidBoundReader : public ShapeReader<SolidBoundReader, SolidBound> {
public:
    SolidBoundReader(PartNumbers& numbers, ProfileReader& profiles, const JsonNode& named)
        : ShapeReader(numbers, named, "solid"), profiles_(profiles) {}

private:
    friend ShapeReader;
    using R = SolidBoundReader;

    static const std::vector<Verb>& verbs() {
        static const std::vector<Verb> all = [] {
            const auto read = [](std::string_view verb) {
                if (verb == "extrude") return &R::extrude;
                if (verb == "stack") return &R::stack;
                if (verb == "revolve") return &R::revolve;
                if (verb == "twist") return &R::twist;
                if (verb == "helix") return &R::helix;
                if (verb == "sphere") return &R::sphere;
                if (verb == "cone") return &R::cone;
                if (verb == "torus") return &R::torus;
                if (verb == "subtract") return &R::subtract;
                if (verb == "union") return &R::unite;
                if (verb == "intersect") return &R::intersect;
                if (verb == "move") return &R::move;
                if (verb == "turn") return &R::turn;
                if (verb == "mirror") return &R::mirror;
                FETTLE_ASSERT(verb == "repeat", "all verbs of solids are listed here");
                return &R::repeat;
            };
            std::vector<Verb> out;
            for (const auto& [verb, keys] : SolidReader::keys()) out.push_back({verb, keys, read(verb)});
            return out;
        }();
        return all;
    }
    // Every sheet that is walked over is a Walk.
    static Result<SolidBound> drawn_once(const std::string& name, const Maker& maker, Sheet& sheet) {
        auto& bounds = static_cast<Walk&>(sheet).bounds;
        const auto known = bounds.find(name);
        if (known != bounds.end()) return known->second;
        Result<SolidBound> made = maker(sheet);
        bounds.emplace(name, made);
        return made;
    }
    static std::optional<Error> fault_of(const SolidBound& solid, const std::string& where) {
        return too_many_facets(solid.facets, "at least ", where);
    }
    static std::optional<Error> fault_of(const std::vector<SolidBound>& solids, const std::string& where) {
        double facets = 0;
        for (const SolidBound& solid : solids) facets += solid.facets;
        return too_many_facets(facets, "at least ", where);
    }

    // The bound of a solid made from an outline; what cannot be drawn is told when it is.
    using OfOutline = std::function<SolidBound(const OutlineBound&, Sheet&)>;
    Maker of_outline(const JsonNode& node, const std::string& name, OfOutline bound_of) {
        return [profile = profiles_.read(node, name), bound_of = std::move(bound_of)](Sheet& sheet) -> Result<SolidBound> {
            const Result<Profile> made = profile(sheet);
            return made && !made->loops.empty() ? bound_of(outline_bound(*made, sheet.drawing.facets), sheet) : SolidBound();
        };
    }

    struct Ends {
        PartNumber both, below, above;
        // A flare reaches beyond the outline, how far depends on its corners.
        bool flares(const Sheet& sheet) const { return both.at(sheet).value < 0 || below.at(sheet).value < 0 || above.at(sheet).value < 0; }
    };
    Ends read_ends(const JsonNode& node) const {
        return {numbers_.length(node["chamfer"]), numbers_.length(node["chamfer_below"]), numbers_.length(node["chamfer_above"])};
    }

    Maker extrude(const JsonNode& node, const std::string& name) {
        return of_outline(node["extrude"], name,
                          [from = numbers_.length(node["from"]), to = numbers_.length(node["to"]), ends = read_ends(node)](
                              const OutlineBound& outline, Sheet& sheet) -> SolidBound {
                              Box box = outline.box;
                              box.low.z() = from.at(sheet).value;
                              box.high.z() = to.at(sheet).value;
                              return bound(2 * outline.facets, ends.flares(sheet) ? everywhere : box);
                          });
    }

    // The layers are flush where they are alike: the one that has most counts.
    Maker stack(const JsonNode& node, const std::string& name) {
        struct Layers {
            Maker one;
            PartNumber height;
            int count = 1;
        };
        std::vector<Layers> all;
        const auto add = [&](const JsonNode& layer, int count) {
            const auto of_layer = [ends = read_ends(layer)](const OutlineBound& outline, Sheet& sheet) -> SolidBound {
                return bound(2 * outline.facets, ends.flares(sheet) ? everywhere : outline.box);
            };
            all.push_back({of_outline(layer["layer"], name, of_layer), numbers_.length(layer["height"]), count});
        };
        for (const JsonNode& element : node["stack"].objects()) {
            if (!element["repeat"].exists()) add(element, 1);
            for (const JsonNode& layer : element["repeat"].objects()) add(layer, numbers_.count(element["count"], 0, 1000).value_or(0));
        }
        return [all, from = numbers_.length(node["from"])](Sheet& sheet) -> Result<SolidBound> {
            SolidBound out{fewest, {}};
            double height = 0;
            for (const Layers& layers : all) {
                const Result<SolidBound> made = layers.one(sheet);
                if (!made) return made;
                if (layers.count > 0) out.facets = std::max(out.facets, made->facets);
                out.box.add(made->box);
                height += layers.count * std::abs(layers.height.at(sheet).value);
            }
            out.box.low.z() = from.at(sheet).value;
            out.box.high.z() = out.box.low.z() + height;
            return bound(out.facets, out.box);
        };
    }

    Maker revolve(const JsonNode& node, const std::string& name) {
        const bool is_part = node["angle"].exists();
        return of_outline(node["revolve"], name,
                          [is_part, angle = numbers_.angle(node["angle"])](const OutlineBound& outline, Sheet& sheet) -> SolidBound {
                              const double sweep = is_part ? angle.at(sheet).value : 2 * std::numbers::pi;
                              const int segments = parts::segments_of(sheet.drawing.facets, outline.radius, sweep);
                              const int whole = parts::segments_of(sheet.drawing.facets, outline.radius, 2 * std::numbers::pi);
                              const double radius = std::max(-outline.box.low.x(), outline.box.high.x()) * reach(whole);
                              return bound(outline.slanted * segments, round_box(radius, outline.box.low.y(), outline.box.high.y()));
                          });
    }

    static double steps(double turns, double radius, const Sheet& sheet) {
        constexpr double most_turns = 1000;  // that are drawn
        return std::ceil(std::min(std::abs(turns), most_turns) * parts::segments_of(sheet.drawing.facets, radius, 2 * std::numbers::pi) -
                         1e-9);
    }

    Maker twist(const JsonNode& node, const std::string& name) {
        return of_outline(
            node["twist"], name,
            [from = numbers_.length(node["from"]), to = numbers_.length(node["to"]), by = numbers_.angle(node["by"])](
                const OutlineBound& outline, Sheet& sheet) -> SolidBound {
                const double count = std::max(1.0, steps(by.at(sheet).value / (2 * std::numbers::pi), outline.distance, sheet));
                return bound(count * outline.facets, round_box(2 * farthest(outline.box), from.at(sheet).value, to.at(sheet).value));
            });
    }

    Maker helix(const JsonNode& node, const std::string& name) {
        return of_outline(
            node["helix"], name,
            [turns = numbers_.number(node["turns"], Dimension::number)](const OutlineBound& outline, Sheet& sheet) -> SolidBound {
                return {std::max(fewest, outline.facets * steps(turns.at(sheet).value, outline.radius, sheet)), everywhere};
            });
    }

    Maker sphere(const JsonNode& node, const std::string&) {
        return [radius = numbers_.length(node["sphere"])](Sheet& sheet) -> Result<SolidBound> {
            const double r = radius.at(sheet).value;
            const int around = parts::segments_of(sheet.drawing.facets, r, 2 * std::numbers::pi),
                      up = parts::segments_of(sheet.drawing.facets, r, std::numbers::pi);
            const double out = r * reach(around) * reach(2 * up);
            return bound(static_cast<double>(around) * (up - 1), round_box(out, -out, out));
        };
    }

    Maker cone(const JsonNode& node, const std::string&) {
        return [radii = read_point(node["cone"], numbers_), height = numbers_.length(node["height"])](Sheet& sheet) -> Result<SolidBound> {
            const parts::Point2 r = radii.at(sheet);
            const double radius = std::max(r.x.value, r.y.value);
            const int around = parts::segments_of(sheet.drawing.facets, radius, 2 * std::numbers::pi);
            return bound(around, round_box(radius * reach(around), 0, height.at(sheet).value));
        };
    }

    Maker torus(const JsonNode& node, const std::string&) {
        return [radii = read_point(node["torus"], numbers_)](Sheet& sheet) -> Result<SolidBound> {
            const parts::Point2 r = radii.at(sheet);
            const int along = parts::segments_of(sheet.drawing.facets, r.x.value + r.y.value, 2 * std::numbers::pi),
                      across = parts::segments_of(sheet.drawing.facets, r.y.value, 2 * std::numbers::pi);
            const double tube = r.y.value * reach(across);
            return bound(static_cast<double>(along) * (across - 2), round_box((r.x.value + tube) * reach(along), -tube, tube));
        };
    }

    Maker subtract(const JsonNode& node, const std::string& name) {
        return [from = read(node["from"], name), list = read_list(node["subtract"], name)](Sheet& sheet) -> Result<SolidBound> {
            const Result<SolidBound> whole = from(sheet);
            if (!whole) return whole;
            const Result<std::vector<SolidBound>> cut = list(sheet);
            if (!cut) return cut.errors();
            const bool is_met = std::any_of(cut->begin(), cut->end(), [&](const SolidBound& each) { return each.box.meets(whole->box); });
            return SolidBound{is_met ? fewest : whole->facets, whole->box};
        };
    }

    Maker unite(const JsonNode& node, const std::string& name) { return united(read_list(node["union"], name)); }
    Maker repeat(const JsonNode& node, const std::string& name) { return united(repeated(node, name)); }
    static Maker united(const ListMaker& list) {
        return [list](Sheet& sheet) -> Result<SolidBound> {
            const Result<std::vector<SolidBound>> made = list(sheet);
            if (!made) return made.errors();
            return SolidBound{united_facets(*made), box_of(*made)};
        };
    }

    Maker intersect(const JsonNode& node, const std::string& name) {
        return [list = read_list(node["intersect"], name)](Sheet& sheet) -> Result<SolidBound> {
            const Result<std::vector<SolidBound>> made = list(sheet);
            if (!made) return made.errors();
            return made->empty() ? SolidBound() : SolidBound{fewest, made->front().box};
        };
    }

    Maker move(const JsonNode& node, const std::string& name) {
        return [what = read(node["move"], name), by = read_point3(node["by"], numbers_)](Sheet& sheet) -> Result<SolidBound> {
            const Result<SolidBound> made = what(sheet);
            if (!made) return made;
            const Vector3 shift = value(by.at(sheet));
            return SolidBound{made->facets, mapped(made->box, [&](const Vector3& x) -> Vector3 { return x + shift; })};
        };
    }

    PartPoint3 read_axis(const JsonNode& node) const {
        PartPoint3 axis = read_point3(node["axis"], numbers_, Dimension::number);
        if (!node["axis"].exists()) axis.z.formula = expression::constant_formula(1);
        return axis;
    }

    Maker turn(const JsonNode& node, const std::string& name) {
        return [what = read(node["turn"], name), by = numbers_.angle(node["by"]), axis = read_axis(node),
                about = read_point3(node["about"], numbers_)](Sheet& sheet) -> Result<SolidBound> {
            const Result<SolidBound> made = what(sheet);
            if (!made) return made;
            return SolidBound{made->facets, turned(made->box, value(axis.at(sheet)), by.at(sheet).value, value(about.at(sheet)))};
        };
    }

    Maker mirror(const JsonNode& node, const std::string& name) {
        const std::string plane = node["across"].string().value_or("xy");
        const Eigen::Index normal = plane == "xy" ? 2 : plane == "yz" ? 0 : 1;
        return [what = read(node["mirror"], name), normal](Sheet& sheet) -> Result<SolidBound> {
            Result<SolidBound> made = what(sheet);
            if (!made) return made;
            std::swap(made->box.low[normal], made->box.high[normal]);
            made->box.low[normal] *= -1;
            made->box.high[normal] *= -1;
            return made;
        };
    }

    ListMaker repeated(const JsonNode& node, const std::string& name) {
        const Maker what = read(node["repeat"], name);
        const int count = numbers_.count(node["count"], 0, base::most_copies).value_or(0);
        const bool is_linear = node["step"].exists(), is_full_turn = !node["every"].exists();
        const PartPoint3 step = read_point3(node["step"], numbers_), about = read_point3(node["about"], numbers_), axis = read_axis(node);
        const PartNumber every = numbers_.angle(node["every"]);
        return [=, where = node.where()](Sheet& sheet) -> Result<std::vector<SolidBound>> {
            if (count == 0) return std::vector<SolidBound>();
            const Result<SolidBound> made = what(sheet);
            if (!made) return made.errors();
            if (auto error = too_many_facets(count * made->facets, "at least ", where)) return *std::move(error);
            const Vector3 shift = value(step.at(sheet)), line = value(axis.at(sheet)), centre = value(about.at(sheet));
            const double angle = is_full_turn ? 2 * std::numbers::pi / count : every.at(sheet).value;
            std::vector<SolidBound> out(count, *made);
            for (int k = 1; k < count; ++k)
                out[k].box = is_linear ? mapped(made->box, [&](const Vector3& x) -> Vector3 { return x + k * shift; })
                                       : turned(made->box, line, k * angle, centre);
            return out;
        };
    }

    ProfileReader& profiles_;
};

}  // namespace

FacetBound read_facet_bound(PartNumbers& numbers, ProfileReader& profiles, const JsonNode& named, const JsonNode& solid) {
    SolidBoundReader reader(numbers, profiles, named);
    reader.read_named();
    return [bound_of = reader.read(solid, {}), makers = reader.named_makers()](const Sheet& sheet) -> Result<double> {
        Walk walk(sheet);
        const Result<SolidBound> made = bound_of(walk);
        if (made) return made->facets;
        if (made.errors().front().code == base::ErrorCode::out_of_range) return made.errors();
        return 0.0;
    };
}

}  // namespace fettle::core::part_files
