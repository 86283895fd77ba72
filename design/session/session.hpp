// SPDX-License-Identifier: MIT
/// A design or a scene that is open: values are set, and whatever becomes known of them is told, as soon as it is known and with the
/// revision that it belongs to. The last values win: what is still computed for former ones ends. The files on the disk are watched.
///
///     auto session = Session::open("hinge.design.json", {}, [](const News& news) {
///         if (news.kind == NewsKind::measured) std::printf("%llu: %g\n", news.revision, news.evaluation->objective);
///     });
///     if (!session) return 3;
///     (*session)->set({{"gap", 0.3e-3}});
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "design/session/opened.hpp"
#include "design/studies/judged_design.hpp"

namespace fettle::design::session {

enum class NewsKind {
    opened,          ///< the files were read; again where they were written to
    faults,          ///< they were written to, and cannot be read any more: what was open stays. Without errors: they can again
    asked,           ///< an evaluation begins: what was known of former revisions is about other values
    progress,        ///< of it
    refused,         ///< it has no values: why
    measured,        ///< motion and values
    differentiated,  ///< the derivatives too
    judged,          ///< what is proven, and the other models of the same motion
    settled,         ///< nothing more will be told of this revision
    tuning           ///< of a search: what it has come to
};

/// Does news of one kind end what earlier news of another say? Each kind ends its own; `opened` ends all but faults; `asked` ends what was
/// known of former values.
bool is_overtaken(NewsKind earlier, NewsKind by);

/// How a search stands.
struct Tuning {
    bool runs = false;
    int evaluations = 0;
    VectorX values = {};                  ///< the best so far; empty: there is none
    double objective = 0, violation = 0;  ///< there
    std::string message = {};             ///< at the end: the verdict
};

struct News {
    NewsKind kind = NewsKind::asked;
    std::uint64_t revision = 0;
    std::shared_ptr<const Opened> opened;
    VectorX values;  ///< of the revision, SI
    bool is_as_in_file = true, can_undo = false, can_redo = false;
    Errors errors = {};                                                ///< of `faults`
    std::string text = {};                                             ///< of `progress`: what is done; of `refused`: the reason
    int step = 0, steps = 0;                                           ///< of `progress`
    std::shared_ptr<const problem::DesignEvaluation> evaluation = {};  ///< from `measured` on
    std::shared_ptr<const studies::JudgedDesign> judged = {};          ///< of `judged`
    double seconds = 0;                                                ///< since the evaluation began
    Tuning tuning = {};
    std::function<bool()> is_stale = [] { return false; };  ///< have other values been set since? Never asked after the session's end
};

struct SessionOptions {
    OpenOptions opens = {};
    bool watches_files = true;
};

/// Safe to call from any thread. `tell` is called on the session's own thread, one call at a time, and must not wait for the session.
class Session {
public:
    using Values = std::map<std::string, double>;  ///< by parameter, SI

    /// The first news is `opened`; an evaluation of the values of the file follows. Errors: of the files.
    static Result<std::unique_ptr<Session>> open(const std::string& path, SessionOptions options, std::function<void(const News&)> tell);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// @return the revision. Errors: no such parameter, no number, a value outside the bounds; a search runs.
    Result<std::uint64_t> set(const Values& values);
    Result<std::uint64_t> undo();
    Result<std::uint64_t> redo();
    /// The values of the file.
    Result<std::uint64_t> reset();

    struct Pulled {
        std::uint64_t revision = 0;
        VectorX values;        ///< SI
        double predicted = 0;  ///< of the quantity, to first order, SI
        bool reaches = true;
    };
    /// Sets the values that are nearest to the present ones and bring a quantity to `value` to first order (least_change.hpp).
    /// @param name  A requirement's, or "objective". @param value  SI.
    /// Errors: no such quantity; its derivative is not known (yet) for the present values.
    Result<Pulled> pull(const std::string& name, double value);

    /// Searches from the present values, as `fettle optimise` does; the best is set at the end. Errors: one runs; nothing can be changed.
    Errors tune(std::optional<int> max_evaluations = {});
    /// Ends a search with what it has.
    void stop();

    /// The text of the file with the present values, to stand in `folder`; of meshes that of the scene that they make. Errors: a scene's
    /// file is not written.
    Result<std::string> text(const std::string& folder) const;

    struct Saved {
        std::string file;
        bool is_there = false;  ///< another file has the name, and nothing was written
    };
    /// Writes text() into the file that was opened, of meshes into X.scene.json beside them; or into `as`. Another file than the one that
    /// was opened is replaced on request alone. Errors: of text(); the file cannot be written.
    Result<Saved> save(const std::optional<std::string>& as = {}, bool replace = false) const;

    std::shared_ptr<const Opened> opened() const;
    VectorX values() const;  ///< SI

private:
    using Clock = std::chrono::steady_clock;

    Session(std::string path, SessionOptions options, std::function<void(const News&)> tell);
    void work();
    void evaluate(std::uint64_t revision);
    void search();
    void reread();
    Result<std::shared_ptr<const Opened>> reopened() const;
    bool is_stale(std::uint64_t revision) const { return is_closing_ || newest_ != revision; }
    News news(NewsKind kind, std::uint64_t revision) const;
    std::uint64_t take(VectorX values);
    Result<std::uint64_t> step_back(std::vector<VectorX>& from, std::vector<VectorX>& to, const char* nothing);

    const std::string path_;
    const SessionOptions options_;
    const std::function<void(const News&)> tell_;

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::shared_ptr<const Opened> opened_;
    VectorX values_;
    std::vector<VectorX> past_, future_;
    std::vector<std::string> set_last_;  // names
    Clock::time_point set_at_{};
    std::shared_ptr<const problem::DesignEvaluation> differentiated_;  // of `known_`
    std::uint64_t known_ = 0;
    std::optional<int> search_asked_;  // how many evaluations at most
    WatchedFiles files_;
    Clock::time_point looked_at_{};
    Errors faults_;  // of the files, as they were told last

    std::atomic<std::uint64_t> newest_ = 1;
    std::atomic<bool> is_closing_ = false, is_searching_ = false, ends_search_ = false;
    std::uint64_t begun_ = 0;  // the last revision that an evaluation was begun for
    std::thread worker_;
};

}  // namespace fettle::design::session
