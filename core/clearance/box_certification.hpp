// SPDX-License-Identifier: MIT
/// The part of certifying pairs of bodies over a box of variables that is the same for joint coordinates (range_clearance.hpp) and for
/// these and deviations (toleranced_clearance.hpp): the pairs in parallel, those that cannot be looked at, options of the search
/// (box_search.hpp), the claim that a certificate makes, the solids, the verdict.
#pragma once

#include <string>
#include <vector>

#include "core/clearance/body_motions.hpp"
#include "core/clearance/box_search.hpp"
#include "core/clearance/certificate_builder.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

class BoxCertification {
public:
    /// @param certificate  null: none is wanted. What is given must stay where it is.
    BoxCertification(const model::Model& model, const std::vector<PairRequest>& pairs, const ClearanceOptions& options,
                     certificate::Certificate* certificate);
    virtual ~BoxCertification() = default;

    /// In the order of the pairs. Each is a search of its own: the number of threads cannot change a result.
    std::vector<PairClearance> run();

protected:
    virtual PairClearance certified(std::size_t pair) const = 0;
    /// What a certificate is about, beside the bodies.
    virtual void name_box(certificate::Certificate& certificate) const = 0;

    const ClearanceOptions& options() const { return options_; }
    bool is_recorded() const { return certificate_ != nullptr; }
    const PairRequest& request(std::size_t pair) const { return pairs_[pair]; }
    certificate::PairCertificate& record(std::size_t pair) const { return certificate_->pairs[pair]; }
    const BodyShape& shape(int body) const { return shapes_[body]; }
    const kinematics::Pose& start(int body) const { return start_.poses.front()[body]; }

    /// Why a pair that so many coordinates move cannot be looked at; empty: it can.
    std::string obstacle(const PairRequest& request, int coordinates) const;
    /// @param size  Size of the two bodies [m]: with more than two coordinates options' `coarse` share of it is enough.
    /// @param second  About how many bounds take a second.
    BoxSearchOptions search_options(PairClearance& out, int coordinates, double size, long second) const;

    template <class Found>
    static void take_bounds(const Found& found, PairClearance& out) {
        out.lower = found.lower;
        out.upper = found.upper;
        out.complete = found.complete;
        out.intersecting = found.intersecting;
        out.bounds = found.bounds;
    }

    /// Lowers out.lower to the claim: below the bound that was found by a room for the order in which a proof goes through its cells, and
    /// for a checker's rounding, but above the minimum, where that was decided. @return the room
    double make_claim(double slack, PairClearance& out) const;

    /// Surfaces that never meet leave one thing to ask, whose answer is the same everywhere in the box: are the solids apart? Then the
    /// verdict.
    /// @param charge  How far the bodies at hand may be off from those of the box [m]
    /// @param place   a place in the box, as a path that stands there; null: the start, which is in it
    void finish(std::size_t pair, double charge, PairClearance& out, const stepper::Trajectory* place = nullptr) const;
    const stepper::Trajectory& start() const { return start_; }

    const model::Model& model_;

private:
    const std::vector<PairRequest>& pairs_;
    const ClearanceOptions& options_;
    certificate::Certificate* certificate_;
    const stepper::Trajectory start_;
    const std::vector<char> usable_;  // [body]
    const std::vector<BodyShape> shapes_;
};

}  // namespace fettle::core::clearance
