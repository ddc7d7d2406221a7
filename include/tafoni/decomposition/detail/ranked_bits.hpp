/// \file
/// A set of small integers that also numbers its members.
#ifndef TAFONI_DECOMPOSITION_DETAIL_RANKED_BITS_HPP
#define TAFONI_DECOMPOSITION_DETAIL_RANKED_BITS_HPP

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// 1.5 bits per candidate; `finish` must follow the last `insert` and come before `rank`, `select` and `count`.
class ranked_bits {
public:
    ranked_bits() = default;
    explicit ranked_bits(std::size_t size) : words_(size / 64 + 1, 0) {}

    void insert(std::size_t i) noexcept { words_[i / 64] |= std::uint64_t{1} << (i % 64); }

    void finish() {
        before_.resize(words_.size());
        std::uint32_t total = 0;
        for (std::size_t w = 0; w < words_.size(); ++w) {
            before_[w] = total;
            total += static_cast<std::uint32_t>(std::popcount(words_[w]));
        }
        count_ = total;
    }

    [[nodiscard]] bool contains(std::size_t i) const noexcept { return (words_[i / 64] >> (i % 64) & 1U) != 0; }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

    /// Members below i. O(1).
    [[nodiscard]] std::uint32_t rank(std::size_t i) const noexcept {
        std::uint64_t const below = words_[i / 64] & ((std::uint64_t{1} << (i % 64)) - 1);
        return before_[i / 64] + static_cast<std::uint32_t>(std::popcount(below));
    }

    /// The member with `rank(member) == r`, r < count(). O(log size).
    [[nodiscard]] std::size_t select(std::uint32_t r) const noexcept {
        auto const after = std::upper_bound(before_.begin(), before_.end(), r);
        auto const w = static_cast<std::size_t>(after - before_.begin()) - 1;
        std::uint64_t word = words_[w];
        for (std::uint32_t skip = r - before_[w]; skip > 0; --skip) word &= word - 1;
        return w * 64 + static_cast<std::size_t>(std::countr_zero(word));
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return words_.capacity() * 8 + before_.capacity() * 4; }

private:
    std::vector<std::uint64_t> words_{};
    std::vector<std::uint32_t> before_{};
    std::size_t count_ = 0;
};

}  // namespace tafoni::detail

#endif
