// SPDX-License-Identifier: MIT
/// Lines of a text file as lists of words, and words as numbers: what the readers of OBJ and OFF share.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace fettle::core::files {

/// Walks over the lines of a text that have words. `#` begins a comment; a line that ends in `\` goes on in the next; CR LF is a line end.
class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text) {}

    /// False at the end of the text. The words are valid as long as the text is.
    bool next(std::vector<std::string_view>& words);

    /// Of the line read last (where it began), from 1.
    int line_number() const { return line_number_; }

private:
    std::string_view rest_;
    int line_number_ = 0;
    int lines_read_ = 0;
};

/// The nearest double, inf and nan included; nullopt unless the whole word is a number. Independent of the locale.
std::optional<double> parsed_number(std::string_view word);
std::optional<int> parsed_integer(std::string_view word);

}  // namespace fettle::core::files
