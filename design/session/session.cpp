// SPDX-License-Identifier: MIT
#include "design/session/session.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <utility>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "design/reading/design_text.hpp"
#include "design/session/least_change.hpp"
#include "design/studies/optimise_design.hpp"

namespace fettle::design::session {

namespace {

using description::Parameter;
using problem::DesignEvaluation;
using problem::DesignProblem;
using Clock = std::chrono::steady_clock;

constexpr auto looks_every = std::chrono::milliseconds(300);  // at the files
constexpr auto reads_faults_again_every = std::chrono::seconds(2);
constexpr auto tells_every = std::chrono::milliseconds(100);      // of progress
constexpr auto one_move_lasts = std::chrono::milliseconds(1000);  // of one slider: it is undone as one

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

Error refused(const std::string& where, const std::string& why) { return {ErrorCode::unsupported, where, why}; }

const Error& a_search_runs() {
    static const Error error = refused("tune", "a search runs: stop it to change something");
    return error;
}

// "12 mm"
std::string shown(double si, const Parameter& parameter) {
    char text[48];
    std::snprintf(text, sizeof text, "%.6g", description::from_si(si, parameter.unit));
    return parameter.unit.dimension == Dimension::number ? text : std::string(text) + " " + std::string(parameter.unit.name);
}

// The row of derivatives that a name stands for; nothing if there is none.
struct QuantityRow {
    double value = 0;
    VectorX gradient;
};
std::optional<QuantityRow> row_of(const description::Design& design, const DesignEvaluation& e, const std::string& name) {
    if (name == "objective") return QuantityRow{e.objective, e.gradient};
    for (std::size_t i = 0; i < design.constraints.size(); ++i)
        if (design.constraints[i].name == name)
            return QuantityRow{e.constraints[i].value, e.jacobian.row(static_cast<Eigen::Index>(i)).transpose()};
    for (std::size_t i = 0; i < design.relations.size(); ++i)
        if (design.relations[i].name == name) {
            const auto k = static_cast<Eigen::Index>(i);
            return QuantityRow{e.relations.values[k], e.relations.jacobian.row(k).transpose()};
        }
    return std::nullopt;
}

bool have_same_ranges(const Opened& a, const Opened& b) {
    const std::vector<Parameter>&p = a.design().parameters, &q = b.design().parameters;
    return std::equal(p.begin(), p.end(), q.begin(), q.end(), [](const Parameter& x, const Parameter& y) {
        return x.name == y.name && x.lower == y.lower && x.upper == y.upper && x.unit.name == y.unit.name;
    });
}

bool are_same(const Errors& a, const Errors& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Error& x, const Error& y) { return x.where == y.where && x.message == y.message; });
}

// What is kept of the values when the files have been read again: a number that the file has changed is the file's, and so is one that no
// longer fits.
VectorX kept_values(const Opened& before, const VectorX& set, const Opened& now) {
    VectorX values = now.values();
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        const Parameter& parameter = now.design().parameters[static_cast<std::size_t>(k)];
        for (Eigen::Index j = 0; j < set.size(); ++j) {
            const Parameter& old = before.design().parameters[static_cast<std::size_t>(j)];
            if (old.name == parameter.name && old.value == parameter.value && set[j] >= parameter.lower && set[j] <= parameter.upper)
                values[k] = set[j];
        }
    }
    return values;
}

}  // namespace

bool is_overtaken(NewsKind earlier, NewsKind by) {
    if (earlier == by) return true;
    if (by == NewsKind::opened) return earlier != NewsKind::faults;
    return by == NewsKind::asked && earlier != NewsKind::opened && earlier != NewsKind::faults && earlier != NewsKind::tuning;
}

Result<std::unique_ptr<Session>> Session::open(const std::string& path, SessionOptions options, std::function<void(const News&)> tell) {
    const std::filesystem::file_time_type begin = std::filesystem::file_time_type::clock::now();
    Result<std::shared_ptr<const Opened>> opened = session::open(path, options.opens);
    if (!opened) return opened.errors();
    std::unique_ptr<Session> session(new Session(path, std::move(options), std::move(tell)));
    session->opened_ = std::move(opened).value();
    session->values_ = session->opened_->values();
    session->files_ = WatchedFiles(paths_of(*session->opened_), begin);
    session->worker_ = std::thread([own = session.get()] { own->work(); });
    return session;
}

Session::Session(std::string path, SessionOptions options, std::function<void(const News&)> tell)
    : path_(std::move(path)), options_(std::move(options)), tell_(std::move(tell)) {}

Session::~Session() {
    {
        const std::lock_guard lock(mutex_);
        is_closing_ = true;
    }
    woken_.notify_all();
    if (worker_.joinable()) worker_.join();
}

std::shared_ptr<const Opened> Session::opened() const {
    const std::lock_guard lock(mutex_);
    return opened_;
}

VectorX Session::values() const {
    const std::lock_guard lock(mutex_);
    return values_;
}

// Contract: the mutex is held.
std::uint64_t Session::take(VectorX values) {
    values_ = std::move(values);
    woken_.notify_all();
    return ++newest_;
}

Result<std::uint64_t> Session::set(const Values& wanted) {
    const std::lock_guard lock(mutex_);
    if (is_searching_) return a_search_runs();
    const std::vector<Parameter>& parameters = opened_->design().parameters;
    VectorX values = values_;
    Errors errors;
    std::vector<std::string> names;
    std::vector<std::string_view> known;
    for (const Parameter& parameter : parameters) known.emplace_back(parameter.name);
    for (const auto& [name, value] : wanted) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            errors.push_back({ErrorCode::unknown_key, name, "there is no such parameter; " + core::files::did_you_mean(name, known)});
            continue;
        }
        const Parameter& parameter = parameters[static_cast<std::size_t>(found - known.begin())];
        const double held = description::representable(value, parameter.unit);
        if (!std::isfinite(value))
            errors.push_back({ErrorCode::not_finite, name, "a number is expected"});
        else if (!(held >= parameter.lower && held <= parameter.upper))
            errors.push_back({ErrorCode::out_of_range, name,
                              shown(value, parameter) + " is outside its bounds, " + shown(parameter.lower, parameter) + " to " +
                                  shown(parameter.upper, parameter)});
        values[found - known.begin()] = held;
        names.push_back(name);
    }
    if (!errors.empty()) return errors;
    if (values == values_) return newest_.load();
    const bool goes_on = names == set_last_ && Clock::now() - set_at_ < one_move_lasts && !past_.empty();
    if (!goes_on) past_.push_back(values_);
    future_.clear();
    set_last_ = std::move(names);
    set_at_ = Clock::now();
    return take(std::move(values));
}

// Contract: the mutex is held.
Result<std::uint64_t> Session::step_back(std::vector<VectorX>& from, std::vector<VectorX>& to, const char* nothing) {
    if (is_searching_) return a_search_runs();
    if (from.empty()) return refused("values", nothing);
    to.push_back(values_);
    VectorX values = std::move(from.back());
    from.pop_back();
    set_last_.clear();
    return take(std::move(values));
}

Result<std::uint64_t> Session::undo() {
    const std::lock_guard lock(mutex_);
    return step_back(past_, future_, "there is nothing to undo");
}

Result<std::uint64_t> Session::redo() {
    const std::lock_guard lock(mutex_);
    return step_back(future_, past_, "there is nothing to redo");
}

Result<std::uint64_t> Session::reset() {
    const std::shared_ptr<const Opened> opened = this->opened();
    Values values;
    for (const Parameter& parameter : opened->design().parameters) values[parameter.name] = parameter.value;
    return set(values);
}

Result<Session::Pulled> Session::pull(const std::string& name, double value) {
    std::shared_ptr<const DesignEvaluation> at;
    std::shared_ptr<const Opened> opened;
    {
        const std::lock_guard lock(mutex_);
        if (is_searching_) return a_search_runs();
        if (known_ == newest_) at = differentiated_;
        opened = opened_;
    }
    if (!std::isfinite(value)) return Error{ErrorCode::not_finite, name, "a number is expected"};
    if (at == nullptr) return refused(name, "its derivative is not known yet for these values");
    const std::vector<Parameter>& parameters = opened->design().parameters;
    const std::optional<QuantityRow> row = row_of(opened->design(), *at, name);
    if (!row) return Error{ErrorCode::unknown_key, name, "no requirement is called so, and it is not \"objective\""};
    if (!std::isfinite(row->value) || !row->gradient.allFinite()) return refused(name, "its derivative is no finite number here");
    VectorX lower(row->gradient.size()), upper(row->gradient.size());
    for (Eigen::Index k = 0; k < lower.size(); ++k) {
        lower[k] = std::min(parameters[static_cast<std::size_t>(k)].lower, at->parameters[k]);
        upper[k] = std::max(parameters[static_cast<std::size_t>(k)].upper, at->parameters[k]);
    }
    const LeastChange least = least_change(at->parameters, lower, upper, row->gradient, value - row->value);
    Values wanted;
    for (Eigen::Index k = 0; k < lower.size(); ++k) wanted[parameters[static_cast<std::size_t>(k)].name] = least.values[k];
    const Result<std::uint64_t> revision = set(wanted);
    if (!revision) return revision.errors();
    return Pulled{*revision, values(), row->value + least.change, least.reaches};
}

Errors Session::tune(std::optional<int> max_evaluations) {
    const std::lock_guard lock(mutex_);
    if (is_searching_) return {a_search_runs()};
    if (opened_->design().parameters.empty()) return {refused("tune", "nothing can be changed: the scene has no variables")};
    if (opened_->design().objective.empty() && opened_->design().constraints.empty())
        return {refused("tune", "nothing is wanted or required: open a design, which says what is")};
    search_asked_ = max_evaluations.value_or(opened_->design().optimiser.max_evaluations);
    is_searching_ = true;
    ends_search_ = false;
    woken_.notify_all();
    return {};
}

void Session::stop() { ends_search_ = true; }

Result<std::string> Session::text(const std::string& folder) const {
    const std::lock_guard lock(mutex_);
    if (!opened_->made_scene.empty()) return opened_->made_scene;
    if (opened_->is_scene) return refused(path_, "a scene is changed in its own file; a design can be saved");
    const Result<std::string> scene = reading::scene_from(opened_->file, folder);
    if (!scene) return scene.errors();
    return reading::design_text(opened_->file, values_, folder);
}

Result<Session::Saved> Session::save(const std::optional<std::string>& as, bool replace) const {
    const std::shared_ptr<const Opened> opened = this->opened();
    const std::string own = opened->is_scene ? opened->file.scene_path : opened->file.path;
    const std::filesystem::path file = as.value_or(own);
    std::error_code none;
    const bool is_opened = std::filesystem::weakly_canonical(file, none) == std::filesystem::weakly_canonical(opened->file.path, none);
    if (!is_opened && !replace && std::filesystem::exists(file, none)) return Saved{file.string(), true};
    const Result<std::string> made = text(file.parent_path().string());
    if (!made) return made.errors();
    if (Errors errors = core::files::write_file_atomically(file, *made); !errors.empty()) return errors;
    return Saved{file.string(), false};
}

// What all news have. Contract: the mutex is not held.
News Session::news(NewsKind kind, std::uint64_t revision) const {
    const std::lock_guard lock(mutex_);
    News news;
    news.kind = kind;
    news.revision = revision;
    news.opened = opened_;
    news.values = values_;
    news.is_as_in_file = values_ == opened_->values();
    news.can_undo = !past_.empty();
    news.can_redo = !future_.empty();
    news.is_stale = [this, revision] { return is_stale(revision); };
    return news;
}

void Session::work() {
    tell_(news(NewsKind::opened, newest_));
    for (;;) {
        std::uint64_t revision = 0;
        bool searches = false;
        {
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, looks_every, [&] { return is_closing_ || search_asked_ || newest_ != begun_; });
            if (is_closing_) return;
            revision = newest_;
            searches = search_asked_.has_value();
        }
        if (searches) {
            search();
        } else if (revision != begun_) {
            begun_ = revision;
            evaluate(revision);
        } else if (options_.watches_files) {
            reread();
        }
    }
}

void Session::evaluate(std::uint64_t revision) {
    const Clock::time_point begin = Clock::now();
    const News about = news(NewsKind::asked, revision);
    if (is_stale(revision)) return;
    tell_(about);
    const auto tell = [&](NewsKind kind, const auto& fill) {
        if (is_stale(revision)) return;
        News each = about;
        each.kind = kind;
        each.seconds = seconds_since(begin);
        fill(each);
        tell_(each);
    };
    Clock::time_point told = begin;
    const char* doing = "simulating";
    const auto on_step = [&](const core::stepper::Progress& p) {
        if (Clock::now() - told < tells_every) return;
        told = Clock::now();
        tell(NewsKind::progress, [&](News& each) {
            each.text = doing;
            each.step = p.step;
            each.steps = p.steps;
        });
    };
    const DesignProblem& problem = *about.opened->problem;
    try {
        problem::EvaluateOptions options;
        options.gradients = problem.parameter_count() > 0;
        options.balance = true;
        options.should_stop = [&] { return is_stale(revision); };
        options.on_step = on_step;
        bool has_told = false;
        const auto measured = [&](std::shared_ptr<const DesignEvaluation> e) {
            has_told = true;
            tell(NewsKind::measured, [&](News& each) { each.evaluation = std::move(e); });
        };
        options.on_values = [&](const DesignEvaluation& e) { measured(std::make_shared<const DesignEvaluation>(e)); };
        const auto evaluation = std::make_shared<const DesignEvaluation>(problem.evaluate(about.values, options));
        if (is_stale(revision)) return;
        if (!evaluation->usable) {
            tell(NewsKind::refused, [&](News& each) { each.text = evaluation->reason; });
            tell(NewsKind::settled, [](News&) {});
            return;
        }
        if (!has_told) measured(evaluation);
        if (options.gradients) {
            const std::lock_guard lock(mutex_);
            differentiated_ = evaluation;
            known_ = revision;
        }
        if (options.gradients) tell(NewsKind::differentiated, [&](News& each) { each.evaluation = evaluation; });
        doing = "comparing with the play taken up";
        const auto judged =
            std::make_shared<const studies::JudgedDesign>(studies::judge_design(problem, *evaluation, {options.should_stop, on_step}));
        tell(NewsKind::judged, [&](News& each) {
            each.evaluation = evaluation;
            each.judged = judged;
        });
    } catch (const std::exception& fault) {
        tell(NewsKind::refused, [&](News& each) { each.text = fault.what(); });
    }
    tell(NewsKind::settled, [](News&) {});
}

void Session::search() {
    int most = 0;
    description::Design design;
    {
        const std::lock_guard lock(mutex_);
        most = *std::exchange(search_asked_, std::nullopt);
        design = opened_->file.design;
        for (Eigen::Index k = 0; k < values_.size(); ++k) {
            Parameter& parameter = design.parameters[static_cast<std::size_t>(k)];
            if (!parameter.reference) parameter.reference = parameter.value;  // the model stays the one that is looked at
            parameter.value = values_[k];
        }
    }
    design.optimiser.max_evaluations = most;
    Tuning tuning{.runs = true};
    const auto tell = [&] {
        News each = news(NewsKind::tuning, newest_);
        each.tuning = tuning;
        tell_(each);
    };
    tell();
    try {
        const Result<DesignProblem> problem = DesignProblem::create(std::move(design));
        if (!problem) {
            tuning.message = problem.errors().front().message;
        } else {
            studies::OptimiseOptions options;
            options.should_stop = [&] { return ends_search_ || is_closing_; };
            options.on_evaluation = [&](int number, const VectorX& p, const optimisers::Evaluation& e, bool best) {
                tuning.evaluations = number;
                if (best && e.usable) {
                    tuning.values = p;
                    tuning.objective = e.objective;
                    tuning.violation = e.violation;
                }
                tell();
            };
            const Result<studies::OptimiseOutcome> outcome = studies::optimise_design(*problem, options);
            if (!outcome) {
                tuning.message = outcome.errors().front().message;
            } else {
                const optimisers::OptimiserReport& report = outcome->report;
                tuning.evaluations = report.evaluations;
                if (report.best.usable) {
                    tuning.values = report.point;
                    tuning.objective = report.best.objective;
                    tuning.violation = report.best.violation;
                }
                tuning.message = std::string(to_string(report.status)) + ": " + report.message;
            }
        }
    } catch (const std::exception& fault) {
        tuning.message = fault.what();
    }
    tuning.runs = false;
    {
        const std::lock_guard lock(mutex_);
        is_searching_ = false;
        if (tuning.values.size() == values_.size() && tuning.values != values_) {
            past_.push_back(values_);
            future_.clear();
            set_last_.clear();
            take(tuning.values);
        }
    }
    tell();
}

// A stop that the caller asked for ends the reading alone.
Result<std::shared_ptr<const Opened>> Session::reopened() const {
    try {
        return session::open(path_, options_.opens);
    } catch (const std::exception& fault) {
        return Error{ErrorCode::file_unreadable, path_, fault.what()};
    }
}

void Session::reread() {
    const Clock::time_point now = Clock::now();
    // Files with faults may name some that were not there, and have come.
    const bool may_be_mended = !faults_.empty() && now - looked_at_ >= reads_faults_again_every;
    if (!may_be_mended && !files_.have_changed()) return;
    looked_at_ = now;
    const std::filesystem::file_time_type begin = std::filesystem::file_time_type::clock::now();
    Result<std::shared_ptr<const Opened>> again = reopened();
    if (!again) {
        if (are_same(faults_, again.errors())) return;
        News faults = news(NewsKind::faults, newest_);
        faults.errors = faults_ = again.errors();
        tell_(faults);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        const VectorX values = kept_values(*opened_, values_, **again);
        if (!have_same_ranges(*opened_, **again)) {  // what was set before may not fit any more
            past_.clear();
            future_.clear();
        }
        opened_ = std::move(again).value();
        files_ = WatchedFiles(paths_of(*opened_), begin);
        take(values);
    }
    if (!std::exchange(faults_, {}).empty()) tell_(news(NewsKind::faults, newest_));
    tell_(news(NewsKind::opened, newest_));
}

}  // namespace fettle::design::session
