/// \file
/// The planes that may bound a Voronoi cell, near ones first, in single precision.
#ifndef TAFONI_DECOMPOSITION_DETAIL_NEAR_PLANES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_NEAR_PLANES_HPP

#include <tafoni/decomposition/detail/cell_lanes.hpp>
#include <tafoni/decomposition/detail/near_sites.hpp>
#include <tafoni/decomposition/detail/plane_corner.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
#else
inline namespace baseline {
#endif

/// Candidate planes of one cell, in shells of growing distance. Lengths are in units of 1 / `scale`,
/// about the distance of neighbours, relative to the cell's site. Only a filter: a coordinate is off
/// by up to 2^-21 of `extent`.
class near_planes {
public:
    static constexpr std::size_t capacity = 512;
    static constexpr std::size_t shells = 64;
    static constexpr std::size_t none = capacity;

    /// The sites of `sites` within `reach`, but for the places in [skip, skip_end), and the walls `walls` times
    /// as near. False when there are too many. O(sites).
    [[nodiscard]] bool fill(near_sites const& sites, std::size_t skip, std::size_t skip_end, ivec3 const& at,
                            float reach, float slack, lattice_box const& box,
                            std::uint32_t wall_id) {
        std::size_t const n = sites.size();
        if (distance2_.size() < n) {
            distance2_.resize(2 * n);
            queue_.resize(2 * n);
        }
        auto const [ox, oy, oz] = sites.relative(at);
        float const* const x = sites.x();
        float const* const y = sites.y();
        float const* const z = sites.z();
        float* const d2 = distance2_.data();
        for (std::size_t k = 0; k < n; ++k) {
            float const dx = x[k] - ox;
            float const dy = y[k] - oy;
            float const dz = z[k] - oz;
            d2[k] = dx * dx + dy * dy + dz * dz;
        }
        for (std::size_t k = skip; k < skip_end; ++k) d2[k] = std::numeric_limits<float>::infinity();
        reach2_ = reach * reach;
        slack_ = slack;
        per_shell_ = static_cast<float>(shells - 1) / reach2_;
        end_.fill(0);
        std::size_t count = 0;
        for (std::size_t k = 0; k < n; ++k) {
            queue_[count] = static_cast<std::uint32_t>(k);
            count += static_cast<std::size_t>(d2[k] <= reach2_);
        }
        if (count + 6 > capacity) return false;
        for (std::size_t k = 0; k < count; ++k) ++end_[shell(d2[queue_[k]]) + 1];
        std::array<float, 6> gap{};
        for (std::uint32_t w = 0; w < 6; ++w) {
            std::size_t const a = w / 2;
            gap[w] = static_cast<float>(static_cast<double>(w % 2 != 0 ? box.hi[a] - at[a] : at[a] - box.lo[a]) * sites.scale());
            if (gap[w] <= 0.5F * reach) ++end_[shell(4 * gap[w] * gap[w]) + 1];
        }
        for (std::size_t k = 0; k < shells; ++k) end_[k + 1] += end_[k];
        count_ = end_[shells];
        for (std::size_t k = 0; k < count; ++k) {
            std::uint32_t const s = queue_[k];
            put(end_[shell(d2[s])]++, x[s] - ox, y[s] - oy, z[s] - oz, 0.5F * d2[s], sites.id(s));
        }
        for (std::uint32_t w = 0; w < 6; ++w) {
            if (!(gap[w] <= 0.5F * reach)) continue;
            std::array<float, 3> e{0, 0, 0};
            e[w / 2] = w % 2 != 0 ? 1.0F : -1.0F;
            put(end_[shell(4 * gap[w] * gap[w])]++, e[0], e[1], e[2], gap[w], wall_id + w);
        }
        for (std::size_t k = count_; k < count_ + float_lanes; ++k) put(k, 0, 0, 0, std::numeric_limits<float>::max(), 0);
        return true;
    }

    /// A count that takes in all planes less than r from the site (r2 = r^2), or twice that of a bisector's site.
    [[nodiscard]] std::size_t within(float r2) const noexcept { return end_[shell(std::min(4.001F * r2 + slack_, reach2_))]; }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint32_t id(std::size_t k) const noexcept { return id_[k]; }

    /// The plane that a ray from `v` along `d` meets first, among the first `n` and those that it does not almost run along.
    [[nodiscard]] std::size_t first_hit(std::array<float, 3> const& v, std::array<float, 3> const& d, float flat,
                                        std::size_t n) const noexcept {
        float_vector best = float_vector{} + std::numeric_limits<float>::infinity();
        int_vector place = int_vector{} + static_cast<std::int32_t>(none);
        int_vector here{};
        for (std::int32_t k = 0; k < static_cast<std::int32_t>(float_lanes); ++k) here[static_cast<std::size_t>(k)] = k;
        for (std::size_t k = 0; k < n; k += float_lanes) {
            float_vector const x = load_floats(x_.data() + k);
            float_vector const y = load_floats(y_.data() + k);
            float_vector const z = load_floats(z_.data() + k);
            float_vector const gap = load_floats(h_.data() + k) - (x * v[0] + y * v[1] + z * v[2]);
            float_vector const speed = x * d[0] + y * d[1] + z * d[2];
            float_vector const time = gap / speed;
            int_vector const better = (speed > flat) & (time < best);
            best = better ? time : best;
            place = better ? here : place;
            here += static_cast<std::int32_t>(float_lanes);
        }
        std::size_t result = none;
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < float_lanes; ++k) {
            if (best[k] < least) {
                least = best[k];
                result = static_cast<std::size_t>(place[k]);
            }
        }
        return result;
    }

    /// How many of the first `n` planes have `v` beyond them, or not `margin` before them.
    [[nodiscard]] std::size_t count_near(std::array<float, 3> const& v, float margin, std::size_t n) const noexcept {
        int_vector sum{};
        for (std::size_t k = 0; k < n; k += float_lanes) sum -= ahead(v, k) > -margin;
        std::int32_t count = 0;
        for (std::size_t k = 0; k < float_lanes; ++k) count += sum[k];
        return static_cast<std::size_t>(count);
    }

    /// Calls visit(k) for these planes until it returns true. True when one did.
    template <class Visit>
    [[nodiscard]] bool any_near(std::array<float, 3> const& v, float margin, std::size_t n, Visit const& visit) const {
        for (std::size_t k = 0; k < n; k += float_lanes) {
            int_vector const reached = ahead(v, k) > -margin;
            if (!any_lane(reached)) continue;
            for (std::size_t l = 0; l < float_lanes; ++l) {
                if (reached[l] != 0 && k + l < count_ && visit(k + l)) return true;
            }
        }
        return false;
    }

private:
    [[nodiscard]] float_vector ahead(std::array<float, 3> const& v, std::size_t k) const noexcept {
        return load_floats(x_.data() + k) * v[0] + load_floats(y_.data() + k) * v[1] + load_floats(z_.data() + k) * v[2] -
               load_floats(h_.data() + k);
    }
    [[nodiscard]] std::size_t shell(float d2) const noexcept {
        return static_cast<std::size_t>(static_cast<std::int32_t>(d2 * per_shell_));
    }
    void put(std::size_t k, float x, float y, float z, float h, std::uint32_t id) noexcept {
        x_[k] = x;
        y_[k] = y;
        z_[k] = z;
        h_[k] = h;
        id_[k] = id;
    }

    std::size_t count_ = 0;
    float reach2_ = 0;
    float slack_ = 0;
    float per_shell_ = 0;
    std::array<std::uint32_t, shells + 1> end_{};
    alignas(32) std::array<float, capacity + 16> x_{};
    alignas(32) std::array<float, capacity + 16> y_{};
    alignas(32) std::array<float, capacity + 16> z_{};
    alignas(32) std::array<float, capacity + 16> h_{};
    std::array<std::uint32_t, capacity + 16> id_{};
    std::vector<float> distance2_;
    std::vector<std::uint32_t> queue_;
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
