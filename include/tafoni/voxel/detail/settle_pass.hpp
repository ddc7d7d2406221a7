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

/// The loop in voxel order over the grains of a call.
///
/// With more than one thread it goes in rounds of fixed size: every grain of a round finds its way over the grid as
/// it stands before the round, in parallel, and keeps the way; then the grains are laid down one by one in order. A
/// step of a way that no change of this round concerns is as it would be found now and is skipped; any
/// other is gone again. So the result is that of the loop, bit by bit, whatever the rounds and threads are
/// [deterministic reservations with the check moved into the commit: Blelloch, Fineman, Gibbons, Shun 2012, Internally
/// deterministic parallel algorithms can be fast].
class settle_pass {
public:
    settle_pass(sparse_grid& grid, grain_slide const& slide) : grid_(grid), slide_(slide) {}

    /// Lets grains go from voxels of air; returns how many left.
    template <class Executor>
    std::size_t release(std::span<voxel const> grains, Executor const& executor) {
        std::size_t left = 0;
        in_order(grains, executor, [&](voxel, auto const& way) {
            voxel p{};
            if (way(p)) {
                put(p, voxel_state::colluvium);
            } else {
                ++left;
            }
        });
        return left;
    }

    template <class Executor>
    void resettle(std::span<voxel const> opened, Executor const& executor, std::size_t& moved, std::size_t& left) {
        std::vector<voxel> wave = collected(opened, executor, [this](voxel v, std::vector<std::uint64_t>& out) {
            voxel_state const s = grid_.state(v);
            if (s == voxel_state::colluvium && slide_.restless(v)) out.push_back(voxel_key(v));
            if (s == voxel_state::air) unsettled_by(v, out);
        });
        std::vector<voxel> lifted;
        while (!wave.empty()) {
            lifted.clear();
            in_order(std::span<voxel const>(wave), executor, [&](voxel v, auto const& way) {
                voxel p{};
                bool const stays = way(p);
                if (stays && p == v) return;
                ++moved;
                lifted.push_back(v);
                put(v, voxel_state::air);
                if (stays) {
                    put(p, voxel_state::colluvium);
                } else {
                    ++left;
                }
            });
            wave = collected(std::span<voxel const>(lifted), executor,
                             [this](voxel v, std::vector<std::uint64_t>& out) {
                                 voxel_state const s = grid_.state(v);
                                 if (s == voxel_state::colluvium && slide_.restless(v)) out.push_back(voxel_key(v));
                                 if (s == voxel_state::air) unsettled_by(v, out);
                             });
        }
    }

    /// Every put turned air to colluvium or back: those put an odd number of times have changed. Where it throws,
    /// `changes` is to be cut back.
    void net_changes(std::vector<voxel_change>& changes) {
        sort_keys(puts_);
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

    /// Takes back every put; their bricks are stored, so it needs no memory.
    void undo() noexcept {
        for (std::uint64_t const k : puts_) {
            voxel const v = voxel_of_key(k);
            grid_.set(v, grid_.state(v) == voxel_state::air ? voxel_state::colluvium : voxel_state::air);
        }
    }

private:
    static constexpr std::size_t round_size = 2048; ///< grains whose ways are found over one state of the grid
    static constexpr std::size_t block_size = 64;   ///< grains of a round that one thread takes at once
    static constexpr std::size_t most_tiles = std::size_t{1} << 20;

    static constexpr std::uint64_t wary_bit = std::uint64_t{1} << 63;

    /// The ways of a block of grains: where each begins and where it stands between its moves.
    struct block_ways {
        struct end {
            std::size_t keys = 0;  ///< end in `keys`
            voxel rest{};
            bool leaves = false;
        };
        std::vector<std::uint64_t> keys{};
        std::vector<end> ends{};
    };

    /// Calls act(start, way) for each start in order; way(p) brings p to the grain's rest in the grid as it is
    /// at that moment, or answers false where the grain leaves. The voxel where a grain starts does not matter to
    /// its way: it looks at lower ones only.
    template <class Executor, class Act>
    void in_order(std::span<voxel const> starts, Executor const& executor, Act const& act) {
        if (executor.thread_count() < 2 || starts.size() < 2 * block_size) {
            for (voxel const v : starts) act(v, [&](voxel& p) { return follow(p = v, v); });
            return;
        }
        prepare_rounds();
        for (std::size_t begin = 0; begin < starts.size(); begin += round_size) {
            std::span<voxel const> const round = starts.subspan(begin, std::min(round_size, starts.size() - begin));
            executor.for_blocks(round.size(), block_size, [&](std::size_t first, std::size_t last) {
                find_ways(round.subspan(first, last - first), ways_[first / block_size]);
            });
            ++round_;
            for (std::size_t i = 0; i < round.size(); ++i) {
                act(round[i], [&](voxel& p) { return follow_again(p, round[i], ways_[i / block_size], i % block_size); });
            }
        }
    }

    void prepare_rounds() {
        if (!here_.empty()) return;
        auto const tiles = [this](std::size_t axis) { return (grid_.size()[axis] >> tile_bits_) + 1; };
        while (tiles(0) * tiles(1) > most_tiles) ++tile_bits_;
        tiles_x_ = tiles(0);
        for (auto* stamps : {&here_, &beside_, &lifted_}) stamps->assign(tiles(0) * tiles(1), 0);
        ways_.resize(round_size / block_size);
    }

    [[nodiscard]] bool follow(voxel& p, voxel start) const noexcept {
        if (slide_.fall(p) == grain_slide::step::leaves) return false;
        std::uint64_t const key = slide_.grain_key(start);
        for (bool wary = false;;) {
            grain_slide::step const s = slide_.slide(p, key, wary);
            if (s != grain_slide::step::moves) return s == grain_slide::step::rests;
        }
    }

    void find_ways(std::span<voxel const> starts, block_ways& out) const {
        out.keys.clear();
        out.ends.clear();
        for (voxel const v : starts) {
            voxel p = v;
            std::uint64_t const key = slide_.grain_key(v);
            out.keys.push_back(voxel_key(p));
            grain_slide::step s = slide_.fall(p);
            if (s == grain_slide::step::moves) out.keys.push_back(voxel_key(p));
            while (s != grain_slide::step::leaves) {
                bool wary = false;
                s = slide_.slide(p, key, wary);
                if (wary) out.keys.back() |= wary_bit;
                if (s != grain_slide::step::moves) break;
                out.keys.push_back(voxel_key(p));
            }
            out.ends.push_back({out.keys.size(), p, s == grain_slide::step::leaves});
        }
    }

    /// `follow`, by the way that was found before the round where it still holds.
    [[nodiscard]] bool follow_again(voxel& p, voxel start, block_ways const& ways, std::size_t j) const noexcept {
        std::size_t k = j == 0 ? 0 : ways.ends[j - 1].keys;
        std::size_t const end = ways.ends[j].keys;
        std::uint64_t const key = slide_.grain_key(start);
        bool first = true;
        for (bool wary = false;;) {
            while (k < end && holds(ways.keys[k], k + 1 < end ? ways.keys[k + 1] : ways.keys[k])) {
                ++k;
                first = false;
            }
            if (k == end) {
                p = ways.ends[j].rest;
                return !ways.ends[j].leaves;
            }
            p = voxel_of_key(ways.keys[k]);
            if (first && slide_.fall(p) == grain_slide::step::leaves) return false;
            first = false;
            // A way that comes to where the old one stood goes on as that did.
            for (++k;;) {
                while (k < end && voxel_of_key(ways.keys[k]).z > p.z) ++k;
                if (k < end && (ways.keys[k] & ~wary_bit) == voxel_key(p)) break;
                grain_slide::step const s = slide_.slide(p, key, wary);
                if (s != grain_slide::step::moves) return s == grain_slide::step::rests;
            }
        }
    }

    /// find(voxel, found keys) for every voxel, one after the other or in parallel; what was found, once, in order.
    template <class Executor, class Find>
    [[nodiscard]] static std::vector<voxel> collected(std::span<voxel const> voxels, Executor const& executor, Find const& find) {
        std::vector<std::uint64_t> found;
        std::size_t const grain = 16 * block_size;
        if (executor.thread_count() < 2 || voxels.size() < 2 * grain) {
            for (voxel const v : voxels) find(v, found);
        } else {
            std::vector<std::vector<std::uint64_t>> parts((voxels.size() + grain - 1) / grain);
            executor.for_blocks(voxels.size(), grain, [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) find(voxels[i], parts[first / grain]);
            });
            for (auto const& part : parts) found.insert(found.end(), part.begin(), part.end());
        }
        sort_keys(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
        std::vector<voxel> out;
        out.reserve(found.size());
        for (std::uint64_t const k : found) out.push_back(voxel_of_key(k));
        return out;
    }

    /// Whether no change of this round can matter to a grain's move from a place to the next.
    [[nodiscard]] bool holds(std::uint64_t from, std::uint64_t to) const noexcept {
        if (here_[tile_of_key(to)] == round_) return false;
        bool const wary = (from & wary_bit) != 0;
        if (!wary && !any_lifted_) return true;
        std::size_t const tile = tile_of_key(from);
        return lifted_[tile] != round_ && !(wary && beside_[tile] == round_);
    }
    [[nodiscard]] std::size_t tile_of_key(std::uint64_t key) const noexcept {
        constexpr std::uint64_t mask = (std::uint64_t{1} << 20) - 1;
        return ((key & mask) >> tile_bits_) + tiles_x_ * ((key >> 20 & mask) >> tile_bits_);
    }
    [[nodiscard]] std::size_t tile_of(voxel v) const noexcept {
        return static_cast<std::size_t>(v.x >> tile_bits_) + tiles_x_ * static_cast<std::size_t>(v.y >> tile_bits_);
    }

    void put(voxel v, voxel_state s) {
        grid_.make_mixed(grid_.brick_of(v));  // what may throw comes before what changes
        puts_.push_back(voxel_key(v));
        grid_.set(v, s);
        any_lifted_ = any_lifted_ || s == voxel_state::air;
        if (here_.empty()) return;
        here_[tile_of(v)] = round_;
        // Whoever stands up to a baseline away along an axis has looked at this column.
        auto const touch = [&](voxel c) {
            beside_[tile_of(c)] = round_;
            if (s == voxel_state::air) lifted_[tile_of(c)] = round_;
        };
        std::int32_t const reach = slide_.baseline();
        auto const nx = static_cast<std::int32_t>(grid_.size()[0]);
        auto const ny = static_cast<std::int32_t>(grid_.size()[1]);
        for (std::int32_t x = std::max(0, v.x - reach); x <= std::min(nx - 1, v.x + reach); ++x) touch({x, v.y, v.z});
        for (std::int32_t y = std::max(0, v.y - reach); y <= std::min(ny - 1, v.y + reach); ++y) touch({v.x, y, v.z});
    }

    /// Colluvium that may have stood because `v` was not air: the voxel above it, and what looks into or
    /// past the air around it, from v's height up to the next ceiling above v.
    void unsettled_by(voxel v, std::vector<std::uint64_t>& out) const {
        auto const nz = static_cast<std::int32_t>(grid_.size()[2]);
        std::int32_t const ceiling = first_solid(v);
        if (ceiling == v.z + 1 && ceiling < nz && grid_.state({v.x, v.y, ceiling}) == voxel_state::colluvium) {
            out.push_back(voxel_key({v.x, v.y, ceiling}));
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

    void grains_between(voxel from, std::int32_t end, std::vector<std::uint64_t>& out) const {
        std::size_t const column = sparse_grid::column_of(from);
        for (std::int32_t z = from.z; z < end; z = (z | 31) + 1) {
            std::uint32_t word = grid_.colluvium_word(grid_.brick_of({from.x, from.y, z}), column) >> (z & 31);
            for (; word != 0; word &= word - 1) {
                voxel const v{from.x, from.y, z + std::countr_zero(word)};
                if (v.z < end && slide_.restless(v)) out.push_back(voxel_key(v));
            }
        }
    }

    sparse_grid& grid_;
    grain_slide slide_;
    std::vector<std::uint64_t> puts_{};
    std::vector<block_ways> ways_{};
    // Per tile the last round in which something changed: in one of its columns; in a column that can be seen from
    // one of them, or in one of them; the same, but only what turned to air.
    std::vector<std::uint32_t> here_{};
    std::vector<std::uint32_t> beside_{};
    std::vector<std::uint32_t> lifted_{};
    bool any_lifted_ = false;
    std::size_t tiles_x_ = 0;
    int tile_bits_ = 0;  ///< a tile is a square of 2^bits columns; single ones unless the grid is very wide
    std::uint32_t round_ = 0;
};

}  // namespace tafoni::detail

#endif
