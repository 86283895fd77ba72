// SPDX-License-Identifier: MIT
#include "design/cli/clearance_files.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/certificate/certificate.hpp"
#include "core/files/atomic_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "design/answers/output_folder.hpp"
#include "design/answers/run_folder.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/cli/clearance_text.hpp"
#include "design/cli/report_made.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using clearance::Subject;
using clearance::SubjectSource;
using core::files::FilesTogether;

bool is_finite(const core::stepper::Trajectory& trajectory) {
    const auto finite = [](const auto& list, const auto& first, const auto& second) {
        return std::all_of(list.begin(), list.end(), [&](const auto& x) { return (x.*first).allFinite() && (x.*second).allFinite(); });
    };
    using core::kinematics::ChartPoint;
    using core::kinematics::Pose;
    for (const auto& poses : trajectory.poses)
        if (!finite(poses, &Pose::rotation, &Pose::position)) return false;
    for (const auto& step : trajectory.steps)
        for (const auto& node : step.nodes)
            if (!finite(node, &ChartPoint::position, &ChartPoint::rotation_vector)) return false;
    return true;
}

/// One call's files, with what is told of them.
class Writing {
public:
    Writing(const ClearanceFiles& wanted, const Subject& subject, clearance::ClearanceReport& report, const CommonOptions& common,
            Console& console, Json& answer, std::string& told)
        : wanted_(wanted), subject_(subject), report_(report), common_(common), console_(console), answer_(answer), told_(told) {}

    Errors write() {
        if (!(wanted_.certificate.empty() && wanted_.out.empty()) && !is_finite(subject_.domain.path()))
            return {{ErrorCode::not_finite, wanted_.certificate.empty() ? wanted_.out : wanted_.certificate,
                     "the path has numbers that are not finite, so that nothing can be certified of it: nothing is written"}};
        Errors errors;
        if (!wanted_.csv.empty()) errors = files_.add(wanted_.csv, report_csv(report_, subject_));
        if (errors.empty() && report_.certificate) errors = add_proof(*report_.certificate);
        if (errors.empty() && !wanted_.out.empty()) errors = add_folder();
        return errors.empty() ? files_.take_names() : errors;
    }

private:
    bool judged_a_trajectory() const { return subject_.source == SubjectSource::trajectory; }

    // The certificate, and beside it the trajectory that it is about, unless that is a file already.
    Errors add_proof(core::certificate::Certificate& certificate) {
        const std::string& file = wanted_.certificate;
        if (certificate.pairs.empty()) {
            take_away_proof();
            answer_["certificate"] = Json();
            told_ += "certificate: not written, because nothing is proven\n";
            return {};
        }
        if (!subject_.files.empty()) {  // meshes: their files are what the proof is about
            auto named = clearance::named_files(subject_.files, file);
            if (!named) return named.errors();
            certificate.exports = std::move(*named);
        } else if (!judged_a_trajectory()) {
            certificate.source = clearance::name_from_certificate(file, wanted_.judged);
            certificate.scenario = wanted_.scenario;
            if (subject_.domain.made()) certificate.process = process_named_from(file);
        }
        const std::string beside = clearance::certificate_trajectory(file), path = judged_a_trajectory() ? wanted_.judged : beside;
        if (!judged_a_trajectory()) {
            Errors errors = core::records::add_trajectory(files_, beside, subject_.domain.path(), subject_.model, subject_.scene_path);
            if (!errors.empty()) return errors;
        }
        answer_["certificate"] = {{"file", file}, {"trajectory", path}};
        told_ += "certificate: " + file + (subject_.domain.is_tree() ? "" : ", of the path in " + path) +
                 "; check it with fettle validate " + file + (judged_a_trajectory() ? " --trajectory " + path : "") + "\n";
        return core::certificate::add_certificate(files_, file, certificate);
    }

    // A process is a name that all know, or a file.
    std::string process_named_from(const std::string& certificate) const {
        std::error_code ignored;
        const bool is_file = std::filesystem::exists(wanted_.process, ignored);
        return is_file ? clearance::name_from_certificate(certificate, wanted_.process) : wanted_.process;
    }

    // Where nothing is proven, the certificate of an earlier run must not stay, nor its trajectory, unless that is what was judged.
    void take_away_proof() {
        if (!core::certificate::is_certificate_file(wanted_.certificate)) return;
        files_.take_away(wanted_.certificate);
        const std::string beside = clearance::certificate_trajectory(wanted_.certificate);
        if (!judged_a_trajectory() && core::records::is_trajectory_file(beside)) files_.take_away(beside);
    }

    Errors add_folder() {
        const std::filesystem::path file = std::filesystem::path(wanted_.out) / "trajectory.json";
        std::error_code ignored;
        if (std::filesystem::equivalent(wanted_.judged, file, ignored)) {
            answers::replace_answer(files_, wanted_.out);
        } else {
            const std::string kept = answers::name_for_longer_run(file, subject_.domain.path().steps.size());
            if (!kept.empty()) {
                console_.narrate("warning: a longer run was there, which is kept as " + kept);
                files_.keep_as(file, kept);
            }
            answers::replace_motion(files_, wanted_.out);
            Errors errors = core::records::add_trajectory(files_, file, subject_.domain.path(), subject_.model, subject_.scene_path);
            if (!errors.empty()) return errors;
        }
        answer_["out"] = wanted_.out;
        return answers::add_result(files_, wanted_.out, answer_, common_.command);
    }

    const ClearanceFiles& wanted_;
    const Subject& subject_;
    clearance::ClearanceReport& report_;
    const CommonOptions& common_;
    Console& console_;
    Json& answer_;
    std::string& told_;
    FilesTogether files_;
};

}  // namespace

Errors try_files(const ClearanceFiles& wanted) {
    for (const std::string& file : {wanted.csv, wanted.certificate}) {
        if (file.empty()) continue;
        if (Errors errors = answers::try_output_file(file); !errors.empty()) return errors;
    }
    if (!wanted.certificate.empty() && !core::records::is_trajectory_file(wanted.judged)) {  // a trajectory is written beside it
        if (Errors errors = answers::others_file(clearance::certificate_trajectory(wanted.certificate)); !errors.empty()) return errors;
    }
    if (!wanted.out.empty()) {
        if (Errors errors = answers::try_run_folder(wanted.out); !errors.empty()) return errors;
    }
    return {};
}

Errors leave_files(const ClearanceFiles& wanted, const Subject& subject, clearance::ClearanceReport& report, const CommonOptions& common,
                   Console& console, Json& answer, std::string& told) {
    Json with_files = answer;
    std::string told_of_files = told;
    Errors errors = Writing(wanted, subject, report, common, console, with_files, told_of_files).write();
    if (!errors.empty()) return errors;
    answer = std::move(with_files);
    told = std::move(told_of_files);
    if (!wanted.out.empty() && !wanted.no_report)
        leave_report(wanted.out, common, console, answer, told,
                     {.motion = report::Motion{subject.model, subject.domain.path(), subject.scene_path}});
    return {};
}

}  // namespace fettle::design::cli
