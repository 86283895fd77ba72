// SPDX-License-Identifier: MIT
#include "fettle/design/description/shape.hpp"

namespace fettle::design::description {

Result<ShapeInstance> as_drawn(const Shape& shape) {
    std::vector<double> values;
    for (const ShapeDimension& dimension : shape.dimensions()) values.push_back(dimension.value);
    return shape.at(values);
}

}  // namespace fettle::design::description
