/// \file
/// Counting the solid voxels in bubbles, a popcount per word of a bubble.
#ifndef TAFONI_VOXEL_DETAIL_WORD_KERNEL_HPP
#define TAFONI_VOXEL_DETAIL_WORD_KERNEL_HPP

#include <tafoni/voxel/detail/air_rows.hpp>
#include <tafoni/voxel/detail/skin_view.hpp>
#include <tafoni/voxel/detail/stencil_words.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tafoni::detail {

/// What a kernel counts: one bubble around many voxels of a brick.
struct count_task {
    air_rows const& rows;
    stencil_words const& bubble;
    std::span<brick_position const> position;
    std::uint32_t* solid;  ///< one for each position, written
};

/// Inlined into functions for one instruction set each; O(voxels * words of the bubble).
struct word_kernel {
    [[gnu::always_inline]] static inline void count(count_task const& t) {
        switch (t.bubble.kind()) {
            case stencil_words::layout::narrow: return narrow(t);
            case stencil_words::layout::medium: return medium(t);
            case stencil_words::layout::wide: return wide(t);
        }
    }

private:
    [[gnu::always_inline]] static inline void narrow(count_task const& t) {
        auto const words = t.bubble.words();
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            auto const z = static_cast<unsigned>(t.position[i] & 31);
            std::uint32_t const* const at = t.rows.narrow(t.position[i]);
            int solid = 0;
            for (auto const& w : words) {
                std::uint64_t pair = 0;
                std::memcpy(&pair, at + w.offset, sizeof pair);
                solid += std::popcount(pair >> (z & 15) & w.mask);
            }
            t.solid[i] = static_cast<std::uint32_t>(solid);
        }
    }
    [[gnu::always_inline]] static inline void medium(count_task const& t) {
        auto const words = t.bubble.words();
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            auto const z = static_cast<unsigned>(t.position[i] & 31);
            std::uint64_t const* const at = t.rows.medium(t.position[i]);
            int solid = 0;
            for (auto const& w : words) solid += std::popcount(at[w.offset] >> z & w.mask);
            t.solid[i] = static_cast<std::uint32_t>(solid);
        }
    }
    [[gnu::always_inline]] static inline void wide(count_task const& t) {
        auto const words = t.bubble.words();
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            auto const z = static_cast<unsigned>(t.position[i] & 31);
            std::uint64_t const* const at = t.rows.wide(t.position[i]);
            int solid = 0;
            for (std::size_t k = 0; k + 1 < words.size(); k += 2) {
                std::uint64_t const* const row = at + 2 * words[k].offset;
                std::uint64_t const carried = row[1] << 1 << (63 - z);
                solid += std::popcount((row[0] >> z | carried) & words[k].mask) +
                         std::popcount(row[1] >> z & words[k + 1].mask);
            }
            t.solid[i] = static_cast<std::uint32_t>(solid);
        }
    }
};

}  // namespace tafoni::detail

#endif
