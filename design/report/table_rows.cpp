// SPDX-License-Identifier: MIT
#include "design/report/table_rows.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "core/base/text.hpp"

namespace fettle::design::report {

namespace {

// The fields of the line that begins at `at`, which is set behind it. Quoted fields may hold commas, doubled quotes and line feeds.
std::vector<std::string> next_line(std::string_view text, std::size_t& at) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        if (quoted) {
            if (c != '"') {
                fields.back() += c;
            } else if (at + 1 < text.size() && text[at + 1] == '"') {
                fields.back() += text[++at];
            } else {
                quoted = false;
            }
        } else if (c == '"') {
            quoted = true;
        } else if (c == ',') {
            fields.emplace_back();
        } else if (c == '\n') {
            ++at;
            return fields;
        } else if (c != '\r') {
            fields.back() += c;
        }
    }
    return fields;
}

const std::string no_word;

}  // namespace

TableRows::TableRows(std::string_view text) : text_(text) {
    std::size_t at = 0;
    header_ = next_line(text, at);
    while (at < text.size()) {
        const std::size_t begin = at;
        if (next_line(text, at).size() == header_.size()) rows_.push_back(begin);
    }
}

const std::vector<std::string>& TableRows::fields(std::size_t row) const {
    if (row == taken_) return fields_;
    std::size_t at = rows_[row];
    fields_ = next_line(text_, at);
    for (std::string& field : fields_) field = core::base::csv_word(field);
    taken_ = row;
    return fields_;
}

bool TableRows::has(std::string_view column) const { return std::find(header_.begin(), header_.end(), column) != header_.end(); }

const std::string& TableRows::word(std::size_t row, std::string_view column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    return found == header_.end() ? no_word : fields(row)[found - header_.begin()];
}

double TableRows::number(std::size_t row, std::string_view column) const {
    const std::string& text = word(row, column);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    return code == std::errc() && end == text.data() + text.size() && !text.empty() ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace fettle::design::report
