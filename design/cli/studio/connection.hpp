// SPDX-License-Identifier: MIT
/// One client's connection to the studio's server: requests and their answers one after the other, or, once it asked for /events, events.
/// All of it runs on the server's thread. connection.cpp is the only file that includes Beast, which takes long to compile.
#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "design/cli/studio/event_queue.hpp"
#include "design/cli/studio/http_message.hpp"
#include "design/cli/studio/request_guard.hpp"

namespace fettle::design::cli::studio {

/// It is owned by the handlers of its operations, and ends with the last of them.
class Connection {
public:
    virtual ~Connection() = default;

    /// Its operations end with a fault, and it with them: not before this returns, where an operation is under way.
    virtual void close() = 0;
    /// Contract of these three: it is a listener.
    virtual bool listens_as(const std::string& client) const = 0;
    virtual void give(std::shared_ptr<const Event> event) = 0;
    virtual bool is_sending() const = 0;
};

/// What connections share. Used on the server's thread alone, but for what is atomic.
struct Shared {
    ServerOptions options;
    GuardRules rules;
    AnswerRequest answer;
    OnListener on_listener;
    std::function<void(std::function<void()>)> do_later;  ///< on another thread, one after the other
    std::size_t connections = 0;
    std::list<Connection*> unproven;     ///< have shown no token yet; the oldest first
    std::vector<Connection*> listeners;  ///< in the order in which they came
    std::atomic<std::size_t> listener_count{0};
    std::atomic<bool> is_ending{false};  ///< nobody is told any more who goes
};

/// Begins to read requests.
void serve(boost::asio::ip::tcp::socket socket, Shared& shared);

/// Gives this answer before anything is asked.
void turn_away(boost::asio::ip::tcp::socket socket, Shared& shared, const Answer& answer);

}  // namespace fettle::design::cli::studio
