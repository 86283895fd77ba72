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

}  // namespace fettle::core::features
