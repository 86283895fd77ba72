// SPDX-License-Identifier: MIT
#include "core/features/feature.hpp"

namespace fettle::core::features {

const char* to_string(End end) {
    switch (end) {
        case End::open:
            return "open";
        case End::closed:
            return "closed";
        case End::cut:
            return "cut";
    }
    return "?";
}

int Features::find(const std::string& name) const {
    for (int k = 0; k < count_of(features); ++k)
        if (features[k].name == name) return k;
    return -1;
}

std::vector<int> Features::by_triangle(std::size_t triangles) const {
    std::vector<int> out(triangles, -1);
    for (int f = 0; f < count_of(features); ++f)
        for (const int t : features[f].triangles) out[t] = f;
    return out;
}

}  // namespace fettle::core::features
