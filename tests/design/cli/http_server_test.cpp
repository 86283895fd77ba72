// SPDX-License-Identifier: MIT
// The studio's server, asked over plain sockets: whom it answers, and that nobody who is slow, silent or makes no sense holds up others.
#include "design/cli/studio/http_server.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/design/cli/http_peer.hpp"

namespace fettle::design::cli::studio::http_server_test {

namespace {

using namespace fettle::tests::design_support;

// How many connections with both ends in this process the system lets it have, at most 1,000.
std::size_t possible_connections() {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 4096);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    return std::min<std::size_t>(1000, (static_cast<std::size_t>(limit.rlim_cur) - 100) / 2);
}

}  // namespace

TEST_CASE("HTTP server: what has passed is answered, and says how it may be used") {
    const Served served;
    Peer peer(served.port());
    peer.say(served.request("GET /a%20b?x=1%262&y=c+d"));
    const Peer::Heard heard = peer.answer();
    CHECK(heard.status == 200);
    CHECK(heard.body == "GET /a b token=" + std::string(token) + " x=1&2 y=c d ");
    for (const char* line :
         {"Content-Type: text/plain", "Cache-Control: no-store", "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
          "Cross-Origin-Opener-Policy: same-origin", "Cross-Origin-Resource-Policy: same-origin", "Connection: keep-alive"})
        CHECK(heard.has(line));
    peer.say(served.post("/call", "{\"do\": \"it\"}"));  // on the same connection
    CHECK(peer.answer().body == "POST /call token=" + std::string(token) + " {\"do\": \"it\"}");
    peer.say(served.request("GET /throws"));
    CHECK(peer.answer().status == 500);
    peer.say(served.request("GET /last", "Connection: close\r\n"));
    CHECK(peer.answer().has("Connection: close"));
    CHECK(peer.ends());
}

TEST_CASE("HTTP server: who is not answered, and why") {
    const Served served;
    const std::string own = served.authority(), other = "127.0.0.1:" + std::to_string(served.port() ^ 1U),
                      with_token = "?token=" + std::string(token);
    const std::string json = "Content-Type: application/json\r\n", local = "localhost:" + std::to_string(served.port());
    const auto with_host = [&](const std::string& host) { return "GET /x" + with_token + " HTTP/1.1\r\n" + host + "\r\n"; };
    const auto with_target = [&](const std::string& target) { return "GET " + target + " HTTP/1.1\r\nHost: " + own + "\r\n\r\n"; };
    const std::vector<std::pair<std::string, int>> table{
        {with_target("/x"), 403},
        {with_target("/x?token="), 403},
        {with_target("/x?tokens=" + std::string(token)), 403},
        {with_target("/x?Token=" + std::string(token)), 403},
        {with_target("/x?token=" + std::string(token) + "0"), 403},
        {with_target("/x?token=" + std::string(token).substr(1)), 403},
        {with_target("/x" + with_token + "&token=0"), 403},
        {with_target("/x" + with_token + "&token=" + std::string(token)), 403},
        {with_target("/token=" + std::string(token)), 403},
        {with_target("/%zz"), 403},  // the token comes first
        {"DELETE /x HTTP/1.1\r\nHost: " + own + "\r\n\r\n", 403},
        {with_host("Host: " + own + "\r\n"), 200},
        {with_host("Host: " + local + "\r\n"), 200},
        {with_host(""), 403},
        {with_host("Host: \r\n"), 403},
        {with_host("Host: " + other + "\r\n"), 403},
        {with_host("Host: 127.0.0.1\r\n"), 403},
        {with_host("Host: evil.example:" + std::to_string(served.port()) + "\r\n"), 403},
        {with_host("Host: localhost.evil.example:" + std::to_string(served.port()) + "\r\n"), 403},
        {with_host("Host: " + own + "\r\nHost: evil.example\r\n"), 403},
        {served.request("GET /x", "Origin: http://" + own + "\r\n"), 200},
        {served.request("GET /x", "Origin: http://" + local + "\r\n"), 200},
        {served.request("GET /x", "Origin: https://" + own + "\r\n"), 403},
        {served.request("GET /x", "Origin: http://" + other + "\r\n"), 403},
        {served.request("GET /x", "Origin: http://evil.example\r\n"), 403},
        {served.request("GET /x", "Origin: null\r\n"), 403},
        {served.request("GET /x", "Origin: http://" + own + "\r\nOrigin: http://evil.example\r\n"), 403},
        {served.request("GET /x", "Sec-Fetch-Site: same-origin\r\n"), 200},
        {served.request("GET /x", "Sec-Fetch-Site: none\r\n"), 200},
        {served.request("GET /x", "Sec-Fetch-Site: same-site\r\n"), 403},
        {served.request("GET /x", "Sec-Fetch-Site: cross-site\r\n"), 403},
        {served.request("GET /", "Sec-Fetch-Site: cross-site\r\n"), 403},
        {served.request("GET /", "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n"), 403},
        {served.request("GET /", "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n"), 200},
        {served.request("GET /events", "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n"), 403},
        {served.request("POST /", json + "Content-Length: 0\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n"), 403},
        {served.request("PUT /x"), 405},
        {served.request("HEAD /x"), 405},
        {served.request("OPTIONS /x"), 405},
        {served.request("get /x"), 405},
        {served.request("POST /events", json + "Content-Length: 0\r\n"), 405},
        {with_target("/%" + with_token), 400},
        {with_target("/%2" + with_token), 400},
        {with_target("/%-1" + with_token), 400},
        {with_target("/%00" + with_token), 400},
        {with_target("/%0a" + with_token), 400},
        {with_target("/%ff" + with_token), 400},
        {with_target("/x" + with_token + "&a=1&a=2"), 400},
        {with_target("/x#part" + with_token), 400},
        {with_target("/\"" + with_token), 400},
        {with_target("http://" + own + "/x" + with_token), 400},
        {with_target("x" + with_token), 400},
        {with_target("*"), 403},
        {served.request("POST /x", "Content-Type: text/plain\r\nContent-Length: 2\r\n", "{}"), 415},
        {served.request("POST /x", "Content-Length: 2\r\n", "{}"), 415},
        {served.request("POST /x", json + json + "Content-Length: 2\r\n", "{}"), 415},
        {served.request("POST /x", "Content-Type: application/jsonp\r\nContent-Length: 2\r\n", "{}"), 415},
        {served.request("POST /x", "Content-Type: Application/JSON ; charset=utf-8\r\nContent-Length: 2\r\n", "{}"), 200},
        {served.request("POST /x", json + "Content-Length: 1048576\r\n", std::string(1048576, 'x')), 200},
        {served.request("POST /x", json + "Content-Length: 1048577\r\n"), 413},
        {served.request("POST /x", json + "Content-Length: 18446744073709551615\r\n"), 413},
        {served.request("POST /x", json + "Content-Length: 18446744073709551616\r\n"), 400},
        {served.request("POST /x", json + "Content-Length: -1\r\n"), 400},
        {served.request("POST /x", json + "Content-Length: 2\r\nContent-Length: 3\r\n", "{}"), 400},
        {served.request("POST /x", json + "Transfer-Encoding: chunked\r\n", "2\r\n{}\r\n0\r\n\r\n"), 411},
        {served.request("POST /x", json + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n", "{}"), 400},
        {served.request("GET /x", "X: " + std::string(15'000, 'x') + "\r\n"), 200},
        {served.request("GET /x", "X: " + std::string(16'384, 'x') + "\r\n"), 431},
        {served.request("GET /x?y=" + std::string(20'000, 'x')), 431},
        {"GET /x HTTP/2.0\r\n\r\n", 505},
        {"GET\r\n\r\n", 400},
        {"\x16\x03\x01\x02\x01\x01\xfc\x03\x03\r\n\r\n", 400},
        {served.request("GET /x", "Na me: x\r\n"), 400},
    };
    for (const auto& [text, status] : table) {
        CAPTURE(text.substr(0, 300));
        const Peer::Heard heard = served.ask(text);
        CHECK(heard.status == status);
        if (status != 200) CHECK((heard.body.starts_with(R"({"error": ")") && heard.body.ends_with(R"("})")));
        if (status != 200) CHECK(heard.has("Connection: close"));
    }
    CHECK(served.ask(served.request("PUT /x")).has("Allow: GET, POST"));
    CHECK(served.ask(served.request("POST /events", json + "Content-Length: 0\r\n")).has("Allow: GET"));
}

TEST_CASE("HTTP server: a token that is wrong in one letter is wrong") {
    const Served served;
    for (std::size_t k = 0; k < token.size(); ++k) {
        std::string text = served.request("GET /x");
        text[text.find(token) + k] ^= 1;
        CHECK(served.ask(text).status == 403);
    }
    CHECK(served.answers());
    const auto random = [] {
        return HttpServer::listen(
            {}, [](const Request&) { return Answer(); }, [](const std::string&, bool) {});
    };
    const auto one = random(), another = random();
    REQUIRE((one && another));
    const std::string first = (*one)->address(), second = (*another)->address();
    CHECK(first.substr(first.find("?token=")).size() == 7 + 32);
    CHECK(first.substr(first.find("?token=")) != second.substr(second.find("?token=")));
}

TEST_CASE("HTTP server: an answer that takes long holds up no other, and is waited for at the end") {
    std::atomic<bool> may_end = false, has_ended = false;
    ServerOptions options;
    options.token = token;
    auto server = HttpServer::listen(
                      options,
                      [&](const Request& request) -> Answer {
                          if (request.path == "/quick") return {200, "text/plain", "quick"};
                          if (request.path == "/throws") return {.later = []() -> Answer { throw std::runtime_error("late"); }};
                          return {.later = [&]() -> Answer {
                              while (!may_end) std::this_thread::sleep_for(1ms);
                              has_ended = true;
                              return {200, "text/plain", "late"};
                          }};
                      },
                      [](const std::string&, bool) {})
                      .value();
    const auto port = static_cast<unsigned short>(std::stoi(server->address().substr(17)));
    const auto request = [&](const std::string& path) {
        return "GET " + path + "?token=" + std::string(token) + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port) + "\r\n\r\n";
    };
    Peer waits(port), quick(port), leaves(port);
    waits.say(request("/late"));
    leaves.say(request("/late"));
    quick.say(request("/quick"));
    CHECK(quick.until("quick").ends_with("quick"));
    may_end = true;
    waits.say(request("/quick"));  // answers keep their order
    CHECK(waits.until("late").ends_with("late"));
    CHECK(waits.until("quick").ends_with("quick"));
    quick.say(request("/throws"));
    CHECK(quick.until("answered").starts_with("HTTP/1.1 500"));
    may_end = has_ended = false;
    leaves.until("late");
    leaves.say(request("/late"));
    quick.say(request("/late"));
    quick.say(request("/quick"));
    std::thread ends([&] {
        std::this_thread::sleep_for(30ms);
        may_end = true;
    });
    std::this_thread::sleep_for(10ms);
    server.reset();
    CHECK(has_ended);
    ends.join();
}

TEST_CASE("HTTP server: a port that is taken, and a token that would have to be encoded, are errors") {
    const Served served;
    ServerOptions taken;
    taken.port = served.port();
    const auto nothing = [](const Request&) { return Answer(); };
    CHECK(HttpServer::listen(taken, nothing, {}).errors().size() == 1);
    ServerOptions encoded;
    encoded.token = "a&b";
    CHECK(HttpServer::listen(encoded, nothing, {}).errors().size() == 1);
}

TEST_CASE("HTTP server: requests that come at once, in pieces, or before the other side hears no more") {
    const Served served;
    Peer at_once(served.port());
    std::string all;
    for (int k = 0; k < 100; ++k) all += served.post("/" + std::to_string(k), std::string(static_cast<std::size_t>(k), 'x'));
    at_once.say(all);
    for (int k = 0; k < 100; ++k)
        CHECK(at_once.answer().body ==
              "POST /" + std::to_string(k) + " token=" + std::string(token) + " " + std::string(static_cast<std::size_t>(k), 'x'));
    Peer in_pieces(served.port());
    for (const char letter : served.post("/x", "{}")) in_pieces.say({&letter, 1});
    CHECK(in_pieces.answer().status == 200);
    Peer half_closed(served.port());
    half_closed.say(served.request("GET /large"));
    half_closed.say_no_more();
    CHECK(half_closed.answer().body.size() == 8'000'000);
    CHECK(half_closed.ends());
    Peer asks_first(served.port());
    asks_first.say(served.request("POST /x", "Content-Type: application/json\r\nContent-Length: 2\r\nExpect: 100-continue\r\n"));
    CHECK(asks_first.until("\r\n\r\n") == "HTTP/1.1 100 Continue\r\n\r\n");
    asks_first.say("{}");
    CHECK(asks_first.answer().status == 200);
    Peer is_refused(served.port());  // all of the answer arrives, though its body is not read
    is_refused.say(served.request("POST /x", "Content-Type: application/json\r\nContent-Length: 2000000\r\n", std::string(2'000'000, 'x')));
    CHECK(is_refused.answer().status == 413);
}

TEST_CASE("HTTP server: who is too slow is closed") {
    ServerOptions options;
    options.header_timeout = options.body_timeout = options.idle_timeout = options.answer_timeout = options.linger_timeout = 100ms;
    const Served served(options);
    Peer silent(served.port()), head(served.port()), body(served.port()), idle(served.port()), greedy(served.port(), 4096),
        refused(served.port());
    head.say("GET /x?token=");
    body.say(served.request("POST /x", "Content-Type: application/json\r\nContent-Length: 100\r\n", "{"));
    idle.say(served.request("GET /x"));
    greedy.say(served.request("GET /large"));
    refused.say("nonsense\r\n\r\n");
    CHECK(idle.answer().status == 200);
    CHECK(refused.answer().status == 400);
    const auto begin = Clock::now();
    for (Peer* each : {&silent, &head, &body, &idle, &refused}) CHECK(each->ends());
    Peer drips(served.port());  // a byte now and then is not enough
    for (int k = 0; k < 400 && !drips.ends(5ms); ++k) drips.say("G");
    CHECK(drips.ends(0ms));
    CHECK(Clock::now() - begin < soon);
    std::this_thread::sleep_for(150ms);
    CHECK(greedy.answer().body.size() < 8'000'000);
    CHECK(served.answers());
}

TEST_CASE("HTTP server: connections that say nothing make room for those that do") {
    ServerOptions options;
    options.most_connections = possible_connections();
    const Served served(options);
    std::vector<Peer> silent;
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < options.most_connections; ++k) silent.emplace_back(served.port());
    for (std::size_t k = 0; k < 10; ++k) CHECK(served.answers());
    CHECK(silent.front().ends());
    silent.back().say(served.request("GET /x"));
    CHECK(silent.back().answer().status == 200);
    CHECK(Clock::now() - begin < soon);
}

TEST_CASE("HTTP server: above the limit it says so") {
    ServerOptions options;
    options.most_connections = 3;
    const Served served(options);
    std::vector<Peer> listeners;
    for (const char* client : {"a", "b", "c"}) listeners.push_back(served.listener(client));
    for (int k = 0; k < 3; ++k) {
        const Peer::Heard heard = served.ask("");
        CHECK(heard.status == 503);
        CHECK(heard.has("Connection: close"));
    }
    listeners.pop_back();
    CHECK(comes_true([&] { return served.answers(); }));
}

TEST_CASE("HTTP server: garbage") {
    const Served served;
    std::mt19937 random(57);  // NOLINT: the same each time
    const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    const std::vector<std::string> good{
        served.request("GET /x"), served.post("/call", "{\"do\": \"undo\"}"), served.request("GET /events?client=a"),
        served.request("POST /x", "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n", "1\r\nx\r\n0\r\n\r\n")};
    for (int k = 0; k < 2000; ++k) {
        std::string text = good[below(good.size())];
        if (k % 4 == 0) {
            text.resize(below(300) + 1);
            for (char& letter : text) letter = static_cast<char>(below(256));
        } else {
            for (std::size_t changes = below(6) + 1; changes > 0; --changes) {
                const std::size_t at = below(text.size());
                if (k % 4 == 1) text[at] = static_cast<char>(below(256));
                if (k % 4 == 2) text.insert(at, text.substr(below(text.size()), below(40)));
                if (k % 4 == 3 && text.size() > 50) text.erase(at, below(20));
            }
        }
        Peer peer(served.port());
        peer.say(text);
        peer.say_no_more();
        if (!peer.ends()) FAIL("not ended: " + text);
        if (k % 500 == 0) CHECK(served.answers());
    }
    CHECK(served.answers());
}

TEST_CASE("HTTP server: its end is the end of every connection, at once") {
    Served served;
    Peer silent(served.port()), half(served.port()), greedy(served.port(), 4096), listener = served.listener("a"),
                                                                                  sleeps = served.listener("b", 4096);
    half.say("GET /");
    greedy.say(served.request("GET /large"));
    for (int k = 0; k < 100; ++k) served->tell("kind" + std::to_string(k), std::string(100'000, 'x'), "b");
    CHECK(served.answers());
    const auto begin = Clock::now();
    served.end();
    CHECK(Clock::now() - begin < 1s);
    for (Peer* each : {&silent, &half, &greedy, &listener, &sleeps}) CHECK(each->ends());
    CHECK(served.seen() == "+a+b");  // nobody is told who goes
}

}  // namespace fettle::design::cli::studio::http_server_test
