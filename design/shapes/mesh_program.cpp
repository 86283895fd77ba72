// SPDX-License-Identifier: MIT
#include "design/shapes/mesh_program.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "core/base/read_record.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/input_file.hpp"
#include "core/files/nearest_word.hpp"
#include "core/files/process.hpp"
#include "core/mesh_files/mesh_reader.hpp"

namespace fettle::design::shapes {

namespace {

namespace fs = std::filesystem;
using description::ShapeDimension;
using Clock = std::chrono::steady_clock;

std::string program_number(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// Calls replace(name) for each "{name}" of a word.
template <class Replace>
std::string filled(const std::string& word, const Replace& replace) {
    static const std::regex placeholder("\\{([A-Za-z_][A-Za-z0-9_]*)\\}");
    std::string result;
    auto begin = word.cbegin();
    for (std::sregex_iterator match(word.begin(), word.end(), placeholder), end; match != end; ++match) {
        result.append(begin, (*match)[0].first);
        result += replace((*match)[1].str());
        begin = (*match)[0].second;
    }
    return result.append(begin, word.cend());
}

// A folder of its own, gone at the end.
class Workplace {
public:
    Workplace() {
        std::string name = (fs::temp_directory_path() / "fettle_part_XXXXXX").string();
        if (::mkdtemp(name.data()) != nullptr) path_ = name;
    }
    ~Workplace() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

// Its exit code; none: it took too long.
std::optional<int> ended_within(core::files::Process& process, double time_limit) {
    const auto limit = Clock::now() + std::chrono::duration<double>(time_limit);
    auto pause = std::chrono::microseconds(500);
    while (true) {
        const std::optional<int> code = process.ended();
        if (code || Clock::now() > limit) return code;
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::microseconds(10'000));
    }
}

// The same mesh in one order: programs write the same triangles in another order each time.
core::geometry::Mesh in_order(const core::geometry::Mesh& mesh, const std::string& name) {
    std::vector<Eigen::Index> order(mesh.vertices.cols());
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    const auto place = [&](Eigen::Index i) { return std::array{mesh.vertices(0, i), mesh.vertices(1, i), mesh.vertices(2, i)}; };
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return place(a) < place(b); });
    Matrix3X vertices(3, mesh.vertices.cols());
    std::vector<int> renamed(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        vertices.col(k) = mesh.vertices.col(order[k]);
        renamed[order[k]] = static_cast<int>(k);
    }
    std::vector<core::geometry::Triangle> triangles = mesh.triangles;
    for (core::geometry::Triangle& t : triangles) {
        for (int& i : t) i = renamed[i];
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return core::geometry::make_mesh(name, std::move(vertices), std::move(triangles));
}

// Where the system finds a program of this name.
fs::path on_path(const std::string& name) {
    const char* const path = ::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (fs::path file = fs::path(folder) / name; ::access(file.c_str(), X_OK) == 0) return file;
    return {};
}

// The program itself, and files that its command names: "rod.scad", "--with=rod.scad". What these name in turn it alone knows.
void record_files(const MeshProgram& program) {
    const std::string& name = program.command.front();
    if (name.find('/') == std::string::npos) core::files::record_file(on_path(name));
    for (const std::string& word : program.command) {
        for (const std::string& file : std::set<std::string>{word, word.substr(word.find('=') + 1)}) {
            std::error_code ignored;
            const fs::path path = fs::path(program.directory) / file;
            if (fs::is_regular_file(path, ignored)) core::files::record_file(path);
        }
    }
}

// The last lines that a program said, in one.
std::string last_words(const fs::path& log) {
    const Result<std::string> text = core::files::read_file(log);
    if (!text || text->empty()) return "it said nothing";
    std::string tail = text->substr(text->size() > 400 ? text->size() - 400 : 0);
    for (char& c : tail)
        if (c == '\n' || c == '\r') c = ' ';
    return "it said: ..." + tail;
}

}  // namespace

Errors check_program(const MeshProgram& program, const std::vector<ShapeDimension>& dimensions) {
    Errors errors;
    if (program.command.empty()) return {{ErrorCode::missing_key, "program", "a program has a command: its name and its arguments"}};
    std::vector<std::string_view> known{"out"};
    for (const ShapeDimension& dimension : dimensions) known.push_back(dimension.name);
    std::vector<bool> named(known.size(), false);
    for (const std::string& word : program.command) {
        filled(word, [&](const std::string& name) {
            const auto found = std::find(known.begin(), known.end(), name);
            if (found != known.end()) {
                named[found - known.begin()] = true;
            } else {
                errors.push_back(
                    {ErrorCode::unknown_key, "program", "{" + name + "} is not a dimension; " + core::files::did_you_mean(name, known)});
            }
            return std::string();
        });
    }
    if (!named[0])
        errors.push_back({ErrorCode::missing_key, "program", "the command does not name {out}, the file that the mesh is to go to"});
    for (std::size_t k = 1; k < known.size(); ++k) {
        if (!named[k])
            errors.push_back({ErrorCode::missing_key, "program",
                              "the command does not name {" + std::string(known[k]) + "}, so this dimension changes nothing"});
    }
    if (dimensions.empty()) errors.push_back({ErrorCode::missing_key, "dimensions", "a part from a program has dimensions"});
    return errors;
}

Result<core::geometry::Mesh> run_program(const MeshProgram& program, const std::vector<ShapeDimension>& dimensions,
                                         const std::vector<double>& values) {
    const Workplace place;
    const core::base::ReadRecord apart(core::base::ReadRecord::Outer::apart);  // of what stands there
    const std::string& name = program.command.front();
    if (place.path().empty()) return Error{ErrorCode::file_unreadable, name, "no temporary folder can be made for what it writes"};
    const fs::path out = place.path() / ("part." + program.format), log = place.path() / "log.txt";
    std::vector<std::string> words;
    for (const std::string& word : program.command) {
        words.push_back(filled(word, [&](const std::string& placeholder) {
            for (std::size_t k = 0; k < dimensions.size(); ++k)
                if (dimensions[k].name == placeholder) return program_number(values[k] / program.unit);
            return out.string();
        }));
    }
    const core::files::Descriptor said(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    std::optional<core::files::Process> process;
    try {
        process.emplace(core::files::Launch{.words = words, .out = *said, .error = *said, .folder = program.directory});
    } catch (const std::system_error& error) {
        return Error{ErrorCode::file_not_found, name,
                     "this program could not be started (" + error.code().message() + "): is it installed, and on the PATH?"};
    }
    const std::optional<int> code = ended_within(*process, program.time_limit);
    process->kill();
    if (!code)
        return Error{ErrorCode::inconsistent, name,
                     "the program took longer than " + program_number(program.time_limit) + " s; " + last_words(log)};
    if (*code != 0 || !fs::exists(out)) {
        const std::string what = *code != 0 ? "ended with code " + std::to_string(*code) : "wrote no " + program.format + " file";
        return Error{ErrorCode::inconsistent, name, "the program " + what + "; " + last_words(log)};
    }
    Result<core::geometry::Mesh> mesh = core::mesh_files::read_mesh(out.string(), {program.unit, true});
    if (!mesh) {
        Errors errors = mesh.errors();
        for (Error& error : errors) error.where = name;
        return errors;
    }
    return in_order(*mesh, name);
}

ProgramPart::ProgramPart(const MeshProgram& program, std::vector<ShapeDimension> dimensions)
    : RebuiltShape(dimensions,
                   [program, dimensions](const std::vector<double>& values) { return run_program(program, dimensions, values); },
                   {.unit = program.unit}),
      program_(program) {}

Result<std::shared_ptr<const ProgramPart>> ProgramPart::create(const MeshProgram& program, std::vector<ShapeDimension> dimensions) {
    Errors errors = check_program(program, dimensions);
    if (!errors.empty()) return errors;
    record_files(program);
    return std::shared_ptr<const ProgramPart>(new ProgramPart(program, std::move(dimensions)));
}

}  // namespace fettle::design::shapes
