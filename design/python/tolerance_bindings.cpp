// SPDX-License-Identifier: MIT
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/files/json_dump.hpp"
#include "design/answers/tolerance_json.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/watch.hpp"
#include "design/studies/sample_maker.hpp"
#include "design/studies/tolerance_file.hpp"

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

reading::DesignFile design_as_made(const Path& path, const std::string& process, const std::vector<Path>& mesh_dirs, bool allow_programs) {
    reading::DesignReadOptions read{texts_of(mesh_dirs), allow_programs ? reading::Programs::allowed : reading::Programs::refused};
    read.as_made = true;
    read.process = process;
    return value_or_raise(reading::read_design(path.string(), read));
}

// Samples that other processes make, and where they are kept.
struct SharedSamples {
    SharedSamples(const Path& path, std::int64_t seed, const std::string& process, const std::vector<Path>& mesh_dirs, bool allow_programs)
        : maker(value_or_raise(studies::SampleMaker::create(design_as_made(path, process, mesh_dirs, allow_programs), seed_from(seed)))) {}

    std::string line_of(int sample) const {
        Watch watch(py::none{});
        const std::string line = [&] {
            const py::gil_scoped_release unlocked;
            return maker.line_of(sample, watch.should_stop());
        }();
        watch.end();
        return line;
    }
    std::vector<int> open(const std::string& samples_file, int samples) {
        check_at_least("samples", samples, 0);
        file.emplace(value_or_raise(studies::SampleFile::open(samples_file, maker.header())));
        std::vector<int> missing;
        for (int k = 0; k < samples; ++k)
            if (file->find(k) == nullptr) missing.push_back(k);
        return missing;
    }
    void keep(const std::string& line) {
        raise_if_any(file->append_line(line));
        raise_if_any(file->unwritten());
    }

    const studies::SampleMaker maker;
    std::optional<studies::SampleFile> file;
};

py::object tolerance(const Path& path, int samples, std::int64_t seed, bool second_order, bool worst_case, const std::string& samples_file,
                     const std::string& process, const std::vector<Path>& mesh_dirs, bool allow_programs, const py::object& progress) {
    check_at_least("samples", samples, 0);
    studies::ToleranceOptions options;
    options.samples = samples;
    options.seed = seed_from(seed);
    options.second_order = second_order;
    options.worst_case = worst_case;
    const reading::DesignFile file = design_as_made(path, process, mesh_dirs, allow_programs);
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
        .attr("ToleranceReport")(core::files::dumped(answers::tolerance_json(file, found)), deviations_of(found, count_of(file.tolerances)),
                                 values_of(found));
}

}  // namespace

void bind_tolerances(py::module_& module) {
    py::class_<SharedSamples>(module, "SharedSamples", "Samples of `tolerance`, made one by one in several processes (tolerances.py).")
        .def(py::init<const Path&, std::int64_t, const std::string&, const std::vector<Path>&, bool>(), py::arg("path"), py::arg("seed"),
             py::arg("process"), py::arg("mesh_dirs"), py::arg("allow_programs"))
        .def_property_readonly(
            "name", [](const SharedSamples& self) { return studies::header_line(self.maker.header()); },
            "The same for the same samples of the same design.")
        .def_property_readonly("tolerance_count", [](const SharedSamples& self) { return self.maker.header().tolerances.size(); })
        .def("line_of", &SharedSamples::line_of, py::arg("sample"), "Simulates sample k.")
        .def("open", &SharedSamples::open, py::arg("samples_file"), py::arg("samples"), "Those of the first that the file has not.")
        .def("keep", &SharedSamples::keep, py::arg("line"), "Adds what line_of gave.")
        .def("close", [](SharedSamples& self) { self.file.reset(); });
    module.def("tolerance", &tolerance, py::arg("path"), py::arg("samples") = 0, py::arg("seed") = 1, py::arg("second_order") = true,
               py::arg("worst_case") = false, py::arg("samples_file") = "", py::arg("process") = "",
               py::arg("mesh_dirs") = std::vector<Path>(), py::arg("allow_programs") = false, py::arg("progress") = py::none(),
               "What becomes of a *.design.json with `tolerances` when its parts are made, as `fettle tolerance` answers: a "
               "ToleranceReport. samples_file: samples that it has are not simulated again. process: what makes the parts, in place of the "
               "design's. progress(done, of).");
}

}  // namespace fettle::design::python
