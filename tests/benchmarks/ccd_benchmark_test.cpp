// SPDX-License-Identifier: MIT
// ccd_benchmark with files of queries: keys, exit codes, messages.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/shared_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::tests::benchmarks::ccd_benchmark_test {

namespace {

using Json = nlohmann::json;
using support::Answer;
using support::shared_file;

Answer run(const std::string& arguments, bool with_errors = false) {
    return support::run_program(FETTLE_CCD_BENCHMARK, arguments, with_errors);
}

/// Query files of a point that passes through, or beside, a triangle.
struct Queries : support::TemporaryFolder {
    /// `x`: of the point, which falls from z = 1 to z = -1; the triangle is (0 0 0), (1 0 0), (0 1 0).
    static std::string query(const std::string& x, const std::string& truth) {
        const std::string triangle = "0,1,0,1,0,1" + truth + "\n1,1,0,1,0,1" + truth + "\n0,1,1,1,0,1" + truth + "\n";
        return x + ",1,4,1,1" + truth + "\n" + triangle + x + ",1,4,-1,1" + truth + "\n" + triangle;
    }
};

}  // namespace

TEST_CASE("ccd_benchmark: counts, keys and exit codes") {
    const Queries q;
    const std::string file = q.write("a_vf.csv", Queries::query("1,4", ",1") + Queries::query("2,1", ",0") + Queries::query("4,1", ",0"));
    for (const std::string method : {"default", "inclusion", "conservative"}) {
        const Answer answer = run(file + " --json --method " + method);
        CHECK(answer.code == 0);
        const Json json = answer.json();
        CHECK(json.at("status") == "ok");
        CHECK(json.at("queries") == 3);
        CHECK(json.at("truth_hits") == 1);
        CHECK(json.at("hits") == 1);
        CHECK(json.at("false_negatives") == 0);
        CHECK(json.at("false_positives") == 0);
        for (const char* key : {"mean_microseconds", "median_microseconds", "worst_microseconds"}) CHECK(json.at(key).get<double>() >= 0);
        CHECK(json.at("files").size() == 1);
        CHECK(json.at("files").at(0).at("file") == file);
        CHECK(json.at("method") == (method == "inclusion" ? "inclusion" : "conservative"));
    }
    // The point of the second query passes at 1 from the triangle: at most 1.5 is a hit, at most 0.5 is none.
    CHECK(run(file + " --json --minimum-separation 1.5m").json()["false_positives"] == 1);
    CHECK(run(file + " --json --minimum-separation 1.5").json()["minimum_separation"] == 1.5);
    CHECK(run(file + " --json --minimum-separation 500mm").json()["false_positives"] == 0);
    const Answer text = run(file);
    CHECK(text.code == 0);
    CHECK(text.out.find("a_vf.csv") != std::string::npos);
    CHECK(text.out.find("in all") != std::string::npos);
}

TEST_CASE("ccd_benchmark: a contact that the file claims and nobody finds is a violation, no truth is null") {
    const Queries q;
    const Answer missed = run(q.write("b_vf.csv", Queries::query("1,4", ",1") + Queries::query("2,1", ",1")) + " --json");
    CHECK(missed.code == 1);
    CHECK(missed.json()["status"] == "missed");
    CHECK(missed.json()["false_negatives"] == 1);
    CHECK(missed.json()["missed"][0]["query"] == 1);
    const Answer untold = run(q.write("c_vf.csv", Queries::query("1,4", "")) + " --json");
    CHECK(untold.code == 0);
    CHECK(untold.json()["hits"] == 1);
    CHECK(untold.json()["truth_hits"].is_null());
    CHECK(untold.json()["false_negatives"].is_null());
    CHECK(untold.json()["false_positives"].is_null());
    // Several files, a folder: the counts of truth are over the queries that have one.
    const Json both = run(q.path.string() + " --json").json();
    CHECK(both.at("queries") == 3);
    CHECK(both.at("queries_with_truth") == 2);
    CHECK(both.at("files").size() == 2);
}

TEST_CASE("ccd_benchmark: bad input and usage end with 3 and the place") {
    const Queries q;
    const std::string broken = q.write("d_vf.csv", "0,1,0,1,0,1\n0,1,0,1,0,q\n");
    const Answer answer = run(broken + " --json");
    CHECK(answer.code == 3);
    CHECK(answer.json()["status"] == "error");
    CHECK(answer.json()["errors"][0]["where"] == broken + ":2");
    CHECK(run("/nowhere/x.csv").code == 3);
    const std::string good = q.write("e.csv", Queries::query("1,4", ",1"));
    CHECK(run(good, true).out.find("--type") != std::string::npos);
    CHECK(run(good).code == 3);
    CHECK(run(good + " --type vertex-face").code == 0);
    const std::string typed = q.write("f_vf.csv", Queries::query("1,4", ",1"));
    for (const std::string option : {"--method nonsense", "--minimum-separation=-1mm", "--minimum-separation 1parsec", "--tolerance 0",
                                     "--deviation none", "--type edge"}) {
        CAPTURE(option);
        CHECK(run(typed + " " + option).code == 3);
    }
    const Answer help = run("--help");
    CHECK(help.code == 0);
    CHECK(help.out.find("Example") != std::string::npos);
}

TEST_CASE("ccd_benchmark: the public queries") {
    FETTLE_NEEDS_SHARED();
    const Answer linear =
        run(shared_file("ccd/sample-queries") + " " + shared_file("ccd/scalable/cloth-funnel/queries/227vf.csv") + " --json");
    CHECK(linear.code == 0);
    CHECK(linear.json()["false_negatives"] == 0);
    CHECK(linear.json()["queries"].get<int>() > 4779);
    CHECK(linear.json()["queries_with_truth"] == linear.json()["queries"]);
    for (const std::string bound : {"closed-form", "interval"}) {
        const Answer rigid = run(shared_file("ccd/rigid/wrecking-ball") + " --json --deviation " + bound);
        CHECK(rigid.code == 0);
        CHECK(rigid.json()["queries"] == 193);
        CHECK(rigid.json()["hits"] == 0);
        CHECK(rigid.json()["truth_hits"].is_null());
        CHECK(rigid.json()["files"][0]["kind"] == "rigid");
    }
}

}  // namespace fettle::tests::benchmarks::ccd_benchmark_test
