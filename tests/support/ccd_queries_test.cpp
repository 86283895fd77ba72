// SPDX-License-Identifier: MIT
#include "tests/support/ccd_queries.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/shared_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::tests::support::ccd_queries_test {

using namespace fettle::core::ccd;
namespace fs = std::filesystem;

namespace {

using Folder = TemporaryFolder;

std::string rows(const std::string& row, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += row + "\n";
    return text;
}

Error only_error(const Result<CcdQueries>& result) {
    REQUIRE(!result);
    REQUIRE(result.errors().size() == 1);
    return result.errors()[0];
}

const std::string rigid_text = R"({"type": "fv",
 "face": {"pose_t0": {"position": [1, 2, 3], "rotation": [0, 0, 1]}, "pose_t1": {"position": [1, 2, 4], "rotation": [0, 0, 3]},
          "vertex0": [0, 0, 0], "vertex1": [1, 0, 0], "vertex2": [0, 1, 0]},
 "vertex": {"pose_t0": {"position": [0, 0, 0], "rotation": [0, 0, 0]}, "pose_t1": {"position": [5, 0, 0], "rotation": [0, 0, 0]},
            "vertex": [7, 8, 9]}})";

}  // namespace

TEST_CASE("rational coordinates are read exactly, whatever the size of their denominators") {
    const Folder f;
    // 3 / 2^111, (2^53 - 1) / 2^60, -5 * 2^80 over 2^80, spaces, CR LF, a blank line at the end
    const std::string row =
        "3,2596148429267413814265248164610048, 9007199254740991,1152921504606846976 ,-6044629098073145873530880,"
        "1208925819614629174706176,1\r";
    const auto queries = read_ccd_queries(f.write("vertex-face/a.csv", rows(row, 16) + "\n"));
    REQUIRE(queries);
    REQUIRE(queries->linear.size() == 2);
    CHECK(queries->rigid.empty());
    const LinearQuery& q = queries->linear[1];
    CHECK(q.type == core::geometry::PairType::point_triangle);
    CHECK(q.truth == true);
    for (const core::geometry::PairVertices* x : {&q.t0, &q.t1})
        for (const Vector3& v : *x) CHECK(v == Vector3(3 * 0x1p-111, 0x1.fffffffffffffp-8, -5));
}

TEST_CASE("the kind of pair and the truth come from names and files beside") {
    const Folder f;
    const std::string row = "1,2,0,1,-3,4";
    CHECK(read_ccd_queries(f.write("q/12ee.csv", rows(row, 8)))->linear[0].type == core::geometry::PairType::edge_edge);
    CHECK(read_ccd_queries(f.write("q/12vf.csv", rows(row, 8)))->linear[0].type == core::geometry::PairType::point_triangle);
    CHECK(read_ccd_queries(f.write("edge-edge/data.csv", rows(row, 8)))->linear[0].type == core::geometry::PairType::edge_edge);
    const std::string unnamed = f.write("q/data.csv", rows(row, 8));
    CHECK(only_error(read_ccd_queries(unnamed)).code == ErrorCode::unsupported);
    CHECK(read_ccd_queries(unnamed, core::geometry::PairType::edge_edge)->linear[0].type == core::geometry::PairType::edge_edge);

    const std::string file = f.write("queries/1vf.csv", rows(row, 16));
    CHECK_FALSE(read_ccd_queries(file)->linear[0].truth.has_value());
    const std::string truth = f.write("mma_bool/1vf_mma_bool.json", "[false, true]");
    CHECK(read_ccd_queries(file)->linear[0].truth == false);
    CHECK(read_ccd_queries(file)->linear[1].truth == true);
    f.write("mma_bool/1vf_mma_bool.json", "[false]");
    CHECK(only_error(read_ccd_queries(file)).code == ErrorCode::inconsistent);
    f.write("mma_bool/1vf_mma_bool.json", "[false, 3]");
    CHECK(only_error(read_ccd_queries(file)).where.find("1vf_mma_bool.json#/1") != std::string::npos);
    fs::remove(truth);
    f.write("queries/1vf_mma_bool.json", "[true, true]");
    CHECK(read_ccd_queries(file)->linear[0].truth == true);
}

TEST_CASE("faults of query files are named by file and line") {
    const Folder f;
    const auto fault = [&](const std::string& text) { return only_error(read_ccd_queries(f.write("vertex-face/a.csv", text))); };
    const std::string good = "0,1,0,1,0,1,0";
    const auto at_line_3 = [&](const std::string& row) {
        const Error error = fault(rows(good, 2) + row + "\n" + rows(good, 5));
        CHECK(error.where == (f.path / "vertex-face/a.csv").string() + ":3");
        return error;
    };
    CHECK(at_line_3("0,1,0,1,0").code == ErrorCode::parse);
    CHECK(at_line_3("0,1,0,1,0,1,0,0").code == ErrorCode::parse);
    CHECK(at_line_3("0,1,0,1,0,1,2").code == ErrorCode::parse);
    CHECK(at_line_3("0,1,x,1,0,1,0").message.find("\"x\" is not a number") != std::string::npos);
    CHECK(at_line_3("0,1,,1,0,1,0").code == ErrorCode::parse);
    CHECK(at_line_3("0,0,0,1,0,1,0").code == ErrorCode::not_finite);
    CHECK(at_line_3("nan,1,0,1,0,1,0").code == ErrorCode::not_finite);
    CHECK(at_line_3("1e999,1,0,1,0,1,0").code == ErrorCode::not_finite);
    CHECK(at_line_3("0,1,0,1,0,1,1").code == ErrorCode::inconsistent);
    CHECK(at_line_3("0,1,0,1,0,1").code == ErrorCode::inconsistent);
    CHECK(fault(rows(good, 12)).message.find("within a query") != std::string::npos);
    CHECK(fault("").code == ErrorCode::parse);
    CHECK(only_error(read_ccd_queries((f.path / "none.csv").string())).code == ErrorCode::file_not_found);
    CHECK(only_error(read_ccd_queries(f.path.string())).code == ErrorCode::file_unreadable);
    CHECK(only_error(read_ccd_queries(f.write("a.txt", good))).code == ErrorCode::unsupported);
}

TEST_CASE("rigid queries: both kinds, and their faults") {
    const Folder f;
    const auto queries = read_ccd_queries(f.write("a.json", rigid_text));
    REQUIRE(queries);
    REQUIRE(queries->rigid.size() == 1);
    const RigidQuery& q = queries->rigid[0];
    CHECK(q.type == core::geometry::PairType::point_triangle);
    CHECK(q.a.position_step == Vector3(5, 0, 0));
    CHECK(q.b.rotation_vector_t0 == Vector3(0, 0, 1));
    CHECK(q.b.rotation_vector_step == Vector3(0, 0, 2));
    CHECK(q.b.position_step == Vector3(0, 0, 1));
    CHECK(q.X[0] == Vector3(7, 8, 9));
    CHECK(q.X[2] == Vector3(1, 0, 0));
    const auto fault = [&](const std::string& from, const std::string& to) {
        std::string text = rigid_text;
        text.replace(text.find(from), from.size(), to);
        return only_error(read_ccd_queries(f.write("b.json", text)));
    };
    CHECK(fault("\"fv\"", "\"ev\"").where == (f.path / "b.json").string() + "#/type");
    CHECK(fault("\"vertex1\"", "\"vertex9\"").where == (f.path / "b.json").string() + "#/face");
    CHECK(fault("\"vertex1\"", "\"vertex9\"").message.find("vertex1") != std::string::npos);
    CHECK(fault("[7, 8, 9]", "[7, 8]").where.find("#/vertex/vertex") != std::string::npos);
    CHECK(fault("{\"type\"", "{\"tpye\"").code == ErrorCode::missing_key);
    CHECK(only_error(read_ccd_queries(f.write("c.json", "[true, false]"))).code == ErrorCode::unsupported);
    CHECK(only_error(read_ccd_queries(f.write("c.json", "{"))).code == ErrorCode::parse);
}

TEST_CASE("folders become their files, sorted, without files of truth") {
    const Folder f;
    f.write("b/2vf.csv", "");
    f.write("b/1.json", "");
    f.write("a/3ee.csv", "");
    f.write("mma_bool/3ee_mma_bool.json", "[true]");
    f.write("boxes/3ee.json", "\n [[1, 2]]");
    f.write("LICENSE", "");
    const std::string root = f.path.string();
    const auto files = find_ccd_query_files({root, root + "/b/2vf.csv", root + "/mma_bool/3ee_mma_bool.json"});
    REQUIRE(files);
    CHECK(*files == std::vector<std::string>{root + "/a/3ee.csv", root + "/b/1.json", root + "/b/2vf.csv", root + "/b/2vf.csv"});
    CHECK(find_ccd_query_files({root + "/nothing"}).errors()[0].code == ErrorCode::file_not_found);
    CHECK(find_ccd_query_files({root + "/mma_bool"}).errors()[0].code == ErrorCode::file_not_found);
}

TEST_CASE("the public files are read whole") {
    FETTLE_NEEDS_SHARED();
    std::size_t linear = 0, with_truth = 0, rigid = 0;
    const std::vector<std::string> files = find_ccd_query_files({tests::support::shared_file("ccd")}).value();
    for (const std::string& file : files) {
        const auto queries = read_ccd_queries(file);
        REQUIRE(queries);
        linear += queries->linear.size();
        rigid += queries->rigid.size();
        for (const LinearQuery& q : queries->linear) with_truth += q.truth.has_value();
    }
    CHECK(linear == 4779 + 5526);
    CHECK(with_truth == linear);
    CHECK(rigid == 193 + 13);
}

}  // namespace fettle::tests::support::ccd_queries_test
