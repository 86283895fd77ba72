// SPDX-License-Identifier: MIT
/// Reads the CSV tables that the program writes (core/records/step_tables.hpp): a header, then rows; words may be quoted.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fettle::design::report {

class TableRows {
public:
    /// Rows that have not as many fields as the header (a file that was cut off) are left out. Contract: the text outlives this.
    explicit TableRows(std::string_view text);

    std::size_t size() const { return rows_.size(); }
    /// Is there a column of this name?
    bool has(std::string_view column) const;
    /// Empty where there is no such column. Valid until another row is asked for: of a long table one is taken apart at a time.
    const std::string& word(std::size_t row, std::string_view column) const;
    /// NaN where there is none.
    double number(std::size_t row, std::string_view column) const;

private:
    const std::vector<std::string>& fields(std::size_t row) const;

    std::string_view text_;
    std::vector<std::string> header_;
    std::vector<std::size_t> rows_;  ///< where each begins
    mutable std::size_t taken_ = static_cast<std::size_t>(-1);
    mutable std::vector<std::string> fields_;  ///< of the row that was taken apart last
};

}  // namespace fettle::design::report
