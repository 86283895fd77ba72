// SPDX-License-Identifier: MIT
/// The studio's server for tests, and plain sockets that ask it.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "design/cli/studio/http_server.hpp"

namespace fettle::tests::design_support {

using design::cli::studio::Answer;
using design::cli::studio::HttpServer;
using design::cli::studio::Request;
using design::cli::studio::ServerOptions;
using namespace std::chrono_literals;  // NOLINT: of tests
using Clock = std::chrono::steady_clock;

inline constexpr std::chrono::milliseconds soon = 5s;  // what comes at all comes until then
inline constexpr std::string_view token = "0123456789abcdef0123456789abcdef";

// One end of a connection to a port of this machine.
class Peer {
public:
    explicit Peer(unsigned short port, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        REQUIRE(socket_ >= 0);
        if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    }
    ~Peer() { ::close(socket_); }
    Peer(Peer&& other) noexcept : socket_(std::exchange(other.socket_, -1)), heard_(std::move(other.heard_)) {}
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    Peer& operator=(Peer&&) = delete;

    // As far as the other side takes it.
    void say(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
            if (sent <= 0) return;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
    }
    void say_no_more() const { ::shutdown(socket_, SHUT_WR); }

    // All up to this text and with it; what there is, where the other side ends before.
    std::string until(std::string_view end) {
        std::size_t found = heard_.find(end);
        while (found == std::string::npos && hear()) found = heard_.find(end);
        return take(found == std::string::npos ? heard_.size() : found + end.size());
    }
    std::string bytes(std::size_t count) {
        while (heard_.size() < count && hear()) {
        }
        return take(std::min(count, heard_.size()));
    }
    bool ends(std::chrono::milliseconds patience = soon) {
        while (hear(patience)) {
        }
        return has_ended_;
    }

    struct Heard {
        int status = 0;
        std::string head, body;
        bool has(std::string_view line) const { return head.find("\r\n" + std::string(line) + "\r\n") != std::string::npos; }
    };
    Heard answer() {
        Heard heard;
        heard.head = until("\r\n\r\n");
        if (!heard.head.starts_with("HTTP/1.1 ")) return heard;
        heard.status = std::stoi(heard.head.substr(9));
        const std::size_t length = heard.head.find("Content-Length: ");
        if (length != std::string::npos) heard.body = bytes(std::stoul(heard.head.substr(length + 16)));
        return heard;
    }

private:
    bool hear(std::chrono::milliseconds patience = soon) {
        pollfd waiting{socket_, POLLIN, 0};
        if (::poll(&waiting, 1, static_cast<int>(patience.count())) != 1) return false;
        char buffer[65536];
        const ssize_t count = ::recv(socket_, buffer, sizeof buffer, 0);
        has_ended_ = count <= 0;
        if (!has_ended_) heard_.append(buffer, static_cast<std::size_t>(count));
        return !has_ended_;
    }
    std::string take(std::size_t count) {
        std::string taken = heard_.substr(0, count);
        heard_.erase(0, count);
        return taken;
    }

    int socket_;
    std::string heard_;
    bool has_ended_ = false;
};

// A server that says back what it was asked, and who has come and gone.
class Served {
public:
    explicit Served(ServerOptions options = {}) {
        options.token = token;
        auto listening = HttpServer::listen(
            options, [](const Request& request) { return said_back(request); },
            [this](const std::string& client, bool connected) {
                if (client == "throws") throw std::runtime_error("of a listener");
                const std::lock_guard lock(mutex_);
                seen_ += (connected ? "+" : "-") + client;
            });
        REQUIRE(listening);
        server_ = std::move(listening).value();
        const std::string address = server_->address();
        REQUIRE(address.starts_with("http://127.0.0.1:"));
        port_ = static_cast<unsigned short>(std::stoi(address.substr(17)));
    }

    HttpServer& operator*() { return *server_; }
    HttpServer* operator->() { return server_.get(); }
    unsigned short port() const { return port_; }
    std::string authority() const { return "127.0.0.1:" + std::to_string(port_); }
    void end() { server_.reset(); }
    std::string seen() const {
        const std::lock_guard lock(mutex_);
        return seen_;
    }

    // "GET /x?a=b" with the token, Host, and these fields.
    std::string request(const std::string& what, const std::string& fields = {}, const std::string& body = {}) const {
        return what + (what.find('?') == std::string::npos ? "?" : "&") + "token=" + std::string(token) +
               " HTTP/1.1\r\nHost: " + authority() + "\r\n" + fields + "\r\n" + body;
    }
    std::string post(const std::string& path, const std::string& body) const {
        return request("POST " + path, "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n", body);
    }
    Peer::Heard ask(const std::string& text) const {
        Peer peer(port_);
        peer.say(text);
        return peer.answer();
    }
    bool answers() const { return ask(request("GET /x")).body == "GET /x token=" + std::string(token) + " "; }

    Peer listener(const std::string& client, int receive_buffer = 0) const {
        Peer peer(port_, receive_buffer);
        peer.say(request("GET /events?client=" + client));
        CHECK(peer.until("\r\n\r\n").find("Content-Type: text/event-stream") != std::string::npos);
        CHECK(peer.until("\n\n") == "retry: 500\n\n");
        return peer;
    }

private:
    static Answer said_back(const Request& request) {
        if (request.path == "/throws") throw std::runtime_error("of an answer");
        if (request.path == "/large") return {200, "text/plain", std::string(8'000'000, 'x'), {}};
        std::string text = request.method + " " + request.path + " ";
        for (const auto& [name, value] : request.query) text.append(name).append("=").append(value) += " ";
        return {200, "text/plain", text + request.body, {}};
    }

    mutable std::mutex mutex_;
    std::string seen_;
    unsigned short port_ = 0;
    std::unique_ptr<HttpServer> server_;
};

template <class Condition>
bool comes_true(const Condition& condition) {
    const auto end = Clock::now() + soon;
    while (Clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(1ms);
    }
    return false;
}

}  // namespace fettle::tests::design_support
