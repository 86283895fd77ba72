// SPDX-License-Identifier: MIT
#include "fettle/design/cli/answers.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "fettle/design/description/requirement_text.hpp"

namespace fettle::design::cli {

std::string relations_text(const description::Design& design, const optimisers::Rows& relations, const Console& console) {
    std::string text;
    for (Eigen::Index i = 0; i < relations.values.size(); ++i) {
        const description::Relation& relation = design.relations[static_cast<size_t>(i)];
        const description::Bounds& bounds = relation.bounds;
        const bool met = description::violation(relation, relations.values[i]) <= 0;
        text += formatted("  %-40s is %.9g, required %s: ", relation.name.c_str(), relations.values[i] / bounds.unit,
                          description::required_text(bounds, "").c_str()) +
                console.coloured(met ? "met" : "VIOLATED", met) + "\n";
    }
    return text;
}

long peak_memory_bytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss * 1024L;
}

std::string formatted(const char* format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, arguments);
    va_end(arguments);
    std::string text(static_cast<size_t>(std::max(0, length)) + 1, '\0');
    std::vsnprintf(text.data(), text.size(), format, again);
    va_end(again);
    text.pop_back();
    return text;
}

}  // namespace fettle::design::cli
