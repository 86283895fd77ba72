// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>

#include "core/clearance/clearance.hpp"
#include "core/files/atomic_file.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "design/exports/export_files.hpp"
#include "design/exports/picture.hpp"
#include "design/exports/png_writer.hpp"
#include "design/exports/projection_view.hpp"
#include "design/exports/svg_writer.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/report/report_data.hpp"
#include "design/report/report_folder.hpp"
#include "design/report/report_page.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::model::Model;
using core::stepper::Trajectory;

namespace {

// None: the parts as they are at the start.
exports::Assembly assembly_of(const Model& model, const Trajectory* trajectory) {
    if (trajectory == nullptr) return exports::assembly_of(model, core::stepper::follow_scripts(model, 0));
    check_same_bodies(*trajectory, model);
    return exports::assembly_of(model, *trajectory);
}

// Number of `name` in `names`.
int index_of(const std::vector<std::string>& names, const std::string& name, const char* where) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    std::string known;
    for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
    throw RaisedErrors({{ErrorCode::out_of_range, where, "`" + name + "` is none of " + known}});
}

struct ExportArguments {
    std::string folder, format, stem, arrangement;
    int every = 1;
    bool in_place = false;
};

std::vector<std::string> export_files(const Model& model, const Trajectory* trajectory, const ExportArguments& arguments) {
    check_at_least("every", arguments.every, 1);
    const auto format = static_cast<exports::Format>(index_of(exports::format_names(), arguments.format, "format"));
    exports::ExportOptions options;
    options.arrangement = static_cast<exports::Arrangement>(index_of(exports::arrangement_names(), arguments.arrangement, "arrangement"));
    options.every = arguments.every;
    options.in_place = arguments.in_place;
    if (options.in_place && options.arrangement != exports::Arrangement::parts)
        refuse(ErrorCode::inconsistent, "in_place", "it is of the arrangement `parts`: a file for each part");
    const exports::Assembly assembly = assembly_of(model, trajectory);
    std::vector<std::string> files;
    const exports::FileSink sink = [&](const std::string& name, const std::string& bytes) {
        files.push_back((std::filesystem::path(arguments.folder) / name).string());
        return core::files::write_file_atomically(files.back(), bytes);
    };
    raise_if_any(exports::export_files(assembly, format, options, arguments.stem, sink));
    return files;
}

struct PictureArguments {
    int t = 0;
    std::string view = "iso", title;
    std::pair<int, int> size{1200, 900};
    bool svg = false;
};

std::string picture(const Model& model, const Trajectory* trajectory, const PictureArguments& arguments) {
    const exports::Assembly assembly = assembly_of(model, trajectory);
    const int count = trajectory == nullptr ? 1 : count_of(trajectory->poses);
    const int t = arguments.t < 0 ? arguments.t + count : arguments.t;
    if (t < 0 || t >= count)
        throw py::index_error("there is no instant " + std::to_string(arguments.t) + "; there are " + std::to_string(count) +
                              ", counted from 0");
    const auto [width, height] = arguments.size;
    if (std::min(width, height) < 16 || std::max(width, height) > 16384)
        refuse(
            ErrorCode::out_of_range, "size",
            std::to_string(width) + " x " + std::to_string(height) + " is not allowed: a picture is from 16 to 16384 pixels wide and high");
    exports::PictureOptions options;
    options.view = value_or_raise(exports::projection_view(arguments.view, assembly.up, "view"));
    options.width = width;
    options.height = height;
    options.title = arguments.title;
    const auto& poses = trajectory == nullptr ? assembly.keyframes.front().poses : trajectory->poses[t];
    const exports::Picture drawn = exports::draw_picture(assembly, poses, options);
    return arguments.svg ? exports::svg_text(drawn) : exports::png_bytes(drawn);
}

py::bytes draw(const Model& model, const Trajectory* trajectory, const PictureArguments& arguments) {
    std::string bytes;
    {
        const py::gil_scoped_release unlocked;
        bytes = picture(model, trajectory, arguments);
    }
    return bytes;
}

std::string view_page(const Model& model, const Trajectory* trajectory, const std::string& title) {
    const Trajectory path = trajectory == nullptr ? core::clearance::as_assembled(model) : *trajectory;
    check_same_bodies(path, model);
    const py::gil_scoped_release unlocked;
    report::ReportSource source;
    source.kind = report::ReportKind::clearance;  // of which nothing was judged: no distance is certified for a look
    source.name = title;
    source.gravity = model.gravity;
    source.result = {{"status", "shown"},
                     {"message", "As they were given; no distance was judged here: certify_clearance proves distances."},
                     {"motion", !path.steps.empty()},
                     {"pairs", nlohmann::ordered_json::array()}};
    source.motion = report::Motion{model, path};
    return report::page_of(report::report_data(source, [] { return true; }));
}

}  // namespace

void bind_exports(py::module_& module) {
    module.def(
        "export_files",
        [](const Path& folder, const std::string& format, const Model& model, const Trajectory* trajectory, const std::string& stem,
           const std::string& arrangement, int every, bool in_place) {
            const py::gil_scoped_release unlocked;
            return export_files(model, trajectory, {folder.string(), format, stem, arrangement, every, in_place});
        },
        py::arg("folder"), py::arg("format"), py::arg("model"), py::arg("trajectory") = py::none(), py::arg("stem") = "parts",
        py::arg("arrangement") = "assembled", py::arg("every") = 1, py::arg("in_place") = false,
        "Parts for other programs, and with glb and vtu their motion: the paths of the files. format: glb, 3mf, stl, obj, vtu. arrangement "
        "(3mf, stl, obj): assembled; plate, for a printer's bed; parts, a file for each, with in_place where it stands at the start. "
        "every: for vtu, a frame for every so many steps.");
    module.def(
        "draw_picture",
        [](const Model& model, const Trajectory* trajectory, int t, const std::string& view, std::pair<int, int> size,
           const std::string& title, bool svg) {
            return draw(model, trajectory, {t, view, title, size, svg});
        },
        py::arg("model"), py::arg("trajectory") = py::none(), py::arg("t") = 0, py::arg("view") = "iso",
        py::arg("size") = std::pair<int, int>{1200, 900}, py::arg("title") = "", py::arg("svg") = false,
        "bytes of a PNG, or of an SVG, of the parts at one instant. view: iso, front, back, left, right, top, bottom, or "
        "\"azimuth,elevation\" in degrees; size: width and height in pixels.");
    module.def(
        "write_report",
        [](const Path& folder, const Path& out, bool allow_programs) {
            const py::gil_scoped_release unlocked;
            report::ReportOptions options;
            options.out = out.string();
            if (allow_programs) options.programs = reading::Programs::allowed;
            return value_or_raise(report::write_report(folder.string(), std::move(options)));
        },
        py::arg("folder"), py::arg("out") = "", py::arg("allow_programs") = false,
        "Makes FOLDER/report.html of what optimise_file, or a command with --out, left there; its path.");
    module.attr("Model").attr("_repr_png_") = py::cpp_function(
        [](const Model& model) {
            return draw(model, nullptr, {0, "iso", "", {800, 600}, false});
        },
        py::is_method(module.attr("Model")), "How it is shown where there is no HTML: the parts at the start.");
    module.def("view_page", &view_page, py::arg("model"), py::arg("trajectory") = py::none(), py::arg("title") = "",
               "The report's page of these parts and their motion, as HTML that needs nothing else; fettle.view shows it in a notebook.");
}

}  // namespace fettle::design::python
