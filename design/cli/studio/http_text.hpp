// SPDX-License-Identifier: MIT
/// What the studio's server sends, as text: heads of answers (RFC 9112) and server-sent events (HTML, 9.2).
#pragma once

#include <string>
#include <string_view>

#include "design/cli/studio/http_message.hpp"

namespace fettle::design::cli::studio {

/// The head of this answer. Browsers keep nothing of it in caches, take it for no other type, and let no page of another origin read it.
std::string head_text(const Answer& answer, bool keeps_alive);

/// The head of a stream of events, and its first line: whoever loses it asks again after 0.5 s.
std::string event_stream_head();

/// One event. Line ends (\n, \r, \r\n) in its data begin another line of data. Contract: the name has no line ends.
std::string event_text(std::string_view name, std::string_view data);

/// A line that says nothing, so that the connection is seen to live.
std::string event_comment();

}  // namespace fettle::design::cli::studio
