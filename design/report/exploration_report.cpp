// SPDX-License-Identifier: MIT
#include "design/report/exploration_report.hpp"

#include <filesystem>

#include "core/files/atomic_file.hpp"
#include "design/answers/run_folder.hpp"
#include "design/reading/design_reader.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/exploration_data.hpp"
#include "design/report/report_page.hpp"
#include "design/studies/exploration_file.hpp"

namespace fettle::design::report {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Errors read_lines(const std::string& file, ExplorationSource& source) {
    Result<studies::Exploration> found = studies::read_exploration(file);
    if (!found) return found.errors();
    source.header = std::move(found->header);
    source.results = std::move(found->results);
    if (!found->damaged.empty())
        source.notices.push_back("Lines of the file that are no results were left out: " + std::to_string(found->damaged.size()) + ".");
    if (found->cut_off) source.notices.emplace_back(cut_off);
    if (source.results.empty())
        return {{ErrorCode::missing_key, file,
                 "an exploration without a result: there is nothing to report yet; `fettle explore` with the same --out goes on with it"}};
    return {};
}

bool has_parameters(const description::Design& design, const Json& names) {
    if (!names.is_array() || names.size() != design.parameters.size()) return false;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (names[k] != design.parameters[k].name) return false;
    return true;
}

void take_design(const std::string& file, const ReportOptions& options, ExplorationSource& source) {
    const std::string without = "; numbers are in SI units, and no parts are shown.";
    const Json path = member(source.header, "file");
    if (!path.is_string()) {
        source.notices.push_back("The file does not say which design was explored" + without);
        return;
    }
    const std::string whole = (fs::path(file).parent_path() / path.get<std::string>()).lexically_normal().string();
    Result<reading::DesignFile> read = reading::read_design(whole, {options.mesh_dirs, options.programs});
    if (!read) {
        source.notices.push_back("The design could not be read (" + read.errors().front().where + ": " + read.errors().front().message +
                                 ")" + without);
        return;
    }
    if (!has_parameters(read->design, member(source.header, "parameters"))) {
        source.notices.push_back(whole + " has other parameters than the design that was explored" + without);
        return;
    }
    source.description = description_of(read->text);
    source.design_path = whole;
    source.design = std::move(read->design);
}

}  // namespace

Result<std::string> write_exploration_report(const std::string& file, const ReportOptions& options) {
    const std::string out = options.out.empty() ? fs::path(file).replace_extension(".report.html").string() : options.out;
    if (options.out.empty())
        if (Errors errors = answers::others_file(out); !errors.empty()) return errors;
    ExplorationSource source;
    if (Errors errors = read_lines(file, source); !errors.empty()) return errors;
    source.folder = file;
    source.name = fs::path(file).stem().string();
    if (options.tell)
        for (const std::string& notice : source.notices) options.tell(notice);
    take_design(file, options, source);
    const std::string page = page_of(exploration_data(source, options.should_stop));
    if (Errors errors = core::files::write_file_atomically(out, page); !errors.empty()) return errors;
    return out;
}

}  // namespace fettle::design::report
