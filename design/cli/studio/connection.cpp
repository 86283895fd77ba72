// SPDX-License-Identifier: MIT
#include "design/cli/studio/connection.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "design/cli/studio/http_text.hpp"

namespace fettle::design::cli::studio {

namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using net::ip::tcp;
using Fault = boost::system::error_code;

constexpr std::size_t patience = std::size_t{256} << 10U;  // bytes of events: a listener with more waiting has fallen behind
constexpr std::size_t read_at_once = 4096;                 // bytes

RequestHead head_of(const http::request_parser<http::string_body>& parser) {
    RequestHead head{std::string(parser.get().method_string()), std::string(parser.get().target()), {}};
    for (const auto& field : parser.get()) {
        std::string name(field.name_string());
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        head.fields.emplace_back(std::move(name), std::string(field.value()));
    }
    return head;
}

class HttpConnection : public Connection, public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(tcp::socket socket, Shared& shared) : stream_(std::move(socket)), shared_(shared), waiting_(patience) {
        place_ = shared_.unproven.insert(shared_.unproven.end(), this);
        ++shared_.connections;
    }
    ~HttpConnection() override {
        --shared_.connections;
        leave_unproven();
        if (!client_) return;
        shared_.listeners.erase(std::find(shared_.listeners.begin(), shared_.listeners.end(), this));
        --shared_.listener_count;
        if (shared_.is_ending) return;
        try {
            shared_.on_listener(*client_, false);
        } catch (...) {  // nobody is left to be told
        }
    }
    HttpConnection(const HttpConnection&) = delete;
    HttpConnection& operator=(const HttpConnection&) = delete;

    void serve() { read_head(); }
    void turn_away(const Answer& answer) {
        leave_unproven();
        send(answer, false);
    }
    void close() override {
        leave_unproven();
        stream_.close();
    }

    bool listens_as(const std::string& client) const override { return client_ == client; }
    void give(std::shared_ptr<const Event> event) override {
        waiting_.push(std::move(event));
        const std::size_t bytes = waiting_.bytes() + (in_flight_ ? in_flight_->text.size() : 0);
        if (bytes > shared_.options.most_waiting) return close();
        if (!in_flight_) send_next_event();
    }
    bool is_sending() const override { return in_flight_ != nullptr; }

private:
    using Parser = http::request_parser<http::string_body>;

    void leave_unproven() {
        if (place_) shared_.unproven.erase(*place_);
        place_.reset();
    }

    // A handler that goes on with `next`, or closes.
    auto then(void (HttpConnection::*next)()) {
        return [self = shared_from_this(), next](const Fault& fault, std::size_t) {
            if (fault) return self->close();
            ((*self).*next)();
        };
    }

    void await_request() {
        if (buffer_.size() > 0) return read_head();
        stream_.expires_after(shared_.options.idle_timeout);
        stream_.async_read_some(buffer_.prepare(read_at_once), [self = shared_from_this()](const Fault& fault, std::size_t count) {
            if (fault) return self->close();
            self->buffer_.commit(count);
            self->read_head();
        });
    }

    void read_head() {
        parser_.emplace();
        parser_->header_limit(static_cast<std::uint32_t>(shared_.options.most_head));
        // The guard looks at the body's length. (Boost 1.74 takes every length for more than boost::none.)
        parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
        stream_.expires_after(shared_.options.header_timeout);
        http::async_read_header(stream_, buffer_, *parser_,
                                [self = shared_from_this()](const Fault& fault, std::size_t) { self->take_head(fault); });
    }

    void take_head(const Fault& fault) {
        if (fault == http::error::header_limit) return send(refused(431, "the request's head is too long"), false);
        if (fault == http::error::end_of_stream || fault == http::error::partial_message) return close();
        if (fault == http::error::bad_version) return send(refused(505, "HTTP/1.1 is expected"), false);
        if (fault.category() == http::make_error_code(http::error::bad_method).category())
            return send(refused(400, "this is no request of HTTP"), false);
        if (fault) return close();
        if (parser_->get().version() != 11 && parser_->get().version() != 10) return send(refused(505, "HTTP/1.1 is expected"), false);
        const RequestHead head = head_of(*parser_);
        if (const std::optional<Answer> why_not = refusal(head, shared_.rules)) return send(*why_not, false);
        leave_unproven();
        target_ = *parsed_target(head.target);
        const bool is_get = head.method == "GET";
        if (target_.path == "/events")
            return is_get ? listen() : send({405, "application/json", R"({"error": "events are GET"})", "GET"}, false);
        read_body();
    }

    void read_body() {
        stream_.expires_after(shared_.options.body_timeout);
        const auto expected = parser_->get()[http::field::expect];
        if (!beast::iequals(expected, "100-continue")) return read_rest();
        static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
        net::async_write(stream_, net::buffer(go_on.data(), go_on.size()), then(&HttpConnection::read_rest));
    }
    void read_rest() { http::async_read(stream_, buffer_, *parser_, then(&HttpConnection::answer)); }

    void answer() {
        const bool keeps_alive = parser_->keep_alive();
        Request request{std::string(parser_->get().method_string()), target_.path, target_.query, std::move(parser_->get().body())};
        Answer made = answer_of([&] { return shared_.answer(request); });
        if (!made.later) return send(std::move(made), keeps_alive);
        parser_.reset();
        shared_.do_later([self = shared_from_this(), later = std::move(made.later), keeps_alive] {
            Answer late = answer_of(later);
            late.later = {};
            net::post(self->stream_.get_executor(),
                      [self, late = std::move(late), keeps_alive]() mutable { self->send(std::move(late), keeps_alive); });
        });
    }

    template <class Make>
    static Answer answer_of(const Make& make) {
        try {
            return make();
        } catch (...) {
            return refused(500, "the program has a fault: this request could not be answered");
        }
    }

    void send(Answer answer, bool keeps_alive) {
        parser_.reset();
        head_ = head_text(answer, keeps_alive);
        body_ = std::move(answer.body);
        stream_.expires_after(shared_.options.answer_timeout);
        net::async_write(stream_, std::array{net::buffer(std::as_const(head_)), net::buffer(std::as_const(body_))},
                         then(keeps_alive ? &HttpConnection::await_request : &HttpConnection::linger));
    }

    // Reads on until the other side has seen the end: a socket that is closed with something unread resets the connection, and the answer
    // may be lost.
    void linger() {
        Fault ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        stream_.expires_after(shared_.options.linger_timeout);
        drop_input();
    }
    void drop_input() {
        buffer_.clear();
        stream_.async_read_some(buffer_.prepare(read_at_once), then(&HttpConnection::drop_input));
    }

    void listen() {
        parser_.reset();
        std::string client = target_.query["client"];
        shared_.listeners.push_back(this);
        client_ = std::move(client);
        ++shared_.listener_count;
        stream_.expires_never();
        drop_input();  // ends where the other side does
        give(std::make_shared<const Event>(Event{"", event_stream_head()}));
        try {
            shared_.on_listener(*client_, true);
        } catch (...) {
            close();
        }
    }

    void send_next_event() {
        in_flight_.reset();
        if (waiting_.empty()) return;
        in_flight_ = waiting_.pop();
        net::async_write(stream_, net::buffer(in_flight_->text), then(&HttpConnection::send_next_event));
    }

    beast::tcp_stream stream_;
    Shared& shared_;
    std::optional<std::list<Connection*>::iterator> place_;  // among those that have shown no token
    beast::flat_buffer buffer_;                              // what has come and is not read yet
    std::optional<Parser> parser_;
    RequestTarget target_;
    std::string head_, body_;            // of the answer that is being sent
    std::optional<std::string> client_;  // of a listener
    EventQueue waiting_;
    std::shared_ptr<const Event> in_flight_;
};

}  // namespace

void serve(tcp::socket socket, Shared& shared) { std::make_shared<HttpConnection>(std::move(socket), shared)->serve(); }

void turn_away(tcp::socket socket, Shared& shared, const Answer& answer) {
    std::make_shared<HttpConnection>(std::move(socket), shared)->turn_away(answer);
}

}  // namespace fettle::design::cli::studio
