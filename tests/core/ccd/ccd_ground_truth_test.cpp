// SPDX-License-Identifier: MIT
// Public ground-truth queries (../shared/ccd/README.md): skipped where they are not there.
#include <catch2/catch.hpp>
#include <string>

#include "core/ccd/curved_ccd.hpp"
#include "tests/support/ccd_queries.hpp"
#include "tests/support/exact_ccd.hpp"
#include "tests/support/inclusion_ccd.hpp"
#include "tests/support/shared_files.hpp"

namespace fettle::core::ccd::ccd_ground_truth_test {

using namespace fettle::tests;
using support::CcdQueries;
using support::LinearQuery;
using support::RigidQuery;

namespace {

/// All queries of the files below a folder of ../shared/ccd.
std::vector<CcdQueries> read_folder(const std::string& folder) {
    std::vector<CcdQueries> queries;
    const std::vector<std::string> files = support::find_ccd_query_files({support::shared_file("ccd/" + folder)}).value();
    for (const std::string& file : files) queries.push_back(support::read_ccd_queries(file).value());
    return queries;
}

struct Tally {
    long queries = 0, hits = 0, false_negatives = 0, false_positives = 0, far = 0, zero = 0;
};

/// Is the distance within sqrt(3) (1e-6 + dmin) at toi? Past its limit of boxes, the inclusion method's toi is earlier than that:
/// then at the toi of the other method.
bool comes_near(const LinearQuery& q, double toi, double dmin) {
    const double reach = 1.7320508075688774 * (1e-6 + dmin);
    return exact_distance_at_most(q.type, q.t0, q.t1, toi, reach) ||
           exact_distance_at_most(q.type, q.t0, q.t1, linear_ccd(q.type, q.t0, q.t1, dmin).toi, reach);
}

using LinearCcd = LinearCcdResult(geometry::PairType, const geometry::PairVertices&, const geometry::PairVertices&, double,
                                  const LinearCcdOptions&);

/// Runs every query of the folder; `far` counts false positives beyond sqrt(3) (tolerance + dmin), `zero` tois of 0 of pairs that start
/// apart.
Tally run(const std::string& folder, LinearCcd* ccd, double dmin) {
    Tally t;
    for (const CcdQueries& file : read_folder(folder)) {
        for (const LinearQuery& q : file.linear) {
            const LinearCcdResult r = ccd(q.type, q.t0, q.t1, dmin, {});
            ++t.queries;
            REQUIRE(q.truth.has_value());
            t.hits += *q.truth;
            t.false_negatives += *q.truth && !r.hit;
            const bool false_positive = r.hit && !*q.truth;
            t.false_positives += false_positive;
            if (false_positive) t.far += !comes_near(q, r.toi, dmin);
            if (r.hit && r.toi == 0) t.zero += !exact_distance_at_most(q.type, q.t0, q.t1, 0, dmin);
        }
    }
    return t;
}

void report(const std::string& name, const Tally& t) {
    WARN(name << ": " << t.queries << " queries, " << t.hits << " hits, " << t.false_negatives << " misses, " << t.false_positives
              << " false positives");
}

}  // namespace

TEST_CASE("advancement on the public linear queries") {
    FETTLE_NEEDS_SHARED();
    for (const std::string folder : {"sample-queries", "scalable"}) {
        const Tally t = run(folder, linear_ccd, 0);
        report("advancement, " + folder, t);
        CHECK(t.queries > 4000);
        CHECK(t.false_negatives == 0);
        CHECK(t.zero == 0);
        CHECK(t.far == 0);
    }
}

TEST_CASE("advancement with a minimum separation on the public linear queries") {
    FETTLE_NEEDS_SHARED();
    for (const double dmin : {1e-8, 1e-3}) {
        const Tally t = run("sample-queries", linear_ccd, dmin);
        CHECK(t.false_negatives == 0);
        CHECK(t.zero == 0);
        CHECK(t.far == 0);
    }
}

TEST_CASE("inclusion on the public linear queries", "[slow]") {
    FETTLE_NEEDS_SHARED();
    for (const std::string folder : {"sample-queries", "scalable"}) {
        const Tally t = run(folder, support::inclusion_ccd, 0);
        report("inclusion, " + folder, t);
        CHECK(t.false_negatives == 0);
        CHECK(t.zero == 0);
        CHECK(t.far == 0);
    }
}

TEST_CASE("the public truth of linear queries is what exact arithmetic says", "[slow]") {
    FETTLE_NEEDS_SHARED();
    long different = 0;
    for (const std::string folder : {"sample-queries", "scalable"}) {
        for (const CcdQueries& file : read_folder(folder)) {
            for (const LinearQuery& q : file.linear) different += exact_linear_contact(q.type, q.t0, q.t1) != *q.truth;
        }
    }
    CHECK(different == 0);
}

TEST_CASE("curved CCD on the public rigid queries") {
    FETTLE_NEEDS_SHARED();
    for (const DeviationBound bound : {DeviationBound::closed_form, DeviationBound::interval}) {
        const bool closed = bound == DeviationBound::closed_form;
        CurvedCcdOptions options;
        options.deviation = bound;
        if (!closed) options.max_pieces = 64;
        for (const std::string folder : {"wrecking-ball", "kinematic"}) {
            long queries = 0, hits = 0, zero = 0;
            for (const CcdQueries& file : read_folder("rigid/" + folder)) {
                const RigidQuery& q = file.rigid.at(0);
                const CurvedCcdResult r = curved_ccd(q.type, q.a, q.b, q.X, 0, options);
                ++queries;
                hits += r.hit;
                zero += r.hit && r.toi == 0;
            }
            CAPTURE(closed, folder, queries);
            CHECK(zero == 0);
            // No wrecking-ball query touches; every kinematic one comes within 1e-9.
            CHECK(hits == (folder == "kinematic" ? queries : 0));
        }
    }
}

}  // namespace fettle::core::ccd::ccd_ground_truth_test
