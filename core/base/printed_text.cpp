// SPDX-License-Identifier: MIT
#include "core/base/printed_text.hpp"

#include <algorithm>
#include <array>

#include "core/base/text.hpp"

namespace fettle::core::base {

namespace {

using namespace std::string_view_literals;

// White space of Unicode on a line, as .NET trims it: U+0020, U+0009, U+00A0, U+1680, U+2000 to U+200A, U+2028, U+2029, U+202F, U+205F,
// U+3000, U+FEFF.
constexpr std::array blanks{" "sv,
                            "\t"sv,
                            "\xC2\xA0"sv,
                            "\xE1\x9A\x80"sv,
                            "\xE2\x80\x80"sv,
                            "\xE2\x80\x81"sv,
                            "\xE2\x80\x82"sv,
                            "\xE2\x80\x83"sv,
                            "\xE2\x80\x84"sv,
                            "\xE2\x80\x85"sv,
                            "\xE2\x80\x86"sv,
                            "\xE2\x80\x87"sv,
                            "\xE2\x80\x88"sv,
                            "\xE2\x80\x89"sv,
                            "\xE2\x80\x8A"sv,
                            "\xE2\x80\xA8"sv,
                            "\xE2\x80\xA9"sv,
                            "\xE2\x80\xAF"sv,
                            "\xE2\x81\x9F"sv,
                            "\xE3\x80\x80"sv,
                            "\xEF\xBB\xBF"sv};

// The size of the blank that a text begins with; 0 if it begins with none.
std::size_t blank_size(std::string_view text) {
    const auto* const blank = std::find_if(blanks.begin(), blanks.end(), [&](std::string_view each) { return text.starts_with(each); });
    return blank == blanks.end() ? 0 : blank->size();
}

}  // namespace

std::string printed(std::string_view text) {
    const std::string all = shown(text);
    std::string out;
    out.reserve(all.size());
    bool begins = true;  // nothing but blanks stands before in this line
    for (std::string_view rest = all; !rest.empty();) {
        const std::size_t blank = begins ? blank_size(rest) : 0;
        const std::size_t size = std::max<std::size_t>(1, blank);
        if (begins && rest.starts_with("::"))
            out += "\\x3a";
        else if (rest.starts_with("##["))
            out += "\\x23";
        else
            out += rest.substr(0, size);
        begins = rest.front() == '\n' || blank > 0;
        rest.remove_prefix(size);
    }
    return out;
}

}  // namespace fettle::core::base
