// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/rebuilt_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fettle/core/base/parallel.hpp"
#include "fettle/design/shapes/mesh_rounding.hpp"
#include "fettle/design/shapes/mesh_velocity.hpp"

namespace fettle::design::shapes {

using core::geometry::Mesh;
using description::ShapeInstance;

namespace {

// For differences of what is known to `rounding` of a part of that size: where rounding / step and the third derivative, about step^2 /
// size^2, make equal errors; and no more than a twentieth of the dimension, which has to stay what it is.
double difference_step(double rounding, double size, double value) {
    const double best = std::cbrt(3 * std::max(rounding, 1e-15 * size) * size * size);
    const double room = value != 0 ? std::abs(value) / 20 : size / 20;
    return std::min(best, room);
}

double largest_column(const Matrix3X& m) { return m.cols() > 0 ? m.colwise().norm().maxCoeff() : 0; }

}  // namespace

/// The meshes that a derivative is taken from: at the dimensions, and by each dimension at + h, - h, + h/2, - h/2.
struct RebuiltShape::Stencil {
    std::shared_ptr<const Result<Mesh>> middle;
    double rounding = 0;
    std::vector<double> steps;
    std::vector<std::array<double, 4>> at;  // the dimension's values
    std::vector<std::array<std::shared_ptr<const Result<Mesh>>, 4>> beside;
};

template <class T>
std::shared_ptr<const T> RebuiltShape::kept(const Kept<T>& store, const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = store.by_values.find(key);
    return found == store.by_values.end() ? nullptr : found->second;
}

template <class T>
void RebuiltShape::keep(Kept<T>& store, const Key& key, std::shared_ptr<const T> value) const {
    const std::lock_guard lock(mutex_);
    if (!store.by_values.emplace(key, std::move(value)).second) return;
    store.order.push_back(key);
    if (store.order.size() <= options_.kept) return;
    store.by_values.erase(store.order.front());
    store.order.pop_front();
}

std::shared_ptr<const Result<Mesh>> RebuiltShape::made(const Key& values) const {
    if (auto known = kept(meshes_, values)) return known;
    auto fresh = std::make_shared<const Result<Mesh>>(maker_(values));
    keep(meshes_, values, fresh);
    return fresh;
}

std::shared_ptr<const Result<RebuiltShape::Derived>> RebuiltShape::derived(const Key& values) const {
    if (auto known = kept(derived_, values)) return known;
    auto fresh = std::make_shared<const Result<Derived>>(derive(values));
    keep(derived_, values, fresh);
    return fresh;
}

Result<Mesh> RebuiltShape::mesh(const std::vector<double>& values) const { return *made(values); }

Result<ShapeInstance> RebuiltShape::at(const std::vector<double>& values) const {
    const auto found = derived(values);
    if (!*found) return found->errors();
    return (*found)->instance;
}

std::vector<std::string> RebuiltShape::remarks(const std::vector<double>& values) const {
    const auto found = derived(values);
    return *found ? (*found)->remarks : std::vector<std::string>();
}

Result<RebuiltShape::Derived> RebuiltShape::derive(const Key& values) const {
    Stencil stencil;
    stencil.middle = made(values);
    if (!*stencil.middle) return stencil.middle->errors();
    const Mesh& middle = **stencil.middle;
    stencil.rounding = options_.rounding.value_or(coordinate_rounding(middle.vertices, options_.unit));
    const double size = (middle.vertices.rowwise().maxCoeff() - middle.vertices.rowwise().minCoeff()).norm();
    const std::size_t n = dimensions_.size();
    for (const double value : values) {
        const double h = difference_step(stencil.rounding, size, value);
        stencil.steps.push_back(h);
        stencil.at.push_back({value + h, value - h, value + h / 2, value - h / 2});
    }
    stencil.beside.resize(n);
    core::base::parallel_for(static_cast<int>(4 * n), 1, [&](int task) {
        const std::size_t k = static_cast<std::size_t>(task) / 4, side = static_cast<std::size_t>(task) % 4;
        Key moved = values;
        moved[k] = stencil.at[k][side];
        stencil.beside[k][side] = made(moved);
    });
    Derived derived;
    derived.instance.mesh = middle;
    for (std::size_t k = 0; k < n; ++k) {
        Errors errors = differentiate(stencil, k, derived);
        if (!errors.empty()) return errors;
    }
    return derived;
}

Errors RebuiltShape::differentiate(const Stencil& stencil, std::size_t k, Derived& derived) const {
    const std::string& name = dimensions_[k].name;
    const auto refuse = [&](const Errors& cause) {
        Errors errors = cause;
        for (Error& error : errors) {
            char text[120];
            std::snprintf(text, sizeof text, "built for its derivative, up to %.4g mm beside: ", 1000 * stencil.steps[k]);
            error.message = text + error.message;
            error.where = name;
        }
        return errors;
    };
    for (const auto& mesh : stencil.beside[k])
        if (!*mesh) return refuse(mesh->errors());
    const auto velocity = [&](std::size_t first) {
        return mesh_velocity(**stencil.middle, **stencil.beside[k][first], **stencil.beside[k][first + 1],
                             stencil.at[k][first] - stencil.at[k][first + 1]);
    };
    const Result<MeshVelocity> wide = velocity(0), narrow = velocity(2);
    if (!wide) return refuse(wide.errors());
    if (!narrow) return refuse(narrow.errors());
    const double noise = std::sqrt(3.0) * stencil.rounding / stencil.steps[k];  // of `wide`; `narrow` has twice that
    const double change = largest_column(wide->velocity - narrow->velocity);
    const bool straight = change <= 3 * noise;
    Matrix3X best = straight ? wide->velocity : Matrix3X((4 * narrow->velocity - wide->velocity) / 3);
    const double error = (straight ? noise : change / 3 + 3 * noise) + std::max(wide->misfit, narrow->misfit);
    char text[300];
    std::snprintf(
        text, sizeof text, "d/d %s: from meshes built %.4g mm beside, %s, to about %.1e of it", name.c_str(), 1000 * stencil.steps[k],
        narrow->by_normals || wide->by_normals ? "by the normal velocity of their surfaces (their triangles differ)" : "vertex by vertex",
        error / std::max(largest_column(best), 1e-300));
    derived.remarks.emplace_back(text);
    derived.instance.jacobian.push_back(std::move(best));
    return {};
}

}  // namespace fettle::design::shapes
