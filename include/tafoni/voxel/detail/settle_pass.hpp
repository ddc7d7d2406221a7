/// \file
/// One call of settling: grains are laid down one after the other, and what they leave behind is followed up.
#ifndef TAFONI_VOXEL_DETAIL_SETTLE_PASS_HPP
#define TAFONI_VOXEL_DETAIL_SETTLE_PASS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/detail/grain_slide.hpp>
#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/voxel/voxel_change.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni::detail {

/// The grains in voxel order, in `copy` where they did not come so. O(n log n), O(n) where they did.
[[nodiscard]] inline std::span<voxel const> checked_grains(sparse_grid const& grid, std::span<voxel const> released,
                                                           std::span<voxel const> opened, std::vector<voxel>& copy) {
    auto const name = [](voxel v) {
        return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
    };
    auto const inside = [&](std::span<voxel const> voxels, char const* what) {
        for (std::size_t i = 0; i < voxels.size(); ++i) {
            if (grid.contains(voxels[i])) continue;
            fail<invalid_input>(errc::out_of_range,
                                std::string("settle: ") + what + "[" + std::to_string(i) +
                                    "]: need a voxel of the grid, got " + name(voxels[i]),
                                {.kind = entity::voxel, .index = i});
        }
    };
    inside(released, "released");
    inside(opened, "opened");
    for (std::size_t i = 0; i < released.size(); ++i) {
        if (!grid.is_solid(released[i])) continue;
        fail<invalid_input>(errc::bad_count,
                            "settle: released[" + std::to_string(i) + "]: need a voxel of air, got a solid one at " +
                                name(released[i]),
                            {.kind = entity::voxel, .index = i});
    }
    if (!std::is_sorted(released.begin(), released.end())) {
        copy.assign(released.begin(), released.end());
        std::sort(copy.begin(), copy.end());
        released = copy;
    }
    if (auto const twice = std::adjacent_find(released.begin(), released.end()); twice != released.end()) {
        fail<invalid_input>(errc::bad_count, "settle: released: need each voxel once, got " + name(*twice) + " twice",
                            {.kind = entity::voxel});
    }
    return released;
}

/// The sequential loop in voxel order.
class settle_pass {
public:
    settle_pass(sparse_grid& grid, grain_slide const& slide) : grid_(grid), slide_(slide) {}

    /// Lets grains go from voxels of air; returns how many left.
    template <class Executor>
    std::size_t release(std::span<voxel const> grains, Executor const&) {
        std::size_t left = 0;
        for (voxel const v : grains) {
            voxel p = v;
            if (travel(p, slide_.grain_key(v)) == grain_slide::step::leaves) {
                ++left;
            } else {
                put(p, voxel_state::colluvium);
            }
        }
        return left;
    }

    template <class Executor>
    void resettle(std::span<voxel const> opened, Executor const&, std::size_t& moved, std::size_t& left) {
        std::vector<voxel> wave;
        for (voxel const v : opened) {
            voxel_state const s = grid_.state(v);
            if (s == voxel_state::colluvium) wave.push_back(v);
            if (s == voxel_state::air) unsettled_by(v, wave);
        }
        std::vector<voxel> next;
        while (!wave.empty()) {
            std::sort(wave.begin(), wave.end());
            wave.erase(std::unique(wave.begin(), wave.end()), wave.end());
            next.clear();
            for (voxel const v : wave) {
                if (grid_.state(v) != voxel_state::colluvium) continue;
                voxel p = v;
                bool const leaves = travel(p, slide_.grain_key(v)) == grain_slide::step::leaves;
                if (!leaves && p == v) continue;
                ++moved;
                put(v, voxel_state::air);
                if (leaves) {
                    ++left;
                } else {
                    put(p, voxel_state::colluvium);
                }
                unsettled_by(v, next);
            }
            wave.swap(next);
        }
    }

    /// Every put turned air to colluvium or back: those put an odd number of times have changed.
    void net_changes(std::vector<voxel_change>& changes) {
        std::sort(puts_.begin(), puts_.end());
        for (std::size_t i = 0; i < puts_.size();) {
            std::size_t end = i + 1;
            while (end < puts_.size() && puts_[end] == puts_[i]) ++end;
            if ((end - i) % 2 == 1) {
                voxel const v = voxel_of_key(puts_[i]);
                voxel_state const now = grid_.state(v);
                changes.push_back({v, now == voxel_state::air ? voxel_state::colluvium : voxel_state::air, now});
            }
            i = end;
        }
    }

private:
    /// To the end of a grain's way. The voxel where it starts does not matter: it looks at lower ones only.
    [[nodiscard]] grain_slide::step travel(voxel& p, std::uint64_t key) const noexcept {
        if (slide_.fall(p) == grain_slide::step::leaves) return grain_slide::step::leaves;
        for (;;) {
            grain_slide::step const s = slide_.slide(p, key);
            if (s != grain_slide::step::moves) return s;
        }
    }

    void put(voxel v, voxel_state s) {
        grid_.set(v, s);
        puts_.push_back(voxel_key(v));
    }

    /// Colluvium that may have stood because `v` was not air: the voxel above it, and what looks into or
    /// past the air around it, from v's height up to the next ceiling above v.
    void unsettled_by(voxel v, std::vector<voxel>& out) const {
        auto const nz = static_cast<std::int32_t>(grid_.size()[2]);
        std::int32_t const ceiling = first_solid(v);
        if (ceiling == v.z + 1 && ceiling < nz && grid_.state({v.x, v.y, ceiling}) == voxel_state::colluvium) {
            out.push_back({v.x, v.y, ceiling});
        }
        for (std::int32_t k = 1; k <= slide_.baseline(); ++k) {
            for (voxel const c : {voxel{v.x - k, v.y, v.z}, voxel{v.x + k, v.y, v.z}, voxel{v.x, v.y - k, v.z},
                                  voxel{v.x, v.y + k, v.z}}) {
                if (grid_.contains(c)) grains_between(c, ceiling, out);
            }
        }
    }

    /// Height of the lowest solid voxel above v; the grid's height where there is none.
    [[nodiscard]] std::int32_t first_solid(voxel v) const noexcept {
        auto const nz = static_cast<std::int32_t>(grid_.size()[2]);
        std::size_t const column = sparse_grid::column_of(v);
        for (std::int32_t z = v.z + 1; z < nz; z = (z | 31) + 1) {
            std::uint32_t const word = grid_.solid_word(grid_.brick_of({v.x, v.y, z}), column) >> (z & 31);
            if (word != 0) return z + std::countr_zero(word);
        }
        return nz;
    }

    void grains_between(voxel from, std::int32_t end, std::vector<voxel>& out) const {
        std::size_t const column = sparse_grid::column_of(from);
        for (std::int32_t z = from.z; z < end; z = (z | 31) + 1) {
            std::uint32_t word = grid_.colluvium_word(grid_.brick_of({from.x, from.y, z}), column) >> (z & 31);
            for (; word != 0; word &= word - 1) {
                std::int32_t const at = z + std::countr_zero(word);
                if (at < end) out.push_back({from.x, from.y, at});
            }
        }
    }

    sparse_grid& grid_;
    grain_slide slide_;
    std::vector<std::uint64_t> puts_{};
};

}  // namespace tafoni::detail

#endif
