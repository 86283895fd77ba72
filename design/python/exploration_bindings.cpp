// SPDX-License-Identifier: MIT
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/stop.hpp"
#include "core/files/json_text.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/design_records.hpp"
#include "design/python/errors.hpp"
#include "design/python/watch.hpp"
#include "design/studies/exploration.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using Json = nlohmann::ordered_json;
using problem::DesignProblem;
using studies::ExplorationJob;

namespace {

using Sweep = std::map<std::string, std::variant<int, std::vector<double>>>;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::vector<ExplorationJob> jobs_of(const DesignProblem& problem, const Sweep& sweep, int samples, int starts, std::int64_t seed) {
    studies::ExplorationRequest request{{}, samples, starts, seed_from(seed)};
    for (const auto& [name, values] : sweep) {
        studies::SweptParameter swept{name, 0, {}, "sweep/" + name};
        if (const int* count = std::get_if<int>(&values)) {
            swept.count = *count;
        } else {
            const std::vector<double>& given = std::get<std::vector<double>>(values);
            swept.values = Eigen::Map<const VectorX>(given.data(), count_of(given));
        }
        request.sweep.push_back(std::move(swept));
    }
    return value_or_raise(studies::jobs_of(problem, request));
}

ExplorationJob job_from(const std::string& kind, const VectorX& point, std::int64_t seed) {
    if (kind != "evaluate" && kind != "optimise")
        refuse(ErrorCode::out_of_range, "kind", "'" + kind + "' is not allowed: evaluate and optimise are");
    return {kind == "evaluate" ? ExplorationJob::Kind::evaluate : ExplorationJob::Kind::optimise, point, seed_from(seed)};
}

std::string line_of(const DesignProblem& problem, const ExplorationJob& job) {
    Watch watch(py::none{});
    std::string line;
    {
        const py::gil_scoped_release unlocked;
        try {
            line = text_of(studies::result_of(problem, job, watch.should_stop()));
        } catch (const core::base::Stopped&) {  // the watch says why
        }
    }
    watch.end();
    return line;
}

/// The file, for as long as a `with` block lasts.
class ResultsFile {
public:
    ResultsFile(const Path& path, const DesignProblem& problem, const std::string& name, const std::string& design_file)
        : file_(value_or_raise(studies::ExplorationFile::open(path.string(), studies::header_of(problem.design(), name, design_file)))) {}

    Errors explore(const DesignProblem& problem, const std::vector<ExplorationJob>& jobs, const py::object& progress) {
        Watch watch(progress);
        studies::Explored end;
        {
            const py::gil_scoped_release unlocked;
            const auto tell = watch.on_result();
            studies::ExploreOptions options{watch.should_stop(), {}};
            options.on_result = [&](int done, int of, const Json& result) { tell(done, of, text_of(result)); };
            end = studies::explore(problem, jobs, open(), options);
        }
        watch.end();
        return end.unwritten;
    }
    Errors append(const std::string& line) {
        Json result = core::files::is_safe_json_text(line) ? Json::parse(line, nullptr, false) : Json();
        if (!result.is_object()) refuse(ErrorCode::parse, "a worker's result", "it is no JSON object");
        open().append(std::move(result));
        return open().unwritten();
    }
    std::string found() { return text_of({{"header", open().found().header}, {"results", open().found().results}}); }
    bool has(const std::string& key) { return open().has(key); }
    void close() { file_.reset(); }

private:
    studies::ExplorationFile& open() {
        if (!file_) throw std::runtime_error("the file of the exploration has been closed");
        return *file_;
    }

    std::optional<studies::ExplorationFile> file_;
};

std::string read_exploration(const Path& path) {
    const studies::Exploration found = value_or_raise(studies::read_exploration(path.string()));
    raise_if_any(found.damaged);
    return text_of({{"header", found.header}, {"results", found.results}});
}

}  // namespace

void bind_exploration(py::module_& module) {
    py::class_<ExplorationJob>(module, "_ExplorationJob", "One design to evaluate, or one run of the optimiser.")
        .def(py::init(&job_from), py::arg("kind"), py::arg("point"), py::arg("seed"))
        .def_property_readonly("key", &ExplorationJob::key)
        .def_property_readonly("kind", [](const ExplorationJob& self) { return studies::to_string(self.kind); })
        .def_readonly("seed", &ExplorationJob::seed)
        .def_readonly("point", &ExplorationJob::point)
        .def(py::pickle([](const ExplorationJob& self) { return py::make_tuple(studies::to_string(self.kind), self.point, self.seed); },
                        [](const py::tuple& state) {
                            return job_from(state[0].cast<std::string>(), state[1].cast<VectorX>(), state[2].cast<std::int64_t>());
                        }));
    py::class_<ResultsFile>(module, "_ExplorationFile", "Results of an exploration, a line each (exploration.py).")
        .def(py::init<const Path&, const DesignProblem&, const std::string&, const std::string&>(), py::arg("path"), py::arg("problem"),
             py::arg("name"), py::arg("design_file"))
        .def(
            "__enter__", [](ResultsFile& self) -> ResultsFile& { return self; }, py::return_value_policy::reference_internal)
        .def("__exit__", [](ResultsFile& self, const py::args&) { self.close(); })
        .def("explore", &ResultsFile::explore, py::arg("problem"), py::arg("jobs"), py::arg("progress"),
             "Runs what the file has no result of; progress(done, of, line). Returns why the file could not take a result.")
        .def("append", &ResultsFile::append, py::arg("line"), "Adds a line of result_of. Returns why the file could not take it.")
        .def("has", &ResultsFile::has, py::arg("key"))
        .def("found", &ResultsFile::found, "Header and results, as JSON.");
    module.def("_exploration_jobs", &jobs_of, py::arg("problem"), py::arg("sweep"), py::arg("samples"), py::arg("starts"), py::arg("seed"),
               "What explore() runs. sweep: {parameter: how many values between its bounds, or the values, SI}.");
    module.def("_result_of", &line_of, py::arg("problem"), py::arg("job"), "The result of a job, as a line of the file.");
    module.def(
        "_lost_result",
        [](const ExplorationJob& job) { return text_of(studies::lost_result(job, "two workers were lost on this design")); },
        py::arg("job"), "Of a job whose workers were lost.");
    module.def("_read_exploration", &read_exploration, py::arg("path"), "Header and results of a file of explore(), as JSON.");
}

}  // namespace fettle::design::python
