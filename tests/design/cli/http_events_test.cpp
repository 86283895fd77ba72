// SPDX-License-Identifier: MIT
// Events of the studio's server: in order, to whom they are for, and held up by nobody who does not read.
#include <catch2/catch.hpp>
#include <memory>
#include <thread>
#include <vector>

#include "design/cli/studio/event_queue.hpp"
#include "design/cli/studio/http_server.hpp"
#include "tests/design/cli/http_peer.hpp"

namespace fettle::design::cli::studio::http_events_test {

namespace {

using namespace fettle::tests::design_support;

}  // namespace

TEST_CASE("HTTP events: they come in order, to all or to one") {
    Served served;
    Peer a = served.listener("a"), b = served.listener("b");
    CHECK(served->listeners() == 2);
    CHECK(comes_true([&] { return served.seen() == "+a+b"; }));
    std::string all;
    for (int k = 0; k < 200; ++k) {
        served->tell("number", std::to_string(k));
        all += "event: number\ndata: " + std::to_string(k) + "\n\n";
    }
    served->tell("mine", "of b", "b");
    served->tell("lines", "one\ntwo\r\nthree\r\n");
    const std::string lines = "event: lines\ndata: one\ndata: two\ndata: three\ndata: \n\n";
    CHECK(a.until("data: \n\n") == all + lines);
    CHECK(b.until("data: \n\n") == all + "event: mine\ndata: of b\n\n" + lines);
    a.say_no_more();  // nobody who says no more is told more
    CHECK(a.ends());
    CHECK(comes_true([&] { return served->listeners() == 1 && served.seen() == "+a+b-a"; }));
    Peer throws(served.port());
    throws.say(served.request("GET /events?client=throws"));
    CHECK(throws.ends());
    served->tell("still", "there");
    CHECK(b.until("\n\n") == "event: still\ndata: there\n\n");
}

TEST_CASE("HTTP events: a newcomer is told what its arrival calls for, before anything else") {
    std::unique_ptr<HttpServer> server;
    ServerOptions options;
    options.token = token;
    options.comment_interval = 20ms;
    server = HttpServer::listen(
                 options, [](const Request&) { return Answer(); },
                 [&](const std::string& client, bool) { server->tell("welcome", client, client); })
                 .value();
    Peer peer(static_cast<unsigned short>(std::stoi(server->address().substr(17))));
    peer.say("GET /events?client=me&token=" + std::string(token) +
             " HTTP/1.1\r\nHost: localhost:" + server->address().substr(17, server->address().find("/?") - 17) + "\r\n\r\n");
    CHECK(peer.until("me\n\n").ends_with("\r\n\r\nretry: 500\n\nevent: welcome\ndata: me\n\n"));
    for (int k = 0; k < 3; ++k) CHECK(peer.until("\n\n") == ": open\n\n");
}

TEST_CASE("HTTP events: who does not read gets the newest, or is dropped, and holds up nobody") {
    ServerOptions options;
    options.most_waiting = std::size_t{4} << 20U;
    Served served(options);
    Peer reads = served.listener("reads"), sleeps = served.listener("sleeps", 4096), drowns = served.listener("drowns", 4096);
    const std::string large(100'000, 'x');
    for (int k = 0; k < 200; ++k) {  // 20 MB
        served->tell("state", std::to_string(k) + large);
        CHECK(reads.until("\n\n") == "event: state\ndata: " + std::to_string(k) + large + "\n\n");
    }
    CHECK(served->listeners() == 3);
    for (int k = 0; k < 400; ++k) served->tell("kind" + std::to_string(k), large, "drowns");
    CHECK(comes_true([&] { return served->listeners() == 2; }));
    CHECK(served.seen().ends_with("-drowns"));
    CHECK(served.answers());
    served->tell("last", "");
    CHECK(reads.until("\n\n") == "event: last\ndata: \n\n");
    const std::string got = sleeps.until("event: last\ndata: \n\n");
    CHECK(got.size() < 15'000'000);
    CHECK(got.find("data: 199x") != std::string::npos);  // the newest, and before it what had been sent already
    CHECK(got.find("data: 150x") == std::string::npos);
}

TEST_CASE("HTTP events: told from several threads") {
    Served served;
    Peer a = served.listener("a"), b = served.listener("b");
    std::vector<std::thread> tellers;
    for (int t = 0; t < 4; ++t)
        tellers.emplace_back([&, t] {
            for (int k = 0; k < 500; ++k) served->tell("of" + std::to_string(t), std::to_string(k), k % 2 == 0 ? "" : "a");
        });
    for (int k = 0; k < 20; ++k) CHECK(served.answers());
    for (std::thread& each : tellers) each.join();
    served->tell("end", "");
    const auto all = [](Peer& peer) { return peer.until("event: end\ndata: \n\n"); };
    for (const auto& [text, step] : {std::pair(all(a), 1), std::pair(all(b), 2)})
        for (int t = 0; t < 4; ++t) {
            int next = 0;
            std::size_t at = 0;
            const std::string name = "event: of" + std::to_string(t) + "\ndata: ";
            while ((at = text.find(name, at)) != std::string::npos) {
                at += name.size();
                if (std::stoi(text.substr(at, 4)) != next) FAIL("out of order");
                next += step;
            }
            CHECK(next == 500);
        }
}

TEST_CASE("HTTP events: a listener that is behind keeps the newest of each kind") {
    EventQueue queue(10);
    const auto push = [&](const std::string& name, const std::string& text) {
        queue.push(std::make_shared<const Event>(Event{name, text}));
    };
    const auto all = [&] {
        std::string text;
        while (!queue.empty()) text += queue.pop()->text + " ";
        return text;
    };
    push("a", "a1"), push("a", "a2"), push("b", "b1");
    CHECK(queue.bytes() == 6);
    CHECK(all() == "a1 a2 b1 ");
    push("a", "a123456"), push("b", "b1"), push("a", "a7"), push("c", "c1"), push("a", "a8");
    CHECK(queue.bytes() == 6);
    CHECK(all() == "b1 c1 a8 ");
    CHECK(queue.bytes() == 0);
}

}  // namespace fettle::design::cli::studio::http_events_test
