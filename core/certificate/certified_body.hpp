// SPDX-License-Identifier: MIT
/// A body as a certificate cuts it into pieces (certificate.hpp), with what certificate_checker.cpp needs of each. Part of the checker:
/// everything is computed from the mesh.
#pragma once

#include <functional>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/certificate.hpp"
#include "core/certificate/interval_motion.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::certificate {

/// A range of a body's list of elements.
struct Part {
    int left = -1, right = -1;  ///< its two parts; -1: of a single element
    Region region;              ///< its elements' corners
};

class CertifiedBody {
public:
    CertifiedBody() = default;
    CertifiedBody(CertifiedBody&&) = default;  // the regions' points stay where they are
    CertifiedBody& operator=(CertifiedBody&&) = default;

    const std::vector<Part>& parts() const { return parts_; }  ///< the first is the root

private:
    friend base::Result<CertifiedBody> certified_body(const BodyPieces& pieces, const geometry::Mesh& mesh);
    std::vector<Vector3> corners_;  // three for each of the listed elements
    std::vector<int> vertices_;     // of the mesh: what the corners are
    std::vector<Part> parts_;       // parents before their children
};

/// Errors (inconsistent), `where` is /elements or /cuts: the list misses an element of the mesh or has one too many, or it is not cut down
/// to single elements.
base::Result<CertifiedBody> certified_body(const BodyPieces& pieces, const geometry::Mesh& mesh);

/// Vertices of the element with this number; empty if there is none.
std::vector<int> element_vertices(const geometry::Mesh& mesh, int number);

/// The point, as intervals in the body's frame; false if it is none of the mesh.
bool point_of(const geometry::Mesh& mesh, const CertifiedPoint& point, Interval3& X);
/// The same of a mesh whose vertices are elsewhere.
bool point_of(const geometry::Mesh& mesh, const CertifiedPoint& point, const std::function<Interval3(int vertex)>& vertices, Interval3& X);

}  // namespace fettle::core::certificate
