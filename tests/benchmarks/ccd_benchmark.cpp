// SPDX-License-Identifier: MIT
// What does a collision query cost, by each method? With files of queries: their hits, misses, false alarms and times (ccd_files.hpp).
// Without: public queries (../shared/ccd) where they are there, and random pairs that pass each other
// closely, as candidates of a simulation do. Prints JSON; times are of this thread alone. Counts are checked before a time is
// believed: no contact missed, no wrecking-ball query reported. Inclusion is the reference of advancement, the interval bound that of the
// closed form.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "core/ccd/curved_ccd.hpp"
#include "tests/benchmarks/ccd_files.hpp"
#include "tests/support/ccd_queries.hpp"
#include "tests/support/inclusion_ccd.hpp"
#include "tests/support/shared_files.hpp"

using namespace fettle;
using namespace fettle::core::ccd;
using namespace fettle::tests::support;

namespace {

double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::vector<CcdQueries> read_folder(const std::string& folder) {
    std::vector<CcdQueries> queries;
    const std::vector<std::string> files = find_ccd_query_files({shared_file("ccd/" + folder)}).value();
    for (const std::string& file : files) queries.push_back(read_ccd_queries(file).value());
    return queries;
}

std::vector<LinearQuery> linear_queries(const std::string& folder) {
    std::vector<LinearQuery> all;
    for (const CcdQueries& file : read_folder(folder)) all.insert(all.end(), file.linear.begin(), file.linear.end());
    return all;
}

std::vector<RigidQuery> rigid_queries(const std::string& folder) {
    std::vector<RigidQuery> all;
    for (const CcdQueries& file : read_folder(folder)) all.insert(all.end(), file.rigid.begin(), file.rigid.end());
    return all;
}

/// Bodies of size 1 that turn by up to 0.1 rad in a step and pass at gaps from 1e-4 to 1e-1.
std::vector<RigidQuery> passing_queries(int count) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
    std::vector<RigidQuery> all;
    while (count_of(all) < count) {
        RigidQuery q;
        q.type = uniform(random) < 0.5 ? core::geometry::PairType::point_triangle : core::geometry::PairType::edge_edge;
        for (Vector3& x : q.X) x = 0.5 * vector();
        for (core::kinematics::PathSegment* p : {&q.a, &q.b}) {
            p->base = core::kinematics::rotation(vector());
            p->rotation_vector_step = 0.1 * uniform(random) * vector();
            p->position_step = 0.02 * vector();
        }
        core::geometry::PairVertices x;
        const std::size_t first_count = q.type == core::geometry::PairType::point_triangle ? 1 : 2;
        for (std::size_t i = 0; i < 4; ++i) x[i] = world_position(pose_at(i < first_count ? q.a : q.b, 0.5), q.X[i]);
        // Apart along z by the gap, half way.
        double low = 1e9, high = -1e9;
        for (std::size_t i = 0; i < 4; ++i) (i < first_count ? low = std::min(low, x[i].z()) : high = std::max(high, x[i].z()));
        q.a.position_t0.z() += high - low + std::pow(10.0, -4 + 3 * uniform(random));
        all.push_back(q);
    }
    return all;
}

/// [us] per query: as often as it takes for 0.2 s, the best of five.
template <class Query, class Run>
double microseconds(const std::vector<Query>& queries, const Run& run) {
    double best = 1e9;
    for (int repetition = 0; repetition < 5; ++repetition) {
        const double start = thread_seconds();
        double seconds = 0;
        long count = 0;
        do {
            for (const Query& q : queries) run(q);
            count += static_cast<long>(queries.size());
            seconds = thread_seconds() - start;
        } while (seconds < 0.04);
        best = std::min(best, 1e6 * seconds / static_cast<double>(count));
    }
    return best;
}

const char* separator = "\n  ";
void print(const std::string& name, std::size_t queries, double time, double reference, bool right) {
    std::printf("%s{\"case\": \"%s\", \"queries\": %zu, \"microseconds\": %.4f, \"reference_microseconds\": %.4f, \"right\": %s}",
                separator, name.c_str(), queries, time, reference, right ? "true" : "false");
    separator = ",\n  ";
    std::fflush(stdout);
}

void linear_case(const std::string& folder) {
    const std::vector<LinearQuery> queries = linear_queries(folder);
    volatile bool sink = false;
    bool right = true;
    for (const LinearQuery& q : queries) right = right && (!*q.truth || linear_ccd(q.type, q.t0, q.t1, 0).hit);
    const double time = microseconds(queries, [&](const LinearQuery& q) { sink = linear_ccd(q.type, q.t0, q.t1, 0).hit; });
    const double reference = microseconds(queries, [&](const LinearQuery& q) { sink = inclusion_ccd(q.type, q.t0, q.t1, 0).hit; });
    print(folder, queries.size(), time, reference, right);
}

/// `hits`: how many there must be; negative: unknown.
void rigid_case(const std::string& name, const std::vector<RigidQuery>& queries, long hits) {
    CurvedCcdOptions interval;
    interval.deviation = DeviationBound::interval;
    volatile bool sink = false;
    const auto run = [&](const RigidQuery& q, const CurvedCcdOptions& options) {
        sink = curved_ccd(q.type, q.a, q.b, q.X, 0, options).hit;
    };
    long found = 0;
    for (const RigidQuery& q : queries) found += curved_ccd(q.type, q.a, q.b, q.X, 0).hit;
    const double time = microseconds(queries, [&](const RigidQuery& q) { run(q, {}); });
    const double reference = microseconds(queries, [&](const RigidQuery& q) { run(q, interval); });
    print(name, queries.size(), time, reference, hits < 0 || found == hits);
}

void distance_case(const std::vector<RigidQuery>& queries) {
    std::vector<LinearQuery> at_rest;
    for (const RigidQuery& q : queries) {
        LinearQuery placed{q.type, {}, {}, {}};
        const std::size_t first_count = q.type == core::geometry::PairType::point_triangle ? 1 : 2;
        for (std::size_t i = 0; i < 4; ++i) placed.t0[i] = world_position(pose_at(i < first_count ? q.a : q.b, 0), q.X[i]);
        placed.t1 = placed.t0;
        at_rest.push_back(placed);
    }
    volatile double sink = 0;
    const double time = microseconds(at_rest, [&](const LinearQuery& q) { sink = distance_lower_bound(q.type, q.t0); });
    const double reference = microseconds(at_rest, [&](const LinearQuery& q) { sink = linear_ccd(q.type, q.t0, q.t1, 0).toi; });
    print("distance_lower_bound (reference: the query at rest)", at_rest.size(), time, reference, true);
}

}  // namespace

int main(int count, char** words) {
    if (count > 1) return fettle::tests::benchmarks::run_ccd_files(count, words);
    std::printf("[");
    const std::vector<RigidQuery> passing = passing_queries(2000);
    distance_case(passing);
    rigid_case("passing", passing, -1);
    if (has_shared_files()) {
        rigid_case("rigid/wrecking-ball", rigid_queries("rigid/wrecking-ball"), 0);
        rigid_case("rigid/kinematic", rigid_queries("rigid/kinematic"), 13);
        linear_case("sample-queries");
        linear_case("scalable");
    }
    std::printf("\n]\n");
}
