/// \file
/// Fast answers to "is this point in the solid?" for many points.
#ifndef TAFONI_GEOMETRY_INSIDE_COLUMNS_HPP
#define TAFONI_GEOMETRY_INSIDE_COLUMNS_HPP

#include <tafoni/geometry/winding_number.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

/// The triangles of a solid, sorted into columns along z. Exact, like `winding_number`, and faster
/// from about ten points on. Views the solid, which must outlive it.
class inside_columns {
public:
    /// O(triangles); at most about eight entries per triangle are kept.
    explicit inside_columns(solid const& s) : solid_(&s) {
        std::size_t const n = s.triangles.size();
        std::size_t const most = 8 * n + 64;
        side_ = 1;
        while (side_ < 1024 && side_ * side_ < n) side_ *= 2;
        while (side_ > 1 && entries(most) > most) side_ /= 2;
        begin_.assign(side_ * side_ + 1, 0);
        each_entry([&](std::size_t column, std::uint32_t) { ++begin_[column + 1]; });
        for (std::size_t c = 0; c < side_ * side_; ++c) begin_[c + 1] += begin_[c];
        triangles_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        each_entry([&](std::size_t column, std::uint32_t t) { triangles_[next[column]++] = t; });
    }

    /// Same as `winding_number(s, p)`. O(triangles of one column).
    [[nodiscard]] int winding(vec3 const& p) const noexcept {
        if (!solid_->bounds.contains(p)) return 0;
        std::size_t const c = column_of(p[0], 0) + side_ * column_of(p[1], 1);
        int sum = 0;
        for (std::size_t e = begin_[c]; e < begin_[c + 1]; ++e) {
            auto const& t = solid_->triangles[triangles_[e]];
            sum += detail::upward_crossing(solid_->positions[t[0]], solid_->positions[t[1]], solid_->positions[t[2]], p);
        }
        return sum;
    }

    /// True where the winding number is positive. Points on the surface get the answer of one side.
    [[nodiscard]] bool contains(vec3 const& p) const noexcept { return winding(p) > 0; }

private:
    /// Monotone in x, so that a triangle's columns are those between the ends of its box.
    [[nodiscard]] std::size_t column_of(double x, int axis) const noexcept {
        double const lo = solid_->bounds.lo[axis];
        double const extent = solid_->bounds.hi[axis] - lo;
        double const u = extent > 0 ? (x - lo) / extent * static_cast<double>(side_) : 0.0;
        auto const i = u > 0 ? static_cast<std::size_t>(u) : std::size_t{0};
        return i < side_ ? i : side_ - 1;
    }

    [[nodiscard]] std::array<std::size_t, 4> columns_of(std::uint32_t t) const noexcept {
        auto const& c = solid_->triangles[t];
        std::array<std::size_t, 4> r{};
        for (int axis = 0; axis < 2; ++axis) {
            double const a = solid_->positions[c[0]][axis];
            double const b = solid_->positions[c[1]][axis];
            double const d = solid_->positions[c[2]][axis];
            auto const i = static_cast<std::size_t>(2 * axis);
            r[i] = column_of(std::min(a, std::min(b, d)), axis);
            r[i + 1] = column_of(std::max(a, std::max(b, d)), axis);
        }
        return r;
    }

    [[nodiscard]] std::size_t entries(std::size_t most) const noexcept {
        std::size_t sum = 0;
        for (std::uint32_t t = 0; t < solid_->triangles.size() && sum <= most; ++t) {
            auto const r = columns_of(t);
            sum += (r[1] - r[0] + 1) * (r[3] - r[2] + 1);
        }
        return sum;
    }

    template <class F>
    void each_entry(F const& f) const {
        for (std::uint32_t t = 0; t < solid_->triangles.size(); ++t) {
            auto const r = columns_of(t);
            for (std::size_t y = r[2]; y <= r[3]; ++y) {
                for (std::size_t x = r[0]; x <= r[1]; ++x) f(x + side_ * y, t);
            }
        }
    }

    solid const* solid_;
    std::size_t side_ = 1;
    std::vector<std::size_t> begin_{};
    std::vector<std::uint32_t> triangles_{};
};

}  // namespace tafoni

#endif
