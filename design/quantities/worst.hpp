// SPDX-License-Identifier: MIT
/// The worst of several quantities, such as one in all of a design's scenarios:
///   q = max_i q_i   (to be made small),   q = min_i q_i   (to be made large)
/// It has a kink where two are equal. Its derivative is that of the one that it is; the others are its branches, which the optimisers that
/// know of branches take as constraints, so that no maximum is differentiated (docs/method/design.md).
#pragma once

#include <memory>
#include <vector>

#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

class Worst : public description::Quantity {
public:
    /// Contract: one part at least, all of one dimension.
    Worst(std::vector<std::shared_ptr<const Quantity>> parts, bool greatest);

    const std::vector<std::shared_ptr<const Quantity>>& parts() const { return parts_; }
    bool greatest() const { return greatest_; }
    Dimension dimension() const override { return parts_.front()->dimension(); }
    description::QuantityFacts facts() const override;
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// Those of its parts, each with branches of its own where these are of the same kind; the one that the value is comes first.
    std::vector<description::Branch> branches(const description::Simulated& simulated, const description::Measurement& measured,
                                              double limit) const override;
    bool is_greatest_branch() const override { return greatest_; }
    /// That of the first of its parts that has one.
    std::string doubt(const description::Simulated& simulated, const description::Measurement& measured) const override;
    bool is_at_rest() const override;
    bool is_about(int scenario) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    /// The first of those that it is equal to.
    int worst(const description::Measurement& measured) const;

    std::vector<std::shared_ptr<const Quantity>> parts_;
    bool greatest_;
};

}  // namespace fettle::design::quantities
