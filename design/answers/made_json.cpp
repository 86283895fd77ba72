// SPDX-License-Identifier: MIT
#include "design/answers/made_json.hpp"

#include <nlohmann/json.hpp>

#include "core/base/text.hpp"

namespace fettle::design::answers {

namespace {

using core::base::formatted;
using Json = nlohmann::ordered_json;
using studies::MadeMechanism;

double in_unit(const MadeMechanism& made, int k) {
    return made.deviations[k] / core::base::to_si(1, made.loaded.problem->design().parameters[made.tolerances[k].parameter].unit);
}

}  // namespace

Json made_json(const MadeMechanism& made, int sample) {
    Json json = {{"sample", sample}, {"seed", made.seed}, {"deviations", Json::array()}, {"kept", nullptr}};
    for (int k = 0; k < count_of(made.tolerances); ++k)
        json["deviations"].push_back({{"of", made.tolerances[k].of}, {"value", in_unit(made, k)}, {"unit", made.units[k]}});
    if (!made.kept) return json;
    json["kept"] = {{"reason", made.kept->failed() ? Json(made.kept->reason) : Json()}, {"responses", Json::array()}};
    for (int i = 0; i < count_of(made.numbers) && !made.kept->failed(); ++i)
        json["kept"]["responses"].push_back(
            {{"name", made.numbers[i].name}, {"value", made.kept->values[i]}, {"met", static_cast<bool>(made.kept->met[i])}});
    return json;
}

std::string made_text(const MadeMechanism& made, int sample) {
    std::string text = formatted("sample %d of seed %llu, as made:\n", sample, static_cast<unsigned long long>(made.seed));
    for (int k = 0; k < count_of(made.tolerances); ++k)
        text += "  " + made.tolerances[k].of + formatted(" %+.6g ", in_unit(made, k)) + made.units[k] + "\n";
    if (!made.kept) return text;
    if (made.kept->failed()) return text + "it failed: " + made.kept->reason + "\n";
    std::vector<std::string> missed;
    for (int i = 0; i < count_of(made.numbers); ++i)
        if (!made.kept->met[i]) missed.push_back(made.numbers[i].name);
    return text + (missed.empty() ? "it met every requirement\n" : "it missed: " + core::base::joined(missed) + "\n");
}

}  // namespace fettle::design::answers
