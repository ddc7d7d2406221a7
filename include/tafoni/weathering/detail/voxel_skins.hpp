/// \file
/// The skin of a grid, brick by brick, kept up to date with what changes.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_SKINS_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_SKINS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>
#include <tafoni/voxel/detail/air_counter.hpp>
#include <tafoni/voxel/voxel_change.hpp>
#include <tafoni/weathering/detail/scratch_pool.hpp>
#include <tafoni/weathering/detail/voxel_skin.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Slots, one for each brick that ever had skin. First bricks are touched, then rebuilt aside, and at last
/// exchanged by `commit`, which cannot throw: until then the skin is as before.
class voxel_skins {
public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// What a rebuild takes from the records that there are.
    enum class basis : std::uint8_t {
        next,     ///< a step goes on: the other decimation
        now,      ///< time stands still
        replaced  ///< and bubble and durability are asked again, counts made anew
    };

    void reset(std::size_t bricks) {
        slot_of_.assign(bricks, none);
        stamp_.assign(bricks, 0);
        stamp_now_ = 0;
        bricks_.clear();
        skins_.clear();
        touched_.clear();
    }
    [[nodiscard]] std::size_t size() const noexcept { return skins_.size(); }
    [[nodiscard]] voxel_skin& operator[](std::size_t slot) noexcept { return skins_[slot]; }
    [[nodiscard]] voxel_skin const& operator[](std::size_t slot) const noexcept { return skins_[slot]; }
    [[nodiscard]] std::size_t brick(std::size_t slot) const noexcept { return bricks_[slot]; }
    [[nodiscard]] std::uint32_t slot_of(std::size_t brick) const noexcept { return slot_of_[brick]; }
    [[nodiscard]] std::span<std::uint32_t const> touched() const noexcept { return touched_; }
    /// Makes a slot where there is none.
    [[nodiscard]] voxel_skin& of_brick(std::size_t b) {
        if (slot_of_[b] == none) {
            bricks_.resize(skins_.size());  // one more where an allocation failed before
            bricks_.push_back(b);
            skins_.emplace_back();
            slot_of_[b] = static_cast<std::uint32_t>(skins_.size() - 1);
        }
        return skins_[slot_of_[b]];
    }
    [[nodiscard]] std::size_t voxel_count() const noexcept {
        std::size_t n = 0;
        for (voxel_skin const& s : skins_) n += s.size();
        return n;
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t n = (slot_of_.capacity() + stamp_.capacity()) * 4;
        for (voxel_skin const& s : skins_) n += sizeof s + s.bytes();
        for (voxel_skin const& s : fresh_) n += sizeof s + s.bytes();
        return n;
    }

    /// All bricks that may hold skin. O(bricks).
    void touch_all(sparse_grid const& grid) {
        start_touching();
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            if (slot_of_[b] != none || (!grid.is_air_brick(b) && !buried(grid, b))) touch(b);
        }
    }

    /// Bricks whose skin or counts the changes may alter: within `depth` of them all, within `reach` those with skin.
    void touch_changed(sparse_grid const& grid, std::span<voxel_change const> changes, int depth, int reach) {
        start_touching();
        for (voxel_change const& c : changes) {
            bool const inner = within(c.at.x, reach) && within(c.at.y, reach) && within(c.at.z, reach);
            if (inner) {
                note(grid.brick_of(c.at), c);
                continue;
            }
            for_each_brick(grid, c.at, reach, [&](std::size_t b, voxel corner) {
                if (slot_of_[b] != none || close(c.at, corner, depth)) note(b, c);
            });
        }
        std::sort(touched_.begin(), touched_.end());  // so that threads meet the bricks that they met before
    }

    /// Rebuilds aside what was touched. `ask(centre)` answers the bubble and the durability of new skin.
    template <class Ask, executor Executor>
    void rebuild(sparse_grid const& grid, std::span<bubble_stencil const> stencils, int depth, Ask const& ask, basis from,
                 Executor const& threads) {
        if (fresh_.size() < skins_.size()) fresh_.resize(skins_.size());
        threads.for_blocks(touched_.size(), 1, [&](std::size_t begin, std::size_t end) {
            auto const mine = scratch_.take();
            for (std::size_t k = begin; k < end; ++k) rebuild_brick(grid, stencils, depth, ask, from, k, *mine);
        });
    }

    /// Exchanges what was rebuilt for what was. Returns how much the skin has grown.
    std::ptrdiff_t commit() noexcept {
        std::ptrdiff_t grown = 0;
        for (std::size_t k = 0; k < touched_.size(); ++k) {
            voxel_skin& skin = skins_[touched_[k]];
            voxel_skin& fresh = fresh_[touched_[k]];
            grown += static_cast<std::ptrdiff_t>(fresh.size()) - static_cast<std::ptrdiff_t>(skin.size());
            std::swap(skin, fresh);
        }
        return grown;
    }
    /// The other decimation holds from now on. Before `commit`.
    void turn() noexcept {
        for (voxel_skin& s : skins_) s.now ^= 1u;
    }

private:
    struct scratch {
        brick_window window{};
        air_counter counter{};
        brick_bits skin{};
        brick_bits changed{};
        brick_bits known{};    // skin as it was
        brick_bits special{};  // changed or covered
        std::vector<std::uint32_t> added{};
        std::vector<brick_position> position{};
        std::vector<std::uint16_t> bubble{};
        std::vector<std::uint32_t> air{};
    };

    /// Rock all around and inside.
    [[nodiscard]] static bool buried(sparse_grid const& grid, std::size_t b) noexcept {
        if (!grid.is_rock_brick(b)) return false;
        voxel const low = grid.brick_corner(b);
        constexpr voxel beside[6] = {{-1, 0, 0}, {32, 0, 0}, {0, -1, 0}, {0, 32, 0}, {0, 0, -1}, {0, 0, 32}};
        return std::all_of(beside, beside + 6, [&](voxel d) {
            voxel const v = low + d;
            return grid.contains(v) && grid.is_rock_brick(grid.brick_of(v));
        });
    }
    static bool within(std::int32_t x, std::int32_t r) noexcept { return (x & 31) >= r && (x & 31) < 32 - r; }
    static bool close(voxel v, voxel corner, std::int32_t r) noexcept {
        auto const one = [r](std::int32_t x, std::int32_t low) { return x >= low - r && x < low + 32 + r; };
        return one(v.x, corner.x) && one(v.y, corner.y) && one(v.z, corner.z);
    }
    template <class F>
    static void for_each_brick(sparse_grid const& grid, voxel v, std::int32_t r, F const& f) {
        auto const& n = grid.bricks();
        auto const low = [r](std::int32_t x) { return std::max((x - r) >> 5, 0); };
        auto const high = [r](std::int32_t x, std::int32_t count) { return std::min((x + r) >> 5, count - 1); };
        for (std::int32_t z = low(v.z); z <= high(v.z, n[2]); ++z) {
            for (std::int32_t y = low(v.y); y <= high(v.y, n[1]); ++y) {
                for (std::int32_t x = low(v.x); x <= high(v.x, n[0]); ++x) {
                    voxel const corner{x * 32, y * 32, z * 32};
                    f(grid.brick_of(corner), corner);
                }
            }
        }
    }

    void start_touching() noexcept {
        if (++stamp_now_ == 0) {
            std::fill(stamp_.begin(), stamp_.end(), 0u);
            stamp_now_ = 1;
        }
        touched_.clear();
    }
    void touch(std::size_t b) {
        if (stamp_[b] == stamp_now_) return;
        (void)of_brick(b);
        if (near_.size() < skins_.size()) near_.resize(skins_.size());
        near_[slot_of_[b]].clear();
        touched_.push_back(slot_of_[b]);
        stamp_[b] = stamp_now_;
    }
    void note(std::size_t b, voxel_change const& c) {
        touch(b);
        near_[slot_of_[b]].push_back(c);
    }

    /// In vectors also where the CPU is not known to count bits.
    static std::uint32_t bits_in(std::uint32_t w) noexcept {
        w -= w >> 1 & 0x55555555u;
        w = (w & 0x33333333u) + (w >> 2 & 0x33333333u);
        w = (w + (w >> 4)) & 0x0F0F0F0Fu;
        w += w >> 8;
        return (w + (w >> 16)) & 63u;
    }

    template <class Ask>
    void rebuild_brick(sparse_grid const& grid, std::span<bubble_stencil const> stencils, int depth, Ask const& ask,
                       basis basis_, std::size_t k, scratch& my) {
        std::size_t const slot = touched_[k];
        std::size_t const brick = bricks_[slot];
        voxel_skin const& old = skins_[slot];
        voxel_skin& fresh = fresh_[slot];
        std::vector<voxel_change> const& changes = near_[slot];
        fresh.now = 0;
        fresh.clock = old.clock;
        fresh.covered.clear();
        fresh.covered_left.clear();
        std::vector<double> const& left_of = old.left[basis_ == basis::next ? old.now ^ 1u : old.now];
        find_skin(grid, brick, depth, my.window, my.skin);
        std::size_t size = 0;
        for (std::uint32_t const word : my.skin) size += bits_in(word);
        fresh.resize(size);
        voxel const corner = grid.brick_corner(brick);
        my.changed.fill(0);
        for (voxel_change const& c : changes) {
            if (!close(c.at, corner, 0)) continue;
            brick_position const p = position_of(c.at);
            my.changed[p >> 5] |= std::uint32_t{1} << (p & 31);
        }
        my.known.fill(0);
        for (brick_position const p : old.position) my.known[p >> 5] |= std::uint32_t{1} << (p & 31);
        my.special = my.changed;
        for (brick_position const p : old.covered) my.special[p >> 5] |= std::uint32_t{1} << (p & 31);
        auto const same = [&my](std::uint32_t p) { return (my.changed[p >> 5] >> (p & 31) & 1) == 0; };
        auto const cover = [&](std::uint32_t p, double left) {
            if (!same(p) || !(left < 100)) return;
            fresh.covered.push_back(static_cast<brick_position>(p));
            fresh.covered_left.push_back(left);
        };
        my.added.clear();
        std::size_t i = 0;  // of the old records
        std::size_t j = 0;  // of the old covered ones
        std::size_t o = 0;  // of the fresh records
        bool const anew = basis_ == basis::replaced;
        for (std::uint32_t c = 0; c < 1024;) {
            std::uint32_t const first = c;  // columns in which nothing has happened are copied together
            while (c < 1024 && ((my.skin[c] ^ my.known[c]) | my.special[c]) == 0 && !anew) ++c;
            if (c != first) {
                std::size_t const from = i;
                while (i < old.size() && old.position[i] < 32 * c) ++i;
                fresh.copy(old, left_of, from, o, i - from);
                o += i - from;
                continue;
            }
            std::uint32_t const skin = my.skin[c];
            for (std::uint32_t bits = skin | my.known[c] | my.special[c]; bits != 0; bits &= bits - 1) {
                auto const z = static_cast<std::uint32_t>(std::countr_zero(bits));
                std::uint32_t const p = 32 * c + z;
                bool const known = (my.known[c] >> z & 1) != 0;
                bool const was_covered = j < old.covered.size() && old.covered[j] == p;
                double left = 100;
                if (same(p) && known) left = left_of[i];
                if (same(p) && was_covered) left = old.covered_left[j];
                if ((skin >> z & 1) == 0) {
                    cover(p, left);
                } else if (known && !anew) {
                    fresh.position[o] = static_cast<brick_position>(p);
                    fresh.left[0][o] = left;
                    fresh.bubble[o] = old.bubble[i];
                    fresh.durability[o] = old.durability[i];
                    fresh.air[o++] = old.air[i];
                } else {
                    auto const [bubble, durability] = ask(grid.centre(at_position(corner, static_cast<brick_position>(p))));
                    fresh.position[o] = static_cast<brick_position>(p);
                    fresh.left[0][o] = left;
                    fresh.bubble[o] = bubble;
                    fresh.durability[o] = durability;
                    fresh.air[o] = 0;
                    my.added.push_back(static_cast<std::uint32_t>(o++));
                }
                i += known ? 1 : 0;
                j += was_covered ? 1 : 0;
            }
            ++c;
        }
        count(grid, brick, stencils, changes, fresh, my);
    }

    /// The counts of what was skin before are brought up to date by the changes, or all are made anew.
    static void count(sparse_grid const& grid, std::size_t brick, std::span<bubble_stencil const> stencils,
                      std::span<voxel_change const> changes, voxel_skin& fresh, scratch& my) {
        if (my.added.size() == fresh.size() || my.counter.recount_is_cheaper(stencils, fresh.view(), changes.size())) {
            my.counter.recount(grid, brick, stencils, fresh.view());
            return;
        }
        my.counter.notify(grid, brick, stencils, fresh.view(), changes);
        my.position.clear();
        my.bubble.clear();
        for (std::uint32_t const a : my.added) {
            my.position.push_back(fresh.position[a]);
            my.bubble.push_back(fresh.bubble[a]);
        }
        my.air.assign(my.added.size(), 0);
        my.counter.recount(grid, brick, stencils, {my.position, my.bubble, my.air});
        for (std::size_t a = 0; a < my.added.size(); ++a) fresh.air[my.added[a]] = my.air[a];
    }

    std::vector<std::uint32_t> slot_of_{};  ///< by brick
    std::vector<std::uint32_t> stamp_{};    ///< by brick: touched in this round
    std::uint32_t stamp_now_ = 0;
    std::vector<std::size_t> bricks_{};  ///< by slot
    std::vector<voxel_skin> skins_{};
    std::vector<std::uint32_t> touched_{};                ///< slots, ascending but by touch_all
    std::vector<std::vector<voxel_change>> near_{};       ///< by slot: what the touched ones have to look at
    std::vector<voxel_skin> fresh_{};                     ///< by slot
    scratch_pool<scratch> scratch_{};
};

}  // namespace tafoni::detail

#endif
