// SPDX-License-Identifier: MIT
/// Texts as lines of words or as one run of words, and words as numbers: what the readers of text formats share.
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

    /// Number of the line read last (where it began), from 1.
    int line_number() const { return line_number_; }

private:
    std::string_view rest_;
    int line_number_ = 0;
    int lines_read_ = 0;
};

/// Walks over the words of a text, wherever its lines end. Nothing is a comment.
class TextWords {
public:
    explicit TextWords(std::string_view text) : text_(text) {}

    /// Empty at the end of the text. Valid as long as the text is.
    std::string_view next();
    /// What is left of the line that the last word stands on, without blanks round it; behind it the next line begins.
    std::string_view rest_of_line();
    /// Number of the line of the word read last, from 1.
    int line_number() const { return line_number_; }
    std::size_t bytes_left() const { return text_.size() - at_; }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    int line_number_ = 1;
};

/// The nearest double, inf and nan included; nullopt unless the whole word is a number. Independent of the locale.
std::optional<double> parsed_number(std::string_view word);
std::optional<int> parsed_integer(std::string_view word);

}  // namespace fettle::core::files
