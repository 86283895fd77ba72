// SPDX-License-Identifier: MIT
// News come on the session's own thread, which never waits for Python: they are put into an inbox, and Python waits for them there without
// the interpreter's lock.
#include "design/session/session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/expression/dimension_powers.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/nearest_word.hpp"
#include "design/answers/summary.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/design_records.hpp"
#include "design/python/errors.hpp"
#include "design/python/watch.hpp"

FETTLE_WORDS(fettle::design::session::NewsKind, "opened", "faults", "asked", "progress", "refused", "measured", "differentiated", "judged",
             "settled", "tuning")

namespace fettle::design::python {

namespace py = pybind11;

namespace {

using session::News;
using session::NewsKind;
using session::Session;
using SessionClock = std::chrono::steady_clock;
using NewsPointer = std::shared_ptr<const News>;

constexpr auto one_wait = std::chrono::milliseconds(50);  // between two looks for Ctrl-C
constexpr double longest_wait = 1e8;                      // [s]

// --- What has been told ---

struct Told {
    struct Entry {
        std::uint64_t number = 0;  // as they came, from 1
        NewsPointer news;
    };
    std::vector<Entry> entries;  // the newest of each kind that still holds
    std::uint64_t searches_ended = 0;
    NewsPointer last_search;  // that has ended
};

class Inbox {
public:
    void put(const News& news) {
        auto kept = std::make_shared<const News>(news);
        {
            const std::lock_guard lock(mutex_);
            std::erase_if(told_.entries, [&](const Told::Entry& entry) { return session::is_overtaken(entry.news->kind, news.kind); });
            told_.entries.push_back({++count_, kept});
            if (news.kind == NewsKind::tuning && !news.tuning.runs) {
                ++told_.searches_ended;
                told_.last_search = std::move(kept);
            }
        }
        come_.notify_all();
    }
    void close() {
        {
            const std::lock_guard lock(mutex_);
            is_closed_ = true;
        }
        come_.notify_all();
    }
    bool is_closed() const {
        const std::lock_guard lock(mutex_);
        return is_closed_;
    }
    template <class Find>
    auto find(const Find& find) const {
        const std::lock_guard lock(mutex_);
        return find(told_);
    }
    // What `find` finds, now or when something has been told; nothing: it was not there until `end`, or the session has ended.
    template <class Find>
    auto wait(const Find& find, SessionClock::time_point end) const {
        std::unique_lock lock(mutex_);
        auto found = find(told_);
        while (!found && !is_closed_ && come_.wait_until(lock, end) == std::cv_status::no_timeout) found = find(told_);
        return found;
    }

private:
    mutable std::mutex mutex_;
    mutable std::condition_variable come_;
    Told told_;
    std::uint64_t count_ = 0;
    bool is_closed_ = false;
};

// What `find` finds; nothing: the time is over, or the session has ended. Ctrl-C is thrown on. Contract: the interpreter's lock is held.
template <class Find>
auto waited(const Inbox& inbox, const Find& find, const std::optional<double>& seconds) {
    if (seconds) check_at_least("timeout", *seconds, 0);
    const auto length = std::chrono::duration<double>(std::min(seconds.value_or(longest_wait), longest_wait));
    const SessionClock::time_point end = SessionClock::now() + std::chrono::duration_cast<SessionClock::duration>(length);
    Watch watch(py::none{});
    decltype(find(Told())) found{};
    {
        const py::gil_scoped_release unlocked;
        const auto should_stop = watch.should_stop();
        do {
            found = inbox.wait(find, std::min(end, SessionClock::now() + one_wait));
        } while (!found && !inbox.is_closed() && SessionClock::now() < end && !should_stop());
    }
    watch.end();
    return found;
}

// News of that kind, if they are of the values set last; else null. Contract: the session has not ended.
NewsPointer current(const Told& told, NewsKind kind) {
    for (const Told::Entry& entry : told.entries)
        if (entry.news->kind == kind && !entry.news->is_stale()) return entry.news;
    return nullptr;
}

NewsPointer of_revision(const Told& told, NewsKind kind, std::uint64_t revision) {
    for (const Told::Entry& entry : told.entries)
        if (entry.news->kind == kind && entry.news->revision == revision) return entry.news;
    return nullptr;
}

// Any of the values set last: it knows what can be undone.
NewsPointer newest(const Told& told) {
    for (const Told::Entry& entry : told.entries)
        if (!entry.news->is_stale()) return entry.news;
    return nullptr;
}

// All that is known of the values set last.
struct Settled {
    NewsPointer end, refused, known;  // refused, known: null where there is none
};
std::optional<Settled> settled(const Told& told) {
    Settled at{current(told, NewsKind::settled), nullptr, nullptr};
    if (at.end == nullptr) return std::nullopt;
    at.refused = of_revision(told, NewsKind::refused, at.end->revision);
    for (const NewsKind kind : {NewsKind::measured, NewsKind::differentiated, NewsKind::judged})
        if (NewsPointer known = of_revision(told, kind, at.end->revision)) at.known = std::move(known);
    return at;
}

// The derivatives at the values set last, or what there is instead.
NewsPointer derivatives(const Told& told) {
    for (const NewsKind kind : {NewsKind::refused, NewsKind::differentiated, NewsKind::settled})
        if (NewsPointer found = current(told, kind)) return found;
    const NewsPointer tuning = current(told, NewsKind::tuning);
    return tuning != nullptr && tuning->tuning.runs ? tuning : nullptr;
}

// --- From and to Python ---

py::dict by_name(const std::vector<description::Parameter>& parameters, const VectorX& values) {
    py::dict named;
    for (int k = 0; k < std::min(count_of(parameters), static_cast<int>(values.size())); ++k)
        named[py::cast(parameters[static_cast<std::size_t>(k)].name)] = values[k];
    return named;
}

// By name those that change, or one for each parameter. A name that is unknown is the session's to tell.
Session::Values values_to_set(const std::vector<description::Parameter>& parameters, py::handle given) {
    Session::Values values;
    if (!py::isinstance<py::dict>(given)) {
        const VectorX p = point_from(parameters, given);
        raise_if_any(description::check_values(parameters, p));
        for (std::size_t k = 0; k < parameters.size(); ++k) values[parameters[k].name] = p[static_cast<Eigen::Index>(k)];
        return values;
    }
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
        const std::string name = py::str(key);
        const auto is_meant = [&](const description::Parameter& parameter) { return parameter.name == name; };
        const auto found = std::find_if(parameters.begin(), parameters.end(), is_meant);
        values[name] = found == parameters.end() ? 0 : quantity_from(value, found->unit.dimension, name);
    }
    return values;
}

Dimension dimension_of(const description::Design& design, const std::string& name) {
    if (name == "objective") return Dimension::number;
    std::vector<std::string_view> known{"objective"};
    for (const description::Constraint& constraint : design.constraints) {
        if (constraint.name == name) return constraint.quantity->dimension();
        known.emplace_back(constraint.name);
    }
    for (const description::Relation& relation : design.relations) {
        if (relation.name == name && relation.formula)
            return core::expression::named_dimension(relation.formula->dimension).value_or(Dimension::number);
        if (relation.name == name) return Dimension::number;
        known.emplace_back(relation.name);
    }
    refuse(ErrorCode::unknown_key, name, "no requirement is called so; " + core::files::did_you_mean(name, known));
}

// Requirements as measured, by name.
py::dict measured_by_name(const description::Design& design, const problem::DesignEvaluation& evaluation) {
    py::dict named;
    const auto add = [&](const std::string& name, const description::Measurement& measured) {
        if (!named.contains(name)) named[py::cast(name)] = measured;
    };
    for (std::size_t i = 0; i < evaluation.constraints.size(); ++i) add(design.constraints[i].name, evaluation.constraints[i]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(evaluation.relations.values.size()); ++i) {
        description::Measurement measured;
        measured.value = measured.lower = measured.upper = evaluation.relations.values[static_cast<Eigen::Index>(i)];
        add(design.relations[i].name, measured);
    }
    return named;
}

py::object judged_to_python(const studies::JudgedDesign& judged, const description::Design& design, const py::object& final) {
    std::vector<std::string> bodies, in_doubt;
    for (const core::scene::Body& body : design.scene.bodies) bodies.push_back(body.name);
    for (const std::size_t i : judged.in_doubt) in_doubt.push_back(design.constraints[i].name);
    py::dict members;
    members["final"] = final;
    members["play_taken_up"] = judged.play_taken_up;
    members["play_taken_up_by"] = judged.play_taken_up_by;
    members["play_not_compared"] = judged.play_not_compared;
    members["in_doubt"] = in_doubt;
    members["clearance"] = record_class("Pairs")(judged.clearance, bodies);
    return record_class("JudgedDesign")(**members);
}

// {sentence, why, rows}: of what was measured alone, or was judged.
py::object summary_of(const News& news) {
    studies::JudgedDesign measured;
    if (news.judged == nullptr) measured.final = *news.evaluation;
    const answers::Summary summary = answers::summary_of(news.opened->design(), news.judged != nullptr ? *news.judged : measured);
    return py::module_::import("json").attr("loads")(core::files::dumped(answers::summary_json(summary)));
}

py::object tuning_to_python(const News& news) {
    const session::Tuning& tuning = news.tuning;
    py::dict members;
    members["runs"] = tuning.runs;
    members["evaluations"] = tuning.evaluations;
    members["message"] = tuning.message;
    if (tuning.values.size() > 0) {
        members["values"] = by_name(news.opened->design().parameters, tuning.values);
        members["objective"] = tuning.objective;
        members["violation"] = tuning.violation;
    }
    return record_class("Tuning")(**members);
}

// The errors of the exception that they would be raised as.
py::object faults_to_python(const Errors& errors) {
    try {
        py::cpp_function([&errors] { raise_if_any(errors); })();
    } catch (py::error_already_set& raised) {
        return raised.value().attr("errors");
    }
    return py::list();
}

// What the evaluation has come to, for news and results.
void add_evaluation(const News& news, py::dict& members) {
    if (news.evaluation == nullptr) return;
    const py::object evaluation = py::cast(*news.evaluation);
    members["evaluation"] = evaluation;
    if (news.judged != nullptr) members["judged"] = judged_to_python(*news.judged, news.opened->design(), evaluation);
    members["summary"] = summary_of(news);
}

py::object news_to_python(const News& news) {
    py::dict members;
    members["kind"] = news.kind;
    members["revision"] = news.revision;
    members["values"] = by_name(news.opened->design().parameters, news.values);
    members["is_as_in_file"] = news.is_as_in_file;
    members["can_undo"] = news.can_undo;
    members["can_redo"] = news.can_redo;
    members["seconds"] = news.seconds;
    members["text"] = news.text;
    members["step"] = news.step;
    members["steps"] = news.steps;
    if (news.kind == NewsKind::opened) {
        members["parameters"] = news.opened->design().parameters;
        members["warnings"] = news.opened->warnings;
    }
    if (news.kind == NewsKind::faults) members["errors"] = faults_to_python(news.errors);
    if (news.kind == NewsKind::tuning) members["tuning"] = tuning_to_python(news);
    add_evaluation(news, members);
    return record_class("News")(**members);
}

[[noreturn]] void raise_no_design(const std::string& reason) {
    const py::object failure = record_class("EvaluationError");
    PyErr_SetObject(failure.ptr(), failure(reason).ptr());
    throw py::error_already_set();
}

py::object result_to_python(const Settled& at) {
    if (at.refused != nullptr) raise_no_design(at.refused->text);
    if (at.known == nullptr) raise_no_design("nothing is known of these values");
    py::dict members;
    members["revision"] = at.end->revision;
    members["values"] = by_name(at.known->opened->design().parameters, at.known->values);
    members["seconds"] = at.end->seconds;
    members["requirements"] = measured_by_name(at.known->opened->design(), *at.known->evaluation);
    add_evaluation(*at.known, members);
    return record_class("SessionResult")(**members);
}

// --- What Python holds ---

class NewsReader {
public:
    explicit NewsReader(std::shared_ptr<const Inbox> inbox) : inbox_(std::move(inbox)) {}

    // None: nothing came in that time, or the session has ended.
    py::object next(const std::optional<double>& timeout) {
        const auto after = [last = last_](const Told& told) -> std::optional<Told::Entry> {
            for (const Told::Entry& entry : told.entries)
                if (entry.number > last) return entry;
            return std::nullopt;
        };
        const std::optional<Told::Entry> found = waited(*inbox_, after, timeout);
        if (!found) return py::none();
        last_ = found->number;
        return news_to_python(*found->news);
    }

private:
    std::shared_ptr<const Inbox> inbox_;
    std::uint64_t last_ = 0;
};

class OpenSession {
public:
    OpenSession(const Path& path, session::SessionOptions options) : path_(path.string()) {
        const auto tell = [inbox = inbox_](const News& news) { inbox->put(news); };
        const py::gil_scoped_release unlocked;
        session_ = value_or_raise(Session::open(path_, std::move(options), tell));
    }
    ~OpenSession() {
        const py::gil_scoped_release unlocked;
        close();
    }
    OpenSession(const OpenSession&) = delete;
    OpenSession& operator=(const OpenSession&) = delete;

    // Waits for the session's thread. Contract: the interpreter's lock is not held.
    void close() {
        std::shared_ptr<Session> last;
        {
            const std::lock_guard lock(mutex_);
            last.swap(session_);
        }
        inbox_->close();
    }
    bool is_closed() const { return inbox_->is_closed(); }
    const std::string& path() const { return path_; }
    NewsReader news() const { return NewsReader(inbox_); }
    std::shared_ptr<const session::Opened> opened() const { return open()->opened(); }

    std::uint64_t set(const py::object& given) {
        const std::shared_ptr<Session> session = open();
        return value_or_raise(session->set(values_to_set(session->opened()->design().parameters, given)));
    }
    std::uint64_t undo() { return value_or_raise(open()->undo()); }
    std::uint64_t redo() { return value_or_raise(open()->redo()); }
    std::uint64_t reset() { return value_or_raise(open()->reset()); }
    py::dict values() const {
        const std::shared_ptr<Session> session = open();
        return by_name(session->opened()->design().parameters, session->values());
    }

    // None, as of all that takes a timeout: it is over.
    py::object pull(const std::string& name, const py::object& value, const std::optional<double>& timeout) {
        const std::shared_ptr<Session> session = open();
        const double si = quantity_from(value, dimension_of(session->opened()->design(), name), name);
        const NewsPointer known = wait(&derivatives, timeout);
        if (known == nullptr) return py::none();
        if (known->kind == NewsKind::refused) raise_no_design(known->text);
        const Session::Pulled pulled = value_or_raise(session->pull(name, si));
        py::dict members;
        members["revision"] = pulled.revision;
        members["values"] = by_name(session->opened()->design().parameters, pulled.values);
        members["predicted"] = pulled.predicted;
        members["reaches"] = pulled.reaches;
        return record_class("Pulled")(**members);
    }
    py::object result(const std::optional<double>& timeout) const {
        const std::optional<Settled> at = wait(&settled, timeout);
        return at ? result_to_python(*at) : py::none();
    }
    // (can_undo, can_redo, is_as_in_file)
    py::tuple place() const {
        const NewsPointer at = wait(&newest, std::nullopt);
        return py::make_tuple(at->can_undo, at->can_redo, at->is_as_in_file);
    }

    void tune(const std::optional<int>& max_evaluations) {
        if (max_evaluations) check_at_least("max_evaluations", *max_evaluations, 1);
        raise_if_any(open()->tune(max_evaluations));
        ++searches_begun_;
    }
    void stop() { open()->stop(); }
    bool is_tuning() const {
        return inbox_->find([&](const Told& told) { return told.searches_ended < searches_begun_; });
    }
    py::object search(const std::optional<double>& timeout) const {
        if (searches_begun_ == 0) refuse(ErrorCode::unsupported, "tune", "no search was begun");
        const auto ended = [this](const Told& told) { return told.searches_ended < searches_begun_ ? nullptr : told.last_search; };
        const NewsPointer found = wait(ended, timeout);
        return found == nullptr ? py::none() : tuning_to_python(*found);
    }

    // Numbers alone change. Meshes are saved as the scene that they make, beside them.
    Path save(const std::optional<Path>& as, bool replace) const {
        const Session::Saved saved = value_or_raise(open()->save(as ? std::optional<std::string>(as->string()) : std::nullopt, replace));
        if (saved.is_there) refuse(ErrorCode::file_unwritable, saved.file, "is there already; with replace=True it is written over");
        return saved.file;
    }

private:
    std::shared_ptr<Session> open() const {
        const std::lock_guard lock(mutex_);
        if (session_ == nullptr) refuse(ErrorCode::unsupported, path_, "the session is closed");
        return session_;
    }
    template <class Find>
    std::invoke_result_t<Find, const Told&> wait(const Find& find, const std::optional<double>& timeout) const {
        const std::shared_ptr<Session> session = open();  // lives while its news are asked whether they are stale
        auto found = waited(*inbox_, find, timeout);
        if (!found) open();  // tells that it was closed meanwhile
        return found;
    }

    const std::string path_;
    const std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
    mutable std::mutex mutex_;
    std::shared_ptr<Session> session_;
    std::atomic<std::uint64_t> searches_begun_ = 0;
};

std::unique_ptr<OpenSession> opened_session(const Path& path, const std::vector<Path>& mesh_dirs, bool allow_programs,
                                            const std::string& unit, bool split, bool watch) {
    session::SessionOptions options;
    options.opens.inputs.mesh_dirs = texts_of(mesh_dirs);
    options.opens.inputs.programs = allow_programs ? reading::Programs::allowed : reading::Programs::refused;
    options.opens.unit = unit;
    options.opens.split = split;
    options.watches_files = watch;
    return std::make_unique<OpenSession>(path, std::move(options));
}

}  // namespace

void bind_session(py::module_& module) {
    const py::call_guard<py::gil_scoped_release> unlocked;
    py::class_<NewsReader>(module, "_NewsReader", "The news of a session, one after the other (session.py).")
        .def("next", &NewsReader::next, py::arg("timeout"), "None: nothing came in that time, or the session has ended.");
    py::class_<OpenSession>(module, "_Session", "A design or a scene that is open (session.py).")
        .def("close", &OpenSession::close, unlocked)
        .def_property_readonly("is_closed", &OpenSession::is_closed)
        .def_property_readonly("path", &OpenSession::path)
        .def_property_readonly("is_scene", [](const OpenSession& self) { return self.opened()->is_scene; })
        .def_property_readonly("warnings", [](const OpenSession& self) { return self.opened()->warnings; })
        .def_property_readonly("parameters", [](const OpenSession& self) { return self.opened()->design().parameters; })
        .def_property_readonly("values", &OpenSession::values)
        .def_property_readonly("is_tuning", &OpenSession::is_tuning)
        .def("news", &OpenSession::news)
        .def("place", &OpenSession::place, "(can_undo, can_redo, is_as_in_file)")
        .def("set", &OpenSession::set, py::arg("values"))
        .def("undo", &OpenSession::undo, unlocked)
        .def("redo", &OpenSession::redo, unlocked)
        .def("reset", &OpenSession::reset, unlocked)
        .def("pull", &OpenSession::pull, py::arg("name"), py::arg("value"), py::arg("timeout"))
        .def("result", &OpenSession::result, py::arg("timeout"))
        .def("tune", &OpenSession::tune, py::arg("max_evaluations"))
        .def("stop", &OpenSession::stop, unlocked)
        .def("search", &OpenSession::search, py::arg("timeout"), "Waits for the end of the last one.")
        .def("save", &OpenSession::save, py::arg("path"), py::arg("replace"), unlocked, "The path that was written.");
    module.def("_open_session", &opened_session, py::arg("path"), py::arg("mesh_dirs"), py::arg("allow_programs"), py::arg("unit"),
               py::arg("split"), py::arg("watch"));
}

}  // namespace fettle::design::python
