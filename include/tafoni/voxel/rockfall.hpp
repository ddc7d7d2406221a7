/// \file
/// Rock that nothing holds falls.
#ifndef TAFONI_VOXEL_ROCKFALL_HPP
#define TAFONI_VOXEL_ROCKFALL_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/detail/joint_planes.hpp>
#include <tafoni/voxel/fallen_block.hpp>
#include <tafoni/voxel/rockfall_options.hpp>
#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/voxel/voxel_change.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// Rock not connected to the ground by faces of rock falls, as whole pieces [Jones et al., section 4].
///
/// Colluvium neither carries nor connects rock. Pieces that were loose before the first call fall in it; `loose` tells
/// them beforehand. Follows one grid from call to call; a copy follows a copy of the grid.
class rockfall {
public:
    rockfall() = default;
    /// \throws invalid_input  as `rockfall_options::validate`.
    explicit rockfall(rockfall_options options) : options_((options.validate(), std::move(options))) {
        for (joint_disc const& d : options_.joints.discs) planes_.push_back(detail::joint_plane::of(d));
    }

    [[nodiscard]] rockfall_options const& options() const noexcept { return options_; }

    /// The pieces that would fall from a grid seen for the first time, by their lowest voxels. O(voxels).
    template <executor Executor>
    [[nodiscard]] std::vector<std::vector<voxel>> loose(sparse_grid const& grid, Executor const&) const {
        std::vector<std::vector<voxel>> out;
        auto const& n = grid.size();
        auto const id = [&](voxel v) {
            return static_cast<std::size_t>(v.x) + n[0] * (static_cast<std::size_t>(v.y) + n[1] * static_cast<std::size_t>(v.z));
        };
        std::vector<bool> seen(n[0] * n[1] * n[2]);
        bool ground = false;
        std::vector<bool> held;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            voxel const v{static_cast<std::int32_t>(i % n[0]), static_cast<std::int32_t>(i / n[0] % n[1]),
                          static_cast<std::int32_t>(i / n[0] / n[1])};
            if (seen[i] || !grid.is_rock(v)) continue;
            std::vector<voxel> piece{v};
            seen[i] = true;
            bool stands = false;
            for (std::size_t at = 0; at < piece.size(); ++at) {
                voxel const p = piece[at];
                stands = stands || is_ground(grid, p);
                for (int a = 0; a < 6; ++a) {
                    voxel q = p;
                    (a / 2 == 0 ? q.x : a / 2 == 1 ? q.y : q.z) += a % 2 == 0 ? -1 : 1;
                    if (!grid.contains(q) || seen[id(q)] || !grid.is_rock(q) || is_cut(grid, p, q)) continue;
                    seen[id(q)] = true;
                    piece.push_back(q);
                }
            }
            std::sort(piece.begin(), piece.end());
            ground = ground || stands;
            held.push_back(stands);
            out.push_back(std::move(piece));
        }
        if (!ground && !out.empty()) {
            std::size_t best = 0;
            for (std::size_t p = 1; p < out.size(); ++p) {
                if (out[p].size() > out[best].size()) best = p;
            }
            held[best] = true;
        }
        std::size_t kept = 0;
        for (std::size_t p = 0; p < out.size(); ++p) {
            if (!held[p]) std::swap(out[kept++], out[p]);
        }
        out.resize(kept);
        return out;
    }

    /// Lets fall what stands no more: its voxels become air.
    /// \param removed  voxels that were rock after the last call and are not now; any order. Not read in the
    ///                 first call, which looks at the whole grid.
    /// \param changes  gets rock -> air appended, each voxel once, in voxel order.
    /// \return  the pieces by their lowest voxels.
    template <executor Executor>
    std::vector<fallen_block> fall(sparse_grid& grid, std::span<voxel const>, std::uint64_t step,
                                   Executor const& threads, std::vector<voxel_change>& changes) {
        std::vector<fallen_block> out;
        std::size_t const first = changes.size();
        for (auto& piece : loose(grid, threads)) {
            for (voxel const v : piece) {
                grid.set(v, voxel_state::air);
                changes.push_back({v, voxel_state::rock, voxel_state::air});
            }
            out.push_back({step, std::move(piece)});
        }
        std::sort(changes.begin() + static_cast<std::ptrdiff_t>(first), changes.end(),
                  [](voxel_change const& a, voxel_change const& b) { return a.at < b.at; });
        return out;
    }

private:
    [[nodiscard]] bool is_ground(sparse_grid const& grid, voxel v) const {
        std::array<std::int32_t, 3> const at{v.x, v.y, v.z};
        for (std::size_t s = 0; s < 6; ++s) {
            auto const last = static_cast<std::int32_t>(grid.size()[s / 2]) - 1;
            if (at[s / 2] != (s % 2 == 0 ? 0 : last)) continue;
            std::size_t const user = 2U * grid.rotation().axis[s / 2] + ((s % 2 == 1) != grid.rotation().mirrored[s / 2] ? 1U : 0U);
            if (options_.sides[user] == ground_side::ground) return true;
            if (options_.sides[user] == ground_side::by_border && s != 5 && grid.border().sides[s] != border_kind::air) return true;
        }
        voxel const u = grid.to_user(v);
        for (voxel const g : options_.ground_voxels) {
            if (g == u) return true;
        }
        return options_.ground_where && options_.ground_where(grid.centre(v));
    }
    [[nodiscard]] bool is_cut(sparse_grid const& grid, voxel p, voxel q) const {
        for (detail::joint_plane const& plane : planes_) {
            if (plane.cuts(grid.centre(p), grid.centre(q))) return true;
        }
        return false;
    }

    rockfall_options options_{};
    std::vector<detail::joint_plane> planes_{};
};

}  // namespace tafoni

#endif
