/// \file
/// Which removed voxels may have parted a rock: a look at 27 voxels each, and at a block of 8^3 where that leaves it
/// open.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_REMOVALS_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_REMOVALS_HPP

#include <tafoni/voxel/detail/joint_cuts.hpp>
#include <tafoni/voxel/detail/rockfall_block.hpp>
#include <tafoni/voxel/detail/rockfall_ground.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Bits per voxel in the bricks that were written.
class sparse_bits {
public:
    [[nodiscard]] std::uint32_t word(std::size_t brick, std::size_t column) const noexcept {
        return table_[brick] == 0 ? 0 : pool_[table_[brick] - 1][column];
    }
    /// The columns of a brick; null where none was written.
    [[nodiscard]] std::uint32_t const* words(std::size_t brick) const noexcept {
        return table_[brick] == 0 ? nullptr : pool_[table_[brick] - 1].data();
    }
    /// To be called when every bit has been unset again. O(bricks written).
    void forget_bricks(std::size_t bricks) {
        if (table_.size() != bricks) table_.assign(bricks, 0);
        for (std::size_t const b : used_) table_[b] = 0;
        used_.clear();
    }
    void set(std::size_t brick, std::size_t column, std::uint32_t bits) {
        if (table_[brick] == 0) {
            if (used_.size() == pool_.size()) pool_.emplace_back();
            used_.push_back(brick);
            table_[brick] = static_cast<std::uint32_t>(used_.size());
        }
        pool_[table_[brick] - 1][column] |= bits;
    }
    void unset(std::size_t brick, std::size_t column, std::uint32_t bits) noexcept {
        if (table_[brick] != 0) pool_[table_[brick] - 1][column] &= ~bits;
    }

private:
    std::vector<std::uint32_t> table_{};
    std::vector<std::size_t> used_{};
    std::vector<std::array<std::uint32_t, 1024>> pool_{};
};

/// Takes voxels out one after the other, in voxel order, and names a voxel of every piece whose footing may be
/// another than before.
///
/// A voxel whose bonded neighbours hang together within its 26 neighbours, by bonds or by the ground, parts
/// nothing; nor does one whose neighbours hang together within a block of 8^3. What ends within that block, and
/// rests on nothing, is a crumb and falls at once, if there is ground elsewhere. Other neighbours become
/// witnesses; a witness that is taken out itself hands on to its own neighbours. So at the end every piece that
/// is not as it was, but for voxels at its skin, holds a witness or is made of crumbs.
class rockfall_removals {
public:
    /// `removed`: rising, without repeats, no rock in the grid any more. With `contacts` a voxel that lay on rock
    /// across a joint, or carried some, makes witnesses too. Crumbs are looked for only where `has_ground`. O(removed).
    /// \return  rock voxels that are no crumbs, rising, without repeats.
    std::vector<voxel> const& witnesses(sparse_grid const& grid, joint_cuts const& cuts, rockfall_ground const& ground,
                                        std::span<voxel const> removed, bool contacts, bool has_ground) {
        if (!clean_) *this = {};  // an allocation failed on the way
        clean_ = false;
        still_.forget_bricks(grid.brick_count());
        named_.forget_bricks(grid.brick_count());
        crumbled_.forget_bricks(grid.brick_count());
        out_.clear();
        crumbs_.clear();
        has_ground_ = has_ground;
        for (voxel const v : removed) still_.set(grid.brick_of(v), sparse_grid::column_of(v), bit(v));
        for (voxel const v : removed) {
            still_.unset(grid.brick_of(v), sparse_grid::column_of(v), bit(v));
            if (is_crumb(grid, v)) continue;
            take_out(grid, cuts, ground, v, contacts);
        }
        for (voxel const v : out_) named_.unset(grid.brick_of(v), sparse_grid::column_of(v), bit(v));
        std::erase_if(out_, [&](voxel v) { return !grid.is_rock(v) || is_crumb(grid, v); });
        std::sort(out_.begin(), out_.end());
        for (voxel const v : crumbs_) crumbled_.unset(grid.brick_of(v), sparse_grid::column_of(v), bit(v));
        clean_ = true;
        std::erase_if(crumbs_, [&](voxel v) { return !grid.is_rock(v); });
        std::sort(crumbs_.begin(), crumbs_.end());
        return out_;
    }
    /// Rock voxels that are loose for certain, rising, from the last call: whole pieces.
    [[nodiscard]] std::vector<voxel> const& crumbs() const noexcept { return crumbs_; }
    /// Removed voxels that neither look settled, since construction.
    [[nodiscard]] std::size_t parted() const noexcept { return parted_; }

private:
    // Cell (dx, dy, dz) of the 27 is bit (dz + 1) + 3 (dx + 1) + 9 (dy + 1).
    static constexpr std::uint32_t centre_bit = std::uint32_t{1} << 13;
    static constexpr std::array<int, 3> shift{3, 9, 1};  // towards +x, +y, +z

    static std::uint32_t bit(voxel v) noexcept { return std::uint32_t{1} << (v.z & 31); }

    /// Three bits of a column around v, by word(brick, column).
    template <class Word>
    static std::uint32_t three(sparse_grid const& grid, voxel v, Word const& word) {
        if (static_cast<std::size_t>(v.x) >= grid.size()[0] || static_cast<std::size_t>(v.y) >= grid.size()[1]) {
            return 0;
        }
        std::size_t const b = grid.brick_of(v);
        std::size_t const c = sparse_grid::column_of(v);
        int const z = v.z & 31;
        std::uint32_t const here = word(b, c);
        if (z >= 1 && z <= 30) return here >> (z - 1) & 7U;
        auto const layer = static_cast<std::size_t>(grid.bricks()[0]) * static_cast<std::size_t>(grid.bricks()[1]);
        if (z == 0) return (here & 3U) << 1 | (v.z == 0 ? 0 : word(b - layer, c) >> 31);
        bool const top = (v.z >> 5) + 1 == grid.bricks()[2];
        return here >> 30 | (top ? 0 : word(b + layer, c) & 1U) << 2;
    }
    template <class Word>
    static std::uint32_t around(sparse_grid const& grid, voxel v, Word const& word) {
        std::uint32_t out = 0;
        int at = 0;
        for (std::int32_t dy = -1; dy <= 1; ++dy) {
            for (std::int32_t dx = -1; dx <= 1; ++dx, at += 3) {
                out |= three(grid, {v.x + dx, v.y + dy, v.z}, word) << at;
            }
        }
        return out;
    }
    [[nodiscard]] bool is_crumb(sparse_grid const& grid, voxel v) const noexcept {
        return !crumbs_.empty() && (crumbled_.word(grid.brick_of(v), sparse_grid::column_of(v)) & bit(v)) != 0;
    }
    [[nodiscard]] std::uint32_t rock_word(sparse_grid const& grid, std::size_t brick, std::size_t c) const noexcept {
        return (grid.plane_word(voxel_plane::rock, brick, c) | still_.word(brick, c)) & ~crumbled_.word(brick, c);
    }
    /// Rock in the grid or still to be taken out, without crumbs.
    [[nodiscard]] std::uint32_t rock_around(sparse_grid const& grid, voxel v) const {
        std::size_t const b = grid.brick_of(v);
        sparse_grid::brick const* const stored = grid.stored(b);
        std::uint32_t const* const still = still_.words(b);
        std::uint32_t const* const gone = crumbled_.words(b);
        auto const within = [](std::int32_t at) { return static_cast<std::uint32_t>((at & 31) - 1) < 30; };
        if (stored == nullptr || still == nullptr || gone != nullptr || !within(v.x) || !within(v.y) || !within(v.z)) {
            return around(grid, v, [&](std::size_t brick, std::size_t c) { return rock_word(grid, brick, c); });
        }
        std::size_t const low = sparse_grid::column_of(v) - 33;
        int const down = (v.z & 31) - 1;
        std::uint32_t out = 0;
        for (std::size_t i = 0; i < 9; ++i) {
            std::size_t const c = low + i % 3 + i / 3 * 32;
            out |= (((stored->solid[c] & ~stored->colluvium[c]) | still[c]) >> down & 7U) << 3 * i;
        }
        return out;
    }
    /// Cells of the 27 that have a next one towards +axis.
    static constexpr std::uint32_t with_next(std::size_t axis) noexcept {
        return axis == 0 ? 077077077U : axis == 1 ? 0777777U : 0333333333U;
    }

    void take_out(sparse_grid const& grid, joint_cuts const& cuts, rockfall_ground const& ground, voxel v,
                  bool contacts) {
        std::uint32_t const rock = rock_around(grid, v) & ~centre_bit;
        std::array<std::uint32_t, 3> open{with_next(0), with_next(1), with_next(2)};
        bool const cracked = !cuts.empty() && near_cut(grid, cuts, v, 1);
        if (cracked) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                open[axis] &= ~around(grid, v, [&](std::size_t b, std::size_t c) { return cuts.word(axis, b, c); });
            }
        }
        std::uint32_t bonded = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bonded |= (open[axis] & centre_bit) << shift[axis] | (open[axis] & centre_bit >> shift[axis]);
        }
        bonded &= rock;
        std::uint32_t fixed = 0;
        if (ground.may_touch(grid, v)) {
            fixed = around(grid, v, [&](std::size_t b, std::size_t c) { return ground.word(grid, b, c); });
        }
        bool const witness = (named_.word(grid.brick_of(v), sparse_grid::column_of(v)) & bit(v)) != 0;
        bool const hangs_together = joined(rock, open, bonded, fixed);
        bool footing = witness;
        if (contacts && cracked) {
            std::uint32_t const up = centre_bit << 1;
            std::uint32_t const down = centre_bit >> 1;
            if ((rock & up) != 0 && (open[2] & centre_bit) == 0) name(grid, v, up);
            if ((rock & down) != 0 && (open[2] & down) == 0) footing = true;
        }
        if (hangs_together) {
            if (footing) name(grid, v, bonded & (0U - bonded));
        } else if ((fixed & centre_bit) != 0) {
            ++parted_;
            name(grid, v, bonded);
        } else {
            look_wider(grid, cuts, ground, v, bonded, footing, contacts);
        }
    }

    /// The same by a block of 8^3.
    void look_wider(sparse_grid const& grid, joint_cuts const& cuts, rockfall_ground const& ground, voxel v,
                    std::uint32_t bonded, bool footing, bool contacts) {
        auto block =
            rockfall_block::around(grid, v, [&](std::size_t b, std::size_t c) { return rock_word(grid, b, c); });
        if (!cuts.empty() && near_cut(grid, cuts, v, 4)) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.cut[axis] =
                    block.gather(grid, [&](std::size_t b, std::size_t c) { return cuts.word(axis, b, c); });
            }
        }
        std::uint32_t going_on = 0;  // a cell of each part that leaves the block
        bool any_held = false;
        while (bonded != 0) {
            std::uint32_t const cell = bonded & (0U - bonded);
            auto const part = block.flood(neighbour(v, cell));
            for (std::uint32_t left = bonded; left != 0; left &= left - 1) {
                std::uint32_t const other = left & (0U - left);
                if (block.has(part, neighbour(v, other))) bonded &= ~other;
            }
            bool const goes_on =
                !has_ground_ || rockfall_block::reaches_out(part) || (contacts && block.at_contact(part));
            if (!goes_on) {
                bool held = false;
                block.for_voxels(part, [&](voxel w) { held = held || ground.contains(grid, w); });
                any_held = any_held || held;
                if (held) continue;
                block.for_voxels(part, [&](voxel w) {
                    // Whoever speaks for the rest must not go with the crumb.
                    footing = footing || (named_.word(grid.brick_of(w), sparse_grid::column_of(w)) & bit(w)) != 0;
                    crumbs_.push_back(w);
                    crumbled_.set(grid.brick_of(w), sparse_grid::column_of(w), bit(w));
                });
                continue;
            }
            going_on |= cell;
        }
        // A single part that goes on is all that is left, unless the ground was in another.
        bool const settled = going_on == 0 || ((going_on & (going_on - 1)) == 0 && !any_held);
        if (!settled) ++parted_;
        if (!settled || footing) name(grid, v, going_on);
    }

    /// Whether the bonded neighbours, and the ground where the voxel was of it, hang together around the voxel.
    static bool joined(std::uint32_t rock, std::array<std::uint32_t, 3> const& open, std::uint32_t bonded,
                       std::uint32_t fixed) noexcept {
        bool const was_ground = (fixed & centre_bit) != 0;
        if (bonded == 0) return true;
        if ((bonded & (bonded - 1)) == 0 && !was_ground) return true;
        std::uint32_t const held = fixed & rock;
        std::uint32_t seen = was_ground ? held : bonded & (0U - bonded);
        for (;;) {
            std::uint32_t next = seen;
            for (std::size_t a = 0; a < 3; ++a) next |= (seen & open[a]) << shift[a] | (seen >> shift[a] & open[a]);
            next &= rock;
            if ((next & held) != 0) next |= held;
            if ((bonded & ~next) == 0) return true;
            if (next == seen) return false;
            seen = next;
        }
    }
    static bool near_cut(sparse_grid const& grid, joint_cuts const& cuts, voxel v, std::int32_t by) noexcept {
        voxel const lo{std::max(v.x - by, 0), std::max(v.y - by, 0), std::max(v.z - by, 0)};
        voxel const hi{std::min(v.x + by, static_cast<std::int32_t>(grid.size()[0]) - 1),
                       std::min(v.y + by, static_cast<std::int32_t>(grid.size()[1]) - 1),
                       std::min(v.z + by, static_cast<std::int32_t>(grid.size()[2]) - 1)};
        for (int c = 0; c < 8; ++c) {
            if (cuts.of(grid.brick_of({c & 1 ? hi.x : lo.x, c & 2 ? hi.y : lo.y, c & 4 ? hi.z : lo.z})) != nullptr) {
                return true;
            }
        }
        return false;
    }
    /// The neighbour that the lowest of some cells stands for.
    static voxel neighbour(voxel v, std::uint32_t cells) noexcept {
        int const at = std::countr_zero(cells);
        return {v.x + at / 3 % 3 - 1, v.y + at / 9 - 1, v.z + at % 3 - 1};
    }
    void name(sparse_grid const& grid, voxel v, std::uint32_t cells) {
        for (; cells != 0; cells &= cells - 1) {
            voxel const w = neighbour(v, cells);
            std::size_t const b = grid.brick_of(w);
            std::size_t const c = sparse_grid::column_of(w);
            if ((named_.word(b, c) & bit(w)) != 0) continue;
            named_.set(b, c, bit(w));
            out_.push_back(w);
        }
    }

    sparse_bits still_{};  ///< removed, but not taken out yet
    sparse_bits named_{};  ///< witnesses
    sparse_bits crumbled_{};
    std::vector<voxel> out_{};
    std::vector<voxel> crumbs_{};
    bool has_ground_ = false;
    std::size_t parted_ = 0;
    bool clean_ = true;
};

}  // namespace tafoni::detail

#endif
