// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "design/answers/optimise_json.hpp"
#include "design/answers/run_folder.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/design_records.hpp"
#include "design/python/errors.hpp"
#include "design/python/studies_records.hpp"
#include "design/python/watch.hpp"
#include "design/report/report_folder.hpp"
#include "design/studies/optimise_file.hpp"
#include "design/studies/random_start.hpp"
#include "design/studies/starting_sides.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using problem::DesignProblem;
using studies::OptimiseOutcome;

namespace {

gradient_audit::CheckReport check_gradients(const DesignProblem& problem, const py::object& p, int most_parameters,
                                            const py::object& progress) {
    const auto& parameters = problem.design().parameters;
    const VectorX point = p.is_none() ? description::values_of(parameters) : point_from(parameters, p);
    raise_if_any(description::check_values(parameters, point));
    check_at_least("most_parameters", most_parameters, 0);
    Watch watch(progress);
    gradient_audit::CheckReport report;
    std::string reason;
    {
        const py::gil_scoped_release unlocked;
        gradient_audit::CheckOptions options;
        options.most_parameters = most_parameters;
        options.on_simulation = watch.on_count();
        options.should_stop = watch.should_stop();
        problem::EvaluateOptions evaluate;
        evaluate.should_stop = watch.should_stop();
        const problem::DesignEvaluation at = problem.evaluate(point, evaluate);
        if (at.usable) report = gradient_audit::check_gradients(problem, point, at, options);
        reason = at.reason;
    }
    watch.end();
    if (!reason.empty()) throw RaisedErrors({{ErrorCode::inconsistent, "design", reason}});
    return report;
}

// `run` is called without the lock.
template <class Run>
OptimiseOutcome optimise(studies::OptimiseOptions options, const py::object& progress, const Run& run) {
    Watch watch(progress);
    std::optional<OptimiseOutcome> outcome;
    {
        const py::gil_scoped_release unlocked;
        options.narrate = watch.on_line();
        options.should_stop = watch.should_stop();
        outcome = run(options);
    }
    watch.end();
    return std::move(*outcome);
}

OptimiseOutcome optimise_design(const DesignProblem& problem, const std::string& optimiser, std::int64_t seed, bool repair,
                                const py::object& progress) {
    studies::OptimiseOptions options;
    options.optimiser = optimiser;
    options.seed = seed_from(seed);
    options.repair = repair;
    return optimise(std::move(options), progress, [&](const studies::OptimiseOptions& all) {
        const DesignProblem begun = value_or_raise(studies::problem_of_seed(problem, all.seed));
        return value_or_raise(studies::optimise_design(begun, all));
    });
}

struct FileArguments {
    std::string directory;
    bool resume = false, report = true;
    reading::Programs programs = reading::Programs::refused;
    std::optional<int> max_evaluations;
    studies::OptimiseOptions options;
};

OptimiseOutcome optimise_file(reading::DesignFile file, FileArguments arguments, const py::object& progress) {
    raise_if_any(answers::others_files(arguments.directory, {"design.final.json"}));
    if (arguments.max_evaluations) file.design.optimiser.max_evaluations = *arguments.max_evaluations;
    const auto run = [&](const studies::OptimiseOptions& all) {
        const DesignProblem written = value_or_raise(DesignProblem::create(file.design));
        studies::FileOfSeed begun = value_or_raise(studies::file_of_seed(file, written, all.seed));
        file = std::move(begun.file);
        const DesignProblem& problem = begun.problem;
        const std::string command = "fettle.optimise_file, Python";
        nlohmann::ordered_json answer;
        studies::RunFolder folder{arguments.directory, arguments.resume};
        folder.add_files = [&](const OptimiseOutcome& outcome, core::files::FilesTogether& files) {
            answer = answers::outcome_json(problem, outcome, {arguments.directory, arguments.options.seed, false});
            return answers::add_outcome(files, arguments.directory, outcome.final, answer, command);
        };
        folder.measure_finer = reading::DesignReadOptions{{}, arguments.programs};
        studies::FileOutcome done = value_or_raise(studies::optimise_file(file, problem, folder, all));
        raise_if_any(done.unwritten);
        if (!arguments.report) return std::move(done.outcome);
        report::ReportOptions options;
        options.programs = arguments.programs;
        options.should_stop = all.should_stop;
        options.at_hand = report::at_hand(file, problem, done.outcome);
        options.at_hand.answer = answers::result_json(std::move(answer), command);
        value_or_raise(report::write_report(arguments.directory, std::move(options)));
        return std::move(done.outcome);
    };
    return optimise(arguments.options, progress, run);
}

}  // namespace

void bind_studies(py::module_& module) {
    module.def(
        "check_gradients", &check_gradients, py::arg("problem"), py::arg("p") = py::none(), py::arg("most_parameters") = 0,
        py::arg("progress") = py::none(),
        "The audit of a design's gradients by central differences, of the sweeps against one another, and of which contacts are about "
        "to change: a CheckReport. most_parameters: those alone that the objective's gradient is largest in; 0: all. "
        "progress(done, of).");
    module.def("optimise", &optimise_design, py::arg("problem"), py::arg("optimiser") = "", py::arg("seed") = 0, py::arg("repair") = false,
               py::arg("progress") = py::none(),
               "Optimises in memory: an OptimiseOutcome. seed 0 begins at the design's values, others at a random start. progress(line).");
    module.def(
        "optimise_file",
        [](const Path& path, const Path& out, bool resume, const std::string& optimiser, std::int64_t seed,
           const std::optional<int>& max_evaluations, bool allow_programs, bool report, const py::object& progress) {
            if (max_evaluations) check_at_least("max_evaluations", *max_evaluations, 1);
            const auto programs = allow_programs ? reading::Programs::allowed : reading::Programs::refused;
            FileArguments arguments{out.string(), resume, report, programs, max_evaluations, {}};
            arguments.options.optimiser = optimiser;
            arguments.options.seed = seed_from(seed);
            return optimise_file(value_or_raise(reading::read_design(path.string(), {{}, programs})), std::move(arguments), progress);
        },
        py::arg("path"), py::arg("out"), py::arg("resume") = false, py::arg("optimiser") = "", py::arg("seed") = 0,
        py::arg("max_evaluations") = py::none(), py::arg("allow_programs") = false, py::arg("report") = true,
        py::arg("progress") = py::none(),
        "Optimises a *.design.json into a folder, as `fettle optimise` does: history, final design, trajectory, motion.glb, result.json "
        "and report.html; resume goes on with what is there.");
    module.def(
        "start_of_seed",
        [](const DesignProblem& problem, std::int64_t given) {
            const std::uint64_t seed = seed_from(given);
            const py::gil_scoped_release unlocked;
            return studies::start_of_seed(value_or_raise(studies::problem_of_seed(problem, seed)), seed);
        },
        py::arg("problem"), py::arg("seed"),
        "(n) SI: where a run of that seed begins: a sample that meets the relations and can be made and assembled, if one is found.");
    module.def(
        "sample_of_seed",
        [](const DesignProblem& problem, std::int64_t seed) { return studies::sample_of_seed(problem.design(), seed_from(seed)); },
        py::arg("problem"), py::arg("seed"), "(n) SI: drawn from the parameters' bounds.");
    module.def(
        "seeds_of_list",
        [](std::int64_t list, int n) {
            check_at_least("n", n, 1);
            return studies::seeds_of_list(seed_from(list), n);
        },
        py::arg("list"), py::arg("n"), "The seeds of a list of n starts: 0, then 1000 list + 1, 1000 list + 2, ...");
}

}  // namespace fettle::design::python
