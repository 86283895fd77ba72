// SPDX-License-Identifier: MIT
/// A part from anything that makes a mesh when it is given dimensions: a program (mesh_program.hpp), a function of Python's. Its derivative
/// comes from rebuilt meshes: central differences in each dimension, of two widths, extrapolated where they differ by more than rounding
/// explains (mesh_velocity.hpp says how vertices are distinguished).
/// Meshes are kept by their dimensions, so that nothing is built twice; those beside a design are built in parallel.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fettle/design/description/shape.hpp"

namespace fettle::design::shapes {

/// The part at these dimensions [m], with one value for each; called from several threads at once, and always with the same answer.
using MeshMaker = std::function<Result<core::geometry::Mesh>(const std::vector<double>& values)>;

struct RebuiltOptions {
    double unit = 1;                      ///< that the maker writes coordinates in [m]: their rounding is estimated from their digits
    std::optional<double> rounding = {};  ///< of coordinates [m]; default: coordinate_rounding
    std::size_t kept = 256;               ///< meshes, of the last dimensions asked for
};

class RebuiltShape : public description::Shape {
public:
    RebuiltShape(std::vector<description::ShapeDimension> dimensions, MeshMaker maker, const RebuiltOptions& options = {})
        : dimensions_(std::move(dimensions)), maker_(std::move(maker)), options_(options) {}

    const std::vector<description::ShapeDimension>& dimensions() const override { return dimensions_; }
    bool has_fixed_triangles() const override { return false; }
    bool is_costly() const override { return true; }
    Result<core::geometry::Mesh> mesh(const std::vector<double>& values) const override;
    /// Errors: what the maker says, here or beside; a topology that changes beside.
    Result<description::ShapeInstance> at(const std::vector<double>& values) const override;
    /// A sentence for each dimension: the step of its differences, how vertices were distinguished, how far the derivative may be off.
    std::vector<std::string> remarks(const std::vector<double>& values) const override;

private:
    struct Derived {
        description::ShapeInstance instance;
        std::vector<std::string> remarks;
    };
    using Key = std::vector<double>;
    template <class T>
    struct Kept {
        std::map<Key, std::shared_ptr<const T>> by_values;
        std::deque<Key> order;
    };

    template <class T>
    std::shared_ptr<const T> kept(const Kept<T>& store, const Key& key) const;
    template <class T>
    void keep(Kept<T>& store, const Key& key, std::shared_ptr<const T> value) const;
    std::shared_ptr<const Result<Derived>> derived(const Key& values) const;
    std::shared_ptr<const Result<core::geometry::Mesh>> made(const Key& values) const;
    Result<Derived> derive(const Key& values) const;
    struct Stencil;
    Errors differentiate(const Stencil& stencil, std::size_t dimension, Derived& derived) const;

    std::vector<description::ShapeDimension> dimensions_;
    MeshMaker maker_;
    RebuiltOptions options_;
    mutable std::mutex mutex_;
    mutable Kept<Result<core::geometry::Mesh>> meshes_;
    mutable Kept<Result<Derived>> derived_;
};

}  // namespace fettle::design::shapes
