// SPDX-License-Identifier: MIT
#include "design/cli/mcp/server.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_text.hpp"
#include "design/cli/command.hpp"
#include "design/cli/mcp/answer.hpp"
#include "design/cli/mcp/call.hpp"
#include "design/cli/mcp/roots.hpp"
#include "design/cli/mcp/tools.hpp"
#include "design/exports/base64.hpp"

namespace fettle::design::cli::mcp {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<const char*, 4> revisions{"2025-06-18", "2025-11-25", "2025-03-26",
                                               "2024-11-05"};  // the first: where another is asked for
constexpr std::size_t longest_message = std::size_t{1} << 24U, most_answers = 50, most_calls = 8;
constexpr int parse_error = -32700, invalid_request = -32600, unknown_method = -32601, invalid_params = -32602;

constexpr const char* instructions =
    "fettle simulates and tunes mechanisms of rigid parts, and proves their clearances. How to go about one: describe (kind starters), "
    "write a "
    "starter or a scene of your own; validate; simulate, and see that what should move did; clearance with motion, kinematic or ranges; "
    "write a "
    "design (what may change, what is wanted, what is required); check; optimise; check the tuned design, clearance with a certificate, "
    "export. "
    "Every answer begins with a verdict. proven: a bound that holds over the whole continuous motion. met: every requirement, as computed. "
    "in "
    "doubt: met as simulated, not with the play of the fits taken up. violated: with the place and the instant. undecided: neither proven "
    "nor "
    "refuted, so no pass. not checked: nothing was required. Numbers in answers are SI (metres, radians, kilograms) unless a key says "
    "otherwise; "
    "lengths in arguments carry a unit: 0.3mm. A clearance says nothing of pairs that it left out: see left_out, uncovered, joined. A "
    "mechanism "
    "that comes apart never collides: see what moved and what it transmits.";

// A folder of this server's, removed at its end.
class OwnFolder {
public:
    OwnFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "fettle-mcp-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw std::runtime_error("no folder can be made in " + std::filesystem::temp_directory_path().string());
        path_ = name;
    }
    ~OwnFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// A call that runs, and who waits for it: a request, until some time; nobody: it is a job.
struct Running {
    std::unique_ptr<Call> call;
    Json request;         // id; null: nobody waits
    Json progress_token;  // null: no progress is wanted
    Clock::time_point until;
    int reports = 0;
    bool is_job = false;  // somebody has been told its name
};

class Server {
public:
    explicit Server(const ServerOptions& options) : options_(options), roots_(options.roots) {}

    void serve() {
        while (!has_ended_) {
            std::vector<pollfd> streams{{STDIN_FILENO, POLLIN, 0}};
            for (const auto& [job, running] : running_) running.call->add_streams(streams);
            if (poll(streams.data(), streams.size(), running_.empty() && waiting_.empty() ? -1 : 50) < 0 && errno != EINTR) return;
            if (interrupted()) return;
            if (streams.front().revents != 0) read_messages();
            look_at_calls();
            if (!waiting_.empty() && (!asks_for_roots_ || Clock::now() > roots_until_)) begin_waiting();
        }
    }

private:
    void read_messages() {
        char bytes[65536];
        const ssize_t count = read(STDIN_FILENO, bytes, sizeof bytes);
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
        if (count <= 0) {
            has_ended_ = true;
            return;
        }
        heard_.append(bytes, static_cast<std::size_t>(count));
        std::size_t begin = 0;
        for (std::size_t end; (end = heard_.find('\n', begin)) != std::string::npos; begin = end + 1)
            take(heard_.substr(begin, end - begin));
        heard_.erase(0, begin);
        if (heard_.size() <= longest_message) return;
        fail(nullptr, invalid_request, "a message is one line of at most 16 MB");
        has_ended_ = true;
    }

    void tell(const Json& message) {
        const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
        std::string_view left = line;
        if (core::files::write_all(STDOUT_FILENO, left) != 0) has_ended_ = true;
    }
    void answer(const Json& id, const Json& result) { tell({{"jsonrpc", "2.0"}, {"id", id}, {"result", result}}); }
    void fail(const Json& id, int code, const std::string& message) {
        tell({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", message}}}});
    }

    void take(const std::string& line) {
        if (line.find_first_not_of(" \t\r") == std::string::npos) return;
        const Json message = core::files::is_safe_json_text(line) ? Json::parse(line, nullptr, false) : Json(Json::value_t::discarded);
        if (message.is_discarded()) return fail(nullptr, parse_error, "not valid JSON");
        const bool has_id =
            message.is_object() && message.contains("id") && (message["id"].is_string() || message["id"].is_number_integer());
        if (!message.is_object() || message.value("jsonrpc", Json()) != "2.0")
            return fail(has_id ? message["id"] : Json(), invalid_request, "one JSON-RPC 2.0 object a line is expected");
        if (!message.contains("method")) return take_response(message);
        if (!message["method"].is_string()) return fail(has_id ? message["id"] : Json(), invalid_request, "`method` is a text");
        const std::string method = message["method"].get<std::string>();
        const Json params = message.value("params", Json::object());
        if (!message.contains("id")) return take_notification(method, params);
        if (!has_id) return fail(nullptr, invalid_request, "`id` is a text or a whole number");
        if (!params.is_object()) return fail(message["id"], invalid_params, "`params` is an object");
        take_request(message["id"], method, params);
    }

    void take_request(const Json& id, const std::string& method, const Json& params) {
        if (method == "initialize") return initialise(id, params);
        if (method == "ping") return answer(id, Json::object());
        if (method == "tools/list") return answer(id, {{"tools", tool_list(options_.program)}});
        if (method != "tools/call") return fail(id, unknown_method, "there is no method " + method);
        const Json name = params.value("name", Json());
        const Tool* tool = name.is_string() ? find_tool(name.get<std::string>()) : nullptr;
        if (tool == nullptr) return fail(id, invalid_params, "there is no tool " + name.dump());
        Json arguments = params.value("arguments", Json());
        if (arguments.is_null()) arguments = Json::object();
        if (!arguments.is_object()) return fail(id, invalid_params, "`arguments` is an object");
        const Json meta = params.value("_meta", Json::object());
        Json token = meta.is_object() ? meta.value("progressToken", Json()) : Json();
        if (!token.is_string() && !token.is_number_integer()) token = nullptr;
        if (asks_for_roots_) return static_cast<void>(waiting_.push_back({id, tool, arguments, token}));
        begin(id, *tool, arguments, token);
    }

    void initialise(const Json& id, const Json& params) {
        const Json asked = params.value("protocolVersion", Json());
        const auto known = std::find_if(revisions.begin(), revisions.end(), [&](const char* revision) { return asked == revision; });
        const Json capabilities = params.value("capabilities", Json::object());
        states_roots_ = options_.roots.empty() && capabilities.is_object() && capabilities.contains("roots");
        if (options_.roots.empty() && !states_roots_) roots_ = Roots({"."});
        answer(id,
               {{"protocolVersion", known == revisions.end() ? revisions.front() : *known},
                {"capabilities", {{"tools", {{"listChanged", false}}}}},
                {"serverInfo",
                 {{"name", "fettle"}, {"title", "fettle: tunes mechanisms under certified clearance"}, {"version", core::base::version()}}},
                {"instructions", instructions}});
    }

    void take_notification(const std::string& method, const Json& params) {
        if (method == "notifications/initialized" || method == "notifications/roots/list_changed") return ask_for_roots();
        if (method != "notifications/cancelled" || !params.is_object()) return;
        const Json id = params.value("requestId", Json());
        std::erase_if(waiting_, [&](const Waiting& each) { return each.id == id; });
        for (auto& [job, running] : running_) {
            if (running.request.is_null() || running.request != id) continue;
            running.request = nullptr;  // a request that is cancelled is not answered
            running.call->stop();
        }
    }

    void ask_for_roots() {
        if (!states_roots_) return;
        asks_for_roots_ = true;
        roots_until_ = Clock::now() + std::chrono::seconds(10);
        tell({{"jsonrpc", "2.0"}, {"id", roots_request()}, {"method", "roots/list"}});
    }
    static std::string roots_request() { return "fettle-roots"; }

    void take_response(const Json& message) {
        if (message.value("id", Json()) != roots_request()) return;
        const Json result = message.value("result", Json::object());
        std::vector<std::string> folders;
        if (result.is_object() && result.contains("roots") && result["roots"].is_array())
            for (const Json& root : result["roots"])
                if (root.is_object() && root.value("uri", Json()).is_string())
                    if (const std::string path = path_of_address(root["uri"].get<std::string>()); !path.empty()) folders.push_back(path);
        roots_ = Roots(folders);
        asks_for_roots_ = false;
    }

    struct Waiting {
        Json id;
        const Tool* tool;
        Json arguments, token;
    };
    void begin_waiting() {
        asks_for_roots_ = false;
        for (const Waiting& each : std::exchange(waiting_, {})) begin(each.id, *each.tool, each.arguments, each.token);
    }

    void begin(const Json& id, const Tool& tool, const Json& arguments, const Json& token) {
        const Result<double> seconds = seconds_to_wait(arguments);
        if (!seconds) return answer(id, refusal(seconds.errors()));
        const std::string name = tool.name;
        if (name == "describe") return describe(id, tool, arguments, token, *seconds);
        if (name == "write") return write(id, tool, arguments, token, *seconds);
        if (name == "job") return wait_for(id, arguments, token, *seconds);
        const Result<std::vector<std::string>> words = words_of(tool, options_.program, arguments, roots_);
        if (!words) return answer(id, refusal(words.errors()));
        start(id, tool, *words, token, *seconds);
    }

    static Clock::time_point after(double seconds) {
        return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }

    void start(const Json& id, const Tool& tool, const std::vector<std::string>& words, const Json& token, double seconds) {
        if (running_.size() >= most_calls) {
            std::string jobs;
            for (const auto& [job, running] : running_) jobs += (jobs.empty() ? "" : ", ") + job;
            return answer(id,
                          refusal({{ErrorCode::unsupported, "", "as many calls as are possible run: wait for, or stop, one of " + jobs}}));
        }
        const std::string job = "job-" + std::to_string(++jobs_);
        try {
            running_[job] = {std::make_unique<Call>(tool, words, options_.passed_on, folder_.path() / job), id, token, after(seconds)};
        } catch (const std::exception& fault) {
            running_.erase(job);
            answer(id, refusal({{ErrorCode::unsupported, "", fault.what()}}));
        }
    }

    void look_at_calls() {
        std::vector<std::string> done;
        for (auto& [job, running] : running_) {
            if (running.call->listen() && !running.progress_token.is_null() && !running.request.is_null())
                tell({{"jsonrpc", "2.0"},
                      {"method", "notifications/progress"},
                      {"params",
                       {{"progressToken", running.progress_token}, {"progress", ++running.reports}, {"message", running.call->doing()}}}});
            if (const std::optional<Ended> ended = running.call->ended()) {
                finish(job, running, *ended);
                done.push_back(job);
            } else if (!running.request.is_null() && Clock::now() >= running.until) {
                answer(running.request, still_running(job, running.call->typed(), running.call->doing()));
                running.request = nullptr;
                running.is_job = true;
            }
        }
        for (const std::string& job : done) running_.erase(job);
    }

    void finish(const std::string& job, const Running& running, const Ended& ended) {
        const std::string number = "answer-" + std::to_string(answered_ + 1);
        Json whole;
        Json result = result_of(running.call->tool(), ended, number, whole);
        if (!whole.is_null()) {
            ++answered_;
            answers_.emplace_back(number, std::move(whole));
            if (answers_.size() > most_answers) answers_.erase(answers_.begin());
        }
        if (const std::string picture = running.call->picture(); !picture.empty())
            result["content"].push_back({{"type", "image"}, {"data", exports::base64(picture)}, {"mimeType", "image/png"}});
        if (!running.request.is_null()) answer(running.request, result);
        if (!running.is_job) return;
        results_.emplace_back(job, std::move(result));
        if (results_.size() > most_answers) results_.erase(results_.begin());
    }

    void wait_for(const Json& id, const Json& arguments, const Json& token, double seconds) {
        const Json job = arguments.value("job", Json()), action = arguments.value("action", Json("wait"));
        if (action != "wait" && action != "stop")
            return answer(id, refusal({{ErrorCode::out_of_range, "action", "\"wait\" or \"stop\" is expected"}}));
        for (const auto& [name, result] : results_)
            if (job == name) return answer(id, result);
        const auto found = job.is_string() ? running_.find(job.get<std::string>()) : running_.end();
        if (found == running_.end()) return answer(id, refusal({{ErrorCode::unknown_key, "job", "there is no such job"}}));
        Running& running = found->second;
        if (action == "stop") running.call->stop();
        if (!running.request.is_null()) answer(running.request, still_running(found->first, running.call->typed(), running.call->doing()));
        running.request = id;
        running.progress_token = token;
        running.until = after(seconds);
    }

    void describe(const Json& id, const Tool& tool, const Json& arguments, const Json& token, double seconds) {
        const Json kind = arguments.value("kind", Json()), name = arguments.value("name", Json());
        const auto number = [&](const char* key, std::size_t usual) {
            const Json value = arguments.value(key, Json());
            return value.is_number_unsigned() ? value.get<std::size_t>() : usual;
        };
        if (kind == "answer") {
            for (const auto& [called, whole] : answers_) {
                if (name != called) continue;
                const Json pointer = arguments.value("pointer", Json(""));
                const Result<Json> part =
                    part_of(whole, pointer.is_string() ? pointer.get<std::string>() : "?", number("from", 0), number("count", 20));
                if (!part) return answer(id, refusal(part.errors()));
                return answer(id, text_result(called + " " + (pointer.is_string() ? pointer.get<std::string>() : ""),
                                              part->dump(-1, ' ', false, Json::error_handler_t::replace)));
            }
            return answer(id, refusal({{ErrorCode::unknown_key, "name", "there is no such answer; the last 50 are kept"}}));
        }
        if (kind == "file") return read_file(id, name, number("from", 0), number("count", 20000));
        for (const char* known : {"shapes", "joints", "quantities", "optimisers", "starters"}) {
            if (kind != known) continue;
            std::vector<std::string> words{kind == "starters" ? "new" : known};
            if (name.is_string() && kind != "starters") {
                const std::string text = name.get<std::string>();
                if (text.empty() || text.find_first_of("/.-") == 0 || text.find('/') != std::string::npos)
                    return answer(id, refusal({{ErrorCode::unknown_key, "name", "a name out of the list is expected"}}));
                words.push_back(text);
            }
            return start(id, tool, words, token, seconds);
        }
        answer(
            id,
            refusal({{ErrorCode::out_of_range, "kind", "shapes, joints, quantities, optimisers, starters, file or answer is expected"}}));
    }

    void read_file(const Json& id, const Json& name, std::size_t from, std::size_t count) {
        const Result<std::string> path = roots_.inside(name.is_string() ? name.get<std::string>() : "", "name");
        if (!path) return answer(id, refusal(path.errors()));
        constexpr std::uintmax_t largest = 1U << 26U;
        std::error_code fault;
        if (!std::filesystem::is_regular_file(*path, fault) || std::filesystem::file_size(*path, fault) > largest || fault)
            return answer(id, refusal({{ErrorCode::file_not_found, "name", *path + " is no file of at most 64 MB"}}));
        const Result<std::string> text = core::files::read_file(*path);
        if (!text) return answer(id, refusal(text.errors()));
        if (!core::base::is_utf8(*text)) return answer(id, refusal({{ErrorCode::unsupported, "name", *path + " is no text"}}));
        const std::string page = from >= text->size() ? "" : text->substr(from, std::min<std::size_t>(count, 40000));
        const bool is_whole = from == 0 && page.size() == text->size();
        answer(id, text_result(*path + (is_whole ? ""
                                                 : ", " + std::to_string(page.size()) + " of " + std::to_string(text->size()) +
                                                       " characters from " + std::to_string(from)),
                               page));
    }

    void write(const Json& id, const Tool& tool, const Json& arguments, const Json& token, double seconds) {
        const Json name = arguments.value("path", Json()), text = arguments.value("text", Json()),
                   starter = arguments.value("starter", Json());
        const Result<std::string> path = roots_.inside(name.is_string() ? name.get<std::string>() : "", "path");
        if (!path) return answer(id, refusal(path.errors()));
        if (starter.is_string()) {
            if (starter.get<std::string>().find_first_of("-/.") == 0)
                return answer(id, refusal({{ErrorCode::unknown_key, "starter", "there is none of that name"}}));
            return start(id, tool, {"new", starter.get<std::string>(), "--in=" + *path}, token, seconds);
        }
        if (!text.is_string()) return answer(id, refusal({{ErrorCode::missing_key, "text", "the file's text, or a starter, is expected"}}));
        std::error_code fault;
        if (std::filesystem::exists(*path, fault) && arguments.value("replace", Json()) != true)
            return answer(id, refusal({{ErrorCode::inconsistent, "path", *path + " is there; say `replace` if it is to be replaced"}}));
        std::filesystem::create_directories(std::filesystem::path(*path).parent_path(), fault);
        if (const Errors errors = core::files::write_file_atomically(*path, text.get<std::string>()); !errors.empty())
            return answer(id, refusal(errors));
        answer(id, text_result("written: " + *path, std::to_string(text.get<std::string>().size()) + " bytes"));
    }

    const ServerOptions& options_;
    Roots roots_;
    OwnFolder folder_;
    std::string heard_;
    bool has_ended_ = false, states_roots_ = false, asks_for_roots_ = false;
    Clock::time_point roots_until_;
    std::vector<Waiting> waiting_;
    std::map<std::string, Running> running_;             // by job
    std::vector<std::pair<std::string, Json>> results_;  // of jobs that have ended
    std::vector<std::pair<std::string, Json>> answers_;  // that were too long
    int jobs_ = 0, answered_ = 0;
};

}  // namespace

void serve(const ServerOptions& options) { Server(options).serve(); }

}  // namespace fettle::design::cli::mcp
