/// \file
/// The order in which to ask walls about particles, so that neighbours are asked about one after the other.
#ifndef TAFONI_FLUID_DETAIL_VISIT_ORDER_HPP
#define TAFONI_FLUID_DETAIL_VISIT_ORDER_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tafoni::detail {

/// Particles by the block of the walls that they are in, then by number; as they are numbered where the walls name no
/// blocks; what is in block 0 touches nothing. Answers do not depend on it, the time does: a cell's faces stay in the
/// cache. Keeps its memory.
class visit_order {
public:
    /// O(n + blocks).
    template <class Walls, class Position, executor E>
    void sort(Walls const& walls, std::size_t n, Position const& position, E const& threads) {
        order_.resize(n);
        away_ = 0;
        if constexpr (requires(vec3 const& p) { walls.block_of(p); }) {
            block_.resize(n);
            threads.for_blocks(n, 2048, [&](std::size_t from, std::size_t to) {
                for (std::size_t i = from; i < to; ++i) block_[i] = static_cast<std::uint32_t>(walls.block_of(position(i)));
            });
            // Most are away as a rule: they are told from the others without a branch, and only the others sorted.
            close_.resize(n);
            std::size_t close = 0;
            for (std::size_t i = 0; i < n; ++i) {
                order_[away_] = close_[close] = static_cast<std::uint32_t>(i);
                bool const here = block_[i] != 0;
                close += here ? 1 : 0;
                away_ += here ? 0 : 1;
            }
            begin_.assign(walls.block_count(), 0);
            for (std::size_t k = 0; k < close; ++k) ++begin_[block_[close_[k]]];
            auto total = static_cast<std::uint32_t>(away_);
            for (std::uint32_t& b : begin_) {
                std::uint32_t const here = b;
                b = total;
                total += here;
            }
            for (std::size_t k = 0; k < close; ++k) order_[begin_[block_[close_[k]]]++] = close_[k];
        } else {
            std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        }
    }
    /// How many there are before the first that may touch the walls.
    [[nodiscard]] std::size_t away() const noexcept { return away_; }
    [[nodiscard]] std::size_t operator[](std::size_t k) const noexcept { return order_[k]; }
    /// Tells the walls which block is asked about a few particles after the k-th, so that it is on its way from memory.
    template <class Walls>
    void look_ahead(Walls const& walls, std::size_t k) const noexcept {
        if constexpr (requires(vec3 const& p) { walls.block_of(p); walls.fetch(std::size_t{0}); }) {
            if (k + ahead < order_.size()) walls.fetch(block_[order_[k + ahead]]);
        }
    }

private:
    static constexpr std::size_t ahead = 6;

    std::size_t away_ = 0;
    std::vector<std::uint32_t> order_{};
    std::vector<std::uint32_t> block_{};
    std::vector<std::uint32_t> close_{};
    std::vector<std::uint32_t> begin_{};
};

}  // namespace tafoni::detail

#endif
