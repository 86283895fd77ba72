// SPDX-License-Identifier: MIT
#include "design/cli/answers.hpp"

#include <sys/resource.h>

#include "design/description/requirement_text.hpp"

namespace fettle::design::cli {

std::string relations_text(const description::Design& design, const optimisers::Rows& relations, const Console& console) {
    std::string text;
    for (Eigen::Index i = 0; i < relations.values.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        const description::Bounds& bounds = relation.bounds;
        const std::string unit = description::unit_name(relation);
        const bool met = description::violation(relation, relations.values[i]) <= 0;
        text += formatted("  %-40s is %s, required %s: ", relation.name.c_str(),
                          description::amount_text(relations.values[i], bounds.unit, unit, 9).c_str(),
                          description::required_text(bounds, unit).c_str()) +
                console.coloured(met ? "met" : "VIOLATED", met) + "\n";
    }
    return text;
}

long peak_memory_bytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss * 1024L;
}

}  // namespace fettle::design::cli
