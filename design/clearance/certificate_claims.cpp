// SPDX-License-Identifier: MIT
#include "design/clearance/certificate_claims.hpp"

#include <algorithm>
#include <filesystem>

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/joint_ranges.hpp"
#include "core/clearance/jointed_clearance.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/clearance/read_subject.hpp"

namespace fettle::design::clearance {

namespace {

using core::certificate::Certificate;
using core::certificate::is_over_ranges;
using core::certificate::Solids;

std::vector<Claim> claims_of(const Certificate& certificate) {
    std::vector<Claim> claims;
    for (const auto& pair : certificate.pairs) {
        Claim claim{pair.a, pair.b, pair.lower, pair.upper, pair.solids, pair.minimum};
        if (certificate.joints) {
            const double charge = joint_charge(*certificate.joints, claim.a, claim.b);
            claim.lower = std::max(0.0, claim.lower - charge);
            claim.upper += charge;
            if (!(claim.lower > 0) && claim.solids == Solids::disjoint) claim.solids = Solids::unproven;
        }
        claims.push_back(claim);
    }
    return claims;
}

bool moves(const core::stepper::Trajectory& trajectory, int body) {
    const auto i = static_cast<size_t>(body);
    if (body < 0 || i >= trajectory.poses.front().size()) return true;  // it is none of the path's: a fault
    const core::kinematics::Pose& first = trajectory.poses.front()[i];
    for (const auto& step : trajectory.steps)
        for (const auto& node : step.nodes)
            if (node[i].position != first.position || node[i].rotation_vector != Vector3::Zero()) return true;
    return false;
}

const char* const of_path_alone = "about the path as stored, between whose nodes the joints may put the bodies elsewhere";

// Doubts the bounds of a certificate of a motion that neither has joints nor says that it is of the path as stored: the worth of bounds of
// moving bodies is known only where the source has no joints.
void doubt_bounds(const core::stepper::Trajectory& trajectory, CheckedCertificate& checked) {
    for (Claim& claim : checked.claims)
        if (moves(trajectory, claim.a) || moves(trajectory, claim.b)) claim.doubt = of_path_alone;
    checked.notes.emplace_back(
        "it has no joints, and does not state that it is about the path as stored: nothing is proven about bodies that move and that "
        "joints hold; make it anew");
}

// Is the source still that of the certificate?
struct SourceCheck {
    std::string source{};    // that it was compared with; empty: with none
    std::string fault{};     // it is stale
    std::string note{};      // what is to be told beside that
    bool has_joints = true;  // as far as is known
};

bool has_deviations(const Certificate& certificate) { return certificate.toleranced && !certificate.toleranced->deviations.empty(); }

bool states_its_domain(const Certificate& certificate) { return certificate.linkage || certificate.toleranced; }

// What ranges or tolerances state, nothing has, as far as is known.
void doubt_domain(CheckedCertificate& checked) {
    const char* const what = has_deviations(*checked.certificate) ? "the tolerances and the joints' ranges" : "the joints' ranges";
    for (Claim& claim : checked.claims)
        claim.doubt =
            std::string("about ") + what + " that the certificate states itself: no scene or design at hand is known to have them";
    checked.notes.push_back(std::string("what it proves is of ") + what +
                            " that it states itself, and of no scene or design: --source FILE says of which it is to be");
}

// The design as made, over what the certificate is.
SourceCheck check_toleranced_source(const Certificate& certificate, const std::string& path, const std::string& source,
                                    const std::string& name, const reading::InputOptions& input) {
    SubjectOptions options;
    options.path = source;
    const std::filesystem::path process = file_of_certificate(path, certificate.process);
    std::error_code ignored;
    options.process = std::filesystem::is_regular_file(process, ignored) ? process.string() : certificate.process;
    options.tolerances = has_deviations(certificate);
    options.kinematic = certificate.toleranced->duration > 0;
    options.time = options.kinematic ? certificate.toleranced->duration : -1;
    options.ranges = !options.kinematic && is_over_ranges(*certificate.toleranced);
    const Result<Subject> subject = read_subject(options, input);
    if (!subject) {
        const Error& error = subject.errors().front();
        return {name, "stale: " + name + ", which it was made from, can no longer be read " +
                          (options.tolerances ? "within tolerances: " : "over its joints' ranges: ") + error.where + ": " + error.message};
    }
    if (core::records::geometry_hash(subject->model) != certificate.geometry_hash)
        return {name, "stale: the meshes of " + name + " have changed since"};
    if (subject->domain.made() && same_toleranced(*subject->domain.made(), *certificate.toleranced)) return {name};
    return {name, "stale: " + std::string(options.tolerances ? "the tolerances of " : "the joints of ") + name +
                      (options.tolerances ? ", its formulas, joints or start poses have changed since"
                                          : ", their limits or the start poses have changed since")};
}

// @param asked  a scene or design in place of the one that the certificate names
SourceCheck check_source(const Certificate& certificate, const std::string& path, const std::string& asked, reading::InputOptions input) {
    const std::string& name = asked.empty() ? certificate.source : asked;
    if (name.empty())
        return {.note = certificate.exports.empty() && !states_its_domain(certificate)
                            ? "it names no scene or design that it was made from: it is about the meshes and start "
                              "poses, and the path, of the trajectory alone"
                            : ""};
    const std::filesystem::path source = asked.empty() ? file_of_certificate(path, name) : std::filesystem::path(asked);
    const std::string untold = ": it cannot be determined whether its meshes have changed since";
    if (!std::filesystem::exists(source)) return {.note = name + ", which it was made from, is not there" + untold};
    input.check_start = false;
    if (input.scenario.empty()) input.scenario = certificate.scenario;
    if (certificate.toleranced) return check_toleranced_source(certificate, path, source.string(), name, input);
    const Result<reading::LoadedModel> loaded = reading::load_model(source.string(), input);
    if (!loaded) {
        const Error& error = loaded.errors().front();
        const std::string why = error.where + ": " + error.message;
        // A file that is not found may be elsewhere (--mesh-dir), a program may not be allowed to run: neither says that something changed.
        if (error.code == ErrorCode::file_not_found || error.code == ErrorCode::unsupported) return {.note = why + untold};
        return {name, "stale: " + name + ", which it was made from, can no longer be read: " + why};
    }
    if (core::records::geometry_hash(loaded->model) != certificate.geometry_hash)
        return {name, "stale: the meshes of " + name + " have changed since"};
    if (certificate.joints) {
        const auto joints = core::clearance::ideal_joints(loaded->model, core::stepper::undriven_bodies(loaded->model));
        if (joints && same_joints(*joints, *certificate.joints)) return {name};
        return {name, "stale: the joints or motors of " + name + " have changed since"};
    }
    if (certificate.motion && loaded->model.mechanism.rows.empty()) return {.source = name, .has_joints = false};
    if (certificate.motion && certificate.is_of_path)
        return {name, "", "its bounds hold for the path as stored, between whose nodes joints may part"};
    if (!certificate.linkage) return {name};
    const auto ranges = core::clearance::joint_ranges(loaded->model);
    const bool same_start = core::records::path_hash(core::clearance::as_assembled(loaded->model)) == certificate.path_hash;
    if (ranges && ranges->linkage == *certificate.linkage && same_start) return {name};
    return {name, "stale: the joints of " + name + ", their limits or the start poses have changed since"};
}

// A certificate of an older version does not say of which of a design's scenarios it is; the first is read unless another one is asked for.
std::string other_scenarios(const std::string& source, const Certificate& certificate, const reading::InputOptions& input) {
    if (!input.scenario.empty() || !certificate.scenario.empty() || !reading::is_design_file(source)) return {};
    const Result<reading::DesignFile> file = reading::read_design(source, {.mesh_dirs = input.mesh_dirs, .programs = input.programs});
    if (!file || file->design.scenarios.size() < 2) return {};
    std::vector<std::string> names;
    for (const description::Scenario& scenario : file->design.scenarios) names.push_back("--scenario " + scenario.name);
    return "; or it is of another scenario than the first, which was read: " + core::base::joined(names);
}

std::vector<CheckedExport> check_exports(const Certificate& certificate, const std::string& path) {
    std::vector<CheckedExport> list;
    for (const core::certificate::ExportedFile& exported : certificate.exports) {
        const Result<std::string> bytes = core::files::read_file(file_of_certificate(path, exported.file));
        const bool is_same = bytes && core::files::hash_of(*bytes) == exported.hash;
        list.push_back({exported.file,
                        !bytes    ? ExportStatus::missing
                        : is_same ? ExportStatus::same
                                  : ExportStatus::changed,
                        exported.rounding});
    }
    return list;
}

std::string note_of(const CheckedExport& exported) {
    if (exported.status == ExportStatus::missing) return exported.file + ", a file of its bodies, is not there or cannot be read";
    if (exported.status == ExportStatus::changed || !(exported.rounding > 0)) return {};
    return exported.file +
           core::base::formatted(": its vertices are rounded by up to %.2g mm; between its parts bounds are wider by twice that",
                                 1000 * exported.rounding);
}

}  // namespace

core::clearance::PairStatus verdict(const Claim& claim, double minimum) {
    using core::clearance::PairStatus;
    if (!claim.doubt.empty()) return PairStatus::undecided;
    if (claim.lower >= minimum && claim.lower > 0 && are_apart(claim.solids)) return PairStatus::clear;
    return claim.upper < minimum ? PairStatus::violated : PairStatus::undecided;
}

std::optional<double> minimum_of(const Claim& claim, const std::optional<double>& asked) { return asked ? asked : claim.minimum; }

std::optional<core::clearance::PairStatus> worst_of(const std::vector<Claim>& claims, const std::optional<double>& asked) {
    using core::clearance::PairStatus;
    std::optional<PairStatus> worst;
    for (const Claim& claim : claims) {
        const std::optional<double> minimum = minimum_of(claim, asked);
        if (!minimum) continue;
        const PairStatus status = verdict(claim, *minimum);
        if (status == PairStatus::violated) return status;
        if (!worst || status == PairStatus::undecided) worst = status;
    }
    return worst;
}

const char* to_string(CertificateStatus status) {
    switch (status) {
        case CertificateStatus::accepted:
            return "accepted";
        case CertificateStatus::stale:
            return "stale";
        case CertificateStatus::rejected:
            break;
    }
    return "rejected";
}

CheckedCertificate check_certificate_file(const std::string& path, const core::records::StoredTrajectory& stored,
                                          const reading::InputOptions& input, const std::string& asked_source) {
    CheckedCertificate checked;
    auto read = core::certificate::read_certificate(path);
    for (const Error& error : read.errors()) checked.faults.push_back({error.where, error.message});
    if (!read) return checked;
    checked.certificate = std::move(read).value();
    const Certificate& certificate = *checked.certificate;
    core::certificate::CertificateReport report = core::certificate::check_certificate(certificate, stored);
    checked.faults = std::move(report.faults);
    checked.leaves = report.leaves;
    checked.claims = claims_of(certificate);
    checked.uncovered = core::certificate::uncovered_pairs(certificate, count_of(stored.model.bodies));
    bool stale = report.stale;
    const auto add_stale = [&](const char* where, const std::string& message) {
        stale = true;
        checked.faults.push_back({where, message});
    };
    const SourceCheck source = check_source(certificate, path, asked_source, input);
    checked.source = source.source;
    if (!source.fault.empty()) {
        const std::string file = asked_source.empty() ? file_of_certificate(path, certificate.source).string() : asked_source;
        add_stale("/source", source.fault + other_scenarios(file, certificate, input));
    }
    if (!source.note.empty()) checked.notes.push_back(source.note);
    if (source.source.empty() && states_its_domain(certificate)) doubt_domain(checked);
    checked.exports = check_exports(certificate, path);
    for (const CheckedExport& exported : checked.exports) {
        if (exported.status == ExportStatus::changed)
            add_stale("/exports", "stale: " + exported.file + ", a file of its bodies, has changed since");
        if (std::string note = note_of(exported); !note.empty()) checked.notes.push_back(std::move(note));
    }
    if (certificate.motion && !certificate.joints && !certificate.is_of_path && source.has_joints) doubt_bounds(stored.trajectory, checked);
    checked.status = checked.faults.empty() ? CertificateStatus::accepted : stale ? CertificateStatus::stale : CertificateStatus::rejected;
    return checked;
}

}  // namespace fettle::design::clearance
