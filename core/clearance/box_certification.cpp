// SPDX-License-Identifier: MIT
#include "core/clearance/box_certification.hpp"

#include <algorithm>
#include <mutex>

#include "core/base/parallel.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/pair_certification.hpp"

namespace fettle::core::clearance {

BoxCertification::BoxCertification(const model::Model& model, const std::vector<PairRequest>& pairs, const ClearanceOptions& options,
                                   certificate::Certificate* certificate)
    : model_(model),
      pairs_(pairs),
      options_(options),
      certificate_(certificate),
      start_(as_assembled(model)),
      usable_(have_usable_numbers(model, start_, {{}})),
      shapes_(body_shapes(model, bodies_of(pairs, count_of(model.bodies)))) {}

std::vector<PairClearance> BoxCertification::run() {
    if (is_recorded()) {
        std::vector<const PieceTree*> trees;
        for (const BodyShape& shape : shapes_) trees.push_back(shape.tree.get());
        *certificate_ = start_certificate(model_, start_, trees, false, pairs_.size());
        name_box(*certificate_);
    }
    std::vector<PairClearance> results(pairs_.size());
    std::mutex report;
    int done = 0;
    const auto count = count_of(pairs_);
    base::parallel_for(count, 1, [&](int i) {
        const PairRequest& asked = pairs_[i];
        const bool stopped = options_.should_stop && options_.should_stop();
        results[i] =
            stopped ? unmeasured(asked, "the search was cut short, by a stop or its budget") : certified(static_cast<std::size_t>(i));
        if (!options_.on_pair) return;
        const std::lock_guard<std::mutex> lock(report);
        options_.on_pair(++done, count);
    });
    if (is_recorded()) drop_unmeasured(*certificate_);
    return results;
}

std::string BoxCertification::obstacle(const PairRequest& request, int coordinates) const {
    if (coordinates > certificate::most_coordinates)
        return std::to_string(coordinates) + " coordinates move the two against each other; at most " +
               std::to_string(certificate::most_coordinates) + " can be looked at together";
    if (!usable_[request.a] || !usable_[request.b]) return "its numbers are not finite, or larger than 1e30";
    return {};
}

BoxSearchOptions BoxCertification::search_options(PairClearance& out, int coordinates, double size, long second) const {
    out.tolerance = coordinates > 2 && options_.coarse > 0 ? std::max(options_.tolerance, options_.coarse * size) : options_.tolerance;
    BoxSearchOptions search;
    search.tolerance = is_recorded() ? 0.75 * out.tolerance : out.tolerance;
    search.stop = {out.minimum, options_.answer_is_enough, second / 2, second};
    search.max_bounds = options_.max_bounds;
    search.should_stop = options_.should_stop;
    return search;
}

double BoxCertification::make_claim(double slack, PairClearance& out) const {
    const double gap = std::max(0.0, out.upper - out.lower);
    double room = (options_.answer_is_enough ? gap : std::min(out.tolerance, gap)) / 8 + 8 * slack;
    const double above = out.lower - (out.minimum < out.lower ? out.minimum : 0);  // a claim keeps what was decided, if it can
    room = std::max(8 * slack, std::min(room, 0.5 * above));
    out.lower = out.lower > room ? out.lower - room : 0;
    return room;
}

void BoxCertification::finish(std::size_t pair, double charge, PairClearance& out, const stepper::Trajectory* place) const {
    if (!out.intersecting && out.lower > 0) {
        certificate::PairStart at{place != nullptr ? *place : start_, -1, 0, out.a, out.b};
        at.charge = charge;
        out.solids = certificate::solids_of(*shapes_[out.a].solid, *shapes_[out.b].solid, at, out.lower);
        if (out.solids == Solids::overlap) out.lower = out.upper = 0;
    }
    if (is_recorded()) record(pair).solids = out.is_clash() ? Solids::unproven : out.solids;
    judge(out, {out.a, out.b, out.minimum}, 0, false);
}

}  // namespace fettle::core::clearance
