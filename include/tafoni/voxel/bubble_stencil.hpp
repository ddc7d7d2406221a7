/// \file
/// A bubble as the list of its voxels: what the counts are made with.
#ifndef TAFONI_VOXEL_BUBBLE_STENCIL_HPP
#define TAFONI_VOXEL_BUBBLE_STENCIL_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>
#include <tafoni/voxel/detail/stencil_words.hpp>

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// The voxels of any `bubble_shape`, asked once and kept as rows of bits. A value; shapes convert to it.
///
/// Bubbles that reach 16 voxels or less are counted from one word per row; those up to `widest` more slowly.
class bubble_stencil {
public:
    static constexpr int widest = 48;  ///< voxels, farthest along an axis

    using row = detail::stencil_row;  ///< dx, dy and a bit dz + `widest` per voxel

    /// O(reach^3) questions. \throws invalid_input  what the shape's `validate` throws; `bad_parameter` for a reach
    /// that is not in 0 .. 48; `empty_input` for a bubble that holds no voxel.
    template <class S>
        requires(!std::same_as<S, bubble_stencil>)
    &&bubble_shape<S> explicit(false) bubble_stencil(S const& shape) {
        if constexpr (requires { shape.validate(); }) shape.validate();
        double const reach = shape.reach();
        detail::require_range("bubble_stencil: reach of the bubble", reach, 0, widest);
        auto const r = static_cast<int>(reach);
        for (int dy = -r; dy <= r; ++dy) {
            for (int dx = -r; dx <= r; ++dx) {
                row line{dx, dy, {}};
                for (int dz = -r; dz <= r; ++dz) {
                    if (!shape.contains(vec3{double(dx), double(dy), double(dz)})) continue;
                    auto const k = static_cast<unsigned>(dz + widest);
                    line.bits[k / 64] |= std::uint64_t{1} << (k % 64);
                    reach_ = std::max({reach_, std::abs(dx), std::abs(dy), std::abs(dz)});
                }
                if (line.bits[0] == 0 && line.bits[1] == 0) continue;
                size_ += static_cast<std::uint32_t>(std::popcount(line.bits[0]) + std::popcount(line.bits[1]));
                rows_.push_back(line);
            }
        }
        if (size_ == 0) {
            detail::fail<invalid_input>(errc::empty_input,
                                        "bubble_stencil: the bubble holds no voxel within its reach of " +
                                            detail::number_text(reach) + " voxels, need at least 1",
                                        {.kind = entity::voxel, .value = 0, .limit = 1});
        }
        words_ = detail::stencil_words(rows_);
    }

    /// Voxels inside, |b| of the paper; 1 .. 97^3.
    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    /// Of the voxel that is farthest along an axis; voxels, 0 .. `widest`.
    [[nodiscard]] int reach() const noexcept { return reach_; }
    [[nodiscard]] bool contains(int dx, int dy, int dz) const noexcept {
        if (std::abs(dz) > widest) return false;
        auto const k = static_cast<unsigned>(dz + widest);
        auto const at = std::lower_bound(rows_.begin(), rows_.end(), row{dx, dy, {}}, before);
        return at != rows_.end() && at->dx == dx && at->dy == dy && (at->bits[k / 64] >> (k % 64) & 1) != 0;
    }
    /// Ordered by dy, then dx; none is empty.
    [[nodiscard]] std::span<row const> rows() const noexcept { return rows_; }
    /// Equal for equal sets of voxels, for checkpoints. O(rows).
    [[nodiscard]] std::uint64_t fingerprint() const noexcept {
        std::uint64_t h = size_;
        auto const add = [&h](std::uint64_t v) {
            h = (h ^ v) * 0x9E3779B97F4A7C15ULL;
            h ^= h >> 29;
        };
        for (row const& line : rows_) {
            add(static_cast<std::uint64_t>(line.dx + widest) * 128 + static_cast<std::uint64_t>(line.dy + widest));
            add(line.bits[0]);
            add(line.bits[1]);
        }
        return h;
    }
    [[nodiscard]] detail::stencil_words const& words() const noexcept { return words_; }  ///< for the kernels

    friend bool operator==(bubble_stencil const& a, bubble_stencil const& b) noexcept {
        return std::equal(a.rows_.begin(), a.rows_.end(), b.rows_.begin(), b.rows_.end(),
                          [](row const& l, row const& r) { return l.dx == r.dx && l.dy == r.dy && l.bits == r.bits; });
    }

private:
    static bool before(row const& a, row const& b) noexcept { return a.dy != b.dy ? a.dy < b.dy : a.dx < b.dx; }

    std::vector<row> rows_{};
    detail::stencil_words words_{};
    std::uint32_t size_ = 0;
    int reach_ = 0;
};

}  // namespace tafoni

#endif
