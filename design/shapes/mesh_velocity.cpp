// SPDX-License-Identifier: MIT
#include "design/shapes/mesh_velocity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "core/geometry/distance.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::design::shapes {

namespace {

using core::geometry::Mesh;
using core::geometry::Triangle;

long euler_characteristic(const Mesh& mesh) {
    return static_cast<long>(mesh.vertices.cols()) - static_cast<long>(mesh.edges.size()) + static_cast<long>(mesh.triangles.size());
}

bool have_same_topology(const Mesh& a, const Mesh& b) {
    return a.shell_names.size() == b.shell_names.size() && euler_characteristic(a) == euler_characteristic(b);
}

// The same triangle begins with its least vertex.
Triangle turned(const Triangle& t) {
    const auto least = std::min_element(t.begin(), t.end()) - t.begin();
    return {t[least], t[(least + 1) % 3], t[(least + 2) % 3]};
}

std::set<Triangle> triangle_set(const Mesh& mesh, const std::vector<int>* renamed = nullptr) {
    std::set<Triangle> all;
    for (Triangle t : mesh.triangles) {
        if (renamed != nullptr)
            for (int& i : t) i = (*renamed)[i];
        all.insert(turned(t));
    }
    return all;
}

// The vertices of `other` in the order of those of `at`, if both are the same triangles on them; else nothing.
std::optional<Matrix3X> matched_vertices(const Mesh& at, const Mesh& other) {
    if (at.vertices.cols() != other.vertices.cols() || at.triangles.size() != other.triangles.size()) return std::nullopt;
    if (at.triangles == other.triangles) return other.vertices;
    std::vector<int> partner(other.vertices.cols());
    std::vector<bool> taken(partner.size(), false);
    Matrix3X matched(3, at.vertices.cols());
    for (Eigen::Index j = 0; j < other.vertices.cols(); ++j) {
        Eigen::Index nearest = 0;
        (at.vertices.colwise() - other.vertices.col(j)).colwise().squaredNorm().minCoeff(&nearest);
        if (taken[nearest]) return std::nullopt;
        taken[nearest] = true;
        partner[j] = static_cast<int>(nearest);
        matched.col(nearest) = other.vertices.col(j);
    }
    if (triangle_set(at) != triangle_set(other, &partner)) return std::nullopt;
    return matched;
}

// The surface of a mesh, asked for its closest points.
class Surface {
public:
    explicit Surface(const Mesh& mesh) : mesh_(mesh), low_(3, count()), high_(3, count()) {
        for (Eigen::Index f = 0; f < count(); ++f) {
            const auto [a, b, c] = corners(f);
            low_.col(f) = a.cwiseMin(b).cwiseMin(c);
            high_.col(f) = a.cwiseMax(b).cwiseMax(c);
        }
    }

    Vector3 closest(const Vector3& p) const {
        double least = std::numeric_limits<double>::infinity();
        Vector3 point = p;
        for (Eigen::Index f = 0; f < count(); ++f) {
            const double box = (low_.col(f) - p).cwiseMax(p - high_.col(f)).cwiseMax(0).squaredNorm();
            if (!(box < least)) continue;
            const auto [a, b, c] = corners(f);
            const core::geometry::ClosestPoints found = core::geometry::point_triangle_closest(p, a, b, c);
            if (!(found.distance_squared < least)) continue;
            least = found.distance_squared;
            point = p - found.difference;
        }
        return point;
    }

private:
    Eigen::Index count() const { return static_cast<Eigen::Index>(mesh_.triangles.size()); }
    std::array<Vector3, 3> corners(Eigen::Index f) const {
        const Triangle& t = mesh_.triangles[f];
        return {mesh_.vertices.col(t[0]), mesh_.vertices.col(t[1]), mesh_.vertices.col(t[2])};
    }

    const Mesh& mesh_;
    Matrix3X low_, high_;
};

// Normal equations of n_f . v = s_f at one vertex.
struct NormalSum {
    Matrix3 matrix = Matrix3::Zero();
    Vector3 right = Vector3::Zero();
};

Vector3 least_velocity(const NormalSum& sum) {
    const core::linear::SymmetricEigen<3> eigen = core::linear::symmetric_eigen<3>(sum.matrix);
    Vector3 v = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {  // directions that hardly any normal has are left at rest
        if (eigen.values[i] > 1e-3 * eigen.values[2]) v += eigen.vectors.col(i) * (eigen.vectors.col(i).dot(sum.right) / eigen.values[i]);
    }
    return v;
}

MeshVelocity normal_velocity(const Mesh& at, const Mesh& plus, const Mesh& minus, double width) {
    const Surface above(plus), below(minus);
    struct Row {
        int vertex;
        Vector3 normal;
        double speed;
    };
    std::vector<Row> rows;
    std::vector<NormalSum> sums(at.vertices.cols());
    for (const Triangle& t : at.triangles) {
        const Vector3 a = at.vertices.col(t[0]), b = at.vertices.col(t[1]), c = at.vertices.col(t[2]);
        const Vector3 doubled = (b - a).cross(c - a);
        if (!(doubled.norm() > 0)) continue;
        const Vector3 normal = doubled.normalized(), middle = (a + b + c) / 3;
        for (const int i : t) {
            const Vector3 point = 0.75 * Vector3(at.vertices.col(i)) + 0.25 * middle;
            const double speed = normal.dot(above.closest(point) - below.closest(point)) / width;
            rows.push_back({i, normal, speed});
            sums[i].matrix += normal * normal.transpose();
            sums[i].right += normal * speed;
        }
    }
    MeshVelocity found;
    found.by_normals = true;
    found.velocity.resize(3, at.vertices.cols());
    for (Eigen::Index i = 0; i < found.velocity.cols(); ++i) found.velocity.col(i) = least_velocity(sums[i]);
    for (const Row& row : rows) found.misfit = std::max(found.misfit, std::abs(row.normal.dot(found.velocity.col(row.vertex)) - row.speed));
    return found;
}

}  // namespace

Result<MeshVelocity> mesh_velocity(const Mesh& at, const Mesh& plus, const Mesh& minus, double width) {
    for (const Mesh* beside : {&plus, &minus}) {
        if (have_same_topology(at, *beside)) continue;
        return Error{ErrorCode::mesh_invalid, "",
                     "the part's topology changes right beside these dimensions (" + std::to_string(at.shell_names.size()) +
                         " shells, Euler characteristic " + std::to_string(euler_characteristic(at)) + "; beside it " +
                         std::to_string(beside->shell_names.size()) + " and " + std::to_string(euler_characteristic(*beside)) +
                         "): it has no derivative here"};
    }
    const auto above = matched_vertices(at, plus), below = matched_vertices(at, minus);
    if (above && below) return MeshVelocity{(*above - *below) / width, false, 0};
    return normal_velocity(at, plus, minus, width);
}

}  // namespace fettle::design::shapes
