/// \file
/// Rock in motion, counted in whole units.
#ifndef TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP
#define TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Volumes as multiples of one power of two, so that sums are exact in any order.
class volume_unit {
public:
    volume_unit() = default;
    /// 2^-50 of a volume that nothing in the scene exceeds.
    explicit volume_unit(double largest) noexcept {
        int exponent = 0;
        (void)std::frexp(largest > 0 ? largest : 1.0, &exponent);
        unit_ = std::ldexp(1.0, exponent - 50);
        inverse_ = 1 / unit_;
    }
    /// Nearest; what is beyond 2^60 units is cut there.
    [[nodiscard]] std::int64_t fixed(double volume) const noexcept {
        double const n = std::floor(volume * inverse_ + 0.5);
        return static_cast<std::int64_t>(std::clamp(n, -0x1p60, 0x1p60));
    }
    [[nodiscard]] double volume(std::int64_t units) const noexcept { return static_cast<double>(units) * unit_; }

private:
    double unit_ = 1;
    double inverse_ = 1;
};

/// Who holds what: particles by id, vertices what they owe (below 0) or are owed.
struct sediment_books {
    std::unordered_map<std::uint64_t, std::int64_t> load{};  ///< never walked in its own order but to sum
    std::vector<std::int64_t> due{};                         ///< per vertex
    std::int64_t eroded = 0;
    std::int64_t deposited = 0;
    std::int64_t left = 0;

    [[nodiscard]] std::int64_t carried() const noexcept {
        std::int64_t sum = 0;
        for (auto const& [id, v] : load) sum += v;
        for (std::int64_t const v : due) sum += v;
        return sum;
    }
    [[nodiscard]] bool balanced() const noexcept { return eroded == deposited + carried() + left; }

    /// What particles that are gone carried has left the scene. `alive(id)` tells.
    template <class Alive>
    void drop_gone(Alive const& alive) {
        for (auto i = load.begin(); i != load.end();) {
            if (alive(i->first)) {
                ++i;
            } else {
                left += i->second;
                i = load.erase(i);
            }
        }
    }
};

/// Moves vertices along their normals by the volume that they owe or are owed, one after the other by number, no
/// farther than `most`; books what the surface really changed by, and keeps the rest due [thesis, 8.3, signed].
/// Adds the way to `wear`. Returns the vertices that moved. O(vertices + faces at those that move).
inline std::size_t settle_accounts(std::vector<vec3>& positions, std::span<std::array<std::uint32_t, 3> const> triangles,
                                   vertex_rings const& rings, volume_unit const& unit, double most, sediment_books& books,
                                   std::vector<double>& wear) {
    std::size_t moved = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (books.due[v] == 0) continue;
        // Six times the volume per length along a is a . (sum of the cross products of the sides at v).
        vec3 const p = positions[v];
        vec3 sum{0, 0, 0};
        for (auto const& c : rings.faces(v)) {
            auto const& t = triangles[c.face];
            vec3 const a{positions[t[(c.place + 1) % 3]] - p};
            vec3 const b{positions[t[(c.place + 2) % 3]] - p};
            sum += cross(a, b);
        }
        double const area = length(sum);
        if (!(area > 0)) continue;
        double const per_length = area / 6;
        double const wanted = unit.volume(books.due[v]) / per_length;
        double const d = std::clamp(wanted, -most, most);
        vec3 const to{p[0] + d / area * sum[0], p[1] + d / area * sum[1], p[2] + d / area * sum[2]};
        vec3 const way{to - p};
        std::int64_t booked = unit.fixed(dot(way, sum) / 6);
        if (d == wanted) booked = books.due[v];  // the rest is rounding
        if (booked == 0) continue;
        positions[v] = to;
        wear[v] += length(way);
        books.due[v] -= booked;
        (booked < 0 ? books.eroded : books.deposited) += booked < 0 ? -booked : booked;
        ++moved;
    }
    return moved;
}

}  // namespace tafoni::detail

#endif
