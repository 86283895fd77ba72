// SPDX-License-Identifier: MIT
#include "design/shapes/rebuilt_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/parallel.hpp"
#include "design/shapes/mesh_rounding.hpp"
#include "design/shapes/mesh_velocity.hpp"

namespace fettle::design::shapes {

using core::geometry::Mesh;
using description::ShapeInstance;

namespace {

// A step for differences of a part of that size, known to `rounding`: there rounding / step and the third derivative, about step^2 /
// size^2, make equal errors; and no more than a twentieth of the dimension, which has to stay what it is.
double difference_step(double rounding, double size, double value) {
    const double best = std::cbrt(3 * std::max(rounding, 1e-15 * size) * size * size);
    const double room = value != 0 ? std::abs(value) / 20 : size / 20;
    return std::min(best, room);
}

double largest_column(const Matrix3X& m) { return m.cols() > 0 ? m.colwise().norm().maxCoeff() : 0; }

}  // namespace

/// The meshes that the derivative in a dimension is taken from: with its value + h, - h, + h/2, - h/2.
struct RebuiltShape::Stencil {
    double rounding = 0, step = 0;  // h
    std::array<double, 4> at;       // the dimension's values
    std::array<std::shared_ptr<const Result<Mesh>>, 4> beside;
};

template <class Key, class T, class Make>
std::shared_ptr<const T> RebuiltShape::kept(Kept<Key, T>& store, const Key& key, const Make& make) const {
    std::shared_ptr<typename Kept<Key, T>::Entry> entry;
    {
        const std::lock_guard lock(mutex_);
        const auto [place, is_new] = store.by_key.try_emplace(key);
        if (is_new) {
            place->second = std::make_shared<typename Kept<Key, T>::Entry>();
            store.order.push_back(key);
        }
        entry = place->second;
        if (store.order.size() > options_.kept) {
            store.by_key.erase(store.order.front());
            store.order.pop_front();
        }
    }
    const std::lock_guard making(entry->making);
    if (!entry->value) entry->value.emplace(make());
    return {entry, &*entry->value};
}

std::shared_ptr<const Result<Mesh>> RebuiltShape::made(const Values& values) const {
    return kept(meshes_, values, [&] { return maker_(values); });
}

Result<Mesh> RebuiltShape::mesh(const std::vector<double>& values) const { return *made(values); }

Result<ShapeInstance> RebuiltShape::at(const std::vector<double>& values) const {
    return differentiated(values, description::all_dimensions(*this));
}

Result<ShapeInstance> RebuiltShape::differentiated(const std::vector<double>& values, const std::vector<bool>& wanted) const {
    const auto middle = made(values);
    if (!*middle) return middle->errors();
    ShapeInstance part{**middle, {}};
    for (const auto& derivative : derivatives(part.mesh, values, wanted)) {
        if (derivative && !*derivative) return derivative->errors();
        part.jacobian.push_back(derivative ? (*derivative)->velocity : Matrix3X(3, 0));
    }
    return part;
}

std::vector<std::string> RebuiltShape::remarks(const std::vector<double>& values, const std::vector<bool>& wanted) const {
    const auto middle = made(values);
    if (!*middle) return {};
    std::vector<std::string> remarks;
    for (const auto& derivative : derivatives(**middle, values, wanted)) {
        if (derivative && !*derivative) return {};
        if (derivative) remarks.push_back((*derivative)->remark);
    }
    return remarks;
}

// The meshes of all of them are made at once.
RebuiltShape::Derivatives RebuiltShape::derivatives(const Mesh& middle, const Values& values, const std::vector<bool>& wanted) const {
    Derivatives out(dimensions_.size());
    core::base::parallel_for(count_of(dimensions_), 1, [&](int task) {
        const auto k = static_cast<std::size_t>(task);
        if (wanted[k])
            out[k] = kept(derivatives_, std::pair(k, values), [&] { return differentiate(middle, stencil_of(middle, values, k), k); });
    });
    return out;
}

RebuiltShape::Stencil RebuiltShape::stencil_of(const Mesh& middle, const Values& values, std::size_t k) const {
    Stencil stencil;
    stencil.rounding = options_.rounding.value_or(coordinate_rounding(middle.vertices, options_.unit));
    const double size = core::geometry::box_sides(middle.vertices).norm();
    const double value = values[k], h = difference_step(stencil.rounding, size, value);
    stencil.step = h;
    stencil.at = {value + h, value - h, value + h / 2, value - h / 2};
    core::base::parallel_for(4, 1, [&](int side) {
        Values moved = values;
        moved[k] = stencil.at[side];
        stencil.beside[side] = made(moved);
    });
    return stencil;
}

Result<RebuiltShape::Derivative> RebuiltShape::differentiate(const Mesh& middle, const Stencil& stencil, std::size_t k) const {
    const std::string& name = dimensions_[k].name;
    const auto refuse = [&](const Errors& cause) {
        Errors errors = cause;
        for (Error& error : errors) {
            char text[120];
            std::snprintf(text, sizeof text, "built for its derivative, up to %.4g mm beside: ", 1000 * stencil.step);
            error.message = text + error.message;
            error.where = name;
        }
        return errors;
    };
    for (const auto& mesh : stencil.beside)
        if (!*mesh) return refuse(mesh->errors());
    const auto velocity = [&](std::size_t first) {
        return mesh_velocity(middle, **stencil.beside[first], **stencil.beside[first + 1], stencil.at[first] - stencil.at[first + 1]);
    };
    const Result<MeshVelocity> wide = velocity(0), narrow = velocity(2);
    if (!wide) return refuse(wide.errors());
    if (!narrow) return refuse(narrow.errors());
    const double noise = std::sqrt(3.0) * stencil.rounding / stencil.step;  // of `wide`; `narrow` has twice that
    const double change = largest_column(wide->velocity - narrow->velocity);
    const bool straight = change <= 3 * noise;
    Derivative derivative;
    derivative.velocity = straight ? wide->velocity : Matrix3X((4 * narrow->velocity - wide->velocity) / 3);
    const double error = (straight ? noise : change / 3 + 3 * noise) + std::max(wide->misfit, narrow->misfit);
    char text[300];
    std::snprintf(
        text, sizeof text, "d/d %s: from meshes built %.4g mm beside, %s, to about %.1e of it", name.c_str(), 1000 * stencil.step,
        narrow->by_normals || wide->by_normals ? "by the normal velocity of their surfaces (their triangles differ)" : "vertex by vertex",
        error / std::max(largest_column(derivative.velocity), 1e-300));
    derivative.remark = text;
    return derivative;
}

}  // namespace fettle::design::shapes
