// SPDX-License-Identifier: MIT
#include "design/cli/mcp/call.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/files/atomic_file.hpp"

namespace fettle::design::cli::mcp {

namespace {

constexpr std::size_t most_of_error = 4000, most_of_answer = std::size_t{1} << 29U;

std::string in_quotes(const std::string& word) {
    if (!word.empty() &&
        word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./,:%+") == std::string::npos)
        return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace

Call::Call(const Tool& tool, std::vector<std::string> words, const std::vector<std::string>& passed_on, std::filesystem::path folder)
    : tool_(tool), folder_(std::move(folder)), typed_("fettle") {
    for (const std::string& word : words) typed_ += " " + in_quotes(word);
    std::filesystem::create_directories(folder_);
    words.insert(words.begin(), "/proc/self/exe");
    words.insert(words.end(), passed_on.begin(), passed_on.end());
    if (std::string(tool.name) == "draw") words.push_back("--out=" + (folder_ / "picture.png").string());
    words.insert(words.end(), {"--json", "--markdown=" + (folder_ / "findings.md").string()});
    core::files::Pipe out, error;
    for (const core::files::Pipe* pipe : {&out, &error}) fcntl(*pipe->from, F_SETFL, O_NONBLOCK);  // reading does not wait
    process_.emplace(core::files::Launch{.words = words, .out = *out.to, .error = *error.to});
    out_from_ = std::move(out.from);
    error_from_ = std::move(error.from);
}

Call::~Call() {
    process_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

void Call::add_streams(std::vector<pollfd>& streams) const {
    for (const core::files::Descriptor* stream : {&out_from_, &error_from_})
        if (**stream >= 0) streams.push_back({**stream, POLLIN, 0});
}

bool Call::take(core::files::Descriptor& from, std::string& into) {
    bool has_more = false;
    char bytes[65536];
    while (*from >= 0) {
        const ssize_t count = read(*from, bytes, sizeof bytes);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0 && errno == EAGAIN) return has_more;
        if (count <= 0) {
            from.close();
            return has_more;
        }
        if (into.size() < most_of_answer) into.append(bytes, static_cast<std::size_t>(count));
        has_more = true;
    }
    return has_more;
}

bool Call::listen() {
    take(out_from_, out_);
    if (!take(error_from_, error_)) return false;
    const std::size_t end = error_.find_last_of('\n');
    if (end != std::string::npos) {
        const std::size_t begin = end == 0 ? std::string::npos : error_.find_last_of('\n', end - 1);
        doing_ = error_.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1));
    }
    if (error_.size() > most_of_error) error_.erase(0, error_.size() - most_of_error);
    return end != std::string::npos;
}

std::optional<Ended> Call::ended() {
    listen();
    if (*out_from_ >= 0 || *error_from_ >= 0) return std::nullopt;
    const std::optional<int> code = process_->ended();
    if (!code) return std::nullopt;
    const Result<std::string> findings = core::files::read_file(folder_ / "findings.md");
    return Ended{*code, out_, findings ? *findings : "", error_, typed_};
}

std::string Call::picture() const {
    const Result<std::string> picture = core::files::read_file(folder_ / "picture.png");
    return picture ? *picture : std::string();
}

}  // namespace fettle::design::cli::mcp
