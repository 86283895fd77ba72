// SPDX-License-Identifier: MIT
/// What becomes of a design when its parts are made: of each number that it asks for, how far it spreads over the tolerances, and which of
/// them make it so. Method: docs/method/tolerances.md.
///
/// - **Predicted**, from the derivatives of one simulation: y = y0 + sum g_j d_j over the deviations d_j. With second-order terms the
///   gradients of 2n simulations more, at +-1 standard deviation of each tolerance.
/// - **Worst case**: the extremes of the linear prediction over all deviations within their limits, and, if asked for, those that the
///   optimiser finds by simulations (worst_case.hpp).
/// - **Sampled**: whole simulations at scrambled Sobol points. The same samples for any number of threads; sample k is the same whether
///   there are 100 or 1,000. A sample that cannot be made or simulated (a jam) is counted and kept, never dropped. The predictions are
///   control variates of means and yields (tolerances/control_variate.hpp).
/// - **Contacts**: where predictions miss the samples, which contacts of the farthest one are not those of the design as drawn.
///
/// All of it is computed. Nothing here is proven, but the clearance of each sample by itself.
///
///     const auto file = design::reading::read_design("fit.design.json", {.as_made = true});  // a design with `tolerances`
///     const auto problem = file ? design::problem::DesignProblem::create(file->design) : file.errors();
///     if (!problem) return 3;
///     design::studies::ToleranceOptions options;
///     options.samples = 64;
///     const auto report = design::studies::study_tolerances(*problem, file->tolerances, options);
///     for (const auto& response : report.responses)
///         std::printf("%s: mean %g, sigma %g, worst case %g to %g\n", response.name.c_str(), response.linear.mean,
///                     response.linear.standard_deviation, response.worst.least, response.worst.most);
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/description/independent_inputs.hpp"
#include "design/description/tolerance.hpp"
#include "design/gradient_audit/contact_changes.hpp"
#include "design/problem/design_problem.hpp"
#include "design/studies/made_responses.hpp"
#include "design/studies/sample_file.hpp"
#include "design/studies/worst_case.hpp"
#include "design/tolerances/capability.hpp"
#include "design/tolerances/control_variate.hpp"
#include "design/tolerances/propagation.hpp"
#include "design/tolerances/yield.hpp"

namespace fettle::design::studies {

struct ToleranceOptions {
    int samples = 0;  ///< whole simulations; 0: none
    std::uint64_t seed = 1;
    bool second_order = true;
    bool worst_case = false;            ///< search for the extremes of each response that has bounds
    SampleFile* file = nullptr;         ///< optional: samples that it has are taken from it, others are added; outlives the study
    std::function<bool()> should_stop;  ///< optional
    std::function<void(int done, int of)> on_simulation = {};  ///< optional; called from one thread at a time
};

/// The effect of one tolerance, by itself, on one number, or of what a group of tolerances shares.
struct Contribution {
    std::string of;          ///< the tolerance, or the group
    int tolerance = 0;       ///< -1: of a group
    double sensitivity = 0;  ///< dy/dd, SI; of a group: by one standard deviation of what it shares
    double share = 0;        ///< of the linear variance
    double worst = 0;        ///< |dy/dd| times half the width of its limits; of a group 0, as its members have theirs
};

/// The response over the samples that could be simulated.
struct SampledResponse {
    tolerances::SampleMoments moments;
    tolerances::Capability capability;
    double least = 0, most = 0;
    int least_sample = 0, most_sample = 0;
    int met = 0;          ///< that meet the bounds, by what is proven of them where it is
    double farthest = 0;  ///< largest |sampled - predicted|, by the second order where there is one
    int farthest_sample = 0;
    double unexplained = 0;  ///< root mean square of sampled - predicted, over the samples' standard deviation; 0 where nothing varies
    /// With the prediction as control variate; nothing where there are fewer than 3 samples, or no second order.
    std::optional<tolerances::ControlledMean> controlled_mean;
    /// At `confidence`; nothing too where there are no bounds, or where the count's own interval is no wider: then that one is to be told.
    std::optional<tolerances::CountedYield> controlled_yield;
};
inline constexpr double confidence = 0.95;  ///< of the intervals

/// More than this much of the samples' standard deviation unexplained: the response is not what its derivatives at the design say.
inline constexpr double much_unexplained = 0.05;

struct Response : AskedNumber {
    double nominal = 0;                       ///< as designed
    VectorX gradient;                         ///< per tolerance
    std::vector<Contribution> contributions;  ///< the largest share first
    tolerances::LinearPrediction linear;
    tolerances::LinearWorstCase worst;
    std::optional<FoundExtreme> least_found, most_found;  ///< nothing: not asked for
    tolerances::Yield linear_yield;
    MatrixX curvature;  ///< empty: there is no second order
    /// Its derivatives change so much within a standard deviation, as where a contact begins, that neither order predicts it: samples do.
    bool is_rough = false;
    std::optional<tolerances::Moments> second_order;
    std::optional<tolerances::Yield> second_order_yield;  ///< nothing too where the moments are of no distribution that is known
    std::optional<SampledResponse> sampled;
};
tolerances::RequirementLimits limits_of(const Response& response);
/// By the second order where there is one, else to first order. @param deviations  per tolerance, SI
double predicted(const Response& response, const VectorX& deviations);

/// A mechanism of the samples.
struct MadeSample : SampleOutcome {
    int number = 0;
    VectorX deviations;  ///< per tolerance
};

/// What is in contact elsewhere, or no longer, in one sample: by bodies and sort of change, the earliest first.
struct SwitchedContacts {
    int sample = 0;
    std::vector<int> responses;  ///< that the sample is the farthest of, from their predictions
    std::vector<gradient_audit::ContactChange> changes;
};

struct ToleranceReport {
    std::vector<Response> responses;  ///< objective, constraints, relations
    std::string no_second_order;      ///< why there is none, though it was asked for; empty: there is, or it was not
    std::vector<MadeSample> samples;  ///< that came to an end: simulated or failed; in the order of their numbers
    std::uint64_t seed = 1;           ///< of the samples
    int met_all = 0;                  ///< that meet every requirement
    std::optional<tolerances::CountedYield> controlled_yield;  ///< of all requirements together, as that of one
    std::vector<SwitchedContacts> switched;
    std::vector<std::string> warnings;  ///< of the motions of the design as drawn (problem/motion_warnings.hpp)
    bool interrupted = false;
    std::string reason;  ///< why there is nothing of it: the design as drawn cannot be simulated; empty: there is
};

/// @param problem  The problem of the design as made (description/tolerance.hpp).
ToleranceReport study_tolerances(const problem::DesignProblem& problem, const std::vector<description::Tolerance>& tolerances,
                                 const ToleranceOptions& options = {});

/// The sample that is farthest beyond a bound, in standard deviations of its response; where none is, the one that is nearest to a bound.
struct WorstSample {
    int sample = 0, response = 0;
    bool is_beyond = false;
};
/// Nothing: no sample was simulated, or nothing has a bound and varies.
std::optional<WorstSample> worst_sample(const ToleranceReport& report);

/// Samples that failed for the same reason, but for the numbers in it.
struct FailureKind {
    int first = 0, count = 0;  ///< number of the first, and how many there are
    std::string reason;        ///< of the first
};
/// The most frequent first.
std::vector<FailureKind> kinds_of_failure(const ToleranceReport& report);

/// What would bring a requirement to Cpk 1 by the predicted moments (99.73% of a normal response within two limits, 99.87% within one).
struct Tightening {
    int response = 0;
    double needed = 0;             ///< standard deviation of the response; 0 or less: its mean is beyond a bound, the design has to move
    std::optional<int> tolerance;  ///< the largest contributor, if tightening it alone is enough; else all of them
    double factor = 0;             ///< by which its width, or all widths, are multiplied
};
/// The tightenings of the requirements that have less, in their order; linear in the tolerances' widths.
std::vector<Tightening> what_to_tighten(const ToleranceReport& report);

/// Tolerances that could be twice as wide: no requirement has more than a share of 1% of its variance from them.
std::vector<int> what_may_be_loosened(const ToleranceReport& report, const std::vector<description::Tolerance>& tolerances);

}  // namespace fettle::design::studies
