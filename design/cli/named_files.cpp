// SPDX-License-Identifier: MIT
#include "design/cli/named_files.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/files/atomic_file.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_same_file(const std::string& x, const std::string& y) {
    std::error_code code;
    for (const std::string& file : {x, y})
        if (fs::is_directory(file, code) || core::files::is_written_directly(file)) return false;
    if (fs::exists(x, code) || fs::exists(y, code)) return fs::equivalent(x, y, code);
    const auto whole = [&](const std::string& file) { return fs::weakly_canonical(fs::absolute(file, code), code); };
    return whole(x) == whole(y);
}

}  // namespace

std::vector<NamedFile> named_files_of(const std::string& command, const std::vector<GivenValue>& given) {
    std::vector<std::string> written{"--log",         "--junit", "--sarif", "--markdown", "--csv",
                                     "--certificate", "--out",   "--to",    "--draw",     "--report"};
    std::vector<std::string> read{"--baseline", "--trajectory", "--continue", "--source"};
    (command == "simulate" ? written : read).emplace_back("--poses");
    (command == "simulate" ? read : written).emplace_back("--samples-file");
    std::vector<NamedFile> files;
    for (const GivenValue& each : given) {
        const bool is_written = is_one_of(each.option, written);
        if (is_written || each.by_place || is_one_of(each.option, read)) files.push_back({each.option, each.value, is_written});
    }
    return files;
}

std::vector<NamedFile> named_files_in(const std::vector<std::string>& words, const std::vector<std::string>& written) {
    std::vector<NamedFile> files;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const std::size_t equals = words[k].find('=');
        const std::string option = words[k].substr(0, equals);
        if (!is_one_of(option, written)) {
            files.push_back({"another word", words[k], false});
        } else if (equals != std::string::npos) {
            files.push_back({option, words[k].substr(equals + 1), true});
        } else if (k + 1 < words.size()) {
            files.push_back({option, words[++k], true});
        }
    }
    return files;
}

Errors named_twice(const std::vector<NamedFile>& files) {
    Errors errors;
    for (const NamedFile& file : files) {
        for (const NamedFile& other : files) {
            const bool is_told = other.is_written && &other <= &file;  // of two that are written, once
            if (!file.is_written || is_told || !is_same_file(file.file, other.file)) continue;
            errors.push_back({ErrorCode::inconsistent, file.file,
                              file.option + " would " +
                                  (other.is_written ? "write what " + other.option + " writes too"
                                                    : "replace a file that is read (" + other.option + ")") +
                                  "; name another file"});
        }
    }
    return errors;
}

}  // namespace fettle::design::cli
