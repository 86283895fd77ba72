// SPDX-License-Identifier: MIT
// Does certifying a motion of 10 bodies with 50,000 triangles in all over 200 steps to 1 um take at most a fifth of the time of simulating
// it, and how does the cost grow as the tolerance falls? One thread. The mechanism: a chain of ten interlinked rings (tori of 5,000
// triangles, 48 mm across), the first held, swinging under gravity from a bent start: neighbours in contact, the others near and turning.
// All 45 pairs are certified, as the program does by default. Before a time counts, the bounds are checked: lower <= the least distance at
// the ends of the steps (searched one by one), upper attained at its witness (evaluated here in long double), the gap within the tolerance.
// Then once more with a certificate, which is checked. Prints JSON, seconds of the processor. Arguments: steps (200), links (10).
#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <string>

#include "core/base/parallel.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/pair_search.hpp"
#include "core/model/body_geometry.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/test_models.hpp"

using namespace fettle;
using namespace fettle::core;
using namespace fettle::core::certificate;
using namespace fettle::core::clearance;

namespace {

// The processor's time, so that other programs count for less; there is one thread.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double seconds_since(double start) { return cpu_seconds() - start; }

// Torus about z with 2 n m triangles.
geometry::Mesh torus(int n, int m, double major, double minor) {
    Matrix3X x(3, n * m);
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double u = 2 * M_PI * i / n;
        for (int j = 0; j < m; ++j) {
            const double v = 2 * M_PI * j / m, r = major + minor * std::cos(v);
            x.col(i * m + j) << r * std::cos(u), r * std::sin(u), minor * std::sin(v);
            const int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    }
    return geometry::make_mesh("torus", x, triangles);
}

// Rings hang in each other, every second one turned by a right angle; the chain starts along a slope of 30 degrees.
model::Model chain(int links) {
    const double major = 0.02, minor = 0.004, play = 3e-4, pitch = 2 * (major - minor) - play;
    const Vector3 along(std::cos(M_PI / 6), 0, -std::sin(M_PI / 6));
    const Matrix3 tilt = kinematics::rotation(Vector3(0, M_PI / 6, 0));
    model::Model model;
    for (int i = 0; i < links; ++i) {
        const Matrix3 turn = kinematics::rotation(Vector3(i % 2 == 0 ? 0 : M_PI / 2, 0, 0));
        model.bodies.push_back(tests::support::make_body("link " + std::to_string(i), torus(50, 50, major, minor),
                                                         kinematics::Pose{tilt * turn, i * pitch * along},
                                                         i == 0 ? scene::BodyType::static_body : scene::BodyType::dynamic_body));
    }
    core::model::complete_geometry(model.bodies);  // copies share their hierarchies, as in a model from a file
    model.gravity = Vector3(0, 0, -9.81);
    model.timestep = 0.005;
    model.dhat = 1e-4;
    model.diagonal = links * pitch;
    model.velocity_tolerance = 1e-3 * model.diagonal;
    model.kappa = model::choose_kappa(model);
    return model;
}

// Distance of the witness's points by the textbook, at the witness's instant.
long double distance_at_witness(const model::Model& model, const stepper::Trajectory& trajectory, const PairClearance& pair) {
    using namespace tests::clearance;
    const Witness& w = pair.witness;
    const auto placed = [&](int body) {
        return oracle_vertices(stepper::path_segment(trajectory, w.step, w.segment, body), model.bodies[body].mesh.vertices, w.s);
    };
    const RealVertices x = placed(pair.a), y = placed(pair.b);
    const geometry::Mesh &a = model.bodies[pair.a].mesh, &b = model.bodies[pair.b].mesh;
    if (w.edge_edge) {
        const auto &e = a.edges[w.primitive_a], &f = b.edges[w.primitive_b];
        return oracle_edge_distance(x.col(e[0]), x.col(e[1]), y.col(f[0]), y.col(f[1]));
    }
    const auto& t = w.vertex_on_a ? b.triangles[w.primitive_b] : a.triangles[w.primitive_a];
    const RealVertices& z = w.vertex_on_a ? y : x;
    const Real3 p = w.vertex_on_a ? x.col(w.primitive_a) : y.col(w.primitive_b);
    return (p - oracle_closest_on_triangle(p, z.col(t[0]), z.col(t[1]), z.col(t[2]))).norm();
}

// Least distances at the ends of the steps, by a search of these instants one by one.
std::vector<double> least_at_nodes(const model::Model& model, const stepper::Trajectory& trajectory,
                                   const std::vector<PairRequest>& pairs) {
    std::vector<PieceTree> trees;
    for (const model::Body& body : model.bodies) trees.push_back(make_piece_tree(body.mesh, *body.hierarchy));
    SearchOptions options;
    options.nodes_only = true;
    options.tolerance = 1e-12;
    std::vector<double> least;
    for (const PairRequest& pair : pairs) {
        const PieceTree &a = trees[pair.a], &b = trees[pair.b];
        std::vector<PairSegment> segments;
        for (int t = 0; t < count_of(trajectory.steps); ++t)
            for (int k = 0; k < stepper::segment_count(trajectory, t); ++k)
                segments.push_back(pair_segment(stepper::path_segment(trajectory, t, k, pair.a),
                                                stepper::path_segment(trajectory, t, k, pair.b), a.radius(), b.radius()));
        least.push_back(search_pair(a, b, segments, options).nearest.pair.distance);
    }
    return least;
}

}  // namespace

int main(int argc, char** argv) {
    const base::ThreadLimit one_thread(1);
    int steps = 200, links = 10;
    CLI::App app("Certifying the motion of a chain of rings against simulating it; prints JSON.");
    app.add_option("steps", steps, "time steps")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("links", links, "rings of 5,000 triangles")->check(CLI::Range(2, 1000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    const model::Model model = chain(links);
    std::size_t triangles = 0;
    std::vector<PairRequest> pairs;
    for (int a = 0; a < count_of(model.bodies); ++a) {
        triangles += model.bodies[a].mesh.triangles.size();
        for (int b = a + 1; b < count_of(model.bodies); ++b) pairs.push_back({a, b, 0});
    }
    stepper::SimulationOptions simulate;
    simulate.steps = steps;
    const auto start = cpu_seconds();
    const stepper::Simulation simulation = stepper::simulate(model, simulate);
    const double simulated = seconds_since(start);
    std::printf("{\"bodies\": %zu, \"triangles\": %zu, \"steps\": %zu, \"simulation\": \"%s\", \"simulation_seconds\": %.3f,\n \"runs\": [",
                model.bodies.size(), triangles, simulation.trajectory.steps.size(), to_string(simulation.report.status), simulated);
    const std::vector<double> at_nodes = least_at_nodes(model, simulation.trajectory, pairs);
    bool first = true;
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
        ClearanceOptions options;
        options.motion = true;
        options.tolerance = tolerance;
        const auto begin = cpu_seconds();
        const auto results = certify(model, simulation.trajectory, pairs, options);
        const double seconds = seconds_since(begin);
        double gap = 0, least_lower = 1e300, least_upper = 1e300;
        bool agrees = true;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const PairClearance& pair = results[i];
            gap = std::max(gap, pair.upper - pair.lower);
            least_lower = std::min(least_lower, pair.lower);
            least_upper = std::min(least_upper, pair.upper);
            const double found = static_cast<double>(distance_at_witness(model, simulation.trajectory, pair));
            agrees = agrees && std::abs(found - pair.upper) < 1e-12 && pair.lower <= at_nodes[i] &&
                     std::abs(pair.sampled - at_nodes[i]) <= 0.01 * tolerance + 1e-12 && pair.upper - pair.lower <= 1.001 * tolerance;
        }
        std::printf(
            "%s\n  {\"tolerance\": %g, \"seconds\": %.3f, \"of_simulation\": %.4f, \"largest_gap\": %.3g, \"least_lower\": %.12g, "
            "\"least_upper\": %.12g, \"agrees\": %s}",
            first ? "" : ",", tolerance, seconds, seconds / simulated, gap, least_lower, least_upper, agrees ? "true" : "false");
        first = false;
        std::fflush(stdout);
    }
    ClearanceOptions options;
    options.motion = true;
    auto begin = cpu_seconds();
    const Certificate certificate = certify_with_proof(model, simulation.trajectory, pairs, options).certificate;
    const double recorded = seconds_since(begin);
    begin = cpu_seconds();
    const CertificateReport report = check_certificate(certificate, model, simulation.trajectory);
    std::printf(
        "],\n \"certificate\": {\"tolerance\": %g, \"seconds\": %.3f, \"leaves\": %ld, \"check_seconds\": %.3f, \"accepted\": %s}}\n",
        options.tolerance, recorded, report.leaves, seconds_since(begin), report.accepted() ? "true" : "false");
}
