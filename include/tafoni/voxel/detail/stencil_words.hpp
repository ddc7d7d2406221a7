/// \file
/// A bubble's rows of bits, laid out as the counting kernels read them.
#ifndef TAFONI_VOXEL_DETAIL_STENCIL_WORDS_HPP
#define TAFONI_VOXEL_DETAIL_STENCIL_WORDS_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace tafoni::detail {

/// The voxels of a bubble above and below one place beside the centre.
struct stencil_row {
    static constexpr int widest = 48;

    std::int32_t dx = 0;
    std::int32_t dy = 0;
    std::array<std::uint64_t, 2> bits{};  ///< bit dz + `widest`, 97 in all

    /// The same voxels seen from each of them: where a change is met from.
    [[nodiscard]] stencil_row mirrored() const noexcept {
        stencil_row out{-dx, -dy, {}};
        for (unsigned k = 0; k <= 2 * unsigned{widest}; ++k) {
            unsigned const to = 2 * unsigned{widest} - k;
            out.bits[to / 64] |= (bits[k / 64] >> (k % 64) & 1) << (to % 64);
        }
        return out;
    }
    /// Those of the heights 0 .. 31 that the row holds when its centre is at height z, any.
    [[nodiscard]] std::uint32_t around(std::int32_t z) const noexcept {
        std::int32_t const shift = widest - z;
        if (shift <= -32 || shift >= 128) return 0;
        if (shift < 0) return static_cast<std::uint32_t>(bits[0] << -shift);
        if (shift >= 64) return static_cast<std::uint32_t>(bits[1] >> (shift - 64));
        return static_cast<std::uint32_t>(bits[0] >> shift | bits[1] << 1 << (63 - shift));
    }
    /// Bits dz + r for |dz| <= r. `r` below 32, no voxel beyond.
    [[nodiscard]] std::uint64_t centred(int r) const noexcept {
        auto const shift = static_cast<unsigned>(widest - r);
        return bits[0] >> shift | bits[1] << (64 - shift);
    }
};

/// What is masked, and with what. The narrow layout packs neighbouring rows into words and vectors, so that
/// one popcount serves several.
class stencil_words {
public:
    /// `narrow`: at most 8 voxels up and down, 16 sideways; rows of 32 bits, two to a word. `medium`: 16 voxels; a row
    /// to a word. `wide`: 48 voxels; a row of 128 bits to two words.
    enum class layout : std::uint8_t { narrow, medium, wide };

    struct word {
        std::int32_t offset;  ///< of its first row: dx + stride * dy
        std::uint64_t mask;
    };
    struct alignas(64) block {
        std::array<std::uint64_t, 8> mask;
    };
    static constexpr int narrow_anchor = 8;   ///< masks of narrow words hold dz at bit dz + 8 ...
    static constexpr int medium_anchor = 16;  ///< ... of medium ones at dz + 16, of wide ones at dz + 48
    static constexpr std::int32_t stride = 64;
    static constexpr std::size_t unrolled = 4;  ///< words come in multiples of it, the last with empty masks
    static constexpr std::int32_t wide_stride = 128;

    stencil_words() = default;
    /// `rows` ordered by dy, then dx.
    explicit stencil_words(std::span<stencil_row const> rows) {
        int sideways = 0;
        int upwards = 0;
        for (stencil_row const& r : rows) {
            sideways = std::max({sideways, r.dx < 0 ? -r.dx : r.dx, r.dy < 0 ? -r.dy : r.dy});
            for (int dz = -stencil_row::widest; dz <= stencil_row::widest; ++dz) {
                auto const k = static_cast<unsigned>(dz + stencil_row::widest);
                if ((r.bits[k / 64] >> (k % 64) & 1) != 0) upwards = std::max(upwards, dz < 0 ? -dz : dz);
            }
        }
        for (stencil_row const& r : rows) mirrored_.push_back(r.mirrored());
        layout_ = sideways > 16 || upwards > 16 ? layout::wide : upwards > 8 ? layout::medium : layout::narrow;
        if (layout_ == layout::wide) {
            pack_wide(rows);
        } else if (layout_ == layout::medium) {
            pack<std::uint64_t>(rows, medium_anchor);
        } else {
            pack<std::uint32_t>(rows, narrow_anchor);
        }
        while (words_.size() % unrolled != 0) words_.push_back({0, 0});
    }

    [[nodiscard]] layout kind() const noexcept { return layout_; }
    [[nodiscard]] std::span<word const> words() const noexcept { return words_; }
    /// Rows of those whose bubble holds the centre.
    [[nodiscard]] std::span<stencil_row const> mirrored() const noexcept { return mirrored_; }
    /// 16 narrow or 8 medium rows each, beginning at `block_offsets`; of 8 wide rows first the low, then the high
    /// words.
    [[nodiscard]] std::span<block const> blocks() const noexcept { return blocks_; }
    [[nodiscard]] std::span<std::int32_t const> block_offsets() const noexcept { return block_offsets_; }

private:
    template <class Row>
    void pack(std::span<stencil_row const> rows, int anchor) {
        constexpr std::int32_t per_word = sizeof(std::uint64_t) / sizeof(Row);
        constexpr std::int32_t per_block = sizeof(block) / sizeof(Row);
        std::array<Row, static_cast<std::size_t>(per_block)> lanes{};
        for (std::size_t first = 0; first < rows.size();) {
            std::int32_t const dy = rows[first].dy;
            std::size_t last = first;
            while (last < rows.size() && rows[last].dy == dy) ++last;
            auto const take = [&](std::int32_t width, std::size_t& at) {
                std::int32_t const low = rows[at].dx;
                lanes.fill(0);
                for (; at < last && rows[at].dx < low + width; ++at) {
                    lanes[static_cast<std::size_t>(rows[at].dx - low)] = static_cast<Row>(rows[at].centred(anchor));
                }
                return low + stride * dy;
            };
            for (std::size_t at = first; at < last;) {
                word w{take(per_word, at), 0};
                std::memcpy(&w.mask, lanes.data(), sizeof w.mask);
                words_.push_back(w);
            }
            for (std::size_t at = first; at < last;) {
                block b{};
                block_offsets_.push_back(take(per_block, at));
                std::memcpy(&b, lanes.data(), sizeof b);
                blocks_.push_back(b);
            }
            first = last;
        }
    }

    void pack_wide(std::span<stencil_row const> rows) {
        for (std::size_t at = 0; at < rows.size();) {
            stencil_row const first = rows[at];
            block low{};
            block high{};
            for (; at < rows.size() && rows[at].dy == first.dy && rows[at].dx < first.dx + 8; ++at) {
                std::int32_t const offset = rows[at].dx + wide_stride * rows[at].dy;
                words_.push_back({offset, rows[at].bits[0]});
                words_.push_back({offset, rows[at].bits[1]});
                low.mask[static_cast<std::size_t>(rows[at].dx - first.dx)] = rows[at].bits[0];
                high.mask[static_cast<std::size_t>(rows[at].dx - first.dx)] = rows[at].bits[1];
            }
            block_offsets_.push_back(first.dx + wide_stride * first.dy);
            blocks_.push_back(low);
            blocks_.push_back(high);
        }
    }

    layout layout_ = layout::narrow;
    std::vector<word> words_{};
    std::vector<stencil_row> mirrored_{};
    std::vector<block> blocks_{};
    std::vector<std::int32_t> block_offsets_{};
};

}  // namespace tafoni::detail

#endif
