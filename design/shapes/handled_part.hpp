// SPDX-License-Identifier: MIT
/// A mesh file whose dimensions are handles (core/features/handled_mesh.hpp), as the Shape that a design moves: a bore of a downloaded STL
/// beside a kernel part. Its derivative is exact.
///     "shape": {"mesh": "base.stl", "handles": {"bore": {"bores": ["B1", "B2"]}}, "dimensions": {"bore": "= bore"}}
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/units.hpp"
#include "core/features/handled_mesh.hpp"
#include "core/scene/scene.hpp"
#include "design/description/shape.hpp"

namespace fettle::design::shapes {

/// Handles as a scene writes them (scene.schema.json, `handle`). Errors: what a reader says, `where` "shape#/handles/...".
Result<std::vector<core::features::Handle>> read_handles(const core::scene::HandledMeshSpec& spec);

/// By name: lengths, angles of turns, plain numbers of morphs. Errors: those of read_handles.
Result<std::map<std::string, core::base::Dimension>> dimensions_of_handles(const core::scene::HandledMeshSpec& spec);

class HandledPart : public description::Shape {
public:
    /// @param dimensions  By the handles' names [SI]; those left out are as drawn.
    /// Errors: those of read_handles and HandledMesh; a dimension without a handle.
    static Result<std::shared_ptr<const HandledPart>> create(const core::scene::HandledMeshSpec& spec,
                                                             const std::map<std::string, double>& dimensions = {});

    const std::vector<description::ShapeDimension>& dimensions() const override { return dimensions_; }
    Result<description::ShapeInstance> at(const std::vector<double>& values) const override;
    Result<core::geometry::Mesh> mesh(const std::vector<double>& values) const override;
    Result<description::RecordedShape> recorded(const std::vector<double>& values) const override;

private:
    explicit HandledPart(core::features::HandledMesh mesh) : mesh_(std::move(mesh)) {}

    core::features::HandledMesh mesh_;
    std::vector<description::ShapeDimension> dimensions_;
};

}  // namespace fettle::design::shapes
