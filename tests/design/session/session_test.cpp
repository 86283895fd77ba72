// SPDX-License-Identifier: MIT
#include "design/session/session.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "design/session/news_json.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::session::session_test {

namespace {

using namespace fettle::tests::design_support;
using namespace std::chrono_literals;

constexpr auto patience = 60s;

// All news of a session, to be waited for.
class Heard {
public:
    std::function<void(const News&)> tell() {
        return [this](const News& news) {
            const std::lock_guard lock(mutex_);
            all_.push_back(news);
            come_.notify_all();
        };
    }

    template <class Is>
    News wait(const Is& is) {
        std::unique_lock lock(mutex_);
        News found;
        const bool has_come = come_.wait_for(lock, patience, [&] {
            const auto at = std::find_if(all_.begin(), all_.end(), is);
            if (at != all_.end()) found = *at;
            return at != all_.end();
        });
        REQUIRE(has_come);
        return found;
    }
    News wait(NewsKind kind, std::uint64_t revision) {
        return wait([=](const News& news) { return news.kind == kind && news.revision == revision; });
    }

    std::vector<News> all() {
        const std::lock_guard lock(mutex_);
        return all_;
    }

private:
    std::mutex mutex_;
    std::condition_variable come_;
    std::vector<News> all_;
};

std::unique_ptr<Session> opened(const std::string& path, Heard& heard) {
    Result<std::unique_ptr<Session>> session = Session::open(path, {}, heard.tell());
    if (!session) FAIL(session.errors().front().message);
    return std::move(session).value();
}

}  // namespace

TEST_CASE("session: what becomes known is told in order, and is what the design's own evaluation says") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    heard.wait(NewsKind::settled, 1);
    std::vector<NewsKind> kinds;
    for (const News& news : heard.all())
        if (news.kind != NewsKind::progress) kinds.push_back(news.kind);
    CHECK(kinds == std::vector{NewsKind::opened, NewsKind::asked, NewsKind::measured, NewsKind::differentiated, NewsKind::judged,
                               NewsKind::settled});

    const Result<std::uint64_t> revision = session->set({{"height", 9e-3}, {"speed", 0.6}});
    REQUIRE(revision);
    CHECK(*revision == 2);
    const News measured = heard.wait(NewsKind::measured, 2), differentiated = heard.wait(NewsKind::differentiated, 2);
    CHECK(measured.values[0] == 9e-3);
    CHECK_FALSE(measured.is_as_in_file);
    CHECK(measured.can_undo);
    const problem::DesignEvaluation own = session->opened()->problem->evaluate(measured.values);
    CHECK(measured.evaluation->objective == own.objective);
    CHECK(differentiated.evaluation->gradient == own.gradient);
    CHECK(differentiated.evaluation->jacobian == own.jacobian);
    const News judged = heard.wait(NewsKind::judged, 2);
    CHECK(judged.judged->clearance.size() == 3);
}

TEST_CASE("session: the last values win, and nothing is told of former ones after they have been set") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    std::uint64_t last = 0;
    for (int k = 0; k < 40; ++k) last = *session->set({{"place", (3 + 0.1 * (k + 1)) * 1e-3}});
    const News settled = heard.wait(NewsKind::settled, last);
    CHECK(settled.values[2] == Approx(7e-3));
    std::uint64_t newest = 0;
    int measured = 0;
    for (const News& news : heard.all()) {
        CHECK(news.revision >= newest);
        newest = std::max(newest, news.revision);
        measured += news.kind == NewsKind::measured ? 1 : 0;
    }
    CHECK(measured < 40);  // most were never begun, or ended early
    // Moves of one slider are one step back.
    CHECK(session->undo());
    CHECK(session->values()[2] == Approx(3e-3));
    CHECK_FALSE(session->undo());
    CHECK(session->redo());
    CHECK(session->values()[2] == Approx(7e-3));
}

TEST_CASE("session: what cannot be set is refused with its reason, and nothing is changed") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    const VectorX before = session->values();
    CHECK(session->set({{"hight", 9e-3}}).errors().front().message.find("height") != std::string::npos);
    CHECK(session->set({{"height", 15e-3}}).errors().front().message.find("6 mm to 14 mm") != std::string::npos);
    CHECK(session->set({{"height", std::nan("")}}).errors().front().code == ErrorCode::not_finite);
    CHECK(session->set({{"width", 21e-3}, {"height", 15e-3}}).errors().size() == 1);
    CHECK(session->values() == before);
    CHECK(*session->set({{"height", 10e-3}}) == 1);  // what it is already
    CHECK_FALSE(session->undo());
    CHECK_FALSE(Session::open(folder.file("none.json"), {}, heard.tell()));
}

TEST_CASE("session: values at which nothing can be simulated are told as refused") {
    // The cube stands in the wall, at 40 - 2.5 mm.
    const DesignFolder folder(replaced(small_design, R"("lower": -5, "upper": 20)", R"("lower": -5, "upper": 60)"));
    Heard heard;
    const auto session = opened(folder.design(), heard);
    const std::uint64_t revision = *session->set({{"place", 40e-3}});
    const News refused = heard.wait(NewsKind::refused, revision);
    CHECK(refused.text.find("wall") != std::string::npos);
    heard.wait(NewsKind::settled, revision);
    for (const News& news : heard.all()) CHECK_FALSE((news.kind == NewsKind::measured && news.revision == revision));
}

TEST_CASE("session: a result is pulled to a value by the least change, and comes there to first order") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    heard.wait(NewsKind::settled, 1);
    const std::string mass = session->opened()->design().constraints[4].name;
    const double now = heard.wait(NewsKind::measured, 1).evaluation->constraints[4].value;
    const Result<Session::Pulled> pulled = session->pull(mass, now * 1.01);
    REQUIRE(pulled);
    CHECK(pulled->reaches);
    CHECK(pulled->predicted == Approx(now * 1.01));
    const News after = heard.wait(NewsKind::measured, pulled->revision);
    CHECK(after.evaluation->constraints[4].value == Approx(now * 1.01).epsilon(1e-4));
    CHECK(after.values == pulled->values);
    heard.wait(NewsKind::settled, pulled->revision);
    CHECK(session->pull("nothing", 1).errors().front().code == ErrorCode::unknown_key);
}

TEST_CASE("session: files that are written to are taken up; what was set stays, unless the file says otherwise") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    REQUIRE(session->set({{"place", 4e-3}}));
    heard.wait(NewsKind::settled, 2);
    folder.write("small.design.json", "{ broken");
    const News faults = heard.wait([](const News& news) { return news.kind == NewsKind::faults && !news.errors.empty(); });
    CHECK(faults.errors.front().where.find("small.design.json") != std::string::npos);
    CHECK(session->values()[2] == 4e-3);
    folder.write("small.design.json", replaced(small_design, R"("name": "height", "value": 10)", R"("name": "height", "value": 8)"));
    heard.wait([](const News& news) { return news.kind == NewsKind::faults && news.errors.empty(); });
    const News again = heard.wait([](const News& news) { return news.kind == NewsKind::opened && news.revision > 2; });
    CHECK(again.values[0] == Approx(8e-3));
    CHECK(again.values[2] == 4e-3);
    heard.wait(NewsKind::settled, again.revision);
}

TEST_CASE("session: a search is told as it goes, ends when asked, and its best design is set") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    REQUIRE(session->tune(6).empty());
    CHECK_FALSE(session->tune(6).empty());
    CHECK_FALSE(session->set({{"place", 4e-3}}));
    const News ended = heard.wait([](const News& news) { return news.kind == NewsKind::tuning && !news.tuning.runs; });
    CHECK(ended.tuning.evaluations >= 2);
    CHECK_FALSE(ended.tuning.message.empty());
    CHECK(session->values() == ended.tuning.values);
    heard.wait(NewsKind::settled, ended.revision);
    CHECK(session->undo());
    REQUIRE(session->tune().empty());
    session->stop();
    heard.wait([&](const News& news) {
        return news.kind == NewsKind::tuning && !news.tuning.runs && news.tuning.message != ended.tuning.message;
    });
}

TEST_CASE("session: a scene is a design that wants nothing; its numbers can be changed") {
    const DesignFolder folder(small_design,
                              replaced(replaced(small_scene, R"("units": "mm",)", R"("units": "mm", "variables": {"wide": "20mm"},)"),
                                       R"("size_x": 20)", R"("size_x": "= wide")"));
    Heard heard;
    const auto session = opened(folder.file("small.scene.json"), heard);
    REQUIRE(session->opened()->design().parameters.size() == 1);
    CHECK(session->opened()->design().parameters[0].lower == Approx(10e-3));
    const std::uint64_t revision = *session->set({{"wide", 18e-3}});
    const News measured = heard.wait(NewsKind::measured, revision);
    CHECK(measured.evaluation->runs.front().simulation.trajectory.steps.size() == 20);
    CHECK_FALSE(session->tune().empty());
    CHECK_FALSE(session->text(folder.path.string()));
    const DesignFolder fixed;
    Heard also;
    const auto other = opened(fixed.file("small.scene.json"), also);
    CHECK(other->opened()->design().parameters.empty());
    also.wait(NewsKind::settled, 1);
}

TEST_CASE("session: as JSON each piece of news has its revision, and numbers in the units of the files") {
    const DesignFolder folder;
    Heard heard;
    const auto session = opened(folder.design(), heard);
    heard.wait(NewsKind::settled, 1);
    std::vector<std::string> names;
    nlohmann::ordered_json by_name;
    for (const News& news : heard.all())
        if (news.kind != NewsKind::progress)
            for (const ToldNews& each : told(news)) {
                if (each.name != "fault" && each.name != "opened") CHECK(each.data["revision"] == 1);
                names.push_back(each.name);
                by_name[each.name] = each.data;
            }
    CHECK(names == std::vector<std::string>{"opened", "asked", "motion", "numbers", "gradient", "numbers", "pairs", "settled"});
    const auto& parameters = by_name["opened"]["parameters"];
    REQUIRE(parameters.size() == 5);
    CHECK(parameters[0]["unit"] == "mm");
    CHECK(parameters[0]["upper"] == 14);
    CHECK(by_name["opened"]["values"]["speed"] == 40);
    CHECK(by_name["opened"]["views"].size() == 1);
    CHECK(by_name["numbers"]["requirements"].size() == 5);
    CHECK(by_name["pairs"]["pairs"].size() == 3);
    // d mass / d height [g / mm], of a box.
    const auto& gradient = by_name["gradient"]["rows"];
    REQUIRE(gradient.size() == 6);
    const double mass = by_name["numbers"]["requirements"][4]["lower"];
    CHECK(gradient[5]["by"]["height"].get<double>() == Approx(mass / 10));
    CHECK(gradient[5]["by"]["place"].get<double>() == Approx(0).margin(1e-12));

    const Result<Session::Values> values = values_from({{"height", 9}, {"speed", 45}}, *session->opened());
    REQUIRE(values);
    CHECK(values->at("height") == Approx(9e-3));
    CHECK_FALSE(values_from({{"height", "9"}}, *session->opened()));
    CHECK_FALSE(values_from({1, 2}, *session->opened()));
}

}  // namespace fettle::design::session::session_test
