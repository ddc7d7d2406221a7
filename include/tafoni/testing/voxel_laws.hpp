/// \file
/// Law checks for grids of voxels.
#ifndef TAFONI_TESTING_VOXEL_LAWS_HPP
#define TAFONI_TESTING_VOXEL_LAWS_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/concepts.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::laws {

namespace voxels {

template <class G>
[[nodiscard]] std::vector<voxel_state> all_states(G const& g) {
    auto const n = grid_access<G>::size(g);
    std::vector<voxel_state> out;
    out.reserve(n[0] * n[1] * n[2]);
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i) out.push_back(grid_access<G>::state(g, i, j, k));
        }
    }
    return out;
}

/// One of the voxel's neighbours in memory or in space, or any voxel, so that shared words are found.
[[nodiscard]] inline std::array<std::size_t, 3> some_voxel(stream& random, std::array<std::size_t, 3> const& n) {
    std::array<std::size_t, 3> v{};
    for (std::size_t d = 0; d < 3; ++d) v[d] = random.index_below(n[d]);
    return v;
}

}  // namespace voxels

/// Grid: at least one voxel along each axis, positive finite spacing, finite origin, states that exist, the same
/// answers every time and in any order; `bytes`, where offered, says the same. O(voxels).
template <voxel_grid G>
[[nodiscard]] std::vector<std::string> voxel_grid(G const& g) {
    using access = grid_access<G>;
    std::vector<std::string> broken;
    auto const law = [&](bool holds, std::string what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(std::move(what));
    };
    auto const n = access::size(g);
    vec3 const spacing = access::spacing(g);
    vec3 const origin = access::origin(g);
    for (std::size_t d = 0; d < 3; ++d) {
        law(n[d] >= 1, "a grid has at least one voxel along each axis");
        double const s = spacing[static_cast<Eigen::Index>(d)];
        law(s > 0 && s - s == 0, "spacing is positive and finite");
    }
    law(is_finite(origin), "the origin is finite");
    if (!broken.empty()) return broken;
    auto const first = voxels::all_states(g);
    law(std::all_of(first.begin(), first.end(), [](voxel_state s) { return static_cast<std::uint8_t>(s) <= 2; }),
        "states are air, rock or colluvium");
    stream random(1, stage::user, 0);
    for (std::size_t q = 0; q < std::min<std::size_t>(1000, first.size()); ++q) {
        auto const v = voxels::some_voxel(random, n);
        law(access::state(g, v[0], v[1], v[2]) == first[v[0] + n[0] * (v[1] + n[1] * v[2])],
            "a voxel answers the same every time");
    }
    law(voxels::all_states(g) == first, "a voxel answers the same every time");
    law(access::size(g) == n && access::spacing(g) == spacing && access::origin(g) == origin,
        "size, spacing and origin answer the same every time");
    if constexpr (requires { access::bytes(g); }) {
        std::span<std::uint8_t const> const bytes = access::bytes(g);
        law(bytes.size() == first.size() &&
                std::equal(bytes.begin(), bytes.end(), first.begin(),
                           [](std::uint8_t b, voxel_state s) { return b == static_cast<std::uint8_t>(s); }),
            "bytes are the states, x fastest");
    }
    return broken;
}

/// Editable grid: what `voxel_grid` checks; a voxel answers what was last set, every other voxel keeps its state,
/// size, spacing and origin stay. The grid is given back as it was. O(voxels).
template <tafoni::editable_voxel_grid G>
[[nodiscard]] std::vector<std::string> editable_voxel_grid(G& g) {
    using access = grid_access<G>;
    std::vector<std::string> broken = laws::voxel_grid(std::as_const(g));
    if (!broken.empty()) return broken;
    auto const law = [&](bool holds, std::string what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(std::move(what));
    };
    auto const n = access::size(g);
    vec3 const spacing = access::spacing(g);
    vec3 const origin = access::origin(g);
    auto const before = voxels::all_states(std::as_const(g));
    auto now = before;
    stream random(2, stage::user, 0);
    auto const put = [&](std::array<std::size_t, 3> const& v, voxel_state s) {
        access::set(g, v[0], v[1], v[2], s);
        now[v[0] + n[0] * (v[1] + n[1] * v[2])] = s;
        law(access::state(std::as_const(g), v[0], v[1], v[2]) == s, "a voxel answers what was last set");
    };
    for (int round = 0; round < 3; ++round) {
        for (std::size_t q = 0; q < std::min<std::size_t>(4000, 4 * now.size()); ++q) {
            auto v = voxels::some_voxel(random, n);
            put(v, static_cast<voxel_state>(random.index_below(3)));
            std::size_t const axis = random.index_below(3);  // a neighbour, which may share a word
            v[axis] = (v[axis] + 1) % n[axis];
            put(v, static_cast<voxel_state>(random.index_below(3)));
        }
        law(voxels::all_states(std::as_const(g)) == now, "voxels that are not set keep their states");
    }
    std::size_t at = 0;
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i, ++at) access::set(g, i, j, k, before[at]);
        }
    }
    law(voxels::all_states(std::as_const(g)) == before, "voxels that are not set keep their states");
    law(access::size(g) == n && access::spacing(g) == spacing && access::origin(g) == origin,
        "size, spacing and origin do not change under set");
    return broken;
}

}  // namespace tafoni::laws

#endif
