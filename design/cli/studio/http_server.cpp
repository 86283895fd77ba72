// SPDX-License-Identifier: MIT
#include "design/cli/studio/http_server.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <system_error>
#include <thread>
#include <utility>

#include "design/cli/studio/connection.hpp"
#include "design/cli/studio/event_queue.hpp"
#include "design/cli/studio/http_text.hpp"
#include "design/cli/studio/request_guard.hpp"

namespace fettle::design::cli::studio {

namespace {

namespace net = boost::asio;
using core::base::Error;
using core::base::ErrorCode;
using core::base::Errors;
using core::base::Result;
using net::ip::tcp;
using Fault = boost::system::error_code;

constexpr std::size_t most_turned_away = 64;  // connections beyond the limit that are told so

// Programs that are started meanwhile do not keep it open.
void close_in_children(int descriptor) { ::fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

Result<std::string> random_token() {
    std::array<unsigned char, 16> bytes{};
    if (::getentropy(bytes.data(), bytes.size()) != 0) return Error{ErrorCode::unsupported, "token", "the system gives no random numbers"};
    std::string token;
    for (const unsigned char byte : bytes) (token += "0123456789abcdef"[byte >> 4U]) += "0123456789abcdef"[byte & 15U];
    return token;
}

bool is_plain(const std::string& token) {
    return std::all_of(token.begin(), token.end(),
                       [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

}  // namespace

class HttpServer::Impl {
public:
    Impl(ServerOptions options, AnswerRequest answer, OnListener on_listener) {
        shared_.options = std::move(options);
        shared_.answer = std::move(answer);
        shared_.on_listener = std::move(on_listener);
        shared_.do_later = [this](std::function<void()> work) { net::post(beside_, std::move(work)); };
    }
    ~Impl() {
        shared_.is_ending = true;
        io_.stop();
        if (thread_.joinable()) thread_.join();
        beside_.stop();
        beside_.join();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    Errors start() {
        Fault fault;
        acceptor_.open(tcp::v4(), fault);
        if (!fault) acceptor_.set_option(tcp::acceptor::reuse_address(true), fault);
        if (!fault) acceptor_.bind({net::ip::address_v4::loopback(), shared_.options.port}, fault);
        if (!fault) acceptor_.listen(net::socket_base::max_listen_connections, fault);
        const tcp::endpoint own = fault ? tcp::endpoint() : acceptor_.local_endpoint(fault);
        if (fault)
            return {{ErrorCode::unsupported, "port",
                     "port " + std::to_string(shared_.options.port) + " of this machine cannot be had: " + fault.message() +
                         "; choose another, or 0 for any that is free"}};
        close_in_children(acceptor_.native_handle());
        shared_.rules = {shared_.options.token, own.port(), shared_.options.most_body};
        accept();
        comment();
        try {
            thread_ = std::thread([this] { run(); });
        } catch (const std::system_error&) {
            return {{ErrorCode::out_of_memory, "", "the system has no thread left"}};
        }
        return {};
    }

    std::string address() const { return "http://127.0.0.1:" + std::to_string(shared_.rules.port) + "/?token=" + shared_.rules.token; }
    std::size_t listeners() const { return shared_.listener_count; }

    void tell(std::shared_ptr<const Event> event, const std::string& client) {
        net::post(io_, [this, event = std::move(event), client] {
            each_listener([&](Connection& listener) {
                if (client.empty() || listener.listens_as(client)) listener.give(event);
            });
        });
    }

private:
    // A handler that throws takes its own connection with it, which nothing else owns.
    void run() {
        for (bool has_ended = false; !has_ended;) {
            try {
                io_.run();
                has_ended = true;
            } catch (...) {  // the others go on
            }
        }
    }

    // Listeners stay in the list until a handler of their own has run, also those that are closed here.
    template <class Visit>
    void each_listener(const Visit& visit) {
        for (Connection* listener : shared_.listeners) {
            try {
                visit(*listener);
            } catch (...) {
                listener->close();
            }
        }
    }

    void accept() {
        acceptor_.async_accept([this](const Fault& fault, tcp::socket socket) {
            if (fault) return accept_again();
            try {
                take(std::move(socket));
            } catch (...) {  // there is no memory for it
            }
            accept();
        });
    }
    // There may be no file handle left: who has shown no token makes room, or else we wait.
    void accept_again() {
        if (!shared_.unproven.empty()) {
            shared_.unproven.front()->close();
            return accept();
        }
        pause_.expires_after(std::chrono::milliseconds(50));
        pause_.async_wait([this](const Fault& fault) {
            if (!fault) accept();
        });
    }

    void take(tcp::socket socket) {
        close_in_children(socket.native_handle());
        Fault ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        const std::size_t most = shared_.options.most_connections;
        const bool has_room = shared_.connections < most || !shared_.unproven.empty();
        if (!has_room && shared_.connections >= most + most_turned_away) return;
        if (has_room && shared_.connections >= most) shared_.unproven.front()->close();
        if (has_room) return serve(std::move(socket), shared_);
        turn_away(std::move(socket), shared_, refused(503, "too many connections"));
    }

    void comment() {
        comments_.expires_after(shared_.options.comment_interval);
        comments_.async_wait([this](const Fault& fault) {
            if (fault) return;
            const auto said = std::make_shared<const Event>(Event{"", event_comment()});
            each_listener([&](Connection& listener) {
                if (!listener.is_sending()) listener.give(said);
            });
            comment();
        });
    }

    Shared shared_;  // outlives the connections, which end with the handlers in io_
    net::io_context io_{1};
    net::thread_pool beside_{1};  // for answers that take long; ends after io_'s thread, and before io_
    tcp::acceptor acceptor_{io_};
    net::steady_timer pause_{io_}, comments_{io_};
    std::thread thread_;
};

HttpServer::HttpServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HttpServer::~HttpServer() = default;

Result<std::unique_ptr<HttpServer>> HttpServer::listen(ServerOptions options, AnswerRequest answer, OnListener on_listener) {
    if (!is_plain(options.token)) return Error{ErrorCode::out_of_range, "token", "letters and digits are expected"};
    if (options.token.empty()) {
        const Result<std::string> token = random_token();
        if (!token) return token.errors();
        options.token = *token;
    }
    auto impl = std::make_unique<Impl>(std::move(options), std::move(answer), std::move(on_listener));
    if (const Errors errors = impl->start(); !errors.empty()) return errors;
    return std::unique_ptr<HttpServer>(new HttpServer(std::move(impl)));
}

std::string HttpServer::address() const { return impl_->address(); }
std::size_t HttpServer::listeners() const { return impl_->listeners(); }
void HttpServer::tell(const std::string& event, const std::string& data, const std::string& client) {
    impl_->tell(std::make_shared<const Event>(Event{event, event_text(event, data)}), client);
}

}  // namespace fettle::design::cli::studio
