// SPDX-License-Identifier: MIT
#include "core/model/ignored_pairs.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/base/text.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::core::model {
namespace {

using base::Error;
using base::ErrorCode;

class IgnoredPairs {
public:
    explicit IgnoredPairs(const scene::Scene& scene) : scene_(scene) {
        for (const scene::Body& body : scene.bodies) names_.push_back(body.name);
    }

    base::Result<std::vector<std::pair<int, int>>> read() {
        for (std::size_t i = 0; i < scene_.ignore.size(); ++i) add(scene_.ignore[i], i);
        if (!errors_.empty()) return errors_;
        std::sort(pairs_.begin(), pairs_.end());
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
        return std::move(pairs_);
    }

private:
    std::vector<int> matching(std::string_view pattern) const {
        std::vector<int> found;
        for (int i = 0; i < count_of(names_); ++i)
            if (base::matches_pattern(pattern, names_[i])) found.push_back(i);
        return found;
    }

    // Names may hold colons: each one may be that between the two.
    void add(std::string_view entry, std::size_t place) {
        const std::size_t before = pairs_.size();
        for (std::size_t at = entry.find(':'); at != std::string_view::npos; at = entry.find(':', at + 1))
            for (const int a : matching(entry.substr(0, at)))
                for (const int b : matching(entry.substr(at + 1)))
                    if (a != b) pairs_.emplace_back(std::minmax(a, b));
        if (pairs_.size() > before) return;
        const std::string where = scene_.path + "#/ignore/" + std::to_string(place);
        const std::size_t colon = entry.find(':');
        std::string message = "\"" + std::string(entry) + "\" is not a pair of bodies; write \"A:B\" with their names";
        for (const std::string_view name : {entry.substr(0, colon), colon == std::string_view::npos ? "" : entry.substr(colon + 1)}) {
            if (colon == std::string_view::npos || !matching(name).empty()) continue;
            const bool is_pattern = name.find('*') != std::string_view::npos;
            message = (is_pattern ? "no body's name matches \"" : "there is no body \"") + std::string(name) + "\"; " +
                      files::did_you_mean(is_pattern ? "" : name, names_);
            break;
        }
        errors_.push_back({ErrorCode::out_of_range, where, message});
    }

    const scene::Scene& scene_;
    std::vector<std::string_view> names_;
    std::vector<std::pair<int, int>> pairs_;
    base::Errors errors_;
};

}  // namespace

base::Result<std::vector<std::pair<int, int>>> ignored_pairs(const scene::Scene& scene) { return IgnoredPairs(scene).read(); }

}  // namespace fettle::core::model
