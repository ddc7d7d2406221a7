/// \file
/// Gives equal points one index: exact equality, with -0.0 equal to 0.0.
#ifndef TAFONI_IO_DETAIL_EXACT_WELDER_HPP
#define TAFONI_IO_DETAIL_EXACT_WELDER_HPP

#include <tafoni/core/vector.hpp>

#include <bit>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// A hash table over points that live elsewhere; it holds indices only. Points must not be NaN.
class exact_welder {
public:
    explicit exact_welder(std::vector<vec3>& points) : points_(points), slots_(16, empty) {}

    /// Room for so many different points.
    void reserve(std::size_t count) {
        points_.reserve(count);
        std::size_t slots = slots_.size();
        while (slots < 2 * count) slots *= 2;
        slots_ = std::vector<std::uint32_t>(slots, empty);
        fill();
    }

    /// The index of the point equal to `p`, which is appended if there is none. O(1) expected.
    std::uint32_t index_of(vec3 const& p) {
        if (2 * points_.size() >= slots_.size()) grow();
        std::size_t const slot = find(p);
        if (slots_[slot] == empty) {
            slots_[slot] = static_cast<std::uint32_t>(points_.size());
            points_.push_back(p);
        }
        return slots_[slot];
    }

private:
    static constexpr std::uint32_t empty = 0xffffffffU;

    [[nodiscard]] std::size_t find(vec3 const& p) const noexcept {
        std::uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            h ^= std::bit_cast<std::uint64_t>(p[axis] + 0.0);
            h *= 0x9e3779b97f4a7c15U;
            h ^= h >> 32;
        }
        // Once more, or the sign of z would not reach the low bits, and mirrored points would share slots.
        h *= 0x9e3779b97f4a7c15U;
        h ^= h >> 32;
        std::size_t const mask = slots_.size() - 1;
        std::size_t slot = static_cast<std::size_t>(h) & mask;
        while (slots_[slot] != empty && !equal(points_[slots_[slot]], p)) slot = (slot + 1) & mask;
        return slot;
    }
    [[nodiscard]] static bool equal(vec3 const& a, vec3 const& b) noexcept {
        return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
    }
    void grow() {
        slots_ = std::vector<std::uint32_t>(2 * slots_.size(), empty);
        fill();
    }
    void fill() {
        for (std::size_t i = 0; i < points_.size(); ++i) slots_[find(points_[i])] = static_cast<std::uint32_t>(i);
    }

    std::vector<vec3>& points_;
    std::vector<std::uint32_t> slots_;
};

}  // namespace tafoni::detail

#endif
