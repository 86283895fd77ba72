// SPDX-License-Identifier: MIT
#include "core/files/json_lines.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace fettle::core::files {
namespace {

/// Reads no values, only where they begin and end.
class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    /// Moves to the value of an object's key, or of an array's entry, that `word` names. false: there is none.
    bool enter(const std::string& word) {
        skip_blanks();
        const bool is_object = next_is('{');
        if (!is_object && !next_is('[')) return false;
        ++at_;
        for (std::size_t number = 0; skip_blanks(), at_ < text_.size() && !next_is('}') && !next_is(']'); ++number) {
            const std::size_t begin = at_;
            std::string name = std::to_string(number);
            if (is_object) {
                skip_value();
                name = std::string(text_.substr(begin, at_ - begin));
                skip_blanks();
                if (!next_is(':')) return false;
                ++at_;
            }
            if (name == (is_object ? "\"" + word + "\"" : word)) {
                found_ = begin;
                return true;
            }
            skip_blanks();
            skip_value();
            skip_blanks();
            if (next_is(',')) ++at_;
        }
        return false;
    }

    int line() const { return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(found_), '\n')); }

private:
    bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }
    void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

    void skip_text() {
        for (++at_; at_ < text_.size() && !next_is('"'); ++at_)
            if (next_is('\\')) ++at_;
        at_ = std::min(at_ + 1, text_.size());
    }

    // At least one character, if there is one.
    void skip_value() {
        int depth = 0;
        do {
            if (next_is('"')) {
                skip_text();
                continue;
            }
            if (next_is('{') || next_is('[')) ++depth;
            if (next_is('}') || next_is(']')) --depth;
            at_ = std::min(at_ + 1, text_.size());
        } while (depth > 0 && at_ < text_.size());
        if (depth == 0 && at_ > 0 && std::string_view("\"}]").find(text_[at_ - 1]) == std::string_view::npos)
            at_ = std::min(text_.find_first_of(",}] \t\r\n", at_), text_.size());
    }

    std::string_view text_;
    std::size_t at_ = 0, found_ = 0;
};

// "~1" is "/", "~0" is "~".
std::string unescaped(std::string_view word) {
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i) {
        const bool escaped = word[i] == '~' && i + 1 < word.size();
        if (escaped) ++i;
        out += escaped ? (word[i] == '1' ? '/' : '~') : word[i];
    }
    return out;
}

}  // namespace

int line_of_pointer(std::string_view text, std::string_view pointer) {
    Scanner scanner(text);
    while (pointer.starts_with("/")) {
        pointer.remove_prefix(1);
        const std::size_t end = std::min(pointer.find('/'), pointer.size());
        if (!scanner.enter(unescaped(pointer.substr(0, end)))) break;
        pointer.remove_prefix(end);
    }
    return scanner.line();
}

}  // namespace fettle::core::files
