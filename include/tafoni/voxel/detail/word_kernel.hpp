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
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            std::uint32_t const* const at = t.rows.narrow(t.position[i]);
            int const z = t.position[i] & 15;
            t.solid[i] = sum(t.bubble.words(), [at, z](stencil_words::word const& w) {
                std::uint64_t pair = 0;
                std::memcpy(&pair, at + w.offset, sizeof pair);
                return pair >> z & w.mask;
            });
        }
    }
    [[gnu::always_inline]] static inline void medium(count_task const& t) {
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            std::uint64_t const* const at = t.rows.medium(t.position[i]);
            int const z = t.position[i] & 31;
            t.solid[i] =
                sum(t.bubble.words(), [at, z](stencil_words::word const& w) { return at[w.offset] >> z & w.mask; });
        }
    }
    [[gnu::always_inline]] static inline void wide(count_task const& t) {
        for (std::size_t i = 0; i < t.position.size(); ++i) {
            std::uint64_t const* const at = t.rows.wide(t.position[i]);
            int const z = t.position[i] & 31;
            auto const words = t.bubble.words();
            int solid = 0;
            for (std::size_t k = 0; k < words.size(); k += 2) {
                std::uint64_t const low = at[words[k].offset];
                std::uint64_t const high = at[words[k].offset + air_rows::wide_plane];
                solid += std::popcount((low >> z | high << 1 << (63 - z)) & words[k].mask) +
                         std::popcount(high >> z & words[k + 1].mask);
            }
            t.solid[i] = static_cast<std::uint32_t>(solid);
        }
    }
    /// Four sums, so that they do not wait for each other.
    template <class Masked>
    [[gnu::always_inline]] static inline std::uint32_t sum(std::span<stencil_words::word const> words,
                                                           Masked const& masked) {
        static_assert(stencil_words::unrolled == 4);
        int a = 0;
        int b = 0;
        int c = 0;
        int d = 0;
        for (std::size_t k = 0; k < words.size(); k += 4) {
            a += std::popcount(masked(words[k]));
            b += std::popcount(masked(words[k + 1]));
            c += std::popcount(masked(words[k + 2]));
            d += std::popcount(masked(words[k + 3]));
        }
        return static_cast<std::uint32_t>(a + b + (c + d));
    }
};

}  // namespace tafoni::detail

#endif
