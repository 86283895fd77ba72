// SPDX-License-Identifier: MIT
#include "core/scene/place.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/contract.hpp"
#include "core/files/nearest_word.hpp"
#include "core/scene/joint_kind.hpp"

namespace fettle::core::scene {
namespace {

using base::Dimension;
using base::Error;
using base::ErrorCode;

enum class List { scene, body, joint, spring, motor, load, pair };

struct ListName {
    List list;
    std::string_view path, what;
};
constexpr ListName list_names[] = {{List::body, "bodies", "body"},
                                   {List::joint, "joints", "joint"},
                                   {List::spring, "springs", "spring"},
                                   {List::spring, "dampers", "damper"},
                                   {List::motor, "motors", "motor"},
                                   {List::load, "loads", "load"},
                                   {List::pair, "friction/pairs", "pair of materials"}};

// One of a scene's bodies, joints, ...
struct Item {
    Scene& scene;
    List list = List::scene;
    std::size_t number = 0;

    Body& body() const { return scene.bodies[number]; }
    Joint& joint() const { return scene.mechanism.joints[number]; }
    Spring& spring() const { return scene.mechanism.springs[number]; }
    Motor& motor() const { return scene.mechanism.motors[number]; }
    PointLoad& load() const { return scene.mechanism.loads[number]; }
    bool is_joint() const { return list == List::joint; }
    Attachment& a() const { return is_joint() ? joint().a : spring().a; }
    Attachment& b() const { return is_joint() ? joint().b : spring().b; }
    CoordinateForces& forces() const { return is_joint() ? joint().forces : spring().forces; }

    // f(the list).
    template <class F>
    auto in_list(const F& f) const {
        const Mechanism& mechanism = scene.mechanism;
        if (list == List::body) return f(scene.bodies);
        if (list == List::joint) return f(mechanism.joints);
        if (list == List::spring) return f(mechanism.springs);
        return list == List::motor ? f(mechanism.motors) : f(mechanism.loads);
    }
    std::size_t count() const {
        if (list == List::pair) return scene.friction.pairs.size();
        return list == List::scene ? 1 : in_list([](const auto& items) { return items.size(); });
    }
    std::string name() const {
        if (list == List::pair || list == List::scene) return {};
        return in_list([this](const auto& items) { return items[number].name; });
    }

    // For messages.
    std::string shown() const {
        if (list == List::scene) return "the scene";
        if (list == List::pair) return "pair " + std::to_string(number) + " of materials";
        return (list == List::body ? "body `" : "`") + name() + "`";
    }

    bool is_damper() const { return list == List::spring && !(forces().stiffness > 0) && !forces().limits; }

    // Is the coordinate that it is, or acts along, an angle?
    bool is_angle() const {
        if (is_joint()) return kind_has("angle");
        if (list != List::spring && list != List::motor) return false;
        const std::string& name = list == List::spring ? spring().joint : motor().joint;
        const std::vector<Joint>& joints = scene.mechanism.joints;
        for (std::size_t k = 0; k < joints.size(); ++k)
            if (joints[k].name == name) return Item{scene, List::joint, k}.is_angle();
        return false;
    }
    bool kind_has(std::string_view coordinate) const {
        return joint_kinds()[static_cast<std::size_t>(joint().kind)].coordinate == coordinate;
    }
    bool couples() const { return joint().kind == JointKind::gear || joint().kind == JointKind::rack; }

    // What a motor's file calls its curve.
    std::string_view curve_name() const {
        const bool is_effort = motor().kind == MotorKind::effort;
        if (is_angle()) return is_effort ? "torque" : "angle";
        return is_effort ? "force" : "travel";
    }
};

// Where an item's numbers of one kind are.
using Numbers = std::variant<std::monostate, double*, std::optional<double>*, Vector3*, std::array<double, 2>*, std::vector<double>*,
                             std::map<std::string, double>*>;

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::size_t entries_of(const Numbers& numbers) {
    return std::visit(Overloaded{[](std::monostate) { return std::size_t{0}; }, [](double*) { return std::size_t{1}; },
                                 [](std::optional<double>*) { return std::size_t{1}; },
                                 [](auto* list) { return static_cast<std::size_t>(list->size()); }},
                      numbers);
}

double& entry_of(const Numbers& numbers, std::size_t k) {
    FETTLE_ASSERT(k < entries_of(numbers), "the scene has the place");
    return *std::visit(
        Overloaded{[](std::monostate) -> double* { return nullptr; }, [](double* number) { return number; },
                   [](std::optional<double>* number) { return *number ? &**number : &number->emplace(0); },
                   [&](std::map<std::string, double>* map) { return &std::next(map->begin(), static_cast<std::ptrdiff_t>(k))->second; },
                   [&](Vector3* vector) { return vector->data() + k; }, [&](auto* list) { return list->data() + k; }},
        numbers);
}

std::string entry_name(const Numbers& numbers, std::size_t k) {
    if (const auto* map = std::get_if<std::map<std::string, double>*>(&numbers))
        return escaped(std::next((*map)->begin(), static_cast<std::ptrdiff_t>(k))->first);
    return std::to_string(k);
}

enum class Range { any, not_negative, positive, not_zero, in_order, some_force };

struct Row {
    List list;
    std::string_view key;  // below its item; * stands for the entry
    PlaceKind kind;
    Numbers (*numbers)(const Item&);
    Dimension (*dimension)(const Item&);
    const char* (*misfit)(const Item&) = nullptr;  // why the item has none; null: it has
    Range range = Range::any;
};

template <Dimension of_length, Dimension of_angle = of_length>
Dimension is(const Item& item) {
    if constexpr (of_length == of_angle) return of_length;
    return item.is_angle() ? of_angle : of_length;
}

template <auto member>
Numbers of_body(const Item& item) {
    return &(item.body().*member);
}
template <auto member>
Numbers of_forces(const Item& item) {
    return &(item.forces().*member);
}

template <int dof>
Numbers rate_of(const Item& item) {
    auto& curve = item.body().prescribed[dof];
    return curve ? Numbers(&curve->rate) : Numbers();
}
template <int dof>
const char* has_no_rate(const Item& item) {
    return item.body().prescribed[dof] ? nullptr : "has no motor on that coordinate; give it one in the scene, under `prescribed`";
}

template <Orientation::Kind kind>
Numbers orientation_of(const Item& item) {
    Orientation& orientation = item.body().orientation;
    return orientation.kind == kind ? Numbers(&orientation.numbers) : Numbers();
}
template <Orientation::Kind kind>
const char* has_no_orientation(const Item& item) {
    const Body& body = item.body();
    if (body.orientation.kind != kind) return kind == Orientation::Kind::angles ? "is turned by a rotation vector" : "is turned by angles";
    constexpr double rounding = 1e-12;
    const bool is_its_own = body.turn.isZero(0) && (rotation_of(body.orientation) - body.pose.rotation).cwiseAbs().maxCoeff() > rounding;
    return is_its_own ? "has a rotation that was made otherwise; a `turn` can be moved" : nullptr;
}

const char* has_no_density(const Item& item) {
    return item.body().inertial ? "has a mass that is given (`inertial`), and follows no density" : nullptr;
}
const char* has_no_point(const Item& item) {
    const bool none = item.is_joint() ? item.couples() : !item.spring().joint.empty();
    return none ? "has no point of its own" : nullptr;
}
const char* has_no_axis(const Item& item) {
    const bool has_none = item.couples() || (item.joint().kind == JointKind::ball && !item.joint().swing);
    return has_none ? "has no axis of its own" : nullptr;
}
const char* has_no_swing(const Item& item) { return item.joint().swing ? nullptr : "has no `swing` in the scene"; }
const char* has_no_coordinate(const Item& item) {
    return item.is_joint() && item.kind_has("") ? "has no coordinate for a force to act along" : nullptr;
}
const char* has_no_spring(const Item& item) {
    if (const char* reason = has_no_coordinate(item)) return reason;
    return item.forces().stiffness > 0 ? nullptr : "has no spring: a `stiffness` greater than 0 is expected in the scene";
}
const char* has_no_rest(const Item& item) {
    if (const char* reason = has_no_spring(item)) return reason;
    return item.forces().preload != 0 ? "has a `preload`, from which its rest follows" : nullptr;
}
const char* has_no_preload(const Item& item) {
    if (const char* reason = has_no_spring(item)) return reason;
    return item.forces().rest ? "has a `rest`, from which its preload follows" : nullptr;
}
const char* has_no_damping(const Item& item) {
    if (const char* reason = has_no_coordinate(item)) return reason;
    return item.forces().damping > 0 ? nullptr : "has no `damping` greater than 0 in the scene";
}
const char* has_no_friction(const Item& item) {
    if (const char* reason = has_no_coordinate(item)) return reason;
    return item.forces().friction > 0 ? nullptr : "has no `friction` greater than 0 in the scene";
}
const char* has_no_limits(const Item& item) {
    if (const char* reason = has_no_coordinate(item)) return reason;
    return item.forces().limits ? nullptr : "has no `limits` in the scene";
}
template <JointKind kind>
const char* is_none(const Item& item) {
    if (item.joint().kind == kind) return nullptr;
    return kind == JointKind::screw ? "is not a screw" : kind == JointKind::gear ? "is not a gear" : "is not a rack";
}

std::vector<Row> make_table() {
    using enum Dimension;
    std::vector<Row> rows{
        {List::scene, "gravity/*", PlaceKind::gravity, [](const Item& i) -> Numbers { return &i.scene.gravity; }, is<acceleration>},
        {List::scene, "contact/dmin", PlaceKind::minimum_separation, [](const Item& i) -> Numbers { return &i.scene.dmin; }, is<length>,
         nullptr, Range::not_negative},
        {List::scene, "friction/mu", PlaceKind::friction, [](const Item& i) -> Numbers { return &i.scene.friction.mu; }, is<number>,
         nullptr, Range::positive},
        {List::scene, "materials/*/mu", PlaceKind::friction, [](const Item& i) -> Numbers { return &i.scene.friction.materials; },
         is<number>, nullptr, Range::positive},
        {List::pair, "mu", PlaceKind::friction, [](const Item& i) -> Numbers { return &i.scene.friction.pairs[i.number].mu; }, is<number>,
         nullptr, Range::positive},
        {List::body, "shape/dimensions/*", PlaceKind::shape_dimension,
         [](const Item& i) { return i.body().shape ? Numbers(&i.body().shape->dimensions) : Numbers(); }, is<length>},
        {List::body, "position/*", PlaceKind::position, [](const Item& i) -> Numbers { return &i.body().pose.position; }, is<length>},
        {List::body, "rotation/*", PlaceKind::rotation, orientation_of<Orientation::Kind::angles>, is<angle>,
         has_no_orientation<Orientation::Kind::angles>},
        {List::body, "rotation_vector/*", PlaceKind::rotation, orientation_of<Orientation::Kind::vector>, is<angle>,
         has_no_orientation<Orientation::Kind::vector>},
        {List::body, "turn/*", PlaceKind::rotation, of_body<&Body::turn>, is<angle>},
        {List::body, "density", PlaceKind::density, of_body<&Body::density>,
         [](const Item& i) { return i.body().mass_kind == MassKind::volume ? density : number; }, has_no_density},
        {List::body, "linear_velocity/*", PlaceKind::start_velocity, of_body<&Body::linear_velocity>, is<speed>},
        {List::body, "angular_velocity/*", PlaceKind::start_velocity, of_body<&Body::angular_velocity>, is<angular_speed>},
        {List::body, "force/*", PlaceKind::body_load, of_body<&Body::force>, is<force>},
        {List::body, "torque/*", PlaceKind::body_load, of_body<&Body::torque>, is<torque>},
        {List::body, "mu", PlaceKind::friction, of_body<&Body::mu>, is<number>, nullptr, Range::positive},
        {List::body, "prescribed/px/rate", PlaceKind::prescribed_rate, rate_of<0>, is<speed>, has_no_rate<0>},
        {List::body, "prescribed/py/rate", PlaceKind::prescribed_rate, rate_of<1>, is<speed>, has_no_rate<1>},
        {List::body, "prescribed/pz/rate", PlaceKind::prescribed_rate, rate_of<2>, is<speed>, has_no_rate<2>},
        {List::body, "prescribed/rx/rate", PlaceKind::prescribed_rate, rate_of<3>, is<angular_speed>, has_no_rate<3>},
        {List::body, "prescribed/ry/rate", PlaceKind::prescribed_rate, rate_of<4>, is<angular_speed>, has_no_rate<4>},
        {List::body, "prescribed/rz/rate", PlaceKind::prescribed_rate, rate_of<5>, is<angular_speed>, has_no_rate<5>},
        {List::joint, "axis_a/*", PlaceKind::joint_axis, [](const Item& i) -> Numbers { return &i.a().axis; }, is<number>, has_no_axis},
        {List::joint, "axis_b/*", PlaceKind::joint_axis, [](const Item& i) -> Numbers { return &i.b().axis; }, is<number>, has_no_axis},
        {List::joint, "pitch", PlaceKind::pitch, [](const Item& i) -> Numbers { return &i.joint().pitch; }, is<length>,
         is_none<JointKind::screw>},
        {List::joint, "swing", PlaceKind::joint_limits,
         [](const Item& i) { return i.joint().swing ? Numbers(&*i.joint().swing) : Numbers(); }, is<angle>, has_no_swing, Range::positive},
        {List::joint, "ratio", PlaceKind::ratio, [](const Item& i) -> Numbers { return &i.joint().ratio; }, is<number>,
         is_none<JointKind::gear>, Range::not_zero},
        {List::joint, "radius", PlaceKind::ratio, [](const Item& i) -> Numbers { return &i.joint().ratio; }, is<length>,
         is_none<JointKind::rack>, Range::not_zero},
        {List::motor, "curve/values/*", PlaceKind::motor_values, [](const Item& i) -> Numbers { return &i.motor().curve.values; },
         [](const Item& i) { return i.motor().kind == MotorKind::effort ? is<force, torque>(i) : is<length, angle>(i); }},
        {List::motor, "curve/rate", PlaceKind::motor_rate, [](const Item& i) -> Numbers { return &i.motor().curve.rate; },
         [](const Item& i) { return i.motor().kind == MotorKind::effort ? number : is<speed, angular_speed>(i); }},
        {List::load, "point/*", PlaceKind::point_load, [](const Item& i) -> Numbers { return &i.load().point; }, is<length>},
        {List::load, "force/*", PlaceKind::point_load, [](const Item& i) -> Numbers { return &i.load().force; }, is<force>, nullptr,
         Range::some_force}};
    using F = CoordinateForces;
    for (const List list : {List::joint, List::spring}) {
        const bool is_joint = list == List::joint;
        const PlaceKind point = is_joint ? PlaceKind::joint_point : PlaceKind::spring_point,
                        limits = is_joint ? PlaceKind::joint_limits : PlaceKind::spring_limits;
        rows.insert(
            rows.end(),
            {{list, "point_a/*", point, [](const Item& i) -> Numbers { return &i.a().point; }, is<length>, has_no_point},
             {list, "point_b/*", point, [](const Item& i) -> Numbers { return &i.b().point; }, is<length>, has_no_point},
             {list, "stiffness", PlaceKind::coordinate_force, of_forces<&F::stiffness>, is<stiffness, angular_stiffness>, has_no_spring,
              Range::positive},
             {list, "rest", PlaceKind::coordinate_force, of_forces<&F::rest>, is<length, angle>, has_no_rest},
             {list, "preload", PlaceKind::coordinate_force, of_forces<&F::preload>, is<force, torque>, has_no_preload},
             {list, "damping", PlaceKind::coordinate_force, of_forces<&F::damping>, is<number>, has_no_damping, Range::positive},
             {list, "friction", PlaceKind::coordinate_force, of_forces<&F::friction>, is<force, torque>, has_no_friction, Range::positive},
             {list, "limits/*", limits, [](const Item& i) { return i.forces().limits ? Numbers(&*i.forces().limits) : Numbers(); },
              is<length, angle>, has_no_limits, Range::in_order}});
    }
    return rows;
}

const std::vector<Row>& table() {
    static const std::vector<Row> rows = make_table();
    return rows;
}

const Row& row_of(const Place& place) { return table()[place.row]; }

Item item_of(Scene& scene, const Place& place) { return {scene, row_of(place).list, static_cast<std::size_t>(place.item)}; }

// To look at: rows only find, and what they find is changed by `at` alone.
Item item_of(const Scene& scene, const Place& place) { return item_of(const_cast<Scene&>(scene), place); }

Numbers numbers_of(const Item& item, const Place& place) { return row_of(place).numbers(item); }

// The items that a name of a list stands for: dampers are springs.
std::vector<Item> items_of(const Scene& scene, const ListName& of) {
    std::vector<Item> out;
    Item item{const_cast<Scene&>(scene), of.list};
    for (; item.number < item.count(); ++item.number)
        if (of.path != "dampers" || item.is_damper()) out.push_back(item);
    return out;
}

std::string unescaped(std::string_view word) {
    std::string out;
    for (std::size_t k = 0; k < word.size(); ++k) {
        const bool coded = word[k] == '~' && k + 1 < word.size();
        out += coded ? (word[++k] == '1' ? '/' : '~') : word[k];
    }
    return out;
}

// The word that stands where the key has its *, "" if it has none; nothing: the key is another.
std::optional<std::string_view> matched(std::string_view key, std::string_view path) {
    const std::size_t star = key.find('*');
    if (star == std::string_view::npos) return key == path ? std::optional(std::string_view()) : std::nullopt;
    const std::string_view before = key.substr(0, star), after = key.substr(star + 1);
    if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after)) return std::nullopt;
    const std::string_view word = path.substr(star, path.size() - before.size() - after.size());
    return word.find('/') == std::string_view::npos ? std::optional(word) : std::nullopt;
}

std::optional<std::size_t> number_in(std::string_view word) {
    if (word.empty() || word.size() > 9 || word.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    return std::stoul(std::string(word));
}

// Looks one pointer up.
class Search {
public:
    Search(const Scene& scene, std::string_view pointer) : scene_(scene), pointer_(pointer) {}

    base::Result<Place> run() const {
        if (!pointer_.starts_with('/')) return fail("a place in a scene is expected, such as /bodies/0/position/2");
        std::string_view path = pointer_.substr(1);
        for (const ListName& of : list_names) {
            if (!path.starts_with(of.path) || !path.substr(of.path.size()).starts_with('/')) continue;
            path.remove_prefix(of.path.size() + 1);
            const std::string_view word = path.substr(0, path.find('/'));
            path.remove_prefix(std::min(path.size(), word.size() + 1));
            return in_list(of, word, path);
        }
        return in_item({const_cast<Scene&>(scene_)}, std::string(path));
    }

private:
    Error fail(const std::string& message) const { return {ErrorCode::inconsistent, std::string(pointer_), message}; }

    base::Result<Place> in_list(const ListName& of, std::string_view word, std::string_view path) const {
        const std::vector<Item> items = items_of(scene_, of);
        const auto number = number_in(word);
        if (number && *number < items.size()) return in_item(items[*number], std::string(path));
        if (number) return fail("there is no " + std::string(of.what) + " of that number");
        const std::string wanted = unescaped(word);
        std::vector<std::string> names;
        for (const Item& item : items) names.push_back(item.name());
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (found != names.end()) return in_item(items[found - names.begin()], std::string(path));
        return fail("there is no " + std::string(of.what) + " `" + wanted + "`; " +
                    files::did_you_mean(wanted, {names.begin(), names.end()}, '`'));
    }

    base::Result<Place> in_item(const Item& item, std::string path) const {
        if (item.list == List::motor) {
            const std::string curve(item.curve_name());
            if (path == "speed") path = "curve/rate";
            if (path.starts_with(curve + "/")) path.replace(0, curve.size(), "curve");
        }
        std::vector<std::string_view> known;
        for (std::size_t k = 0; k < table().size(); ++k) {
            const Row& row = table()[k];
            if (row.list != item.list) continue;
            known.push_back(row.key);
            const auto entry = matched(row.key, path);
            if (entry) return in_row(static_cast<int>(k), item, *entry);
        }
        return fail(item.shown() + " has nothing at `" + path + "` that can be moved; " + files::did_you_mean(path, known, '`'));
    }

    base::Result<Place> in_row(int k, const Item& item, std::string_view entry) const {
        const Row& row = table()[k];
        if (const char* reason = row.misfit ? row.misfit(item) : nullptr) return fail(item.shown() + " " + reason);
        const Numbers numbers = row.numbers(item);
        std::vector<std::string> names;
        for (std::size_t i = 0; i < entries_of(numbers); ++i) names.push_back(entry_name(numbers, i));
        const bool is_one = row.key.find('*') == std::string_view::npos;
        const auto found = is_one ? names.begin() : std::find(names.begin(), names.end(), entry);
        if (found != names.end()) return Place{k, static_cast<int>(item.number), static_cast<int>(found - names.begin())};
        if (row.key.starts_with("materials")) return fail("material `" + unescaped(entry) + "` has no `mu` in the scene");
        return fail(item.shown() + " has no such value: `" + std::string(row.key.substr(0, row.key.find('*'))) + unescaped(entry) + "`; " +
                    files::did_you_mean(entry, {names.begin(), names.end()}, '`'));
    }

    const Scene& scene_;
    std::string_view pointer_;
};

std::string key_of(const Item& item, const Place& place) {
    std::string key(row_of(place).key);
    if (const std::size_t star = key.find('*'); star != std::string::npos)
        key.replace(star, 1, entry_name(numbers_of(item, place), static_cast<std::size_t>(place.entry)));
    if (item.list == List::motor) key.replace(0, std::string_view("curve").size(), item.curve_name());
    return key;
}

}  // namespace

std::string escaped(std::string_view name) {
    std::string out;
    for (const char c : name) out += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
    return out;
}

base::Result<Place> find_place(const Scene& scene, std::string_view pointer) { return Search(scene, pointer).run(); }

std::string pointer_to(const Scene& scene, const Place& place) {
    const Item item = item_of(scene, place);
    const std::string key = key_of(item, place);
    if (item.list == List::scene) return "/" + key;
    const bool is_damper = item.is_damper();
    for (const ListName& of : list_names) {
        if (of.list != item.list || (of.path == "dampers") != is_damper) continue;
        std::size_t number = 0;
        for (const Item& other : items_of(scene, of)) number += other.number < item.number ? 1 : 0;
        return "/" + std::string(of.path) + "/" + std::to_string(number) + "/" + key;
    }
    FETTLE_ASSERT(false, "every list has a name");
    return {};
}

std::vector<Place> places_of(const Scene& scene) {
    std::vector<Place> out;
    for (std::size_t k = 0; k < table().size(); ++k) {
        const Row& row = table()[k];
        Item item{const_cast<Scene&>(scene), row.list};
        for (; item.number < item.count(); ++item.number) {
            if (row.misfit && row.misfit(item)) continue;
            const int entries = static_cast<int>(entries_of(row.numbers(item)));
            for (int i = 0; i < entries; ++i) out.push_back({static_cast<int>(k), static_cast<int>(item.number), i});
        }
    }
    return out;
}

PlaceKind kind_of(const Place& place) { return row_of(place).kind; }

int row_count() { return static_cast<int>(table().size()); }

Dimension dimension_at(const Scene& scene, const Place& place) {
    const Item item = item_of(scene, place);
    const Row& row = row_of(place);
    if (row.key != "shape/dimensions/*" || !item.body().shape) return row.dimension(item);
    const ShapeSpec& shape = *item.body().shape;
    const std::string name = entry_name(row.numbers(item), static_cast<std::size_t>(place.entry));
    if (std::find(shape.angles.begin(), shape.angles.end(), name) != shape.angles.end()) return Dimension::angle;
    return std::find(shape.numbers.begin(), shape.numbers.end(), name) != shape.numbers.end() ? Dimension::number : Dimension::length;
}

double& at(Scene& scene, const Place& place) {
    return entry_of(numbers_of(item_of(scene, place), place), static_cast<std::size_t>(place.entry));
}

double value_at(const Scene& scene, const Place& place) {
    const Numbers numbers = numbers_of(item_of(scene, place), place);
    const auto* may_be_absent = std::get_if<std::optional<double>*>(&numbers);
    if (may_be_absent && !**may_be_absent) return std::nan("");
    return entry_of(numbers, static_cast<std::size_t>(place.entry));
}

base::Errors faults_at(const Scene& scene, const Place& place) {
    const Item item = item_of(scene, place);
    const double value = value_at(scene, place);
    const std::string key = "its `" + key_of(item, place) + "` ";
    const auto unless = [&](bool fits, const std::string& message) {
        return fits ? base::Errors() : base::Errors{{ErrorCode::out_of_range, item.shown(), message}};
    };
    switch (row_of(place).range) {
        case Range::any:
            return {};
        case Range::not_negative:
            return unless(value >= 0, key + "must not be negative");
        case Range::positive:
            return unless(value > 0, key + "must be greater than 0 for a derivative");
        case Range::not_zero:
            return unless(value != 0, key + "must not be 0");
        case Range::in_order:
            return unless((*item.forces().limits)[0] < (*item.forces().limits)[1], "its lower limit must be less than the upper one");
        case Range::some_force:
            return unless(item.load().force.norm() > 0, "its force must be greater than 0 for a derivative");
    }
    return {};
}

void settle_rotation(Body& body) {
    body.pose.rotation = rotation_of(body.orientation);
    if (!body.turn.isZero(0)) body.pose.rotation = kinematics::rotation(body.turn) * body.pose.rotation;
}

void clear_numbers(Scene& scene) {
    for (const Row& row : table()) {
        Item item{scene, row.list};
        for (; item.number < item.count(); ++item.number) {
            const Numbers numbers = row.numbers(item);
            for (std::size_t k = 0; k < entries_of(numbers); ++k) entry_of(numbers, k) = 0;
        }
    }
}

}  // namespace fettle::core::scene
