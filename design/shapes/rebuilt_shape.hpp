// SPDX-License-Identifier: MIT
/// A part from anything that makes a mesh when it is given dimensions: a program (mesh_program.hpp), a function of Python's. Its derivative
/// comes from rebuilt meshes: central differences in each dimension, of two widths, extrapolated where they differ by more than rounding
/// explains (mesh_velocity.hpp says how vertices are distinguished).
/// Meshes and derivatives are kept by their dimensions, so that nothing is built twice, whoever asks at the same time; meshes beside a
/// design are built in parallel, and only for the dimensions whose derivatives are wanted: four for each.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "design/description/shape.hpp"

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
    /// The others' are left out.
    Result<description::ShapeInstance> differentiated(const std::vector<double>& values, const std::vector<bool>& wanted) const override;
    /// A sentence for each dimension that is wanted: the step of its differences, how vertices were distinguished, how far the derivative
    /// may be off.
    std::vector<std::string> remarks(const std::vector<double>& values, const std::vector<bool>& wanted) const override;

private:
    using Values = std::vector<double>;
    struct Derivative {
        Matrix3X velocity;
        std::string remark;
    };
    /// By what they were made for, the last ones asked for first. Who asks for one that is being made waits for it.
    template <class Key, class T>
    struct Kept {
        struct Entry {
            std::mutex making;
            std::optional<T> value;
        };
        std::map<Key, std::shared_ptr<Entry>> by_key;
        std::deque<Key> order;
    };
    using Derivatives = std::vector<std::shared_ptr<const Result<Derivative>>>;  ///< per dimension; null where it is not wanted

    template <class Key, class T, class Make>
    std::shared_ptr<const T> kept(Kept<Key, T>& store, const Key& key, const Make& make) const;
    std::shared_ptr<const Result<core::geometry::Mesh>> made(const Values& values) const;
    Derivatives derivatives(const core::geometry::Mesh& middle, const Values& values, const std::vector<bool>& wanted) const;
    struct Stencil;
    Stencil stencil_of(const core::geometry::Mesh& middle, const Values& values, std::size_t dimension) const;
    Result<Derivative> differentiate(const core::geometry::Mesh& middle, const Stencil& stencil, std::size_t dimension) const;

    std::vector<description::ShapeDimension> dimensions_;
    MeshMaker maker_;
    RebuiltOptions options_;
    mutable std::mutex mutex_;
    mutable Kept<Values, Result<core::geometry::Mesh>> meshes_;
    mutable Kept<std::pair<std::size_t, Values>, Result<Derivative>> derivatives_;
};

}  // namespace fettle::design::shapes
