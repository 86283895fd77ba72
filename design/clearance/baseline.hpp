// SPDX-License-Identifier: MIT
/// An earlier report of `fettle clearance`, and what has become of its findings: pairs that are violated or undecided.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/clearance/pair_clearance.hpp"

namespace fettle::design::clearance {

/// A pair in an earlier report.
struct Before {
    std::string status;
    double lower = 0, upper = 0;  ///< [m]
};

/// What has become of a pair.
struct Change {
    std::optional<Before> before;  ///< as the earlier report has it
    std::string word;              ///< "new", "existing", "resolved"; empty: no change
};

class Baseline {
public:
    /// Reads a file that `fettle clearance --json` wrote. Errors: the file is no report.
    static Result<Baseline> read(const std::string& path);

    /// The change of a pair, named in either order, that is judged now; counts it.
    Change compare(const std::string& a, const std::string& b, core::clearance::PairStatus now);

    /// Once all pairs have been compared.
    std::string text() const;
    const std::string& file() const { return file_; }
    int new_ones() const { return new_; }
    int existing() const { return existing_; }
    int resolved() const { return resolved_; }
    std::vector<std::string> missing() const;  ///< findings whose pairs are not judged now

private:
    struct Row {
        std::string a, b;
        Before before;
        bool judged = false;  ///< now
    };
    std::string file_;
    std::vector<Row> rows_;
    std::map<std::string, std::size_t> by_pair_;
    int new_ = 0, existing_ = 0, resolved_ = 0;
};

}  // namespace fettle::design::clearance
