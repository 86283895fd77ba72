// SPDX-License-Identifier: MIT
/// fettle studio FILE: a page on this machine in which a design, or a scene, is changed and watched.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "core/files/json_dump.hpp"
#include "core/files/json_text.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/studio/calls.hpp"
#include "design/cli/studio/http_server.hpp"
#include "design/report/report_page.hpp"
#include "design/session/news_json.hpp"

namespace fettle::design::cli::studio {

namespace {

using Json = nlohmann::ordered_json;
using session::News;
using session::NewsKind;
using session::Session;

struct StudioArguments {
    std::string path;
    std::string unit = "auto";
    bool split = false;
    int port = 0;
};

// The session, the windows that look at it, and the one of these that may change it.
class Studio {
public:
    /// Errors: of the files, and of the port.
    Errors open(const StudioArguments& arguments, const CommonOptions& common) {
        reading::InputOptions inputs = input_options(common);
        inputs.should_stop = interrupted;
        Result<std::unique_ptr<Session>> session = Session::open(
            arguments.path, {.opens = {std::move(inputs), arguments.unit, arguments.split}}, [this](const News& news) { tell(news); });
        if (!session) return session.errors();
        session_ = std::move(session).value();
        ServerOptions options;
        options.port = static_cast<unsigned short>(arguments.port);
        Result<std::unique_ptr<HttpServer>> server = HttpServer::listen(
            options, [this](const Request& request) { return answer(request); },
            [this](const std::string& client, bool connected) { connected ? welcome(client) : part(client); });
        if (!server) return server.errors();
        std::unique_lock lock(mutex_);
        server_ = std::move(server).value();
        changed_.wait(lock, [this] { return !page_data_.is_null(); });
        return {};
    }

    /// Nothing calls back any more afterwards.
    void close() {
        std::unique_ptr<HttpServer> ended;
        {
            const std::lock_guard lock(mutex_);
            ended = std::move(server_);
        }
        ended.reset();  // without the mutex: it waits for a call that is under way, which may ask the session
        session_.reset();
    }

    /// Contract: it is open.
    std::string address() const {
        const std::lock_guard lock(mutex_);
        return server_->address();
    }
    bool has_unsaved_values() const { return session_->values() != session_->opened()->values(); }

private:
    // News that still hold: what a window is told that opens now.
    struct Standing {
        NewsKind kind;
        std::string name, text;
    };

    static Answer json_answer(int status, const Json& json) { return {status, "application/json", core::files::dumped(json)}; }
    static Answer fault(int status, const std::string& sentence) { return json_answer(status, {{"error", sentence}}); }

    // On the session's thread.
    void tell(const News& news) {
        const std::vector<session::ToldNews> all = session::told(news);
        const std::lock_guard lock(mutex_);
        if (news.evaluation) evaluation_ = news.evaluation;
        if (news.kind == NewsKind::opened) page_data_ = all.front().data;
        std::erase_if(standing_, [&](const Standing& earlier) { return session::is_overtaken(earlier.kind, news.kind); });
        for (const session::ToldNews& each : all) {
            standing_.push_back({news.kind, each.name, core::files::dumped(each.data)});
            if (server_) server_->tell(each.name, standing_.back().text);
        }
        changed_.notify_all();
    }

    // On the server's thread, as all that follows.
    Answer answer(const Request& request) {
        if (request.method == "GET" && request.path == "/") return page();
        if (request.path != "/call") return fault(404, "there is nothing of this name");
        if (request.method != "POST") {
            Answer refused = fault(405, "calls are POST");
            refused.allow = "POST";
            return refused;
        }
        const auto client = request.query.find("client");
        return call(client == request.query.end() ? std::string() : client->second, request.body);
    }

    Answer page() {
        const std::lock_guard lock(mutex_);
        return {200, "text/html; charset=utf-8", report::page_of(page_data_)};
    }

    Answer call(const std::string& client, const std::string& body) {
        if (!core::files::is_safe_json_text(body)) return fault(400, "the body is no JSON");
        const Json asked = Json::parse(body, nullptr, false);
        if (!asked.is_object()) return fault(400, "the body is no JSON object");
        std::shared_ptr<const problem::DesignEvaluation> evaluation;
        {
            const std::lock_guard lock(mutex_);
            evaluation = evaluation_;
            const bool takes_over = asked.value("do", Json()) == "write";
            if (takes_over && std::find(clients_.begin(), clients_.end(), client) != clients_.end()) writer_ = client;
            if (takes_over) {
                tell_writers();
                return json_answer(200, {{"done", true}, {"writer", writer_ == client}});
            }
            const bool only_looks = asked.value("do", Json()) == "export" || asked.value("do", Json()) == "pose";
            if (only_looks) return {.later = [this, asked, evaluation] { return answered(asked, evaluation); }};
            if (!writer_.empty() && client != writer_) return fault(403, "another window changes things: take over first");
        }
        return answered(asked, evaluation);
    }

    Answer answered(const Json& asked, const std::shared_ptr<const problem::DesignEvaluation>& evaluation) {
        const CallAnswer answer = answer_call(*session_, asked, evaluation);
        return json_answer(answer.status, answer.json);
    }

    void welcome(const std::string& client) {
        const std::lock_guard lock(mutex_);
        if (!server_) return;  // it will be told all news
        clients_.push_back(client);
        if (writer_.empty()) writer_ = client;
        for (const Standing& each : standing_) server_->tell(each.name, each.text, client);
        tell_writers();
    }

    void part(const std::string& client) {
        const std::lock_guard lock(mutex_);
        const auto found = std::find(clients_.begin(), clients_.end(), client);
        if (found != clients_.end()) clients_.erase(found);
        const bool is_still_there = std::find(clients_.begin(), clients_.end(), client) != clients_.end();
        if (writer_ == client && !is_still_there) writer_ = clients_.empty() ? std::string() : clients_.front();
        if (server_) tell_writers();
    }

    // Contract: the mutex is held.
    void tell_writers() {
        for (const std::string& client : clients_)
            server_->tell("writer", core::files::dumped(Json{{"writer", client == writer_}, {"others", clients_.size() - 1}}), client);
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Standing> standing_;  // as they came
    Json page_data_;
    std::shared_ptr<const problem::DesignEvaluation> evaluation_;  // the newest
    std::vector<std::string> clients_;                             // in the order in which they came
    std::string writer_;                                           // empty: nobody looks
    std::unique_ptr<Session> session_;
    std::unique_ptr<HttpServer> server_;
};

int run_studio(const StudioArguments& arguments, const CommonOptions& common, Console& console) {
    Studio studio;
    const Errors errors = studio.open(arguments, common);
    if (!errors.empty()) {
        studio.close();
        return console.input_errors(errors);
    }
    const std::string address = studio.address();
    console.result({{"status", "serving"}, {"address", address}},
                   "studio: " + address + "\nOpen it in a browser on this machine. Ctrl-C ends it.\n");
    while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const bool unsaved = studio.has_unsaved_values();
    studio.close();
    if (unsaved) console.narrate("warning: values were set in the page that no file has");
    return exit_done;
}

}  // namespace

Command add_studio(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("studio", "Opens a design or a scene in the browser: change it, and see at once what it does");
    auto arguments = std::make_shared<StudioArguments>();
    app.option("FILE", arguments->path, "Design, scene, part, mesh (STL, 3MF, STEP ...) or a folder of meshes").required();
    app.option("--unit", arguments->unit, "Unit of meshes that state none (default: auto, by their size)");
    app.flag("--split", arguments->split, "Of meshes: each solid is a body of its own");
    app.option("--port", arguments->port, "Of this machine; default: any that is free").between(0, 65535);
    app.closing_words(
        "Example:  fettle studio examples/slider_crank/slider_crank.design.json\n"
        "The page is served on this machine alone (127.0.0.1), to whoever has its address, which holds a secret. Files are written in the\n"
        "folder of FILE alone, where the page saves. What is edited on the disk is taken up.");
    return {app, [arguments, &common](Console& console) { return run_studio(*arguments, common, console); }};
}

}  // namespace fettle::design::cli::studio
