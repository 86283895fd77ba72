// SPDX-License-Identifier: MIT
#include "design/studies/made_sample.hpp"

#include <utility>

#include "design/description/independent_inputs.hpp"
#include "design/reading/design_text.hpp"
#include "design/studies/tolerance_file.hpp"

namespace fettle::design::studies {

Result<MadeMechanism> load_made(const std::string& path, reading::InputOptions options, const MadePick& pick) {
    const std::string scenario = std::exchange(options.scenario, {});
    if (reading::file_kind(path) == reading::FileKind::scene)
        return Error{ErrorCode::unsupported, path, "--made is about the samples of a design's tolerances, and this is a scene"};
    options.as_made = true;
    options.process = pick.process;
    Result<reading::DesignFile> file = reading::open_design(path, options);
    if (!file) return file.errors();
    if (file->tolerances.empty()) return no_tolerances(*file);
    MadeMechanism out;
    out.seed = pick.seed;
    out.tolerances = file->tolerances;
    for (const description::Tolerance& tolerance : out.tolerances)
        out.units.emplace_back(file->design.parameters[tolerance.parameter].unit.name);
    out.numbers = asked_numbers(file->design);
    if (!pick.samples_file.empty()) {
        Result<KeptSamples> kept = read_samples(pick.samples_file, samples_header(*file, file->design, pick.seed));
        if (!kept) return kept.errors();
        out.seed = kept->seed;
        const auto found = kept->outcomes.find(pick.sample);
        if (found == kept->outcomes.end())
            return Error{ErrorCode::out_of_range, pick.samples_file,
                         "it has no sample " + std::to_string(pick.sample) + ", of the " + std::to_string(kept->outcomes.size()) +
                             " that are in it"};
        out.kept = found->second;
    }
    out.deviations = description::DeviationSamples(out.tolerances, out.seed).at(pick.sample);
    const VectorX values = description::with_deviations(file->design, out.tolerances, out.deviations);
    Result<reading::LoadedModel> loaded = reading::loaded_design(std::move(file).value(), values, scenario);
    if (!loaded) {
        Errors errors = loaded.errors();
        for (Error& error : errors) error.message = "sample " + std::to_string(pick.sample) + " cannot be made: " + error.message;
        return errors;
    }
    out.loaded = std::move(loaded).value();
    return out;
}

}  // namespace fettle::design::studies
