// SPDX-License-Identifier: MIT
#include "design/exports/projection_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/files/nearest_word.hpp"
#include "core/files/text_lines.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::design::exports {

namespace {

struct NamedView {
    std::string_view name;
    double azimuth, elevation;  // [degrees]
};

constexpr NamedView named_views[] = {{"iso", 45, 35.264389682754654},
                                     {"front", 0, 0},
                                     {"back", 180, 0},
                                     {"left", -90, 0},
                                     {"right", 90, 0},
                                     {"top", 0, 90},
                                     {"bottom", 0, -90}};

std::optional<NamedView> view_by_angles(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) return std::nullopt;
    const auto azimuth = core::files::parsed_number(std::string_view(text).substr(0, comma)),
               elevation = core::files::parsed_number(std::string_view(text).substr(comma + 1));
    if (!azimuth || !elevation || !std::isfinite(*azimuth) || !(std::abs(*elevation) <= 90)) return std::nullopt;
    return NamedView{"", *azimuth, *elevation};
}

/// Exact where the angle is a multiple of 90 degrees, so that a front view sees side faces as lines.
double cosine(double degrees) {
    const double quarter = std::remainder(degrees, 360) / 90;
    if (quarter == std::round(quarter)) return std::abs(quarter) == 1 ? 0 : quarter == 0 ? 1 : -1;
    return std::cos(degrees * M_PI / 180);
}
double sine(double degrees) { return cosine(degrees - 90); }

}  // namespace

Result<ProjectionView> projection_view(const std::string& name, const Vector3& up, const std::string& where) {
    std::optional<NamedView> view = view_by_angles(name);
    std::vector<std::string_view> known;
    for (const NamedView& each : named_views) {
        known.push_back(each.name);
        if (each.name == name) view = each;
    }
    if (!view) {
        return Error{ErrorCode::out_of_range, where,
                     "\"" + name + "\" is not a view; azimuth,elevation in degrees, elevation from -90 to 90, or a name: " +
                         core::files::did_you_mean(name, known)};
    }
    // With Z up the viewer stands at (sin a cos e, -cos a cos e, sin e).
    const double ca = cosine(view->azimuth), sa = sine(view->azimuth), ce = cosine(view->elevation), se = sine(view->elevation);
    const Vector3 towards(sa * ce, -ca * ce, se), right(ca, sa, 0);
    const Matrix3 to_world = core::kinematics::turn_between(Vector3::UnitZ(), up).toRotationMatrix();
    return ProjectionView{to_world * right, to_world * towards.cross(right), to_world * towards};
}

}  // namespace fettle::design::exports
