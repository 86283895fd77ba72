// SPDX-License-Identifier: MIT
#include "design/studies/exploration_file.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_text.hpp"

namespace fettle::design::studies {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* first_key = "fettle_explore";
constexpr int version = 1;

bool is_header(const Json& json) { return json.is_object() && json.contains(first_key) && json[first_key] == version; }

bool are_numbers(const Json& result, const char* key) {
    if (!result.contains(key)) return true;
    const Json& group = result[key];
    return group.is_object() && std::all_of(group.begin(), group.end(), [](const Json& x) { return x.is_number() || x.is_null(); });
}

bool is_result(const Json& json) {
    const auto has_text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
    const auto may_be_number = [&](const char* key) { return !json.contains(key) || json[key].is_number() || json[key].is_null(); };
    if (!json.is_object() || !has_text("key") || !has_text("status") || !may_be_number("objective") || !may_be_number("violation"))
        return false;
    return are_numbers(json, "parameters") && are_numbers(json, "terms") && are_numbers(json, "constraints") &&
           are_numbers(json, "certified");
}

// Discarded where it is no JSON that is safe to look at.
Json parsed(std::string_view line) {
    return core::files::is_safe_json_text(line) ? Json::parse(line, nullptr, false) : Json(Json::value_t::discarded);
}

void read_results(std::string_view text, const std::string& path, Exploration& found) {
    int number = 2;
    for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1), ++number) {
        const std::string_view line = text.substr(0, end);
        if (line.empty()) continue;
        Json json = parsed(line);
        if (is_result(json)) {
            found.results.push_back(std::move(json));
        } else {
            const char* fault = json.is_discarded() ? "it is no JSON" : "it is no result of an exploration";
            found.damaged.push_back({ErrorCode::parse, path + ":" + std::to_string(number),
                                     std::string("the line is damaged: ") + fault + "; take it out, or name another file"});
        }
    }
    found.cut_off = !text.empty();
}

double number(const Json& result, const char* key) { return result.at(key).get<double>(); }

}  // namespace

std::vector<std::size_t> Exploration::best() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const auto has = [&](const char* key) { return results[i].contains(key) && results[i][key].is_number(); };
        if (has("violation") && has("objective") && number(results[i], "violation") <= 0) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return number(results[i], "objective") < number(results[j], "objective"); });
    return order;
}

Result<Exploration> read_exploration(const std::string& path) {
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    const std::size_t end = std::min(text->find('\n'), text->size());
    Exploration found;
    found.header = parsed(std::string_view(*text).substr(0, end));
    if (!is_header(found.header))
        return Error{ErrorCode::missing_key, path,
                     "not an exploration: its first line has no `fettle_explore` 1; `fettle explore` writes such files"};
    read_results(std::string_view(*text).substr(std::min(end + 1, text->size())), path, found);
    return found;
}

Json header_of(const description::Design& design, const std::string& name, const std::string& file) {
    Json header{{first_key, version},
                {"program", core::base::version()},
                {"design", name},
                {"parameters", description::names_of(design.parameters)}};
    if (!file.empty() && core::base::is_utf8(file)) header["file"] = file;  // JSON has no others
    return header;
}

// What is there is looked at before it is locked or cut: a file of somebody else stays as it is.
Result<ExplorationFile> ExplorationFile::open(const std::string& path, const Json& header) {
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
        return Error{ErrorCode::file_unwritable, path, "results are added to it and read again: it has to be a regular file"};
    const auto size = fs::file_size(path, ignored);
    const bool is_there = !ignored && size > 0;
    Exploration found;
    found.header = header;
    if (is_there) {
        Result<Exploration> read = read_exploration(path);
        if (!read && read.errors().front().code == ErrorCode::missing_key)
            return Error{ErrorCode::parse, path, "this file is no exploration; name another one"};
        if (!read) return read.errors();
        for (const char* key : {"program", "design", "parameters"})
            if (!read->header.contains(key) || read->header[key] != header[key])
                return Error{ErrorCode::inconsistent, path, "this file is the exploration of another design; name another file"};
        if (!read->damaged.empty()) return read->damaged;
        found = std::move(read).value();
    }
    Result<LineFile> lines = LineFile::open(path, LineFileMode::resume, "exploration");
    if (!lines) return lines.errors();
    if (Errors errors = lines->keep(lines->found().size()); !errors.empty()) return errors;
    ExplorationFile file(std::move(lines).value(), path);
    file.found_.header = found.header;
    for (Json& result : found.results) file.take(std::move(result));
    if (file.lines_.found().empty()) {
        file.is_new_ = true;
        file.lines_.append(header.dump(-1, ' ', false, Json::error_handler_t::replace));
        if (Errors errors = file.unwritten(); !errors.empty()) return errors;
    }
    return file;
}

ExplorationFile::ExplorationFile(ExplorationFile&& other) noexcept
    : lines_(std::move(other.lines_)),
      path_(std::move(other.path_)),
      is_new_(std::exchange(other.is_new_, false)),
      found_(std::move(other.found_)),
      keys_(std::move(other.keys_)) {}

ExplorationFile::~ExplorationFile() {
    std::error_code ignored;
    if (is_new_ && found_.results.empty()) fs::remove(path_, ignored);
}

void ExplorationFile::take(Json result) {
    if (result["status"] != "lost") keys_.insert(result["key"].get<std::string>());
    found_.results.push_back(std::move(result));
}

void ExplorationFile::append(Json result) {
    lines_.append(result.dump(-1, ' ', false, Json::error_handler_t::replace));
    take(std::move(result));
}

}  // namespace fettle::design::studies
