// SPDX-License-Identifier: MIT
#include "design/cli/mcp/answer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/text.hpp"
#include "core/files/json_text.hpp"
#include "design/cli/console.hpp"

namespace fettle::design::cli::mcp {

namespace {

// A token is about four characters: an answer, with its findings, stays below 25,000.
constexpr std::size_t longest_answer = 32000, longest_findings = 6000;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string word_in(const Json& answer, const char* key) {
    return answer.is_object() && answer.contains(key) && answer[key].is_string() ? answer[key].get<std::string>() : std::string();
}

bool all_proven(const Json& constraints) {
    return constraints.is_array() && !constraints.empty() && std::all_of(constraints.begin(), constraints.end(), [](const Json& each) {
               return each.is_object() && each.value("proven", false);
           });
}

// Pairs that push each other are exempt from a minimum, and nothing is proven of them.
bool all_clear(const Json& pairs) {
    return std::all_of(pairs.begin(), pairs.end(), [](const Json& each) { return word_in(each, "status") == "clear"; });
}

std::string verdict_of(const std::string& tool, int exit_code, const Json& answer) {
    if (exit_code == exit_violated) return "violated";
    if (exit_code == exit_undecided) return "undecided";
    if (exit_code != exit_done) return "refused";
    if (tool == "clearance") return all_clear(answer.value("pairs", Json::array())) ? "proven" : "not checked";
    if (tool == "ranges") return "proven";
    if (tool != "check" && tool != "optimise") return "not checked";
    const bool doubtful =
        answer.contains("by_models") && answer["by_models"].is_object() && !answer["by_models"].value("in_doubt", Json::array()).empty();
    if (doubtful || word_in(answer, "status") == "in doubt") return "in doubt";
    return all_proven(answer.value("constraints", Json())) ? "proven" : "met";
}

double number_in(const Json& object, const char* key) {
    return object.contains(key) && object[key].is_number() ? object[key].get<double>() : 0;
}

// The pair that lacks most of what is required; else the nearest.
std::string clearance_sentence(const Json& answer) {
    const Json pairs = answer.value("pairs", Json::array());
    const Json* worst = nullptr;
    const auto spare = [](const Json& pair) {
        const bool clash = word_in(pair, "finding") == "clash";
        return clash ? -1e9 : number_in(pair, "lower") - number_in(pair, "minimum");
    };
    for (const Json& pair : pairs)
        if (worst == nullptr || spare(pair) < spare(*worst)) worst = &pair;
    std::string text = core::base::counted(pairs.size(), "pair") + ", " + word_in(answer, "source");
    const auto not_clear = std::count_if(pairs.begin(), pairs.end(), [](const Json& pair) { return word_in(pair, "status") == "contact"; });
    if (not_clear > 0) text += " (" + std::to_string(not_clear) + " in contact, of which nothing is proven)";
    if (worst == nullptr) return text + ": nothing was judged";
    text += ": worst " + word_in(*worst, "a") + ":" + word_in(*worst, "b") + ", " + word_in(*worst, "finding") +
            core::base::formatted(", at least %.6g mm", 1e3 * number_in(*worst, "lower"));
    if (number_in(*worst, "minimum") > 0) text += core::base::formatted(", required %.6g mm", 1e3 * number_in(*worst, "minimum"));
    if (worst->contains("time") && (*worst)["time"].is_number()) text += core::base::formatted(", at %.6g s", number_in(*worst, "time"));
    return text;
}

// The command's own sentence, where it has one.
std::string sentence_of(const std::string& tool, const std::string& verdict, const Json& answer, const Ended& ended) {
    if (verdict == "refused") {
        std::string text;
        for (const Json& error : answer.is_object() ? answer.value("errors", Json::array()) : Json::array())
            text += (text.empty() ? "" : "\n") + word_in(error, "where") + ": " + word_in(error, "message");
        return text.empty() ? "the program ended with exit code " + std::to_string(ended.exit_code) + ": " + ended.error : text;
    }
    if (answer.is_object() && answer.contains("summary")) {
        const std::string why = word_in(answer["summary"], "why");
        return word_in(answer["summary"], "sentence") + (why.empty() ? "" : " " + why);
    }
    if (const std::string message = word_in(answer, "message"); !message.empty()) return message;
    if (tool == "simulate") return "nothing is required of the motion; " + word_in(answer, "moved");
    if (tool == "clearance") return clearance_sentence(answer);
    return "status " + word_in(answer, "status");
}

// Lists of more than `most` entries are cut; says so in their place.
Json shortened(const Json& value, std::size_t most, bool& is_cut) {
    if (value.is_object()) {
        Json out = Json::object();
        for (const auto& [key, each] : value.items()) out[key] = shortened(each, most, is_cut);
        return out;
    }
    if (!value.is_array()) return value;
    Json out = Json::array();
    for (std::size_t k = 0; k < std::min(most, value.size()); ++k) out.push_back(shortened(value[k], most, is_cut));
    if (value.size() <= most) return out;
    is_cut = true;
    out.push_back("... " + std::to_string(value.size() - most) + " more");
    return out;
}

// What nobody reads: the matrix of a pose beside the points that it places.
void drop_poses(Json& value) {
    if (value.is_object())
        for (const char* key : {"pose_a", "pose_b", "witnesses", "peak_memory_bytes"}) value.erase(key);
    if (value.is_structured())
        for (Json& each : value) drop_poses(each);
}

Json result(const Json& structured, const std::string& text, bool is_error) {
    return {{"content", Json::array({{{"type", "text"}, {"text", text}}})}, {"structuredContent", structured}, {"isError", is_error}};
}

}  // namespace

Json result_of(const Tool& tool, const Ended& ended, const std::string& number, Json& whole) {
    Json answer;
    if (core::files::is_safe_json_text(ended.out)) answer = Json::parse(ended.out, nullptr, false);
    if (!answer.is_object()) answer = Json::object();
    const std::string verdict = answer.empty() && ended.exit_code == exit_done ? "refused" : verdict_of(tool.name, ended.exit_code, answer);
    Json structured = {{"verdict", verdict}, {"sentence", sentence_of(tool.name, verdict, answer, ended)}, {"command", ended.typed}};
    if (verdict == "refused") return result(structured, "refused: " + structured["sentence"].get<std::string>(), true);
    Json shorter = answer;
    drop_poses(shorter);
    bool is_cut = false;
    for (const std::size_t most : {1000U, 100U, 30U, 10U, 4U, 1U}) {
        if (dumped(shorter).size() <= longest_answer) break;
        shorter = shortened(shorter, most, is_cut);
    }
    if (dumped(shorter).size() > longest_answer) {
        is_cut = true;
        shorter = part_of(answer, "", 0, 0).value();
    }
    structured["answer"] = shorter;
    if (is_cut || shorter != answer) {
        whole = answer;
        structured["left_off"] =
            std::string(is_cut ? "long lists are cut" : "poses are left off") + "; all of it: describe, kind answer, name " + number;
    }
    std::string text = verdict + ": " + structured["sentence"].get<std::string>() + "\n";
    text += ended.findings.size() <= longest_findings ? ended.findings
                                                      : ended.findings.substr(0, ended.findings.rfind('\n', longest_findings)) + "\n...\n";
    return result(structured, text + dumped(structured), false);
}

Json refusal(const Errors& errors) {
    std::string text;
    for (const Error& error : errors) text += (text.empty() ? "" : "\n") + (error.where.empty() ? "" : error.where + ": ") + error.message;
    return result({{"verdict", "refused"}, {"sentence", text}}, "refused: " + text, true);
}

Json still_running(const std::string& job, const std::string& typed, const std::string& doing) {
    const Json structured = {{"verdict", "running"},
                             {"sentence", doing.empty() ? "it goes on" : "it goes on; last: " + doing},
                             {"command", typed},
                             {"job", job}};
    return result(structured, "running: " + structured["sentence"].get<std::string>() + "\nwait for it with the tool job, job " + job,
                  false);
}

Json text_result(const std::string& sentence, const std::string& text) {
    return result({{"verdict", "not checked"}, {"sentence", sentence}, {"answer", text}}, sentence + "\n" + text, false);
}

Result<Json> part_of(const Json& answer, const std::string& pointer, std::size_t from, std::size_t count) {
    Json::json_pointer place;
    try {
        place = Json::json_pointer(pointer);
    } catch (const Json::exception&) {
        return Error{ErrorCode::unknown_key, "pointer", "a JSON pointer is expected, such as /pairs/3"};
    }
    if (!answer.contains(place) && !pointer.empty())
        return Error{ErrorCode::unknown_key, "pointer", "there is no " + pointer + " in this answer"};
    const Json& part = answer.at(place);
    if (part.is_array()) {
        Json page = Json::array();
        std::size_t size = 0;
        for (std::size_t k = from; k < part.size() && k - from < count && size < longest_answer; ++k)
            size += dumped(page.emplace_back(part[k])).size();
        return Json{{"of", part.size()}, {"from", from}, {"entries", page}};
    }
    if (dumped(part).size() <= longest_answer) return part;
    if (part.is_string()) return Json(part.get<std::string>().substr(std::min(from, part.get<std::string>().size()), count));
    Json keys = Json::object();
    for (const auto& [key, value] : part.items())
        keys[key] = value.is_structured() ? Json(std::to_string(value.size()) + " entries, " + std::to_string(dumped(value).size()) +
                                                 " characters: ask for " + pointer + "/" + key)
                                          : value;
    return keys;
}

}  // namespace fettle::design::cli::mcp
