// SPDX-License-Identifier: MIT
#include <limits>
#include <nlohmann/json.hpp>

#include "fettle/design/answers/tolerance_json.hpp"
#include "fettle/design/python/arguments.hpp"
#include "fettle/design/python/bindings.hpp"
#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/watch.hpp"
#include "fettle/design/studies/tolerance_file.hpp"

namespace fettle::design::python {

namespace py = pybind11;

namespace {

// A row per sample; of one that failed NaN.
MatrixX values_of(const studies::ToleranceReport& report) {
    MatrixX out = MatrixX::Constant(count_of(report.samples), count_of(report.responses), std::numeric_limits<double>::quiet_NaN());
    for (int k = 0; k < count_of(report.samples); ++k)
        if (!report.samples[k].failed()) out.row(k) = report.samples[k].values.transpose();
    return out;
}

MatrixX deviations_of(const studies::ToleranceReport& report, int tolerances) {
    MatrixX out(count_of(report.samples), tolerances);
    for (int k = 0; k < count_of(report.samples); ++k) out.row(k) = report.samples[k].deviations.transpose();
    return out;
}

py::object tolerance(const Path& path, int samples, std::int64_t seed, bool second_order, bool worst_case, const std::string& samples_file,
                     const std::string& process, const std::vector<Path>& mesh_dirs, bool allow_programs, const py::object& progress) {
    check_at_least("samples", samples, 0);
    reading::DesignReadOptions read{texts_of(mesh_dirs), allow_programs ? reading::Programs::allowed : reading::Programs::refused};
    read.as_made = true;
    read.process = process;
    studies::ToleranceOptions options;
    options.samples = samples;
    options.seed = seed_from(seed);
    options.second_order = second_order;
    options.worst_case = worst_case;
    const reading::DesignFile file = value_or_raise(reading::read_design(path.string(), read));
    Watch watch(progress);
    Result<studies::ToleranceReport> report = [&] {
        const py::gil_scoped_release unlocked;
        options.on_simulation = watch.on_count();
        options.should_stop = watch.should_stop();
        return studies::study_tolerances(file, samples_file, options);
    }();
    watch.end();
    const studies::ToleranceReport found = value_or_raise(std::move(report));
    return py::module_::import("fettle.results")
        .attr("ToleranceReport")(answers::tolerance_json(file, found).dump(), deviations_of(found, count_of(file.tolerances)),
                                 values_of(found));
}

}  // namespace

void bind_tolerances(py::module_& module) {
    module.def("tolerance", &tolerance, py::arg("path"), py::arg("samples") = 0, py::arg("seed") = 1, py::arg("second_order") = true,
               py::arg("worst_case") = false, py::arg("samples_file") = "", py::arg("process") = "",
               py::arg("mesh_dirs") = std::vector<Path>(), py::arg("allow_programs") = false, py::arg("progress") = py::none(),
               "What becomes of a *.design.json with `tolerances` when its parts are made, as `fettle tolerance` answers: a "
               "ToleranceReport. samples_file: samples that it has are not simulated again. process: what makes the parts, in place of the "
               "design's. progress(done, of).");
}

}  // namespace fettle::design::python
