// SPDX-License-Identifier: MIT
#include "tests/support/ccd_queries.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/files/json_document.hpp"

namespace fettle::tests::support {

using core::files::JsonDocument;
using core::files::JsonNode;
namespace fs = std::filesystem;

namespace {

constexpr std::string_view truth_ending = "_mma_bool.json";
constexpr std::size_t rows_per_query = 8;

bool ends_in(std::string_view text, std::string_view ending) { return text.size() >= ending.size() && text.ends_with(ending); }

struct CsvRow {
    Vector3 point;
    std::optional<bool> truth;
};

/// Comma-separated numbers of one line.
class CsvRowParser {
public:
    CsvRowParser(std::string_view line, std::string where) : rest_(line), where_(std::move(where)) {
        while (!rest_.empty() && (rest_.back() == '\r' || rest_.back() == ' ' || rest_.back() == '\t')) rest_.remove_suffix(1);
    }

    Result<CsvRow> row() {
        CsvRow row;
        for (int k = 0; k < 3; ++k) {
            const Result<double> coordinate = rational();
            if (!coordinate) return coordinate.errors();
            row.point[k] = *coordinate;
        }
        if (at_end_) return row;
        const std::string_view truth = field();
        if ((truth != "0" && truth != "1") || !at_end_) {
            return fault(ErrorCode::parse,
                         "after the three coordinates only the truth may stand, 0 or 1; found \"" + std::string(truth) + "\"");
        }
        row.truth = truth == "1";
        return row;
    }

private:
    Error fault(ErrorCode code, const std::string& message) const { return {code, where_, message}; }

    std::string_view field() {
        const std::size_t comma = rest_.find(',');
        at_end_ = comma == std::string_view::npos;
        std::string_view found = rest_.substr(0, comma);
        rest_.remove_prefix(at_end_ ? rest_.size() : comma + 1);
        while (!found.empty() && (found.front() == ' ' || found.front() == '\t')) found.remove_prefix(1);
        while (!found.empty() && (found.back() == ' ' || found.back() == '\t')) found.remove_suffix(1);
        return found;
    }

    Result<long double> number() {
        if (at_end_) return fault(ErrorCode::parse, "too few columns; a row is xn,xd,yn,yd,zn,zd[,truth]");
        const std::string_view text = field();
        // 64 bits of precision and 15 of exponent: exact for every multiple of a power of two that a double's quotient comes from.
        long double value = 0;
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (code == std::errc::invalid_argument || end != text.data() + text.size()) {
            return fault(ErrorCode::parse, "\"" + std::string(text) + "\" is not a number; a row is xn,xd,yn,yd,zn,zd[,truth]");
        }
        return value;
    }

    Result<double> rational() {
        const Result<long double> numerator = number();
        if (!numerator) return numerator.errors();
        const Result<long double> denominator = number();
        if (!denominator) return denominator.errors();
        const double value = static_cast<double>(*numerator / *denominator);
        if (*denominator == 0 || !std::isfinite(value)) return fault(ErrorCode::not_finite, "a coordinate that is not a finite number");
        return value;
    }

    std::string_view rest_;
    std::string where_;
    bool at_end_ = false;
};

std::optional<PairType> type_of(const fs::path& file) {
    const std::string name = file.stem().string(), folder = file.parent_path().filename().string();
    if (folder == "vertex-face" || ends_in(name, "vf") || ends_in(name, "vertex-face")) return PairType::point_triangle;
    if (folder == "edge-edge" || ends_in(name, "ee") || ends_in(name, "edge-edge")) return PairType::edge_edge;
    return std::nullopt;
}

/// Adds row `row` (of the whole file, from 0) to its query.
std::optional<Error> add_row(CcdQueries& queries, PairType type, std::size_t row, const CsvRow& read, const std::string& where) {
    if (row % rows_per_query == 0) {
        queries.linear.emplace_back();
        queries.linear.back().type = type;
        queries.linear.back().truth = read.truth;
    }
    LinearQuery& query = queries.linear.back();
    (row % rows_per_query < 4 ? query.t0 : query.t1)[row % 4] = read.point;
    if (query.truth == read.truth) return std::nullopt;
    return Error{ErrorCode::inconsistent, where, "the truth is not the same in all 8 rows of the query"};
}

Result<std::vector<bool>> read_truth(const std::string& path) {
    Result<JsonDocument> document = JsonDocument::read(path);
    if (!document) return document.errors();
    std::vector<bool> truth;
    for (const JsonNode& entry : document->root().elements()) truth.push_back(entry.boolean().value_or(false));
    if (!document->errors().empty()) return document->errors();
    return truth;
}

/// Truth from the file beside, for queries without a column for it.
Errors add_truth(CcdQueries& queries) {
    if (std::any_of(queries.linear.begin(), queries.linear.end(), [](const LinearQuery& q) { return q.truth.has_value(); })) return {};
    const fs::path file(queries.path);
    const std::string name = file.stem().string() + std::string(truth_ending);
    for (const fs::path& beside : {file.parent_path() / name, file.parent_path() / ".." / "mma_bool" / name}) {
        std::error_code ignored;
        if (!fs::exists(beside, ignored)) continue;
        const Result<std::vector<bool>> truth = read_truth(beside.string());
        if (!truth) return truth.errors();
        if (truth->size() != queries.linear.size()) {
            return {{ErrorCode::inconsistent, beside.string(),
                     "holds the truth of " + std::to_string(truth->size()) + " queries; " + queries.path + " holds " +
                         std::to_string(queries.linear.size())}};
        }
        for (std::size_t i = 0; i < truth->size(); ++i) queries.linear[i].truth = (*truth)[i];
        return {};
    }
    return {};
}

Result<CcdQueries> read_linear(const std::string& path, const std::optional<PairType>& given) {
    const std::optional<PairType> type = type_of(fs::path(path)).has_value() ? type_of(fs::path(path)) : given;
    if (!type) {
        return Error{ErrorCode::unsupported, path,
                     "vertex-face or edge-edge? Neither the folder's name nor the end of the file's (vf, ee) says; say so with --type"};
    }
    std::ifstream in(path);
    if (!in) return Error{ErrorCode::file_unreadable, path, "cannot be read"};
    CcdQueries queries;
    queries.path = path;
    std::size_t rows = 0, line_number = 0;
    for (std::string line; std::getline(in, line);) {
        const std::string where = path + ":" + std::to_string(++line_number);
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const Result<CsvRow> row = CsvRowParser(line, where).row();
        if (!row) return row.errors();
        if (const auto error = add_row(queries, *type, rows++, *row, where)) return *error;
    }
    if (in.bad()) return Error{ErrorCode::file_unreadable, path, "cannot be read to its end"};
    if (rows == 0) return Error{ErrorCode::parse, path, "holds no queries; a query is 8 rows xn,xd,yn,yd,zn,zd[,truth]"};
    if (rows % rows_per_query != 0) {
        return Error{ErrorCode::parse, path + ":" + std::to_string(line_number),
                     "the file ends within a query: " + std::to_string(rows) + " rows are no multiple of 8"};
    }
    const Errors errors = add_truth(queries);
    if (!errors.empty()) return errors;
    return queries;
}

core::kinematics::PathSegment path_of(const JsonNode& body) {
    const auto read = [&](std::string_view pose, std::string_view part) {
        return body.require(pose).require(part).vector3().value_or(Vector3::Zero());
    };
    core::kinematics::PathSegment p;
    p.position_t0 = read("pose_t0", "position");
    p.rotation_vector_t0 = read("pose_t0", "rotation");
    p.position_step = read("pose_t1", "position") - p.position_t0;
    p.rotation_vector_step = read("pose_t1", "rotation") - p.rotation_vector_t0;
    return p;
}

Result<CcdQueries> read_rigid(const std::string& path) {
    Result<JsonDocument> document = JsonDocument::read(path);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    if (root.is_array()) {
        return Error{ErrorCode::unsupported, path,
                     "an array, not a query; the truth of a CSV file (*_mma_bool.json) is read with that file"};
    }
    RigidQuery q;
    const auto type = root.require("type").choice({"ee", "fv"});
    if (!document->errors().empty()) return document->errors();
    q.type = *type == "ee" ? PairType::edge_edge : PairType::point_triangle;
    const bool edges = q.type == PairType::edge_edge;
    const JsonNode a = root.require(edges ? "edge0" : "vertex"), b = root.require(edges ? "edge1" : "face");
    const auto vertex = [](const JsonNode& body, std::string_view key) { return body.require(key).vector3().value_or(Vector3::Zero()); };
    if (document->errors().empty()) {
        q.a = path_of(a);
        q.b = path_of(b);
        if (edges) {
            q.X = {vertex(a, "vertex0"), vertex(a, "vertex1"), vertex(b, "vertex0"), vertex(b, "vertex1")};
        } else {
            q.X = {vertex(a, "vertex"), vertex(b, "vertex0"), vertex(b, "vertex1"), vertex(b, "vertex2")};
        }
    }
    if (!document->errors().empty()) return document->errors();
    return CcdQueries{path, {}, {q}};
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// Can a file found in a folder hold queries? JSON that begins with an array is truth, or the boxes that come with it.
bool may_hold_queries(const fs::path& path) {
    const std::string extension = lower_extension(path);
    if (extension != ".json") return extension == ".csv";
    std::ifstream in(path);
    char first = 0;
    return !(in >> first && first == '[');
}

}  // namespace

Result<CcdQueries> read_ccd_queries(const std::string& path, const std::optional<PairType>& type) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return Error{ErrorCode::file_not_found, path, "there is no such file"};
    if (fs::is_directory(path, ignored)) return Error{ErrorCode::file_unreadable, path, "a folder, not a file of queries"};
    const std::string extension = lower_extension(path);
    if (extension == ".csv") return read_linear(path, type);
    if (extension == ".json") return read_rigid(path);
    return Error{ErrorCode::unsupported, path, "queries are .csv (linear motion) or .json (rigid motion)"};
}

Result<std::vector<std::string>> find_ccd_query_files(const std::vector<std::string>& paths) {
    std::vector<std::string> files;
    Errors errors;
    for (const std::string& path : paths) {
        std::error_code code;
        if (!fs::exists(path, code)) {
            errors.push_back({ErrorCode::file_not_found, path, "there is no such file or folder"});
        } else if (fs::is_directory(path, code)) {
            std::vector<std::string> below;
            for (fs::recursive_directory_iterator it(path, code), end; !code && it != end; it.increment(code)) {
                std::error_code not_a_file;
                if (it->is_regular_file(not_a_file) && may_hold_queries(it->path())) below.push_back(it->path().string());
            }
            if (code) errors.push_back({ErrorCode::file_unreadable, path, "cannot be read: " + code.message()});
            if (!code && below.empty()) errors.push_back({ErrorCode::file_not_found, path, "no .csv or .json file in this folder"});
            std::sort(below.begin(), below.end());
            files.insert(files.end(), below.begin(), below.end());
        } else if (!ends_in(path, truth_ending)) {
            files.push_back(path);
        }
    }
    if (errors.empty() && files.empty()) errors.push_back({ErrorCode::file_not_found, paths.empty() ? "" : paths[0], "no queries in it"});
    if (!errors.empty()) return errors;
    return files;
}

}  // namespace fettle::tests::support
