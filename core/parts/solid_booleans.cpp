// SPDX-License-Identifier: MIT
// Without CGAL: solids that are apart can be united, and all else is refused.
#include "fettle/core/parts/solid_booleans.hpp"

#include <limits>

namespace fettle::core::parts {
namespace {

struct Box {
    std::array<double, 3> low, high;
};

Box box_of(const Solid& solid) {
    Box box;
    box.low.fill(std::numeric_limits<double>::infinity());
    box.high.fill(-std::numeric_limits<double>::infinity());
    for (const Point3& vertex : solid.vertices) {
        const std::array<double, 3> at{vertex.x.value, vertex.y.value, vertex.z.value};
        for (std::size_t k = 0; k < 3; ++k) {
            box.low[k] = std::min(box.low[k], at[k]);
            box.high[k] = std::max(box.high[k], at[k]);
        }
    }
    return box;
}

bool are_apart(const Box& a, const Box& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.high[k] < b.low[k] || b.high[k] < a.low[k]) return true;
    return false;
}

Error refusal(const char* what) {
    return {ErrorCode::unsupported, "",
            std::string("this build of fettle cannot ") + what +
                " solids that meet; draw the part as layers of profiles (`stack`), whose unions and differences it can make"};
}

}  // namespace

bool has_solid_booleans() { return false; }

Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b) { return united(drawing, std::vector<Solid>{a, b}); }

Result<Solid> united(Drawing&, const std::vector<Solid>& solids) {
    std::vector<Box> boxes;
    for (const Solid& solid : solids) boxes.push_back(box_of(solid));
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (!are_apart(boxes[i], boxes[k])) return refusal("unite");
    return together(solids);
}

Result<Solid> difference(Drawing&, const Solid&, const Solid&) { return refusal("subtract"); }
Result<Solid> intersection(Drawing&, const Solid&, const Solid&) { return refusal("intersect"); }

}  // namespace fettle::core::parts
