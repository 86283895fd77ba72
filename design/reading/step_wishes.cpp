// SPDX-License-Identifier: MIT
#include "design/reading/step_wishes.hpp"

#include <tuple>

#include "core/base/units.hpp"

namespace fettle::design::reading {

Errors take_step_wishes(const StepWishes& wishes, core::mesh_files::MeshReadOptions& options) {
    Errors errors;
    for (const auto& [option, text, value] : {std::tuple{"--facets", &wishes.facets, &options.chord},
                                              {"--surface-tolerance", &wishes.surface_tolerance, &options.surface_tolerance}}) {
        if (text->empty()) continue;
        const Result<double> length = core::base::parse_length(*text, option);
        errors.insert(errors.end(), length.errors().begin(), length.errors().end());
        if (length && !(*length > 0)) errors.push_back({ErrorCode::out_of_range, option, "a length above 0 is expected, as in 5um"});
        if (length) *value = *length;
    }
    return errors;
}

}  // namespace fettle::design::reading
