// SPDX-License-Identifier: MIT
// fettle mcp, talked to as a client does: the answers are the command line's, nothing outside of the roots is touched, and bad messages
// end in an error that names what is wrong.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/files/atomic_file.hpp"
#include "design/cli/child_process.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::mcp_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::run;
using Json = nlohmann::ordered_json;

class Client {
public:
    explicit Client(const std::string& root) : server_({program(), "mcp", "--root", root}) {
        hello_ =
            ask("initialize", {{"protocolVersion", "2025-06-18"}, {"capabilities", Json::object()}, {"clientInfo", {{"name", "test"}}}});
        tell(R"({"jsonrpc": "2.0", "method": "notifications/initialized"})");
    }
    ~Client() {  // as a client ends it: the server removes its folder
        server_.tell_no_more();
        while (server_.next_line({})) {
        }
    }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    const Json& hello() const { return hello_; }

    void tell(const std::string& line) { REQUIRE(server_.tell(line + "\n")); }
    Json next() {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        const auto line = server_.next_line([&] { return std::chrono::steady_clock::now() > end; });
        REQUIRE(line);
        return Json::parse(*line);
    }
    Json ask(const std::string& method, const Json& params) {
        tell(Json{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}}.dump());
        Json message = next();
        while (!message.contains("id") || message["id"] != id_) message = next();
        return message;
    }
    Json call(const std::string& tool, const Json& arguments) {
        const Json answer = ask("tools/call", {{"name", tool}, {"arguments", arguments}});
        CAPTURE(answer.dump());
        REQUIRE(answer.contains("result"));
        const Json& result = answer["result"];
        CHECK(result["content"][0]["text"].get<std::string>().starts_with(result["structuredContent"]["verdict"] == "not checked" &&
                                                                                  !result["structuredContent"].contains("command")
                                                                              ? result["structuredContent"]["sentence"].get<std::string>()
                                                                              : result["structuredContent"]["verdict"].get<std::string>()));
        return result;
    }

private:
    static std::string program() {
        const char* elsewhere = std::getenv("FETTLE_PROGRAM");
        return elsewhere != nullptr ? elsewhere : FETTLE_PROGRAM;
    }

    TalkingProcess server_;
    Json hello_;
    int id_ = 0;
};

// What does not change from run to run.
Json without_times(Json answer) {
    for (const char* key : {"start_seconds", "wall_seconds", "certify_seconds", "peak_memory_bytes", "forward_seconds", "backward_seconds"})
        answer.erase(key);
    return answer;
}

}  // namespace

TEST_CASE("mcp: every tool has a schema that is the command's own, and says whether it writes") {
    const DesignFolder folder;
    Client client(folder.path.string());
    CHECK(client.hello()["result"]["protocolVersion"] == "2025-06-18");
    CHECK(client.hello()["result"]["serverInfo"]["name"] == "fettle");
    const Json list = client.ask("tools/list", Json::object())["result"]["tools"];
    CHECK(list.size() >= 12);
    std::set<std::string> names;
    for (const Json& tool : list) {
        CAPTURE(tool["name"]);
        names.insert(tool["name"].get<std::string>());
        CHECK(tool["inputSchema"]["type"] == "object");
        CHECK(tool["inputSchema"]["properties"].size() >= 2);
        for (const auto& [key, property] : tool["inputSchema"]["properties"].items()) {
            CAPTURE(key);
            CHECK(property.contains("description"));
        }
        for (const Json& key : tool["inputSchema"]["required"]) CHECK(tool["inputSchema"]["properties"].contains(key.get<std::string>()));
        CHECK(tool["annotations"]["readOnlyHint"] != tool["annotations"]["destructiveHint"]);
    }
    CHECK(names.size() == list.size());
    for (const char* name : {"describe", "write", "validate", "simulate", "clearance", "check", "optimise", "job"})
        CHECK(names.contains(name));
}

TEST_CASE("mcp: answers are the command line's, begun by a verdict") {
    const DesignFolder folder;
    Client client(folder.path.string());
    const std::string scene = (folder.path / "small.scene.json").string();
    const auto same = [&](const std::string& tool, const Json& arguments, const std::string& words) {
        const Json told = client.call(tool, arguments)["structuredContent"];
        CAPTURE(words, told.dump());
        const Json own = Json::parse(run(words + " --json").out);
        const Json answer = without_times(told.at("answer"));
        for (const auto& [key, value] : answer.items()) {
            if (value.is_structured()) continue;  // poses are left off
            CAPTURE(key);
            CHECK(own.at(key) == value);
        }
        return told;
    };
    CHECK(same("validate", {{"file", "small.scene.json"}}, "validate " + scene)["verdict"] == "not checked");
    CHECK(same("simulate", {{"scene", "small.scene.json"}, {"steps", 2}}, "simulate " + scene + " --steps 2")["verdict"] == "not checked");
    CHECK(same("clearance", {{"file", {"small.scene.json"}}, {"minimum", "1000mm"}},
               "clearance " + scene + " --minimum 1000mm")["verdict"] == "violated");
    // The cube and the table push each other over the motion: nothing is proven of them, so it is not told.
    const Json pushed = same("clearance", {{"file", {"small.scene.json"}}, {"motion", true}}, "clearance " + scene + " --motion");
    CHECK(pushed["answer"]["pairs"].dump().find("\"status\":\"contact\"") != std::string::npos);
    CHECK(pushed["verdict"] == "not checked");
    CHECK(pushed["sentence"].get<std::string>().find("1 in contact, of which nothing is proven") != std::string::npos);
    const Json check = same("check", {{"design", "small.design.json"}}, "check " + folder.design());
    const int code = run("check " + folder.design()).code;
    CHECK((check["verdict"] == "violated") == (code == 1));
    CHECK(client.call("describe", {{"kind", "shapes"}, {"name", "box"}})["structuredContent"]["answer"]["shapes"][0]["name"] == "box");
    const Json drawn = client.call("draw", {{"file", "small.scene.json"}, {"size", "200x150"}});
    REQUIRE(drawn["content"].size() == 2);
    CHECK(drawn["content"][1]["mimeType"] == "image/png");
}

TEST_CASE("mcp: files are read and written below the roots alone") {
    const DesignFolder folder, other;
    Client client(folder.path.string());
    for (const std::string& path : {other.design(), std::string("../x.json"), std::string("/etc/passwd"), std::string()}) {
        CAPTURE(path);
        CHECK(client.call("validate", {{"file", path}})["isError"] == true);
        CHECK(client.call("describe", {{"kind", "file"}, {"name", path}})["isError"] == true);
        CHECK(client.call("write", {{"path", path}, {"text", "{}"}, {"replace", true}})["isError"] == true);
        CHECK(client.call("export", {{"file", "small.scene.json"}, {"to", path}})["isError"] == true);
    }
    std::filesystem::create_symlink(other.path, folder.path / "link");
    CHECK(client.call("validate", {{"file", "link/small.scene.json"}})["isError"] == true);
    CHECK(client.call("write", {{"path", "new/a.txt"}, {"text", "line"}})["isError"] == false);
    CHECK(core::files::read_file(folder.path / "new/a.txt").value() == "line");
    CHECK(client.call("write", {{"path", "new/a.txt"}, {"text", "other"}})["isError"] == true);  // not replaced without a word
    CHECK(client.call("describe", {{"kind", "file"}, {"name", "new/a.txt"}})["structuredContent"]["answer"] == "line");
    CHECK(client.call("write", {{"path", "mine"}, {"starter", "hinge"}})["isError"] == false);
    CHECK(client.call("validate", {{"file", "mine/hinge.design.json"}})["isError"] == false);
}

TEST_CASE("mcp: what takes long is a job; arguments and messages that are not taken are told") {
    const DesignFolder folder;
    Client client(folder.path.string());
    const Json begun = client.call("simulate", {{"scene", "small.scene.json"}, {"steps", 3}, {"wait_seconds", 0}})["structuredContent"];
    REQUIRE(begun["verdict"] == "running");
    const Json done = client.call("job", {{"job", begun["job"]}})["structuredContent"];
    CHECK(done["verdict"] == "not checked");
    CHECK(done["answer"]["steps"] == 3);
    CHECK(client.call("job", {{"job", begun["job"]}})["structuredContent"] == done);
    CHECK(client.call("job", {{"job", "job-99"}})["isError"] == true);

    const auto said = [&](const std::string& tool, const Json& arguments) {
        return client.call(tool, arguments)["structuredContent"]["sentence"].get<std::string>();
    };
    CHECK(said("simulate", {{"scene", "small.scene.json"}, {"stesp", 3}}).find("did you mean `steps`?") != std::string::npos);
    CHECK(said("simulate", {{"scene", "small.scene.json"}, {"steps", "three"}}) == "steps: a whole number is expected, found \"three\"");
    CHECK(said("simulate", Json::object()).find("scene: is missing") == 0);
    CHECK(said("clearance", {{"file", {"small.scene.json"}}, {"minimum", "0.3"}}).find("--minimum") != std::string::npos);
    CHECK(said("optimise", {{"design", "small.design.json"}}).find("out: is missing") == 0);

    const auto code = [&](const std::string& line) {
        client.tell(line);
        return client.next().at("error").at("code").get<int>();
    };
    CHECK(code("{") == -32700);
    CHECK(code("[]") == -32600);
    CHECK(code(R"({"jsonrpc": "2.0", "id": 7, "method": "no/such"})") == -32601);
    CHECK(code(R"({"jsonrpc": "2.0", "id": 8, "method": "tools/call", "params": {"name": "rm"}})") == -32602);
    CHECK(code(R"({"jsonrpc": "2.0", "id": [], "method": "ping"})") == -32600);
    CHECK(code(R"({"jsonrpc": "2.0", "id": 9, "method": "tools/call", "params": {"name": "describe", "arguments": []}})") == -32602);
    CHECK(code(R"({"jsonrpc": "2.0", "id": 9, "method": "tools/call", "params": {"name": "describe", "arguments": "x"}})") == -32602);
    for (const char* tool : {"describe", "write", "job", "validate", "optimise"})
        CHECK(client.call(tool, nullptr)["structuredContent"]["verdict"] == "refused");
    CHECK(client.ask("ping", Json::object())["result"] == Json::object());
}

}  // namespace fettle::design::cli::mcp_test
