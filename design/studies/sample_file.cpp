// SPDX-License-Identifier: MIT
#include "fettle/design/studies/sample_file.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/json_text.hpp"

namespace fettle::design::studies {

namespace {

using Json = nlohmann::ordered_json;

Json header_json(const SampleFileHeader& header) {
    Json tolerances = Json::array();
    for (const description::Tolerance& tolerance : header.tolerances) {
        const tolerances::Distribution& d = tolerance.deviation;
        tolerances.push_back({{"of", tolerance.of},
                              {"distribution", to_string(d.kind)},
                              {"lower", d.lower},
                              {"upper", d.upper},
                              {"sigma_level", d.sigma_level},
                              {"shift", d.shift},
                              {"group", tolerance.group},
                              {"correlation", tolerance.correlation}});
    }
    return {{"fettle_samples", 1}, {"design", header.design_hash}, {"program", core::base::version()},
            {"seed", header.seed}, {"tolerances", tolerances},     {"responses", header.responses}};
}

std::pair<int, SampleOutcome> parsed_sample(const std::string& line, const SampleFileHeader& header) {
    if (!core::files::is_safe_json_text(line)) throw std::runtime_error("is not JSON of a sample");
    const Json json = Json::parse(line);
    const int number = json.at("sample").get<int>();
    if (number < 0) throw std::runtime_error("samples count from 0");
    SampleOutcome out;
    if (json.contains("reason")) {
        out.reason = json.at("reason").get<std::string>();
        return {number, out};
    }
    const auto values = json.at("values").get<std::vector<double>>();
    out.met = json.at("met").get<std::vector<bool>>();
    if (values.size() != header.responses.size() || out.met.size() != values.size())
        throw std::runtime_error("sizes do not match the header");
    out.values = Eigen::Map<const VectorX>(values.data(), count_of(values));
    return {number, out};
}

}  // namespace

Result<SampleFile> SampleFile::open(const std::string& path, const SampleFileHeader& header) {
    Result<LineFile> file = LineFile::open(path, LineFileMode::resume, "file of samples");
    if (!file) return file.errors();
    SampleFile out(std::move(file).value(), header);
    Errors errors = out.read_found(path);
    if (!errors.empty()) return errors;
    return out;
}

Errors SampleFile::read_found(const std::string& path) {
    const std::vector<std::string>& lines = file_.found();
    if (lines.empty()) {
        Errors errors = file_.keep(0);
        if (!errors.empty()) return errors;
        file_.append(header_json(header_).dump());
        return unwritten();
    }
    const Json found = core::files::is_safe_json_text(lines.front()) ? Json::parse(lines.front(), nullptr, false) : Json();
    if (found.is_discarded() || !found.is_object() || !found.contains("fettle_samples"))
        return {{ErrorCode::parse, path + ": line 1", "this is not a file of samples of fettle; name another file"}};
    if (found != header_json(header_))
        return {{ErrorCode::inconsistent, path,
                 "these are samples of another design, version, seed, or of other tolerances; name another file, or delete this one"}};
    std::size_t good = 1;
    for (; good < lines.size(); ++good) {
        try {
            known_.insert(parsed_sample(lines[good], header_));
        } catch (const std::exception& e) {
            if (good + 1 == lines.size()) break;  // a machine that lost power
            return {{ErrorCode::parse, path + ": line " + std::to_string(good + 1),
                     std::string("damaged: ") + e.what() + "; take the line out, or name another file"}};
        }
    }
    return file_.keep(good);
}

const SampleOutcome* SampleFile::find(int sample) const {
    const auto found = known_.find(sample);
    return found == known_.end() ? nullptr : &found->second;
}

void SampleFile::append(int sample, const SampleOutcome& outcome) {
    Json json = {{"sample", sample}};
    if (outcome.failed()) {
        json["reason"] = outcome.reason;
    } else {
        json["values"] = std::vector<double>(outcome.values.begin(), outcome.values.end());
        json["met"] = outcome.met;
    }
    file_.append(json.dump());
}

}  // namespace fettle::design::studies
