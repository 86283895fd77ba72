// SPDX-License-Identifier: MIT
// What does a start cost, by phase, before the first step: from the vertices and triangles of a mesh to a model that can be simulated?
// Microseconds of the processor per triangle, and of the clock with all threads that are allowed (a phase that is not parallel has the same
// twice). A bumpy torus; with a mesh file as second argument, that mesh too, its triangles as the file has them. Before a time counts, the
// answer is checked: volume and area by Pappus' theorems (smooth torus), soundness, boxes that hold their elements. Prints JSON.
// Arguments: triangles (1000000), mesh file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "core/base/parallel.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/mesh_validity.hpp"

using namespace fettle;
using namespace fettle::core;

namespace {

// About z, 2 n m triangles; `bumps` is the height of waves on it, in parts of the minor radius.
geometry::Mesh torus(int n, int m, double bumps) {
    const double major = 0.02, minor = 0.006;
    Matrix3X x(3, static_cast<Eigen::Index>(n) * m);
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double u = 2 * M_PI * i / n;
        for (int j = 0; j < m; ++j) {
            const double v = 2 * M_PI * j / m, tube = minor * (1 + bumps * std::sin(9 * u) * std::cos(5 * v)),
                         r = major + tube * std::cos(v);
            x.col(static_cast<Eigen::Index>(i) * m + j) << r * std::cos(u), r * std::sin(u), tube * std::sin(v);
            const int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    }
    return geometry::make_mesh("torus", x, std::move(triangles));
}

double wall_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
    double one_thread = std::numeric_limits<double>::infinity();   ///< of the processor
    double all_threads = std::numeric_limits<double>::infinity();  ///< of the clock
};

/// Best of three each.
Cost cost_of(const std::function<bool()>& run, bool& right) {
    Cost cost;
    for (int repetition = 0; repetition < 3; ++repetition) {
        const core::base::ThreadLimit one(1);
        const double start = cpu_seconds();
        right = run() && right;
        cost.one_thread = std::min(cost.one_thread, cpu_seconds() - start);
    }
    for (int repetition = 0; repetition < 3; ++repetition) {
        const double start = wall_seconds();
        right = run() && right;
        cost.all_threads = std::min(cost.all_threads, wall_seconds() - start);
    }
    return cost;
}

bool holds_its_elements(const geometry::BodyHierarchy& hierarchy, const geometry::Mesh& mesh) {
    std::size_t seen = 0;
    for (const geometry::HierarchyNode& node : hierarchy.nodes()) {
        if (!node.is_leaf()) continue;
        for (int i = node.first; i < node.first + node.count; ++i, ++seen) {
            const geometry::HierarchyElement& element = hierarchy.elements()[i];
            for (int k = 0; k < element.vertex_count; ++k) {
                const Vector3 x = mesh.vertices.col(element.vertices[k]);
                if (((x - node.center).cwiseAbs() - node.half_extent).maxCoeff() > 0) return false;
            }
        }
    }
    return seen == hierarchy.elements().size();
}

/// The mesh falls on itself, one and a half of its size below: both bodies are of one shape.
scene::Scene two_of(const geometry::Mesh& mesh) {
    scene::Scene scene;
    const Vector3 size = mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff();
    for (int i = 0; i < 2; ++i) {
        scene::Body body;
        body.name = i == 0 ? "lower" : "upper";
        body.type = i == 0 ? scene::BodyType::static_body : scene::BodyType::dynamic_body;
        body.mesh = mesh;
        body.mesh_policy = scene::MeshPolicy::tolerant;
        body.pose.position.z() = 1.5 * i * size.z();
        scene.bodies.push_back(std::move(body));
    }
    return scene;
}

void run_phases(const std::string& name, const geometry::Mesh& mesh, std::optional<double> volume) {
    const auto count = static_cast<double>(mesh.triangles.size());
    const char* separator = "";
    bool all_right = true;
    std::printf("  {\"mesh\": \"%s\", \"triangles\": %zu, \"phases\": [\n", name.c_str(), mesh.triangles.size());
    const auto phase = [&](const std::string& what, const std::function<bool()>& run) {
        bool right = true;
        const Cost cost = cost_of(run, right);
        std::printf("%s    {\"phase\": \"%s\", \"us_per_triangle\": %.4f, \"us_per_triangle_all_threads\": %.4f, \"right\": %s}", separator,
                    what.c_str(), 1e6 * cost.one_thread / count, 1e6 * cost.all_threads / count, right ? "true" : "false");
        separator = ",\n";
        all_right = all_right && right;
        std::fflush(stdout);
    };
    geometry::Mesh copy = mesh;
    phase("connectivity", [&] {
        copy.edges.clear();
        geometry::build_connectivity(copy);
        return copy.edges == mesh.edges;
    });
    phase("welding", [&] { return geometry::have_same_shape(geometry::weld_exactly(mesh), mesh); });
    phase("half edges", [&] { return geometry::sorted_half_edges(mesh).size() == 3 * mesh.triangles.size(); });
    phase("closed", [&] { return solids::bounds_a_solid(mesh) && geometry::is_nearly_closed(mesh.vertices, mesh.triangles); });
    phase("volume moments", [&] {
        const double found = geometry::capped_solid_moments(mesh.vertices, mesh.triangles)(3, 3);
        return found > 0 && (!volume || std::abs(found - *volume) < 1e-3 * *volume);
    });
    phase("repair", [&] { return solids::repair_mesh(copy).empty(); });
    phase("judgement", [&] { return solids::judge_mesh(mesh, true).errors.empty(); });
    phase("strict validity", [&] { return solids::validate_mesh(mesh, {}).empty(); });
    phase("hierarchy", [&] { return holds_its_elements(geometry::BodyHierarchy(mesh), mesh); });
    const scene::Scene scene = two_of(mesh);
    phase("model of two copies, with mesh and start check", [&] { return static_cast<bool>(setup::build_model(scene)); });
    std::printf("\n  ], \"right\": %s}", all_right ? "true" : "false");
}

}  // namespace

int main(int argc, char** argv) {
    int wanted = 1'000'000;
    std::string file;
    CLI::App app("What a start costs, by phase; prints JSON.");
    app.add_option("triangles", wanted, "of a bumpy torus")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("mesh", file, "that too")->check(CLI::ExistingFile);
    CLI11_PARSE(app, argc, argv);
    const int n = std::max(8, static_cast<int>(std::sqrt(wanted)));
    std::printf("{\"threads\": %d, \"meshes\": [\n", base::thread_count());
    run_phases("torus", torus(n, std::max(8, wanted / 2 / n), 0), 2 * M_PI * M_PI * 0.02 * 0.006 * 0.006);
    std::printf(",\n");
    run_phases("bumpy torus", torus(n, std::max(8, wanted / 2 / n), 0.2), std::nullopt);
    if (!file.empty()) {
        const auto read = mesh_files::read_mesh(file);
        if (!read) return std::fprintf(stderr, "%s\n", read.errors().front().message.c_str()), 2;
        std::printf(",\n");
        run_phases(file, *read, std::nullopt);
    }
    std::printf("\n]}\n");
}
