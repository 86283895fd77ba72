// SPDX-License-Identifier: MIT
#include "ccd_queries.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace fettle::tests {

using core::contact::PairType;
using nlohmann::json;

namespace {

json read_json(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return json::parse(in);
}

PairType type_of(const std::filesystem::path& file) {
    const std::string name = file.stem().string(), folder = file.parent_path().filename().string();
    if (folder == "vertex-face" || name.ends_with("vf")) return PairType::point_triangle;
    if (folder == "edge-edge" || name.ends_with("ee")) return PairType::edge_edge;
    throw std::runtime_error("neither vertex-face nor edge-edge: " + file.string());
}

Vector3 vector_of(const json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

core::kinematics::PathSegment path_of(const json& j) {
    core::kinematics::PathSegment p;
    p.position_t0 = vector_of(j.at("pose_t0").at("position"));
    p.position_step = vector_of(j.at("pose_t1").at("position")) - p.position_t0;
    p.rotation_vector_t0 = vector_of(j.at("pose_t0").at("rotation"));
    p.rotation_vector_step = vector_of(j.at("pose_t1").at("rotation")) - p.rotation_vector_t0;
    return p;
}

/// One row: a point, and the truth if there is a seventh column.
Vector3 point_of(const std::string& line, std::optional<bool>& truth) {
    std::array<long double, 6> number{};
    const char* at = line.c_str();
    for (auto& n : number) {
        char* end = nullptr;
        n = std::strtold(at, &end);
        if (end == at) throw std::runtime_error("malformed row: " + line);
        at = *end == ',' ? end + 1 : end;
    }
    if (*at == '0' || *at == '1') truth = *at == '1';
    return {static_cast<double>(number[0] / number[1]), static_cast<double>(number[2] / number[3]),
            static_cast<double>(number[4] / number[5])};
}

}  // namespace

std::vector<LinearQuery> read_linear_queries(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    std::vector<LinearQuery> queries;
    std::string line;
    for (std::size_t row = 0; std::getline(in, line); ++row) {
        if (row % 8 == 0) queries.emplace_back().type = type_of(file);
        LinearQuery& q = queries.back();
        (row % 8 < 4 ? q.t0 : q.t1)[row % 4] = point_of(line, q.truth);
    }
    const auto truth_file = file.parent_path().parent_path() / "mma_bool" / (file.stem().string() + "_mma_bool.json");
    if (std::filesystem::exists(truth_file)) {
        const json truth = read_json(truth_file);
        if (truth.size() != queries.size()) throw std::runtime_error("truth of another length: " + truth_file.string());
        for (std::size_t i = 0; i < queries.size(); ++i) queries[i].truth = truth[i].get<bool>();
    }
    return queries;
}

RigidQuery read_rigid_query(const std::filesystem::path& file) {
    const json j = read_json(file);
    RigidQuery q;
    if (j.at("type") == "ee") {
        q.type = PairType::edge_edge;
        const json &a = j.at("edge0"), &b = j.at("edge1");
        q.a = path_of(a);
        q.b = path_of(b);
        q.X = {vector_of(a.at("vertex0")), vector_of(a.at("vertex1")), vector_of(b.at("vertex0")), vector_of(b.at("vertex1"))};
    } else {
        const json &a = j.at("vertex"), &b = j.at("face");
        q.a = path_of(a);
        q.b = path_of(b);
        q.X = {vector_of(a.at("vertex")), vector_of(b.at("vertex0")), vector_of(b.at("vertex1")), vector_of(b.at("vertex2"))};
    }
    return q;
}

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder, const std::string& extension) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == extension) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace fettle::tests
