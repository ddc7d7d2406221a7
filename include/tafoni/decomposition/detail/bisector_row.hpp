/// \file
/// A bisector as one linear equation over a plane or line, exact.
#ifndef TAFONI_DECOMPOSITION_DETAIL_BISECTOR_ROW_HPP
#define TAFONI_DECOMPOSITION_DETAIL_BISECTOR_ROW_HPP

#include <tafoni/geometry/lattice.hpp>
#include <tafoni/geometry/wide_int.hpp>

#include <cstddef>

namespace tafoni::detail {

/// The bisector of two sites as the equation  sum of w along(end, base) = offset  for points base + sum of
/// w (end - base). Needed where a surface runs almost in the bisector: there doubles would cancel, and where
/// they meet would be anywhere. Lattice points below 2^58.
class bisector_row {
public:
    /// Share of a full right angle down to which doubles lose no more than ten bits.
    static constexpr double steep = 0x1p-10;

    bisector_row(ivec3 const& other, ivec3 const& own, ivec3 const& base) noexcept {
        for (std::size_t a = 0; a < 3; ++a) {
            n_[a] = other[a] - own[a];
            from_own_[a] = base[a] - own[a];
        }
    }

    /// |n|^2 - 2 n . (base - own)
    [[nodiscard]] tafoni::wide_int<2> offset() const noexcept {
        ivec3 m{};
        for (std::size_t a = 0; a < 3; ++a) m[a] = n_[a] - 2 * from_own_[a];
        return product(n_, m);
    }
    /// 2 n . (end - base)
    [[nodiscard]] tafoni::wide_int<2> along(ivec3 const& end, ivec3 const& base) const noexcept {
        ivec3 m{};
        for (std::size_t a = 0; a < 3; ++a) m[a] = 2 * (end[a] - base[a]);
        return product(n_, m);
    }

private:
    [[nodiscard]] static tafoni::wide_int<2> product(ivec3 const& a, ivec3 const& b) noexcept {
        return tafoni::wide_int<1>(a[0]) * tafoni::wide_int<1>(b[0]) + tafoni::wide_int<1>(a[1]) * tafoni::wide_int<1>(b[1]) +
               tafoni::wide_int<1>(a[2]) * tafoni::wide_int<1>(b[2]);
    }

    ivec3 n_{};
    ivec3 from_own_{};
};

}  // namespace tafoni::detail

#endif
