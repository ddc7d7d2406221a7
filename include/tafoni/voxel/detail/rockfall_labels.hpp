/// \file
/// The pieces of rock within one brick.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_LABELS_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_LABELS_HPP

#include <tafoni/voxel/detail/joint_cuts.hpp>
#include <tafoni/voxel/detail/rockfall_ground.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Voxels of a column from `lo` to `hi`, bonded to one another.
struct rock_run {
    std::uint8_t lo;
    std::uint8_t hi;
    std::uint16_t piece;

    [[nodiscard]] std::uint32_t bits() const noexcept {
        return (~std::uint32_t{0} << lo) & (~std::uint32_t{0} >> (31 - hi));
    }
};

/// Runs of bonded rock along z, joined across columns by union-find; about 7 KiB for a brick at the surface.
class rock_labels {
public:
    struct piece {
        std::uint32_t voxels = 0;
        bool ground = false;
        std::uint8_t faces = 0;            ///< of the brick that it touches: bit 2 axis + side
        std::uint16_t first_column = 0;
        std::uint16_t last_column = 0;
        std::uint32_t epoch = 0;  ///< of the search that saw it last
        std::uint32_t group = 0;  ///< what that search put it in
    };

    bool valid = false;
    std::vector<piece> pieces{};

    [[nodiscard]] rock_run const* begin(std::size_t column) const noexcept { return runs_.data() + first_[column]; }
    [[nodiscard]] rock_run const* end(std::size_t column) const noexcept { return runs_.data() + first_[column + 1]; }
    /// The voxels of a piece in a column.
    [[nodiscard]] std::uint32_t bits(std::size_t column, std::uint16_t of) const noexcept {
        std::uint32_t out = 0;
        for (auto const* r = begin(column); r != end(column); ++r) out |= r->piece == of ? r->bits() : 0;
        return out;
    }
    /// The piece of a rock voxel.
    [[nodiscard]] std::uint16_t piece_at(std::size_t column, std::int32_t z) const noexcept {
        auto const* r = begin(column);
        while (r->hi < z) ++r;
        return r->piece;
    }

    /// Numbers pieces by their first runs, in order of columns, so the numbers follow from the brick alone.
    /// O(columns + runs), 10 to 40 us.
    void label(sparse_grid const& grid, joint_cuts const& cuts, rockfall_ground const& ground, std::size_t brick) {
        joint_cuts::brick_cuts const* const cut = cuts.of(brick);
        sparse_grid::brick const* const stored = grid.stored(brick);
        runs_.clear();
        first_.resize(1025);
        for (std::size_t c = 0; c < 1024; ++c) {
            first_[c] = static_cast<std::uint16_t>(runs_.size());
            std::uint32_t left = stored != nullptr ? stored->solid[c] & ~stored->colluvium[c]
                                                   : grid.plane_word(voxel_plane::rock, brick, c);
            std::uint32_t const bonded = left & left >> 1 & (cut == nullptr ? ~std::uint32_t{0} : ~cut->axis[2][c]);
            while (left != 0) {
                int const lo = std::countr_zero(left);
                int const hi = lo + std::countr_one(bonded >> lo);
                runs_.push_back({static_cast<std::uint8_t>(lo), static_cast<std::uint8_t>(hi),
                                 static_cast<std::uint16_t>(runs_.size())});
                left &= ~runs_.back().bits();
            }
            if ((c & 31) != 0) join(c - 1, c, cut == nullptr ? 0 : cut->axis[0][c - 1]);
            if (c >= 32) join(c - 32, c, cut == nullptr ? 0 : cut->axis[1][c - 32]);
        }
        first_[1024] = static_cast<std::uint16_t>(runs_.size());
        pieces.clear();
        // A run's root never comes after it, so one pass in order turns roots into numbers.
        for (std::size_t c = 0; c < 1024; ++c) {
            std::uint32_t const sides = ((c & 31) == 0 ? 1U : 0U) | ((c & 31) == 31 ? 2U : 0U) | (c < 32 ? 4U : 0U) | (c >= 992 ? 8U : 0U);
            for (std::size_t r = first_[c]; r < first_[c + 1]; ++r) {
                std::size_t const up = runs_[r].piece;
                if (up == r) {
                    runs_[r].piece = static_cast<std::uint16_t>(pieces.size());
                    pieces.emplace_back();
                    pieces.back().first_column = static_cast<std::uint16_t>(c);
                } else {
                    runs_[r].piece = runs_[up].piece;
                }
                piece& p = pieces[runs_[r].piece];
                p.voxels += static_cast<std::uint32_t>(runs_[r].hi - runs_[r].lo + 1);
                p.faces = static_cast<std::uint8_t>(p.faces | sides | (runs_[r].lo == 0 ? 16U : 0U) | (runs_[r].hi == 31 ? 32U : 0U));
                p.last_column = static_cast<std::uint16_t>(c);
            }
        }
        if (ground.may_hold(grid, brick)) {
            for (std::size_t c = 0; c < 1024; ++c) {
                std::uint32_t const g = ground.word(grid, brick, c);
                if (g == 0) continue;
                for (auto const* r = begin(c); r != end(c); ++r) {
                    if ((r->bits() & g) != 0) pieces[r->piece].ground = true;
                }
            }
        }
        valid = true;
    }

private:
    /// While runs are joined, `piece` is the run above in the union-find forest.
    std::size_t root(std::size_t r) noexcept {
        while (runs_[r].piece != r) {
            runs_[r].piece = runs_[runs_[r].piece].piece;
            r = runs_[r].piece;
        }
        return r;
    }
    void join(std::size_t before, std::size_t column, std::uint32_t cut) noexcept {
        rock_run* const runs = runs_.data();
        std::size_t a = first_[before];
        std::size_t const a_end = first_[before + 1];
        std::size_t b = first_[column];
        std::size_t const b_end = runs_.size();
        while (a < a_end && b < b_end) {
            // The same root above both settles most pairs at a glance.
            if (runs[a].piece != runs[b].piece && (runs[a].bits() & runs[b].bits() & ~cut) != 0) {
                std::size_t const p = root(a);
                std::size_t const q = root(b);
                std::size_t const least = p < q ? p : q;
                runs[p].piece = static_cast<std::uint16_t>(least);
                runs[q].piece = static_cast<std::uint16_t>(least);
                runs[a].piece = static_cast<std::uint16_t>(least);
                runs[b].piece = static_cast<std::uint16_t>(least);
            }
            (runs[a].hi <= runs[b].hi ? a : b)++;
        }
    }

    std::vector<std::uint16_t> first_{};
    std::vector<rock_run> runs_{};
};

}  // namespace tafoni::detail

#endif
