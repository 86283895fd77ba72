// SPDX-License-Identifier: MIT
#include "core/clearance/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"
#include "core/clearance/body_motions.hpp"
#include "core/clearance/certificate_builder.hpp"
#include "core/clearance/far_pairs.hpp"
#include "core/clearance/near_windows.hpp"
#include "core/clearance/pair_certification.hpp"

namespace fettle::core::clearance {
namespace {

constexpr const char* unusable_numbers = "the numbers of its path are not finite, or larger than 1e30";

// What all pairs of a body share.
struct BodyMotion {
    BodyShape shape;
    std::vector<BodySegment> segments;  // none: its path cannot be measured
};

std::vector<BodyMotion> body_motions(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                                     const std::vector<int>& bodies, const std::vector<BodyShape>& shapes) {
    std::vector<BodyMotion> motions(model.bodies.size());
    const std::vector<char> usable = have_usable_numbers(model, trajectory, places);
    parallel_for(count_of(bodies), 1, [&](int i) {
        const int body = bodies[i];
        motions[body].shape = shapes[body];
        if (usable[body] == 0) return;
        motions[body].segments.reserve(places.size());
        for (const PathPlace& place : places) motions[body].segments.push_back(body_segment(segment_at(trajectory, place, body)));
    });
    return motions;
}

PairMotion pair_motion(const BodyMotion& a, const BodyMotion& b, const stepper::Trajectory& trajectory,
                       const std::vector<PathPlace>& places) {
    PairMotion pair{*a.shape.tree, *b.shape.tree, trajectory, {}, *a.shape.solid, *b.shape.solid};
    for (std::size_t i = 0; i < places.size(); ++i) {
        pair.segments.push_back(pair_segment(a.segments[i], b.segments[i], pair.a.radius(), pair.b.radius()));
        pair.segments.back().step = places[i].step;
        pair.segments.back().segment = places[i].segment;
    }
    return pair;
}

// The minimum of one window: where it is nearest, and whether that is its very beginning or end.
struct WindowMinimum {
    std::optional<Witness> witness;
    bool at_start = false, at_end = false;
};

WindowMinimum window_minimum(PairMotion pair, std::size_t begin, std::size_t end, const SearchOptions& search) {
    const auto at = [&](std::size_t i) { return pair.segments.begin() + static_cast<std::ptrdiff_t>(i); };
    pair.segments = std::vector<PairSegment>(at(begin), at(end));
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    if (!(found.upper <= search.enough)) return {};
    const auto count = count_of(pair.segments);
    return {witness_of(pair, found.nearest), found.nearest.segment == 0 && found.nearest.s == 0,
            found.nearest.segment == count - 1 && found.nearest.s == 1};
}

}  // namespace

const char* to_string(PairStatus status) {
    switch (status) {
        case PairStatus::clear:
            return "clear";
        case PairStatus::violated:
            return "violated";
        case PairStatus::undecided:
            return "undecided";
        case PairStatus::contact:
            return "contact";
    }
    return "unknown";
}

const char* words(Solids solids) {
    switch (solids) {
        case Solids::disjoint:
            return "disjoint solids";
        case Solids::not_closed:
            return "disjoint solids cannot be verified: not closed";
        case Solids::unverified:
            return "one may lie inside the other: not closed";
        case Solids::overlap:
        case Solids::unproven:
            break;
    }
    return "not proven to be apart";
}

const char* why_not_apart(Solids solids) {
    if (solids == Solids::unverified)
        return "whether one lies inside the other cannot be verified: a mesh is not closed, and the other is within what would close it, "
               "or may come there; close the mesh, or say \"mass_per\": \"area\" if it is meant as a sheet";
    return "whether one lies inside the other is a matter of rounding";
}

namespace {

class Certification {
public:
    Certification(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                  const ClearanceOptions& options, certificate::Certificate* record)
        : model_(model),
          trajectory_(trajectory),
          pairs_(pairs),
          options_(options),
          record_(record),
          places_(path_places(trajectory, options.motion)) {}

    std::vector<PairClearance> run() {
        const std::vector<int> bodies = bodies_of(pairs_, count_of(model_.bodies));
        const std::vector<BodyShape> shapes = body_shapes(model_, bodies);
        far_ = far_pairs(model_, trajectory_, places_, pairs_, shapes, options_);
        std::vector<PairRequest> wanted;  // those to look at one by one: a far one too, if its proof is to be recorded
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (far_[i] && !is_recorded()) continue;
            indices_.push_back(static_cast<int>(i));
            wanted.push_back(pairs_[i]);
        }
        motions_ = body_motions(model_, trajectory_, places_, bodies_of(wanted, count_of(model_.bodies)), shapes);
        if (is_recorded()) start_record();
        std::vector<PairClearance> results(pairs_.size());
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (far_[i]) results[i] = *far_[i];
        }
        const auto count = count_of(pairs_), left = count_of(indices_);
        std::mutex report;
        int done = count - left;
        // Each pair is a search of its own: the number of threads cannot change a result.
        parallel_for(left, 1, [&](int k) {
            const auto i = static_cast<std::size_t>(indices_[k]);
            results[i] = certified(i);
            if (!options_.on_pair) return;
            const std::lock_guard<std::mutex> lock(report);
            options_.on_pair(++done, count);
        });
        if (is_recorded()) drop_unmeasured(*record_);
        return results;
    }

private:
    bool is_recorded() const { return record_ != nullptr; }

    void start_record() {
        std::vector<const PieceTree*> trees;
        trees.reserve(motions_.size());
        for (const BodyMotion& motion : motions_) trees.push_back(motion.shape.tree.get());
        certificate::Certificate& certificate = *record_;
        certificate = start_certificate(model_, trajectory_, trees, options_.motion && !trajectory_.steps.empty(), pairs_.size());
        certificate.is_of_path = true;
        certified_ = certified_bodies(certificate, model_);
    }

    PairClearance certified(std::size_t i) const {
        const PairRequest& request = pairs_[i];
        std::optional<PairRecord> record;
        if (is_recorded()) {
            record.emplace(PairRecord{record_->pairs[i], certified_[request.a], certified_[request.b]});
            record->certificate.a = request.a;
            record->certificate.b = request.b;
        }
        const BodyMotion &a = motions_[request.a], &b = motions_[request.b];
        if (a.segments.empty() || b.segments.empty()) return unmeasured(request, unusable_numbers);
        const PairMotion motion = pair_motion(a, b, trajectory_, places_);
        if (far_[i]) {
            const PairClearance known = recorded_far(motion, request, record);
            if (known.lower >= request.far && known.status == PairStatus::clear) return far_pair(request, known.lower, known.solids);
        }
        return certify_pair(motion, request, model_.dmin + model_.dhat, options_, record);
    }

    // With a proof for the certificate, whose claim is less than what is proven by up to the tolerance.
    PairClearance recorded_far(const PairMotion& motion, const PairRequest& request, const std::optional<PairRecord>& record) const {
        ClearanceOptions options = options_;
        options.enough = request.far + options.tolerance;
        options.answer_is_enough = false;
        options.sample_nodes = options.margin_curve = false;
        options.witness_tolerance = 0;
        return certify_pair(motion, request, 0, options, record);
    }

    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    const std::vector<PairRequest>& pairs_;
    const ClearanceOptions& options_;
    certificate::Certificate* record_;  // null: none is wanted
    std::vector<PathPlace> places_;
    std::vector<std::optional<PairClearance>> far_;
    std::vector<int> indices_;  // of the pairs to look at one by one
    std::vector<BodyMotion> motions_;
    std::vector<certificate::CertifiedBody> certified_;
};

std::vector<PairClearance> certify(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options, certificate::Certificate* record) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    return Certification(model, trajectory, pairs, options, record).run();
}

}  // namespace

std::vector<PairClearance> certify(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options) {
    return certify(model, trajectory, pairs, options, nullptr);
}

ProvenClearances certify_with_proof(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options) {
    ProvenClearances proven;
    proven.pairs = certify(model, trajectory, pairs, options, &proven.certificate);
    return proven;
}

ClearanceOptions usual_options(const std::vector<PairRequest>& pairs, std::optional<double> tolerance) {
    ClearanceOptions options;
    options.tolerance = tolerance.value_or(1e-6);
    if (tolerance) return options;
    options.answer_is_enough = true;
    options.coarse = 0.01;
    for (const PairRequest& pair : pairs)
        if (pair.minimum > 0) options.tolerance = std::min(options.tolerance, 1e-3 * pair.minimum);
    return options;
}

namespace {

constexpr int most_body_segments = 1 << 12;  // kept at once, but for those of a single pair: they stay in the processor's caches
constexpr int longest_stretch = 1 << 11;     // of segments, if bodies are many

// Searches the windows one stretch of time after another, and in a stretch some pairs after others: a body's segments are made once for
// all its pairs that follow closely, and forgotten after them.
class WindowSearch {
public:
    WindowSearch(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                 const std::vector<NearWindow>& windows, const ClearanceOptions& options)
        : model_(model), trajectory_(trajectory), places_(places), options_(options), bodies_(model.bodies.size()) {
        std::vector<PairRequest> pairs;
        pairs.reserve(windows.size());
        for (const NearWindow& window : windows) pairs.push_back({window.a, window.b, 0});
        const std::vector<int> bodies = bodies_of(pairs, count_of(model.bodies));
        shapes_ = body_shapes(model, bodies);
        const int length = std::max(longest_stretch, (1 << 17) / std::max(count_of(bodies), 1));
        for (const NearWindow& window : windows) {
            if (!window.measurable) {
                parts_.push_back(window);
                continue;
            }
            for (int first = window.first, last = 0; first < window.last; first = last) {
                const int stretch = first / length;
                last = std::min(window.last, (stretch + 1) * length);
                if (stretches_.size() <= static_cast<std::size_t>(stretch)) stretches_.resize(static_cast<std::size_t>(stretch) + 1);
                stretches_[stretch].push_back(count_of(parts_));
                parts_.push_back({window.a, window.b, first, last});
            }
        }
    }

    std::vector<PairClearance> run() {
        std::vector<PairClearance> results;
        results.reserve(parts_.size());
        for (const NearWindow& part : parts_) results.push_back(unmeasured({part.a, part.b, 0}, unusable_numbers));
        for (const std::vector<int>& stretch : stretches_) {
            begin_stretch(stretch);
            for (std::size_t first = 0, last = 0; first < stretch.size(); first = last) {
                last = make_batch(stretch, first);
                parallel_for(static_cast<int>(last - first), 1, [&](int k) {
                    const int part = stretch[first + static_cast<std::size_t>(k)];
                    results[part] = searched(parts_[part]);
                });
            }
        }
        return results;
    }

private:
    // The part of a body's path from segment `first` on that its windows in a stretch of time need.
    struct Stretch {
        int first = 0, last = 0;
        int batch = -1;                     // that wants it
        std::vector<BodySegment> segments;  // empty: not made

        int count() const { return last - first; }
    };

    Stretch& body(int i) { return bodies_[i]; }

    void begin_stretch(const std::vector<int>& stretch) {
        forget([](const Stretch&) { return true; });
        for (Stretch& known : bodies_) known.first = known.last = 0;
        for (const int index : stretch) {
            const NearWindow& part = parts_[index];
            for (const int i : {part.a, part.b}) {
                const bool is_new = body(i).count() == 0;
                body(i).first = is_new ? part.first : std::min(body(i).first, part.first);
                body(i).last = is_new ? part.last : std::max(body(i).last, part.last);
            }
        }
    }

    template <class Condition>
    void forget(const Condition& condition) {
        for (Stretch& known : bodies_) {
            if (known.segments.empty() || !condition(known)) continue;
            known.segments.clear();
            spare_.push_back(std::move(known.segments));
            known.segments = {};
        }
    }

    // Makes what the parts from `first` on need, as many of them as may be kept at once. @return behind the last of them
    std::size_t make_batch(const std::vector<int>& stretch, std::size_t first) {
        ++batch_;
        std::vector<int> missing;
        std::size_t last = first;
        for (int kept = 0; last < stretch.size(); ++last) {
            const NearWindow& part = parts_[stretch[last]];
            int more = 0;
            for (const int i : {part.a, part.b}) more += body(i).batch == batch_ ? 0 : body(i).count();
            if (last > first && kept + more > most_body_segments) break;
            kept += more;
            for (const int i : {part.a, part.b}) {
                if (body(i).batch == batch_) continue;
                body(i).batch = batch_;
                if (body(i).segments.empty()) missing.push_back(i);
            }
        }
        forget([&](const Stretch& known) { return known.batch != batch_; });
        std::sort(missing.begin(), missing.end());
        make_segments(missing);
        return last;
    }

    void make_segments(const std::vector<int>& missing) {
        for (const int i : missing) {
            if (!spare_.empty()) {
                body(i).segments = std::move(spare_.back());
                spare_.pop_back();
            }
            body(i).segments.reserve(body(i).count());
        }
        const auto count = count_of(missing);
        parallel_for((count + bodies_at_once - 1) / bodies_at_once, 1, [&](int block) {
            const auto from = missing.begin() + block * bodies_at_once,
                       to = missing.begin() + std::min(count, (block + 1) * bodies_at_once);
            int begin = count_of(places_), end = 0;
            for (auto i = from; i != to; ++i) {
                begin = std::min(begin, body(*i).first);
                end = std::max(end, body(*i).last);
            }
            for (int k = begin; k < end; ++k) {
                const PathPlace& place = places_[k];
                for (auto i = from; i != to; ++i) {
                    Stretch& known = body(*i);
                    if (known.first <= k && k < known.last) known.segments.push_back(body_segment(segment_at(trajectory_, place, *i)));
                }
            }
        });
    }

    PairClearance searched(const NearWindow& part) const {
        const BodyShape &shape_a = shapes_[part.a], &shape_b = shapes_[part.b];
        const Stretch &a = bodies_[part.a], &b = bodies_[part.b];
        PairMotion pair{*shape_a.tree, *shape_b.tree, trajectory_, {}, *shape_a.solid, *shape_b.solid};
        pair.segments.reserve(part.last - part.first);
        for (int i = part.first; i < part.last; ++i) {
            const PathPlace& place = places_[i];
            pair.segments.push_back(pair_segment(a.segments[i - a.first], b.segments[i - b.first], pair.a.radius(), pair.b.radius()));
            pair.segments.back().step = place.step;
            pair.segments.back().segment = place.segment;
        }
        return certify_pair(pair, {part.a, part.b, 0}, model_.dmin + model_.dhat, options_, std::nullopt);
    }

    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    const std::vector<PathPlace>& places_;
    const ClearanceOptions& options_;
    std::vector<BodyShape> shapes_;
    std::vector<NearWindow> parts_;            // in the order of the windows
    std::vector<std::vector<int>> stretches_;  // the parts of each
    std::vector<Stretch> bodies_;
    std::vector<std::vector<BodySegment>> spare_;  // memory of what was forgotten
    int batch_ = -1;
};

}  // namespace

namespace {

NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                            double reach, ClearanceOptions options) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    const NearWindows near = near_windows(model, trajectory, places, reach);
    options.enough = std::min(options.enough, reach);
    return {WindowSearch(model, trajectory, places, near.windows, options).run(), near.everything};
}

}  // namespace

NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, double reach, ClearanceOptions options) {
    const std::vector<PathPlace> places = path_places(trajectory, options.motion);
    return certify_near(model, trajectory, places, reach, std::move(options));
}

NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, StepRange steps, double reach,
                            ClearanceOptions options) {
    FETTLE_ASSERT(steps.first >= 0 && steps.first < steps.last && steps.last <= count_of(trajectory.steps), "steps of the trajectory");
    return certify_near(model, trajectory, path_places(trajectory, steps.first, steps.last), reach, std::move(options));
}

std::vector<Witness> nearest_by_window(const model::Model& model, const stepper::Trajectory& trajectory, const PairRequest& pair,
                                       const TimeWindows& windows, double reach, double tolerance) {
    const int steps = windows.last - windows.first;
    FETTLE_ASSERT(windows.first >= 0 && steps > 0 && windows.last <= count_of(trajectory.steps), "windows of the trajectory");
    const std::vector<PathPlace> places = path_places(trajectory, windows.first, windows.last);
    const std::vector<BodyMotion> motions = body_motions(model, trajectory, places, {pair.a, pair.b}, body_shapes(model, {pair.a, pair.b}));
    const BodyMotion &a = motions[pair.a], &b = motions[pair.b];
    if (a.segments.empty() || b.segments.empty()) return {};
    const PairMotion whole = pair_motion(a, b, trajectory, places);
    SearchOptions search;
    search.tolerance = tolerance;
    search.enough = reach;
    const int count = std::clamp(windows.count, 1, steps);
    std::vector<WindowMinimum> minima(count);
    const auto begin_of = [&](int w) {
        const int step = windows.first + static_cast<int>(static_cast<long>(w) * steps / count);
        const auto before = [](const PathPlace& place, int t) { return place.step < t; };
        return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), step, before) - places.begin());
    };
    parallel_for(count, 1, [&](int w) { minima[w] = window_minimum(whole, begin_of(w), begin_of(w + 1), search); });
    std::vector<Witness> witnesses;
    for (int w = 0; w < count; ++w) {
        const WindowMinimum& here = minima[w];
        if (!here.witness) continue;
        const auto is_nearer = [&](int other) {
            return other >= 0 && other < count && minima[other].witness && minima[other].witness->distance <= here.witness->distance;
        };
        if ((here.at_start && is_nearer(w - 1)) || (here.at_end && is_nearer(w + 1))) continue;
        witnesses.push_back(*here.witness);
    }
    return witnesses;
}

stepper::Trajectory as_assembled(const model::Model& model) {
    stepper::Trajectory trajectory;
    trajectory.timestep = model.timestep;
    trajectory.poses.emplace_back();
    for (const model::Body& body : model.bodies) {
        trajectory.body_names.push_back(body.name);
        trajectory.poses.front().push_back(body.pose_start);
    }
    return trajectory;
}

}  // namespace fettle::core::clearance
