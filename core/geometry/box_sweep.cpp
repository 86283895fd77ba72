// SPDX-License-Identifier: MIT
#include "core/geometry/box_sweep.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/four.hpp"

namespace fettle::core::geometry {
namespace {

using base::Four;
using base::lanes;

// The axis along which the middles of the boxes are spread widest.
int widest_axis(const std::vector<Box>& boxes, const std::vector<int>& some) {
    Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
    for (const int i : some) {
        const Box& box = boxes[i];
        const Eigen::Array3d middle = box.low.array() / 2 + box.high.array() / 2;
        sum += middle;
        squares += middle.square();
    }
    int axis = 0;
    if (!some.empty()) (squares - sum.square() / static_cast<double>(some.size())).maxCoeff(&axis);
    return axis;
}

}  // namespace

struct BoxSweep::Ends {
    const BoxSweep& sweep;
    double reach;

    const double* low(std::size_t axis) const { return sweep.ends_.data() + axis * sweep.length_; }
    const double* high(std::size_t axis) const { return low(axis + 3); }

    [[gnu::always_inline]] inline void find(int begin, int end, Pairs& out) const {
        const auto count = count_of(sweep.order_);
        for (int i = begin; i < end; ++i) {
            const std::array<double, 3> x_low{low(0)[i], low(1)[i], low(2)[i]}, x_high{high(0)[i], high(1)[i], high(2)[i]};
            for (int j = i + 1; j < count; j += lanes) {
                if (low(0)[j] - x_high[0] >= reach) break;  // nor do later ones begin before it ends
                auto is_apart = Four{0, 0, 0, 0} != 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    Four y_low, y_high;
                    base::load(low(k) + j, y_low);
                    base::load(high(k) + j, y_high);
                    is_apart |= (y_low - x_high[k] >= reach) | (x_low[k] - y_high >= reach);
                }
                if ((is_apart[0] & is_apart[1] & is_apart[2] & is_apart[3]) != 0) continue;
                for (int lane = 0; lane < std::min(lanes, count - j); ++lane)
                    if (is_apart[lane] == 0) add(i, j + lane, out);
            }
        }
    }
    FETTLE_WIDE void find_wide(int begin, int end, Pairs& out) const { find(begin, end, out); }

private:
    void add(int i, int j, Pairs& out) const {
        const int a = sweep.order_[i], b = sweep.order_[j];
        out.emplace_back(std::min(a, b), std::max(a, b));
    }
};

BoxSweep::BoxSweep(const std::vector<Box>& boxes, std::vector<int> some) : order_(std::move(some)), length_(order_.size() + lanes) {
    const int axis = widest_axis(boxes, order_);
    struct Begin {
        double low;
        int box;
    };
    std::vector<Begin> begins(order_.size());
    for (std::size_t i = 0; i < begins.size(); ++i) begins[i] = {boxes[order_[i]].low[axis], order_[i]};
    std::sort(begins.begin(), begins.end(), [](const Begin& x, const Begin& y) { return x.low != y.low ? x.low < y.low : x.box < y.box; });
    ends_.resize(6 * length_);
    for (std::size_t i = 0; i < begins.size(); ++i) {
        order_[i] = begins[i].box;
        const Box& box = boxes[order_[i]];
        for (int k = 0; k < 3; ++k) {
            ends_[static_cast<std::size_t>(k) * length_ + i] = box.low[(axis + k) % 3];
            ends_[static_cast<std::size_t>(k + 3) * length_ + i] = box.high[(axis + k) % 3];
        }
    }
}

void BoxSweep::find(int begin, int end, double reach, Pairs& out) const {
    const Ends ends{*this, reach};
    base::has_wide_instructions() ? ends.find_wide(begin, end, out) : ends.find(begin, end, out);
}

}  // namespace fettle::core::geometry
