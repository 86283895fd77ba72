// SPDX-License-Identifier: MIT
/// HTTP/1.1 for one page and its program on this machine: answers requests, and tells listeners events (server-sent events). It knows
/// nothing of what is asked and told. Whom it answers: request_guard.hpp.
///
/// One thread serves all connections, so that idle, slow and half-closed ones cost nothing but their memory. No fault of one connection
/// reaches another.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "core/base/result.hpp"
#include "design/cli/studio/http_message.hpp"

namespace fettle::design::cli::studio {

class HttpServer {
public:
    /// Begins to serve. `answer` gets all requests but those for /events. Both are called on the server's thread, one call at a time; what
    /// they take, all others wait (Answer::later). They may call `tell`. An exception of `answer` is answered 500, one of `on_listener`
    /// ends that listener. Errors: a port that is taken or not allowed, a token of other characters, no random numbers, no thread.
    static core::base::Result<std::unique_ptr<HttpServer>> listen(ServerOptions options, AnswerRequest answer, OnListener on_listener);

    /// Ends all connections and the thread at once; waits for a call of `answer`, `later` or `on_listener` that is under way, and makes no
    /// other: listeners that are still there are not reported as gone. Contract: not on the server's thread.
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// "http://127.0.0.1:43211/?token=..."
    std::string address() const;

    /// An event for all listeners, or those of one client, in the order of the calls. Returns at once, on any thread. A listener that is
    /// behind gets the newest of each kind only (event_queue.hpp). Contract: the event's name is one line.
    void tell(const std::string& event, const std::string& data, const std::string& client = "");

    std::size_t listeners() const;

private:
    class Impl;
    explicit HttpServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace fettle::design::cli::studio
