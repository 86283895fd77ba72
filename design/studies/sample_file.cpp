// SPDX-License-Identifier: MIT
#include "design/studies/sample_file.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_text.hpp"

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

struct FoundSamples {
    KeptSamples samples;
    std::size_t good = 0;  // lines that are whole
};

// @param seed_counts  must it be the header's?
Result<FoundSamples> found_in(const std::vector<std::string>& lines, const std::string& path, SampleFileHeader header, bool seed_counts) {
    const Json found = core::files::is_safe_json_text(lines.front()) ? Json::parse(lines.front(), nullptr, false) : Json();
    if (found.is_discarded() || !found.is_object() || !found.contains("fettle_samples"))
        return Error{ErrorCode::parse, path + ": line 1", "this is not a file of samples of fettle; name another file"};
    if (!seed_counts && found.contains("seed") && found["seed"].is_number_unsigned()) header.seed = found["seed"].get<std::uint64_t>();
    if (found != header_json(header))
        return Error{ErrorCode::inconsistent, path,
                     seed_counts
                         ? "these are samples of another design, version, seed, or of other tolerances; name another file, or delete "
                           "this one"
                         : "these are samples of another design, version, or of other tolerances (is a --process missing?)"};
    FoundSamples out;
    out.samples.seed = header.seed;
    for (out.good = 1; out.good < lines.size(); ++out.good) {
        try {
            out.samples.outcomes.insert(parsed_sample(lines[out.good], header));
        } catch (const std::exception& e) {
            if (out.good + 1 == lines.size()) break;  // a machine that lost power
            return Error{ErrorCode::parse, path + ": line " + std::to_string(out.good + 1),
                         std::string("damaged: ") + e.what() + "; take the line out, or name another file"};
        }
    }
    return out;
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

Result<KeptSamples> read_samples(const std::string& path, const SampleFileHeader& header) {
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    std::vector<std::string> lines;
    std::istringstream stream(text->substr(0, text->rfind('\n') + 1));
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    if (lines.empty()) return Error{ErrorCode::parse, path, "there are no samples in it"};
    Result<FoundSamples> found = found_in(lines, path, header, false);
    if (!found) return found.errors();
    return std::move(found->samples);
}

Errors SampleFile::read_found(const std::string& path) {
    const std::vector<std::string>& lines = file_.found();
    if (lines.empty()) {
        Errors errors = file_.keep(0);
        if (!errors.empty()) return errors;
        file_.append(core::files::dumped(header_json(header_)));
        return unwritten();
    }
    Result<FoundSamples> found = found_in(lines, path, header_, true);
    if (!found) return found.errors();
    known_ = std::move(found->samples.outcomes);
    return file_.keep(found->good);
}

const SampleOutcome* SampleFile::find(int sample) const {
    const auto found = known_.find(sample);
    return found == known_.end() ? nullptr : &found->second;
}

std::string header_line(const SampleFileHeader& header) { return core::files::dumped(header_json(header)); }

std::string sample_line(int sample, const SampleOutcome& outcome) {
    Json json = {{"sample", sample}};
    if (outcome.failed()) {
        json["reason"] = outcome.reason;
    } else {
        json["values"] = std::vector<double>(outcome.values.begin(), outcome.values.end());
        json["met"] = outcome.met;
    }
    return core::files::dumped(json);
}

void SampleFile::append(int sample, const SampleOutcome& outcome) { file_.append(sample_line(sample, outcome)); }

Errors SampleFile::append_line(const std::string& line) {
    try {
        const auto [number, outcome] = parsed_sample(line, header_);
        append(number, outcome);
    } catch (const std::exception& e) {
        return {{ErrorCode::parse, "a worker's sample", e.what()}};
    }
    return {};
}

}  // namespace fettle::design::studies
